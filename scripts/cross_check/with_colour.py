"""Compares the color differences of paint-compare with those of colour-science, which comes from pip.

Random pairs stand as paints of one reading each; pairs of equal name are compared. colour-science states CIE 1976, CIE94 for the
graphic arts, CMC(l:c) with the standard first, and CIEDE2000.
"""

import json
import random
import subprocess

from cross_check.with_mitsuba import VENV
from shared.tools import run_tool

# A separate environment, because colour-science brings a numpy of its own.
ENVIRONMENT = VENV.with_name("cross-check-colour")
PAIRS = 10000
FORMULAS = ("cie76", "cie94", "cmc:2:1", "cmc:1:1", "ciede2000")

# Reads [[standard, sample] ...] and prints the differences by formula.
DIFFERENCES = """
import json, sys
import numpy
from colour import difference
pairs = numpy.array(json.load(sys.stdin))
standard, sample = pairs[:, 0], pairs[:, 1]
found = {"cie76": difference.delta_E_CIE1976(standard, sample),
         "cie94": difference.delta_E_CIE1994(standard, sample),
         "cmc:2:1": difference.delta_E_CMC(standard, sample, l=2, c=1),
         "cmc:1:1": difference.delta_E_CMC(standard, sample, l=1, c=1),
         "ciede2000": difference.delta_E_CIE2000(standard, sample)}
json.dump({name: list(values) for name, values in found.items()}, sys.stdout)
"""


class NotHere(Exception):
    """colour-science cannot be had; the text says why."""


def python_with_colour():
    """The Python of the virtual environment, with colour-science in it. Raises NotHere."""
    python = ENVIRONMENT / "bin/python"
    steps = [] if python.exists() else [["/usr/bin/python3", "-m", "venv", ENVIRONMENT]]
    steps.append([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "colour-science"])
    for step in steps:
        done = subprocess.run(step, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode:
            raise NotHere(f"pip cannot install it: {(done.stdout.strip().splitlines() or ['no message'])[-1]}")
    return python


def random_pairs():
    """Half of the pairs are near each other, as batches are, and half are not."""
    numbers = random.Random(49)

    def color():
        return [numbers.uniform(1, 140), numbers.uniform(-90, 90), numbers.uniform(-90, 90)]

    pairs = []
    for index in range(PAIRS):
        standard = color()
        pairs.append((standard, color() if index % 2 else [value + numbers.gauss(0, 1) for value in standard]))
    return pairs


def table(pairs, side):
    rows = [f"p{index},45as15,D65,10,{pair[side][0]!r},{pair[side][1]!r},{pair[side][2]!r}" for index, pair in enumerate(pairs)]
    return "\n".join(["sample,geometry,illuminant,observer,L,a,b", *rows]) + "\n"


def lines(bin_dir, at):
    """Yields (what, figure, bound, why). Raises NotHere."""
    python, pairs = python_with_colour(), random_pairs()
    for side, name in enumerate(("standard", "sample")):
        (at / f"{name}.csv").write_text(table(pairs, side))
        run_tool(bin_dir / "paint-convert", "-q", at / f"{name}.csv", "-o", at / f"{name}.paints.xml")
    found = run_tool(bin_dir / "paint-compare", "-q", "--standard", at / "standard.paints.xml", "--pair", "name", "--formula",
                     ",".join(FORMULAS), "--format", "json", at / "sample.paints.xml").decode().splitlines()
    done = subprocess.run([python, "-c", DIFFERENCES], input=json.dumps(pairs), capture_output=True, text=True, check=False)
    if done.returncode:
        raise NotHere(f"it does not run: {(done.stderr.strip().splitlines() or ['no message'])[-1]}")
    theirs = json.loads(done.stdout)
    ours = [json.loads(line)["geometries"]["45as15"] for line in found]
    if len(ours) != len(pairs):
        raise ValueError(f"paint-compare compared {len(ours)} of {len(pairs)} pairs")
    for formula in FORMULAS:
        worst = max(abs(one[f"dE_{formula}"] - other) for one, other in zip(ours, theirs[formula], strict=True))
        yield (f"colour-science, {formula} of {len(pairs)} pairs, largest difference", worst, 1e-9, "roundings")
