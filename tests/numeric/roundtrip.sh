#!/usr/bin/env bash
# XML -> native -> XML over all scenes at hand: the same elements, spellings and comments, the same
# bytes of pictures from all three, and short native texts.
set -u
wrt=${WRT:-build/wrt}
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
original=${WRT_SHARED:-$top/../shared}/original
scenes=("$top"/scenes/*.xml)
if [ -d "$original" ]; then
    scenes+=("$original"/*.xml)
else
    echo "SKIP: the original's scenes are not here ($original); only our own were converted"
fi
most=55 # percent of the XML's bytes that the native texts may have, all together

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
failed=0
complain()
{
    echo "$scene: $*"
    failed=$((failed + 1))
}

# A scene's lines without what a conversion may change: blank ones and the declaration.
content()
{
    "$wrt" fmt "$1" | grep -vE '^$|^<\?xml '
}

# The text there and back; file names stay as spelt, so the files are not looked for.
check_text()
{
    "$wrt" convert "$scene" -o "$tmp/there.wrt" --no-verify 2>"$tmp/err" &&
        "$wrt" convert "$tmp/there.wrt" -o "$tmp/back.xml" --no-verify 2>>"$tmp/err" || {
        complain "is not converted"
        cat "$tmp/err"
        return
    }
    "$wrt" fmt --check "$tmp/there.wrt" "$tmp/back.xml" >/dev/null || complain "is not in canonical layout"
    diff <(content "$scene") <(content "$tmp/back.xml") >"$tmp/diff" || {
        complain "came back changed"
        head -n 20 "$tmp/diff"
    }
}

# The pictures of the scene, its native twin and that one's.
check_pictures()
{
    "$wrt" convert "$scene" -o "$tmp/here.wrt" --rebase && "$wrt" convert "$tmp/here.wrt" -o "$tmp/here.xml" --rebase || {
        complain "is not verified"
        return
    }
    for file in "$scene" "$tmp/here.wrt" "$tmp/here.xml"; do
        "$wrt" render -q "$file" --res 40x30 -o "$tmp/$(basename "$file").ppm" || complain "$file is not rendered"
    done
    cmp -s "$tmp/$(basename "$scene").ppm" "$tmp/here.wrt.ppm" || complain "the native twin gives another picture"
    cmp -s "$tmp/here.wrt.ppm" "$tmp/here.xml.ppm" || complain "its XML twin gives another picture"
}

xml_bytes=0 native_bytes=0
for scene in "${scenes[@]}"; do
    check_text
    check_pictures
    case $scene in
    "$original"/*)
        xml_bytes=$((xml_bytes + $(wc -c <"$scene")))
        native_bytes=$((native_bytes + $(wc -c <"$tmp/there.wrt")))
        ;;
    esac
done
if [ $xml_bytes -gt 0 ]; then
    echo "native texts: $native_bytes bytes, $((native_bytes * 1000 / xml_bytes)) per mille of the XML's"
    [ $((native_bytes * 100)) -le $((xml_bytes * most)) ] || {
        echo "more than $most percent"
        failed=$((failed + 1))
    }
fi
echo "${#scenes[@]} scenes, $failed failed"
[ $failed = 0 ]
