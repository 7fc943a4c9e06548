"""Looks directions up in a .xml file of Radiance: the tensor tree of rank 3 on the side of "Reflection Back", as the library
of Radiance does, with Y and the chromaticities u' and v' relative to the illuminant E."""

import xml.etree.ElementTree

import numpy

SPACE = "{http://windows.lbl.gov}"
BRADFORD = numpy.array(((0.8951, 0.2664, -0.1614), (-0.7502, 1.7135, 0.0367), (0.0389, -0.0685, 1.0296)))
XYZ_FROM_REC709 = numpy.array(((0.412391, 0.357584, 0.180481), (0.212639, 0.715169, 0.072192), (0.019331, 0.119195, 0.950532)))


class Tree:
    """A grid of 1, 8 or 64... numbers, or eight trees, as nested braces. Only the branches that are looked up are read."""

    def __init__(self, text):
        self.text = text.encode()
        letters = numpy.frombuffer(self.text, numpy.uint8)
        self.places = numpy.flatnonzero((letters == ord("{")) | (letters == ord("}")))
        opens = letters[self.places] == ord("{")
        depth = numpy.cumsum(numpy.where(opens, 1, -1)) + ~opens  # a brace and its partner have the same
        order = numpy.argsort(depth, kind="stable")  # at one depth the braces open and close in turn
        assert depth[-1] == 1 and len(order) % 2 == 0 and opens[order[::2]].all() and not opens[order[1::2]].any()
        self.partner = numpy.empty_like(order)
        self.partner[order[::2]] = order[1::2]

    def at(self, place):
        node = 0
        while self.partner[node] > node + 1:  # of eight branches the first axis is the fastest
            branches = [node + 1]
            while self.partner[branches[-1]] + 1 < self.partner[node]:
                branches.append(self.partner[branches[-1]] + 1)
            assert len(branches) == 8
            place = 2 * place
            high = place >= 1
            place = place - high
            node = branches[high @ (1, 2, 4)]
        grid = self.text[self.places[node] + 1:self.places[node + 1]].replace(b",", b" ").split()
        width = round(len(grid) ** (1 / 3))  # of a grid the last axis is the fastest
        return float(grid[(width * place).astype(int) @ (width * width, width, 1)])


def square(x, y):
    """The map of Shirley and Chiu from the disc to the square."""
    radius, angle = numpy.hypot(x, y), numpy.arctan2(y, x)
    side = numpy.floor((angle + numpy.pi / 4) / (numpy.pi / 2)) % 4
    along = radius * ((angle - side * numpy.pi / 2 + numpy.pi) % (2 * numpy.pi) - numpy.pi) / (numpy.pi / 4)
    a, b = {0: (radius, along), 1: (-along, radius), 2: (-radius, -along), 3: (along, -radius)}[int(side)]
    return (a + 1) / 2, (b + 1) / 2


def trees(path):
    layer = xml.etree.ElementTree.parse(path).getroot().find(f"{SPACE}Optical/{SPACE}Layer")
    assert layer.find(f"{SPACE}DataDefinition/{SPACE}IncidentDataStructure").text == "TensorTree3"
    found = {}
    for data in layer.findall(SPACE + "WavelengthData"):
        block = data.find(SPACE + "WavelengthDataBlock")
        assert block.find(SPACE + "WavelengthDataDirection").text == "Reflection Back"
        found[data.find(SPACE + "Wavelength").text] = Tree(block.find(SPACE + "ScatteringData").text)
    return found


def xyz(path, light, view):
    """XYZ of f of each pair of directions, one a row, relative to the illuminant E."""
    found, rows = trees(path), []
    for l, v in zip(light, view):
        sine = numpy.hypot(l[0], l[1])
        c, s = (-l[0] / sine, -l[1] / sine) if sine > 0 else (1, 0)
        place = numpy.array((0.5 - 1e-6 - sine / 2, *square(c * v[0] + s * v[1], c * v[1] - s * v[0])))
        y, u, w = (found[name].at(place) for name in ("Visible", "CIE-u", "CIE-v"))
        rows.append((9 * u * y / (4 * w), y, y * (12 - 3 * u - 20 * w) / (4 * w)))
    return numpy.array(rows)


def reflection(path, light, view):
    """f of each pair of directions, one a row, in Rec.709."""
    cones = BRADFORD @ XYZ_FROM_REC709.sum(1)
    to_d65 = numpy.linalg.inv(BRADFORD) @ numpy.diag(cones / BRADFORD.sum(1)) @ BRADFORD
    return xyz(path, light, view) @ to_d65.T @ numpy.linalg.inv(XYZ_FROM_REC709).T
