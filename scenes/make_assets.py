#!/usr/bin/env python3
"""Make every mesh and texture the scenes use.

    python3 scenes/make_assets.py [FOLDER]

Writes into scenes/assets/ (or FOLDER).  Only the standard library is needed, and nothing is
random: every run of one Python version writes the same bytes, so the outputs are committed
beside this script.  Everything here is procedural; no picture or model was taken from elsewhere.

Conventions, the same as the renderer's:

* The world is left-handed: x to the right, y up, z away from the viewer.
* A face's normal is (v1 - v0) x (v2 - v0); every closed mesh has its normals outside.
* A UV list has one "u v" pair a line, three pairs a face, in face order.
* A sphere's map has the viewer's side (0, 0, -1) at u = 0.75 and north at the top row.
* A normal map holds the slope to the right in red, upwards in green, 128 meaning none.
"""

import math
import os
import random
import struct
import sys
import zlib

OUT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "assets")


# ---------------------------------------------------------------------------------------------
# Files
# ---------------------------------------------------------------------------------------------

def save(name, data):
    with open(os.path.join(OUT, name), "wb") as f:
        f.write(data)


def chunk(kind, body):
    return (struct.pack(">I", len(body)) + kind + body
            + struct.pack(">I", zlib.crc32(kind + body) & 0xFFFFFFFF))


def filter_row(kind, row, above, bpp):
    """One PNG row under filter 0 None, 1 Sub, 2 Up or 4 Paeth."""
    if kind == 0:
        return bytes(row)
    left = bytes(bpp) + row[:-bpp]
    if kind == 1:
        return bytes((a - b) & 255 for a, b in zip(row, left))
    if kind == 2:
        return bytes((a - b) & 255 for a, b in zip(row, above))
    corner = bytes(bpp) + above[:-bpp]
    out = bytearray()
    for x, a, b, c in zip(row, left, above, corner):
        pa, pb, pc = abs(b - c), abs(a - c), abs(a + b - 2 * c)
        out.append((x - (a if pa <= pb and pa <= pc else b if pb <= pc else c)) & 255)
    return bytes(out)


def filter_rows(rows, bpp, choice):
    """Rows under one filter, or under the one with the smallest differences when choice is None."""
    out = bytearray()
    above = bytes(len(rows[0])) if rows else b""
    for row in rows:
        if choice is None:
            tries = [(filter_row(k, row, above, bpp), k) for k in (0, 1, 2, 4)]
            best, kind = min(tries, key=lambda t: sum(min(v, 256 - v) for v in t[0]))
        else:
            best, kind = filter_row(choice, row, above, bpp), choice
        out.append(kind)
        out += best
        above = row
    return bytes(out)


def pack_bits(values, depth):
    """Palette indexes or samples of one row, packed to `depth` bits each."""
    if depth == 8:
        return bytes(values)
    out, acc, have = bytearray(), 0, 0
    for v in values:
        acc, have = acc << depth | v, have + depth
        if have == 8:
            out.append(acc)
            acc, have = 0, 0
    if have:
        out.append(acc << (8 - have))
    return bytes(out)


ADAM7 = ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2),
         (0, 1, 1, 2))


def save_png(name, image, kind, depth=8, palette=None, interlaced=False):
    """image: rows from top to bottom of pixels; kind: "rgb", "grey" or "palette"."""
    height, width = len(image), len(image[0])
    colour, bpp = {"rgb": (2, 3), "grey": (0, depth // 8 or 1), "palette": (3, 1)}[kind]

    def pack(row):
        if kind == "rgb":
            return bytes(v for pixel in row for v in pixel)
        if depth == 16:
            return struct.pack(">%dH" % len(row), *row)
        return pack_bits(row, depth)

    if interlaced:
        passes = [[pack(row[x0::dx]) for row in image[y0::dy]] for x0, y0, dx, dy in ADAM7]
    else:
        passes = [[pack(row) for row in image]]
    streams = (b"".join(filter_rows(rows, bpp, choice) for rows in passes)
               for choice in (None, 0, 1, 2))
    body = min((zlib.compress(s, 9) for s in streams), key=len)
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(
        ">IIBBBBB", width, height, depth, colour, 0, 0, int(interlaced)))
    if palette:
        data += chunk(b"PLTE", bytes(v for c in palette for v in c))
    save(name, data + chunk(b"IDAT", body) + chunk(b"IEND", b""))


def save_shades(name, grey, dark, light, shades):
    """A picture of values in 0..1 as a palette of `shades` steps from one colour to another."""
    ramp = [mix8(dark, light, i / (shades - 1)) for i in range(shades)]
    save_png(name, [[int(clamp(v) * (shades - 1) + 0.5) for v in row] for row in grey],
             "palette", 8 if shades > 16 else 4, ramp)


# ---------------------------------------------------------------------------------------------
# Small mathematics
# ---------------------------------------------------------------------------------------------

def clamp(x, low=0.0, high=1.0):
    return low if x < low else high if x > high else x


def smooth(a, b, x):
    t = clamp((x - a) / (b - a))
    return t * t * (3 - 2 * t)


def mix(a, b, t):
    return tuple(p + (q - p) * t for p, q in zip(a, b))


def mix8(a, b, t):
    return tuple(int(v + 0.5) for v in mix(a, b, t))


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def unit(a):
    length = math.sqrt(dot(a, a))
    return (a[0] / length, a[1] / length, a[2] / length)


def turned(yaw, pitch, roll):
    """The rows of the matrix that takes world directions back to those of a turned ball.

    The ball is rolled about z, then pitched (positive lifts its front), then yawed (positive
    turns its front to the right); angles in degrees.
    """
    (cy, sy), (cp, sp), (cr, sr) = ((math.cos(math.radians(a)), math.sin(math.radians(a)))
                                    for a in (yaw, pitch, roll))

    def forth(v):
        x, y, z = v
        x, y = cr * x - sr * y, sr * x + cr * y
        y, z = cp * y - sp * z, sp * y + cp * z
        return (cy * x - sy * z, y, sy * x + cy * z)

    return forth((1, 0, 0)), forth((0, 1, 0)), forth((0, 0, 1))


def noise_grid(size_x, size_y, cells_x, cells_y, seed):
    """Smooth value noise in 0..1 that repeats at the picture's borders."""
    rng = random.Random(seed)
    lattice = [[rng.random() for _ in range(cells_x)] for _ in range(cells_y)]
    columns = []
    for i in range(size_x):
        p = i * cells_x / size_x
        k = int(p)
        columns.append((k, (k + 1) % cells_x, smooth(0, 1, p - k)))
    out = []
    for j in range(size_y):
        p = j * cells_y / size_y
        k = int(p)
        t = smooth(0, 1, p - k)
        a, b = lattice[k], lattice[(k + 1) % cells_y]
        blend = [u + (v - u) * t for u, v in zip(a, b)]
        out.append([blend[k0] + (blend[k1] - blend[k0]) * f for k0, k1, f in columns])
    return out


def cloud_grid(size_x, size_y, cells_x, cells_y, octaves, seed):
    """Several octaves of noise, each twice as fine and half as strong; 0..1, repeating."""
    total = [[0.0] * size_x for _ in range(size_y)]
    weight, full = 1.0, 0.0
    for o in range(octaves):
        layer = noise_grid(size_x, size_y, cells_x << o, cells_y << o, seed * 31 + o)
        for row, add in zip(total, layer):
            for i, v in enumerate(add):
                row[i] += weight * v
        full += weight
        weight /= 2
    return [[v / full for v in row] for row in total]


class SolidNoise:
    """Value noise in space, for maps without a seam."""

    def __init__(self, seed):
        rng = random.Random(seed)
        self.table = [rng.random() for _ in range(4096)]

    def once(self, x, y, z):
        i, j, k = math.floor(x), math.floor(y), math.floor(z)
        u, v, w = x - i, y - j, z - k
        u, v, w = u * u * (3 - 2 * u), v * v * (3 - 2 * v), w * w * (3 - 2 * w)

        def at(a, b, c):
            return self.table[(a * 1619 + b * 31337 + c * 6971) & 4095]

        def line(b, c):
            p = at(i, b, c)
            return p + (at(i + 1, b, c) - p) * u

        def sheet(c):
            p = line(j, c)
            return p + (line(j + 1, c) - p) * v

        p = sheet(k)
        return p + (sheet(k + 1) - p) * w

    def __call__(self, d, scale, octaves):
        total, full, weight = 0.0, 0.0, 1.0
        for _ in range(octaves):
            total += weight * self.once(d[0] * scale, d[1] * scale, d[2] * scale)
            full += weight
            weight, scale = weight / 2, scale * 2
        return total / full


def sphere_map(width, height, paint):
    """A 2:1 map; paint(direction) gives the pixel."""
    out = []
    for j in range(height):
        phi = math.pi * (j + 0.5) / height
        y, r = math.cos(phi), math.sin(phi)
        row = []
        for i in range(width):
            theta = 2 * math.pi * (i + 0.5) / width
            row.append(paint((r * math.cos(theta), y, r * math.sin(theta))))
        out.append(row)
    return out


def splat(width, height, centres, radius, combine):
    """combine(i, j, angle) for every texel of a 2:1 map that is near one of the centres."""
    for c in centres:
        phi = math.acos(clamp(c[1], -1, 1))
        theta = math.atan2(c[2], c[0])
        for j in range(max(0, int((phi - radius) / math.pi * height)),
                       min(height, int((phi + radius) / math.pi * height) + 2)):
            p = math.pi * (j + 0.5) / height
            y, r = math.cos(p), math.sin(p)
            reach = min(width // 2, int(radius * width / (2 * math.pi) / max(r, 1e-3)) + 2)
            mid = int(theta / (2 * math.pi) * width)
            for i in range(mid - reach, mid + reach):
                t = 2 * math.pi * (i + 0.5) / width
                cosine = r * math.cos(t) * c[0] + y * c[1] + r * math.sin(t) * c[2]
                angle = math.acos(clamp(cosine, -1, 1))
                if angle < radius:
                    combine(i % width, j, angle)


def normal_map(heights, strength, step=1, wrap_v=True):
    """Slopes of a height picture as colours; `step` coarsens them so that they pack better."""
    rows, columns = len(heights), len(heights[0])
    out = []
    for j in range(rows):
        up = heights[j - 1] if wrap_v or j else heights[j]
        down = heights[(j + 1) % rows] if wrap_v or j + 1 < rows else heights[j]
        here, line = heights[j], []
        for i in range(columns):
            sx = (here[i - 1] - here[(i + 1) % columns]) * strength
            sy = (down[i] - up[i]) * strength
            n = unit((sx, sy, 1.0))
            line.append(tuple(min(255, 128 + step * int(math.floor(v * 127 / step + 0.5)))
                              for v in n))
        out.append(line)
    return out


# ---------------------------------------------------------------------------------------------
# Meshes
# ---------------------------------------------------------------------------------------------

class Mesh:
    """Vertices, faces, and a UV pair for every corner of every face."""

    def __init__(self):
        self.vertices, self.faces, self.uvs = [], [], []

    def vertex(self, p):
        self.vertices.append(p)
        return len(self.vertices) - 1

    def face(self, corners, uvs=None):
        self.faces.append(tuple(corners))
        self.uvs.extend(uvs or [(0.0, 0.0)] * 3)

    def square(self, a, b, c, d, uvs=None):
        """Two faces a b c and a c d."""
        t = uvs or [(0.0, 0.0)] * 4
        self.face((a, b, c), (t[0], t[1], t[2]))
        self.face((a, c, d), (t[0], t[2], t[3]))

    def flip(self):
        self.faces = [(a, c, b) for a, b, c in self.faces]
        u = self.uvs
        self.uvs = [u[i + k] for i in range(0, len(u), 3) for k in (0, 2, 1)]

    def add(self, other):
        base = len(self.vertices)
        self.vertices += other.vertices
        self.faces += [tuple(base + i for i in f) for f in other.faces]
        self.uvs += other.uvs

    def volume(self):
        v = self.vertices
        return sum(dot(v[a], cross(v[b], v[c])) for a, b, c in self.faces) / 6

    def outwards(self):
        """The same mesh with its normals outside; it must be closed."""
        if self.volume() < 0:
            self.flip()
        return self

    def save(self, name, comment, with_uv=False):
        lines = ["OFF", "# " + comment,
                 "%d %d 0" % (len(self.vertices), len(self.faces))]
        lines += [" ".join(number(c) for c in p) for p in self.vertices]
        lines += ["3 %d %d %d" % f for f in self.faces]
        save(name + ".off", ("\n".join(lines) + "\n").encode())
        if with_uv:
            text = "".join("%s %s\n" % (number(u), number(v)) for u, v in self.uvs)
            save(name + "_uv.txt", text.encode())

    def save_obj(self, name, comment, crease):
        """With texture coordinates, and normals that break at edges sharper than `crease`."""
        corners = [(f[k], k, i) for i, f in enumerate(self.faces) for k in range(3)]
        flat = [unit(cross(sub(v[1], v[0]), sub(v[2], v[0])))
                for v in ([self.vertices[c] for c in f] for f in self.faces)]
        around = {}
        for vertex, _, face in corners:
            around.setdefault(vertex, []).append(face)
        limit = math.cos(math.radians(crease))
        lists = {"vt": {}, "vn": {}}

        def place(kind, values):
            known = lists[kind]
            return known.setdefault(" ".join(number(x) for x in values), len(known) + 1)

        faces = [[] for _ in self.faces]
        for vertex, k, i in corners:
            near = [flat[j] for j in around[vertex] if dot(flat[i], flat[j]) >= limit]
            normal = unit(tuple(sum(n[c] for n in near) for c in range(3)))
            faces[i].append("%d/%d/%d" % (vertex + 1, place("vt", self.uvs[3 * i + k]),
                                          place("vn", normal)))
        lines = ["# " + comment] + ["v " + " ".join(number(c) for c in p) for p in self.vertices]
        lines += [kind + " " + text for kind in lists for text in lists[kind]]
        lines += ["f " + " ".join(face) for face in faces]
        save(name + ".obj", ("\n".join(lines) + "\n").encode())

    def save_ply(self, name, comment):
        """Binary, with doubles."""
        header = ("ply\nformat binary_little_endian 1.0\ncomment %s\nelement vertex %d\n"
                  "property double x\nproperty double y\nproperty double z\nelement face %d\n"
                  "property list uchar int vertex_indices\nend_header\n"
                  % (comment, len(self.vertices), len(self.faces)))
        save(name + ".ply", header.encode()
             + b"".join(struct.pack("<3d", *(float(number(c)) for c in p)) for p in self.vertices)
             + b"".join(struct.pack("<B3i", 3, *f) for f in self.faces))

    def save_stl(self, name):
        lines = ["solid " + name]
        for f in self.faces:
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += ["vertex " + " ".join(number(c) for c in self.vertices[i]) for i in f]
            lines += ["endloop", "endfacet"]
        save(name + ".stl", ("\n".join(lines + ["endsolid " + name]) + "\n").encode())


def number(x):
    """Four decimals, no trailing zeros, no minus zero."""
    text = ("%.4f" % x).rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def ring_grid(columns, rows, point):
    """A sheet that closes in both directions; point(u, v) with u, v in 0..1."""
    m = Mesh()
    ids = [[m.vertex(point(i / columns, j / rows)) for i in range(columns)]
           for j in range(rows)]
    for j in range(rows):
        for i in range(columns):
            i1, j1 = (i + 1) % columns, (j + 1) % rows
            u0, u1, v0, v1 = i / columns, (i + 1) / columns, j / rows, (j + 1) / rows
            m.square(ids[j][i], ids[j][i1], ids[j1][i1], ids[j1][i],
                     [(u0, v0), (u1, v0), (u1, v1), (u0, v1)])
    return m


def revolve(profile, columns):
    """A closed body from a profile of (radius, y) that starts and ends on the axis."""
    m = Mesh()
    lengths = [0.0]
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        lengths.append(lengths[-1] + math.hypot(r1 - r0, y1 - y0))
    v = [s / lengths[-1] for s in lengths]
    first = m.vertex((0.0, profile[0][1], 0.0))
    rings = []
    for r, y in profile[1:-1]:
        ring = []
        for i in range(columns):
            a = 2 * math.pi * i / columns
            ring.append(m.vertex((r * math.cos(a), y, r * math.sin(a))))
        rings.append(ring)
    last = m.vertex((0.0, profile[-1][1], 0.0))
    for i in range(columns):
        k = (i + 1) % columns
        u0, u1 = i / columns, (i + 1) / columns
        middle = (u0 + u1) / 2
        m.face((first, rings[0][i], rings[0][k]), ((middle, v[0]), (u0, v[1]), (u1, v[1])))
        for j in range(len(rings) - 1):
            m.square(rings[j][i], rings[j + 1][i], rings[j + 1][k], rings[j][k],
                     [(u0, v[j + 1]), (u0, v[j + 2]), (u1, v[j + 2]), (u1, v[j + 1])])
        m.face((last, rings[-1][k], rings[-1][i]), ((middle, v[-1]), (u1, v[-2]), (u0, v[-2])))
    return m.outwards()


def curve(points, steps):
    """A Catmull-Rom curve through points (tuples of any length)."""
    out = []
    n = len(points) - 1
    for s in range(n):
        p = [points[max(0, min(n, s + k))] for k in (-1, 0, 1, 2)]
        for q in range(steps):
            t = q / steps
            w = ((-t + 2 * t * t - t ** 3) / 2, (2 - 5 * t * t + 3 * t ** 3) / 2,
                 (t + 4 * t * t - 3 * t ** 3) / 2, (t ** 3 - t * t) / 2)
            out.append(tuple(sum(a * b[c] for a, b in zip(w, p)) for c in range(len(points[0]))))
    return out + [tuple(points[-1])]


def tube(points, columns):
    """A closed tube along points (x, y, z, radius) in the plane z = 0, with flat round ends."""
    m = Mesh()
    rings = []
    for k, (x, y, z, r) in enumerate(points):
        a, b = points[max(0, k - 1)], points[min(len(points) - 1, k + 1)]
        dx, dy, _ = unit((b[0] - a[0], b[1] - a[1], 0.0))
        ring = []
        for i in range(columns):
            t = 2 * math.pi * i / columns
            s = r * math.cos(t)
            ring.append(m.vertex((x - dy * s, y + dx * s, z + r * math.sin(t))))
        rings.append(ring)
    for lower, upper in zip(rings, rings[1:]):
        for i in range(columns):
            k = (i + 1) % columns
            m.square(lower[i], lower[k], upper[k], upper[i])
    for ring, end, turn in ((rings[0], points[0], 1), (rings[-1], points[-1], -1)):
        middle = m.vertex(end[:3])
        for i in range(columns):
            k = (i + 1) % columns
            m.face((middle, ring[k], ring[i]) if turn > 0 else (middle, ring[i], ring[k]))
    return m.outwards()


def torus(columns, rows, ring, pipe):
    def point(u, v):
        a, b = 2 * math.pi * u, 2 * math.pi * v
        r = ring - pipe * math.cos(b)
        return (r * math.cos(a), pipe * math.sin(b), r * math.sin(a))
    return ring_grid(columns, rows, point).outwards()


def knot(columns, rows, pipe):
    """A tube along a trefoil knot that lies flat on its side."""
    def middle(t):
        return ((2 + math.cos(3 * t)) * math.cos(2 * t) / 3,
                (2 + math.cos(3 * t)) * math.sin(2 * t) / 3, math.sin(3 * t) / 3)

    def point(u, v):
        t, a = 2 * math.pi * u, 2 * math.pi * v
        p = middle(t)
        along = unit(sub(middle(t + 1e-4), middle(t - 1e-4)))
        side = unit(cross((p[0] / 4, p[1] / 4, 1.0), along))
        up = cross(along, side)
        c, s = pipe * math.cos(a), pipe * math.sin(a)
        return tuple(p[k] + c * side[k] + s * up[k] for k in range(3))
    return ring_grid(columns, rows, point).outwards()


def blob(levels):
    """An icosahedron, each face cut in four `levels` times, pushed in and out by waves."""
    g = (1 + math.sqrt(5)) / 2
    points = [unit(p) for p in ((-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g),
                                (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1),
                                (-g, 0, -1), (-g, 0, 1))]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
             (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
             (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(levels):
        halves, finer = {}, []

        def half(a, b):
            key = (min(a, b), max(a, b))
            if key not in halves:
                halves[key] = len(points)
                points.append(unit(tuple(p + q for p, q in zip(points[a], points[b]))))
            return halves[key]

        for a, b, c in faces:
            ab, bc, ca = half(a, b), half(b, c), half(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = finer
    m = Mesh()
    for x, y, z in points:
        r = (1 + 0.13 * math.sin(4.1 * x + 1.7) * math.cos(3.3 * y)
             + 0.11 * math.sin(5.2 * z + 2.0 * y) + 0.06 * math.cos(7.0 * x * y + 3.0 * z))
        m.vertex((r * x, r * y, r * z))
    for f in faces:
        m.face(f)
    return m.outwards()


def box(sides, degrees):
    """A box on the plane y = 0, turned about the vertical."""
    m = Mesh()
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    for i in range(8):
        x = (0.5 if i & 1 else -0.5) * sides[0]
        y = sides[1] if i & 2 else 0.0
        z = (0.5 if i & 4 else -0.5) * sides[2]
        m.vertex((c * x - s * z, y, s * x + c * z))
    for a, b, d, e in ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1),
                       (4, 5, 7, 6)):
        m.square(a, b, d, e)
    return m.outwards()


def teapot():
    """A squat pot: body, lid and knob as one profile, a spout and a handle as tubes."""
    profile = curve([(0.0, 0.0), (0.42, 0.0), (0.52, 0.04), (0.78, 0.28), (0.84, 0.52),
                     (0.70, 0.78), (0.47, 0.92)], 4)
    profile += curve([(0.47, 0.92), (0.49, 0.96), (0.42, 1.0), (0.22, 1.08), (0.08, 1.12),
                      (0.07, 1.17), (0.14, 1.24), (0.12, 1.32), (0.0, 1.35)], 3)[1:]
    m = revolve(profile, 40)
    m.add(tube(curve([(0.60, 0.34, 0.0, 0.20), (0.95, 0.42, 0.0, 0.15), (1.12, 0.70, 0.0, 0.10),
                      (1.28, 0.98, 0.0, 0.075), (1.40, 1.05, 0.0, 0.07)], 5), 18))
    m.add(tube(curve([(-0.60, 0.82, 0.0, 0.06), (-1.00, 0.90, 0.0, 0.065),
                      (-1.27, 0.74, 0.0, 0.07), (-1.20, 0.44, 0.0, 0.065),
                      (-0.72, 0.26, 0.0, 0.06)], 6), 14))
    return m


def vase():
    """A vase with an outside, a rim and an inside."""
    outside = curve([(0.0, 0.0), (0.38, 0.0), (0.44, 0.05), (0.60, 0.40), (0.66, 0.75),
                     (0.52, 1.10), (0.30, 1.38), (0.27, 1.55), (0.42, 1.78)], 4)
    inside = curve([(0.38, 1.78), (0.22, 1.52), (0.26, 1.36), (0.46, 1.08), (0.58, 0.75),
                    (0.50, 0.40), (0.30, 0.10), (0.0, 0.08)], 2)
    return revolve(outside + inside, 40)


def gem():
    """A brilliant of 8 sides: table, crown, girdle, pavilion; its tip stands on y = 0."""
    m = Mesh()

    def ring(radius, y, turn):
        return [m.vertex((radius * math.cos(math.pi * (i + turn) / 4), y,
                          radius * math.sin(math.pi * (i + turn) / 4))) for i in range(8)]

    tip, girdle, table = m.vertex((0.0, 0.0, 0.0)), ring(1.0, 0.9, 0.0), ring(0.62, 1.25, 0.5)
    for i in range(8):
        k = (i + 1) % 8
        m.face((tip, girdle[i], girdle[k]))
        m.face((girdle[i], table[i], girdle[k]))
        m.face((table[i], table[k], girdle[k]))
        if i > 1:
            m.face((table[0], table[i], table[i - 1]))
    return m.outwards()


def mug():
    """A beaker with sharp rims outside and inside."""
    return revolve([(0.0, 0.0), (0.34, 0.0), (0.38, 0.3), (0.41, 0.6), (0.43, 0.9), (0.37, 0.9),
                    (0.35, 0.6), (0.32, 0.3), (0.29, 0.06), (0.0, 0.06)], 24)


def make_meshes():
    torus(40, 20, 0.72, 0.28).save("torus", "torus about the y axis, radii 0.72 and 0.28", True)
    vase().save("vase", "vase of revolution, 1.78 high, standing on y = 0", True)
    teapot().save("pot", "tea pot, 1.35 high, standing on y = 0, spout towards +x")
    blob(4).save("blob", "wavy ball of radius about 1")
    knot(256, 16, 0.17).save("knot", "tube along a trefoil knot, in the plane z = 0")
    mug().save_obj("mug", "beaker 0.9 high, standing on y = 0", 40)
    torus(24, 12, 0.5, 0.16).save_ply("ring", "torus about the y axis, radii 0.5 and 0.16")
    gem().save_stl("gem")
    box((90, 180, 90), 20).save("box_tall", "box 90 x 180 x 90, turned by 20 degrees")
    box((84, 84, 84), -24).save("box_short", "cube of side 84, turned by -24 degrees")


# ---------------------------------------------------------------------------------------------
# Plain textures
# ---------------------------------------------------------------------------------------------

def make_checker():
    """Eight by eight squares; a palette of two colours, one bit a pixel."""
    save_png("checker.png", [[(i // 8 + j // 8) & 1 for i in range(64)] for j in range(64)],
             "palette", 1, [(236, 232, 220), (38, 46, 66)])


def make_tiles():
    """A mosaic of sixteen tiles in a palette, four bits a pixel; entry 0 is the joint."""
    palette = [(205, 200, 188), (32, 92, 120), (44, 122, 142), (78, 156, 160), (140, 190, 178),
               (214, 206, 160), (226, 170, 96), (204, 112, 62), (160, 66, 50)]
    plan = ["1283", "4562", "2176", "8345"]
    image = []
    for j in range(128):
        row = []
        for i in range(128):
            x, y = i % 32, j % 32
            joint = x < 2 or y < 2
            row.append(0 if joint else int(plan[j // 32][i // 32]))
        image.append(row)
    save_png("tiles.png", image, "palette", 4, palette)


def make_pattern():
    """Bands for the vase: zigzags, dots and lines."""
    palette = [(232, 220, 192), (150, 62, 38), (34, 52, 84), (196, 150, 70)]
    image = []
    for j in range(128):
        row = []
        for i in range(256):
            zigzag = abs(i % 32 - 16)
            k = 0
            if j % 64 < 4 or 40 <= j % 64 < 44:
                k = 2
            elif 8 <= j % 64 < 36:
                k = 1 if abs(j % 64 - 12 - zigzag) < 5 else 0
            elif 46 <= j % 64 < 62:
                k = 3 if (i % 16 - 8) ** 2 + (j % 64 - 54) ** 2 < 26 else 0
            row.append(k)
        image.append(row)
    save_png("pattern.png", image, "palette", 4, palette)


def make_marble():
    """Veins in sixteen-bit grey."""
    size = 128
    warp = cloud_grid(size, size, 4, 4, 4, 11)
    fine = cloud_grid(size, size, 8, 8, 3, 12)
    image = []
    for j in range(size):
        row = []
        for i in range(size):
            wave = math.sin(2 * math.pi * (2 * i / size + j / size) + 9 * warp[j][i])
            vein = (1 - abs(wave)) ** 3
            row.append(int(65535 * clamp(0.93 - 0.62 * vein - 0.14 * (fine[j][i] - 0.5))))
        image.append(row)
    save_png("marble.png", image, "grey", 16)


def make_planet():
    """Seas, lands and ice, as an interlaced PNG; small, so that filtering shows."""
    noise, fine = SolidNoise(21), SolidNoise(22)

    def paint(d):
        h = noise(d, 2.3, 5) + 0.15 * (fine(d, 9, 2) - 0.5)
        cold = smooth(0.72, 0.9, abs(d[1]) + 0.25 * (fine(d, 5, 2) - 0.5))
        if h < 0.52:
            c = mix((12, 34, 92), (38, 112, 160), smooth(0.3, 0.52, h))
        else:
            land = mix((64, 122, 52), (176, 148, 92), smooth(0.53, 0.64, h))
            land = mix(land, (120, 96, 76), smooth(0.62, 0.7, h))
            c = mix((214, 200, 150), land, smooth(0.52, 0.54, h))
        return mix8(c, (240, 244, 248), cold)

    save_png("planet.png", sphere_map(256, 128, paint), "rgb", interlaced=True)


def make_bricks():
    """A brick wall and its normal map."""
    size = 256
    grain = cloud_grid(size, size, 16, 16, 3, 31)
    rng = random.Random(32)
    tones = [[rng.random() for _ in range(4)] for _ in range(8)]
    image, heights = [], []
    for j in range(size):
        course = j // 32
        row, line = [], []
        for i in range(size):
            x = (i + 32 * (course % 2)) % size
            edge = min(x % 64, 63 - x % 64, j % 32, 31 - j % 32)
            body = smooth(1.0, 4.0, edge + 1.5 * (grain[j][i] - 0.5))
            tone = tones[course][x // 64]
            brick = mix((138, 58, 42), (186, 96, 64), 0.7 * tone + 0.5 * (grain[j][i] - 0.5))
            mortar = mix((168, 160, 148), (190, 184, 172), grain[j][i])
            row.append(tuple(int(clamp(v, 0, 255)) & 0xFC for v in mix(mortar, brick, body)))
            line.append(body + 0.5 * grain[j][i])
        image.append(row)
        heights.append(line)
    save_png("brick.png", image, "rgb")
    save_png("brick_n.png", normal_map(heights, 1.6, 8), "rgb")


def make_ripples():
    """Rings and waves that repeat, as a normal map."""
    size = 128
    heights = []
    for j in range(size):
        row = []
        for i in range(size):
            x, y = 2 * math.pi * i / size, 2 * math.pi * j / size
            row.append(math.sin(3 * x + 1.2 * math.sin(y)) + 0.7 * math.sin(2 * y + math.sin(2 * x))
                       + 0.4 * math.sin(5 * x - 4 * y))
        heights.append(row)
    save_png("ripples_n.png", normal_map(heights, 1.7, 2), "rgb")


def make_court():
    """A floor of long wooden strips that repeats."""
    width = height = 512
    grain = cloud_grid(width, height, 64, 4, 3, 41)
    broad = cloud_grid(width, height, 32, 2, 2, 42)
    rng = random.Random(43)
    strips = 8
    starts = [rng.randrange(height) for _ in range(strips)]
    tones = [[rng.random() for _ in range(2)] for _ in range(strips)]
    image = []
    for j in range(height):
        row = []
        for i in range(width):
            s = i * strips // width
            p = (j + starts[s]) % height
            x = i % (width // strips)
            shade = 0.30 + 0.42 * tones[s][p * 2 // height] + 0.30 * (grain[j][i] - 0.5)
            shade += 0.16 * math.sin(26 * broad[j][i] + 5 * s) * grain[j][i]
            if x == 0 or p % (height // 2) < 2:
                shade -= 0.4
            row.append(shade)
        image.append(row)
    save_shades("court.png", image, (112, 62, 26), (236, 186, 118), 40)


def make_felt():
    fuzz = cloud_grid(128, 128, 32, 32, 2, 51)
    save_shades("felt.png", [[0.5 + 1.1 * (v - 0.5) for v in row] for row in fuzz],
                (190, 190, 190), (255, 255, 255), 16)


def make_clay():
    """Crushed brick, as a colour and as a normal map."""
    grains = noise_grid(256, 256, 128, 128, 61)
    broad = cloud_grid(256, 256, 4, 4, 4, 62)
    image = [[0.45 + 0.55 * (g - 0.5) + 0.7 * (b - 0.5) for g, b in zip(p, q)]
             for p, q in zip(grains, broad)]
    save_shades("clay.png", image, (136, 62, 34), (214, 122, 78), 24)
    save_png("clay_n.png", normal_map(noise_grid(128, 128, 64, 64, 63), 0.5, 8), "rgb")


def make_sky():
    """An evening sky with clouds."""
    clouds = cloud_grid(256, 128, 4, 4, 5, 71)
    image = []
    for j in range(128):
        v = j / 127
        base = mix((38, 84, 160), (236, 206, 168), v ** 1.5)
        row = []
        for i in range(256):
            c = smooth(0.5, 0.68, clouds[j][i]) * (1 - 0.5 * v)
            row.append(tuple(w & 0xFC for w in mix8(base, (252, 248, 240), 0.85 * c)))
        image.append(row)
    save_png("sky.png", image, "rgb")


def make_hall():
    """A wall of a dim room (panelling, windows, lamps) and its ceiling, for reflections."""
    width, height = 512, 256
    grain = cloud_grid(width, height, 64, 8, 3, 81)
    image = []
    for j in range(height):
        row = []
        for i in range(width):
            x, y = i % 128, j
            g = grain[j][i]
            if y > 168:                                    # panelling
                c = mix((52, 28, 14), (96, 56, 28), g)
                if x % 32 < 2 or y % 44 < 3:
                    c = mix(c, (20, 10, 6), 0.7)
            elif y > 162:                                  # rail
                c = (140, 92, 48)
            else:                                          # plaster
                c = mix((74, 70, 60), (108, 98, 80), 0.4 + 0.3 * g + 0.2 * y / 160)
            if 26 <= x < 86 and 36 <= y < 140:             # window
                wx, wy = (x - 26) % 30, (y - 36) % 52
                c = mix((226, 236, 246), (150, 182, 220), (y - 36) / 104)
                if wx < 2 or wx > 27 or wy < 2 or wy > 49:
                    c = (58, 34, 18)
            glow = math.hypot(x - 107, 1.2 * (y - 84))     # wall lamp
            c = mix(c, (255, 226, 160), clamp(1 - glow / 30) ** 2)
            if glow < 7:
                c = (255, 246, 214)
            row.append(tuple(int(v) & 0xF8 for v in c))
        image.append(row)
    save_png("hall.png", image, "rgb")

    image = []
    for j in range(128):
        row = []
        for i in range(128):
            x, y = i % 64, j % 64
            c = (44, 40, 34) if x % 32 > 3 and y % 32 > 3 else (28, 20, 14)
            lamp = max(abs(x - 32) - 20, abs(y - 32) - 5)
            c = (250, 244, 226) if lamp < 0 else mix(c, (250, 236, 200), 0.5 * clamp(1 - lamp / 9))
            row.append(tuple(int(v) & 0xFC for v in c))
        image.append(row)
    save_png("ceiling.png", image, "rgb")


# ---------------------------------------------------------------------------------------------
# Balls
# ---------------------------------------------------------------------------------------------

FONT = {  # five by seven, one string a row
    "0": ".###. #...# #..## #.#.# ##..# #...# .###.",
    "1": "..#.. .##.. ..#.. ..#.. ..#.. ..#.. .###.",
    "2": ".###. #...# ....# ..##. .#... #.... #####",
    "3": "####. ....# ....# .###. ....# ....# ####.",
    "4": "...#. ..##. .#.#. #..#. ##### ...#. ...#.",
    "5": "##### #.... ####. ....# ....# #...# .###.",
    "6": "..##. .#... #.... ####. #...# #...# .###.",
    "7": "##### ....# ...#. ..#.. ..#.. .#... .#...",
    "8": ".###. #...# #...# .###. #...# #...# .###.",
    "9": ".###. #...# #...# .#### ....# ...#. .##..",
}

BALL_COLOURS = [(242, 190, 30), (28, 62, 158), (206, 34, 30), (92, 42, 124), (236, 108, 26),
                (18, 108, 62), (128, 26, 34), (22, 22, 24)]
IVORY = (246, 240, 224)

# How each ball lies: yaw, pitch and roll in degrees; the pitch lifts the number to the viewer.
BALL_POSES = [(-14, 34, 8), (16, 26, -12), (-24, 30, 14), (20, 40, 6), (-10, 44, -18),
              (26, 22, 10), (-28, 24, -8), (4, 46, 4), (30, 34, 24), (-8, 28, -26),
              (18, 42, 16), (-20, 36, 30), (12, 30, -20), (-26, 46, 12), (24, 38, -14)]


def digit_ink(text, x, y):
    """How much of the text's ink is at x, y; the text is centred, each dot has side 1."""
    width = 6 * len(text) - 1
    total = 0
    for sx in (-0.33, 0.0, 0.33):
        for sy in (-0.33, 0.0, 0.33):
            column = math.floor(x + sx + width / 2)
            row = math.floor(3.5 - (y + sy))
            if 0 <= row < 7 and 0 <= column < width and column % 6 < 5:
                glyph = FONT[text[column // 6]].split()
                total += glyph[row][column % 6] == "#"
    return total / 9


def make_billiard_balls():
    """Balls 1 to 15: solid to 8, with a band from 9 on; two numbers each, on opposite sides."""
    for ball in range(1, 16):
        colour = BALL_COLOURS[(ball - 1) % 8]
        ex, ey, ez = turned(*BALL_POSES[ball - 1])
        text, dots = str(ball), 0.052

        def paint(d):
            x, y, z = dot(ex, d), dot(ey, d), dot(ez, d)
            c = colour
            if ball > 8:
                c = mix(IVORY, colour, smooth(-0.012, 0.012, 0.52 - abs(y)))
            disc = math.acos(clamp(abs(z), 0, 1))
            if disc < 0.46:
                c = mix(c, IVORY, smooth(-0.012, 0.012, 0.43 - disc))
                side = -1 if z > 0 else 1
                c = mix(c, (20, 20, 22), digit_ink(text, side * x / dots, y / dots))
            return tuple(int(v + 0.5) for v in c)

        save_png("ball%02d.png" % ball, sphere_map(512, 256, paint), "rgb")


def seam(parts):
    """Points along a tennis ball's seam."""
    a, b = 0.76, 0.24
    c = 2 * math.sqrt(a * b)
    out = []
    for k in range(parts):
        t = 2 * math.pi * k / parts
        out.append(unit((a * math.cos(t) + b * math.cos(3 * t), c * math.sin(2 * t),
                         a * math.sin(t) - b * math.sin(3 * t))))
    return out


def make_tennis_ball():
    width, height = 512, 256
    ex, ey, ez = turned(20, 30, 15)
    line = [tuple(p[0] * ex[k] + p[1] * ey[k] + p[2] * ez[k] for k in range(3))
            for p in seam(900)]
    far = [[1.0] * width for _ in range(height)]

    def nearer(i, j, angle):
        if angle < far[j][i]:
            far[j][i] = angle

    splat(width, height, line, 0.16, nearer)
    fuzz = noise_grid(width, height, 128, 64, 91)
    fine = noise_grid(width, height, 256, 128, 92)
    image, heights = [], []
    for j in range(height):
        row, bumps = [], []
        for i in range(width):
            hair = 0.5 * fuzz[j][i] + 0.5 * fine[j][i]
            felt = mix((150, 184, 24), (220, 240, 70), hair)
            rubber = 1 - smooth(0.044, 0.062, far[j][i])
            row.append(tuple(v & 0xF8 for v in mix8(felt, (238, 238, 230), rubber)))
            bumps.append((0.55 * hair + 0.9 * smooth(0.05, 0.12, far[j][i])) * (1 - 0.6 * rubber))
        image.append(row)
        heights.append(bumps)
    save_png("tennis.png", image, "rgb")
    save_png("tennis_n.png", normal_map(heights, 1.5, 16, wrap_v=False), "rgb")


def make_basketball():
    width, height = 512, 256
    ex, ey, ez = turned(24, 20, -18)
    count = 3000
    golden = math.pi * (3 - math.sqrt(5))
    pebbles = []
    for k in range(count):
        y = 1 - 2 * (k + 0.5) / count
        r = math.sqrt(1 - y * y)
        pebbles.append((r * math.cos(golden * k), y, r * math.sin(golden * k)))
    radius = 0.034
    bumps = [[0.0] * width for _ in range(height)]

    def raise_bump(i, j, angle):
        bumps[j][i] = max(bumps[j][i], math.sqrt(1 - (angle / radius) ** 2))

    splat(width, height, pebbles, radius, raise_bump)

    def groove(d):
        """Angle from the nearest of the ball's lines."""
        x, y = dot(ex, d), dot(ey, d)
        slope = (math.copysign(1.0, x), -1.9 * y)
        g = abs(x) - (0.32 + 0.95 * y * y)
        inward = slope[0] * x + slope[1] * y
        steep = math.sqrt(max(slope[0] ** 2 + slope[1] ** 2 - inward ** 2, 0.04))
        return min(abs(x), abs(y), abs(g) / steep)

    lines = sphere_map(width, height, groove)
    grain = cloud_grid(width, height, 16, 8, 3, 95)
    image, heights = [], []
    for j in range(height):
        row, line = [], []
        for i in range(width):
            ink = 1 - smooth(0.020, 0.034, lines[j][i])
            leather = mix((164, 74, 26), (214, 112, 46), 0.5 * bumps[j][i] + 0.5 * grain[j][i])
            row.append(tuple(v & 0xF8 for v in mix8(leather, (26, 20, 18), ink)))
            line.append(0.7 * bumps[j][i] * (1 - ink) + 1.6 * smooth(0.0, 0.05, lines[j][i]))
        image.append(row)
        heights.append(line)
    save_png("basketball.png", image, "rgb")
    save_png("basketball_n.png", normal_map(heights, 0.6, 16, wrap_v=False), "rgb")


def main():
    global OUT
    if len(sys.argv) > 1:
        OUT = sys.argv[1]
    os.makedirs(OUT, exist_ok=True)
    for make in (make_meshes, make_checker, make_tiles, make_pattern, make_marble, make_planet,
                 make_bricks, make_ripples, make_court, make_felt, make_clay, make_sky, make_hall,
                 make_billiard_balls, make_tennis_ball, make_basketball):
        make()


if __name__ == "__main__":
    main()
