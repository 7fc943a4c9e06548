"""Vectors in space, as tuples of three numbers."""

import math


def cross(a, b):
    """The vector product."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    """The scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def along(point, direction, distance):
    """point + distance * direction."""
    return tuple(p + distance * d for p, d in zip(point, direction))


def between(a, b):
    """b - a."""
    return tuple(q - p for p, q in zip(a, b))


def unit(a):
    """a with length 1."""
    length = math.sqrt(dot(a, a))
    return tuple(c / length for c in a)


def angle(a, b):
    """The angle between a and b in radians."""
    return math.atan2(math.hypot(*cross(a, b)), dot(a, b))
