#!/usr/bin/env python3
"""Writes room.glb beside this script (or to the path given): a furnished room of our own, the one that ./dev play opens.

    python3 assets/make_room.py [--flicker] [room.glb]

Python 3.9 or newer, standard library only. The same script always writes the same bytes.

A living room of 5.2 x 2.8 x 4.4 m, metres, y up, seen from +z through its front wall, which like all surfaces is
one-sided. Daylight (extras.sky and a sun) falls in through a window on the left. Lights that switch: the pendant over
the table, the floor lamp by the sofa, the table lamp, which stands on cube1 and goes where its player goes, and the sky
with its sun. --flicker: the table lamp is a candle, which flickers.

Every surface is a grid, laid flat into the atlas (TEXCOORD_1) as a rectangle of whole cells, 128 cells a side: at 256
texels a cell is 2 x 2, a gutter of two texels lies around each chart, and each chart holds a texel down to 128. Radiance
in W m^-2 sr^-1, sun in W m^-2: a dim day, so that lamps can be told beside it.
"""
import math
import pathlib
import random
import struct
import sys
import zlib

from glb import Glb

CELLS = 128
WIDTH, HEIGHT, DEPTH = 5.2, 2.8, 4.4
X, Z = WIDTH / 2, DEPTH / 2
WINDOW = (0.95, 2.25, -1.15, 0.45)  # y and z from .. to, in the wall at -X
SKY = (0.9, 1.15, 1.5)
SUN, SUN_ALONG = (9.0, 7.6, 5.6), (0.80, -0.52, -0.30)
PENDANT, FLOOR_LAMP, TABLE_LAMP = (26.0, 19.5, 11.5), (5.2, 3.5, 1.9), (9.0, 6.2, 3.1)


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def times(a, k):
    return tuple(x * k for x in a)


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return times(a, 1 / length) if length > 0 else (0.0, 1.0, 0.0)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def distance(a, b):
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b)))


class Patch:
    """points[j][i], i to the right and j up as seen from the front; `detail`: cells a metre, times all others'."""

    def __init__(self, points, normals=None, detail=1.0):
        self.points, self.detail = points, detail
        self.normals = normals or self.own_normals()
        rows, columns = len(points), len(points[0])
        self.width = max(sum(distance(row[i], row[i + 1]) for i in range(columns - 1)) for row in points)
        self.height = max(sum(distance(points[j][i], points[j + 1][i]) for j in range(rows - 1)) for i in range(columns))
        self.cells = self.chart = None

    def own_normals(self):
        p, rows, columns = self.points, len(self.points), len(self.points[0])

        def at(j, i):
            right = minus(p[j][min(i + 1, columns - 1)], p[j][max(i - 1, 0)])
            up = minus(p[min(j + 1, rows - 1)][i], p[max(j - 1, 0)][i])
            return unit(cross(right, up))

        return [[at(j, i) for i in range(columns)] for j in range(rows)]

    def moved(self, by):
        return Patch([[add(p, by) for p in row] for row in self.points], self.normals, self.detail)

    def turned(self, angle):
        """About y."""
        c, s = math.cos(angle), math.sin(angle)

        def turn(p):
            return (c * p[0] + s * p[2], p[1], c * p[2] - s * p[0])

        return Patch([[turn(p) for p in row] for row in self.points], [[turn(n) for n in row] for row in self.normals],
                     self.detail)


def quad(a, b, c, d, detail=1.0):
    """Corners counter-clockwise from the front."""
    return [Patch([[a, b], [d, c]], detail=detail)]


def panel(origin, right, up, detail=1.0):
    return quad(origin, add(origin, right), add(add(origin, right), up), add(origin, up), detail)


def box(low, high, detail=1.0, without=""):
    """Faces outwards: t(op), b(ottom), l(eft), r(ight), f(ront), k (back)."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    faces = {
        "t": ((x0, y1, z1), (x1, y1, z1), (x1, y1, z0), (x0, y1, z0)),
        "b": ((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)),
        "f": ((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)),
        "k": ((x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0)),
        "r": ((x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1)),
        "l": ((x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)),
    }
    return [patch for name, corners in faces.items() if name not in without for patch in quad(*corners, detail)]


def soft_box(low, high, radius, steps=7, detail=1.0):
    """A cushion: a box whose edges are round."""
    middle = times(add(low, high), 0.5)
    inner = [(h - l) / 2 - radius for l, h in zip(low, high)]

    def rounded(p):
        core = tuple(max(-k, min(k, x)) for x, k in zip(p, inner))
        out = unit(minus(p, core))
        return add(middle, add(core, times(out, radius))), out

    patches = []
    for face in box(minus(low, middle), minus(high, middle), detail):
        (a, b), (d, c) = face.points
        grid = [[add(times(add(times(a, 1 - s), times(b, s)), 1 - t), times(add(times(d, 1 - s), times(c, s)), t))
                 for s in curve(steps)] for t in curve(steps)]
        pairs = [[rounded(p) for p in row] for row in grid]
        patches.append(Patch([[p for p, _ in row] for row in pairs], [[n for _, n in row] for row in pairs], detail))
    return patches


def curve(steps):
    """0..1, denser at both ends."""
    return [(1 - math.cos(math.pi * i / steps)) / 2 for i in range(steps + 1)]


def lathe(profile, sides, at=(0.0, 0.0, 0.0), detail=1.0):
    """Turns (radius, height) pairs, from below upwards as seen from outside, about y."""
    ring = [2 * math.pi * i / sides for i in range(sides + 1)]
    points = [[add(at, (r * math.cos(-a), h, r * math.sin(-a))) for a in ring] for r, h in profile]
    slopes = []
    for j in range(len(profile)):
        (r0, h0), (r1, h1) = profile[max(j - 1, 0)], profile[min(j + 1, len(profile) - 1)]
        slopes.append((h1 - h0, r0 - r1))
    normals = [[unit((out * math.cos(-a), up, out * math.sin(-a))) for a in ring] for out, up in slopes]
    return [Patch(points, normals, detail)]


def disc(radius, sides, at, up, detail=1.0):
    """A lid that looks up or down."""
    turn = 1 if up else -1
    ring = [turn * 2 * math.pi * i / sides for i in range(sides + 1)]
    rows = [[add(at, (r * math.cos(-a), 0, r * math.sin(-a))) for a in ring] for r in (radius, radius * 0.02)]
    normal = (0.0, 1.0 if up else -1.0, 0.0)
    patch = Patch(rows, [[normal] * len(ring)] * 2, detail)
    patch.width = patch.height = radius * 1.6
    return [patch]


def ball(radius, at, steps=16, detail=1.0):
    profile = [(radius * math.sin(math.pi * j / steps) + 1e-4, -radius * math.cos(math.pi * j / steps))
               for j in range(steps + 1)]
    return lathe(profile, 2 * steps, at, detail)


def cylinder(radius, y0, y1, sides, at=(0.0, 0.0, 0.0), detail=1.0, top=True, bottom=True):
    x, y, z = at
    patches = lathe([(radius, y0), (radius, y1)], sides, at, detail)
    patches[0].normals = [[unit((n[0], 0, n[2])) for n in row] for row in patches[0].normals]
    if top:
        patches += disc(radius, sides, (x, y + y1, z), True, detail)
    if bottom:
        patches += disc(radius, sides, (x, y + y0, z), False, detail)
    return patches


def moved(patches, by, angle=0.0):
    return [patch.turned(angle).moved(by) if angle else patch.moved(by) for patch in patches]


# --- textures: coarse, as the light map's texels are -------------------------------------------------------------


def png(width, height, pixel):
    """pixel(x, y) -> linear RGB."""

    def srgb(v):
        v = min(max(v, 0.0), 1.0)
        return round(255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055))

    rows = b"".join(b"\0" + bytes(srgb(v) for x in range(width) for v in pixel(x, y)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def boards():
    """Planks along x, each a shade of its own."""
    chance = random.Random(5)
    shades = [[0.78 + 0.44 * chance.random() for _ in range(4)] for _ in range(22)]

    def pixel(x, y):
        row = y // 4
        shade = shades[row % 22][((x + 37 * row) // 24) % 4]
        return times((0.36, 0.21, 0.11), shade)

    return png(88, 88, pixel)


def rug():
    def pixel(x, y):
        edge = min(x, y, 59 - x, 39 - y)
        if edge < 3:
            return (0.42, 0.33, 0.20)
        if edge < 6:
            return (0.32, 0.05, 0.06)
        diamond = (abs((x - 29.5) / 24) + abs((y - 19.5) / 14))
        if diamond < 0.35:
            return (0.55, 0.42, 0.24)
        return (0.10, 0.14, 0.26) if diamond < 0.8 else (0.34, 0.07, 0.07)

    return png(60, 40, pixel)


def books():
    chance = random.Random(11)
    colours = [(0.45, 0.08, 0.06), (0.08, 0.16, 0.30), (0.50, 0.40, 0.22), (0.08, 0.22, 0.14), (0.55, 0.50, 0.42),
               (0.30, 0.12, 0.20), (0.60, 0.30, 0.08)]
    spines = []
    while len(spines) < 32:
        spines += [chance.choice(colours)] * chance.choice((2, 2, 3))
    return png(32, 4, lambda x, y: spines[x])


def landscape():
    def pixel(x, y):
        hill = 13 + 3 * math.sin(x / 5.0)
        if y > hill + 5:
            return (0.10, 0.20, 0.06)
        if y > hill:
            return (0.24, 0.34, 0.10)
        sun = (x - 23) ** 2 + (y - 6) ** 2
        return (0.95, 0.75, 0.35) if sun < 8 else (0.45 + 0.012 * y, 0.55, 0.72 - 0.015 * y)

    return png(32, 24, pixel)


def squares():
    colours = [(0.70, 0.10, 0.06), (0.85, 0.62, 0.10), (0.08, 0.20, 0.45), (0.75, 0.72, 0.64), (0.05, 0.05, 0.06)]

    def pixel(x, y):
        return colours[(3 * (x // 6) + 2 * (y // 8) + (x // 6) * (y // 8)) % 5]

    return png(18, 24, pixel)


# --- the atlas -----------------------------------------------------------------------------------------------------


def pack(patches, density):
    """Shelves of charts with a cell between any two; False if they do not fit."""
    for patch in patches:
        patch.cells = (max(1, round(patch.width * density * patch.detail)),
                       max(1, round(patch.height * density * patch.detail)))
        if max(patch.cells) > CELLS - 2:
            return False
    column = row = 1
    shelf = 0
    for patch in sorted(patches, key=lambda patch: (-patch.cells[1], -patch.cells[0])):
        width, height = patch.cells
        if column + width > CELLS - 1:
            column, row, shelf = 1, row + shelf + 1, 0
        if row + height > CELLS - 1:
            return False
        patch.chart = (column, row, width, height)
        column += width + 1
        shelf = max(shelf, height)
    return True


def lay_out(patches):
    """As many cells a metre as fit."""
    low, high = 0.5, 40.0
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if pack(patches, middle) else (low, middle)
    assert pack(patches, low)
    return low


class Room:
    def __init__(self):
        self.glb = Glb()
        self.parts = []  # (node, patches, material)

    def texture(self, data):
        gltf = self.glb.gltf
        gltf.setdefault("samplers", [{"magFilter": 9729, "minFilter": 9729}])
        gltf.setdefault("images", []).append({"bufferView": self.glb.view(data), "mimeType": "image/png"})
        gltf.setdefault("textures", []).append({"source": len(gltf["images"]) - 1, "sampler": 0})
        return len(gltf["textures"]) - 1

    def add(self, name, patches, material, **node):
        node = dict(node, name=name)
        self.parts.append((node, patches, material))
        return node

    def write(self):
        density = lay_out([patch for _, patches, _ in self.parts for patch in patches])
        nodes = [self.glb.node(**dict(node, mesh=self.mesh(node["name"], patches, material)))
                 for node, patches, material in self.parts]
        return nodes, density

    def mesh(self, name, patches, material):
        positions, normals, picture, atlas, indices = [], [], [], [], []
        for patch in patches:
            column, row, width, height = patch.chart
            rows, columns = len(patch.points), len(patch.points[0])
            first = len(positions)
            for j in range(rows):
                for i in range(columns):
                    s, t = self.along(patch, j, i)
                    positions.append(patch.points[j][i])
                    normals.append(patch.normals[j][i])
                    picture.append((s, 1 - t))
                    atlas.append(((column + s * width) / CELLS, (row + (1 - t) * height) / CELLS))
            for j in range(rows - 1):
                for i in range(columns - 1):
                    a = first + j * columns + i
                    indices += [a, a + 1, a + columns + 1, a, a + columns + 1, a + columns]
        return self.glb.mesh(name, positions, normals, picture, atlas, indices, material)

    @staticmethod
    def along(patch, j, i):
        return i / (len(patch.points[0]) - 1), j / (len(patch.points) - 1)


def walls(room, plaster, warm, cool):
    y0, y1, z0, z1 = WINDOW
    room.add("floor", panel((-X, 0, Z), (WIDTH, 0, 0), (0, 0, -DEPTH)), room.boards)
    room.add("ceiling", panel((-X, HEIGHT, -Z), (WIDTH, 0, 0), (0, 0, DEPTH), 0.6), plaster)
    room.add("back wall", panel((-X, 0, -Z), (WIDTH, 0, 0), (0, HEIGHT, 0)), cool)
    room.add("front wall", panel((X, 0, Z), (-WIDTH, 0, 0), (0, HEIGHT, 0), 0.5), plaster)
    room.add("right wall", panel((X, 0, -Z), (0, 0, DEPTH), (0, HEIGHT, 0), 0.8), warm)
    left = []
    for low, high, near, far in ((0, y0, -Z, Z), (y1, HEIGHT, -Z, Z), (y0, y1, -Z, z0), (y0, y1, z1, Z)):
        left += panel((-X, low, far), (0, 0, near - far), (0, high - low, 0), 0.8)
    room.add("left wall", left, plaster)


def window(room, white, curtain):
    y0, y1, z0, z1 = WINDOW
    x, w = -X + 0.035, 0.03
    bars = []
    for low, high in (((y0, z0), (y0 + 0.07, z1)), ((y1 - 0.07, z0), (y1, z1)), ((y0, z0), (y1, z0 + 0.07)),
                      ((y0, z1 - 0.07), (y1, z1)), ((y0, (z0 + z1) / 2 - 0.03), (y1, (z0 + z1) / 2 + 0.03)),
                      ((y0 + 0.86, z0), (y0 + 0.91, z1))):
        bars += box((x - w, low[0], low[1]), (x + w, high[0], high[1]), 0.7)
    room.add("window frame", bars, white)
    room.add("window sill", box((-X + 0.003, y0 - 0.035, z0 - 0.06), (-X + 0.16, y0, z1 + 0.06)), white)
    for name, near, far in (("left curtain", z1 + 0.02, z1 + 0.52), ("right curtain", z0 - 0.52, z0 - 0.02)):
        def fold(t, out):
            return (-X + 0.10 + out + 0.035 * math.sin(2 * math.pi * 4 * t), 0.0, near + (far - near) * t)
        sides = []
        for out, turn in ((0.012, True), (-0.012, False)):
            ts = [i / 48 for i in range(49)]
            row = [fold(t, out) for t in (ts[::-1] if turn else ts)]
            heights = [0.06 + (2.46 - 0.06) * j / 8 for j in range(9)]
            sides.append(Patch([[(p[0], h, p[2]) for p in row] for h in heights], detail=0.8))
        room.add(name, sides, curtain)
    rod = cylinder(0.014, -1.5, 1.5, 12)[0]
    turn = [[(p[0], p[2], p[1]) for p in row] for row in rod.points]
    room.add("curtain rod", [Patch([row[::-1] for row in turn]).moved((-X + 0.10, 2.48, -0.35))], room.brass)


def door(room, white, brass):
    x, z = X, 0.62
    leaf = box((x - 0.045, 0.005, z), (x - 0.004, 2.05, z + 0.86))
    for low, high in ((0.18, 0.92), (1.08, 1.90)):
        leaf += box((x - 0.062, low, z + 0.13), (x - 0.0451, high, z + 0.73))
    room.add("door", leaf, white)
    frame = box((x - 0.06, 0, z - 0.09), (x - 0.002, 2.14, z - 0.005)) + box((x - 0.06, 0, z + 0.865),
                                                                            (x - 0.002, 2.14, z + 0.95))
    room.add("door frame", frame + box((x - 0.06, 2.055, z - 0.005), (x - 0.002, 2.14, z + 0.865)), white)
    room.add("door handle", ball(0.032, (x - 0.10, 1.02, z + 0.08), 8) +
             box((x - 0.10, 1.012, z + 0.072), (x - 0.046, 1.028, z + 0.088)), brass)


def table(room, wood):
    top = soft_box((-0.62, 0.71, -0.42), (0.62, 0.75, 0.42), 0.018, 4)
    legs = []
    for x in (-0.54, 0.54):
        for z in (-0.34, 0.34):
            legs += box((x - 0.03, 0.004, z - 0.03), (x + 0.03, 0.711, z + 0.03), 0.8)
    at = (0.72, 0, -0.55)
    room.add("table", moved(top + legs, at), wood)
    bowl = lathe([(0.05, 0), (0.11, 0.025), (0.15, 0.07), (0.16, 0.09)], 24) + \
        lathe([(0.152, 0.09), (0.14, 0.072), (0.10, 0.032), (0.004, 0.02)], 24)
    room.add("bowl", moved(bowl, add(at, (0.15, 0.752, 0.02))), room.clay)
    fruit = ball(0.045, (0.15, 0.82, 0.05), 8) + ball(0.042, (0.09, 0.815, -0.02), 8) + ball(0.044, (0.2, 0.818, -0.03), 8)
    room.add("oranges", moved(fruit, at), room.orange)
    mug = cylinder(0.04, 0, 0.09, 20, bottom=True, top=False) + lathe([(0.034, 0.09), (0.034, 0.012), (0.002, 0.01)], 20)
    room.add("mug", moved(mug, add(at, (-0.32, 0.752, 0.16))), room.blue)
    for number, (x, z, angle) in enumerate(((-0.30, 0.80, 0.25), (0.05, -0.72, math.pi + 0.1))):
        seat = soft_box((-0.2, 0.43, -0.2), (0.2, 0.47, 0.2), 0.018, 3)
        for lx in (-0.17, 0.17):
            for lz in (-0.17, 0.17):
                seat += box((lx - 0.02, 0.004, lz - 0.02), (lx + 0.02, 0.431, lz + 0.02), 0.8)
        for lx in (-0.17, 0.17):
            seat += box((lx - 0.02, 0.469, 0.15), (lx + 0.02, 0.9, 0.19), 0.8)
        for y in (0.62, 0.80):
            seat += box((-0.15, y, 0.155), (0.15, y + 0.08, 0.18))
        room.add("chair %d" % (number + 1), moved(seat, add(at, (x, 0, z)), angle), wood)


def pendant(room, dark):
    at = (0.72, 0, -0.55)
    room.add("pendant shade", moved(lathe([(0.20, 1.62), (0.17, 1.72), (0.10, 1.80), (0.03, 1.83)], 32) +
                                    lathe([(0.026, 1.826), (0.095, 1.795), (0.163, 1.717), (0.194, 1.62)], 32), at), dark)
    room.add("pendant cord", moved(cylinder(0.008, 1.83, HEIGHT - 0.005, 8, top=False, bottom=False), at), dark)
    room.add("pendant", moved(ball(0.05, (0, 1.70, 0), 10), at), room.glow("pendant", PENDANT),
             extras={"switchable": True})


def sofa(room, cloth):
    at = (-1.22, 0, -1.62)
    body = soft_box((-1.0, 0.10, -0.42), (1.0, 0.34, 0.42), 0.05, 6)
    body += soft_box((-1.0, 0.30, -0.50), (1.0, 0.86, -0.26), 0.09, 7)
    for x in (-1.12, 0.92):
        body += soft_box((x, 0.10, -0.48), (x + 0.20, 0.60, 0.44), 0.07, 6)
    room.add("sofa", moved(body, at), cloth)
    seats = soft_box((-0.9, 0.345, -0.25), (-0.01, 0.47, 0.42), 0.05, 7) + soft_box((0.01, 0.345, -0.25), (0.9, 0.47, 0.42),
                                                                              0.05, 7)
    room.add("seat cushions", moved(seats, at), cloth)
    pillow = soft_box((-0.2, -0.2, -0.06), (0.2, 0.2, 0.06), 0.055, 8)
    room.add("pillow", moved(pillow, add(at, (-0.62, 0.685, -0.13)), 0.15), room.red)
    room.add("other pillow", moved(pillow, add(at, (0.62, 0.685, -0.13)), -0.2), room.ochre)
    feet = []
    for x in (-0.98, 0.98):
        for z in (-0.36, 0.34):
            feet += cylinder(0.025, 0.004, 0.11, 10, (x, 0, z), 0.7, top=False)
    room.add("sofa feet", moved(feet, at), room.wood)


def floor_lamp(room, dark):
    at = (0.32, 0, -1.80)
    room.add("floor lamp stand", moved(cylinder(0.14, 0.004, 0.03, 24) + cylinder(0.012, 0.03, 1.42, 10, top=False,
                                                                                  bottom=False), at), dark)
    room.add("floor lamp", moved(lathe([(0.19, 1.34), (0.13, 1.62)], 32) + disc(0.13, 32, (0, 1.62, 0), True) +
                                 disc(0.19, 32, (0, 1.34, 0), False), at), room.glow("lampshade", FLOOR_LAMP),
             extras={"switchable": True})


def shelf(room, wood):
    x0, x1, depth, height = 1.35, 2.45, 0.30, 1.9
    z0, z1 = -Z + 0.004, -Z + depth
    boards_ = box((x0, 0.004, z0), (x0 + 0.03, height, z1)) + box((x1 - 0.03, 0.004, z0), (x1, height, z1))
    levels = [0.06 + i * 0.45 for i in range(5)]
    for y in levels:
        boards_ += box((x0 + 0.031, y, z0), (x1 - 0.031, y + 0.028, z1), without="lr")
    boards_ += panel((x0 + 0.031, 0.09, z0 + 0.006), (x1 - x0 - 0.062, 0, 0), (0, height - 0.12, 0), 0.7)
    room.add("bookshelf", boards_, wood)
    rows = ((0, 0.04, 0.98, 0.27), (1, 0.04, 0.52, 0.25), (1, 0.70, 0.99, 0.30), (2, 0.04, 0.80, 0.26), (3, 0.35, 0.98, 0.24))
    volumes = []
    for level, left, right, tall in rows:
        y = levels[level] + 0.030
        volumes += box((x0 + 0.03 + left, y, z0 + 0.05), (x0 + 0.05 + right, y + tall, z1 - 0.04), without="b")
    room.add("books", volumes, room.books)
    vase = lathe([(0.045, 0), (0.085, 0.06), (0.09, 0.12), (0.05, 0.2), (0.035, 0.25), (0.045, 0.28)], 28) + \
        disc(0.044, 28, (0, 0.272, 0), True)
    room.add("vase", moved(vase, (x0 + 0.68, levels[1] + 0.030, -Z + 0.17)), room.blue)
    room.add("globe", ball(0.12, (x0 + 0.2, levels[3] + 0.155, -Z + 0.17), 14), room.clay)
    room.add("small box", box((x0 + 0.35, levels[4] + 0.03, -Z + 0.08), (x0 + 0.62, levels[4] + 0.15, -Z + 0.26)), room.red)


def pictures(room):
    for name, x, y, width, height, texture in (("landscape", -1.75, 1.35, 0.92, 0.66, room.landscape),
                                               ("squares", -0.45, 1.30, 0.52, 0.72, room.squares)):
        room.add(name, panel((x, y, -Z + 0.022), (width, 0, 0), (0, height, 0), 1.5), texture)
        f = 0.045
        frame = []
        for low, high in (((x - f, y - f), (x + width + f, y)), ((x - f, y + height), (x + width + f, y + height + f)),
                          ((x - f, y), (x, y + height)), ((x + width, y), (x + width + f, y + height))):
            frame += box((low[0], low[1], -Z + 0.003), (high[0], high[1], -Z + 0.035), without="k")
        room.add(name + " frame", frame, room.dark_wood)


def plant(room):
    at = (-1.95, 0, 1.35)
    pot = lathe([(0.13, 0.004), (0.17, 0.28), (0.185, 0.30)], 24) + disc(0.17, 24, (0, 0.28, 0), True)
    room.add("plant pot", moved(pot, at), room.clay)
    chance = random.Random(3)
    leaves = []
    for number in range(11):
        turn, lean = 2.4 * number, 0.2 + 0.35 * chance.random()
        length, width = 0.45 + 0.3 * chance.random(), 0.065
        for front in (True, False):
            grid = []
            for j in range(9):
                t = j / 8
                out, up = length * t * math.sin(lean + 0.7 * t), length * t * math.cos(lean + 0.5 * t)
                half = width * math.sin(math.pi * (0.08 + 0.90 * t))
                lift = 0.004 if front else -0.004
                row = [(out - lift, up + 0.27 + lift + 0.25 * abs(s) * half, s * half) for s in (-1, -0.5, 0, 0.5, 1)]
                grid.append(row if not front else row[::-1])
            leaves.append(Patch(grid, detail=0.6).turned(turn))
    room.add("plant", moved(leaves, at), room.leaf)


def radiator(room, white):
    fins = []
    for i in range(9):
        z = -1.0 + 0.155 * i
        fins += soft_box((-X + 0.03, 0.14, z), (-X + 0.13, 0.74, z + 0.12), 0.03, 3)
    room.add("radiator", fins, white)


def players(room, flicker):
    """Two cubes that move in the plane before the furniture; the lamp stands on the first."""
    z = 0.95
    crate = box((-0.17, -0.17, -0.17), (0.17, 0.17, 0.17), 1.2)
    lamp = lathe([(0.075, 0.1702), (0.07, 0.19), (0.03, 0.215), (0.02, 0.25), (0.02, 0.36)], 24, detail=1.5)
    room.add("cube1", crate, room.ochre_paint, translation=[-0.85, 0.172, z], extras={"movable": True})
    room.child("cube1", "lamp foot", lamp, room.brass)
    shade = lathe([(0.13, 0.36), (0.085, 0.54)], 28, detail=1.5) + disc(0.085, 28, (0, 0.54, 0), True) + disc(0.13, 28, (0, 0.36, 0), False, 1.5)
    extras = {"switchable": True}
    if flicker:
        extras["flicker"] = 0.5
    room.child("cube1", "table lamp", shade, room.glow("small shade", TABLE_LAMP), extras)
    room.add("cube2", soft_box((-0.17, -0.17, -0.17), (0.17, 0.17, 0.17), 0.03, 5, 1.2), room.blue_paint,
             translation=[1.35, 0.172, z], extras={"movable": True})


class Furnished(Room):
    def __init__(self):
        super().__init__()
        glb = self.glb
        self.children = []
        self.boards = glb.material("boards", (1, 1, 1), texture=self.texture(boards()))
        self.rug = glb.material("rug", (1, 1, 1), texture=self.texture(rug()))
        self.books = glb.material("books", (1, 1, 1), texture=self.texture(books()))
        self.landscape = glb.material("landscape", (1, 1, 1), texture=self.texture(landscape()))
        self.squares = glb.material("squares", (1, 1, 1), texture=self.texture(squares()))
        for name, colour in (("plaster", (0.72, 0.70, 0.66)), ("warm", (0.66, 0.40, 0.27)), ("cool", (0.30, 0.42, 0.40)),
                             ("white", (0.76, 0.75, 0.72)), ("wood", (0.40, 0.22, 0.11)), ("dark_wood", (0.13, 0.07, 0.04)),
                             ("dark", (0.06, 0.06, 0.07)), ("cloth", (0.16, 0.22, 0.30)), ("curtain", (0.62, 0.55, 0.42)),
                             ("brass", (0.55, 0.40, 0.16)), ("clay", (0.52, 0.24, 0.14)), ("orange", (0.80, 0.33, 0.05)),
                             ("blue", (0.10, 0.22, 0.45)), ("red", (0.50, 0.07, 0.06)), ("ochre", (0.62, 0.40, 0.10)),
                             ("leaf", (0.16, 0.40, 0.12)), ("ochre_paint", (0.80, 0.42, 0.10)),
                             ("blue_paint", (0.10, 0.28, 0.70))):
            setattr(self, name, glb.material(name.replace("_", " "), colour))

    def glow(self, name, radiance):
        return self.glb.material(name, (0.6, 0.6, 0.6), radiance)

    def child(self, parent, name, patches, material, extras=None):
        node = self.add(name, patches, material, **({"extras": extras} if extras else {}))
        self.children.append((parent, node))


def furnished(flicker=False):
    room = Furnished()
    walls(room, room.plaster, room.warm, room.cool)
    window(room, room.white, room.curtain)
    door(room, room.white, room.brass)
    room.add("rug", box((-1.75, 0.002, -0.70), (0.05, 0.014, 0.55), 1.2, without="b"), room.rug)
    sofa(room, room.cloth)
    table(room, room.wood)
    pendant(room, room.dark)
    floor_lamp(room, room.dark)
    shelf(room, room.wood)
    pictures(room)
    plant(room)
    radiator(room, room.white)
    players(room, flicker)
    nodes, density = room.write()
    names = [node["name"] for node, _, _ in room.parts]
    below = {child["name"] for _, child in room.children}
    for parent, child in room.children:
        room.glb.gltf["nodes"][nodes[names.index(parent)]].setdefault("children", []).append(
            nodes[names.index(child["name"])])
    roots = [node for node, name in zip(nodes, names) if name not in below]
    roots.append(add_sun(room.glb))
    print("%.1f texels a metre at 256" % (2 * density), file=sys.stderr)
    return room.glb.bytes("Lichtveld assets/make_room.py",
                          {"name": "room", "nodes": roots, "extras": {"sky": list(SKY), "switchable": True}})


def add_sun(glb):
    """A directional light shines along its node's -z."""
    glb.use("KHR_lights_punctual")
    most = max(SUN)
    glb.gltf["extensions"] = {"KHR_lights_punctual": {"lights": [
        {"type": "directional", "name": "sun", "intensity": most, "color": [c / most for c in SUN]}]}}
    x, y, z = unit(SUN_ALONG)
    # The half turn about the middle of -z and there leads from the one to the other.
    axis = unit((x, y, z - 1))
    return glb.node(name="sun", rotation=[axis[0], axis[1], axis[2], 0.0], extras={"switchable": True},
                    extensions={"KHR_lights_punctual": {"light": 0}})


if __name__ == "__main__":
    arguments = [argument for argument in sys.argv[1:] if argument != "--flicker"]
    target = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent / "room.glb")
    target.write_bytes(furnished("--flicker" in sys.argv[1:]))
