"""Fitting: the method, the number of lobes and the target, held against the measured colors."""

import statistics

from shared.quantile import quantile

from .study import Figure, Reading, Study

METHODS = ("l1", "l2", "deltae")
TARGETS = ("measured", "curve")
DEFAULT = ("l1", "measured", 7)  # 7 lobes, as the basis b7 has


def bases(run):
    """({number of lobes: the basis that fit-basis chose for the library}, the sets of its report), made once for all studies."""
    if "bases" not in run.kept:
        found, _ = run.tool("fit-basis", run.paints, "--lobes", f"1..{7 if run.quick else 9}", "--starts", 2 if run.quick else 4,
                            "--mirror", "yes", "--each", run.work / "lobes-", "-o", run.work / "largest.xml")
        sets = found["sets"]
        run.kept["bases"] = {each["lobes"]: run.work / f"lobes-{each['lobes']}.basis.xml" for each in sets}, sets
    return run.kept["bases"]


def fitted(run, basis, method, target):
    """(the seconds that a paint takes, those of every repetition, the color differences at the readings)"""
    times = []
    for _ in range(run.repeats):
        results, _ = run.tool("fit-paint", run.paints, "--basis", basis, "--method", method, "--target", target,
                              "--threads", 1, "-o", run.work / "fitted.xml")
        paints = [paint for paint in results["paints"] if paint["status"] != "failed"]
        times.append(1e-6 * statistics.median(paint["time_us"] for paint in paints))
    errors = [error for paint in paints for error in paint["de00_by_geometry"].values()]
    return min(times), tuple(times), errors


def study(run):
    sizes = (2, 4, 7) if run.quick else (2, 4, 7, 9)
    by_size = {size: bases(run)[0][size] for size in sizes}
    readings, rows = [], []
    for target in TARGETS:
        for method in METHODS:
            for size, basis in by_size.items():
                time_s, all_s, errors = fitted(run, basis, method, target)
                numbers = {"lobes": size, "p95": quantile(errors, 0.95), "max": max(errors)}
                readings.append(Reading(f"{method}, {size} lobes, {target}", time_s, statistics.mean(errors),
                                        method=f"{method} {target}", default=(method, target, size) == DEFAULT,
                                        raw_s=all_s, numbers=numbers))
                rows.append((method, target, size, 1e6 * time_s, statistics.mean(errors), numbers["p95"], numbers["max"]))
    mean = Figure("fit-mean", "Mean dE00 at the readings against time for a paint", readings,
                  "time for a paint (s)", "dE00, mean")
    lobes = Figure("fit-lobes", "Mean dE00 against the number of lobes", readings, "lobes", "dE00, mean",
                   front=False, x=lambda r: r.numbers["lobes"], logarithmic="y",
                   note="There is no dashed line here: the axis is a number of lobes, not a time.")
    return Study("Fitting", f"Every paint of the library is fitted, on one thread, to bases of {sizes[0]} to {sizes[-1]} lobes "
                 "that fit-basis chose for the library. The error is that of the color that the lobes predict at the readings. "
                 "Two causes of error remain with any number of lobes: readings that differ on the two sides of specular, and "
                 "colors outside the working space. fit-paint names them as the limit of a paint.",
                 [mean, lobes],
                 [("Method, target and lobes", ("method", "target", "lobes", "time (us)", "dE00 mean", "95 %", "largest"), rows)])
