"""A sphere as an OBJ mesh, written to standard output:  python3 sphere.py ROWS"""

from math import cos, pi, sin
import sys


def sphere_obj(rows):
    """The text of a unit sphere of `rows` rows of quadrilaterals about the y axis, twice as many in a row, with normals."""
    lines = []
    for i in range(rows + 1):
        for j in range(2 * rows):
            t, p = pi * i / rows, pi * j / rows
            point = f"{sin(t) * sin(p):.7f} {cos(t):.7f} {sin(t) * cos(p):.7f}"
            lines += [f"v {point}", f"vn {point}"]

    def corner(i, j):
        return "{0}//{0}".format(2 * rows * i + j % (2 * rows) + 1)

    lines += [f"f {corner(i, j)} {corner(i + 1, j)} {corner(i + 1, j + 1)} {corner(i, j + 1)}"
              for i in range(rows) for j in range(2 * rows)]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(sphere_obj(int(sys.argv[1])))
