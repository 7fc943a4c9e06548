"""Evaluates an RGL tensor file, with RGB or bands of wavelength, after [DupuyJakob2018] and the description of its data."""

import struct

import numpy


def fields(path):
    """The arrays of a tensor file by name."""
    data = open(path, "rb").read()
    (magic, count), place, arrays = struct.unpack_from("<14sI", data), 18, {}
    assert magic == b"tensor_file\0\1\0"
    for _ in range(count):
        (length,) = struct.unpack_from("<H", data, place)
        name = data[place + 2:place + 2 + length].decode()
        rank, kind, offset = struct.unpack_from("<HBQ", data, place + 2 + length)
        shape = struct.unpack_from(f"<{rank}Q", data, place + 13 + length)
        place += 13 + length + 8 * rank
        arrays[name] = numpy.frombuffer(data, {1: "u1", 10: "<f4"}[kind], int(numpy.prod(shape)), offset).reshape(shape).astype(float)
    return arrays


def bilinear(table, x, y):
    """A table over the unit square at x (along its last axis) and y."""
    x, y = x * (table.shape[-1] - 1), y * (table.shape[-2] - 1)
    i, j = (min(int(at), size - 2) for at, size in ((x, table.shape[-1]), (y, table.shape[-2])))
    rows = table[..., j:j + 2, i] * (1 - (x - i)) + table[..., j:j + 2, i + 1] * (x - i)
    return rows[..., 0] * (1 - (y - j)) + rows[..., 1] * (y - j)


def share_below(density, at):
    """The share of the integral of a density, linear between its nodes, that lies below a place in 0..1."""
    fine = numpy.union1d(numpy.linspace(0, 1, len(density)), [at])
    values = numpy.interp(fine, numpy.linspace(0, 1, len(density)), density)
    pieces = numpy.diff(fine) * (values[1:] + values[:-1]) / 2
    return pieces[fine[1:] <= at + 1e-15].sum() / pieces.sum()


def value(file, viewer, light):
    """f in Rec.709 or in bands; the first direction of the file is that of the viewer."""
    half = (viewer + light) / numpy.linalg.norm(viewer + light)
    theta, theta_h = numpy.arccos(numpy.minimum((viewer[2], half[2]), 1))
    turn = numpy.arctan2(half[1], half[0]) - numpy.arctan2(viewer[1], viewer[0])
    u, v = numpy.sqrt(theta_h * 2 / numpy.pi), (turn / (2 * numpy.pi) + 0.5) % 1
    angles = file["theta_i"]
    k = int(numpy.clip(numpy.searchsorted(angles, theta) - 1, 0, len(angles) - 2))
    w = float(numpy.clip((theta - angles[k]) / (angles[k + 1] - angles[k]), 0, 1))
    density = sum(share * table / table.mean() for share, table in zip((1 - w, w), file["vndf"][0, k:k + 2]))
    rows, y = (density[:, 1:] + density[:, :-1]).sum(1), v * (len(density) - 1)
    j = min(int(y), len(rows) - 2)
    s = share_below((1 - (y - j)) * density[j] + (y - j) * density[j + 1], u)
    one, two = file["rgb" if "rgb" in file else "spectra"][0, k:k + 2]
    colors = bilinear((1 - w) * one + w * two, s, share_below(rows, v))
    return colors * bilinear(file["ndf"], u, v) / (4 * bilinear(file["sigma"], numpy.sqrt(theta * 2 / numpy.pi), 0.5)) / light[2]


def reflection(path, lights, views):
    """f of each pair of directions, one a row."""
    file = fields(path)
    return numpy.array([value(file, view, light) for light, view in zip(lights, views)])


def share_above_horizon(path, viewer):
    """The share of a renderer's samples of lights that stand above the horizon, for a viewer at that place among the file's angles.

    A sample is drawn by the luminance of the square, then by the density of half vectors.
    """
    file = fields(path)
    theta, luminance, density = file["theta_i"][viewer], file["luminance"][0, viewer], file["vndf"][0, viewer]
    middles = numpy.linspace(0, 1, 2 * len(luminance) + 1)[1::2]
    def gathered(values):
        return numpy.concatenate([[0], numpy.cumsum((values[1:] + values[:-1]) / 2)])
    def between(rows, at):
        low = min(int(at), len(rows) - 2)
        return rows[low] + (at - low) * (rows[low + 1] - rows[low])
    sums, drawn, above = gathered(density.sum(1)), 0.0, 0.0
    for t in middles:
        y = numpy.interp(t * sums[-1], sums, numpy.arange(len(sums)))
        row = gathered(between(density, y))
        u = numpy.interp(middles * row[-1], row, numpy.linspace(0, 1, len(row)))
        half, azimuth = u ** 2 * numpy.pi / 2, (2 * y / (len(sums) - 1) - 1) * numpy.pi
        along = numpy.sin(half) * numpy.cos(azimuth) * numpy.sin(theta) + numpy.cos(half) * numpy.cos(theta)
        weights = [bilinear(luminance, s, t) for s in middles]
        drawn += numpy.sum(weights)
        above += numpy.sum(weights * (2 * along * numpy.cos(half) > numpy.cos(theta)))
    return above / drawn
