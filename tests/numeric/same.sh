#!/usr/bin/env bash
# The same bytes whatever the threads, with and without the tree of boxes, with and without every
# skip, and for a crop: over all scenes at hand, in small; larger with WRT_FULL set or --full.
set -u
full=${WRT_FULL:-}
[ "${1:-}" = --full ] && full=1
wrt=${WRT:-build/wrt}
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
original=${WRT_SHARED:-$top/../shared}/original
scenes=("$top"/scenes/*.xml "$top"/examples/*.wrt)
if [ -d "$original" ]; then
    scenes+=("$original"/*.xml)
else
    echo "SKIP: the original's scenes are not here ($original); only our own were rendered"
fi

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT

width=40 height=30
[ -n "$full" ] && width=160 height=120

# render NAME OPTIONS...: the scene at a small size into $tmp/NAME.ppm
render()
{
    local name=$1
    shift
    "$wrt" render -q "$scene" --res "${width}x$height" -o "$tmp/$name.ppm" "$@" || echo "$scene: $* failed"
}

passed=0 failed=0 skipped=0

# note SAME WHAT: counts, and names what differs.
note()
{
    if [ -n "$1" ]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "$scene: ${*:2}: other bytes"
    fi
}

# compare WHOLE OTHER OPTIONS...: the picture with these options against one already rendered.
compare()
{
    render "$2" "${@:3}"
    note "$(cmp -s "$tmp/$1.ppm" "$tmp/$2.ppm" && echo same)" "${@:3}"
}

# The instruction sets of this machine but the one that is used anyway.
others=
for isa in plain generic avx2; do
    "$wrt" render "${scenes[0]}" --res 1x1 -o "$tmp/x.ppm" --isa $isa 2>/dev/null && others="$others $isa"
done

# check_scene: all that is compared of one.
check_scene()
{
    if "$wrt" render "$scene" --res 1x1 -o "$tmp/x.ppm" 2>&1 | grep -q 'was built without'; then
        echo "SKIP: $(basename "$scene") needs what this wrt was built without"
        skipped=$((skipped + 1))
        return
    fi
    render whole -t 1
    if [ -n "$full" ]; then
        compare whole other -t 2
        compare whole other -t 7
        compare whole other --no-skip
    else
        compare whole other -t 7 --no-skip
    fi
    if [ -n "${scene##*/examples/*}" ]; then
        compare whole other --accel none
    else
        # the slowest scenes: without the tree only a few pixels
        local wide=$width high=$height
        width=$((wide / 5)) height=$((high / 5))
        render small -t 1
        compare small other --accel none
        width=$wide height=$high
    fi
    if [ -n "$full" ] || [ -n "${scene##*/examples/*}" ]; then # instruction sets of these in the long run
        for isa in $others; do
            compare whole other --isa "$isa"
        done
    fi
    render jittered -t 1 -s 2 --jitter
    compare jittered other -t 3 -s 2 --jitter --no-skip
    # the middle of the picture, cut out of the whole
    render part --crop 10,8,31,20
    {
        printf 'P6\n21 12\n255\n'
        for ((y = 8; y < 20; y++)); do
            tail -c "$((3 * width * (height - y)))" "$tmp/whole.ppm" | tail -c +31 | head -c 63
        done
    } >"$tmp/cut.ppm"
    note "$(cmp -s "$tmp/part.ppm" "$tmp/cut.ppm" && echo same)" --crop
}

# check_share K: every second scene, in a folder of its own; counts go to a file.
check_share()
{
    tmp=$tmp/$1
    mkdir "$tmp"
    for ((i = $1; i < ${#scenes[@]}; i += 2)); do
        scene=${scenes[i]}
        check_scene
    done
    echo "$passed $failed $skipped" >"$tmp/counts"
}

check_share 0 &
check_share 1 &
wait
for share in 0 1; do
    read -r p f s <"$tmp/$share/counts" || f=1
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
done
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" = 0 ]
