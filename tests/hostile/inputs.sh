# shellcheck shell=bash
# The inputs of run.sh: make_NAME writes the standard input of row NAME, and files beside it.

camera='camera { eye: (0, 0, -4)  look_at: (0, 0, 0)  fov: 50deg  resolution: (8, 8) }
light point { position: (2, 4, -4)  intensity: 60 }'
ball='sphere { center: 0  radius: 1  material: lambert { diffuse: 1 } }'

whole()
{
    printf 'wrt 1\n%s\n%s\n' "$camera" "$ball"
}

# repeat N TEXT: the text N times, with %d for the number of the round.
repeat()
{
    awk -v n="$1" -v text="$2" 'BEGIN { for (i = 0; i < n; i++) { t = text; gsub(/%d/, i, t); gsub(/%e/, i + 1, t); print t } }'
}

# fill N TEXT: the text N times on one line.
fill()
{
    yes -- "$2" | head -n "$1" | tr -d '\n'
}

make_templates()
{
    whole
    echo "define a0() { $ball }"
    repeat 40 'define a%e() { a%d() a%d() }'
    echo 'a40()'
}

make_templates_few()
{
    make_templates
}

make_templates_empty()
{
    whole
    echo 'define a0() { }'
    repeat 40 'define a%e() { a%d() a%d() }'
    echo 'a40()'
}

make_functions()
{
    whole
    echo 'fn f(n) = n < 2 ? 1 : f(n - 1) + f(n - 2)'
    echo 'let x = f(200)'
}

make_functions_few()
{
    make_functions
}

make_functions_deep()
{
    whole
    echo 'fn f(n) = 1 + f(n + 1)'
    echo 'let x = f(0)'
}

make_loops()
{
    whole
    echo 'for i in range(100000) { for j in range(100000) { for k in range(100000) { } } }'
}

make_loops_few()
{
    make_loops
}

make_ranges()
{
    whole
    echo 'let a = range(1000000000)'
    echo 'let b = steps(0, 1, 1000000000)'
    echo 'for i in range(-9e15, 9e15) { }'
}

make_lists()
{
    whole
    echo 'let a0 = [1, 2, 3, 4]'
    repeat 40 'let a%e = a%d + a%d'
}

make_strings()
{
    whole
    echo 'let a0 = "kilobyte"'
    repeat 40 'let a%e = a%d + a%d'
}

make_comprehensions()
{
    whole
    echo 'let a = [[[k for k in range(1000)] for j in range(1000)] for i in range(1000)]'
}

make_groups()
{
    whole
    fill 100000 'group { '
}

make_groups_xml()
{
    fill 100000 '<scene>'
}

make_brackets()
{
    whole
    echo "let a = $(fill 100000 '([')"
}

make_operators()
{
    whole
    echo "let a = $(fill 100000 '- ! -')1"
    echo "let b = 1 $(fill 100000 '^ 1 ')"
    echo "let c = 1 $(fill 100000 '+ 1 ')"
}

make_defines()
{
    whole >scene.wrt
    { printf 'size='; fill 50000 '('; } >value
}

make_include_chain()
{
    for i in $(seq 0 100); do
        printf 'wrt 1\ninclude "a%d.wrt"\n' $((i + 1)) >"a$i.wrt"
    done
    whole >a101.wrt
}

# Were a file read each time, there would be 2^20 of them.
make_include_twice()
{
    for i in $(seq 0 20); do
        printf 'wrt 1\ninclude "a%d.wrt"\ninclude "a%d.wrt"\n' $((i + 1)) $((i + 1)) >"a$i.wrt"
    done
    printf 'wrt 1\nlet x = 1\n' >a21.wrt
    whole | sed 1d >>a0.wrt
}

make_include_itself()
{
    for i in $(seq 0 20); do
        printf 'wrt 1\ninclude "a%d.wrt"\n' $(((i + 1) % 21)) >"a$i.wrt"
    done
}

make_include_endless()
{
    printf 'wrt 1\ninclude "/dev/zero"\n'
}

make_include_fenced()
{
    make_include_endless
}

make_names()
{
    whole
    printf 'let '
    fill 500000 a
    printf ' = '
    fill 500000 b
    echo
}

make_names_alike()
{
    whole
    repeat 700 'let abcdefghijklmnopqrstuvwxyz%d = abcdefghijklmnopqrstuvwxyy%d'
}

make_numbers()
{
    whole
    printf 'let a = 1.'
    fill 400000 9
    printf '\nlet b = 0.'
    fill 400000 0
    printf '1\nlet c = 1e'
    fill 400000 9
    echo
}

make_entities()
{
    echo '<!DOCTYPE lolz [<!ENTITY lol "lol">'
    repeat 30 '<!ENTITY lol%e "&lol%d;&lol%d;&lol%d;">'
    echo ']><scene>&lol30;</scene>'
}

make_nan()
{
    whole
    repeat 2000 'let a%d = 0 / 0  let b%d = 1e308 * 1e308  let c%d = sqrt(-1)  let d%d = log(0)'
}

make_nan_xml()
{
    echo '<scene><surfaces>'
    repeat 2000 '<item><class>Sphere</class><position><x>nan</x><y>-inf</y><z>1e999</z></position><radius>NaN</radius></item>'
    echo '</surfaces></scene>'
}

make_huge()
{
    whole
    repeat 50 'sphere { center: (%de300, -1e305, 1e150)  radius: 1e15%d  material: shiny { diffuse: 1  specular: 1  exponent: 5  reflection: 1 } }' | sed 's/1e15[1-9][0-9]/1e159/'
    echo 'triangle { vertices: [(-1e153, 0, 3), (1e153, 1e-300, 3), (0, 1e153, 3)]  material: glass { diffuse: 1  specular: 1  exponent: 5  reflection: 1  ior: 1.5  refraction: 1 } }'
}

make_tiny()
{
    whole
    repeat 50 'sphere { center: (0, %de-310, 1e-320)  radius: 1e-15%d  material: shiny { diffuse: 1  specular: 1  exponent: 5  reflection: 1 } }' | sed 's/1e-15[1-9][0-9]/1e-159/'
    echo 'triangle { vertices: [(0, 0, 0), (5e-324, 0, 0), (0, 5e-324, 0)]  material: lambert { diffuse: 1 } }'
}

make_light_samples()
{
    whole
    echo 'light area { position: (0, 4, 0)  size: 1  intensity: 1  samples: 1000000000 }'
}

# A pixel of which takes minutes: each ray gives rise to two, and all see twenty area lights.
make_rays()
{
    echo 'wrt 1
model modern
camera { eye: (0, 4, -7)  look_at: 0  fov: 50deg  resolution: (2000, 1500) }
settings { depth: 16  samples: 16 }
for i in range(20) {
    light area { shape: sphere  size: 3  position: (i, 6, -5)  intensity: 60  samples: 128 }
}
for i in range(500) {
    sphere { center: 4 * (rand(i) - 0.5, rand(i, 1) - 0.5, rand(i, 2) - 0.5)  radius: 0.3
             material: glass { diffuse: 0.3  specular: 0.5  exponent: 5  reflection: 0.5
                               refraction: 0.5  ior: 1.5 } }
}'
}

make_rays_ended()
{
    make_rays
}

make_resolution()
{
    whole | sed 's/(8, 8)/(1000000000, 1000000000)/'
}

make_pixels()
{
    whole | sed 's/(8, 8)/(16384, 16384)/'
}

make_picture()
{
    make_pixels
}

make_depth()
{
    whole
    echo 'settings { depth: 1000 }'
    repeat 20 'sphere { center: 0  radius: 0.%e5  material: glass { diffuse: 1  specular: 1  exponent: 5  reflection: 1  ior: 1.%e  refraction: 1 } }'
}

make_instances()
{
    whole
    echo "define a0() { $ball }"
    repeat 15 'define a%e() { a%d() a%d() { translate: (%e, 1, 0) } }'
    echo 'a15()'
}

textured()
{
    whole
    echo 'texture t = image { file: "texture" }'
    echo 'quad { vertices: [(-1, -1, 0), (-1, 1, 0), (1, 1, 0), (1, -1, 0)]  uvs: [(0, 0), (0, 1), (1, 1), (1, 0)]  material: lambert { diffuse: 1  texture: t } }'
}


# ---- pictures: gzip makes checksums and deflate streams ------------------------------------------

# be32 N: four bytes, the highest first.
be32()
{
    # shellcheck disable=SC2059 # the format is made of octal escapes
    printf "$(printf '\\%03o\\%03o\\%03o\\%03o' $(($1 >> 24 & 255)) $(($1 >> 16 & 255)) $(($1 >> 8 & 255)) $(($1 & 255)))"
}

# chunk TYPE: a PNG chunk with the standard input in it.
chunk()
{
    local sum
    { printf '%s' "$1"; cat; } >chunk
    # shellcheck disable=SC2207 # four numbers
    sum=($(gzip -c chunk | tail -c 8 | head -c 4 | od -An -tu1))
    be32 $(($(wc -c <chunk) - 4))
    cat chunk
    be32 $((sum[0] | sum[1] << 8 | sum[2] << 16 | sum[3] << 24))
}

# header SIDE BITS: of a grey picture.
png_header()
{
    printf '\211PNG\r\n\032\n'
    { be32 "$1"; be32 "$1"; printf "\\$(printf %03o "$2")"'\0\0\0\0'; } | chunk IHDR
}

# zeros N: a zlib stream of N zero bytes.
zeros()
{
    printf '\170\332'
    head -c "$1" /dev/zero | gzip -9 -c | tail -c +11 | head -c -8
    be32 $((($1 % 65521) << 16 | 1))
}

make_png_header()
{
    png_header 16384 1 >texture
    textured
}

# As many bytes as the rows may have been packed into, but no rows.
make_png_rows()
{
    { png_header 4096 1; head -c 100000 /dev/zero | chunk IDAT; } >texture
    textured
}

make_png_bomb()
{
    { png_header 16384 1; zeros $((2049 * 16384)) | chunk IDAT; chunk IEND </dev/null; } >texture
    textured
}

make_png_bomb_small()
{
    { png_header 8192 1; zeros $((1025 * 8192)) | chunk IDAT; chunk IEND </dev/null; } >texture
    textured
}

# A text of 3 MB packed into 3 KB, ten times.
make_png_text()
{
    { printf 'Comment\0\0'; zeros 3000000; } >text
    {
        png_header 8 8
        for i in 1 2 3 4 5 6 7 8 9 10; do
            chunk zTXt <text
        done
        zeros 72 | chunk IDAT
        chunk IEND </dev/null
    } >texture
    textured
}

# Start and frame of 16000 x 16000 pixels in three components, and a scan without data; the kind of
# frame is 300 baseline, 302 progressive (octal).
jpeg_header()
{
    printf '\377\330\377\'"$1"'\0\021\010\076\200\076\200\003\001\021\0\002\021\0\003\021\0'
    printf '\377\332\0\014\003\001\0\002\0\003\0\0\0\0'
}

make_jpeg_header()
{
    jpeg_header 300 >texture
    textured
}

make_jpeg_progressive()
{
    { jpeg_header 302; fill 500000 'filling ^'; } >texture
    textured
}

# ---- meshes ----------------------------------------------------------------------------------------

with_mesh()
{
    whole
    echo 'mesh { file: "mesh"  material: lambert { diffuse: 1 } }'
}

make_off_counts()
{
    printf 'OFF\n4000000000 4000000000 0\n0 0 0\n' >mesh
    with_mesh
}

make_off_corners()
{
    printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n' >mesh
    with_mesh
}

make_ply_counts()
{
    printf 'ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty double x\nproperty double y\nproperty double z\nelement face 4000000000\nproperty list uint uint vertex_indices\nend_header\n' >mesh
    with_mesh
}

make_ply_lists()
{
    printf 'ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nproperty list uint double extra\nelement face 1\nproperty list uint uint vertex_indices\nend_header\n0123456789ab\377\377\377\377' >mesh
    with_mesh
}

make_stl_count()
{
    { head -c 80 /dev/zero; printf '\377\377\377\377'; head -c 500 /dev/zero; } >mesh
    with_mesh
}

make_obj_index()
{
    { repeat 3 'v %d 0 1'; echo 'f 1 2 99999999999999999999'; echo 'f -9223372036854775808 1 2'; } >mesh
    with_mesh
}

make_uv_lines()
{
    printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >mesh
    { printf '0 0\n0 1\n1 0\n'; fill 1000000 '1'; } >uv
    textured
    echo 'mesh { file: "mesh"  uv_file: "uv"  material: lambert { diffuse: 1  texture: t } }'
    { png_header 8 8; zeros 72 | chunk IDAT; chunk IEND </dev/null; } >texture
}

make_wrl_uses()
{
    echo '#VRML V2.0 utf8'
    echo 'DEF a0 Shape { geometry IndexedFaceSet { coord Coordinate { point [0 0 0, 1 0 0, 0 1 0] }'
    echo 'coordIndex [0 1 2 -1] texCoord TextureCoordinate { point [0 0, 1 0, 0 1] } texCoordIndex [0 1 2 -1] } }'
    repeat 40 'DEF a%e Group { children [ USE a%d USE a%d ] }'
}

make_wrl_uses_little()
{
    make_wrl_uses
}

make_wrl_deep()
{
    echo '#VRML V2.0 utf8'
    fill 100000 'Group { children [ '
}

# ---- many things -----------------------------------------------------------------------------------

make_lint_flats()
{
    whole
    repeat 300 'quad { vertices: [(-1, -1, 0), (-1, 1.00%d, 0), (1, 1.00%d, 0), (1, -1, 0)]  material: lambert { diffuse: 1 } }'
}

make_lint_spheres()
{
    whole
    repeat 5000 'sphere { center: (0, 0, 0.0%d)  radius: 1.0%d  material: glass { diffuse: 1  specular: 1  exponent: 5  reflection: 1  ior: 1.5  refraction: 1 } }'
}

make_lint_names()
{
    whole
    repeat 3000 'let name_%d = %d'
}

make_fmt_lines()
{
    whole
    printf 'let a = [ '
    fill 100000 '1, '
    echo ']'
    fill 100000 '/* */ '
    printf 'let b = '
    fill 100 '[('
    echo 1
    fill 100 ',2,3)]'
}

make_convert_shared()
{
    whole
    echo 'material m = phong { diffuse: 1  specular: 1  exponent: 5 }'
    echo "define a0() { ${ball/lambert \{ diffuse: 1 \}/m} }"
    repeat 11 'define a%e() { a%d() { translate: (1, 0, 0) } a%d() }'
    echo 'a11()'
}

# ---- editors ---------------------------------------------------------------------------------------

make_lsp_length()
{
    printf 'Content-Length: 99999999999999999999999\r\n\r\n{}'
    printf 'Content-Length: 4000000000\r\n\r\n{}'
}

make_lsp_headers()
{
    fill 1000000 'X-Header: 1 '
}

make_lsp_nested()
{
    printf 'Content-Length: 1000000\r\n\r\n'
    fill 1000000 '['
}

make_lsp_many()
{
    for i in $(seq 2000); do
        printf 'Content-Length: 46\r\n\r\n{"jsonrpc":"2.0","id":%4d,"method":"nothing"}' "$i"
    done
}
