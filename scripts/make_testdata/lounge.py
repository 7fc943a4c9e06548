"""lounge.obj: a furnished room that two lamps light by way of its ceiling, so that nearly all light in it has bounced.

The room is 6 m wide, 5 m deep and 2.8 m high, closed on all sides, with its floor at y = 0 and the back wall at z = -2.5. The lamps
stand in the back corners; their bowls hide the shining discs from everything but the ceiling and the upper walls.
"""

import math

from make_testdata.solids import ball, block, flat, obj, pillow, rectangle, turned_solid

WIDTH, DEPTH, HEIGHT = 6.0, 5.0, 2.8
LAMPS = (-2.45, -1.95), (2.45, -1.95)
BOWL_HEIGHT, BOWL_RADIUS = 1.75, 0.28


def room():
    """(part, faces) of the walls, which face inward."""
    x, z = WIDTH / 2, DEPTH / 2
    return [
        ("Floor", [rectangle((-x, 0, -z), (0, 0, 2 * z), (2 * x, 0, 0))]),
        ("Ceiling", [rectangle((-x, HEIGHT, -z), (2 * x, 0, 0), (0, 0, 2 * z))]),
        ("Wall_Back", [rectangle((-x, 0, -z), (2 * x, 0, 0), (0, HEIGHT, 0))]),
        ("Wall_Left", [rectangle((-x, 0, -z), (0, HEIGHT, 0), (0, 0, 2 * z))]),
        ("Wall_Right", [rectangle((x, 0, -z), (0, 0, 2 * z), (0, HEIGHT, 0))]),
        ("Wall_Front", [rectangle((-x, 0, z), (0, HEIGHT, 0), (2 * x, 0, 0))]),
    ]


def framed(corner, a, b, out):
    """(the faces of a picture, those of its frame): the rectangle from a corner along two edges, on a frame that stands out."""
    def place(s, t, high):
        return tuple(corner[i] + s * a[i] + t * b[i] + high * out[i] for i in range(3))
    width, thick = 0.07, 0.04
    s, t = (width / math.dist(edge, (0, 0, 0)) for edge in (a, b))
    outer = [(-s, -t), (1 + s, -t), (1 + s, 1 + t), (-s, 1 + t)]
    inner = [(0, 0), (1, 0), (1, 1), (0, 1)]
    frame = []
    for k in range(4):
        (o0, o1), (i0, i1) = (outer[k], outer[(k + 1) % 4]), (inner[k], inner[(k + 1) % 4])
        frame.append(flat(place(*o0, thick), place(*o1, thick), place(*i1, thick), place(*i0, thick)))
        frame.append(flat(place(*o0, 0), place(*o1, 0), place(*o1, thick), place(*o0, thick)))
        frame.append(flat(place(*i0, thick), place(*i1, thick), place(*i1, thick / 2), place(*i0, thick / 2)))
    return [flat(*(place(*corner_at, thick / 2) for corner_at in inner))], frame


def lamp(middle):
    """(the faces of the stand, of the bowl, of the shining disc) of one lamp."""
    stand = turned_solid([(0.16, 0.0), (0.16, 0.02), (0.16, 0.02), (0.02, 0.03), (0.015, 0.1), (0.015, BOWL_HEIGHT - 0.12)][::-1],
                         middle, 24)
    low, steps = BOWL_HEIGHT - 0.13, 8
    outside = [(BOWL_RADIUS * math.sin(math.pi / 2 * k / steps), low + 0.13 * (1 - math.cos(math.pi / 2 * k / steps)))
               for k in range(steps + 1)]
    rim = [(BOWL_RADIUS, BOWL_HEIGHT), (BOWL_RADIUS - 0.01, BOWL_HEIGHT + 0.004)]
    inside = [(0.95 * r, y + 0.012) for r, y in reversed(outside)]
    bowl = turned_solid((outside + [outside[-1]] + rim + [inside[0]] + inside)[::-1], middle)
    disc = turned_solid([(0.0, BOWL_HEIGHT - 0.05), (0.19, BOWL_HEIGHT - 0.05)], middle)
    return stand, bowl, disc


def sofa():
    """(the faces of the frame, of the cushions) of the sofa, which stands before the back wall and faces +Z."""
    middle = (-0.2, -1.75)
    frame = pillow((middle[0], middle[1]), (1.15, 0.45), 0.1, 0.34, 0.04)
    frame += pillow((middle[0], middle[1] - 0.38), (1.15, 0.12), 0.3, 0.85, 0.08)
    for side in (-1, 1):
        frame += pillow((middle[0] + side * 1.1, middle[1]), (0.12, 0.47), 0.1, 0.62, 0.08)
        for near in (-0.38, 0.38):
            frame += block((middle[0] + side * 1.05, middle[1] + near), (0.03, 0.03), 0, 0.12, bottom=False)
    cushions = []
    for seat in (-0.655, 0.0, 0.655):
        cushions += pillow((middle[0] + seat, middle[1] + 0.1), (0.32, 0.36), 0.34, 0.5, 0.06)
        cushions += pillow((middle[0] + seat, middle[1] - 0.2), (0.31, 0.09), 0.48, 0.86, 0.07)
    return frame, cushions


def table():
    """(the faces of the top, of the foot) of the round table before the sofa."""
    middle, height = (0.1, -0.35), 0.42
    top = turned_solid([(0.0, height - 0.03), (0.53, height - 0.03), (0.55, height - 0.015), (0.55, height - 0.015),
                        (0.53, height), (0.53, height), (0.0, height)][::-1], middle, 64)
    foot = turned_solid([(0.3, 0.0), (0.3, 0.015), (0.3, 0.015), (0.08, 0.05), (0.05, 0.15), (0.06, 0.3), (0.12, height - 0.03)][::-1],
                        middle)
    return top, foot


def vase():
    """The faces of the vase on the table, outside and in."""
    outside = [(0.0, 0.42), (0.05, 0.42), (0.05, 0.42), (0.062, 0.45), (0.08, 0.5), (0.082, 0.55), (0.07, 0.61), (0.045, 0.66),
               (0.035, 0.7), (0.038, 0.73), (0.052, 0.76)]
    inside = [(r - 0.004, y + 0.001) for r, y in reversed(outside[3:])] + [(0.0, 0.44)]
    return turned_solid((outside + [outside[-1]] + inside)[::-1], (-0.1, -0.35))


def lounge_obj():
    """The bytes of lounge.obj."""
    sofa_frame, cushions = sofa()
    top, foot = table()
    x, z = WIDTH / 2, DEPTH / 2
    left, left_frame = framed((-x, 1.0, 0.55), (0, 0, -1.3), (0, 0.95, 0), (1, 0, 0))
    back, back_frame = framed((-0.9, 1.15, -z), (1.4, 0, 0), (0, 0.85, 0), (0, 0, 1))
    lamps = [lamp(middle) for middle in LAMPS]
    parts = room() + [
        ("Carpet", block((0.1, -0.45), (1.5, 1.0), 0, 0.012, bottom=False)),
        ("Sofa", sofa_frame),
        ("Cushions", cushions),
        ("Table_Top", top),
        ("Table_Foot", foot),
        ("Vase", vase()),
        ("Ball", ball((0.28, 0.42 + 0.09, -0.22), 0.09)),
        ("Stool", pillow((1.85, -0.75), (0.27, 0.27), 0.0, 0.4, 0.09, 25)),
        ("Cabinet", block((2.7, 0.6), (0.25, 0.8), 0, 0.75, bottom=False)),
        ("Painting_Left", left),
        ("Painting_Back", back),
        ("Frames", left_frame + back_frame),
        ("Lamp_Stands", [face for stand, _, _ in lamps for face in stand]),
        ("Lamp_Bowls", [face for _, bowl, _ in lamps for face in bowl]),
        ("Lamps", [face for _, _, disc in lamps for face in disc]),
    ]
    return obj(["a lounge: metres, +Y up; the parts Lamps shine at the ceiling", "Made by scripts/make-testdata."], parts)
