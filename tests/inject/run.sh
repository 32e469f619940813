#!/usr/bin/env bash
# Every allocation and every call to the system fails in turn, in every command: the run ends with
# status 3 and a message, or does all of its work in spite of it; nothing leaks, no file is harmed, and
# none is left behind.
#
#   run.sh [--full] [RUN...]     --full: each call, instead of a few
#
# A line of runs.txt is a name and a command; it runs in a copy of the folder that `stage` makes.
# What it does undisturbed is what it is compared with.  inject.c makes the calls fail.
set -u
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
srcdir=$(cd "$here/../.." && pwd)
WRT=${WRT:-$srcdir/build/wrt}
inject=${INJECT_LIBRARY:-$(dirname "$WRT")/tests/inject/inject.so}
full=
[ "${1-}" = --full ] && full=yes && shift
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" && ln -s "$(realpath "$WRT")" "$work/bin/wrt"

if ! LD_PRELOAD=$inject INJECT=alloc:0 INJECT_LOG=$work/log "$WRT" --version >/dev/null 2>&1 || ! [ -s "$work/log" ]; then
    echo "inject: nothing can be preloaded into $WRT: skipped"
    exit 77
fi

# shellcheck source=/dev/null
. "$here/stage.sh"
mkdir "$work/stage" && (cd "$work/stage" && stage "$srcdir") || { echo 'inject: no stage'; exit 1; }

# attempt FOLDER WHAT COMMAND: leaves FOLDER, FOLDER.out, FOLDER.err, FOLDER.log; returns the status.
attempt()
{
    rm -rf "$1"
    cp -a "$work/stage" "$1"
    (
        cd "$1" || exit 1
        PATH=$work/bin:$PATH
        eval "timeout 20 env LD_PRELOAD=\$inject INJECT=\$2 INJECT_LOG=\$1.log $3" >"$1.out" 2>"$1.err"
        echo $? >"$1.status"
    ) </dev/null
    # Not $?: once process numbers come round, bash may tell an older process's.
    local status
    status=$(<"$1.status")
    # Times and memory are others each time.
    [ ! -s "$1.out" ] || sed -Ei 's/"([a-z]+_s|peak|peak_rss_bytes)": [0-9.e-]+/\1/; s/peak [0-9.]+ MB/peak/' "$1.out"
    return $status
}

# unharmed STATUS: every file is as it was, or as it is to be.
unharmed()
{
    local line name
    while read -r line; do
        case $line in
        "Files $work/now/"*) name=${line#"Files $work/now/"} name=${name%% *} ;;
        "Only in $work/now: "*) name=${line#*: } ;;
        "Only in $work/stage: "*) # gone, as it is when all goes well
            [ "$1" = 0 ] && [ ! -e "$work/good/${line#*: }" ] && continue
            complaint=$line
            return 1
            ;;
        *) complaint=$line; return 1 ;;
        esac
        # What is finished of a long render is kept when it ends early: that is the use of these.
        [[ $name != *.journal && $name != *frames* ]] || continue
        cmp -s "$work/now/$name" "$work/good/$name" || {
            complaint="$name is harmed or left behind"
            return 1
        }
    done < <(diff -rq "$work/now" "$work/stage")
}

# field FILE NAME: prints the number behind the name.
field()
{
    local name number
    while read -r name number; do
        [ "$name" != "$2" ] || echo "$number"
    done <"$1"
}

right()
{
    local status=$1 usual=$2 said
    { said=$(<"$work/now.err")$(<"$work/now.out"); } 2>/dev/null # pictures hold NULs
    unharmed "$status" || return 1
    [[ $said == *'out of memory'* ]] || [ "$(field "$work/now.log" live)" -le $((live + streams)) ] || {
        complaint="$(field "$work/now.log" live) blocks leak"
        return 1
    }
    if [ "$status" = 3 ]; then
        [[ $said == *error* ]] && return
        complaint='no message'
    elif [ "$status" != "$usual" ]; then
        complaint="exit status $status"
    elif ! cmp -s "$work/now.out" "$work/good.out" || ! diff -rq "$work/now" "$work/good" >"$work/difference"; then
        complaint='the failure is not told, and the result is another'
    else
        return 0
    fi
    return 1
}

# The numbers of the calls of a kind that are to fail, of N: all, or of memory and one other kind one
# that is another for each run.
chosen()
{
    local kind=$1 n=$2
    if [ -n "$full" ]; then
        seq "$n"
    elif [ "$n" -gt 0 ] && { [ "$kind" = alloc ] || [ $((place % 11)) = $((turn % 11)) ]; }; then
        echo $((turn * 7 % n + 1))
    fi
}

# try WHAT: a call fails, in the command at hand.
try()
{
    attempt "$work/now" "$1" "$command"
    local status=$?
    count=$((count + 1))
    right $status $usual && return
    echo "FAIL $name, $1 of $n: $complaint: $command"
    head -n 3 "$work/now.err"
    failed=$((failed + 1))
}

# Blocks of OpenMesh's streams, which stay when the C library cannot remember to end them.
streams=4

count=0 failed=0 turn=0
while read -r name kinds command; do
    case $name in '' | '#'*) continue ;; esac
    [ $# = 0 ] || [[ " $* " == *" $name "* ]] || continue
    turn=$((turn + 1))
    attempt "$work/good" alloc:0 "$command"
    usual=$?
    # what is wrong from the start would try little
    [ $usual = 0 ] || [[ $usual = 1 && $name == @(*-mistakes|diff-scenes) ]] || { echo "FAIL $name: exit status $usual undisturbed"; head -n 3 "$work/good.err"; failed=$((failed + 1)); }
    live=$(field "$work/good.log" live) place=0
    while read -r kind n; do
        place=$((place + 1))
        [[ ,$kinds, == *,all,* ]] || [[ ,$kinds, == *,$kind,* ]] || continue
        [[ $kind != live && $kind != failed ]] || continue
        for i in $(chosen "$kind" "$n"); do
            try "$kind:$i"
            [ "$kind" != alloc ] || [ $((i % 5)) != 0 ] || try "$kind+:$i"
        done
    done <"$work/good.log"
done <"$here/runs.txt"
[ $count != 0 ] || { echo "inject: no such run"; exit 1; }
echo "inject: $count failing calls, $failed not handled"
[ $failed = 0 ]
