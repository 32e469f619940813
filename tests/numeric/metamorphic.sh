#!/usr/bin/env bash
# Scenes changed in ways that must not change the picture, or change it in a known way, through the
# command itself: scaled, mirrored, moved, in another order, cut into other tiles, as instances.
#
#     tests/numeric/metamorphic.sh [--full]
#
# --full (or WRT_FULL) tries more of each in larger pictures, and tells how POV-Ray does.
set -u
full=${WRT_FULL:-}
[ "${1:-}" = --full ] && full=1
wrt=${WRT:-build/wrt}
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT

width=48 height=36
[ -n "$full" ] && width=320 height=240
pixels=$((width * height))

passed=0 failed=0 skipped=0

# row WHAT MEASURED BOUND GOOD: a line of the table.
row()
{
    printf '%-58s %10s  %-22s%s\n' "$1" "$2" "$3" "${4:-  FAILED}" | sed 's/yes$//; s/ *$//'
    if [ -n "$4" ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
}

# ---- scenes --------------------------------------------------------------------------------------

# A closed mesh: a ball of quads cut in two.
awk 'BEGIN {
    n = 12; pi = atan2(0, -1)
    printf "OFF\n%d %d 0\n0 1 0\n0 -1 0\n", n * (n - 1) + 2, 2 * n * (n - 1)
    for (i = 1; i < n; i++)
        for (k = 0; k < n; k++)
            printf "%.17g %.17g %.17g\n", sin(pi * i / n) * cos(2 * pi * k / n), cos(pi * i / n),
                sin(pi * i / n) * sin(2 * pi * k / n)
    for (k = 0; k < n; k++) {
        next_k = (k + 1) % n; last = 2 + n * (n - 2)
        printf "3 0 %d %d\n3 1 %d %d\n", 2 + next_k, 2 + k, last + k, last + next_k
        for (i = 0; i < n - 2; i++) {
            a = 2 + i * n
            printf "3 %d %d %d\n3 %d %d %d\n", a + k, a + next_k, a + n + next_k,
                a + n + next_k, a + n + k, a + k
        }
    }
}' >"$tmp/ball.off"

# head MODEL FALLOFF: what stands before the surfaces.  s: scale; x: -1 mirrors; to: moves.
head_of()
{
    local power='1' camera='look_at: at(0.2, 0.8, 0)  fov: 46deg'
    [ "$2" = inverse_square ] && power='s ^ 2 * 50'
    [ "$1" = classic ] && camera='back: (-0.05 * x, 0.19, -1)  up: (0, 1, 0)  yfov: 23'
    cat <<END
wrt 1
model $1
param s = 1
param x = 1
param to = (0, 0, 0)
fn at(a, b, c) = to + s * (x * a, b, c)
texture checker = image { file: "$top/scenes/assets/checker.png" }
camera { eye: at(0.5, 2.2, -7)  $camera  resolution: ($width, $height) }
light point { position: at(-4, 7, -5)  falloff: $2  intensity: $power * (0.8, 0.7, 0.6) }
END
    [ "$1" = modern ] && echo 'settings { background: (0.1, 0.2, 0.3)  ambient: 0.1 }'
    [ "$3" = plain ] || cat <<END
light area { shape: sphere  position: at(4, 5, -3)  size: s  falloff: $2  intensity: $power * 0.4  samples: 2 }
END
}

# Opaque things only, one a line; none touches another in the same points.
plain_surfaces()
{
    cat <<'END'
quad { vertices: [at(-6, 0, -6), at(-6, 0, 6), at(6, 0, 6), at(6, 0, -6)]  material: phong { diffuse: 0.7  specular: 0.1  exponent: 10 } }
sphere { center: at(-1.3, 1.01, 0.4)  radius: s  material: shiny { diffuse: (0.7, 0.3, 0.2)  specular: 0.5  exponent: 30  reflection: 0.3 } }
sphere { center: at(0.4, 0.32, -2.1)  radius: 0.3 * s  material: lambert { diffuse: (0.2, 0.7, 0.3) } }
cylinder { base: at(1.2, 0.3, -0.4)  top: at(1.9, 1.6, 0.2)  radius: 0.4 * s  material: metal { diffuse: (0.6, 0.5, 0.2)  specular: 0.6  exponent: 20  reflection: 0.4 } }
triangle { vertices: [at(-3, 0.2, 3), at(3, 0.4, 3.5), at(0.3, 3.1, 4)]  material: phong { diffuse: (0.3, 0.4, 0.8)  specular: 0.2  exponent: 15 } }
END
}

# Glass, a texture, a mesh and an ellipsoid, too.
surfaces()
{
    plain_surfaces
    cat <<END
sphere { center: at(-0.3, 0.51, -1.7)  radius: 0.5 * s  material: glass { diffuse: 0.05  specular: 0.5  exponent: 60  reflection: 0.1  refraction: 0.85  ior: 1.5 } }
quad { vertices: [at(-5, 0.1, 5), at(-5, 3, 5), at(5, 3, 5), at(5, 0.1, 5)]  uvs: [(0, 0), (0, 2), (3, 2), (3, 0)]  material: lambert { diffuse: 0.9  texture: checker } }
mesh { file: "ball.off"  position: at(2.2, 0.61, -1.6)  scale: 0.6 * s  smooth: true  material: phong { diffuse: (0.6, 0.2, 0.6)  specular: 0.4  exponent: 25 } }
group { translate: at(-2.6, 0.61, -1.3)  rotate: (20deg, 30deg, 40deg)  scale: s * (0.3, 0.6, 0.4)  sphere { center: 0  radius: 1  material: phong { diffuse: (0.8, 0.7, 0.2)  specular: 0.3  exponent: 12 } } }
END
}

for model in classic modern; do
    for falloff in none inverse_square; do
        { head_of $model $falloff whole; surfaces; } >"$tmp/$model.$falloff.wrt"
    done
done
{ head_of modern inverse_square plain; plain_surfaces; } >"$tmp/plain.wrt"

# render SCENE OUT OPTIONS...
render()
{
    "$wrt" render -q --no-warn all "$tmp/$1.wrt" -o "$tmp/$2.ppm" "${@:3}" || echo "$1: $* failed"
}

# ---- pictures ------------------------------------------------------------------------------------

# pixels_of PICTURE: one pixel a line, without the header.
pixels_of()
{
    tail -c "$((3 * pixels))" "$tmp/$1.ppm" | od -An -v -tu1 -w3
}

# flipped PICTURE: the same with each row from right to left.
flipped()
{
    pixels_of "$1" | awk -v w="$width" '
        { pixel[NR % w] = $0 }
        NR % w == 0 { print pixel[0]; for (i = w - 1; i > 0; i--) print pixel[i] }'
}

# far_pixels A B: how many pixels differ by more than 1 in some channel.
far_pixels()
{
    paste <(pixels_of "$1") <(pixels_of "$2") | awk '
        function far(a, b) { return a - b > 1 || b - a > 1 }
        far($1, $4) || far($2, $5) || far($3, $6) { n++ }
        END { print NR == '$pixels' ? n + 0 : NR " pixels" }'
}

# same WHAT A B
same()
{
    row "$1" "" "same bytes" "$(cmp -s "$tmp/$2.ppm" "$tmp/$3.ppm" && echo yes)"
}

# near WHAT A B: at most 1/255 on 99.99 % of the pixels.
near()
{
    local n most=$((pixels / 10000))
    n=$(far_pixels "$2" "$3")
    row "$1" "$n" "$most pixels > 1/255" "$([ "$n" -le "$most" ] 2>/dev/null && echo yes)"
}

# ---- rows ----------------------------------------------------------------------------------------

printf '%-58s %10s  %s\n' '' measured bound
whole='classic.none classic.inverse_square modern.none modern.inverse_square'
for scene in $whole; do
    render "$scene" "$scene"
done

powers='-40 -21 7 40'
[ -n "$full" ] && powers=$(seq -40 40)
for scene in $whole; do
    different=
    for k in $powers; do
        render "$scene" other -D "s=2^($k)"
        cmp -s "$tmp/$scene.ppm" "$tmp/other.ppm" || different="$different $k"
    done
    row "$scene scaled by 2^k, k = -40 .. 40${different:+, other bytes:$different}" "" "same bytes" \
        "$([ -z "$different" ] && echo yes)"
done

render plain plain
render plain mirrored -D x=-1
row "modern, opaque: mirrored from x to -x" "" "flipped bytes" \
    "$(cmp -s <(flipped plain) <(pixels_of mirrored) && echo yes)"

sizes='1e-12 1e-6 1e9'
[ -n "$full" ] && sizes='1e-12 1e-9 1e-6 1e-5 1e-3 3 1e3 1e6 1e7 1e9 1e12'
for size in $sizes; do
    for scene in classic.none modern.inverse_square; do
        render "$scene" other -D "s=$size"
        near "$scene scaled by $size" "$scene" other
    done
done

moves='2^20 2^30'
[ -n "$full" ] && moves=$(seq -f '2^%.0f' 20 30)
for move in $moves; do
    render modern.inverse_square other -D "to=$move * (1, 0.5, -0.75)"
    near "modern moved by $move" modern.inverse_square other
done

# every surface is a line; heads are the same
for model in classic modern; do
    { head_of $model none whole; surfaces | tac; } >"$tmp/backwards.wrt"
    render backwards other
    same "$model: surfaces in the opposite order" $model.none other
done

# parts of other sizes than a tile, put together
for part in 11 ${full:+5 13 64}; do
    for scene in classic.none modern.inverse_square; do
        : >"$tmp/joined"
        for ((y = 0; y < height; y += part)); do
            columns=()
            for ((x = 0; x < width; x += part)); do
                w=$((x + part < width ? part : width - x)) h=$((y + part < height ? part : height - y))
                render "$scene" part --crop "$x,$y,$((x + w)),$((y + h))"
                tail -c $((3 * w * h)) "$tmp/part.ppm" | od -An -v -tu1 -w$((3 * w)) >"$tmp/column.$x"
                columns+=("$tmp/column.$x")
            done
            paste -d ' ' "${columns[@]}" >>"$tmp/joined"
        done
        row "$scene put together from parts of $part x $part" "" "same bytes" \
            "$(cmp -s <(tr -s ' ' '\n' <"$tmp/joined" | grep .) \
                <(pixels_of "$scene" | tr -s ' ' '\n' | grep .) && echo yes)"
    done
done

# a mesh that stands once is copied into the scene; one of hundreds is an instance
mesh='rotate: (10deg, 50deg, 20deg)  mesh { file: "ball.off"  smooth: true  material: phong { diffuse: (0.6, 0.2, 0.6)  specular: 0.4  exponent: 25 } }'
{
    head_of modern none whole
    plain_surfaces
    echo "group { translate: (0, 1.2, -2)  scale: (0.8, 0.5, 0.7)  $mesh }"
} >"$tmp/copied.wrt"
{
    cat "$tmp/copied.wrt"
    echo "for i in range(300) { group { translate: (0, -9, -50 - i)  scale: 0.5  $mesh } }"
} >"$tmp/instanced.wrt"
render copied copied
render instanced instanced
near "modern: a mesh as an instance, and as a copy" copied instanced

# two walls that meet, lit from behind one of them: no light gets in along the line
cat >"$tmp/corner.wrt" <<END
wrt 1
model modern
camera { eye: (0, 0, -5)  look_at: 0  fov: 40deg  resolution: (33, 33) }
settings { background: 0  ambient: 0 }
light point { position: (3, 0, 0)  intensity: 9 }
quad { vertices: [(0, -3, 0), (0, 3, 0), (-3, 3, -3), (-3, -3, -3)]  material: lambert { diffuse: 1 } }
quad { vertices: [(0, -3, 0), (0, 3, 0), (3, 3, -3), (3, -3, -3)]  material: lambert { diffuse: 1 } }
END
render corner other
lit=$(tail -c $((3 * 33 * 33)) "$tmp/other.ppm" | tr -d '\0' | wc -c)
row 'an inner corner, lit from behind: channels with light' "$lit" '0' "$([ "$lit" = 0 ] && echo yes)"

# ---- things without a shape ----------------------------------------------------------------------

# mesh_of VERTEX...: one triangle among them, as $tmp/odd.off, in a scene.
mesh_of()
{
    printf 'OFF\n%d 1 0\n' $# >"$tmp/odd.off"
    printf '%s\n' "$@" "3 0 1 2" >>"$tmp/odd.off"
    { head_of modern none plain; echo 'mesh { file: "odd.off"  material: lambert { diffuse: 1 } }'; } >"$tmp/odd.wrt"
}

# refused WHAT: the scene is an error that names a place.
refused()
{
    local status
    timeout 60 "$wrt" render -q "$tmp/odd.wrt" -o "$tmp/other.ppm" 2>"$tmp/said"
    status=$?
    row "$1" "exit $status" "diagnosed" "$([ $status -gt 0 ] && [ $status -lt 10 ] &&
        grep -q "^[^ ]*odd\.[^ ]*:[0-9]*:.*error" "$tmp/said" && echo yes)"
}

mesh_of '0 0 0' '1 0 0' 'nan 1 0'
refused 'a vertex that is no number'
mesh_of '0 0 0' '1 0 0' '0 inf 0'
refused 'a vertex at infinity'
sed 's/look_at: at(0.2, 0.8, 0)/look_at: at(0.5, 2.2, -7)/' "$tmp/plain.wrt" >"$tmp/odd.wrt"
refused 'a camera that looks nowhere'

# A fan of 1e5 equal triangles, and triangles from a hair's breadth down to none.
awk 'BEGIN {
    print "OFF\n4 100000 0\n-1 0.5 0\n1 0.5 0\n0 2 0.3\n0 0.5 0"
    for (i = 0; i < 100000; i++) print "3 0 1 2"
}' >"$tmp/equal.off"
awk 'BEGIN {
    print "OFF\n240 80 0"
    for (i = 0; i < 80; i++) {
        x = -2 + i / 20
        printf "%.17g 0.2 0\n%.17g 2 0\n%.17g 1 %.17g\n", x, x + 0.1, x + 0.05 + 10 ^ (-i / 4), 10 ^ (-i / 4)
    }
    for (i = 0; i < 80; i++) print 3, 3 * i, 3 * i + 1, i % 4 ? 3 * i + 2 : 3 * i + 1
}' >"$tmp/slivers.off"
for odd in equal slivers; do
    what=slivers
    [ $odd = equal ] && what='1e5 equal triangles'
    { head_of modern none plain; echo "mesh { file: \"$odd.off\"  material: phong { diffuse: 1  specular: 1  exponent: 9 } }"; } >"$tmp/odd.wrt"
    size=$((width / 4))x$((height / 4))
    timeout 120 "$wrt" render -q --no-warn all "$tmp/odd.wrt" -o "$tmp/odd.ppm" --res $size
    timeout 120 "$wrt" render -q --no-warn all "$tmp/odd.wrt" -o "$tmp/other.ppm" --res $size --accel none
    same "$what: tree and brute force" odd other
done

# ---- POV-Ray at the same sizes, for comparison; nothing is asserted -------------------------------

povray_at()
{
    "$wrt" convert -q --no-warn all "$tmp/plain.wrt" -D "s=$1" -o "$tmp/pov.pov" &&
        (cd "$tmp" && povray pov.pov +FP "+O$2.ppm" "+W$width" "+H$height" -A -D) >"$tmp/log" 2>&1
}

if [ -n "$full" ] && command -v povray >/dev/null; then
    povray_at 1 pov
    for size in $sizes; do
        differ=failed
        povray_at "$size" other && differ="$(far_pixels pov other) of $pixels"
        echo "POV-Ray $(povray --version 2>&1 | sed -n 's/^POV-Ray \([0-9.]*\).*/\1/p'), scaled by $size:" \
            "$differ pixels > 1/255 from its own picture"
        render plain other -D "s=$size"
        echo "  wrt: $(far_pixels plain other)"
    done
elif [ -n "$full" ]; then
    echo 'SKIP: povray is not installed, so not compared with'
fi

echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" = 0 ]
