"""Paths: error against time for samples, engines, effects and bounces, and growth with triangles, pixels and lights."""

import numpy

from shared import pictures
from shared.colors import XYZ_FROM_REC2020, de2000, lab_of_rec2020

from .growth import curve
from .scene import CAMERA
from .study import Figure, Reading, Study

PAINT = "silver_fine"
MOST = 12  # bounces of the picture that all are held against
NEVER = 0.5  # a tolerance that the time limits here do not meet
LEAST = 0.02  # the least difference of the plot; nobody sees a smaller one
COMMON = ("--floor", "none", "--exposure", "0", "--background", "none")


def write_wavy(path, rows):
    """Writes a sphere whose surface is wavy, so that it shades itself: `rows` rows, twice as many columns, without normals.

    It is written row by row, since ten million triangles do not fit in memory as lines of text.
    """
    wide = 2 * rows
    p = numpy.pi * numpy.arange(wide) / rows
    column = numpy.arange(wide)
    beside = (column + 1) % wide
    with path.open("w") as file:
        for i in range(rows + 1):
            t = numpy.pi * i / rows
            r = 1 + 0.06 * numpy.sin(8 * t) * numpy.sin(9 * p)
            points = numpy.stack([r * numpy.sin(t) * numpy.sin(p), r * numpy.cos(t), r * numpy.sin(t) * numpy.cos(p)], -1)
            file.write("".join(map("v %.6f %.6f %.6f\n".__mod__, map(tuple, points.tolist()))))
        for i in range(rows):
            a, b = i * wide + column + 1, i * wide + beside + 1
            for corners in ([(a, a + wide, b)] if i > 0 else []) + ([(b, a + wide, b + wide)] if i < rows - 1 else []):
                file.write("".join(map("f %d %d %d\n".__mod__, map(tuple, numpy.stack(corners, -1).tolist()))))


class Pictures:
    """Pictures of one paint on the mesh under the probe, and what they are held against."""

    def __init__(self, run):
        self.run, self.fitted, self.env = run, run.work / "paths.xml", run.work / "paths.env.exr"
        run.tool("fit-paint", "--basis", run.data / "b7.basis.xml", run.paints, "-o", self.fitted)
        run.tool("prefilter-envmap", run.probe, "--basis", run.data / "b7.basis.xml", "-o", self.env)
        self.light = ("--env", self.env, "--check-source", run.probe)
        self.words = ("--mesh", run.mesh, "--paint", f"{self.fitted}#{run.named([PAINT])[0]}", *COMMON, *CAMERA)
        self.truth = None
        self.white = 1.0

    def drawn(self, *more):
        """(the colors, whether a pixel shows the mesh, the results of the report, the seconds)"""
        out = self.run.work / "path.exr"
        results, seconds = self.run.tool("render-osmesa", *self.words, *more, "-o", out)
        channels = pictures.channels(out)
        return numpy.stack([channels[name] for name in "RGB"], -1).astype(float), channels["A"] > 0.99, results, seconds

    def path(self, bounces, tolerance, seed=2):
        return self.drawn(*self.light, "--engine", "path", "--bounces", bounces, "--tolerance", tolerance, "--seed", seed)

    def converge(self):
        """Draws the picture that all others are held against."""
        rgb, self.seen, results, _ = self.path(MOST, 1 if self.run.quick else 0.5, seed=1)
        self.truth = rgb[self.seen]
        self.white = 2 * float(numpy.quantile((self.truth @ numpy.transpose(XYZ_FROM_REC2020))[:, 1], 0.9))
        return results["noise_de00_p95"]

    def error(self, rgb):
        """The 95th percentile of dE00 to that picture."""
        errors = de2000(lab_of_rec2020(rgb[self.seen], self.white), lab_of_rec2020(self.truth, self.white))
        return float(numpy.quantile(errors, 0.95))

    def reading(self, method, setting, *drawn, default=False):
        """A reading; `drawn` are the options that make the picture."""
        rgb, _, _, seconds = self.drawn(*drawn)
        return Reading(f"{method}, {setting}", error=self.error(rgb), method=method, default=default,
                       **self.run.timed(lambda: self.drawn(*drawn)[3], seconds))


def against_time(run):
    """(the readings of all engines, the noise of the picture that they are held against)"""
    stage = Pictures(run)
    noise = stage.converge()
    readings = []
    for bounces in (0, 8) if run.quick else (0, 2, 8):
        for tolerance in ("4",) if run.quick else ("4", "2", "1"):
            readings.append(stage.reading(f"path, {bounces} bounces", f"to {tolerance} dE00", *stage.light, "--engine", "path",
                                          "--bounces", bounces, "--tolerance", tolerance))
    for tolerance in ("4", "2") if run.quick else ("4", "2", "1", "0.5"):
        readings.append(stage.reading("maps and rays", f"to {tolerance} dE00", *stage.light, "--tolerance", tolerance))
    readings.append(stage.reading("maps and rays", "by default", *stage.light, default=True))
    for seconds in ("0.5",) if run.quick else ("0.5", "1", "2"):
        readings.append(stage.reading("maps and rays, by time", f"{seconds} s", *stage.light, "--tolerance", NEVER,
                                      "--time-limit", seconds))
    readings.append(stage.reading("cpu", "all effects", *stage.light, "--engine", "cpu", "--effects", "all,-rays"))
    readings.append(stage.reading("integral", "to 2 dE00", *stage.light, "--engine", "integral", "--tolerance", "2",
                                  "--effects", "all,-rays"))
    return readings, noise


def growth(run):
    """(what grows, its size, the least seconds, all seconds): processor time of the whole tool."""
    fitted = run.work / "paths.xml"
    paint = ("--paint", f"{fitted}#{run.named([PAINT])[0]}", *COMMON, "--engine", "path", "--bounces", 2, "--tolerance", 2,
             "-o", run.work / "growth.exr")
    mesh = run.work / "wavy.obj"
    view = ("--camera", "30,20", "--env", run.work / "paths.env.exr", "--check-source", run.probe)

    def timed(*words):
        _, best, raw = run.repeated("render-osmesa", "--mesh", mesh, *paint, *words)
        return best, raw
    for rows in (50, 100) if run.quick else (50, 158):
        write_wavy(mesh, rows)
        yield "triangles", 4 * rows * (rows - 1), *timed(*view, "--size", "160x90")
    write_wavy(mesh, 100)
    for width in (80, 160) if run.quick else (80, 160, 320):
        yield "pixels", width * width * 9 // 16, *timed(*view, "--size", f"{width}x{width * 9 // 16}")
    for lights in (1, 8) if run.quick else (1, 4, 16):
        words = [word for i in range(lights) for word in ("--light", f"{360 * i / lights - 180:.1f},40")]
        yield "lights", lights, *timed("--camera", "30,20", "--size", "160x90", *words)


def study(run):
    readings, noise = against_time(run)
    error = Figure("paths", "dE00 to a converged picture, 95 % of the pixels, against time", readings, "processor time (s)",
                   "dE00, 95 % of the pixels", y=lambda r: max(r.error, LEAST),
                   note=f"The picture that all are held against has {MOST} bounces and a noise of {noise:.2f} dE00. The engines "
                   "cpu and integral leave out that the mesh is in the way of light.")
    kinds = {}
    for kind, n, best, raw in growth(run):
        kinds.setdefault(kind, []).append(Reading(f"{kind} {n}", time_s=best, error=0.0, method=kind, raw_s=raw, numbers={"n": n}))
    grown = Figure("path-growth", "Time of a path traced picture against its size", [r for rs in kinds.values() for r in rs],
                   x_label="triangles, pixels or lights", y_label="time (s)", front=False, x=lambda r: r.numbers["n"],
                   y=lambda r: r.time_s)
    return Study("Pictures and paths",
                 "One picture is drawn to several tolerances (--tolerance) and for several times (--time-limit). The default, maps and "
                 "rays, errs by its maps and by the noise of rays. The engine path has no maps; each of its lines allows another "
                 "number of bounces. Fewer bounces leave light out, which no number of samples brings back. Times are processor "
                 "time of the whole tool, reading included. Growth is that of a wavy sphere that shades itself, drawn by the engine "
                 "path to a noise of 2 dE00 with 2 bounces; the tolerance ends the work, so that a light more costs what its noise "
                 "costs.",
                 [error, grown],
                 [("Error and time", ("method, tolerance", "time (s)", "dE00 95 %"), [(r.setting, r.time_s, r.error) for r in readings]),
                  ("Growth", ("what grows", "sizes", "least (s)", "most (s)", "exponent", "steepest step", "its exponent"),
                   [(kind, f"{rs[0].numbers['n']} to {rs[-1].numbers['n']}", rs[0].time_s, rs[-1].time_s, *curve(rs))
                    for kind, rs in kinds.items()])])
