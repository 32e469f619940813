#!/bin/sh
# The tables of wrt.5 are those that the program makes, and its examples are scenes.
#
#   manual.sh [--update]
set -u
cd "${srcdir:-$(dirname "$0")/..}" || exit 1
manual=man/wrt.5
work=$(mktemp -d "${TMPDIR:-/tmp}/wrt-manual.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
# insert NAME COMMAND...: between the marks of that name, what the command prints.
insert()
{
    begin='^\.\\" BEGIN '$1 end='^\.\\" END '$1
    shift
    "$@" >"$work/part" || exit 1
    if [ "$(grep -cE "$begin|$end" "$work/wanted")" != 2 ]; then
        echo "manual: $manual lacks marks: $begin"
        exit 1
    fi
    {
        sed "/$begin/q" "$work/wanted"
        cat "$work/part"
        sed -n "/$end/,\$p" "$work/wanted"
    } >"$work/next"
    mv "$work/next" "$work/wanted"
}
cp $manual "$work/wanted"
insert PROPERTIES "${WRT:-build/wrt}" doc --man
insert FUNCTIONS "${WRT:-build/wrt}" doc --man functions
insert DIAGNOSTICS "${WRT:-build/wrt}" explain --man
if [ "${1-}" = --update ]; then
    cmp -s "$work/wanted" $manual || cp "$work/wanted" $manual
elif ! diff -u $manual "$work/wanted"; then
    echo "manual: $manual is older than the tables: run 'make update-docs'"
    exit 1
fi

# Its examples are scenes without a finding: `.\" EXAMPLE` stands before each, with `whole` when the
# example has all that a scene needs.
awk -v folder="$work" '
    /^\.\\" EXAMPLE/ { number++; whole = /whole/; next }
    /^\.Bd -literal/ && number > done {
        file = folder "/example" number ".wrt"; inside = 1
        if (!whole)
            printf "wrt 1\nmodel modern\ncamera { eye: (0, 1, -4)  look_at: 0  fov: 54  resolution: (8, 8) }\n" >file
        next
    }
    /^\.Ed/ { if (inside) { close(file); done = number }; inside = 0 }
    inside { print >file }
' $manual
examples=0 status=0
for example in "$work"/example*.wrt; do
    examples=$((examples + 1))
    found=$("${WRT:-build/wrt}" check -v "$example" 2>&1) && [ -z "$found" ] && continue
    printf 'manual: an example is wrong\n%s\n' "$found"
    status=1
done
[ $examples -ge 5 ] || { echo "manual: only $examples examples found"; status=1; }
echo "$examples examples"
exit $status
