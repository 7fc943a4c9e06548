"""cornell.obj: a box with a red and a green wall, two blocks and a lamp in its ceiling, whose light bounces between them.

It is 2 m wide, high and deep, its floor is at y = 0, and it is open toward +Z. The lamp fills a hole of the ceiling.
"""

from make_testdata.solids import block, obj, rectangle

LAMP = 0.3, 0.25  # half its size along x and z


def ceiling():
    """The ceiling around the lamp, facing down."""
    w, d = LAMP
    return [rectangle((-1, 2, -1), (2, 0, 0), (0, 0, 1 - d)), rectangle((-1, 2, d), (2, 0, 0), (0, 0, 1 - d)),
            rectangle((-1, 2, -d), (1 - w, 0, 0), (0, 0, 2 * d)), rectangle((w, 2, -d), (1 - w, 0, 0), (0, 0, 2 * d))]


def cornell_obj():
    """The bytes of cornell.obj."""
    w, d = LAMP
    parts = [
        ("Floor", [rectangle((-1, 0, -1), (0, 0, 2), (2, 0, 0))]),
        ("Ceiling", ceiling()),
        ("Back", [rectangle((-1, 0, -1), (2, 0, 0), (0, 2, 0))]),
        ("Red", [rectangle((-1, 0, -1), (0, 2, 0), (0, 0, 2))]),
        ("Green", [rectangle((1, 0, -1), (0, 0, 2), (0, 2, 0))]),
        ("Tall", block((-0.35, -0.35), (0.3, 0.3), 0, 1.2, -18, bottom=False)),
        ("Short", block((0.38, 0.25), (0.29, 0.29), 0, 0.6, 16, bottom=False)),
        ("Lamp", [rectangle((-w, 2, -d), (2 * w, 0, 0), (0, 0, 2 * d))]),
    ]
    return obj(["a box with colored walls and a lamp in the ceiling: metres, +Y up, open toward +Z", "Made by scripts/make-testdata."],
               parts)
