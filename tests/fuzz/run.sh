#!/usr/bin/env bash
# The inputs that fuzzing starts from, and those that were findings once, through what they are for.
#
#   run.sh                 replays them
#   run.sh --fuzz SECONDS [TARGET...]
#       with a fuzz that is linked with libFuzzer: looks for more, each target so long, in folders of
#       findings and inputs below the current one
set -u
here=$(cd "$(dirname "$0")" && pwd)
fuzz=${FUZZ:-$(dirname "${WRT:-build/wrt}")/tests/fuzz/fuzz}
all='native xml define off obj ply stl uv wrl png jpeg tiles frames lsp'

replay()
{
    local target failed=0 count=0 file
    for target in $all; do
        set -- "$here/corpus/$target"/* "$here/findings/$target"-*
        for file; do
            [ -f "$file" ] || continue
            count=$((count + 1))
        done
        timeout 60 "$fuzz" "$target" $(ls -d "$@" 2>/dev/null) </dev/null || {
            echo "FAIL $target: exit status $?"
            failed=1
        }
    done
    echo "fuzz: $count inputs"
    return $failed
}

look_for_more()
{
    local seconds=$1 target failed=0
    shift
    for target in ${*:-$all}; do
        mkdir -p "inputs/$target" findings
        "$FUZZ_PLAIN" --dictionary "$target" >"$target.dict"
        WRT_FUZZ=$target nice -n 19 "$fuzz" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=3000 \
            -malloc_limit_mb=2000 -max_len=4096 -dict="$target.dict" -artifact_prefix="findings/$target-" \
            -print_final_stats=1 "inputs/$target" "$here/corpus/$target" >"$target.log" 2>&1 || failed=1
        summary "$target"
    done
    return $failed
}

# target, executions, coverage (edges), features, size of the corpus, seconds, findings
summary()
{
    local last
    last=$(grep -E '^#[0-9]+' "$1.log" | tail -n 1)
    printf '%-8s %s; findings: %s\n' "$1" "$last" "$(find findings -name "$1-*" | wc -l)"
}

case ${1-} in
--fuzz) shift; look_for_more "$@" ;;
*) replay ;;
esac
