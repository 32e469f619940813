#!/bin/sh
# Every diagnostic is explained, and the examples of its explanation are examples of it.
#
# What is proposed for the wrong ones brings up no other finding, and nothing is left to do twice: no
# rule asks for what another one objects to.
#
# Native examples are read by `wrt lint` with every rule on; one that is no whole scene is given a
# beginning.  What begins with `$`, `<` or `OFF` is a command, XML or a mesh, and is not run.
set -u
cd "${srcdir:-$(dirname "$0")/..}" || exit 1
wrt=${WRT:-build/wrt}
status=0
complain()
{
    echo "explain: $1"
    status=1
}
work=$(mktemp -d "${TMPDIR:-/tmp}/wrt-explain.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

# The files that examples name.
printf 'wrt 1\nmaterial gold = lambert { diffuse: 0.5 }\n' >"$work/metals.wrt"
for file in wood.png Wood.png stone.png 'textures\wood.png'; do
    echo picture >"$work/$file"
done

# example CODE wrong|right: the indented lines of that part, as a scene; false where it is none.
example()
{
    "$wrt" explain "$1" | awk -v title="$2:" '
        $0 == title { inside = 1; next }
        inside && !/^    / { exit }
        inside { print substr($0, 5) }' >"$work/part"
    case $(head -c 3 "$work/part") in '' | '$'* | '<'* | OFF) return 1 ;; esac
    {
        grep -q '^wrt \|^model ' "$work/part" || echo 'wrt 1
model modern'
        grep -q '^camera\|^model' "$work/part" ||
            echo 'camera { eye: (0, 1, -4)  look_at: 0  fov: 54deg  resolution: (8, 8) }'
        sed "s|/home/eva/scenes|$work|" "$work/part"
    } >"$work/$2.wrt"
}

"$wrt" explain --man | sed -n 's/^\.It \([EWN][0-9]*\) .*/\1/p' >"$work/codes"
codes() { sed -n 's/.* \[\([EWN][0-9]*\)-.*\]$/\1/p' | sort -u; }
ran=0
while read -r code; do
    [ "$("$wrt" explain "$code" | wc -l)" -ge 4 ] || complain "$code is not explained"
    for part in wrong right; do
        example "$code" $part || continue
        ran=$((ran + 1))
        "$wrt" lint -W all "$work/$part.wrt" 2>&1 | codes >"$work/before"
        found=$(grep -cx "$code" "$work/before")
        if [ $part = wrong ] && [ "${code#E}" = "$code" ]; then # errors hide findings
            cp "$work/wrong.wrt" "$work/mended.wrt"
            "$wrt" lint -W all --fix=all "$work/mended.wrt" 2>&1 | codes >"$work/after"
            new=$(comm -13 "$work/before" "$work/after" | tr '\n' ' ')
            [ -z "$new" ] || complain "$code: mending its wrong example brings $new"
            "$wrt" lint -W all --fix=all --diff "$work/mended.wrt" 2>/dev/null | grep -q . &&
                complain "$code: its wrong example is mended again and again"
        fi
        case $part$found in
        wrong0) complain "$code: the wrong example does not fire" ;;
        wrong* | right0) ;;
        right*) complain "$code: the right example fires" ;;
        esac
    done
done <"$work/codes"
[ "$ran" -ge 50 ] || complain "only $ran examples found"
echo "$ran examples"
exit $status
