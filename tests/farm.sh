#!/usr/bin/env bash
# Renders that end early and go on, and pictures made of parts: always the same bytes.  A render is
# killed at random moments, ended by signals, its journal damaged; parts are joined in any order.
#
#   farm.sh [--full]     200 kills instead of a few; WRT_SEED repeats a run
set -u
full=${WRT_FULL:-}
[ "${1:-}" = --full ] && full=1
wrt=${WRT:-build/wrt}
[ -x "$wrt" ] || { echo "farm: no program $wrt" >&2; exit 1; }
wrt=$(cd "$(dirname "$wrt")" && pwd)/$(basename "$wrt")
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
kills=3 damages=2 ways_of_parts=1
[ -n "$full" ] && kills=200 damages=20 ways_of_parts=4
RANDOM=${WRT_SEED:=$$}

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
cd "$tmp" || exit 1
failed=0
complain()
{
    echo "farm: $* (WRT_SEED=$WRT_SEED)"
    failed=1
}

scene=$top/examples/mirrors.wrt
# Ways to render, each of which another part of the program cuts into tiles.
ways=("--res 160x120 -s 2 --jitter" "--res 160x120 --adaptive=0.02" "--res 300x200 --crop 13,9,211,150"
    "--res 200x150 --bits 16" "--res 100x75 --adaptive=0.02 --jitter --exposure 1")

# render FILE OPTIONS...
render() { "$wrt" render -q "$scene" -o "$@"; }

# Kills at random moments until so many have hit a render under way.
killed=0 round=0
while [ $killed -lt "$kills" ] && [ $round -lt $((10 * kills)) ]; do
    read -ra way <<<"${ways[round++ % ${#ways[@]}]}"
    render whole.png "${way[@]}" || complain "${way[*]} failed"
    for ((tries = 0; tries < 40; tries++)); do
        "$wrt" render -q "$scene" -o again.png "${way[@]}" --checkpoint journal --resume &
        pid=$!
        sleep "0.$(printf '%03d' $((40 + RANDOM % 160)))"
        kill -KILL $pid 2>/dev/null
        wait $pid 2>/dev/null
        status=$?
        [ $status = 0 ] && break
        [ $status = 137 ] || complain "${way[*]}: status $status"
        killed=$((killed + 1))
    done
    [ $status = 0 ] || render again.png "${way[@]}" --checkpoint journal --resume || complain "no end"
    cmp -s whole.png again.png || complain "${way[*]}: other bytes after being killed"
    [ ! -e journal ] || complain "the journal is still there"
    rm -f again.png journal
done 2>killed.log
grep -v Killed killed.log
[ $killed -ge "$kills" ] || complain "only $killed renders were long enough to be killed"

# A signal saves the journal and the picture so far; the second ends the program at once.
slow=(--res 300x200 -s 3)
render whole.png "${slow[@]}"
for signal in INT TERM; do
    expected=$((128 + $(kill -l $signal)))
    # a shell's jobs ignore SIGINT: one that does not starts them
    env --default-signal=INT "$wrt" render -q "$scene" -o picture.png "${slow[@]}" --checkpoint journal \
        2>err &
    pid=$!
    until [ -s journal ] || ! kill -0 $pid; do sleep 0.01; done
    sleep 0.05
    kill -$signal $pid
    wait $pid
    status=$?
    [ $status = $expected ] || complain "SIG$signal: status $status, not $expected"
    [ -s picture.partial.png ] && [ -s journal ] && [ ! -e picture.png ] ||
        complain "SIG$signal left $(echo *)"
    grep -q "^wrt: ended by SIG$signal with .* % of the picture, which is in 'picture.partial.png'" err || complain "said: $(cat err)"
    render picture.png "${slow[@]}" --checkpoint journal --resume
    cmp -s whole.png picture.png || complain "SIG$signal: other bytes"
    [ ! -e picture.partial.png ] || complain "SIG$signal: the picture so far is still there"
    rm -f picture* journal
done

# What is kept when a signal ends other renders, and what is not, is said.
cp "$scene" film.wrt
sed -i "s|\"../|\"$top/|; s/^model .*/&\nparam frame = 0/" film.wrt
pids=() said=()
# ends_saying WHAT OPTIONS...
ends_saying()
{
    said+=("$1")
    shift
    env --default-signal=INT "$wrt" render -q "$@" >/dev/null 2>"err${#said[@]}" &
    pids+=($!)
}
slow=(--res 900x700 -s 9)
ends_saying '% of the picture; nothing of it was kept' "$scene" "${slow[@]}" -o -
ends_saying '% of the part; nothing of it was kept' "$scene" "${slow[@]}" --part 1/2 -o part
ends_saying "% of the part; --checkpoint 'journal' --resume goes on" "$scene" "${slow[@]}" --part 1/2 --checkpoint journal
ends_saying "before the time was over; the picture so far is in 'timed.partial.png'" "$scene" --time 60 -o timed.png
ends_saying "'film-0001.partial.png'; --checkpoint 'film-%d' --resume goes on" film.wrt "${slow[@]}" --frames 1..2 --checkpoint film-%d
for pid in "${pids[@]}"; do
    for ((i = 0; i < 500; i++)); do # until SIGINT, the second bit, is caught
        [[ $(sed -n 's/^SigCgt:[^0-9a-f]*//p' "/proc/$pid/status") =~ [2367abef]$ ]] && break
        sleep 0.02
    done
done 2>/dev/null
kill -INT "${pids[@]}"
wait
for ((i = 0; i < ${#said[@]}; i++)); do
    grep -qF -- "${said[i]}" "err$((i + 1))" || complain "not '${said[i]}', but: $(cat "err$((i + 1))")"
done
"$wrt" film.wrt -q --res 8x6 --frames 1..1 && [ ! -e film-0001.partial.png ] ||
    complain "the frame so far is still there"
rm -f film* journal timed* part err?

# A part that is torn or damaged at any byte is not used.
render part --res 80x60 --part 1/1
size=$(wc -c <part)
for n in 0 5 $((RANDOM % 200)) $((RANDOM % size)) $((size - 1)); do
    head -c "$n" part >torn
    "$wrt" merge torn -o torn.png 2>err && complain "a part of $n bytes of $size was taken"
    grep -q "E302-other-tiles" err || complain "a part of $n bytes: $(cat err)"
    [ ! -e torn.png ] || complain "a torn part made a picture"
done
for ((i = 0; i < damages; i++)); do
    at=$((RANDOM % size))
    {
        head -c $at part
        printf '\252'
        tail -c +$((at + 2)) part
    } >damaged
    cmp -s part damaged && continue
    "$wrt" merge damaged -o damaged.png 2>err && complain "a part damaged at byte $at was taken"
    [ ! -e damaged.png ] || complain "a damaged part made a picture"
done

# A journal that is torn or damaged at any byte behind its head is used as far as it is whole.
slow=(--res 140x105 -s 3)
render whole.png "${slow[@]}"
for ((i = 0; i < damages; i++)); do
    "$wrt" render -q "$scene" "${slow[@]}" -o picture.png --checkpoint journal 2>/dev/null &
    pid=$!
    sleep 0.2
    kill -TERM $pid 2>/dev/null
    wait $pid 2>/dev/null
    [ -s journal ] || continue
    size=$(wc -c <journal)
    at=$((RANDOM % size))
    if [ $((i % 2)) = 0 ]; then
        truncate -s "$at" journal
    else
        at=$((at > 300 ? at : 300))
        printf '\252\252\252\252' | dd of=journal bs=1 seek=$at conv=notrunc status=none
    fi
    render picture.png "${slow[@]}" --checkpoint journal --resume ||
        complain "a journal damaged at byte $at of $size was not resumed"
    cmp -s whole.png picture.png || complain "a journal damaged at byte $at of $size: other bytes"
    rm -f picture* journal
done

# Parts in any order; more parts than tiles; parts of adaptive pictures.
ways=("--res 80x60 --adaptive=0.02" "--res 160x120" "--res 20x15" "--res 160x120 --show depth")
for way in "${ways[@]:0:ways_of_parts}"; do
    read -ra options <<<"$way"
    render whole.png "${options[@]}"
    for i in 7 3 1 2 6 5 4; do
        render "part$i" "${options[@]}" --part $i/7
    done
    "$wrt" merge part7 part1 part3 part2 part5 part4 part6 -o parts.png || complain "merge failed"
    cmp -s whole.png parts.png || complain "$way: 7 parts make other bytes"
done
"$wrt" merge part[1-46-7] -o missing.png 2>err && complain "a missing part was not missed"
grep -q 'of 7 parts, 5 is missing' err || complain "a missing part: $(cat err)"

# Frames: what does not change is read once, which a pipe shows; one at a time they are the same.
mkfifo mesh.off
cat >film.wrt <<'END'
wrt 1
model modern
param frame = 0
param time = 0.0
param file = "mesh.off"
camera { eye: (0, 3, 9 - time) look_at: (0, 0, 0) up: (0, 1, 0) fov: 40 resolution: (60, 45) }
light sun { direction: (1, -2, -1) intensity: 2 }
for i in range(4) {
    mesh { file: file smooth: true position: (2 * i - 3, floor(frame / 2), 0)
           material: lambert { diffuse: 1 } }
}
END
cat "$top/scenes/assets/pot.off" >mesh.off &
timeout 60 "$wrt" film.wrt --frames 1..4 || complain "a mesh is read more than once"
rm mesh.off
for frame in 1 4; do
    "$wrt" film.wrt -D file="$top/scenes/assets/pot.off" -D frame=$frame \
        -D time="$(awk "BEGIN { printf \"%.17g\", $frame / 24 }")" -o one.png
    cmp -s one.png film-000$frame.png || complain "frame $frame differs from the picture by itself"
done

[ $failed = 0 ]
