#!/usr/bin/env bash
# The pictures of the original program: each scene, rendered, against the picture made in 2008.
#
#     tests/numeric/original.sh [--full]
#
# A scene passes with 99.9 % of its pixels within 2/255 in every channel (testBillar 99.4 %: one of
# its textures carries a colour profile that the original applied).  Scenes with area lights are
# rendered at a quarter of their width and height, which are exactly every fourth pixel of the full
# picture; --full renders all of them whole.
set -u
full=${WRT_FULL:-}
[ "${1:-}" = --full ] && full=1
wrt=${WRT:-build/wrt}
compare=${COMPARE:-$(dirname "$wrt")/tests/numeric/compare}
original=${WRT_SHARED:-../shared}/original
if [ ! -d "$original/ref" ]; then
    echo "SKIP: the original's scenes are not here ($original); none of its pictures was compared"
    exit 77
fi

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT

# resolution SCENE: width and height as the scene says them.
resolution()
{
    sed -n 's/.*<\([xy]\)Resolution> *\([0-9]*\).*/\2/p' "$1" | tr '\n' ' '
}

passed=0 failed=0 skipped=0
printf '%-16s %9s %5s  %s\n' scene 'within %' max 'worst pixel'
for ref in "$original"/ref/*.png; do
    picture=$(basename "$ref" .png)
    name=${picture%.*} samples=${picture##*.}
    scene=$original/$name.xml
    limit=99.9
    if "$wrt" render "$scene" --res 1x1 -o "$tmp/x.ppm" 2>&1 | grep -q 'was built without'; then
        echo "SKIP: $name needs what this wrt was built without"
        skipped=$((skipped + 1))
        continue
    fi
    [ "$name" = testBillar ] && limit=99.4
    options=(-s "$samples")
    note=
    if [ -z "$full" ] && [ "$samples" = 1 ] && grep -q 'class="AreaLight"' "$scene"; then
        read -r w h < <(resolution "$scene")
        if [ $((w % 4)) = 0 ] && [ $((h % 4)) = 0 ]; then
            options+=(--res "$((w / 4))x$((h / 4))")
            note=' (every 4th pixel)'
        elif [ $((w % 2)) = 0 ] && [ $((h % 2)) = 0 ]; then
            options+=(--res "$((w / 2))x$((h / 2))")
            note=' (every 2nd pixel)'
        fi
    fi
    if "$wrt" render -q "$scene" "${options[@]}" -o "$tmp/$picture.png" &&
        result=$("$compare" "$tmp/$picture.png" "$ref"); then
        read -r share most x y <<<"$result"
        verdict=
        if awk "BEGIN { exit !($share >= $limit) }"; then
            passed=$((passed + 1))
        else
            verdict="  FAILED: wants $limit"
            failed=$((failed + 1))
        fi
        printf '%-16s %9s %5s  %s,%s%s%s\n' "$picture" "$share" "$most" "$x" "$y" "$note" "$verdict"
    else
        failed=$((failed + 1))
        printf '%-16s FAILED to render or compare\n' "$picture"
    fi
    rm -f "$tmp/$picture.png"
done
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" = 0 ]
