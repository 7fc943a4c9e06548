"""What the rings of plot-paint --hud must show: hud_test.py VIEW DRAWING [--closed], or hud_test.py --ball for a mesh."""

import collections
import math
import re
import sys


def write_ball(lines=48):
    """A ball with its normals as OBJ, on standard output."""
    print("\n".join("%s %f %f %f" % (word, math.sin(t) * math.cos(p), math.cos(t), math.sin(t) * math.sin(p))
                    for i in range(lines + 1) for j in range(2 * lines)
                    for t, p in [(math.pi * i / lines, math.pi * j / lines)] for word in ("v", "vn")))
    side = 2 * lines
    for i in range(lines):
        for j in range(side):
            a, b, c, d = (row * side + column % side + 1 for row, column in ((i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)))
            for corners in [(a, b, c)] * (i > 0) + [(a, c, d)] * (i < lines - 1):
                print("f", *("%d//%d" % (n, n) for n in corners))


def share_on(ends, angles, level, tolerance, shift=0.0):
    """The share of these ends of pieces of a line where the angles between the middles of pixels are the level."""
    import numpy

    x, y = (numpy.array(ends) - 0.5 + shift).T
    row, column = (numpy.minimum(at.astype(int), size - 2) for at, size in zip((y, x), angles.shape))
    u, v = x - column, y - row
    angle = ((1 - v) * ((1 - u) * angles[row, column] + u * angles[row, column + 1])
             + v * ((1 - u) * angles[row + 1, column] + u * angles[row + 1, column + 1]))
    return numpy.mean(abs(angle - level) <= tolerance)


def is_one_closed_line(ends):
    """Whether all pieces are joined, at both ends. An end that is rounded to the middle of a pixel may meet three others."""
    beside = collections.defaultdict(list)
    for a, b in zip(ends[::2], ends[1::2]):
        beside[a].append(b)
        beside[b].append(a)
    met, waiting = set(), [ends[0]]
    while waiting:
        end = waiting.pop()
        if end not in met:
            met.add(end)
            waiting += beside[end]
    return met == set(beside) and all(len(others) % 2 == 0 for others in beside.values())


def main():
    if sys.argv[1:] == ["--ball"]:
        write_ball()
        return
    import numpy
    import OpenImageIO

    buffer = OpenImageIO.ImageBuf(sys.argv[1])
    channel = buffer.spec().channelnames.index("aspecular")
    angles = buffer.get_pixels(OpenImageIO.FLOAT)[:, :, channel].astype(float)
    with open(sys.argv[2], encoding="utf-8") as file:
        text = file.read()
    travel = float(re.search(r">([\d.]+) deg, travel", text)[1])
    lines = re.findall(r'<path d="([^"]*)" fill="none" stroke="#000000"', text)
    assert len(lines) == 3, len(lines)
    # Neighbors differ by 20 degrees at most where a line passes between them, and its ends are written to 0.005 px; the
    # angle of the travel is written to 0.05 degrees.
    for level, tolerance, line in zip((15, 45, travel), (0.1, 0.1, 0.15), lines):
        ends = [(float(x), float(y)) for x, y in re.findall(r"[ML]([\d.]+) ([\d.]+)", line)]
        assert len(ends) > 50 and share_on(ends, angles, level, tolerance) == 1, (level, len(ends))
        # The control: half a pixel aside, as if the middles of pixels were at whole numbers, a line is not on its angle but where
        # it runs that way itself.
        assert share_on(ends, angles, level, tolerance, 0.5) < 0.25, (level, share_on(ends, angles, level, tolerance, 0.5))
        # No piece is left out: all four angles around each are seen, and on one side of the line as well as on the other.
        if level != travel:
            around = [angles[:-1, :-1], angles[:-1, 1:], angles[1:, 1:], angles[1:, :-1]]
            low, high = (pick(pick(around[0], around[1]), pick(around[2], around[3])) for pick in (numpy.minimum, numpy.maximum))
            met = (high < 179.9) & (high - low <= 20) & (low < level) & (high >= level)
            below = [corner < level for corner in around]
            saddles = met & (below[0] == below[2]) & (below[1] == below[3])
            assert line.count("M") == met.sum() + saddles.sum(), (level, line.count("M"), met.sum(), saddles.sum())
        if sys.argv[3:] == ["--closed"]:
            assert is_one_closed_line(ends), level


if __name__ == "__main__":
    main()
