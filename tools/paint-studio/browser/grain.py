#!/usr/bin/env python3
"""Compares the grain of a page's picture with that of render-osmesa.

grain.py PLAIN.f32 FLAKY.f32 PLAIN.exr FLAKY.exr prints, for the page and then for render-osmesa, the contrast of the light
of flakes, relative to the mean luminance, and the parts of pixels above 1.5, 2, 4 and 8 times the plain ones; then the
difference of the page's means, as CIEDE2000 at an exposure that brings the plain one to L* 60, and its standard error.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts"))
import numpy

from shared import colors, pictures

TO_XYZ = numpy.array(((0.6369580, 0.1446169, 0.1688810), (0.2627002, 0.6779981, 0.0593017), (0.0, 0.0280727, 1.0609851)))


def main():
    reference = [pictures.channels(path) for path in sys.argv[3:5]]
    theirs = [numpy.stack([picture[name] for name in "RGB"], -1) for picture in reference]
    ours = [numpy.fromfile(path, "<f4").reshape((*theirs[0].shape[:2], 4))[..., :3] for path in sys.argv[1:3]]
    for plain, flaky in (ours, theirs):
        before, after = (picture.astype(float) @ TO_XYZ[1] for picture in (plain, flaky))
        contrast = (after - before).std() / before.mean()
        print(f"{contrast:.4f}", *(f"{(after > times * before).mean():.5f}" for times in (1.5, 2, 4, 8)))
    means = [picture.reshape(-1, 3).mean(0, dtype=float) for picture in ours]
    white = means[0] @ TO_XYZ[1] / 0.2812
    difference = colors.de2000(*(colors.lab(mean[None] @ TO_XYZ.T / white) for mean in means))[0]
    error = colors.de2000(*(colors.lab(means[0][None] * share @ TO_XYZ.T / white) for share in (1, 1 + ours[1][..., 1].std() / means[0][1] / ours[1][..., 0].size ** 0.5)))[0]
    print(f"{difference:.4f} {error:.4f}")


main()
