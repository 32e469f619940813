#!/bin/sh
# The property tables of wrt.5 are those that the schema makes.
#
#   manual.sh [--update]
set -u
cd "${srcdir:-$(dirname "$0")/..}" || exit 1
manual=man/wrt.5
begin='^\.\\" BEGIN PROPERTIES'
end='^\.\\" END PROPERTIES'

work=$(mktemp -d "${TMPDIR:-/tmp}/wrt-manual.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
"${WRT:-build/wrt}" doc --man >"$work/tables" || exit 1
if [ "$(grep -cE "$begin|$end" $manual)" != 2 ]; then
    echo "manual: $manual lacks the marks around its tables"
    exit 1
fi
{
    sed "/$begin/q" $manual
    cat "$work/tables"
    sed -n "/$end/,\$p" $manual
} >"$work/wanted"
if [ "${1-}" = --update ]; then
    cmp -s "$work/wanted" $manual || cp "$work/wanted" $manual
elif ! diff -u $manual "$work/wanted"; then
    echo "manual: $manual is older than the schema: run 'make update-docs'"
    exit 1
fi
