#!/bin/sh
# Nothing is to be said of the scenes and examples, and what `wrt lint --fix` would mend in them is
# nothing.
set -u
cd "${srcdir:-$(dirname "$0")/..}" || exit 1
wrt=${WRT:-build/wrt}
status=0 scenes=0
for scene in scenes/*.xml examples/*.wrt; do
    scenes=$((scenes + 1))
    found=$("$wrt" lint --fix=all --diff "$scene" 2>&1) && [ -z "$found" ] && continue
    printf 'lint: %s is not clean\n%s\n' "$scene" "$found"
    status=1
done
[ $scenes -ge 40 ] || { echo "lint: only $scenes scenes found"; status=1; }

# Every rule that lint looks for has a right and a wrong example.
codes=$("$wrt" lint --list | sed -n 's/^  \([WN][5-9][0-9]*\) .*/\1/p')
for code in $codes; do
    for part in wrong right; do
        "$wrt" explain "$code" | grep -q "^$part:" && continue
        echo "lint: $code has no $part example"
        status=1
    done
done
echo "$scenes scenes, $(echo "$codes" | wc -l) rules"
exit $status
