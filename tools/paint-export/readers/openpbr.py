"""Evaluates OpenPBR by the graph that MaterialX 1.39 gives for it, without the parts that these files leave at 0."""

import numpy

from facets import dielectric, ggx, reflected


def layer(weight, index, alpha, light, view):
    """(f of a dielectric node, what it lets through to the node below)"""
    all_light, f = reflected(alpha, view, lambda c: 1), dielectric(numpy.linalg.norm(light + view) / 2, index)
    more, f0 = 1 + f * (1 - all_light) / all_light, ((index - 1) / (index + 1)) ** 2
    given = reflected(alpha, view, lambda c: f0 + (1 - f0) * (1 - numpy.clip(c, 0, 1)) ** 5)
    return weight * f * more * ggx(max(alpha, 1e-4), light, view), 1 - weight * more * given


def value(given, light, view):
    """f for one pair of directions; `given` has the inputs of the shader as arrays."""
    number = {name: values[0] for name, values in given.items() if len(values) == 1}
    assert number["base_weight"] == 1 and number["coat_darkening"] == 0
    coat, coat_index, coat_roughness = (number["coat_" + name] for name in ("weight", "ior", "roughness"))
    rough = number["specular_roughness"]
    rough += coat * (min(1, 2 * coat_roughness ** 4 + rough ** 4) ** 0.25 - rough)
    ratio = max(number["specular_ior"] / coat_index, coat_index / number["specular_ior"])
    in_coat = number["specular_ior"] * (1 - coat) + ratio * coat
    root = numpy.sqrt(min(0.99999, number["specular_weight"] * ((in_coat - 1) / (in_coat + 1)) ** 2))
    lobe, through = layer(1, (1 + root) / (1 - root), rough ** 2, light, view)
    base = given["specular_color"] * lobe + through * given["base_color"] / numpy.pi
    c, seventh = numpy.linalg.norm(light + view) / 2, 1 / 7
    normal = given["base_color"]
    at82 = normal + (1 - normal) * (1 - seventh) ** 5
    f = normal + (1 - normal) * (1 - c) ** 5 - at82 * (1 - given["specular_color"]) * c * (1 - c) ** 6 / (seventh * (1 - seventh) ** 6)
    all_light = reflected(rough ** 2, view, lambda c: 1)
    metal = number["specular_weight"] * f * (1 + f * (1 - all_light) / all_light) * ggx(max(rough ** 2, 1e-4), light, view)
    base = base + number["base_metalness"] * (metal - base)
    shine, below = layer(coat, coat_index, coat_roughness ** 2, light, view) if coat > 0 else (0, 1)
    return shine + below * base
