#!/usr/bin/env bash
# Scenes and files made to be as costly as can be: each ends in its time, within its memory, and as it
# should.
#
#   run.sh [--full] [ROW...]     --full: the slow rows, too
#
# A row is a line of rows.txt: a name, quick or full, the megabytes and seconds it may take, the exit
# status, and the command.  The function `make_NAME` writes its input to the standard input of the
# command, or files into the folder where it runs.  Memory is that of `ulimit -v`; the seconds are
# generous, a hundred times what a quick machine takes.
set -u
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
WRT=${WRT:-$here/../../build/wrt}
full=
[ "${1-}" = --full ] && full=yes && shift
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" && ln -s "$(realpath "$WRT")" "$work/bin/wrt"
PATH=$work/bin:$PATH

# shellcheck source=/dev/null
. "$here/inputs.sh"

# Sanitizers map terabytes and take their time.
limited=yes slowness=1
(ulimit -v 3000000 && wrt --version) >/dev/null 2>&1 || { limited='' slowness=10; }

run_row()
{
    local name=$1 megabytes=$2 seconds=$3 status=$4 got
    shift 4
    mkdir "$work/$name" && cd "$work/$name" || exit 1
    "make_${name//-/_}" >input || exit 1
    (
        [ -z "$limited" ] || ulimit -v $((megabytes * 1024)) || exit 1
        exec timeout -k 2 $((slowness * seconds)) sh -c "$*" <input >out 2>err
    )
    got=$?
    cd "$work" || exit 1
    if [ $got != "$status" ]; then
        echo "FAIL $name: exit status $got instead of $status: $*"
        head -n 3 "$name/err" | cut -c 1-300
        failed=$((failed + 1))
    elif [ "$status" != 0 ] && ! grep -q 'error:' "$name/err" "$name/out"; then
        echo "FAIL $name: no message"
        failed=$((failed + 1))
    fi
    count=$((count + 1))
    rm -rf "${work:?}/$name"
}

count=0 failed=0
while read -r name speed megabytes seconds status command; do
    case $name in '' | '#'*) continue ;; esac
    [ $# = 0 ] || [[ " $* " == *" $name "* ]] || continue
    [ $# != 0 ] || [ -n "$full" ] || [ "$speed" = quick ] || continue
    start=$(date +%s%N)
    run_row "$name" "$megabytes" "$seconds" "$status" "$command" </dev/null
    [ -z "${VERBOSE-}" ] || echo "$name: $((($(date +%s%N) - start) / 1000000)) ms"
done <"$here/rows.txt"
[ $count != 0 ] || { echo "hostile: no such row"; exit 1; }
echo "hostile: $count inputs, $failed failed"
[ $failed = 0 ]
