"""Microfacets of GGX and the dielectric, as arrays of numpy."""

import numpy


def ggx(alpha, light, view):
    """D G / (4 cos_i cos_o) with the height-correlated G of Smith; the last axis has the vector."""
    half = light + view
    half = half / numpy.linalg.norm(half, axis=-1, keepdims=True)
    d = alpha ** 2 / (numpy.pi * ((alpha ** 2 - 1) * half[..., 2] ** 2 + 1) ** 2)
    a, b = (numpy.sqrt(1 + alpha ** 2 * (1 / c ** 2 - 1)) for c in (light[..., 2], view[..., 2]))
    return d * 2 / (a + b) / (4 * light[..., 2] * view[..., 2])


def reflected(alpha, view, fresnel):
    """The share of even light that goes to the viewer, by a sum over half vectors with the density D cos."""
    u, turn = numpy.meshgrid((numpy.arange(400) + 0.5) / 400, (numpy.arange(90) + 0.5) / 45 * numpy.pi)
    tangent = alpha * numpy.sqrt(u / (1 - u))
    z = 1 / numpy.sqrt(1 + tangent ** 2)
    half = numpy.stack([z * tangent * numpy.cos(turn), z * tangent * numpy.sin(turn), z], -1)
    along = half @ view
    light = 2 * along * z - view[2]
    masking = 2 / sum(numpy.sqrt(1 + alpha ** 2 * (1 / c ** 2 - 1)) for c in (light, view[2]))
    return (((along > 0) & (light > 0)) * fresnel(along) * masking * along / (z * view[2])).mean()


def dielectric(c, index):
    """Fresnel's reflectance for unpolarized light."""
    inside = numpy.sqrt(1 - (1 - c ** 2) / index ** 2)
    return sum(((a * c - b * inside) / (a * c + b * inside)) ** 2 for a, b in ((1, index), (index, 1))) / 2
