"""A faceted chip: flat faces of many tilts in one picture, each of which shows the paint at an angle of its own."""

import math

SIDES = 8
TILTS_DEG = (0, 14, 28, 42, 56)  # of the top and of the rings of facets around it
WIDTH = 0.32  # of a ring, along its slope
TOP = 0.36  # the radius of the top


def rings():
    """(radius, height) of the edges between the rings, from the top to the rim."""
    edges = [(TOP, 0.0)]
    for tilt_deg in TILTS_DEG[1:]:
        radius, height = edges[-1]
        tilt = math.radians(tilt_deg)
        edges.append((radius + WIDTH * math.cos(tilt), height - WIDTH * math.sin(tilt)))
    return edges


def corner(radius, height, side):
    """A corner of a ring. The chip leans toward +Z, so that it faces a camera before it."""
    azimuth = 2 * math.pi * (side + 0.5) / SIDES
    return radius * math.cos(azimuth), radius * math.sin(azimuth), height


def normal(a, b, c):
    u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.sqrt(sum(x * x for x in n))
    return tuple(x / length for x in n)


def facets():
    """The corners of every facet, counterclockwise as seen from +Z: the top first, and then ring by ring."""
    edges = rings()
    yield [corner(*edges[0], side) for side in range(SIDES)]
    for inner, outer in zip(edges, edges[1:]):
        for side in range(SIDES):
            yield [corner(*inner, side), corner(*outer, side), corner(*outer, side + 1), corner(*inner, side + 1)]


def chip_obj():
    """The chip as OBJ, with one normal for each facet."""
    lines, points = ["g Chip"], 0
    for number, corners in enumerate(facets(), 1):
        lines += ["v {:.9g} {:.9g} {:.9g}".format(*point) for point in corners]
        lines.append("vn {:.9g} {:.9g} {:.9g}".format(*normal(*corners[:3])))
        lines.append("f " + " ".join(f"{points + i}//{number}" for i in range(1, len(corners) + 1)))
        points += len(corners)
    return "\n".join(lines) + "\n"
