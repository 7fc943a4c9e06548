"""Microfacets of GGX and the dielectric, as arrays of numpy."""

import functools

import numpy


def ggx(alpha, light, view, beside=None):
    """D G / (4 cos_i cos_o) with the height-correlated G of Smith; the last axis has the vector.

    With `beside`, alpha is the roughness along the viewer's plane, that the other one beside it, and G has their geometric mean.
    """
    if alpha == 0:  # a mirror reflects into one direction alone
        return numpy.zeros(numpy.broadcast(light, view).shape[:-1])
    half = light + view
    half = half / numpy.linalg.norm(half, axis=-1, keepdims=True)
    beside = alpha if beside is None else beside
    plane = numpy.hypot(view[..., 0], view[..., 1])
    x, y = (numpy.where(plane > 0, view[..., k] / numpy.maximum(plane, 1e-30), 1 - k) for k in (0, 1))
    along, across = half[..., 0] * x + half[..., 1] * y, half[..., 1] * x - half[..., 0] * y
    d = 1 / (numpy.pi * alpha * beside * ((along / alpha) ** 2 + (across / beside) ** 2 + half[..., 2] ** 2) ** 2)
    a, b = (numpy.sqrt(1 + alpha * beside * (1 / c ** 2 - 1)) for c in (light[..., 2], view[..., 2]))
    return d * 2 / (a + b) / (4 * light[..., 2] * view[..., 2])


@functools.lru_cache(4)
def half_vectors(alpha):
    """Half vectors with the density D cos, and their cosines."""
    u, turn = numpy.meshgrid((numpy.arange(400) + 0.5) / 400, (numpy.arange(90) + 0.5) / 45 * numpy.pi)
    tangent = alpha * numpy.sqrt(u / (1 - u))
    z = 1 / numpy.sqrt(1 + tangent ** 2)
    return numpy.stack([z * tangent * numpy.cos(turn), z * tangent * numpy.sin(turn), z], -1), z


@functools.lru_cache(4)
def shares(alpha, view):
    """The cosine of the viewer to each of these half vectors, and the share of even light by it from a mirror there."""
    half, z = half_vectors(alpha)
    along = half @ view
    light = 2 * along * z - view[2]
    masking = 2 / sum(numpy.sqrt(1 + alpha ** 2 * (1 / c ** 2 - 1)) for c in (light, view[2]))
    return along, ((along > 0) & (light > 0)) * masking * along / (z * view[2])


def reflected(alpha, view, fresnel):
    """The share of even light that goes to the viewer, by a sum over half vectors with the density D cos."""
    along, share = shares(float(alpha), tuple(view))
    return (share * fresnel(along)).mean()


def dielectric(c, index):
    """Fresnel's reflectance for unpolarized light."""
    inside = numpy.sqrt(1 - (1 - c ** 2) / index ** 2)
    return sum(((a * c - b * inside) / (a * c + b * inside)) ** 2 for a, b in ((1, index), (index, 1))) / 2
