"""Few samples in a pixel against many: what is left of the steps of an outline, and what smooth outlines cost."""

import functools
import statistics

import numpy

from shared import pictures
from shared.colors import de2000, lab
from shared.quantile import quantile
from shared.tools import Failed

from .scene import CAMERA
from .study import Figure, Reading, Study

PAINTS = ("silver_black_flop",)
VIEW = CAMERA[CAMERA.index("--camera"):]  # without the size and the samples, which this study varies
SIZE, FINER = (240, 135), 4  # The reference is FINER times as wide and high and has 16 samples in each of its pixels.
DEFAULT = ("cpu", 4)
GRAY = 0.18  # the light behind the mesh, as a part of white
XYZ = ((0.636958, 0.144617, 0.168881), (0.262700, 0.677998, 0.059302), (0.0, 0.028073, 1.060985))  # from linear Rec.2020


def averaged(channel, n):
    """Blocks of n x n values of a channel, each as its mean."""
    height, width = channel.shape
    return channel.astype(float).reshape(height // n, n, width // n, n).mean((1, 3))


def labs(channels, white):
    """Lab of every pixel before gray, as a display shows it: no channel is above white."""
    behind = (1 - channels["A"]) * GRAY
    rgb = numpy.stack([numpy.minimum(1, channels[name] / white + behind) for name in "RGB"], -1)
    return lab(rgb @ numpy.transpose(XYZ))


class Picture:
    """A paint on the mesh under the probe, which can be drawn at any size."""

    def __init__(self, run, paint):
        self.run, self.out = run, run.work / "edges.exr"
        fitted, env = run.work / "edges.xml", run.work / "edges.env.exr"
        run.tool("fit-paint", "--basis", run.data / "b7.basis.xml", run.paints, "-o", fitted)
        run.tool("prefilter-envmap", run.probe, "--basis", run.data / "b7.basis.xml", "-o", env)
        self.words = ("--mesh", run.mesh, "--paint", f"{fitted}#{paint}", "--env", env, *VIEW, "--effects", "all,-rays", "-o", self.out)

    def drawn(self, scale, samples, engine):
        size = "x".join(str(scale * side) for side in SIZE)
        results, _ = self.run.tool("render-osmesa", *self.words, "--size", size, "--samples", samples, "--engine", engine)
        return results

    def read(self, *drawn):
        return self.drawn(*drawn), pictures.channels(self.out)


def readings_of(run, paint):
    view = Picture(run, paint)
    results, fine = view.read(FINER, 16, "cpu")
    white = results["white_luminance"]
    exact = {name: averaged(fine[name], FINER) for name in "RGBA"}
    inside = exact["A"] == 1
    outline = (exact["A"] > 0) & ~inside
    if not (inside.any() and outline.any()):
        raise Failed(f"{run.mesh}: its outline is not in the picture, seen by {' '.join(VIEW)}")
    reference = labs(exact, white)
    for engine in ("gl", "cpu"):
        for samples in (1, 4, 16):
            drawn = functools.partial(view.drawn, 1, samples, engine)
            results, channels = view.read(1, samples, engine)
            errors = de2000(reference, labs(channels, white))
            edge = errors[outline].tolist()
            times = run.timed(lambda drawn=drawn: 1e-3 * drawn()["frame_ms"], 1e-3 * results["frame_ms"])
            yield Reading(f"{engine}, {samples} sample{'s' * (samples > 1)}", error=statistics.mean(edge), method=engine,
                          default=(engine, samples) == DEFAULT, **times,
                          numbers={"paint": paint, "p95": quantile(edge, 0.95), "inside": float(errors[inside].mean()),
                                   "pixels": len(edge)})


def study(run):
    by_paint = {paint: list(readings_of(run, paint)) for paint in run.named(PAINTS)}
    figures = [Figure(f"edges-{paint}", f"{paint}: mean dE00 of the pixels on its outline against time", readings,
                      "time of a frame, all samples (s)", "dE00 on the outline, mean",
                      note="From left to right: 1, 4 and 16 samples. A single sample is drawn from the buffers that the planning "
                      "has already made; each further one looks at the mesh again, so the step from 1 to 4 is the steepest.")
               for paint, readings in by_paint.items()]
    rows = [(paint, r.setting, 1e3 * r.time_s, r.error, r.numbers["p95"], r.numbers["inside"])
            for paint, readings in by_paint.items() for r in readings]
    return Study("Edges", f"Pictures of {SIZE[0]} x {SIZE[1]} pixels with 1, 4 and 16 samples in a pixel, drawn with all effects "
                 f"before a gray of {GRAY * 100:.0f} %. The reference is the same view, {FINER} times as wide and high, with 16 "
                 f"samples in a pixel; {16 * FINER ** 2} samples are thus averaged, as light, for each pixel. Colors are "
                 "compared as a display shows them: nothing is brighter than white.", figures,
                 [("Samples of a pixel",
                   ("paint", "engine and samples", "frame (ms)", "outline, dE00 mean", "outline, 95 %", "inside, mean"), rows)])
