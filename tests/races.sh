#!/usr/bin/env bash
# Scenes of every kind on eight threads, whole, adaptive and in a limited time: for a wrt built with
# ThreadSanitizer, which ends with status 66 where two threads meet.  The bytes are those of one thread.
set -u
cd "${srcdir:-$(dirname "$0")/..}" || exit 1
WRT=${WRT:-build/wrt}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
failed=0 count=0

# run NAME ARGUMENTS
run()
{
    local name=$1
    shift
    count=$((count + 1))
    TSAN_OPTIONS=halt_on_error=1 timeout 300 "$WRT" render -q -t 8 "$@" -o "$work/$name.ppm" 2>"$work/err" || {
        echo "FAIL $name: exit status $?: wrt render -t 8 $*"
        head -n 30 "$work/err"
        failed=1
    }
}

for scene in scenes/*.xml examples/*.wrt; do
    name=$(basename "$scene")
    run "$name" "$scene" --res 64x48
    run "$name-adaptive" "$scene" --res 40x30 --adaptive=0.02
done
for scene in scenes/cornell.xml examples/chess.wrt; do
    [ -f "$scene" ] || continue
    run "$(basename "$scene")-time" "$scene" --res 64x64 --time 2
    run "$(basename "$scene")-jitter" "$scene" --res 64x64 -s 2 --jitter
    run "$(basename "$scene")-plain" "$scene" --res 32x32 --isa plain --no-skip
done
echo "races: $count pictures, $([ $failed = 0 ] && echo no race || echo races)"
exit $failed
