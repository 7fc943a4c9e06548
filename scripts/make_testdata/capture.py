"""Photographs of varnished stripes by a gantry: the files of testdata/capture, which fit-sbrdf takes.

The pixel value of a texel is exposure * pi * f * cos_i / d^2, with f = diffuse + strength * base^n, as in
goniochrome-surfaces(7), "SPATIALLY VARYING SURFACES"; it is written as sRGB in 16 bits. One photograph in four has half the exposure.
"""

import math
import random
import struct
import zlib

from make_testdata.blend import mix
from make_testdata.vectors import dot, unit

COLUMNS, ROWS, WIDTH, PHOTOS, DISTANCE = 24, 16, 2.0, 20, 6.0
MOST_TILT = math.radians(60)
# Linear Rec.709: stripes of a matt red and of a glossy blue varnish, and how sharp their lobe is.
RED, BLUE = ((0.42, 0.09, 0.07), 18.0), ((0.05, 0.10, 0.36), 70.0)
GLOSS = 0.05  # the share of the light that the lobe reflects


def poses():
    """(place of the light, place of the camera, exposure) of each photograph.

    In every second one the light is near the mirror direction of the camera.
    """
    numbers = random.Random(7)

    def anywhere():
        z = 1 - numbers.random() * (1 - math.cos(MOST_TILT))
        ring, turn = math.sqrt(1 - z * z), 2 * math.pi * numbers.random()
        return (ring * math.cos(turn), ring * math.sin(turn), z)

    result = []
    for number in range(PHOTOS):
        camera = anywhere()
        light = anywhere()
        if number % 2:
            off = [0.3 * (numbers.random() - 0.5) for _ in range(3)]
            light = unit((-camera[0] + off[0], -camera[1] + off[1], max(camera[2] + off[2], 0.3)))
        # Six digits, as in the table.
        place = lambda d: tuple(round(DISTANCE * c, 6) for c in d)
        result.append((place(light), place(camera), 12.0 if number % 4 == 3 else 24.0))
    return result


def texel(column, row):
    """(diffuse RGB in 1/sr, strength in 1/sr, exponent): diagonal stripes with soft edges."""
    t = 0.5 + 0.5 * math.tanh(3 * math.sin(2 * math.pi * (column + row) / 16))
    color, exponent = mix(RED[0], BLUE[0], t), RED[1] * (BLUE[1] / RED[1])**t
    return [c / math.pi for c in color], GLOSS * (exponent + 1) / (2 * math.pi), exponent


def encoded(value):
    """sRGB in 16 bits."""
    value = min(max(value, 0.0), 1.0)
    curve = 12.92 * value if value <= 0.0031308 else 1.055 * value**(1 / 2.4) - 0.055
    return round(65535 * curve)


def png(rows):
    """The bytes of a PNG of 16 bits from rows of RGB."""
    def chunk(name, content):
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))

    lines = b"".join(b"\0" + b"".join(struct.pack(">3H", *pixel) for pixel in row) for row in rows)
    head = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 16, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b"")


def photo(number):
    """The bytes of a photograph."""
    light, camera, exposure = poses()[number]
    size, rows = WIDTH / COLUMNS, []
    for row in range(ROWS):
        line = []
        for column in range(COLUMNS):
            at = ((column + 0.5) * size - WIDTH / 2, (ROWS / 2 - row - 0.5) * size, 0.0)
            to_light, to_camera = ([p - a for p, a in zip(place, at)] for place in (light, camera))
            l, v = unit(to_light), unit(to_camera)
            diffuse, strength, exponent = texel(column, row)
            lobe = strength * max(0.0, -l[0] * v[0] - l[1] * v[1] + l[2] * v[2])**exponent
            gain = exposure * math.pi * l[2] / dot(to_light, to_light)
            line.append([encoded(gain * (c + lobe)) for c in diffuse])
        rows.append(line)
    return png(rows)


def name(number):
    return f"stripes-{number:02d}.png"


def table():
    """The table of the photographs."""
    lines = ["# varnished stripes, 2 wide, photographed by a gantry", "image,light_x,light_y,light_z,camera_x,camera_y,camera_z,exposure"]
    for number, (light, camera, exposure) in enumerate(poses()):
        lines.append(",".join([name(number), *(repr(c) for c in (*light, *camera)), f"{exposure:g}"]))
    return ("\n".join(lines) + "\n").encode()


def files():
    """{name: function that returns the bytes}."""
    return {"capture/photos.csv": table} | {f"capture/{name(n)}": lambda n=n: photo(n) for n in range(PHOTOS)}
