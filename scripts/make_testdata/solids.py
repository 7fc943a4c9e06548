"""Faces of simple solids, for the rooms: lists of faces, each a list of (point, normal) corners, counterclockwise as seen."""

import math

from shared.numbers import shortest
from make_testdata.vectors import along, between, cross, unit


def flat(*corners):
    """A face with one normal for all of its corners."""
    normal = unit(cross(between(corners[0], corners[1]), between(corners[0], corners[-1])))
    return [(tuple(map(float, corner)), normal) for corner in corners]


def rectangle(corner, a, b):
    """The rectangle from a corner along two edges; it faces along a x b."""
    across = along(corner, a, 1)
    return flat(corner, across, along(across, b, 1), along(corner, b, 1))


def turned(point, middle, turn_deg):
    """A point turned about the vertical axis through (x, z)."""
    c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
    x, z = point[0] - middle[0], point[2] - middle[1]
    return middle[0] + c * x + s * z, point[1], middle[1] - s * x + c * z


def block(middle, half, low, high, turn_deg=0.0, bottom=True):
    """A box about the vertical axis through (x, z), half so large along x and z; without its bottom where it stands on something."""
    (x, z), (w, d) = middle, half
    corner = [[turned((x + a * w, y, z + b * d), middle, turn_deg) for a, b in ((-1, 1), (1, 1), (1, -1), (-1, -1))]
              for y in (low, high)]
    faces = [flat(corner[0][k], corner[0][(k + 1) % 4], corner[1][(k + 1) % 4], corner[1][k]) for k in range(4)]
    faces.append(flat(*corner[1]))
    if bottom:
        faces.append(flat(*reversed(corner[0])))
    return faces


def pillow(middle, half, low, high, rounding, turn_deg=0.0, steps=3):
    """A box whose edges are rounded: the points at one distance from a smaller box."""
    center = (middle[0], (low + high) / 2, middle[1])
    size = (half[0], (high - low) / 2, half[1])
    inner = [extent - rounding for extent in size]
    faces = []
    for axis in range(3):
        for side in (-1, 1):
            u, v = (axis + 1) % 3, (axis + 2) % 3

            def corner(a, b):
                # Angles from -45 to 45 degrees on either side of the flat middle.
                def place(t):
                    angle = math.radians(45) * (abs(t) - 1) if abs(t) > 1 else 0.0
                    return math.copysign(math.tan(angle), t), math.copysign(min(abs(t), 1.0), t)
                (ta, fa), (tb, fb) = place(a), place(b)
                direction = [0.0] * 3
                direction[axis], direction[u], direction[v] = side, ta, tb
                normal = unit(direction)
                foot = [0.0] * 3
                foot[axis], foot[u], foot[v] = side * inner[axis], fa * inner[u], fb * inner[v]
                point = tuple(center[i] + foot[i] + rounding * normal[i] for i in range(3))
                return turned(point, middle, turn_deg), turned(normal, (0, 0), turn_deg)

            at = [-1 - (steps - i) / steps for i in range(steps)] + [-1.0, 1.0] + [1 + (i + 1) / steps for i in range(steps)]
            for a0, a1 in zip(at, at[1:]):
                for b0, b1 in zip(at, at[1:]):
                    face = [corner(a0, b0), corner(a1, b0), corner(a1, b1), corner(a0, b1)]
                    faces.append(face if side > 0 else face[::-1])
    return faces


def turned_solid(profile, middle, sides=40):
    """What a line of (radius, height) sweeps about the vertical axis through (x, z); it faces to the left of the way along the
    line, seen with the radius to the right and the height up. Corners of the line are sharp where it names a point twice."""
    count = len(profile)
    slopes = []
    for k in range(count):
        # The mean of the two pieces that meet here; of one where the other has no length.
        normals = []
        for i, j in ((k - 1, k), (k, k + 1)):
            if 0 <= i and j < count:
                dr, dy = profile[j][0] - profile[i][0], profile[j][1] - profile[i][1]
                if math.hypot(dr, dy) > 1e-9:
                    normals.append((-dy / math.hypot(dr, dy), dr / math.hypot(dr, dy)))
        slopes.append((sum(n[0] for n in normals), sum(n[1] for n in normals)))

    def corner(k, i):
        angle = 2 * math.pi * (i % sides) / sides
        c, s = math.cos(angle), math.sin(angle)
        (r, y), (nr, ny) = profile[k], slopes[k]
        return (middle[0] + r * c, y, middle[1] + r * s), unit((nr * c, ny, nr * s))

    faces = []
    for k in range(count - 1):
        if math.dist(profile[k], profile[k + 1]) < 1e-9:
            continue
        for i in range(sides):
            ring = [corner(k, i), corner(k, i + 1), corner(k + 1, i + 1), corner(k + 1, i)]
            if profile[k][0] == 0:
                ring = ring[1:]
            elif profile[k + 1][0] == 0:
                ring = ring[:3]
            faces.append(ring)
    return faces


def ball(middle, radius, sides=40):
    """A sphere about (x, y, z)."""
    steps = sides // 2
    profile = [(radius * math.sin(math.pi * k / steps), middle[1] + radius * math.cos(math.pi * k / steps)) for k in range(steps + 1)]
    profile[0], profile[-1] = (0.0, middle[1] + radius), (0.0, middle[1] - radius)
    return turned_solid(profile, (middle[0], middle[2]), sides)


def obj(comment, parts):
    """The bytes of an OBJ file of (part, faces), whose equal points and normals stand in it once."""
    lines = [f"# {line}" for line in comment]
    points, normals = {}, {}

    def number(table, key, keyword):
        if key not in table:
            table[key] = len(table) + 1
            lines.append(f"{keyword} " + " ".join(shortest(c) for c in key))
        return table[key]

    for name, faces in parts:
        lines.append(f"o {name}")
        for face in faces:
            words = []
            for point, normal in face:
                p = number(points, tuple(round(c, 4) + 0.0 for c in point), "v")
                n = number(normals, tuple(round(c, 4) + 0.0 for c in normal), "vn")
                words.append(f"{p}//{n}")
            lines.append("f " + " ".join(words))
    return ("\n".join(lines) + "\n").encode()
