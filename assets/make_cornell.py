#!/usr/bin/env python3
"""Writes cornell.glb beside this script (or to the path given): the Cornell room, lit by its whole ceiling.

    python3 assets/make_cornell.py [cornell.glb]

Python 3.9 or newer, standard library only. The same script always writes the same bytes.

Measurements: Cornell University Program of Computer Graphics, "Cornell Box Data", the room of Goral et al. 1984
as measured for the comparison of photograph and simulation (graphics.cornell.edu/online/box/data.html). The left
wall is really a little crooked (552.8 and 549.6 at the floor, 556.0 at the ceiling), so it folds along its diagonal.
One published unit is taken as one centimetre, which makes a room of 5.5 m to walk around in.

Axes: metres, y up, +x to the viewer's right, +z towards the viewer. The published axes have x to the viewer's left
and z away from the viewer; half a turn about y leads from one to the other, and red stays on the left. The origin is
in the middle of the floor.

| node        | what                              | reflectance (linear RGB) | emits               |
|-------------|-----------------------------------|--------------------------|---------------------|
| floor       | white                             | 0.73 0.73 0.73           |                     |
| ceiling     | white, all of it is the lamp      | 0.73 0.73 0.73           | 10 W m^-2 sr^-1     |
| back        | white                             | 0.73 0.73 0.73           |                     |
| left        | red                               | 0.65 0.05 0.05           |                     |
| right       | green                             | 0.12 0.45 0.15           |                     |
| front       | white, faces inwards              | 0.73 0.73 0.73           |                     |
| short_block | white, 1.65 m cube, turned        | 0.73 0.73 0.73           |                     |
| tall_block  | white, 1.65 x 3.30 x 1.65, turned | 0.73 0.73 0.73           |                     |
| cube1       | orange, 0.55 m, movable           | 0.80 0.33 0.05           |                     |
| cube2       | blue, 0.55 m, movable             | 0.08 0.20 0.75           |                     |

The walls' RGB values are the ones in common use for the published reflectance spectra (400-700 nm) reduced to
linear sRGB and rounded to two digits. Cubes, front wall and the glowing ceiling are not part of the measured room.

The front wall closes the room, so that no light is lost and an energy balance is exact; as all surfaces are
one-sided, a camera outside looks in through its back. The blocks stand GAP above the floor: a bottom that lies in
the floor's own plane would leave to rounding which of the two is in front.

Atlas (TEXCOORD_1, and TEXCOORD_0 with the same data because glTF wants the sets without a hole): one rectangular
chart a face on a grid of 64 x 64 cells, at least one cell from its neighbours and from the border. A cell is 4 x 4
texels at 256, which leaves each chart a gutter of 2 texels of its own, and the charts stay apart at 128 and 64.
Walls get 14.5 texels a metre at 256, blocks 14.5 to 17, cubes 29.
"""
import pathlib
import sys

from glb import Glb, normal

UNIT = 0.01  # metres in one published unit
GAP = 0.002  # metres between the floor and the blocks' bottoms
CELLS = 64  # atlas cells a side
CUBE = 0.55  # metres, a tenth of the room's width

WHITE, RED, GREEN = (0.73, 0.73, 0.73), (0.65, 0.05, 0.05), (0.12, 0.45, 0.15)
ORANGE, BLUE = (0.80, 0.33, 0.05), (0.08, 0.20, 0.75)
CEILING_RADIANCE = 10.0  # W m^-2 sr^-1


def place(x, y, z):
    """Published coordinates to metres in the scene's axes."""
    return ((278.0 - x) * UNIT, y * UNIT, (279.6 - z) * UNIT)


def room():
    """Node name -> the wall's corners, counter-clockwise seen from inside."""
    fl, fr = place(552.8, 0, 0), place(0, 0, 0)  # floor: front left, front right
    bl, br = place(549.6, 0, 559.2), place(0, 0, 559.2)
    tfl, tfr = place(556, 548.8, 0), place(0, 548.8, 0)  # the same at the ceiling
    tbl, tbr = place(556, 548.8, 559.2), place(0, 548.8, 559.2)
    return {
        "floor": (fl, fr, br, bl),
        "ceiling": (tbl, tbr, tfr, tfl),
        "back": (bl, br, tbr, tbl),
        "left": (fl, bl, tbl, tfl),
        "right": (br, fr, tfr, tbr),
        "front": (fr, fl, tfl, tfr),
    }


def block(footprint, height):
    """Top, bottom and four sides of a block over published (x, z) corners, counter-clockwise seen from outside."""
    low = [(x, GAP, z) for x, _, z in (place(x, 0, z) for x, z in footprint)]
    high = [(x, height * UNIT, z) for x, _, z in low]
    sides = [(low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]) for i in range(4)]
    return [tuple(high), tuple(reversed(low))] + sides


def cube(size):
    """The same for a cube around the origin."""
    h = size / 2
    ring = [(-h, h), (h, h), (h, -h), (-h, -h)]
    low, high = [(x, -h, z) for x, z in ring], [(x, h, z) for x, z in ring]
    sides = [(low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]) for i in range(4)]
    return [tuple(high), tuple(reversed(low))] + sides


# Charts as (column, row, width, height) in cells. The first faces of a block or cube are its top and bottom.
WALL_CHARTS = [(1 + 21 * (i % 3), 1 + 21 * (i // 3), 20, 20) for i in range(6)]
TALL_CHARTS = [(1, 56, 7, 7), (49, 56, 4, 4)] + [(1 + 8 * i, 43, 7, 12) for i in range(4)]
SHORT_CHARTS = [(9, 56, 7, 7), (54, 56, 4, 4)] + [(17 + 8 * i, 56, 7, 7) for i in range(4)]
CUBE_CHARTS = [[(33 + 5 * i, 43 + 5 * row, 4, 4) for i in range(6)] for row in range(2)]


def triangles(faces, charts):
    """Flat-shaded vertices and indices of quads; a face whose halves lie in two planes keeps a normal for each."""
    positions, normals, atlas, indices = [], [], [], []
    for corners, (column, row, width, height) in zip(faces, charts):
        u0, u1 = column / CELLS, (column + width) / CELLS
        v0, v1 = row / CELLS, (row + height) / CELLS
        uvs = ((u0, v1), (u1, v1), (u1, v0), (u0, v0))
        halves = ((0, 1, 2), (0, 2, 3))
        n = [normal(*(corners[i] for i in half)) for half in halves]
        flat = max(abs(a - b) for a, b in zip(*n)) < 1e-6
        for group, direction in ([((0, 1, 2, 3), n[0])] if flat else list(zip(halves, n))):
            first = len(positions)
            positions += [corners[i] for i in group]
            normals += [direction] * len(group)
            atlas += [uvs[i] for i in group]
            indices += [first + i for i in ((0, 1, 2, 0, 2, 3) if flat else (0, 1, 2))]
    return positions, normals, atlas, indices


def node(glb, name, faces, charts, material, movable_at=None):
    positions, normals, atlas, indices = triangles(faces, charts)
    more = {"translation": list(movable_at), "extras": {"movable": True}} if movable_at else {}
    glb.node(name=name, mesh=glb.mesh(name, positions, normals, atlas, atlas, indices, material), **more)


def cornell():
    glb = Glb()
    white, red, green = glb.material("white", WHITE), glb.material("red", RED), glb.material("green", GREEN)
    lamp = glb.material("lamp", WHITE, CEILING_RADIANCE)
    orange, blue = glb.material("orange", ORANGE), glb.material("blue", BLUE)

    walls = {"ceiling": lamp, "left": red, "right": green}
    for (name, corners), chart in zip(room().items(), WALL_CHARTS):
        node(glb, name, [corners], [chart], walls.get(name, white))
    node(glb, "short_block", block([(130, 65), (82, 225), (240, 272), (290, 114)], 165), SHORT_CHARTS, white)
    node(glb, "tall_block", block([(423, 247), (265, 296), (314, 456), (472, 406)], 330), TALL_CHARTS, white)
    # One before the tall block, one above the short block: free to move in x and y, and in each other's way.
    node(glb, "cube1", cube(CUBE), CUBE_CHARTS[0], orange, movable_at=place(408, 130, 120))
    node(glb, "cube2", cube(CUBE), CUBE_CHARTS[1], blue, movable_at=place(148, 250, 120))
    return glb.bytes("Lichtveld assets/make_cornell.py",
                     {"name": "cornell", "nodes": list(range(len(glb.gltf["nodes"])))})


if __name__ == "__main__":
    target = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "cornell.glb")
    target.write_bytes(cornell())
