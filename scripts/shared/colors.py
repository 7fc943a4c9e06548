"""CIELAB and its color difference, for numpy arrays whose last axis has the three values of a color."""

import numpy

WHITE = (0.95047, 1.0, 1.08883)  # XYZ of D65
XYZ_FROM_REC2020 = ((0.636958, 0.144617, 0.168881), (0.262700, 0.677998, 0.059302), (0.0, 0.028073, 1.060985))


def lab(xyz):
    """L*, a* and b* of XYZ under D65 [CIE 15:2018, 8.2.1]."""
    ratio = xyz / numpy.array(WHITE)
    f = numpy.where(ratio > (6 / 29) ** 3, numpy.cbrt(ratio), ratio / (3 * (6 / 29) ** 2) + 4 / 29)
    fx, fy, fz = numpy.moveaxis(f, -1, 0)
    return numpy.stack([116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)], -1)


def lab_of_rec2020(rgb, white):
    """L*, a* and b* of linear Rec.2020, before a white of this luminance."""
    return lab(numpy.maximum(rgb @ numpy.transpose(XYZ_FROM_REC2020) / white, 0))


def de2000(one, two):
    """CIEDE2000 of two arrays of Lab colors [Sharma2005]."""
    (l1, a1, b1), (l2, a2, b2) = numpy.moveaxis(one, -1, 0), numpy.moveaxis(two, -1, 0)
    mean7 = ((numpy.hypot(a1, b1) + numpy.hypot(a2, b2)) / 2) ** 7
    g = 0.5 * (1 - numpy.sqrt(mean7 / (mean7 + 25 ** 7)))
    a1, a2 = a1 * (1 + g), a2 * (1 + g)
    c1, c2 = numpy.hypot(a1, b1), numpy.hypot(a2, b2)
    h1, h2 = numpy.degrees(numpy.arctan2(b1, a1)) % 360, numpy.degrees(numpy.arctan2(b2, a2)) % 360
    chromatic = c1 * c2 != 0
    turn = numpy.where(chromatic, (h2 - h1 + 180) % 360 - 180, 0)
    dh = 2 * numpy.sqrt(c1 * c2) * numpy.sin(numpy.radians(turn) / 2)
    h = numpy.where(chromatic, (h1 + turn / 2) % 360, h1 + h2)
    t = 1 + sum(k * numpy.cos(numpy.radians(n * h + p)) for k, n, p in
                ((-0.17, 1, -30), (0.24, 2, 0), (0.32, 3, 6), (-0.20, 4, -63)))
    l, c = (l1 + l2) / 2 - 50, (c1 + c2) / 2
    sl = 1 + 0.015 * l * l / numpy.sqrt(20 + l * l)
    sc, sh = 1 + 0.045 * c, 1 + 0.015 * c * t
    rt = -numpy.sin(numpy.radians(60 * numpy.exp(-(((h - 275) / 25) ** 2)))) * 2 * numpy.sqrt(c ** 7 / (c ** 7 + 25 ** 7))
    x, y, z = (l2 - l1) / sl, (c2 - c1) / sc, dh / sh
    return numpy.sqrt(numpy.maximum(0, x * x + y * y + z * z + rt * y * z))
