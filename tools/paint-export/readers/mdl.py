"""Evaluates a material of MDL: a measured table, and a fresnel_layer over it, after the specification and NVIDIA's implementation of MDL."""

import pathlib
import re
import struct

import numpy

from facets import dielectric
from materialx import REC709_FROM_ACESCG


def table(path):
    """The values of an .mbsdf file over light, viewer and azimuth, in Rec.709."""
    data = pathlib.Path(path).read_bytes()
    assert data.startswith(b"NVIDIA ARC MBSDF V1\n")
    place = data.index(b"MBSDF_DATA_REFLECTION=\n") + len(b"MBSDF_DATA_REFLECTION=\n")
    kind, theta, phi = struct.unpack_from("<3I", data, place)
    assert kind == 1 and len(data) == place + 12 + theta * theta * phi * 12
    values = numpy.frombuffer(data, "<f4", -1, place + 12).reshape(theta, theta, phi, 3).astype(float)
    return values @ REC709_FROM_ACESCG.T if b'\ncolorspace="acescg"\n' in data[:place] else values


def looked_up(values, light, view):
    """Linear between the centers of cells, and constant beyond the outermost ones."""
    # 0 where one of them is the normal.
    azimuth = numpy.arctan2(abs(light[0] * view[1] - light[1] * view[0]), light[0] * view[0] + light[1] * view[1])
    for angle, most in ((numpy.arccos(light[2]), numpy.pi / 2), (numpy.arccos(view[2]), numpy.pi / 2), (azimuth, numpy.pi)):
        x = numpy.clip(angle / most * len(values) - 0.5, 0, len(values) - 1)
        low = min(int(x), len(values) - 2)
        values = values[low] + (x - low) * (values[low + 1] - values[low])
    return values


def reflection(path, lights, views):
    """f of each pair of directions, one a row."""
    text = pathlib.Path(path).read_text(encoding="utf-8")
    name, = re.findall(r'bsdf_measurement\("\./([^"]*)"\)', text)
    values = table(pathlib.Path(path).parent / name)
    f = numpy.array([looked_up(values, light, view) for light, view in zip(lights, views)])
    layer = re.search(r"fresnel_layer\(\s*ior: ([0-9.]+),\s*weight: ([0-9.]+),", text)
    if layer is None:
        return f
    index, weight = (float(x) for x in layer.groups())
    return f * (1 - weight * numpy.maximum(dielectric(lights[:, 2], index), dielectric(views[:, 2], index)))[:, None]
