"""Compares what Mitsuba 3 shows of the tables that paint-export writes with pictures of the engine path.

A sphere stands in gray light that changes slowly with the direction, so that the mirror image, which the table has widened, is the
same in both. Where pip has no mitsuba, the caller says so.
"""

import math

import numpy

from cross_check.with_mitsuba import REC2020_FROM_REC709, Case, difference, interpreter, p95
from shared import pictures
from shared.colors import XYZ_FROM_REC2020
from shared.files import write_whole
from shared.sphere import sphere_obj
from shared.tools import DATA, run_tool

PAINTS = ("arctic_white", "silver_fine", "candy_red", "candy_blue")  # the last is outside of Rec.709


def gray_probe(at):
    """Writes a wide light above and a weaker one at the side, for the tools and, with each texel cut into 8 x 8, for Mitsuba."""
    t, p = numpy.meshgrid((numpy.arange(64) + 0.5) / 64 * math.pi, (numpy.arange(128) + 0.5) / 128 * 2 * math.pi, indexing="ij")
    up, side = numpy.cos(t), numpy.sin(t) * numpy.cos(p - 1)
    light = 0.3 + 2 * numpy.exp(6 * (up - 1)) + 1.2 * numpy.exp(6 * (side - 1))
    gray = light[..., None].repeat(3, -1)
    write_whole(at / "probe.exr", pictures.exr_file(gray, numpy.float32, "two wide gray lights"))
    numpy.save(at / "probe.npy", gray.repeat(8, 0).repeat(8, 1).astype(numpy.float32))


class TableCase(Case):
    """A sphere with a fitted paint in ours, and with its table in Mitsuba's."""

    def __init__(self, name, at, size):
        super().__init__(name, at, size, at / "sphere.obj", {}, ((0.0, 0.0, 5.0), (0.0, 0.0, 0.0)), True)
        at_paint = self.words.index("--paint") + 1
        self.words[at_paint] = at / f"fitted.xml#{name}"
        self.told["parts"][0]["paint"] = {"table": str(at / f"{name}.bsdf")}


def lines(bin_dir, at, size=48, samples=256, tolerance=0.35):
    """(what, figure, bound, why) of each paint."""
    python, environment = interpreter()
    gray_probe(at)
    (at / "sphere.obj").write_text(sphere_obj(96))
    run_tool(bin_dir / "prefilter-envmap", at / "probe.exr", "-e", 1, "--size", 8, "--verify", 0, "-q", "-o", at / "probe.env.exr",
             done=(0,), command="prefilter-envmap")
    run_tool(bin_dir / "fit-paint", "-q", "-b", DATA / "b7.basis.xml", f"{DATA / 'paints.paints.xml'}#{','.join(PAINTS)}", "-o",
             at / "fitted.xml", done=(0,), command="fit-paint")
    run_tool(bin_dir / "paint-export", "-q", "--to", "rgl", at / "fitted.xml", "-o", at / "{name}", done=(0,), command="paint-export")
    for name in PAINTS:
        case = TableCase(name, at, size)
        (one, covered, _), (two, _, _) = (case.ours(bin_dir, tolerance, seed) for seed in (1, 2))
        halves = [case.theirs(python, environment, "llvm_ad_rgb", samples, 4, seed) for seed in (1, 101)]
        (b1, told), (b2, _) = ((picture @ numpy.transpose(REC2020_FROM_REC709), said) for picture, said in halves)
        ours, theirs = (one + two) / 2, (b1 + b2) / 2
        white = float(numpy.quantile((ours @ numpy.transpose(XYZ_FROM_REC2020))[..., 1][covered], 0.9)) / 0.5

        def apart(x, y):
            return difference(x[covered], y[covered], white)
        noise = 0.5 * math.hypot(p95(apart(one, two)), p95(apart(b1, b2)))
        yield (f"Mitsuba {told['version']}, the table of {name} on a sphere, 95th percentile of dE00 over {int(covered.sum())} pixels",
               p95(apart(ours, theirs)), 0.5 + 1.3 * noise, f"noise of both {noise:.2f}, and the table between its nodes")
