"""Fewer lobes: what smaller bases, --lobes and --prune do to the color of a paint and to the time of drawing it."""

import statistics

from shared.tools import Failed

from .fit import bases
from .scene import CAMERA
from .study import Figure, Reading, Study

PAINT = "silver_black_flop"
DEFAULT = "b7, all lobes"
VIEW = ("--size", "640x360", "--samples", 16, *CAMERA[CAMERA.index("--camera"):])


def settings(run):
    """(series, setting, basis, more words for fit-paint) of every setting; the default comes first."""
    b7 = run.data / "b7.basis.xml"
    yield "b7, --prune", DEFAULT, b7, ()
    for de00 in (1,) if run.quick else (0.2, 1, 5):
        yield "b7, --prune", f"b7, --prune {de00:g}", b7, ("--prune", de00)
    for count in (3,) if run.quick else (1, 2, 3):
        yield "b7, --lobes", f"b7, --lobes {count}", b7, ("--lobes", count)
    for size in (2, 4, 7) if run.quick else (2, 4, 7, 9):
        yield "fit-basis", f"basis of {size} lobes", bases(run)[0][size], ()


def environment(run, basis):
    """(the probe filtered by a basis, the seconds that this took); it is done once for each basis."""
    key = ("lobes", basis)
    if key not in run.kept:
        out = run.work / f"lobes-{basis.stem}.env.exr"
        run.kept[key] = out, run.tool("prefilter-envmap", run.probe, "--basis", basis, "-o", out)[1]
    return run.kept[key]


def study(run):
    paint, = run.named([PAINT])
    readings, rows = [], []
    for i, (series, setting, basis, more) in enumerate(settings(run)):
        fitted = run.work / f"lobes-fitted-{i}.xml"
        results, _ = run.tool("fit-paint", "--basis", basis, *more, run.paints, "-o", fitted)
        env, filter_s = environment(run, basis)
        paints = {p["name"]: p for p in results["paints"] if p["status"] != "failed"}
        if paint not in paints:
            raise Failed(f"{run.paints}: {paint} cannot be fitted")
        _, best, raw = run.repeated("render-osmesa", "--mesh", run.mesh, "--paint", f"{fitted}#{paint}", "--env", env, *VIEW,
                                    "--effects", "all,-rays", "-o", run.work / "lobes.exr")
        reading = Reading(setting, best, paints[paint]["de00_mean"], series, setting == DEFAULT, raw,
                          {"lobes": paints[paint]["active_lobes"]})
        left = statistics.mean(p["active_lobes"] for p in paints.values())
        rows.append((setting, left, results["de00_mean"], results["de00_p95"], filter_s, reading.time_s, reading.error))
        readings.append(reading)
    figure = Figure("lobes", f"{paint}: dE00 at its readings with fewer lobes against the time of drawing it", readings,
                    "time of a picture of 16 samples (s)", "dE00 of the fit, mean", front=False,
                    note="There is no dashed line here: a lobe that no reading of this paint needs still shapes its colors "
                    "between the readings, and this error does not show that. b7 has two sharp lobes for gloss; the lobes that "
                    "fit-basis chose serve the readings only.")
    head = ("setting", "lobes left", "library, dE00 mean", "95 %", "prefilter (s)", "16 samples (s)", f"{paint}, dE00 mean")
    return Study("Fewer lobes", "There are three ways to fit a paint with fewer lobes: a smaller basis that fit-basis chose, the "
                 "best few of the seven lobes of b7 (fit-paint --lobes), and leaving out lobes as long as no color moves by more "
                 "than a given dE00 (fit-paint --prune). All effects of the picture are drawn.",
                 [figure], [("What the lobes cost", head, rows)])
