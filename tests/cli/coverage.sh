#!/bin/sh
# Every diagnostic of src/diag/diag.def has a case tests/cli/diag/CODE-slug that prints it, and a near
# miss tests/cli/diag/CODE-near-miss that does not.
set -u
cd "${srcdir:-$(dirname "$0")/../..}" || exit 1

cases=tests/cli/diag
# More text or triangles than a test can afford.
costly='E209-scene-too-large'
# Cases whose `needs` a usual build does not meet are trusted to print what they are called.
status=0
offence()
{
    echo "coverage: $1"
    status=1
}

codes=$(sed -n 's/^DIAG([A-Z0-9_]*, "\([EWN][0-9]*\)", "\([a-z0-9-]*\)".*/\1-\2/p' src/diag/diag.def)
[ -n "$codes" ] || offence "no codes found in src/diag/diag.def"
for code in $codes; do
    case " $costly " in *" $code "*) continue ;; esac
    if [ ! -f "$cases/$code/cmd" ]; then
        offence "no case $cases/$code"
    elif [ ! -f "$cases/$code/needs" ] && ! grep -qsF "[$code]" "$cases/$code/err" "$cases/$code/out"; then
        offence "$cases/$code does not print [$code]"
    fi
    near=$cases/${code%%-*}-near-miss
    if [ ! -f "$near/cmd" ]; then
        offence "no case $near"
    elif grep -qsF "[${code%%-*}-" "$near/err" "$near/out"; then
        offence "$near prints the code"
    fi
done

for folder in "$cases"/*/; do
    name=$(basename "$folder")
    case $name in *-near-miss) continue ;; esac
    printf '%s\n' "$codes" | grep -qxF "$name" || offence "$folder is named after no code"
done
exit $status
