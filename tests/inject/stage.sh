# shellcheck shell=bash
# The folder in which the commands of runs.txt run.

message()
{
    printf 'Content-Length: %d\r\n\r\n%s' ${#1} "$1"
}

stage_session()
{
    local uri='"uri":"file:///nowhere/a.wrt"'
    message '{"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{}}}'
    message '{"jsonrpc":"2.0","method":"initialized","params":{}}'
    message '{"jsonrpc":"2.0","method":"textDocument/didOpen","params":{"textDocument":{'"$uri"',"languageId":"wrt","version":1,"text":"let a = 1\nsphere { center: 0  radius: b }\n"}}}'
    message '{"jsonrpc":"2.0","id":2,"method":"textDocument/hover","params":{"textDocument":{'"$uri"'},"position":{"line":1,"character":2}}}'
    message '{"jsonrpc":"2.0","id":3,"method":"textDocument/completion","params":{"textDocument":{'"$uri"'},"position":{"line":1,"character":9}}}'
    message '{"jsonrpc":"2.0","id":4,"method":"textDocument/formatting","params":{"textDocument":{'"$uri"'},"options":{"tabSize":2,"insertSpaces":true}}}'
    message '{"jsonrpc":"2.0","id":5,"method":"shutdown"}'
    message '{"jsonrpc":"2.0","method":"exit"}'
}

# stage SRCDIR: into the current folder.
stage()
{
    local cli=$1/tests/cli
    cp "$cli/restrict/inside/"{mesh.off,uvs.txt,tiny.png} .
    cp "$cli/diag/W590-near-miss/Wood.jpg" wood.jpg
    cp tiny.png old.png
    cp tiny.png picture.png
    mkdir sub
    ln -s picture.png link.png
    printf 'wrt 1\nlet shift = 1\n' >part.wrt
    cat >scene.wrt <<'END'
wrt 1
include "part.wrt"
texture t = image { file: "tiny.png" }
texture u = image { file: "wood.jpg" }
camera { eye: (0, 0, -4)  look_at: (0, 0, 0)  fov: 50deg  resolution: (9, 8) }
light point { position: (2, 4, -4)  intensity: 60 }
light area { shape: sphere  position: (0, 4, 0)  size: 1  intensity: 9  samples: 2 }
define pair(x) {
  sphere { center: (x, 1, 0)  radius: 0.3  material: lambert { diffuse: shift } }
  mesh { file: "mesh.off"  uv_file: "uvs.txt"  smooth: true  material: lambert { diffuse: 1  texture: t } }
}
for i in range(2) { pair(i - 0.5) { translate: (0, i, 0) } }
quad { vertices: [(-1, -1, 0), (-1, 1, 0), (1, 1, 0), (1, -1, 0)]  uvs: [(0, 0), (0, 1), (1, 1), (1, 0)]
  material: lambert { diffuse: 1  texture: u } }
END
    sed 's/^wrt 1$/&\nparam frame = 1/; s/radius: 0.3/radius: 0.3 + frame \/ 100/' scene.wrt >film.wrt
    cp "$1/scenes/sphere.xml" scene.xml
    sed -i 's/<xResolution>[^<]*/<xResolution>9/; s/<yResolution>[^<]*/<yResolution>7/' scene.xml
    printf 'let  unused = 1\nsphere   { center: (0,0,0)\nradius: 1 material: lambert{diffuse: 2} }\ncamera { eye: (0, 0, -4)  look_at: (0, 0, 0)  fov: 50  resolution: (9, 8) }\nlight point { position: 1 intensity: 0 }' >worn.wrt
    printf 'wrt 1\nlet a = b\nsphere { radius: "x" }\ncamera { fob: 1 }}\n' >wrong.wrt
    printf '#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point [0 0 0, 1 0 0, 0 1 0] } coordIndex [0 1 2 -1] texCoord TextureCoordinate { point [0 0, 1 0, 0 1] } texCoordIndex [0 1 2 -1] } }\n' >face.wrl
    stage_session >session
    "$WRT" render scene.wrt -q --part 1/2 -o half.1
    "$WRT" render scene.wrt -q --part 2/2 -o half.2
    "$WRT" render film.wrt -q --frames 1..2 -o kept-%d.png
    "$WRT" render scene.wrt -t 1 -q --checkpoint kept.journal -o /dev/full 2>/dev/null || [ -s kept.journal ]
}
