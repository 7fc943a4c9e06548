"""Evaluates the material of a .gltf file, after Appendix B of glTF 2.0 and its extensions specular, ior, clearcoat and iridescence."""

import json

import numpy


def facets(roughness, light, view):
    """V D of the specification: GGX with alpha the square of the roughness."""
    alpha = max(roughness ** 2, 1e-4)
    half = (light + view) / numpy.linalg.norm(light + view, axis=1, keepdims=True)
    d = alpha ** 2 / (numpy.pi * ((alpha ** 2 - 1) * half[:, 2] ** 2 + 1) ** 2)
    l, v = light[:, 2], view[:, 2]
    root = lambda c: numpy.sqrt(alpha ** 2 + (1 - alpha ** 2) * c ** 2)
    return d * 0.5 / (l * root(v) + v * root(l))


def schlick(normal, cosine):
    return normal + (1 - normal) * (1 - cosine) ** 5


def film(index, thickness, base, cosine):
    """iridescent_fresnel() of KHR_materials_iridescence, in air; one row for each cosine."""
    cosine = cosine[:, None]
    inside = numpy.sqrt(1 - (1 - cosine ** 2) / index ** 2)
    outer = schlick(((index - 1) / (index + 1)) ** 2, cosine)
    root = numpy.sqrt(base + 0.0001)
    under = (1 + root) / (1 - root)
    inner = schlick(((under - index) / (under + index)) ** 2, inside)
    phase = numpy.pi * (index >= 1) + numpy.pi * (under < index)
    both = numpy.clip(outer * inner, 1e-5, 0.9999)
    through = (1 - outer) ** 2 * inner / (1 - both)
    total, factor = outer + through, through - (1 - outer)
    value, place, width = numpy.array(((5.4856e-13, 4.4201e-13, 5.2481e-13), (1.6810e6, 1.7953e6, 2.2084e6), (4.3278e9, 9.3046e9, 6.6121e9)))
    for order in (1, 2):
        turn = 2 * numpy.pi * order * 2 * index * thickness * inside * 1e-9
        xyz = value * numpy.sqrt(2 * numpy.pi * width) * numpy.cos(place * turn + order * phase) * numpy.exp(-turn ** 2 * width)
        xyz[:, :1] += 9.7470e-14 * numpy.sqrt(2 * numpy.pi * 4.5282e9) * numpy.cos(2.2399e6 * turn + order * phase[0]) * numpy.exp(-4.5282e9 * turn ** 2)
        factor = factor * numpy.sqrt(both)
        rgb = xyz / 1.0685e-7 @ numpy.array(((3.2404542, -0.9692660, 0.0556434), (-1.5371385, 1.8760108, -0.2040259), (-0.4985314, 0.0415560, 1.0572252)))
        total = total + 2 * factor * rgb
    return numpy.maximum(total, 0)


def reflection(path, light, view):
    """f of each pair of directions, one a row, in Rec.709."""
    document = json.load(open(path, encoding="utf-8"))
    material = document["materials"][document["meshes"][0]["primitives"][0]["material"]]
    core, extra = material["pbrMetallicRoughness"], material["extensions"]
    assert core["metallicFactor"] == 0 and extra["KHR_materials_ior"]["ior"] == 0
    specular = extra["KHR_materials_specular"]
    strength = specular["specularFactor"]
    normal = numpy.minimum(specular["specularColorFactor"], 1) * strength  # an index of 0 stands for a reflectance of 1
    grazing = (1 - numpy.linalg.norm(light + view, axis=1) / 2)[:, None] ** 5
    fresnel = normal + (strength - normal) * grazing
    thin = extra.get("KHR_materials_iridescence")
    if thin is not None:
        seen = film(thin["iridescenceIor"], thin["iridescenceThicknessMaximum"], normal, numpy.linalg.norm(light + view, axis=1) / 2)
        fresnel = fresnel + thin["iridescenceFactor"] * (seen - fresnel)
    diffuse = (1 - fresnel.max(1, keepdims=True)) * numpy.array(core["baseColorFactor"][:3]) / numpy.pi
    base = diffuse + fresnel * facets(core["roughnessFactor"], light, view)[:, None]
    coat = extra.get("KHR_materials_clearcoat")
    if coat is None:
        return base
    share = coat["clearcoatFactor"] * (0.04 + 0.96 * (1 - view[:, 2]) ** 5)
    shine = share * facets(coat["clearcoatRoughnessFactor"], light, view)
    return (1 - share)[:, None] * base + shine[:, None]
