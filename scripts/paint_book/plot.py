"""L*, a* and b* against aspecular angle, as inline SVG.

The tool draw-plot could draw these plots, but not as well. For the 59 paints of testdata, three runs for each paint (one for
each channel) take 0.4 s of processor time in all, and the page of 4.0 MB becomes 0.3 MB larger; this module takes 0.01 s, and
the whole book 20 s. Time and size would therefore allow it, but the picture does not. If three panels are to fit beside the
picture of the paint, draw-plot labels one value or none on the vertical axis of each. A dot has a color of its own only as a
series of its own, and the legend of these series takes a third of the width. The horizontal axis is labeled at round numbers
instead of the angles that were measured, and nothing marks the specular direction. plot-paint draws the channels of all paints
in one run of 1.4 s, but always together with its other drawings, which take 0.9 MB for each paint.
"""

import math

from paint_book.colors import srgb

WIDTH, PANEL, LEFT, RIGHT, TOP, FOOT = 430, 104, 58, 12, 10, 34
CHANNELS = ("L*", "a*", "b*")


def ticks(low, high):
    """Round numbers from low to high, at least two and usually not more than four; low and high if there are none."""
    span = high - low
    step = 10 ** math.floor(math.log10(span))
    for factor in (5, 2, 1, 0.5, 0.2):
        first = math.ceil(low / (step * factor))
        last = math.floor(high / (step * factor))
        if last - first >= 1:
            return [i * step * factor for i in range(first, last + 1)]
    return [low, high]


class Axis:
    """The vertical scale of a panel."""

    def __init__(self, values, top):
        low, high = min(values), max(values)
        pad = max((high - low) * 0.12, (6 - (high - low)) / 2, 0.5)
        self.low, self.high, self.top = low - pad, high + pad, top

    def y(self, value):
        return self.top + (PANEL - 16) * (self.high - value) / (self.high - self.low)


def plot(paint):
    """The three panels of a paint. Readings are dots in their own color, hollow if out of plane; the curve is a line."""
    angles = [row.angle_deg for row in paint.rows]
    left_deg = min([0] + angles)
    right_deg = max([115] + [angle + 5 for angle in angles])

    def x(angle):
        return LEFT + (WIDTH - LEFT - RIGHT) * (angle - left_deg) / (right_deg - left_deg)

    steps = [15 + (right_deg - 15) * i / 60 for i in range(61)]
    line = [(angle, paint.curve_at(angle)) for angle in steps] if paint.appearance else \
        sorted((row.angle_deg, row.lab) for row in paint.rows if row.in_plane)
    height = TOP + 3 * PANEL + FOOT - 16
    parts = [f'<svg class="plot" viewBox="0 0 {WIDTH} {height}" role="img" '
             'aria-label="L*, a* and b* against aspecular angle; the numbers are in the table">']
    for channel, label in enumerate(CHANNELS):
        axis = Axis([lab[channel] for _, lab in line] + [row.lab[channel] for row in paint.rows], TOP + channel * PANEL)
        parts += panel(axis, label)
        path = " ".join(f"{x(angle):.1f},{axis.y(lab[channel]):.1f}" for angle, lab in line)
        parts.append(f'<polyline class="curve" points="{path}"/>')
        for row in paint.rows:
            fill = srgb(row.lab) if row.in_plane else "none"
            parts.append(f'<circle cx="{x(row.angle_deg):.1f}" cy="{axis.y(row.lab[channel]):.1f}" r="4" fill="{fill}"/>')
    floor = TOP + 3 * PANEL - 16
    if left_deg < 0:
        parts.append(f'<line class="specular" x1="{x(0):.1f}" x2="{x(0):.1f}" y1="{TOP}" y2="{floor}"/>'
                     f'<text x="{x(0):.1f}" y="{floor + 15}" text-anchor="middle">specular</text>')
    for angle in angle_labels(sorted(set(angles)) or [15, 45, 110], x):
        parts.append(f'<line class="tick" x1="{x(angle):.1f}" x2="{x(angle):.1f}" y1="{floor}" y2="{floor + 4}"/>'
                     f'<text x="{x(angle):.1f}" y="{floor + 15}" text-anchor="middle">{angle:g}</text>')
    parts.append(f'<text x="{WIDTH - RIGHT}" y="{floor + 30}" text-anchor="end">aspecular angle, degrees</text></svg>')
    return "".join(parts)


def angle_labels(angles, x):
    """The angles that are labeled: from the left, those whose label does not touch the one before."""
    kept = []
    for angle in angles:
        if not kept or x(angle) - x(kept[-1]) >= 22:
            kept.append(angle)
    return kept


def panel(axis, label):
    parts = [f'<text class="channel" x="0" y="{axis.top + 12}">{label}</text>']
    for tick in ticks(axis.low, axis.high):
        y = axis.y(tick)
        parts.append(f'<line class="grid" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y:.1f}" y2="{y:.1f}"/>'
                     f'<text x="{LEFT - 5}" y="{y + 4:.1f}" text-anchor="end">{tick:g}</text>')
    return parts
