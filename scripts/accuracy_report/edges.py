"""Samples of a pixel against many: what is left of the steps of an outline, and what smooth ones cost."""

import functools
import importlib.machinery
import importlib.util
import statistics

from make_testdata import exr

from .fit import part
from .scene import CAMERA
from .study import Failed, Figure, Reading, Study

PAINTS = ("signal_red", "silver_black_flop")
VIEW = CAMERA[CAMERA.index("--camera"):]  # without size and samples, which are the knobs here
SIZE, FINER = (240, 135), 4  # the reference is so many times as wide, with 16 samples of each of its pixels
DEFAULT = ("cpu", 4)
GRAY = 0.18  # behind the mesh, of white
XYZ = ((0.636958, 0.144617, 0.168881), (0.262700, 0.677998, 0.059302), (0.0, 0.028073, 1.060985))  # of linear Rec.2020


def recipe(run):
    """The recipe that compares pictures, for its color difference."""
    path = run.data.parent / "scripts/batch/recipes/picture-difference"
    loader = importlib.machinery.SourceFileLoader("picture_difference", str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def averaged(rows, n):
    """Blocks of n x n values, each as its mean."""
    for top in range(0, len(rows), n):
        line = [sum(column) for column in zip(*rows[top:top + n])]
        yield [sum(line[i:i + n]) / n ** 2 for i in range(0, len(line), n)]


def labs(recipe, channels, white):
    """Lab of every pixel before gray, as a display shows it: no channel above white."""
    for r, g, b, a in zip(*(sum(map(list, channels[name]), []) for name in "RGBA")):
        rgb = [min(1.0, c / white + (1 - a) * GRAY) for c in (r, g, b)]
        fx, fy, fz = (recipe.f(sum(m * c for m, c in zip(row, rgb)) / w) for row, w in zip(XYZ, recipe.WHITE))
        yield 116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)


class Picture:
    """A paint on the mesh under the probe, at any size."""

    def __init__(self, run, paint):
        self.run, self.out = run, run.work / "edges.exr"
        fitted, env = run.work / "edges.xml", run.work / "edges.env.exr"
        run.tool("fit-paint", "--basis", run.data / "b7.basis.xml", run.paints, "-o", fitted)
        run.tool("prefilter-envmap", run.probe, "--basis", run.data / "b7.basis.xml", "-o", env)
        self.words = ("--mesh", run.mesh, "--paint", f"{fitted}#{paint}", "--env", env, *VIEW, "--effects", "all", "-o", self.out)

    def drawn(self, scale, samples, engine):
        size = "x".join(str(scale * side) for side in SIZE)
        results, _ = self.run.tool("render-osmesa", *self.words, "--size", size, "--samples", samples, "--engine", engine)
        return results

    def read(self, *drawn):
        return self.drawn(*drawn), exr.channels_of(self.out)


def readings_of(run, recipe, paint):
    view = Picture(run, paint)
    results, fine = view.read(FINER, 16, "cpu")
    white = results["white_luminance"]
    exact = {name: list(averaged(rows, FINER)) for name, rows in fine.items()}
    alpha = [a for row in exact["A"] for a in row]
    if 1 not in alpha or all(a in (0, 1) for a in alpha):
        raise Failed(f"{run.mesh}: its outline is not in the picture, seen by {' '.join(VIEW)}")
    reference = list(labs(recipe, exact, white))
    for engine in ("gl", "cpu"):
        for samples in (1, 4, 16):
            drawn = functools.partial(view.drawn, 1, samples, engine)
            results, channels = view.read(1, samples, engine)
            errors = [recipe.de2000(one, other) for one, other in zip(reference, labs(recipe, channels, white))]
            edge = [e for e, a in zip(errors, alpha) if 0 < a < 1]
            times = run.timed(lambda drawn=drawn: 1e-3 * drawn()["frame_ms"], 1e-3 * results["frame_ms"])
            inside = statistics.mean(e for e, a in zip(errors, alpha) if a == 1)
            yield Reading(f"{engine}, {samples} samples", error=statistics.mean(edge), method=engine,
                          default=(engine, samples) == DEFAULT, **times,
                          numbers={"paint": paint, "p95": part(edge, 0.95), "inside": inside, "pixels": len(edge)})


def study(run):
    compare = recipe(run)
    by_paint = {paint: list(readings_of(run, compare, paint)) for paint in run.named(PAINTS[:1] if run.quick else PAINTS)}
    figures = [Figure(f"edges-{paint}", f"{paint}: mean dE00 of the pixels on its outline against time", readings,
                      "time of a frame, all samples (s)", "dE00 on the outline, mean",
                      note="From left to right: 1, 4 and 16 samples. One is drawn from the buffers of the planning; more want a "
                      "rasterization each, and the first of them is the cliff.")
               for paint, readings in by_paint.items()]
    rows = [(paint, r.setting, 1e3 * r.time_s, r.error, r.numbers["p95"], r.numbers["inside"])
            for paint, readings in by_paint.items() for r in readings]
    return Study("Edges", f"Pictures of {SIZE[0]} x {SIZE[1]} pixels with 1, 4 and 16 samples a pixel, all effects drawn, before "
                 f"gray of {GRAY * 100:.0f} %. The reference is the same view {FINER} times as wide and high with 16 samples, "
                 f"{16 * FINER ** 2} for each pixel, averaged as light. Colors are compared as a display shows them, with white "
                 "as the brightest. ", figures,
                 [("Samples of a pixel",
                   ("paint", "engine and samples", "frame (ms)", "outline, dE00 mean", "outline, 95 %", "inside, mean"), rows)])
