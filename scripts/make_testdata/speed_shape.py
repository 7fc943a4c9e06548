"""The body of the speed shape: a smooth sculpture that resembles a car, as the net of a closed bicubic B-spline.

Lengths are meters; +Y is up, +Z is forward, +X is to the left of the car, and the ground is at y = 0.
"""

import math

from make_testdata.bspline import ClosedSurface

# The lines of the design, a ring in each row, from the tail to the nose. Before the bar: z, sweep (how far the ring trails at
# 0.8 m from the middle) and rake (dz for a meter of height). Behind it: the height of the middle; x, y and r of the roof edge,
# the belt and the shoulder; x and y of the waist, the swell and the sill; the height of the floor. r is the distance of the
# neighboring control points: a small distance makes a tight edge, a large one a soft edge.
LINES = """
# z    sweep rake | top    roof edge        belt             shoulder         waist      swell      sill      floor
-2.16  .10   -.05 | .885   .50  .88  .06    .62  .872 .05    .735 .84  .040   .735 .64   .69  .43   .60  .33  .31
-2.07  .10   -.04 | .90    .52  .893 .08    .66  .88  .05    .79  .855 .038   .80  .62   .77  .41   .68  .28  .245
-1.82  .08   .00  | .945   .52  .93  .09    .70  .885 .05    .885 .868 .035   .91  .62   .91  .40   .82  .22  .175
-1.45  .00   .00  | 1.035  .50  1.00 .07    .72  .885 .05    .935 .877 .03    .985 .62   .995 .40   .87  .18  .13
-1.05  .00   .00  | 1.13   .49  1.075 .06   .73  .875 .04    .915 .85  .03    .915 .60   .925 .35   .84  .165 .12
-.60   .00   .00  | 1.20   .505 1.13 .06    .73  .845 .04    .865 .80  .03    .815 .57   .865 .31   .80  .16  .12
-.15   .00   .00  | 1.225  .515 1.15 .06    .73  .82  .04    .84  .765 .03    .785 .54   .85 .29    .79  .16  .12
.30    .00   .00  | 1.15   .515 1.085 .06   .735 .805 .04    .845 .755 .03    .79 .53    .85 .285   .79  .16  .12
.70    .00   .00  | .985   .505 .94  .08    .73  .79  .05    .87  .76  .03    .825 .54   .87  .29   .80  .165 .12
1.05   .00   .00  | .865   .50  .845 .10    .69  .76  .06    .91  .775 .035   .915 .57   .935 .33   .84  .17  .12
1.40   .03   .00  | .80    .47  .787 .10    .65  .725 .07    .925 .775 .045   .98 .58    .985 .38   .86  .18  .125
1.75   .10   .00  | .73    .42  .718 .10    .59  .66 .07     .87  .70  .05    .925 .51   .925 .36   .82  .18  .135
2.02   .18   .08  | .65    .36  .64  .08    .51  .60  .06    .755 .61  .05    .80 .45    .79  .32   .70  .19  .155
2.15   .22   .18  | .58    .30  .573 .06    .43  .55  .05    .63  .545 .045   .665 .43   .65  .32   .56  .22  .19
"""

# The rings inside the ends turn a scaled copy of the outermost line into an ellipse. Each has its z, its middle, its scale and
# the share of the ellipse, whose half width and half height stand below. The last one is the pole.
TAIL = [(-2.185, 0.60, 0.94, 0.05), (-2.155, 0.60, 0.84, 0.3), (-2.14, 0.60, 0.45, 1.0), (-2.14, 0.60, 0.0, 1.0)]
NOSE = [(2.20, 0.40, 0.86, 0.15), (2.215, 0.39, 0.5, 1.0), (2.215, 0.39, 0.0, 1.0)]
TAIL_ELLIPSE, NOSE_ELLIPSE = (0.80, 0.28), (0.68, 0.19)
MIDDLE_OF_RAKE = 0.5


def toward(a, b, distance):
    """The point at `distance` from a on the way to b, or at 0.4 of the way if that is nearer."""
    share = min(distance / math.dist(a, b), 0.4)
    return tuple(p + (q - p) * share for p, q in zip(a, b))


def half_section(numbers):
    """The left half of the control points (x, y) of a ring, from top to bottom, from the numbers of one row."""
    top, rx, ry, rr, bx, by, br, sx, sy, sr, wx, wy, ex, ey, kx, ky, floor = numbers
    roof, belt, shoulder, waist, swell, sill = (rx, ry), (bx, by), (sx, sy), (wx, wy), (ex, ey), (kx, ky)
    crown = top - ry
    inner = (rx * 0.68, top - 0.40 * crown)
    glass = ((rx + bx) / 2 + 0.035 * (ry - by) / 0.3, (ry + by) / 2 + 0.02 * (ry - by) / 0.3)
    return [(0, top), (rx * 0.36, top - 0.09 * crown), inner,
            toward(roof, inner, rr), roof, toward(roof, glass, rr), glass,
            toward(belt, glass, br), belt, toward(belt, shoulder, br),
            toward(shoulder, belt, sr), shoulder, toward(shoulder, waist, sr),
            waist, swell, sill, (kx * 0.6, floor + 0.01), (kx * 0.3, floor), (0, floor)]


def whole_ring(half, place):
    """A closed ring, made of its left half; `place` gives z for (x, y)."""
    loop = half + [(-x, y) for x, y in half[-2:0:-1]]
    return [(x, y, place(x, y)) for x, y in loop]


def end_rings(half, place, ends, radii):
    """The rings from the outermost line to the pole.

    Near the pole they are full ellipses, which are level and symmetric about their middle, so that the surface has one tangent
    plane at the pole.
    """
    rings = []
    for z, middle, scale, roundness in ends:
        blended = []
        for i, (x, y) in enumerate(half):
            turn = math.pi * i / (len(half) - 1)
            round_x, round_y = radii[0] * scale * math.sin(turn), middle + radii[1] * scale * math.cos(turn)
            x, y = x * scale, middle + (y - middle) * scale
            blended.append((x + (round_x - x) * roundness, y + (round_y - y) * roundness))
        trail = place(0, MIDDLE_OF_RAKE)
        rings.append(whole_ring(blended, lambda x, y: z + (1 - roundness) * (place(x, y) - trail)))
    return rings


def body():
    """The surface of the body: u runs from the top (0) down the left side to the underside and up the right side."""
    rings, halves, places = [], [], []
    for line in LINES.splitlines():
        if line and not line.startswith("#"):
            before, after = line.split("|")
            z, sweep, rake = map(float, before.split())
            halves.append(half_section(list(map(float, after.split()))))
            places.append(lambda x, y, z=z, sweep=sweep, rake=rake:
                          z - sweep * (x / 0.8) ** 2 + rake * (y - MIDDLE_OF_RAKE))
            rings.append(whole_ring(halves[-1], places[-1]))
    tail = end_rings(halves[0], places[0], TAIL, TAIL_ELLIPSE)
    nose = end_rings(halves[-1], places[-1], NOSE, NOSE_ELLIPSE)
    return ClosedSurface(tail[::-1] + rings + nose)
