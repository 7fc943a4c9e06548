"""Panels that are cut from a smooth surface.

Their mesh is dense where the surface bends, ends a little before the cut and has a rolled edge there. Lengths are meters.
"""

import bisect
import math

from make_testdata.vectors import along, angle, between, cross, dot, unit

GAP = 0.004  # the distance of neighboring panels
ROLL_RADIUS = 0.0025
ROLL_ANGLES = (math.radians(45), math.radians(90))
FLANGE_DEPTH = 0.008  # how far a rolled edge reaches in behind the surface, unless a caller asks for another depth
SHORTEST_STEP = 0.009  # No edge of the mesh is shorter, however tight the bend is.
PROBES = 256  # the samples of a line by which its bends are measured


class Part:
    """A triangle mesh with a name and with a normal for each vertex."""

    def __init__(self, name):
        self.name = name
        self.points, self.normals, self.triangles = [], [], []

    def add(self, point, normal):
        """Adds a vertex and returns its index."""
        self.points.append(tuple(point))
        self.normals.append(tuple(normal))
        return len(self.points) - 1

    def add_strip(self, upper, lower):
        """Adds triangles between two rows of equally many vertices. Seen from outside, the lower row is on the right."""
        for a, b, c, d in zip(upper, upper[1:], lower, lower[1:]):
            self.triangles += [(a, c, b), (b, c, d)]

    def append(self, other):
        """Adds the vertices and triangles of another part."""
        offset = len(self.points)
        self.points += other.points
        self.normals += other.normals
        self.triangles += [tuple(i + offset for i in triangle) for triangle in other.triangles]

    def mirrored(self, name):
        """The part on the other side of the plane x = 0."""
        other = Part(name)
        other.points = [(-x, y, z) for x, y, z in self.points]
        other.normals = [(-x, y, z) for x, y, z in self.normals]
        other.triangles = [(a, c, b) for a, b, c in self.triangles]
        return other


def spread(lines, mesh_size, symmetric=False):
    """Parameters from 0 to 1 that are dense where any of the `lines` is long or bends.

    A line maps a parameter to (point, normal). `mesh_size` is (step, turn): an edge of the mesh is at most about `step` meters
    long and turns by at most about `turn` degrees.
    """
    step, turn = mesh_size[0], math.radians(mesh_size[1])
    share = [0.0] * PROBES
    for line in lines:
        samples = [line(i / PROBES) for i in range(PROBES + 1)]
        chords = [between(p, q) for (p, _), (q, _) in zip(samples, samples[1:])]
        for i, ((_, n), (_, m)) in enumerate(zip(samples, samples[1:])):
            length = math.sqrt(dot(chords[i], chords[i]))
            bend = max(angle(n, m), angle(chords[max(i - 1, 0)], chords[i]))
            share[i] = max(share[i], math.hypot(length / step, min(bend / turn, length / SHORTEST_STEP)))
    if symmetric:
        share = [max(a, b) for a, b in zip(share, reversed(share))]
    total = [0.0]
    for amount in share:
        total.append(total[-1] + amount)
    count = max(2, math.ceil(total[-1]))
    result = []
    for k in range(count + 1):
        target = total[-1] * k / count
        i = min(bisect.bisect_right(total, target) - 1, PROBES - 1)
        result.append((i + (target - total[i]) / share[i]) / PROBES)
    return result


def insets(surface, t, edge, inset):
    """How far, in s, the border s = `edge` (0 or 1) is drawn back at t so that it ends `inset` meters before the cut."""
    h = 1e-4
    inside = h if edge == 0 else 1 - h
    here = surface(edge, t)[0]
    toward_inside = between(here, surface(inside, t)[0])
    t0, t1 = max(0, t - h), min(1, t + h)
    along_cut = unit(between(surface(edge, t0)[0], surface(edge, t1)[0]))
    return inset * h / math.hypot(*cross(toward_inside, along_cut))


def drawn_in(s, low, high):
    """s, moved inward by `low` at 0 and by `high` at 1, and hardly moved far from both."""
    return s + low * (1 - s) ** 3 - high * s ** 3


def add_grid(part, surface, inset, mesh_size, symmetric=False):
    """Adds the mesh of a `surface` to a part and returns the indices of its vertices: rows[i][j] is at the i-th s and j-th t.

    The surface maps s and t, both from 0 to 1, to (point, normal). `inset` has the distances at which the borders end before the
    cut: at s = 0, at s = 1, and at both ends of t.
    """
    lines = (0, 0.25, 0.5, 0.75, 1)
    s_values = spread([lambda s, t=t: surface(s, t) for t in lines], mesh_size, symmetric)
    t_values = spread([lambda t, s=s: surface(s, t) for s in lines], mesh_size)

    def turned(t, s):
        return surface(s, t)

    s_insets = [(insets(surface, t, 0, inset[0]), insets(surface, t, 1, inset[1])) for t in t_values]
    t_insets = [(insets(turned, s, 0, inset[2]), insets(turned, s, 1, inset[2])) for s in s_values]
    rows = []
    for s, (t_low, t_high) in zip(s_values, t_insets):
        row = []
        for t, (s_low, s_high) in zip(t_values, s_insets):
            row.append(part.add(*surface(drawn_in(s, s_low, s_high), drawn_in(t, t_low, t_high))))
        rows.append(row)
    for near, far in zip(rows, rows[1:]):
        part.add_strip(far, near)
    return rows


def add_rolled_edge(part, loop, deeper=None):
    """Rolls a closed border inward and returns its innermost row: (point, normal of the surface above) for each vertex.

    The border `loop` has the indices of its vertices, counterclockwise if seen from outside. `deeper` maps some of them to a
    depth of their own.
    """
    outward, stretch = [], []
    for before, here, after in zip(loop[-1:] + loop[:-1], loop, loop[1:] + loop[:1]):
        normal = part.normals[here]
        first, second = (unit(cross(unit(between(part.points[a], part.points[b])), normal))
                         for a, b in ((before, here), (here, after)))
        outward.append(unit(tuple(a + b for a, b in zip(first, second))))
        stretch.append(1 / max(0.5, dot(outward[-1], first)))  # Corners are mitered.
    profile = [(ROLL_RADIUS * math.sin(a), ROLL_RADIUS * (1 - math.cos(a)), a) for a in ROLL_ANGLES]
    profile.append((ROLL_RADIUS, None, ROLL_ANGLES[-1]))
    upper = loop + loop[:1]
    for reach, depth, turn in profile:
        lower = []
        for index, out, wider in zip(loop, outward, stretch):
            normal = part.normals[index]
            inward = (deeper or {}).get(index, FLANGE_DEPTH) if depth is None else depth
            point = along(along(part.points[index], out, reach * wider), normal, -inward)
            lower.append(part.add(point, along(tuple(math.cos(turn) * c for c in normal), out, math.sin(turn))))
        part.add_strip(upper, lower + lower[:1])
        upper = lower + lower[:1]
    return [(part.points[bottom], part.normals[top]) for bottom, top in zip(upper, loop)]


def add_seam(part, left, right):
    """Closes the gap between two borders, which are lists of (point, normal) that run the same way, `left` on the left."""
    left_indices = [part.add(*vertex) for vertex in left]
    right_indices = [part.add(*vertex) for vertex in right]
    i = j = 0
    while i + 1 < len(left) or j + 1 < len(right):
        step_left = math.dist(left[i + 1][0], right[j][0]) if i + 1 < len(left) else math.inf
        step_right = math.dist(left[i][0], right[j + 1][0]) if j + 1 < len(right) else math.inf
        if step_left < step_right:
            part.triangles.append((left_indices[i], right_indices[j], left_indices[i + 1]))
            i += 1
        else:
            part.triangles.append((left_indices[i], right_indices[j], right_indices[j + 1]))
            j += 1
