"""Evaluates the UsdPreviewSurface of a .usda file as the reference viewer hdStorm lights it, or its OpenPBR."""

import re

import numpy

import openpbr


def facets(roughness, light, view):
    """GGX over 4 cos cos, masked after Schlick; alpha is the square of the roughness."""
    alpha = max(roughness, 0.001) ** 2
    half = (light + view) / numpy.linalg.norm(light + view, axis=1, keepdims=True)
    d = alpha ** 2 / (numpy.pi * (half[:, 2] ** 2 * (alpha ** 2 - 1) + 1) ** 2)
    hidden = [c / (c * (1 - alpha / 2) + alpha / 2) for c in (light[:, 2], view[:, 2])]
    return d * hidden[0] * hidden[1] / (4 * light[:, 2] * view[:, 2])


def reflection(path, light, view):
    """f of each pair of directions, one a row, in Rec.709."""
    text = open(path, encoding="utf-8").read()
    given = {name: numpy.array([float(x) for x in value.strip("()").split(",")])
             for name, value in re.findall(r"inputs:(\w+) = (\([^)]*\)|[-\d.e]+)\n", text)}
    if 'info:id = "ND_open_pbr_surface_surfaceshader"' in text:
        return numpy.array([openpbr.value(given, *pair) for pair in zip(light, view)])
    assert given["useSpecularWorkflow"][0] == 1
    grazing = (1 - numpy.linalg.norm(light + view, axis=1) / 2)[:, None] ** 5
    fresnel = given["specularColor"] + (1 - given["specularColor"]) * grazing
    normal = ((given["ior"][0] - 1) / (given["ior"][0] + 1)) ** 2
    coat = given["clearcoat"][0] * (normal + (1 - normal) * grazing) * facets(given["clearcoatRoughness"][0], light, view)[:, None]
    return (1 - fresnel) * given["diffuseColor"] / numpy.pi + fresnel * facets(given["roughness"][0], light, view)[:, None] + coat
