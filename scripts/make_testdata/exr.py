"""Lat-long EXR images: their directions, and the file itself (scan lines, ZIP, half or float), written and read."""

import itertools
import math
import struct
import zlib

HALF, FLOAT = 1, 2
ZIP_COMPRESSION, LINES_PER_BLOCK = 3, 16
REC709 = (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329)  # x y of red, green, blue and white


def direction(column, row, width, height):
    """The unit vector (+Y up) of a point of a lat-long image: its centre looks along +Z, its left quarter along +X."""
    latitude = math.pi * (0.5 - row / height)
    longitude = 2 * math.pi * (0.5 - column / width)
    ring = math.cos(latitude)
    return (ring * math.sin(longitude), math.sin(latitude), ring * math.cos(longitude))


def attribute(name, kind, payload):
    """One header attribute."""
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(payload)) + payload


def header(width, height, names, pixel_type, comments):
    """The magic number, the version and the header of a single-part scan-line file with these channels."""
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iBxxxii", pixel_type, 0, 1, 1) for name in names)
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    return b"".join([
        struct.pack("<Ii", 20000630, 2),
        attribute("channels", "chlist", channels + b"\0"),
        attribute("chromaticities", "chromaticities", struct.pack("<8f", *REC709)),
        attribute("comments", "string", comments.encode()),
        attribute("compression", "compression", struct.pack("<B", ZIP_COMPRESSION)),
        attribute("dataWindow", "box2i", window),
        attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"),
        attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1)),
        attribute("software", "string", b"make-testdata"),
        b"\0"])


def zipped(raw):
    """A block as EXR's ZIP stores it: bytes of even and odd place apart, differences, deflate; raw if no shorter."""
    parted = raw[0::2] + raw[1::2]
    differences = bytes([parted[0]]) + bytes((b - a + 128) & 255 for a, b in zip(parted, parted[1:]))
    packed = zlib.compress(differences, 9)
    return packed if len(packed) < len(raw) else raw


def exr_file(rows, pixel_type, comments, names=("R", "G", "B")):
    """The bytes of an EXR. `rows`: from the top, each a list of texels with one value for each of the names."""
    width, height = len(rows[0]), len(rows)
    stored = sorted(range(len(names)), key=lambda channel: names[channel])
    line_format = f"<{width}{'e' if pixel_type == HALF else 'f'}"
    head = header(width, height, [names[channel] for channel in stored], pixel_type, comments)
    blocks = []
    for top in range(0, height, LINES_PER_BLOCK):
        raw = b"".join(struct.pack(line_format, *(texel[channel] for texel in row))
                       for row in rows[top:top + LINES_PER_BLOCK] for channel in stored)
        packed = zipped(raw)
        blocks.append(struct.pack("<ii", top, len(packed)) + packed)
    offsets, position = [], len(head) + 8 * len(blocks)
    for block in blocks:
        offsets.append(position)
        position += len(block)
    return head + struct.pack(f"<{len(blocks)}Q", *offsets) + b"".join(blocks)


def unzipped(packed, size):
    """What zipped() made of `size` bytes."""
    if len(packed) == size:
        return packed
    sums = bytearray(map((255).__and__, itertools.accumulate(zlib.decompress(packed))))
    sums[1::2] = bytes(b ^ 128 for b in sums[1::2])  # each difference is 128 too large
    raw, half = bytearray(size), (size + 1) // 2
    raw[0::2], raw[1::2] = sums[:half], sums[half:]
    return bytes(raw)


def zero_ended(data, at):
    """(a word that ends in a zero byte, the place behind it)"""
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def attributes(data):
    """({name: payload} of a header, the place behind it)"""
    found, at = {}, 8
    while data[at]:
        name, at = zero_ended(data, at)
        _, at = zero_ended(data, at)
        size, = struct.unpack_from("<i", data, at)
        found[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return found, at + 1


def channels_of(path):
    """{channel: rows of values, from the top} of a scan-line EXR of one part with ZIP or no compression."""
    data = path.read_bytes()
    head, at = attributes(data)
    lines = {0: 1, 2: 1, ZIP_COMPRESSION: LINES_PER_BLOCK}.get(head["compression"][0])
    kinds, place = [], 0  # of the channels, by name
    while head["channels"][place]:
        name, place = zero_ended(head["channels"], place)
        kinds.append((name, {HALF: "e", FLOAT: "f"}.get(head["channels"][place])))
        place += 16
    version, = struct.unpack_from("<I", data, 4)
    if version & ~0x400 != 2 or lines is None or any(kind is None for _, kind in kinds):
        raise ValueError(f"{path}: give an EXR of one part in scan lines of half or float, ZIP or not compressed")
    left, top, right, bottom = struct.unpack("<4i", head["dataWindow"])
    width = right - left + 1
    rows = {name: [] for name, _ in kinds}
    for block in struct.unpack_from(f"<{-(-(bottom - top + 1) // lines)}Q", data, at):
        y, size = struct.unpack_from("<ii", data, block)
        count = min(lines, bottom - y + 1)
        line = [(name, f"<{width}{kind}") for name, kind in kinds]
        raw, place = unzipped(data[block + 8:block + 8 + size], count * sum(struct.calcsize(f) for _, f in line)), 0
        for name, form in line * count:
            rows[name].append(struct.unpack_from(form, raw, place))
            place += struct.calcsize(form)
    return rows
