"""Choosing a basis: the starts, sample angles and method of fit-basis against the fits that its lobes allow."""

import statistics

from .study import Figure, Reading, Study

LOBES = 5
METHOD, STARTS, ANGLES = "power-mean", 6, 40  # the defaults of fit-basis


def error(run, basis):
    """(the largest plus the mean RMS error of a paint in L*, the mean dE00 of the library)

    The first is what fit-basis minimizes; here it is computed at the readings that fit-paint uses.
    """
    squares, _ = run.tool("fit-paint", run.paints, "--basis", basis, "--method", "l2", "-o", run.work / "fitted.xml")
    errors = [paint["objective"] for paint in squares["paints"] if paint["status"] != "failed"]
    colors, _ = run.tool("fit-paint", run.paints, "--basis", basis, "--method", "deltae", "-o", run.work / "fitted.xml")
    return max(errors) + statistics.mean(errors), colors["de00_mean"]


def reading(run, series, method, starts, angles):
    basis = run.work / "chosen.basis.xml"
    words = ("fit-basis", run.paints, "--lobes", LOBES, "--mirror", "--method", method, "--starts", starts,
             "--angles", angles, "-o", basis)
    found, best, raw = run.repeated(*words)
    missed, de00 = error(run, basis)
    default = (method, starts, angles) == (METHOD, STARTS, ANGLES)
    return Reading(f"{method}, {starts} starts, {angles} angles", best, missed, series, default, raw,
                   {"de00": de00, "evaluations": found["sets"][-1]["evaluations"]}, again=lambda: run.tool(*words)[1])


def study(run):
    angles = [reading(run, METHOD, METHOD, STARTS, n) for n in ((10, 40) if run.quick else (10, 20, 40, 80))]
    angles += [] if run.quick else [reading(run, "lm", "lm", STARTS, n) for n in (20, 40)]
    starts = [reading(run, method, method, n, ANGLES) for method in ("power-mean", "lm")
              for n in ((1, STARTS) if run.quick or method == "lm" else (1, 2, 4, STARTS, 12))]
    aim = "RMS error, largest + mean of a paint (L*)"
    figures = [Figure("basis-angles", f"{LOBES} lobes: error of the library against the time of finding them, "
                      "by the sample angles of a paint", angles, "time of fit-basis (s)", aim),
               Figure("basis-starts", "The same by the starts of the search", starts, "time of fit-basis (s)", aim, front=False,
                      note="There is no dashed line here: more starts are a precaution against a poor local minimum. That two "
                      "of them are enough for this library does not mean that they are enough for another one.")]
    rows = [(r.setting, r.time_s, r.numbers["evaluations"], r.error, r.numbers["de00"]) for r in angles + starts]
    return Study("Choosing a basis", f"fit-basis looks for {LOBES} exponents for the whole library; one of its settings is "
                 "varied at a time. The error is the figure that fit-basis minimizes, but computed from the least squares of "
                 "fit-paint, which do not depend on the sample angles. The mean dE00 in the table is that of the fits of least "
                 "color difference.",
                 figures, [("Angles, starts and method", ("settings", "time (s)", "evaluations", aim, "dE00 mean"), rows)])
