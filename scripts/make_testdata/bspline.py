"""A uniform bicubic B-spline surface over a net of control rings, closed at both ends by a pole.

A ring is a closed loop of control points around the body; the rings follow one another from the rear pole to the front
pole. Beyond a pole the net continues with the rings before it, turned by half a loop, so that curves cross the pole without
a kink. The surface is C2 everywhere except at the poles, where its tangent plane is continuous.
"""


def blending(t):
    """The four weights of a uniform cubic B-spline at t from 0 to 1, and their derivatives."""
    s = 1 - t
    weights = (s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
               (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6)
    slopes = (-s * s / 2, (3 * t * t - 4 * t) / 2, (4 * s - 3 * s * s) / 2, t * t / 2)
    return weights, slopes


class ClosedSurface:
    """The surface over `rings`, which are lists of (x, y, z) of one even length; the first and the last are poles."""

    def __init__(self, rings):
        self.around = len(rings[0])
        self.along = len(rings) - 1
        half = self.around // 2
        # Each end gets one more ring, which lies beyond the pole.
        self.net = [rings[1][half:] + rings[1][:half], *rings, rings[-2][half:] + rings[-2][:half]]

    def point_and_tangents(self, u, v):
        """(point, dP/du, dP/dv) at u, which has the period `around`, and at v from 0 to `along`."""
        column, row = int(u // 1), min(int(v), self.along - 1)
        weights_u, slopes_u = blending(u - column)
        weights_v, slopes_v = blending(v - row)
        columns = [(column + k - 1) % self.around for k in range(4)]
        point, along_u, along_v = [0.0] * 3, [0.0] * 3, [0.0] * 3
        for j in range(4):
            a, b, c, d = (self.net[row + j][i] for i in columns)
            for axis in range(3):
                p = weights_u[0] * a[axis] + weights_u[1] * b[axis] + weights_u[2] * c[axis] + weights_u[3] * d[axis]
                q = slopes_u[0] * a[axis] + slopes_u[1] * b[axis] + slopes_u[2] * c[axis] + slopes_u[3] * d[axis]
                point[axis] += weights_v[j] * p
                along_u[axis] += weights_v[j] * q
                along_v[axis] += slopes_v[j] * p
        return point, along_u, along_v
