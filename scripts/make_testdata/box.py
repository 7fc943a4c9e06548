"""box.obj: an open box with a red and a green wall and two blocks, which shows the look of colored light.

It is 2 m wide, high and deep and open toward +Z, and its floor is at y = 0. Each color is a part: White, Red (on the left), Green
(on the right) and Gray (the blocks, both of them turned). Every face has its own normal, and the walls face inward.
"""

import math

from shared.numbers import shortest
from make_testdata.vectors import between, cross, unit


def quad(corners):
    """A quadrilateral; its corners are counterclockwise as they are seen."""
    return [tuple(float(c) for c in corner) for corner in corners]


def room():
    """(part, quadrilaterals) of each color of the walls."""
    left, right, floor, top, back, front = -1, 1, 0, 2, -1, 1
    white = [
        quad([(left, floor, front), (right, floor, front), (right, floor, back), (left, floor, back)]),
        quad([(left, top, back), (right, top, back), (right, top, front), (left, top, front)]),
        quad([(left, floor, back), (right, floor, back), (right, top, back), (left, top, back)]),
    ]
    red = [quad([(left, floor, front), (left, floor, back), (left, top, back), (left, top, front)])]
    green = [quad([(right, floor, back), (right, floor, front), (right, top, front), (right, top, back)])]
    return [("White", white), ("Red", red), ("Green", green)]


def block(x, z, half, height, turn_deg):
    """The sides and the top of a block that stands on the floor and is turned about the vertical axis."""
    turn = math.radians(turn_deg)
    ground = [(x + half * (a * math.cos(turn) - b * math.sin(turn)), z + half * (a * math.sin(turn) + b * math.cos(turn)))
              for a, b in ((-1, 1), (1, 1), (1, -1), (-1, -1))]
    sides = []
    for k in range(4):
        (x0, z0), (x1, z1) = ground[k], ground[(k + 1) % 4]
        sides.append(quad([(x0, 0, z0), (x1, 0, z1), (x1, height, z1), (x0, height, z0)]))
    return sides + [quad([(px, height, pz) for px, pz in ground])]


def normal(corners):
    """The unit normal of a quadrilateral."""
    return unit(cross(between(corners[0], corners[1]), between(corners[0], corners[3])))


def box_obj():
    """The bytes of box.obj."""
    parts = room() + [("Gray", block(-0.35, -0.35, 0.30, 1.2, 18) + block(0.38, 0.25, 0.29, 0.6, -16))]
    lines = ["# an open box, made by scripts/make-testdata"]
    vertices = normals = 0
    for name, quads in parts:
        lines.append(f"o {name}")
        for corners in quads:
            lines += ["v " + " ".join(shortest(round(c, 6) + 0.0) for c in corner) for corner in corners]
            lines.append("vn " + " ".join(shortest(round(c, 9) + 0.0) for c in normal(corners)))
            normals += 1
            lines.append("f " + " ".join(f"{vertices + k}//{normals}" for k in range(1, 5)))
            vertices += 4
    return ("\n".join(lines) + "\n").encode()
