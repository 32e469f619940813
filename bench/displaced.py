"""A displaced sphere of any number of triangles, a scene that shows it, and a displaced square for
numbers too large for it."""
import math

GOLDEN = (1 + 5 ** 0.5) / 2
CORNERS = [(-1, GOLDEN, 0), (1, GOLDEN, 0), (-1, -GOLDEN, 0), (1, -GOLDEN, 0),
           (0, -1, GOLDEN), (0, 1, GOLDEN), (0, -1, -GOLDEN), (0, 1, -GOLDEN),
           (GOLDEN, 0, -1), (GOLDEN, 0, 1), (-GOLDEN, 0, -1), (-GOLDEN, 0, 1)]
SCENE = """wrt 1
model modern
camera { eye: (0, 0.6, -4)  look_at: 0  fov: 32deg  resolution: (1024, 1024) }
light point { position: (3, 5, -6)  intensity: 60 }
mesh { file: "mesh.off"  smooth: true
       material: phong { diffuse: (0.7, 0.7, 0.8)  specular: 0.3  exponent: 25 } }
"""


def icosahedron():
    """Its faces: corners next to each other, turned outwards."""
    near = {(a, b) for a in range(12) for b in range(12)
            if a != b and math.dist(CORNERS[a], CORNERS[b]) < 2.1}
    for a in range(12):
        for b in range(a + 1, 12):
            for c in range(b + 1, 12):
                if {(a, b), (b, c), (a, c)} <= near:
                    p, q, r = CORNERS[a], CORNERS[b], CORNERS[c]
                    volume = (p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2])
                              + p[2] * (q[0] * r[1] - q[1] * r[0]))
                    yield (a, b, c) if volume > 0 else (a, c, b)


def displaced(x, y, z):
    length = math.sqrt(x * x + y * y + z * z)
    x, y, z = x / length, y / length, z / length
    r = (1 + 0.15 * math.sin(5 * x + 1) * math.cos(4 * y) * math.sin(6 * z + 2)
         + 0.05 * math.sin(17 * x) * math.sin(19 * y + 1) * math.cos(13 * z)
         + 0.01 * math.sin(61 * x) * math.sin(57 * y) * math.sin(53 * z))
    return r * x, r * y, r * z


def write_mesh(path, n):
    """Each face cut into n^2; vertices on common edges are shared."""
    numbers, vertices, triangles = {}, [], []

    def vertex(face, i, j):
        parts = tuple(sorted((v, w) for v, w in zip(face, (n - i - j, i, j)) if w))
        if parts not in numbers:
            numbers[parts] = len(vertices)
            vertices.append(displaced(*(sum(CORNERS[v][k] * w for v, w in parts) for k in range(3))))
        return numbers[parts]

    for face in icosahedron():
        for i in range(n):
            for j in range(n - i):
                triangles.append((vertex(face, i, j), vertex(face, i + 1, j), vertex(face, i, j + 1)))
                if i + j < n - 1:
                    triangles.append((vertex(face, i + 1, j), vertex(face, i + 1, j + 1),
                                      vertex(face, i, j + 1)))
    with open(path, "w") as f:
        print(f"OFF\n{len(vertices)} {len(triangles)} 0", file=f)
        for v in vertices:
            print("%.9g %.9g %.9g" % v, file=f)
        for t in triangles:
            print("3 %d %d %d" % t, file=f)
    return len(triangles)


def write_scene(folder, n):
    """mesh.off and scene.wrt; returns how many triangles there are."""
    count = write_mesh(f"{folder}/mesh.off", n)
    with open(f"{folder}/scene.wrt", "w") as f:
        f.write(SCENE)
    return count


def write_square(path, n):
    """2 n^2 triangles, towards the camera of the scene."""
    with open(path, "w") as f:
        print(f"OFF\n{(n + 1) ** 2} {2 * n * n} 0", file=f)
        for j in range(n + 1):
            y = 2 * j / n - 1
            across = [math.sin(17 * y + 1) * math.cos(5 * y), math.cos(61 * y)]
            for i in range(n + 1):
                x = 2 * i / n - 1
                z = 0.1 * math.sin(7 * x) * across[0] + 0.01 * math.sin(57 * x) * across[1]
                f.write("%.7g %.7g %.7g\n" % (x, y, z))
        for j in range(n):
            for a in range(j * (n + 1), j * (n + 1) + n):
                f.write("3 %d %d %d\n3 %d %d %d\n" % (a, a + n + 1, a + 1, a + 1, a + n + 1, a + n + 2))
    return 2 * n * n
