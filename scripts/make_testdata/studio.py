"""studio.exr: a photographer's studio for cars, built for long, smooth reflections.

It is seen from the middle of the car, 0.7 m above a dark floor that runs through a cove into a lit cyclorama. Radiance is
linear Rec.709 in arbitrary units: 0.05 to 0.6 for the room, 10 to 60 for the lights. Lengths are meters from the eye.
"""

import collections
import math

import numpy

from make_testdata.blend import mix, smooth_step
from make_testdata.vectors import cross, dot
from shared import pictures

WIDTH, HEIGHT, SAMPLES = 512, 256, 2  # SAMPLES x SAMPLES points are averaged in each texel.

# A lamp lies in the plane through `center`, spanned by the unit vectors `across` and `along`.
Lamp = collections.namedtuple("Lamp", "center across along half_width half_length soft glow color")

OVERHEAD = Lamp((0, 3.1, 0.2), (1, 0, 0), (0, 0, 1), 0.85, 2.7, 0.30, 0.35, (14.2, 13.9, 13.3))
STRIP_LEFT = Lamp((4.6, 1.35, -1.6), (0, 1, 0), (0, 0, 1), 0.20, 3.9, 0.14, 0.25, (24.5, 22.6, 20.0))
STRIP_RIGHT = Lamp((-4.4, 1.95, 0.1), (0, 1, 0), (0, 0, 1), 0.28, 4.0, 0.18, 0.25, (17.5, 18.1, 19.0))
BACK_LIGHT = Lamp((-0.6, 2.5, -5.6), (1, 0, 0), (0, 0.94, 0.342), 1.7, 0.42, 0.24, 0.2, (58.0, 55.5, 51.0))
LAMPS = (OVERHEAD, STRIP_LEFT, STRIP_RIGHT, BACK_LIGHT)

# The window: the unit normal of its plane (level, toward the front left), its distance, sill, size, panes and bars.
WINDOW_NORMAL = (math.sin(math.radians(38)), 0.0, math.cos(math.radians(38)))
WINDOW_DISTANCE, WINDOW_SILL, WINDOW_WIDTH, WINDOW_HEIGHT = 5.4, 0.15, 2.5, 2.3
PANES_ACROSS, PANES_UP, BAR, BAR_SOFT = 3, 2, 0.09, 0.05


def room(d):
    """Radiance of floor, cove, cyclorama and ceiling in direction d."""
    x, y, z = d
    elevation = math.degrees(math.asin(max(-1.0, min(1.0, y))))
    # The cyclorama is lit from below the cove, most strongly behind the car and on its left. Its left is warm, its right cool.
    side = 0.5 + 0.5 * x
    level = 0.62 + 0.28 * smooth_step(-0.4, 1.0, -z) + 0.10 * x
    tint = mix((0.93, 0.99, 1.09), (1.07, 1.0, 0.90), side)
    fall = math.exp(-max(0.0, elevation) / 21.0)
    wall = tuple(level * (0.05 + 0.58 * fall) * c for c in tint)
    ceiling = (0.058, 0.060, 0.064)
    upper = mix(wall, ceiling, smooth_step(34, 70, elevation))
    # The floor has a pool of light under the softbox and gets darker toward the cove.
    reach = 0.7 / max(1e-3, -y) if y < 0 else 1e3
    pool = 1.0 / (1.0 + (reach / 2.6) ** 2)
    floor = tuple(c * (0.62 + 0.9 * pool) for c in (0.094, 0.092, 0.089))
    return mix(floor, upper, smooth_step(-24, -2, elevation))


def lamp_light(lamp, d):
    """The share of the lamp in direction d, from 0 to about 1. A lamp has soft edges and is brightest in the middle."""
    normal = cross(lamp.across, lamp.along)
    distance, facing = dot(normal, lamp.center), dot(normal, d)
    if facing * distance <= 0:
        return 0.0
    hit = [c * distance / facing - m for c, m in zip(d, lamp.center)]
    u, v = abs(dot(hit, lamp.across)), abs(dot(hit, lamp.along))
    edge = (1 - smooth_step(lamp.half_width - lamp.soft, lamp.half_width, u)) \
        * (1 - smooth_step(lamp.half_length - 2 * lamp.soft, lamp.half_length, v))
    middle = 1 - lamp.glow * ((u / lamp.half_width) ** 2 + (v / lamp.half_length) ** 2) / 2
    return edge * middle


def window(d):
    """(share of clear glass, radiance of the daylight) in direction d."""
    facing = dot(WINDOW_NORMAL, d)
    if facing <= 0.05:
        return 0.0, (0, 0, 0)
    across = (d[0] * WINDOW_NORMAL[2] - d[2] * WINDOW_NORMAL[0]) * WINDOW_DISTANCE / facing
    up = d[1] * WINDOW_DISTANCE / facing - WINDOW_SILL
    clear = 1.0
    for position, size, panes in ((across + WINDOW_WIDTH / 2, WINDOW_WIDTH, PANES_ACROSS),
                                  (up, WINDOW_HEIGHT, PANES_UP)):
        if not 0 < position < size:
            return 0.0, (0, 0, 0)
        pitch = size / panes
        to_bar = min(position % pitch, pitch - position % pitch)
        clear *= smooth_step(BAR / 2, BAR / 2 + BAR_SOFT, to_bar)
    # Outside, a bright haze lies on the horizon under a blue sky.
    sky = mix((10.6, 12.4, 14.6), (6.9, 10.1, 15.8), smooth_step(0.2, WINDOW_HEIGHT, up))
    outside = mix((3.1, 3.5, 3.4), sky, smooth_step(0.12, 0.34, up))
    return clear, outside


def radiance(d):
    """Radiance of the studio in direction d."""
    clear, daylight = window(d)
    color = mix(room(d), daylight, clear)
    for lamp in LAMPS:
        share = lamp_light(lamp, d)
        if share > 0:
            color = mix(color, lamp.color, share)
    return color


def studio_exr():
    """The bytes of studio.exr."""
    offsets = [(i + 0.5) / SAMPLES for i in range(SAMPLES)]
    rows = []
    for row in range(HEIGHT):
        texels = []
        for column in range(WIDTH):
            total = [0.0, 0.0, 0.0]
            for dy in offsets:
                for dx in offsets:
                    sample = radiance(pictures.direction(column + dx, row + dy, WIDTH, HEIGHT))
                    total = [t + s for t, s in zip(total, sample)]
            texels.append(tuple(t / SAMPLES ** 2 for t in total))
        rows.append(texels)
    return pictures.exr_file(rows, numpy.float16, "designed photo studio, lat-long, linear Rec.709")
