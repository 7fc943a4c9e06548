"""Smooth transitions, of numbers and of colors."""


def smooth_step(low, high, x):
    """0 up to `low`, 1 from `high`, a smooth cubic between."""
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)


def mix(a, b, t):
    """The color a at t = 0, b at t = 1."""
    return tuple(p + (q - p) * t for p, q in zip(a, b))
