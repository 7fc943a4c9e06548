"""speed-shape.obj: the body of the speed shape, cut into panels, with a front bumper that is turned 8 degrees out of flush."""

import functools
import math

from make_testdata import patch
from make_testdata.patch import Part, add_grid, add_rolled_edge, add_seam, insets, spread
from make_testdata.speed_shape import body
from make_testdata.vectors import along, between, cross, dot, unit
from make_testdata.wheels import open_wells, wheels

BODY = body()
AROUND, FRONT_POLE = BODY.around, BODY.along
POLE_MARGIN = 1e-4  # At the pole itself the tangents vanish.

ROOF_EDGE, BELT, SILL = 4.6, 8.0, 15.4  # u of the cuts that run lengthwise; the cut along the sill only lies near its u.
SILL_HEIGHT = 0.21
AXLES, ARCH_RADIUS, ARCH_CENTER = (1.36, -1.45), 0.385, 0.255
ARCH_STEEPEST = math.radians(80)
SILL_ROUNDING = 0.06
RECESS, LINER_EDGE = 0.018, 12.1  # The underbody lies so many meters behind the surface, and it reaches up to this u.
INSET = patch.GAP / 2 + patch.ROLL_RADIUS
PAINTED, HIDDEN = (0.085, 8.5), (0.12, 14)  # mesh sizes in meters and degrees

MISALIGNMENT_DEG = 8.0  # the turn of Bumper_F about the axis that is parallel to x and goes through the top of its seam


def on_body(u, v):
    """(point, unit normal) of the body at u and v."""
    v = min(max(v, POLE_MARGIN), FRONT_POLE - POLE_MARGIN)
    point, along_u, along_v = BODY.point_and_tangents(u % AROUND, v)
    return tuple(point), unit(cross(along_v, along_u))


def solved(function, low, high):
    """The argument between low and high at which the rising `function` passes 0."""
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (low, middle) if function(middle) > 0 else (middle, high)
    return (low + high) / 2


def v_at(z):
    """The v at which the body's middle line passes z."""
    return solved(lambda v: BODY.point_and_tangents(0.0, v)[0][2] - z, 2.0, FRONT_POLE - 1.0)


def lower_cut_height(z):
    """The height of the cut along the sills, which has an arch over each axle."""
    base = SILL_HEIGHT + 1.1 * max(0.0, -1.75 - z) ** 2 + 0.5 * max(0.0, z - 1.5) ** 2
    foot = ARCH_RADIUS * math.sin(ARCH_STEEPEST)
    for axle in AXLES:
        beyond = max(0.0, abs(z - axle) - foot)
        reach = min(abs(z - axle), foot)
        arch = ARCH_CENTER + math.sqrt(ARCH_RADIUS ** 2 - reach ** 2) - beyond * math.tan(ARCH_STEEPEST)
        base = (arch + base + math.hypot(arch - base, SILL_ROUNDING)) / 2
    return base


class LowerCut:
    """The u of the cut along the sills at any v between the ends, from a fine table."""

    COUNT = 1600

    def __init__(self):
        self.first = v_at(-2.1)
        self.step = (v_at(2.1) - self.first) / self.COUNT
        self.table = [self.solved_at(self.first + i * self.step) for i in range(self.COUNT + 1)]

    @staticmethod
    def solved_at(v):
        """The u at which the section at v comes down to the height of the cut."""
        def below_cut(u):
            _, y, z = BODY.point_and_tangents(u, v)[0]
            return lower_cut_height(z) - y
        return solved(below_cut, 11.5, 16.5)

    def __call__(self, v):
        place = (v - self.first) / self.step
        i = min(max(int(place), 0), self.COUNT - 1)
        return self.table[i] + (self.table[i + 1] - self.table[i]) * (place - i)


LOWER_CUT = LowerCut()


def mix(a, b, t):
    """a at t = 0, b at t = 1."""
    return a + (b - a) * t


def crosswise_cut(z_middle, z_side):
    """The v of a bowed cut over the top, as a function of u: it passes z_middle on the middle line and z_side at the belt."""
    middle, side = v_at(z_middle), v_at(z_side)
    return lambda u: mix(middle, side, (u / BELT) ** 2)


FRONT, REAR = v_at(2.06), v_at(-2.02)
LINER_FRONT, LINER_REAR = v_at(2.035), v_at(-1.995)
COWL, DECK = crosswise_cut(0.98, 0.60), crosswise_cut(-1.66, -1.40)
ROOF_FRONT, ROOF_REAR = crosswise_cut(0.28, 0.02), crosswise_cut(-0.86, -0.70)
DOOR_FRONT, DOOR_REAR = (v_at(0.80), v_at(0.76)), (v_at(-0.66), v_at(-0.78))  # v at the belt and at the sill


def top_patch(left, right, rear, front):
    """The surface from u = left to right and from the cut `rear` to the cut `front`."""
    def surface(s, t):
        u = mix(left, right, s)
        return on_body(u, mix(rear(u), front(u), t))
    return surface


def side_patch(rear, front):
    """The surface from the belt to the lower cut, between two cuts that are given by their v at the belt and at the sill."""
    def surface(s, t):
        v = mix(mix(*rear, s), mix(*front, s), t)
        # The arches bend the lines of the mesh strongly near the cut and hardly at the shoulder.
        return on_body(mix(BELT, SILL, s) + (LOWER_CUT(v) - SILL) * s ** 2, v)
    return surface


def underbody_patch(s, t):
    """The surface below the waist. It is set in, so that it closes the arches and lies behind the sides."""
    point, normal = on_body(mix(LINER_EDGE, AROUND - LINER_EDGE, s), mix(LINER_REAR, LINER_FRONT, t))
    return along(point, normal, -RECESS), normal


def cut_panel(part, surface, symmetric=False, open_high=False):
    """Adds the mesh of a panel with four sides and rolled edges to a part, and returns the innermost rows along its borders.

    Each row is a list of (point, normal). `low` and `high` are the borders in s, which run along t; `rear` and `front` are those
    in t, which run along s. With `open_high`, the border at the high s has no neighbor across a gap and reaches in to the
    underbody.
    """
    rows = add_grid(part, surface, (INSET, 0.0 if open_high else INSET, INSET), PAINTED, symmetric)
    low, high = rows[0], rows[-1]
    rear, front = [row[0] for row in rows], [row[-1] for row in rows]
    deeper = dict.fromkeys(high, RECESS - 0.001) if open_high else {}
    inner = add_rolled_edge(part, low[:-1] + front[:-1] + high[:0:-1] + rear[:0:-1], deeper)
    corners = [0, len(low) - 1, len(low) + len(rear) - 2, 2 * len(low) + len(rear) - 3, len(inner)]
    low, front, high, rear = ((inner + inner[:1])[a:b + 1] for a, b in zip(corners, corners[1:]))
    return {"low": low, "front": front, "high": high[::-1], "rear": rear[::-1]}


def set_in_underbody(part):
    """Adds the mesh of the underbody to a part; returns its rows of (point, normal) at `rear` and `front`, below the lower cut."""
    rows = add_grid(part, underbody_patch, (0.0, 0.0, 0.0), HIDDEN, symmetric=True)

    def below_the_cut(indices):
        vertices = [(part.points[i], part.normals[i]) for i in indices]
        return [(point, normal) for point, normal in vertices if point[1] < lower_cut_height(point[2])]

    return {"rear": below_the_cut(row[0] for row in rows), "front": below_the_cut(row[-1] for row in rows)}


def other_side(edge):
    """An edge that is mirrored to the other side and runs in the same sense across the car."""
    return [((-x, y, z), (-a, b, c)) for (x, y, z), (a, b, c) in reversed(edge)]


def across(side, middle):
    """An edge from the right side over the middle to the left side."""
    return other_side(side) + middle + side


def cut_cap(part, cap, pole_is_front):
    """Adds the mesh of an end with a rolled edge to a part, and returns the innermost row of the edge: (turn, (point, normal)).

    `cap` maps w, which is 0 at the cut and 1 at the pole, and the turn s from 0 to 1 to (point, normal).
    """
    turns = spread([lambda s, w=w: cap(w, s) for w in (0.02, 0.3, 0.6)], PAINTED, symmetric=True)[:-1]
    depths = spread([lambda w, s=s: cap(w, s) for s in (0.0, 0.125, 0.25, 0.375, 0.5)], PAINTED)
    drawn_back = [insets(cap, s, 0, INSET) for s in turns]
    rings = [[part.add(*cap(mix(back, 1.0, w), s)) for s, back in zip(turns, drawn_back)] for w in depths[:-1]]
    pole = part.add(*cap(1.0, 0.0))
    rings.append([pole] * len(turns))
    for near, far in zip(rings, rings[1:]):
        near, far = near + near[:1], far + far[:1]
        part.add_strip(*((near, far) if pole_is_front else (far, near)))
    part.triangles = [t for t in part.triangles if len(set(t)) == 3]
    border = rings[0]
    if pole_is_front:
        inner = add_rolled_edge(part, border[::-1])[::-1]
    else:
        inner = add_rolled_edge(part, border)
    return list(zip(turns, inner))


def tail_cap(w, s):
    """The surface behind the rear cut."""
    return on_body(AROUND * s, mix(REAR, 0.0, w))


class TurnedNose:
    """The surface before the front cut, turned as one piece about the top of the seam, with its lower edge drawn in.

    It is cut anew where it meets the old seam, so that the gap keeps its width and only the normals show the misalignment.
    """

    def __init__(self):
        self.pivot = on_body(0.0, FRONT)[0]
        angle = math.radians(MISALIGNMENT_DEG)
        self.cosine, self.sine = math.cos(angle), math.sin(angle)

    def turned(self, vector, sense=1):
        """A direction turned with the bumper, or turned back if `sense` is -1."""
        x, y, z = vector
        return (x, self.cosine * y - sense * self.sine * z, sense * self.sine * y + self.cosine * z)

    def moved(self, point, sense=1):
        """A point moved with the bumper, or moved back if `sense` is -1."""
        return along(self.pivot, self.turned(between(self.pivot, point), sense), 1)

    @functools.lru_cache(maxsize=None)
    def new_cut(self, s):
        """(u, v) of that point of the body which the turn brings nearest to the point of the seam at s."""
        u, v = AROUND * s, FRONT
        goal = self.moved(on_body(u, v)[0], -1)
        for _ in range(12):
            point, along_u, along_v = BODY.point_and_tangents(u % AROUND, v)
            off = between(point, goal)
            uu, uv, vv = dot(along_u, along_u), dot(along_u, along_v), dot(along_v, along_v)
            pu, pv = dot(off, along_u), dot(off, along_v)
            u += (pu * vv - pv * uv) / (uu * vv - uv * uv)
            v += (pv * uu - pu * uv) / (uu * vv - uv * uv)
        return u, v

    def __call__(self, w, s):
        u, v = self.new_cut(s)
        point, normal = on_body(u, mix(v, FRONT_POLE, w))
        return self.moved(point), self.turned(normal)


def speed_shape():
    """The parts of the speed shape."""
    parts = {name: Part(name) for name in (
        "Hood", "Fender_L", "Fender_R", "Roof", "Door_L", "Door_R", "Quarter_L", "Quarter_R", "Deck", "Bumper_F",
        "Rear", "Glass", "Underbody", "Seams")}

    rear, front = (lambda u: REAR), (lambda u: FRONT)
    hood = cut_panel(parts["Hood"], top_patch(-BELT, BELT, COWL, front), symmetric=True)
    deck = cut_panel(parts["Deck"], top_patch(-BELT, BELT, rear, DECK), symmetric=True)
    roof = cut_panel(parts["Roof"], top_patch(-ROOF_EDGE, ROOF_EDGE, ROOF_REAR, ROOF_FRONT), symmetric=True)
    windshield = cut_panel(parts["Glass"], top_patch(-ROOF_EDGE, ROOF_EDGE, ROOF_FRONT, COWL), symmetric=True)
    backlight = cut_panel(parts["Glass"], top_patch(-ROOF_EDGE, ROOF_EDGE, DECK, ROOF_REAR), symmetric=True)
    window_part = Part("Glass")
    window = cut_panel(window_part, top_patch(ROOF_EDGE, BELT, DECK, COWL))
    fender = cut_panel(parts["Fender_L"], side_patch(DOOR_FRONT, (FRONT, FRONT)), open_high=True)
    door = cut_panel(parts["Door_L"], side_patch(DOOR_REAR, DOOR_FRONT), open_high=True)
    quarter = cut_panel(parts["Quarter_L"], side_patch((REAR, REAR), DOOR_REAR), open_high=True)
    for name in ("Fender", "Door", "Quarter"):
        parts[name + "_R"] = parts[name + "_L"].mirrored(name + "_R")
    parts["Glass"].append(window_part)
    parts["Glass"].append(window_part.mirrored("Glass"))
    underbody = set_in_underbody(parts["Underbody"])

    nose = cut_cap(parts["Bumper_F"], TurnedNose(), pole_is_front=True)
    tail = cut_cap(parts["Rear"], tail_cap, pole_is_front=False)

    half = Part("Seams")  # of the left side
    add_seam(half, quarter["low"] + door["low"] + fender["low"], deck["high"] + window["high"] + hood["high"])
    add_seam(half, window["low"], backlight["high"] + roof["high"] + windshield["high"])
    add_seam(half, quarter["front"], door["rear"])
    add_seam(half, door["front"], fender["rear"])
    seams = parts["Seams"]
    seams.append(half)
    seams.append(half.mirrored("Seams"))
    add_seam(seams, deck["front"], across(window["rear"], backlight["rear"]))
    add_seam(seams, backlight["front"], roof["rear"])
    add_seam(seams, roof["front"], windshield["rear"])
    add_seam(seams, across(window["front"], windshield["front"]), hood["rear"])
    sill_front, sill_rear = LOWER_CUT(FRONT) / AROUND, LOWER_CUT(REAR) / AROUND
    add_seam(seams, across(fender["front"], hood["front"]), upper_half(nose, sill_front))
    add_seam(seams, upper_half(tail, sill_rear), across(quarter["rear"], deck["rear"]))
    add_seam(seams, underbody["front"], lower_half(nose, sill_front - 0.015))
    add_seam(seams, lower_half(tail, sill_rear), underbody["rear"])
    open_wells(parts["Underbody"], AXLES, ARCH_CENTER, ARCH_RADIUS)
    return list(parts.values()) + wheels(AXLES)


def upper_half(edge, last):
    """The vertices of a loop of (turn, vertex) above the turn `last` on the left, from right to left."""
    return [vertex for turn, vertex in edge if turn > 1 - last] + [vertex for turn, vertex in edge if turn < last]


def lower_half(edge, first):
    """The vertices of a loop of (turn, vertex) below the turn `first` on the left, from left to right."""
    return [vertex for turn, vertex in edge if first <= turn <= 1 - first]


def number(value):
    """A length with six significant digits, rounded to a micrometer."""
    return f"{round(value, 6) + 0.0:.6g}"


def speed_shape_obj():
    """The bytes of speed-shape.obj."""
    nose = TurnedNose()
    lines = ["# A speed shape for judging paint: metres, +Y up, +Z forward, ground at y = 0.",
             "# Gaps of 4 mm; paint Seams, Underbody and Tires black, Glass dark and Rims as metal, the rest as you like.",
             f"# Bumper_F is out of flush: turned by {MISALIGNMENT_DEG:g} degrees about the line parallel to x through "
             f"y = {number(nose.pivot[1])}, z = {number(nose.pivot[2])}, its lower edge drawn in.",
             "# Made by scripts/make-testdata."]
    offset = 1
    for part in speed_shape():
        lines.append(f"o {part.name}")
        lines += ["v " + " ".join(map(number, point)) for point in part.points]
        lines += ["vn " + " ".join(map(number, normal)) for normal in part.normals]
        lines += ["f " + " ".join(f"{i + offset}//{i + offset}" for i in triangle) for triangle in part.triangles]
        offset += len(part.points)
    return "\n".join(lines + [""]).encode()
