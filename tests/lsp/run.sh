#!/usr/bin/env bash
# Recorded sessions with the language server.
#
#   run.sh [--update] [NAME...]
#
# tests/lsp/sessions/NAME.session is what a client says, line by line, and under it what the server answers
# (see session.c).  Each is played against WRT in a folder with the files of tests/lsp/files, and must
# come out as it is written.  `wrt lsp` has the options that a line `# options: ...` of the session names,
# else --no-warn all; --update writes it so.
set -u
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
srcdir=$(cd "$here/../.." && pwd)
WRT=${WRT:-$srcdir/build/wrt}
SESSION=${SESSION:-$(dirname "$WRT")/tests/lsp/session}

update=no
if [ "${1-}" = --update ]; then
    update=yes
    shift
fi
for program in "$WRT" "$SESSION"; do
    [ -x "$program" ] || { echo "run.sh: no program $program: build it first" >&2; exit 1; }
done

work=$(mktemp -d "${TMPDIR:-/tmp}/wrt-lsp.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cp -R "$here/files" "$work/files"
chmod -R u+w "$work/files"
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}exitcode=134"
export UBSAN_OPTIONS="${UBSAN_OPTIONS:+$UBSAN_OPTIONS:}exitcode=134"

[ $# -gt 0 ] || set -- $(cd "$here/sessions" && ls ./*.session | sed 's|^\./||; s|\.session$||')
failed=0
for name in "$@"; do
    session=$here/sessions/$name.session
    options=$(sed -n 's/^# options: //p' "$session")
    [ -n "$options" ] || options='--no-warn all'
    # what the server says on standard error comes last
    (cd "$work/files" && "$SESSION" "$session" ${WRT_WRAPPER-} "$WRT" lsp $options 2>"$work/err" >"$work/out")
    status=$?
    sed 's/^/<2 /' "$work/err" >>"$work/out"
    if [ $status = 0 ] && [ $update = yes ] && ! cmp -s "$session" "$work/out"; then
        cp "$work/out" "$session"
    elif [ $status != 0 ] || ! cmp -s "$session" "$work/out"; then
        echo "FAIL $name"
        diff -u "$session" "$work/out" | sed 's/^/    /' | head -n 80
        failed=$((failed + 1))
    fi
done
echo "$(($# - failed)) passed, $failed failed"
[ $failed = 0 ]
