"""Evaluates the material of a .gltf file, after Appendix B of glTF 2.0 and its extensions specular, ior and clearcoat."""

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
    diffuse = (1 - fresnel.max(1, keepdims=True)) * numpy.array(core["baseColorFactor"][:3]) / numpy.pi
    base = diffuse + fresnel * facets(core["roughnessFactor"], light, view)[:, None]
    coat = extra.get("KHR_materials_clearcoat")
    if coat is None:
        return base
    share = coat["clearcoatFactor"] * (0.04 + 0.96 * (1 - view[:, 2]) ** 5)
    shine = share * facets(coat["clearcoatRoughnessFactor"], light, view)
    return (1 - share)[:, None] * base + shine[:, None]
