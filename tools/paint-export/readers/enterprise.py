"""Evaluates the material of a .dspbr.gltf file by the Enterprise PBR Shading Model 2022x, section Core and its appendix, opaque and thin-walled."""

import functools
import json

import numpy

from facets import ggx, reflected

NODES, WEIGHTS = (part / 2 for part in numpy.polynomial.legendre.leggauss(20))
NODES = NODES + 0.5


def schlick(cosine):
    return (1 - numpy.clip(cosine, 0, 1)) ** 5


@functools.lru_cache(None)
def albedo(alpha, cosine):
    """E_m and its part that (1 - c)^5 weights, for one viewer."""
    view = numpy.array((numpy.sqrt(1 - cosine ** 2), 0, cosine))
    return numpy.array((reflected(alpha, view, lambda c: 1), reflected(alpha, view, schlick)))


@functools.lru_cache(None)
def mean(alpha):
    """2 int E(c) c dc of the same."""
    return sum(2 * c * weight * albedo(alpha, c) for c, weight in zip(NODES, WEIGHTS))


def several(f0, f90, alpha):
    """F_ms."""
    average, e = f90 / 21 + 20 * f0 / 21, mean(alpha)[0]
    return average ** 2 * e / (1 - average * (1 - e))


def lost(f0, parts, alpha):
    """1 - E, where the lobe reflects F(f0, 1) and what it loses comes back by several reflections."""
    return 1 - (f0 * (parts[0] - parts[1]) + parts[1] + several(f0, 1, alpha) * (1 - parts[0]))


def value(material, light, view):
    """f for one pair of directions."""
    core, extra = material["pbrMetallicRoughness"], material["extensions"]
    albedo_color, m, alpha = numpy.array(core["baseColorFactor"][:3]), core["metallicFactor"], core["roughnessFactor"] ** 2
    index, s = extra["KHR_materials_ior"]["ior"], extra["KHR_materials_specular"]["specularFactor"]
    tinted = ((index - 1) / (index + 1)) ** 2 * numpy.array(extra["KHR_materials_specular"]["specularColorFactor"])
    cosine = numpy.linalg.norm(light + view) / 2
    f0, f90 = (1 - m) * s * tinted + m * albedo_color, (1 - m) * s + m
    f = ggx(max(alpha, 1e-4), light, view) * (f0 + (f90 - f0) * schlick(cosine))
    at_light, at_view, of_all = albedo(alpha, light[2]), albedo(alpha, view[2]), mean(alpha)
    f = f + (1 - at_light[0]) * (1 - at_view[0]) / (numpy.pi * (1 - of_all[0])) * several(f0, f90, alpha)
    under = lost(tinted.max(), at_light, alpha) * lost(tinted.max(), at_view, alpha) / lost(tinted.max(), of_all, alpha)
    f = f + (1 - m) * albedo_color * (1 - s + s * under) / numpy.pi
    coat = extra.get("KHR_materials_clearcoat")
    if coat is None:
        return f
    fresnel = lambda c: coat["clearcoatFactor"] * (0.04 + 0.96 * schlick(c))
    shine = fresnel(cosine) * ggx(max(coat["clearcoatRoughnessFactor"] ** 2, 1e-4), light, view)
    return f * (1 - max(fresnel(light[2]), fresnel(view[2]))) + shine


def reflection(path, light, view):
    """f of each pair of directions, one a row, in Rec.709."""
    document = json.load(open(path, encoding="utf-8"))
    material = document["materials"][document["meshes"][0]["primitives"][0]["material"]]
    return numpy.array([value(material, *pair) for pair in zip(light, view)])
