#!/usr/bin/env bash
# One HTML page of all examples, picture beside source; `make gallery` runs it.
#
#   gallery.sh WRT EXAMPLES OUT      WRT the program, EXAMPLES the folder, OUT where index.html goes
#
# The page needs nothing but the pictures beside it.  The order, and what a scene shows, are those of
# the table in EXAMPLES/README.md.
set -eu
export LC_ALL=C
[ $# = 3 ] || { echo "usage: gallery.sh WRT EXAMPLES OUT" >&2; exit 1; }
wrt=$1 examples=$2 out=$3

escape()
{
    sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g; s/"/\&quot;/g' "$@"
}

# Comments in a colour of their own; what is in a string is none.
source_of()
{
    escape "$1" | sed -E 's|^(([^&/]\|/[^/]\|&[^q]\|&quot;([^&]\|&[^q])*&quot;)*)(//.*)$|\1<i>\4</i>|'
}

# "FILE<tab>WHAT" for each row of the table.
rows()
{
    sed -n 's/^| `\([a-z_]*\)\.wrt` | \(.*\) |$/\1\t\2/p' "$examples/README.md"
}

head_of_page()
{
    cat <<'EOF'
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>wrt: gallery</title>
<style>
body { margin: 0 auto; max-width: 96rem; padding: 2rem; background: #f6f4ef; color: #26241f;
  font: 1rem/1.5 system-ui, sans-serif }
h1 { font-weight: 300; font-size: 2.6rem; margin: 0 0 1rem }
h2 { font-weight: 600; margin: 0 }
p { margin: 0.2rem 0 1rem; color: #5d584c }
nav { display: flex; flex-wrap: wrap; gap: 0.6rem; margin-bottom: 3rem }
nav img { display: block; height: 6rem; border-radius: 4px }
section { margin-bottom: 3.5rem }
.pair { display: grid; grid-template-columns: minmax(0, 1fr) minmax(0, 1fr); gap: 1.5rem; align-items: start }
.pair img { position: sticky; top: 1rem; width: 100%; height: auto; border-radius: 6px;
  box-shadow: 0 4px 18px #0004 }
pre { margin: 0; max-height: 80vh; overflow: auto; padding: 1rem 1.2rem; border-radius: 6px;
  background: #22252b; color: #e8e4da; font: 0.82rem/1.45 ui-monospace, monospace; tab-size: 2 }
pre i { color: #93a98c; font-style: normal }
@media (max-width: 60rem) { .pair { grid-template-columns: 1fr } .pair img { position: static } }
</style>
</head>
<body>
<h1>wrt: gallery</h1>
EOF
}

mkdir -p "$out"
page=$out/index.html.new
{
    head_of_page
    echo '<nav>'
    rows | while IFS=$'\t' read -r name what; do
        echo "<a href=\"#$name\"><img src=\"$name.png\" alt=\"$name\"></a>"
    done
    echo '</nav>'
    rows | while IFS=$'\t' read -r name what; do
        echo "<section id=\"$name\">"
        echo "<h2>$name</h2>"
        echo "<p>$(echo "$what" | escape | sed 's|`\([^`]*\)`|<code>\1</code>|g')</p>"
        echo "<div class=\"pair\"><img src=\"$name.png\" alt=\"$name\">"
        echo "<pre>$(source_of "$examples/$name.wrt")</pre></div>"
        echo '</section>'
    done
    echo '</body>'
    echo '</html>'
} >"$page"
rows | while IFS=$'\t' read -r name what; do
    echo "  $name"
    "$wrt" render "$examples/$name.wrt" -q -o "$out/$name.png"
done
mv "$page" "$out/index.html"
echo "see $out/index.html"
