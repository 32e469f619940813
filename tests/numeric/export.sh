#!/usr/bin/env bash
# POV-Ray and Tachyon see in converted scenes what wrt sees in the scenes: the same pixels are
# covered, and for POV-Ray the colours are near, too (root mean square; its textures, area lights
# and unclamped light differ a little; all scenes with WRT_FULL set or --full).  Every number is printed.
set -u
wrt=${WRT:-build/wrt}
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
coverage=$(dirname "$wrt")/tests/numeric/coverage
least=99.9    # percent of pixels that agree; measured: 100
declare -A farthest
farthest[classic]=0.12 # measured: 0.117 with thin cylinders all over, else 0.071 at most
farthest[modern]=0.05  # measured: 0.042

missing=
command -v povray >/dev/null || missing="$missing povray"
command -v tachyon >/dev/null || missing="$missing tachyon"
[ -z "$missing" ] || echo "SKIP: not installed, so not compared with:$missing"
case $missing in *povray*tachyon*) exit 77 ;; esac

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
failed=0
complain()
{
    echo "$1"
    failed=1
}

# Whatever the materials are, white shows what is hit.
white_pov()
{
    sed '1a#declare White = texture { pigment { rgb 1 } finish { diffuse 0 emission 1 } }
         /^#declare M/s/ = .*/ = material { texture { White } }/
         /^#declare M/!s/ material { texture .*/ material { texture { White } } }/
         /^background/d' "$1"
}

with_povray()
{
    "$wrt" convert -q "$scene" -o "$tmp/a.pov" || return 1
    white_pov "$tmp/a.pov" >"$tmp/white.pov"
    (cd "$tmp" && povray white.pov +Omask.png "+W$width" "+H$height" -A -D &&
        povray a.pov +Opicture.png "+W$width" "+H$height" +A0.3 -D) >"$tmp/log" 2>&1 || {
        tail -n 5 "$tmp/log"
        return 1
    }
    "$wrt" render -q "$scene" --res "${width}x$height" -s 2 -o "$tmp/ours.png" || return 1
    colours=$("$coverage" "$tmp/ours.png" "$tmp/picture.png" --colours)
}

# At a resolution other than the file's, samples would not lie in the middle of pixels.
with_tachyon()
{
    "$wrt" convert -q "$scene" -o "$tmp/a.dat" || return 1
    (cd "$tmp" && tachyon a.dat -lowestshade -format PNG -o mask.png) >"$tmp/log" 2>&1
    if grep -qi error "$tmp/log"; then
        tail -n 5 "$tmp/log"
        return 1
    fi
}

# judge NAME WIDTH HEIGHT: the mask against wrt's depths.
judge()
{
    local times=$([ $model = modern ] && echo 1 || echo 2)
    "$wrt" render -q "$scene" --show depth --res "$((times * $2))x$((times * $3))" -s 1 \
        -o "$tmp/depth.ppm" || return
    read -r alike covered < <("$coverage" "$tmp/mask.png" "$tmp/depth.ppm")
    printf '%-24s %-8s %6s %% of pixels agree, %6s %% covered%s\n' "$(basename "$scene")" "$1" \
        "$alike" "$covered" "${colours:+, colours differ by $colours}"
    awk "BEGIN { exit !($alike >= $least) }" </dev/null || complain "$scene: $1 covers other pixels"
    [ -z "$colours" ] || awk "BEGIN { exit !($colours <= ${farthest[$model]}) }" </dev/null ||
        complain "$scene: $1 makes other colours"
}

# The largest picture of the scene's exact proportions that is at most 200 pixels wide.
shrink()
{
    local k=$(((full + 199) / 200))
    while [ $((full % k)) != 0 ] || [ $((full_height % k)) != 0 ]; do
        k=$((k + 1))
    done
    width=$((full / k)) height=$((full_height / k))
}

modern=$top/tests/numeric/modern.wrt
scenes=("$top"/scenes/{quads,cylinders_tilted,mesh_smooth,textures,compat,wide_picture,refraction}.xml
    "$modern" "$top"/examples/{cornell,still_life,tutorial}.wrt)
if [ -n "${WRT_FULL:-}" ] || [ "${1:-}" = --full ]; then
    scenes=("$top"/scenes/*.xml "$modern" "$top"/examples/*.wrt)
fi
for scene in "${scenes[@]}"; do
    read -r full full_height < <("$wrt" convert -q "$scene" -o - --to pov |
        sed -n '1s/.*+W\([0-9]*\) +H\([0-9]*\) .*/\1 \2/p')
    model=$("$wrt" convert -q "$scene" -o - --to json | sed -n '1s/.*"model":"\([a-z]*\)".*/\1/p')
    shrink
    colours=
    if command -v povray >/dev/null; then
        if with_povray; then judge povray $width $height; else complain "$scene: povray failed"; fi
    fi
    colours=
    if command -v tachyon >/dev/null; then
        if with_tachyon; then judge tachyon "$full" "$full_height"; else complain "$scene: tachyon failed"; fi
    fi
done
[ $failed = 0 ]
