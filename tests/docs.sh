#!/usr/bin/env bash
# Documents that say what the tree says elsewhere must agree with it: the file map of HACKING.md,
# the options in wrt.1, the packages in README.md.
set -u
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$top" || exit 1
failed=0
complain()
{
    echo "$1"
    failed=1
}

for file in src/*/* grammar/*; do
    name=$(basename "$file")
    stem=${name%.*}
    room=$(dirname "$file")
    # a line of the room's section names the file, or its stem for a .c and .h pair
    awk -v room="### $room/" 'index($0, "### ") == 1 { on = index($0, room) == 1 } on' HACKING.md |
        grep -qE "\`($name|$stem)\`" || complain "HACKING.md: $file is not in the file map"
done

while IFS= read -r option; do
    grep -q -- "Fl -$option" man/wrt.1 || complain "wrt.1: option --$option is not described"
done < <(sed -n 's/^OPT([^"]*"\([^"]*\)".*/\1/p' src/cmd/opts.def)

# the one-page reference names every native kind and property
while IFS= read -r name; do
    grep -qF "\`$name\`" README.md || complain "README.md: '$name' of schema.def is not in the reference"
done < <(sed -n 's/^KIND([^"]*"\([^"]*\)".*/\1/p; s/^PROP([^"]*"\([^"]*\)".*/\1/p' src/schema/schema.def)

diff <(sed -n '/^| Needed/,$p' README.md | grep '^|') build-aux/packages.md >/dev/null ||
    complain "README.md: the table of packages differs from build-aux/packages.md"

[ $failed = 0 ]
