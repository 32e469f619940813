#!/usr/bin/env bash
# Golden cases of the command line.
#
#   run.sh [--update] [CASE...]      CASE as area/case or area; all without
#
# A case is a folder tests/cli/AREA/CASE with
#   cmd      shell commands, run by sh in a scratch copy of the folder, `wrt` being on PATH
#   out err  what they must print (missing: nothing)
#   exit     their exit status (missing: 0)
#   files    names that must exist afterwards, or must not when they start with `!`
#   needs    a shell test; when it fails the case is skipped
# and any input files.  A signal, a sanitizer report or 60 seconds without an end fail any case.
# $srcdir names the source folder (and stands for it in out and err), $WRT_SHARED the reference data.
# WRT_EVERY=n takes every n-th case only.
# WRT is the program under test, WRT_WRAPPER a command to run it under, such as valgrind.
set -u
export LC_ALL=C TERM=dumb
unset NO_COLOR CDPATH MAKEFLAGS MFLAGS MAKELEVEL

here=$(cd "$(dirname "$0")" && pwd)
srcdir=$(cd "$here/../.." && pwd)
WRT=${WRT:-$srcdir/build/wrt}
WRT_SHARED=${WRT_SHARED:-$srcdir/../shared}
export srcdir WRT WRT_SHARED

limit=
for tool in timeout gtimeout; do
    command -v $tool >/dev/null 2>&1 && limit="$tool -k 5 ${WRT_TIMEOUT:-60}" && break
done

# ---- one case, in a shell of its own: leaves $work/$name/{result,report} ----------------------

# What a case printed, with the place of the sources made independent of this machine.
portable()
{
    local file
    grep -lF -- "$srcdir" "$@" | while IFS= read -r file; do
        sed "s|$srcdir|\$srcdir|g" "$file" >"$file.portable" && mv "$file.portable" "$file"
    done
}

compare()
{
    local expected=$1 actual=$2 title=$3
    [ -s "$expected" ] || [ -s "$actual" ] || return 0
    [ -f "$expected" ] || expected=/dev/null
    cmp -s "$expected" "$actual" && return
    diff -u -L "$title expected" -L "$title got" "$expected" "$actual" | head -n 60
    return 1
}

check_files()
{
    local name ok=0
    while IFS= read -r name; do
        case $name in
        '') ;;
        !*) [ ! -e "${name#!}" ] || { echo "file ${name#!} must not exist"; ok=1; } ;;
        *) [ -e "$name" ] || { echo "file $name is missing"; ok=1; } ;;
        esac
    done <"$1"
    return $ok
}

# Failures that no golden file can make right.
check_crash()
{
    local status=$1 mine=$2 ok=0
    if [ "$status" -eq 124 ] && [ -n "$limit" ]; then
        echo "no end after ${WRT_TIMEOUT:-60} seconds"
        ok=1
    elif [ "$status" -ge 128 ]; then
        echo "ended with status $status"
        ok=1
    fi
    if [ -s "$mine/crashes" ]; then
        cat "$mine/crashes"
        ok=1
    fi
    if compgen -G "$mine/sanitizer.*" >/dev/null; then
        head -n 60 "$mine"/sanitizer.*
        ok=1
    elif grep -qE 'AddressSanitizer|LeakSanitizer|ThreadSanitizer|runtime error:' "$mine/out" "$mine/err"; then
        echo "sanitizer report in the output"
        ok=1
    fi
    return $ok
}

record()
{
    local case_dir=$1 mine=$2 part
    for part in out err exit; do
        if [ -s "$mine/$part" ]; then
            cmp -s "$mine/$part" "$case_dir/$part" || cp "$mine/$part" "$case_dir/$part"
        else
            rm -f "$case_dir/$part"
        fi
    done
}

run_case()
{
    local case_dir=$1 work=$2 update=$3 name mine status
    name=${case_dir#"$here"/}
    mine=$work/$name
    mkdir -p "$mine"
    cp -R "$case_dir" "$mine/run"
    [ -w "$case_dir/cmd" ] || chmod -R u+w "$mine/run"
    cd "$mine/run" && rm -f cmd out err exit files needs
    if [ -f "$case_dir/needs" ] && ! sh "$case_dir/needs" >/dev/null 2>&1; then
        echo skip >"$mine/result"
        return
    fi

    export WRT_CRASHES=$mine/crashes
    export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}log_path=$mine/sanitizer:exitcode=134"
    export UBSAN_OPTIONS="${UBSAN_OPTIONS:+$UBSAN_OPTIONS:}log_path=$mine/sanitizer:print_stacktrace=1:exitcode=134"
    PATH=$work/bin:$PATH $limit sh "$case_dir/cmd" >"$mine/out" 2>"$mine/err" </dev/null
    status=$?
    [ $status = 0 ] || echo $status >"$mine/exit"
    portable "$mine/out" "$mine/err"

    {
        local ok=0
        check_crash $status "$mine" || ok=1
        if [ "$update" = yes ] && [ $ok = 0 ]; then
            record "$case_dir" "$mine"
        fi
        compare "$case_dir/exit" "$mine/exit" "exit status" || ok=1
        compare "$case_dir/out" "$mine/out" "out" || ok=1
        compare "$case_dir/err" "$mine/err" "err" || ok=1
        [ ! -f "$case_dir/files" ] || check_files "$case_dir/files" || ok=1
    } >"$mine/report"
    if [ $ok = 0 ]; then echo pass; else echo fail; fi >"$mine/result"
    rm -rf "$mine/run"
}

# --cases WORK UPDATE CASE...
if [ "${1-}" = --cases ]; then
    work=$2 update=$3
    shift 3
    for case_dir; do
        (run_case "$case_dir" "$work" "$update")
    done
    exit 0
fi

# ---- all cases ----------------------------------------------------------------------------------

update=no
if [ "${1-}" = --update ]; then
    update=yes
    shift
    if [ -n "${WRT_WRAPPER-}" ]; then
        echo "run.sh: --update records the plain program: unset WRT_WRAPPER" >&2
        exit 2
    fi
fi
[ -x "$WRT" ] || { echo "run.sh: no program $WRT: build it, or set WRT" >&2; exit 1; }
WRT=$(cd "$(dirname "$WRT")" && pwd)/$(basename "$WRT")

work=$(mktemp -d "${TMPDIR:-/tmp}/wrt-cli.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM

# The wrapper tells of crashes that the commands around them would hide.
mkdir "$work/bin"
cat >"$work/bin/wrt" <<'END'
#!/bin/sh
$WRT_WRAPPER "$WRT" "$@"
status=$?
case $status in
132 | 134 | 135 | 136 | 139) echo "wrt $*: crashed with status $status" >>"$WRT_CRASHES" ;;
esac
exit $status
END
chmod +x "$work/bin/wrt"
export WRT_WRAPPER=${WRT_WRAPPER-}

for place in "${@:-.}"; do
    if [ ! -d "$here/$place" ]; then
        echo "run.sh: no case or area $place" >&2
        exit 2
    fi
    find "$here/$place" -type f -name cmd
done | sed "s|/\./|/|; s|/cmd\$||" | sort -u | awk -v every="${WRT_EVERY:-1}" 'NR % every == 0' >"$work/cases"

cores=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)
tr '\n' '\0' <"$work/cases" | xargs -0 -n 8 -P "$cores" "$BASH" "$here/run.sh" --cases "$work" $update

passed=0 failed=0 skipped=0
while IFS= read -r case_dir; do
    name=${case_dir#"$here"/} result=
    [ ! -f "$work/$name/result" ] || read -r result <"$work/$name/result"
    case $result in
    pass) passed=$((passed + 1)) ;;
    skip)
        skipped=$((skipped + 1))
        echo "SKIP $name: needs $(tr '\n' ' ' <"$case_dir/needs")"
        ;;
    *)
        failed=$((failed + 1))
        echo "FAIL $name"
        sed 's/^/    /' "$work/$name/report" 2>/dev/null
        ;;
    esac
done <"$work/cases"

echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ] && [ $((passed + skipped)) -gt 0 ]
