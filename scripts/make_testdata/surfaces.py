"""Spatially varying surfaces (*.sbrdf.exr): brushed metal, a nameplate, wood.

Each texel is a sum of generalized cosine lobes, f = diffuse + sum albedo (x wo.x wi.x + y wo.y wi.y + z wo.z wi.z)^n in
1/sr and linear Rec.2020. Its frame has an x axis along the brush or the grain, which is turned by half the angle of
(frame.c, frame.s). The equations are in goniochrome-surfaces(7), "SPATIALLY VARYING SURFACES".
"""

import math

import numpy

from make_testdata.blend import mix, smooth_step
from shared import pictures

# Texels along each side of the files, and the unit of length of the patterns, so that larger maps show the same.
SIZE = 128


def noise(*integers):
    """A number from 0 to 1 that looks random: a hash of the integers."""
    state = 0x9E3779B9
    for value in integers:
        state = (state ^ (value & 0xFFFFFFFF)) * 0x85EBCA6B & 0xFFFFFFFF
        state ^= state >> 13
        state = state * 0xC2B2AE35 & 0xFFFFFFFF
        state ^= state >> 16
    return state / 0xFFFFFFFF


def soft_noise(x, y, period_x, period_y, seed):
    """Noise that is smooth between whole numbers and repeats itself after the periods."""
    column, row = math.floor(x), math.floor(y)
    s, t = smooth_step(0, 1, x - column), smooth_step(0, 1, y - row)
    at = [[noise((column + i) % period_x, (row + j) % period_y, seed) for i in (0, 1)] for j in (0, 1)]
    top, bottom = (a + s * (b - a) for a, b in at)
    return top + t * (bottom - top)


def lobe_energy(exponent):
    """The albedo (1/sr) with which a lobe about the mirror direction reflects all light."""
    return (exponent + 1) / (2 * math.pi)


def metal(tint, strength):
    """Three lobes of a metal that is brushed along x.

    The sharp one lies about the mirror direction. The wider a lobe is, the less it follows the view across the brush (along y),
    as the mean normal of the grooves does; together they draw the highlight long across the brush.
    """
    fan = ((18, 0.0, 0.40), (56, 0.80, 0.30), (184, 1.0, 0.15))
    values = []
    for exponent, across, share in fan:
        albedo = strength * share * lobe_energy(exponent)
        values += [albedo * c for c in tint] + [-1.0, -across, 1.0, exponent]
    return values


def names(lobes):
    """The names of a texel's channels, in the order of its values."""
    result = ["diffuse.R", "diffuse.G", "diffuse.B", "frame.c", "frame.s"]
    for lobe in range(lobes):
        result += [f"lobe{lobe}.{channel}" for channel in "RGBxyzn"]
    return result


def frame(angle):
    """The direction of a texel's x axis, turned by `angle`, as it is stored."""
    return [math.cos(2 * angle), math.sin(2 * angle)]


STEEL, BRASS = (0.80, 0.82, 0.84), (0.86, 0.68, 0.36)


def brushed(column, row, fine):
    """Steel with streaks, `fine` times finer than a texel of SIZE, whose brush direction makes one full turn across."""
    angle = 2 * math.pi * (column + 0.5) / SIZE
    along = math.cos(angle) * column + math.sin(angle) * row
    across = -math.sin(angle) * column + math.cos(angle) * row
    streak = 0.85 + 0.3 * soft_noise(along / 24, across * 1.5 * fine, 4096, 4096, 1)
    return [0.012 * c for c in STEEL] + frame(angle) + metal(STEEL, streak)


# Letters of 5 x 7 dots; each number is the bits of a row.
LETTERS = {
    "G": (14, 17, 16, 23, 17, 17, 15), "O": (14, 17, 17, 17, 17, 17, 14), "N": (17, 25, 21, 19, 17, 17, 17),
    "I": (14, 4, 4, 4, 4, 4, 14), "C": (14, 17, 16, 16, 16, 17, 14), "H": (17, 17, 17, 31, 17, 17, 17),
    "R": (30, 17, 17, 30, 20, 18, 17), "M": (17, 27, 21, 21, 17, 17, 17), "E": (31, 16, 16, 30, 16, 16, 31),
}
LINES, DOT = ("GONIO", "CHROME"), 3


def lettered(column, row):
    """Whether a place is inside the lettering, which is two centered lines."""
    column, row = math.floor(column + 0.5), math.floor(row + 0.5)
    for number, word in enumerate(LINES):
        width, top = (6 * len(word) - 1) * DOT, SIZE // 2 - 26 + 30 * number
        x, y = column - (SIZE - width) // 2, row - top
        if 0 <= x < width and 0 <= y < 7 * DOT:
            letter, dot = divmod(x // DOT, 6)
            return dot < 5 and LETTERS[word[letter]][y // DOT] >> (4 - dot) & 1 == 1
    return False


def nameplate(column, row, fine):
    """Brass that is brushed across, with letters that are brushed upright.

    The letters are the same metal, only a little darker; what makes them readable is the direction of their highlights.
    """
    inside = lettered(column, row)
    angle = math.pi / 2 if inside else 0.0
    along, across = (row, column) if inside else (column, row)
    streak = 0.85 + 0.3 * soft_noise(along / 16, across * fine, SIZE // 16, SIZE * fine, 2)
    return [0.012 * c for c in BRASS] + frame(angle) + metal(BRASS, streak * (0.8 if inside else 1.0))


def wood(column, row, _fine):
    """Varnished oak, cut along the trunk: rings that darken slowly and end at once, fibers, and short dark pores.

    The lobe is wide on the dark part of a ring (an exponent of about 10) and glossier between (about 150). Both reflect more at
    grazing angles, where the length of p is above 1.
    """
    x, y = (column + 0.5) / SIZE, (row + 0.5) / SIZE
    bend = 0.05 * math.sin(2 * math.pi * x) + 0.16 * soft_noise(2 * x, 3 * y, 2, 3, 3) + 0.02 * soft_noise(9 * x, 12 * y, 9, 12, 6)
    ring = 9 * (y + bend) + 0.15 * soft_noise(12 * x, 48 * y, 12, 48, 4)
    phase = ring - math.floor(ring)
    grain = smooth_step(0.25, 0.92, phase) ** 2 * (1 - smooth_step(0.94, 1.0, phase))
    fiber = 0.8 + 0.25 * soft_noise(8 * x, 96 * y, 8, 96, 5) + 0.2 * soft_noise(24 * x, 256 * y, 24, 256, 7)
    pore = smooth_step(0.72, 0.86, soft_noise(14 * x, 128 * y, 14, 128, 8)) * (0.35 + 0.65 * grain)
    color = tuple(fiber * (1 - 0.55 * pore) * c / math.pi for c in mix((0.27, 0.18, 0.085), (0.13, 0.075, 0.032), grain))
    rough = min(1.0, grain + 0.5 * pore)
    exponent = 150 * (10 / 150) ** rough
    strength = 0.035 * (1 - 0.6 * rough) * lobe_energy(exponent)
    return list(color) + frame(0.0) + [strength] * 3 + [-1 - 1.5 / exponent] * 2 + [1.0, exponent]


def surface_exr(texel, lobes, comments, size):
    """The bytes of one texture of so many texels along each side, a multiple of SIZE."""
    fine = size // SIZE
    places = [(i + 0.5) / fine - 0.5 for i in range(size)]
    rows = [[texel(column, row, fine) for column in places] for row in places]
    return pictures.exr_file(rows, numpy.float16, comments, names(lobes))


def brushed_exr(size=SIZE):
    return surface_exr(brushed, 3, "brushed steel, the brush turning once across; generalized cosine lobes, linear Rec.2020", size)


def nameplate_exr(size=SIZE):
    return surface_exr(nameplate, 3, "lettering in brushed brass; generalized cosine lobes, linear Rec.2020", size)


def wood_exr(size=SIZE):
    return surface_exr(wood, 1, "varnished wood; generalized cosine lobes, linear Rec.2020", size)
