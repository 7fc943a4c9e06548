"""The wheels of the speed shape and the wells that they stand in. Lengths are meters, and the ground is at y = 0."""

import math

from make_testdata.patch import Part
from make_testdata.vectors import between, cross, dot, unit

RADIUS = 0.305  # of a tire: it stands on the ground, and leaves 3 cm to the arch
TURNS = 40

# The profiles of the left wheels: x from the middle of the car, and the distance from the axle. A line that begins with a
# second point of the same place is an edge; within a line the surface is smooth.
TIRE = [[(0.868, 0.205), (0.893, 0.222), (0.905, 0.250), (0.900, 0.280), (0.885, 0.297), (0.868, 0.304), (0.840, 0.305)],
        [(0.840, 0.305), (0.740, 0.305)],
        [(0.740, 0.305), (0.712, 0.304), (0.698, 0.297), (0.690, 0.270), (0.692, 0.230), (0.700, 0.200)]]
RIM = [[(0.868, 0.205), (0.880, 0.209), (0.884, 0.203), (0.878, 0.196), (0.862, 0.192)],
       [(0.862, 0.192), (0.848, 0.180), (0.846, 0.150), (0.858, 0.100), (0.868, 0.062)],
       [(0.868, 0.062), (0.876, 0.058), (0.880, 0.045), (0.882, 0.020), (0.8825, 0.0)],
       [(0.700, 0.200), (0.705, 0.190), (0.720, 0.150), (0.725, 0.0)]]
SLOTS, SLOT = 5, (0.092, 0.158)  # openings of the rim, between two distances from the axle

WELL_DEPTH, WELL_FRONT, WELL_MARGIN, WELL_FLOOR = 0.60, 0.83, 0.012, 0.19


def bulge_normals(line):
    """A normal (x, r) for each point of a line of a profile: that of the chord between its neighbors, to the right of it."""
    normals = []
    for i in range(len(line)):
        a, b = line[max(i - 1, 0)], line[min(i + 1, len(line) - 1)]
        length = math.hypot(b[0] - a[0], b[1] - a[1])
        normals.append(((b[1] - a[1]) / length, (a[0] - b[0]) / length))
    return normals


def add_facing(part, triangle):
    """Adds a triangle so that it looks to the side of its vertices' normals; none without area."""
    a, b, c = (part.points[i] for i in triangle)
    face = cross(between(a, b), between(a, c))
    if dot(face, face) < 1e-20:
        return
    normal = [sum(part.normals[i][k] for i in triangle) for k in range(3)]
    part.triangles.append(tuple(triangle) if dot(face, normal) > 0 else (triangle[0], triangle[2], triangle[1]))


def add_lathe(part, lines, axle, height, outward, keep=lambda r, turn: True):
    """Adds the surface that lines of a profile describe as they turn about an axle along x.

    `outward(x)` says whether the normals of a line that begins at x look away from the axle's inner end.
    """
    for line in lines:
        sense = outward(line)
        rings = []
        for (x, r), (nx, nr) in zip(line, bulge_normals(line)):
            ring = []
            for k in range(TURNS):
                turn = 2 * math.pi * k / TURNS
                c, s = math.cos(turn), math.sin(turn)
                ring.append(part.add((x, height + r * c, axle + r * s), (sense * nx, sense * nr * c, sense * nr * s)))
            rings.append(ring)
        for (near, (_, near_r)), (far, (_, far_r)) in zip(zip(rings, line), zip(rings[1:], line[1:])):
            for k in range(TURNS):
                if not keep((near_r + far_r) / 2, (k + 0.5) / TURNS):
                    continue
                m = (k + 1) % TURNS
                add_facing(part, (near[k], far[k], near[m]))
                add_facing(part, (near[m], far[k], far[m]))


def is_solid(r, turn):
    """Whether the rim is there, or one of its openings."""
    return not (SLOT[0] < r < SLOT[1] and abs(turn * SLOTS % 1 - 0.5) < 0.32)


def wheels(axles):
    """The parts Tires and Rims: a wheel at each side of each axle."""
    tires, rims = Part("Tires"), Part("Rims")
    for axle in axles:
        add_lathe(tires, TIRE, axle, RADIUS, lambda line: 1)
        # The profile of the face runs toward the axle, and that of the back away from the viewer.
        add_lathe(rims, RIM[:3], axle, RADIUS, lambda line: -1, is_solid)
        add_lathe(rims, RIM[3:], axle, RADIUS, lambda line: -1)
    for part in (tires, rims):
        part.append(part.mirrored(part.name))
    return [tires, rims]


def split(part, triangle):
    """The four triangles of a triangle that is cut at the middles of its edges."""
    def middle(i, j):
        point = tuple((p + q) / 2 for p, q in zip(part.points[i], part.points[j]))
        return part.add(point, unit(tuple(p + q for p, q in zip(part.normals[i], part.normals[j]))))

    a, b, c = triangle
    ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
    return [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]


def open_wells(underbody, axles, center, radius):
    """Cuts a well for each wheel into the underbody, `center` being the height of the arches, and lines it."""
    reach = radius + WELL_MARGIN

    def distance(point):
        return min(math.hypot(point[1] - center, point[2] - axle) for axle in axles)

    triangles = underbody.triangles
    for cut in range(3):  # The border of the well is to be finer than the lips of the arch hide.
        finer = []
        for triangle in triangles:
            points = [underbody.points[i] for i in triangle]
            size = max(math.dist(p, q) for p, q in zip(points, points[1:] + points[:1]))
            slack = 0.5 * size if cut == 0 else 0.0
            crosses = min(map(distance, points)) - slack < reach < max(map(distance, points)) + slack
            at_side = max(abs(x) for x, _, _ in points) > WELL_DEPTH
            finer += split(underbody, triangle) if crosses and at_side and size > 0.03 else [triangle]
        triangles = finer
    underbody.triangles = []
    for triangle in triangles:
        middle = [sum(underbody.points[i][k] for i in triangle) / 3 for k in range(3)]
        if not (abs(middle[0]) > WELL_DEPTH and distance(middle) < reach):
            underbody.triangles.append(triangle)
    lining = Part(underbody.name)
    first = math.asin((WELL_FLOOR - center) / reach)
    for axle in axles:
        arc = [first + (math.pi - 2 * first) * k / 32 for k in range(33)]
        rows = [[lining.add((x, center + reach * math.sin(t), axle + reach * math.cos(t)),
                            (0.0, -math.sin(t), -math.cos(t))) for t in arc] for x in (WELL_FRONT, WELL_DEPTH)]
        for k in range(32):
            add_facing(lining, (rows[0][k], rows[1][k], rows[0][k + 1]))
            add_facing(lining, (rows[0][k + 1], rows[1][k], rows[1][k + 1]))
        wall = [lining.add((WELL_DEPTH, center + reach * math.sin(t), axle + reach * math.cos(t)), (1.0, 0.0, 0.0))
                for t in arc]
        for k in range(1, 32):
            add_facing(lining, (wall[0], wall[k], wall[k + 1]))
    underbody.append(lining)
    underbody.append(lining.mirrored(underbody.name))
    # Vertices that no triangle has any more are left out.
    used = sorted({i for triangle in underbody.triangles for i in triangle})
    place = {old: new for new, old in enumerate(used)}
    underbody.points = [underbody.points[i] for i in used]
    underbody.normals = [underbody.normals[i] for i in used]
    underbody.triangles = [tuple(place[i] for i in triangle) for triangle in underbody.triangles]
