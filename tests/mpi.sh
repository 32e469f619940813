#!/usr/bin/env bash
# One picture by 1, 2 and 4 processes of MPI, more than this machine may have processors: the same
# bytes.  A process is killed, and the journal goes on.
set -u
wrt=${WRT:-build/wrt}
[ -x "$wrt" ] || { echo "mpi: no program $wrt" >&2; exit 1; }
wrt=$(cd "$(dirname "$wrt")" && pwd)/$(basename "$wrt")
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
scene=$top/examples/mirrors.wrt
if "$wrt" "$scene" --mpi -o /dev/null 2>&1 | grep -q 'built without MPI'; then
    echo "SKIP mpi: this wrt was built without MPI: ./configure --with-mpi"
    exit 77
fi
if ! command -v mpirun >/dev/null; then
    echo "SKIP mpi: mpirun is not installed"
    exit 77
fi
# Open MPI wants to be told that it may; MPICH does not care.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
cd "$tmp" || exit 1
failed=0
complain()
{
    echo "mpi: $*"
    failed=1
}

for way in "--res 160x120" "--res 120x90 --adaptive=0.02" "--res 100x75 --show depth --bits 16"; do
    read -ra options <<<"$way"
    "$wrt" -q "$scene" "${options[@]}" -o whole.png
    for n in 1 2 4; do
        timeout 120 mpirun -n $n "$wrt" -q "$scene" "${options[@]}" --mpi -o shared.png 2>err ||
            complain "$way: $n processes: $(cat err)"
        cmp -s whole.png shared.png || complain "$way: other bytes of $n processes"
        rm -f shared.png
    done
done

# frames, each with a journal, and parts of a picture
cat >film.wrt <<'END'
wrt 1
model modern
param frame = 0
camera { eye: (0, 0, 9) look_at: (0, 0, 0) up: (0, 1, 0) fov: 40 resolution: (60, 45) }
light sun { direction: (1, -2, -1) intensity: 2 }
sphere { center: (frame, 0, 0) radius: 1 material: lambert { diffuse: 1 } }
END
timeout 120 mpirun -n 2 "$wrt" film.wrt --mpi --frames 1..3 --checkpoint journal-%d || complain "frames"
"$wrt" film.wrt -D frame=2 -o 2.png
cmp -s 2.png film-0002.png || complain "a frame has other bytes"
[ "$(wc -l <film-frames.png.txt)" = 3 ] || complain "frames are noted more than once"
timeout 120 mpirun -n 2 "$wrt" film.wrt --mpi --frames 1..3 -v 2>err
[ "$(grep -c 'is there and stays' err)" = 3 ] || complain "frames were not kept: $(cat err)"
"$wrt" film.wrt --part 1/2 -o 1
timeout 120 mpirun -n 2 "$wrt" film.wrt --mpi --part 2/2 -o 2
"$wrt" merge 1 2 -o merged.png
"$wrt" film.wrt -o whole.png
cmp -s whole.png merged.png || complain "a part has other bytes"

# an error is told once
echo 'sphere {' >wrong.wrt
timeout 120 mpirun -n 3 "$wrt" wrong.wrt --mpi 2>err && complain "a wrong scene was rendered"
[ "$(grep -c 'error:' err)" = 1 ] || complain "an error is not told once: $(cat err)"

mkdir list-frames.png.txt
timeout 120 mpirun -n 3 "$wrt" film.wrt --mpi --frames 1..2 -o list-%d.png 2>err
[ "$(grep -c 'could not read the list of frames' err)" = 1 ] || complain "a list of frames that is none: $(cat err)"

# A process is killed: mpirun ends them all, and the journal makes the lost job whole.
slow=(--res 320x240 -s 3)
"$wrt" -q "$scene" "${slow[@]}" -o whole.png
mpirun -n 3 "$wrt" -q "$scene" "${slow[@]}" --mpi -o shared.png --checkpoint journal >log 2>&1 &
job=$!
for ((i = 0; i < 100; i++)); do
    [ "$({ wc -c <journal; } 2>/dev/null || echo 0)" -gt 5000 ] && break
    sleep 0.05
done
victim=$(pgrep -P "$job" -f "$scene" | tail -n 1)
kill -KILL "$victim"
wait $job && complain "the job went on without a process"
[ -s journal ] || complain "no journal is left"
timeout 120 mpirun -n 2 "$wrt" -q "$scene" "${slow[@]}" --mpi -o shared.png --checkpoint journal --resume ||
    complain "could not go on"
cmp -s whole.png shared.png || complain "other bytes after a process was killed"

[ $failed = 0 ]
