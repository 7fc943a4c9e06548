"""Evaluates the graph of BSDF nodes in a .mtlx file, after the specification of MaterialX's physically based nodes."""

import xml.etree.ElementTree

import numpy

import openpbr
from facets import dielectric, ggx, reflected

# From ACEScg, whose white is that of ACES, by the matrices of S-2014-004, of Bradford and of Rec.709.
REC709_FROM_ACESCG = numpy.array(((1.705052, -0.621792, -0.083259), (-0.130256, 1.140805, -0.010548), (-0.024003, -0.128969, 1.152972)))

# Nodes of numbers, vectors and colors.
OPERATIONS = {
    "add": lambda a, b: a + b, "subtract": lambda a, b: a - b, "multiply": lambda a, b: a * b, "divide": lambda a, b: a / b,
    "max": numpy.maximum, "min": numpy.minimum, "dotproduct": lambda a, b: (a * b).sum(keepdims=True),
    "combine2": lambda a, b: numpy.concatenate([a, b])}


def computed(nodes, given, view):
    """The numbers of an input, which it has itself or from other nodes."""
    if given.get("value") is not None:
        return numpy.array([float(x) for x in given.get("value").split(",")])
    node = nodes[given.get("nodename")]
    if node.tag == "viewdirection":  # from the viewer
        return -view
    if node.tag == "normal":
        return numpy.array((0.0, 0, 1))
    inputs = {entry.get("name"): entry for entry in node}
    if node.tag == "absval":
        return abs(computed(nodes, inputs["in"], view))
    return OPERATIONS[node.tag](computed(nodes, inputs["in1"], view), computed(nodes, inputs["in2"], view))


def evaluated(nodes, name, light, view):
    """(f of a node in RGB, what it lets through to the node below)"""
    node = nodes[name]
    inputs = {given.get("name"): given for given in node}
    def numbers(key, default):
        return computed(nodes, inputs[key], view) if key in inputs else numpy.array([default])
    def below(key):
        return evaluated(nodes, inputs[key].get("nodename"), light, view)
    if node.tag == "standard_surface":  # as MaterialX defines it, without the parts that these files leave at 0
        def layer(weight, index, roughness):
            alpha = max(roughness[0] ** 2, 1e-4)
            all_light, f = reflected(alpha, view, lambda c: 1), dielectric(numpy.linalg.norm(light + view) / 2, index[0])
            more, f0 = 1 + f * (1 - all_light) / all_light, ((index[0] - 1) / (index[0] + 1)) ** 2
            given = reflected(alpha, view, lambda c: f0 + (1 - f0) * (1 - numpy.clip(c, 0, 1)) ** 5)
            return weight * f * more * ggx(alpha, light, view), 1 - weight * more * given
        lobe, through = layer(1, numbers("specular_IOR", 1.5), numbers("specular_roughness", 0.2))
        coat, below_coat = layer(numbers("coat", 0), numbers("coat_IOR", 1.5), numbers("coat_roughness", 0.1))
        return coat + below_coat * (numbers("specular_color", 1) * lobe + through * numbers("base_color", 0.8) / numpy.pi), 0
    if node.tag == "open_pbr_surface":
        return openpbr.value({key: numbers(key, 0) for key in inputs}, light, view), 0
    if node.tag == "add":
        return below("in1")[0] + below("in2")[0], 0
    if node.tag == "multiply":
        return below("in1")[0] * numpy.clip(numbers("in2", 1), 0, 1), 0
    if node.tag == "layer":
        top, through = below("top")
        return top + through * below("base")[0], 0
    if node.tag in ("oren_nayar_diffuse_bsdf", "burley_diffuse_bsdf"):
        assert numbers("roughness", 0) == 0  # where Burley's F_90 is 1/2
        falls = [1 - (1 - c) ** 5 / 2 if node.tag.startswith("burley") else 1 for c in (light[2], view[2])]
        return numbers("color", 0.18) * falls[0] * falls[1] / numpy.pi, 0
    alpha, beside = numpy.resize(numbers("roughness", 0.05), 2)
    if alpha != beside:  # then the tangent has to be the view direction
        assert numpy.linalg.norm(numpy.cross(numbers("tangent", 0), view)) < 0.003
    mean, weight, index = (alpha * beside) ** 0.5, numbers("weight", 1)[0], numbers("ior", 1.5)[0]
    def schlick(f0, f90, power):
        return lambda c: f0 + (f90 - f0) * (1 - numpy.clip(c, 0, 1)) ** power
    fresnel = average = schlick(numbers("color0", 1)[0], numbers("color90", 1)[0], numbers("exponent", 5)[0])
    if node.tag == "dielectric_bsdf":
        fresnel, average = lambda c: dielectric(c, index), schlick(((index - 1) / (index + 1)) ** 2, 1, 5)
    f, all_light = fresnel(numpy.linalg.norm(light + view) / 2), reflected(mean, view, lambda c: 1)
    more = 1 + f * (1 - all_light) / all_light
    return weight * f * more * ggx(alpha, light, view, beside) * numpy.ones(3), 1 - weight * more * reflected(mean, view, average)


def reflection(path, lights, views):
    """f of each pair of directions, one a row, in Rec.709."""
    root = xml.etree.ElementTree.parse(path).getroot()
    nodes = {node.get("name"): node for node in root}
    surface = next(node for node in nodes.values() if node.tag in ("surface", "standard_surface", "open_pbr_surface"))
    surface = surface.get("name") if surface.tag != "surface" else surface.find("input").get("nodename")
    f = numpy.array([evaluated(nodes, surface, light, view)[0] for light, view in zip(lights, views)])
    return f @ {"lin_rec709": numpy.eye(3), "acescg": REC709_FROM_ACESCG}[root.get("colorspace")].T
