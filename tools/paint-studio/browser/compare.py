#!/usr/bin/env python3
"""Compares a picture of a page with one of render-osmesa, by CIEDE2000 at an exposure that brings white to 1.

compare.py PICTURE.f32 PICTURE.exr WHITE prints the mean, the 95th percentile and the largest difference over the pixels
that show the mesh in both, how many these are, and the median difference. With one more word, "beside", it takes the
pixels that do not show the mesh.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts"))
import numpy

from shared import colors, pictures

TO_XYZ = numpy.array(((0.6369580, 0.1446169, 0.1688810), (0.2627002, 0.6779981, 0.0593017), (0.0, 0.0280727, 1.0609851)))


def main():
    page, reference, white = sys.argv[1], pictures.channels(sys.argv[2]), float(sys.argv[3])
    theirs = numpy.stack([reference[name] for name in "RGBA"], -1)
    ours = numpy.fromfile(page, "<f4").reshape(theirs.shape)
    mesh = (theirs[..., 3] == 1) & (ours[..., 3] == 1)
    if "mask" in reference:
        mesh &= (reference["mask"] > 0) != (sys.argv[4:] == ["beside"])
    lab = [colors.lab(numpy.maximum(picture[mesh][:, :3], 0) @ TO_XYZ.T / white) for picture in (ours, theirs)]
    difference = colors.de2000(*lab)
    print(f"{difference.mean():.4f} {numpy.percentile(difference, 95):.4f} {difference.max():.3f}", end=" ")
    print(f"{mesh.sum()} {numpy.median(difference):.4f}")


main()
