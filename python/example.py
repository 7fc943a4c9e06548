"""Fits a silver, compares the fit with its readings, and prints both as a plot over the aspecular angle.

  python example.py TESTDATA
"""

import sys

import goniochrome
import numpy

data = sys.argv[1]
(silver,) = goniochrome.read_paints(data + "/paints.paints.xml#silver_fine")
(fitted,) = goniochrome.fit([silver], goniochrome.read_basis(data + "/b7.basis.xml"))

# What the lobes show where the instrument stood.
light, view = goniochrome.directions(silver.geometries)
shown = goniochrome.lab_from_rgb(numpy.pi * fitted.brdf(light, view), silver.illuminant, silver.observer_deg)
apart = goniochrome.delta_e_2000(silver.readings, shown)
for name, reading, lab, difference in zip(silver.geometries, silver.readings, shown, apart):
    print(f"{name:10} read {reading[0]:6.2f}  fitted {lab[0]:6.2f}  dE00 {difference:.2f}  {'#' * round(reading[0] / 3)}")

# The curve between them.
angles = numpy.arange(15, 111, 5)
for angle, lab in zip(angles, silver.curve(angles)):
    print(f"{angle:3} deg  {' ' * round(lab[0] / 3)}o")
print(f"flop index {silver.metrics['flop_index']:.2f}, mean dE00 {apart.mean():.2f}")
