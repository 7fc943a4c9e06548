"""outdoor.exr: an analytic clear sky with a sun of its real size, over asphalt and a low skyline.

Radiance is linear Rec.709 in units where the sun is 1e5 and the zenith is about 0.3. The brightness of the sky follows the
CIE general sky: a gradation in elevation times the scattering around the sun. Its color goes from blue at the zenith to a
pale haze at the horizon. Mantissas are rounded to MANTISSA_BITS so that the file stays small; those of the sun are not.
"""

import math

import numpy

from make_testdata.blend import mix, smooth_step
from make_testdata.vectors import angle
from shared import pictures

WIDTH, HEIGHT = 1024, 512
MANTISSA_BITS = 10

SUN_COLUMN, SUN_ROW = 128.5, 147.5  # The center of a texel: azimuth 135 deg to the left of +Z, elevation 38 deg.
SUN_RADIUS_RAD = math.radians(0.25)
SUN_RADIANCE = 1e5
SUN_COLOR = (1.0, 0.955, 0.885)
SUN_GRID = 256  # SUN_GRID x SUN_GRID points in a texel measure how much of it the sun covers.
SUN = pictures.direction(SUN_COLUMN, SUN_ROW, WIDTH, HEIGHT)

ZENITH, HORIZON, HAZE = (0.130, 0.275, 0.60), (0.62, 0.88, 1.16), (1.85, 1.82, 1.74)
ASPHALT, PAINT_LINE = (0.198, 0.196, 0.194), (0.92, 0.90, 0.85)
FOREST, FIELD = (0.034, 0.045, 0.028), (0.15, 0.16, 0.075)


def angle_to_sun(d):
    """The angle in radians between d and the center of the sun."""
    return angle(d, SUN)


def sky(d):
    """Radiance of the sky without the sun's disc, for d above the horizon."""
    sine = max(d[1], 0.012)
    gradation = (1 - math.exp(-0.32 / sine)) / (1 - math.exp(-0.32))  # It is 1 at the zenith and 3.7 at the horizon.
    chi = angle_to_sun(d)
    scattering = 1 + 4.2 * (math.exp(-3.0 * chi) - math.exp(-1.5 * math.pi)) + 0.38 * math.cos(chi) ** 2
    color = mix(mix(ZENITH, HORIZON, (gradation - 1) / 2.7), HAZE, 0.8 * math.exp(-d[1] / 0.07))
    aureole = 0.9 * math.exp(-chi / 0.11) + 7.0 * math.exp(-chi / 0.028)
    level = (0.70 + 0.30 * gradation / 3.7) * scattering * 0.62
    return tuple(c * level + aureole * s for c, s in zip(color, SUN_COLOR))


def ridge(azimuth, terms):
    """The elevation of a skyline in degrees: a sum of sines, each an (amplitude, cycles in a full turn, phase)."""
    return sum(a * math.sin(n * azimuth + p) for a, n, p in terms)


HILLS = ((2.1, 2, 0.4), (1.1, 5, 1.9), (0.45, 11, 0.3), (0.22, 23, 2.2))
TREES = ((0.9, 3, 2.6), (0.5, 7, 0.8), (0.22, 31, 1.1), (0.17, 53, 0.2), (0.12, 97, 2.9))
# Of each building: the azimuths where it begins and ends, its height, all in degrees, and its shade.
BUILDINGS = ((-168, -157, 5.6, 0.85), (-155, -146, 8.3, 1.1), (-146, -139, 4.4, 0.7), (-128, -121, 6.6, 0.95),
             (96, 104, 6.2, 0.9), (106, 121, 4.1, 1.15), (124, 130, 7.7, 0.8), (-38, -31, 3.9, 0.9))


def skyline(d, elevation):
    """Radiance of the nearest silhouette in direction d; None if there is only sky."""
    azimuth = math.atan2(d[0], d[2])
    degrees = math.degrees(azimuth)
    for start, end, height, shade in BUILDINGS:
        if start < degrees < end and elevation < height:
            sunlit = 0.5 + 0.5 * max(-0.4, math.cos(azimuth - math.atan2(SUN[0], SUN[2]) + math.pi))
            return tuple(c * shade * (0.5 + sunlit) for c in (0.26, 0.245, 0.23))
    if elevation < 1.9 + ridge(azimuth, TREES):
        return mix(FOREST, (0.085, 0.105, 0.06), smooth_step(0.2, 2.8, elevation))
    if elevation < 3.4 + ridge(azimuth, HILLS):
        return mix((0.30, 0.37, 0.47), (0.19, 0.25, 0.31), smooth_step(0, 7, elevation))
    return None


def ground(d):
    """Radiance of the ground for d below the horizon: a paved lot with painted lines along z, then a field, then a forest."""
    reach = 0.7 / max(1e-4, -d[1])
    x, distance = reach * d[0], reach * math.hypot(d[0], d[2])
    line = max(1 - smooth_step(0.06, 0.16, abs(abs(x) - offset)) for offset in (2.6, 6.2)) * math.exp(-distance / 14)
    paved = mix(mix(ASPHALT, (0.25, 0.25, 0.255), smooth_step(2, 20, distance)), PAINT_LINE, line)
    return mix(mix(paved, FIELD, smooth_step(22, 27, distance)), FOREST, 0.35 * smooth_step(50, 160, distance))


def scene(d):
    """Radiance in direction d without the sun's disc."""
    elevation = math.degrees(math.asin(max(-1.0, min(1.0, d[1]))))
    if elevation < 0:
        return ground(d)
    return skyline(d, elevation) or sky(d)


def sun_coverage(column, row):
    """The part of a texel's solid angle that the sun's disc covers, from 0 to 1."""
    covered = total = 0.0
    for j in range(SUN_GRID):
        y = row + (j + 0.5) / SUN_GRID
        weight = math.cos(math.pi * (0.5 - y / HEIGHT))
        hits = sum(angle_to_sun(pictures.direction(column + (i + 0.5) / SUN_GRID, y, WIDTH, HEIGHT)) < SUN_RADIUS_RAD
                   for i in range(SUN_GRID))
        covered += weight * hits
        total += weight * SUN_GRID
    return covered / total


def cut(value):
    """`value` rounded to MANTISSA_BITS bits behind its leading bit."""
    mantissa, exponent = math.frexp(value)
    scale = 2.0 ** (MANTISSA_BITS + 1)
    return math.ldexp(round(mantissa * scale) / scale, exponent)


def outdoor_exr():
    """The bytes of outdoor.exr."""
    offsets = (0.25, 0.75)
    rows = []
    for row in range(HEIGHT):
        detailed = row > HEIGHT / 2 - 32  # The skyline and the lines need four points in a texel, the smooth sky needs one.
        points = [(dx, dy) for dx in offsets for dy in offsets] if detailed else [(0.5, 0.5)]
        texels = []
        for column in range(WIDTH):
            samples = [scene(pictures.direction(column + dx, row + dy, WIDTH, HEIGHT)) for dx, dy in points]
            texels.append([cut(sum(channel) / len(points)) for channel in zip(*samples)])
        rows.append(texels)
    column, row = int(SUN_COLUMN), int(SUN_ROW)
    for y in range(row - 1, row + 2):
        for x in range(column - 1, column + 2):
            rows[y][x] = mix(rows[y][x], [SUN_RADIANCE * s for s in SUN_COLOR], sun_coverage(x, y))
    return pictures.exr_file(rows, numpy.float32, "designed clear sky with a 0.5 degree sun, lat-long, linear Rec.709")
