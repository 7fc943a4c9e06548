"""Fewer lobes: what smaller bases, --lobes and --prune do to the color of a paint and to the time of shading it."""

import dataclasses
import functools
import statistics

from shared.tools import Failed

from .fit import bases
from .scene import CAMERA
from .study import Figure, Reading, Study

PAINTS = ("silver_black_flop", "candy_red")
DEFAULT = "b7, all lobes"
SIZE = ("--size", "640x360")
UNSEEN = ("There is no dashed line here: a lobe that no reading of this paint needs still shapes its colors between the "
          "readings, and this error does not show that.")


def settings(run):
    """(series, setting, basis, more words for fit-paint) of every setting; the default comes first."""
    b7 = run.data / "b7.basis.xml"
    yield "b7, --prune", DEFAULT, b7, ()
    for de00 in (1,) if run.quick else (0.2, 1, 2, 5):
        yield "b7, --prune", f"b7, --prune {de00:g}", b7, ("--prune", de00)
    for count in (3,) if run.quick else (1, 2, 3, 4):
        yield "b7, --lobes", f"b7, --lobes {count}", b7, ("--lobes", count)
    for size, basis in bases(run, (2, 4, 7) if run.quick else (1, 2, 3, 4, 5, 7, 11)).items():
        yield "fit-basis", f"basis of {size} lobes", basis, ()


def environment(run, basis):
    """(the probe filtered by a basis, the seconds that this took); it is done once for each basis."""
    key = ("lobes", basis)
    if key not in run.kept:
        out = run.work / f"lobes-{basis.stem}.env.exr"
        run.kept[key] = out, run.tool("prefilter-envmap", run.probe, "--basis", basis, "-o", out)[1]
    return run.kept[key]


def study(run):
    names = run.named(PAINTS[:1] if run.quick else PAINTS)
    by_paint, library, rows = {name: [] for name in names}, [], []
    for i, (series, setting, basis, more) in enumerate(settings(run)):
        fitted = run.work / f"lobes-fitted-{i}.xml"
        results, best, raw = run.repeated("fit-paint", "--basis", basis, *more, run.paints, "-o", fitted)
        env, filter_s = environment(run, basis)
        paints = {p["name"]: p for p in results["paints"] if p["status"] != "failed"}
        if not set(names) <= set(paints):
            raise Failed(f"{run.paints}: {', '.join(set(names) - set(paints))} cannot be fitted")
        left = statistics.mean(p["active_lobes"] for p in paints.values())
        numbers = {"lobes": left, "p95": results["de00_p95"], "prefilter_s": filter_s}
        library.append(Reading(setting, best, results["de00_mean"], series, setting == DEFAULT, raw, numbers))
        for name in names:
            shading = functools.partial(run.shading, "--mesh", run.mesh, "--paint", f"{fitted}#{name}", "--env", env,
                                        *SIZE, *CAMERA[2:], "--effects", "all,-rays", "-o", run.work / "lobes.exr")
            by_paint[name].append(Reading(setting, error=paints[name]["de00_mean"], method=series, default=setting == DEFAULT,
                                          **run.timed(shading), numbers={"lobes": paints[name]["active_lobes"]}))
        shading = [1e3 * by_paint[name][-1].time_s for name in names]
        rows.append((setting, left, results["de00_mean"], results["de00_p95"], filter_s, *shading))
    figures = [Figure("lobes", "The library: mean dE00 at the readings against the lobes left", library,
                      "lobes left, mean over the paints", "dE00, mean", front=False, x=lambda r: r.numbers["lobes"],
                      logarithmic="y", note="There is no dashed line here: the axis is a number of lobes, not a time.")]
    x_label, y_label = "time of shading every pixel once (s)", "dE00 of the fit, mean"
    figures += [Figure(f"lobes-{name}",
                       f"{name}: dE00 at its readings with fewer of the lobes of b7 against the time of shading it",
                       [r for r in readings if r.method != "fit-basis"], x_label, y_label, front=False, note=UNSEEN)
                for name, readings in by_paint.items()]
    own = [dataclasses.replace(r, method=name, default=False)
           for name, readings in by_paint.items() for r in readings if r.method == "fit-basis"]
    figures.append(Figure("lobes-own", "The same with bases that fit-basis chose for the library", own, x_label, y_label,
                          apart=True, note="The bases have more lobes from left to right. Unlike those of b7, which has two "
                          "sharp ones for gloss, these lobes serve the readings only."))
    head = ("setting", "lobes left", "library, dE00 mean", "95 %", "prefilter (s)", *(f"{name}, shading (ms)" for name in names))
    return Study("Fewer lobes", "There are three ways to fit a paint with fewer lobes: a smaller basis that fit-basis chose, the "
                 "best few of the seven lobes of b7 (fit-paint --lobes), and leaving out lobes as long as no color moves by more "
                 "than a given dE00 (fit-paint --prune). All effects of the picture are drawn.",
                 figures, [("What the lobes cost", head, rows)])
