"""Reads cube textures of KTX 2.0 and DDS with numpy alone, and sums lobes over a lat-long image of Radiance HDR.

It was written from the formats' specifications and shares no code with the tool.
"""
import struct

import numpy


def ktx2(path):
    """The metadata, and each level as an array of (6, n, n, 4), the largest level first."""
    data = open(path, "rb").read()
    assert data[:12] == b"\xabKTX 20\xbb\r\n\x1a\n"
    vk_format, type_size, width, height, depth, layers, faces, count, packed = struct.unpack_from("<9I", data, 12)
    assert (width, depth, layers, faces, packed) == (height, 0, 0, 6, 0)
    kind = {97: "<f2", 109: "<f4"}[vk_format]
    assert type_size == numpy.dtype(kind).itemsize
    format_at, format_bytes, pairs_at, pairs_bytes, shared_at, shared_bytes = struct.unpack_from("<4I2Q", data, 48)
    assert (shared_at, shared_bytes) == (0, 0) and struct.unpack_from("<I", data, format_at)[0] == format_bytes
    model, primaries, transfer, flags = data[format_at + 12 : format_at + 16]
    assert (model, primaries, transfer, flags) == (1, 1, 1, 0)  # RGBSDA, BT.709, linear, straight alpha
    pairs, at = {}, pairs_at
    while at < pairs_at + pairs_bytes:
        length = struct.unpack_from("<I", data, at)[0]
        key, value = data[at + 4 : at + 4 + length].split(b"\0")[:2]
        pairs[key.decode()] = value.decode()
        at += 4 + (length + 3) // 4 * 4
    assert at == pairs_at + pairs_bytes and list(pairs) == sorted(pairs)
    levels, end = [], None
    for level in range(count):
        at, length, whole = struct.unpack_from("<3Q", data, 80 + 24 * level)
        n = max(1, width >> level)
        assert length == whole == 6 * n * n * 4 * type_size and at % (4 * type_size) == 0
        assert end is None or at + length <= end  # the smallest level comes first
        assert end is not None or at + length == len(data)
        levels.append(numpy.frombuffer(data, kind, 6 * n * n * 4, at).reshape(6, n, n, 4).astype(float))
        end = at
    return pairs, levels


def dds(path):
    """Each level as an array of (6, n, n, 4), the largest level first."""
    data = open(path, "rb").read()
    header = struct.unpack_from("<4s31I", data)
    assert header[0] == b"DDS " and header[1] == 124 and header[19] == 32
    height, width, count, code, caps2 = header[3], header[4], header[7], header[21], header[28]
    assert width == height and caps2 == 0xFE00
    kind = numpy.dtype({113: "<f2", 116: "<f4"}[code])
    sizes = [max(1, width >> level) for level in range(count)]
    values = numpy.frombuffer(data, kind, -1, 128).astype(float).reshape(6, sum(4 * n * n for n in sizes))
    ends = numpy.cumsum([4 * n * n for n in sizes])
    return [values[:, end - 4 * n * n : end].reshape(6, n, n, 4) for n, end in zip(sizes, ends)]


def directions(n):
    """The directions of the texels of a cube of n texels a face, as (6, n, n, 3): table 8.19 of OpenGL 4.5."""
    t, s = numpy.meshgrid(*[(2 * numpy.arange(n) + 1) / n - 1] * 2, indexing="ij")
    one = numpy.ones_like(s)
    faces = [(one, -t, -s), (-one, -t, s), (s, one, t), (s, -one, -t), (s, -t, one), (-s, -t, -one)]
    d = numpy.array([numpy.stack(face, -1) for face in faces])
    return d / numpy.linalg.norm(d, axis=-1, keepdims=True)


def flat_hdr(path):
    """A Radiance HDR image without run lengths."""
    header, data = open(path, "rb").read().split(b"\n\n", 1)
    size, data = data.split(b"\n", 1)
    height, width = int(size.split()[1]), int(size.split()[3])
    rgbe = numpy.frombuffer(data, "u1").reshape(height, width, 4).astype(float)
    return rgbe[..., :3] * numpy.exp2(rgbe[..., 3:] - 136)


def filtered(image, exponent, where):
    """The mean of a lat-long image under max(0, cos)^exponent about each direction; texels are cut 4 x 4."""
    parts = 4
    fine = image.repeat(parts, 0).repeat(parts, 1)
    rows, columns = fine.shape[:2]
    theta = numpy.pi * (numpy.arange(rows) + 0.5) / rows
    longitude = 2 * numpy.pi * (0.5 - (numpy.arange(columns) + 0.5) / columns)
    ring = numpy.sin(theta)[:, None] + 0 * longitude
    d = numpy.stack((ring * numpy.sin(longitude), numpy.cos(theta)[:, None] + 0 * ring, ring * numpy.cos(longitude)), -1)
    sums = []
    for axis in where.reshape(-1, 3):
        cosine = d @ axis
        seen = cosine > 0
        weight = cosine[seen] ** exponent * ring[seen]
        sums.append(weight @ fine[seen] / weight.sum())
    return numpy.reshape(sums, where.shape)


def largest_difference(levels, exponents, image, known={}):
    """The largest difference of any texel from the filtered image, relative to the texel; `known` are filtered images."""
    worst = 0
    for level, exponent in zip(levels, exponents):
        assert (level[..., 3] == 1).all()
        key = image.tobytes(), exponent, level.shape[1]
        if key not in known:
            known[key] = filtered(image, exponent, directions(level.shape[1]))
        worst = max(worst, (numpy.abs(level[..., :3] - known[key]) / known[key]).max())
    return worst
