#!/usr/bin/env bash
# Every example is checked without a finding, lies in canonical layout, renders, and is in the table
# of examples/README.md; every step of the tutorial, too; the gallery's page is whole.
set -u
export LC_ALL=C
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
wrt=${WRT:-$top/build/wrt}
tmp=$(mktemp -d) || exit 1
trap 'rm -rf "$tmp"' EXIT
failed=0

# must NAME COMMAND...: silent success
must()
{
    local name=$1
    shift
    if ! "$@" >"$tmp/said" 2>&1 || [ -s "$tmp/said" ]; then
        echo "$name: $*"
        cat "$tmp/said"
        failed=1
    fi
}

# a stand-in that renders in small, for the gallery
printf '#!/bin/sh\nexec "%s" "$@" --res 16x12 -s 1\n' "$wrt" >"$tmp/small"
chmod +x "$tmp/small"

scenes=("$top"/examples/*.wrt)
for scene in "${scenes[@]}"; do
    name=$(basename "$scene" .wrt)
    must "$name" "$wrt" check -q "$scene"
    must "$name" "$wrt" fmt --check "$scene"
    must "$name" "$wrt" render "$scene" -q -s 1 --res 16x12 -o "$tmp/$name.ppm"
    grep -qF "\`$name.wrt\`" "$top/examples/README.md" || { echo "examples/README.md: no $name.wrt"; failed=1; }
done

for step in 1 2 3 4 5; do
    must "step $step" "$wrt" render "$top/examples/tutorial.wrt" -D step=$step -q -s 1 --res 40x30 \
        -o "$tmp/step$step.ppm"
    [ $step = 1 ] || ! cmp -s "$tmp/step$step.ppm" "$tmp/step$((step - 1)).ppm" ||
        { echo "tutorial: step $step looks like the one before"; failed=1; }
done

"$top/build-aux/gallery.sh" "$tmp/small" "$top/examples" "$tmp/gallery" >"$tmp/said" 2>&1 ||
    { cat "$tmp/said"; failed=1; }
page=$tmp/gallery/index.html
[ "$(grep -c '<section' "$page")" = ${#scenes[@]} ] || { echo "gallery: not every example has a section"; failed=1; }
[ "$(grep -c '</section' "$page")" = ${#scenes[@]} ] || { echo "gallery: an unfinished section"; failed=1; }
for scene in "${scenes[@]}"; do
    [ -s "$tmp/gallery/$(basename "$scene" .wrt).png" ] || { echo "gallery: no picture of $scene"; failed=1; }
done
# what the page shows of a source is that source, once the marks of comments are gone
sed -n '/<section id="billiard"/,/<\/section/p' "$page" | sed -n '/<pre>/,/<\/pre>/p' |
    sed -E 's|.*<pre>||; s|</pre>.*||; s|</?i>||g; s/&lt;/</g; s/&gt;/>/g; s/&quot;/"/g; s/&amp;/\&/g' |
    diff - "$top/examples/billiard.wrt" || { echo "gallery: the source differs"; failed=1; }
grep -nE '(src|href)="[a-z]+:' "$page" && { echo "gallery: something from elsewhere"; failed=1; }

[ $failed = 0 ]
