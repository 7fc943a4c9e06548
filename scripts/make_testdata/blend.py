"""Smooth transitions between numbers and between colors."""


def smooth_step(low, high, x):
    """0 up to `low`, 1 from `high` on, and a smooth cubic between them."""
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)


def mix(a, b, t):
    """The color that is a at t = 0 and b at t = 1."""
    return tuple(p + (q - p) * t for p, q in zip(a, b))
