#!/usr/bin/env python3
"""Writes the ICC profile of a printer of three inks, ICC.1:2010: print_profile.py FILE.icc

It prints each L* from 20 to 95 with each a* and b* from -60 to 60, and no other color.
"""

import struct
import sys

GRID = 33
LOW, HIGH = (20, -60, -60), (95, 60, 60)


def lut(table):
    """A tag of 16 bits whose curves are straight: three channels to three."""
    head = b"mft2" + bytes(4) + bytes((3, 3, GRID, 0)) + struct.pack(">9i", *(65536 * (i % 4 == 0) for i in range(9)))
    straight = struct.pack(">6H", *(0, 65535) * 3)
    nodes = ((x, y, z) for x in range(GRID) for y in range(GRID) for z in range(GRID))
    return head + struct.pack(">2H", 2, 2) + straight + b"".join(struct.pack(">3H", *table(*node)) for node in nodes) + straight


def colors(*node):
    lab = [low + (high - low) * i / (GRID - 1) for i, low, high in zip(node, LOW, HIGH)]
    return [round(lab[0] * 652.8), *(round((x + 128) * 256) for x in lab[1:])]


def inks(*node):
    codes = [65535 * i / (GRID - 1) for i in node]
    lab = [codes[0] / 652.8, *(code / 256 - 128 for code in codes[1:])]
    return [round(65535 * min(1, max(0, (x - low) / (high - low)))) for x, low, high in zip(lab, LOW, HIGH)]


white = b"XYZ " + bytes(4) + struct.pack(">3i", 63190, 65536, 54061)
parts = {b"wtpt": white, b"A2B0": lut(colors), b"B2A0": lut(inks)}
table, body, places = b"", b"", {}
first = 128 + 4 + 12 * 7
for name, part in parts.items():
    places[name] = struct.pack(">2I", first + len(body), len(part))
    body += part
for name in (b"wtpt", b"A2B0", b"A2B1", b"A2B2", b"B2A0", b"B2A1", b"B2A2"):
    table += name + places[name[:3] + b"0" if name[3:].isdigit() else name]
head = struct.pack(">I4sI4s4s4s", first + len(body), bytes(4), 0x02400000, b"prtr", b"RGB ", b"Lab ") + struct.pack(">6H", 2026, 1, 1, 0, 0, 0)
head += b"acsp" + bytes(28) + struct.pack(">3i", 63190, 65536, 54061)
with open(sys.argv[1], "wb") as file:
    file.write(head.ljust(128, b"\0") + struct.pack(">I", 7) + table + body)
