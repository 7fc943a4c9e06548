"""Choosing a basis: the starts and the method of fit-basis against the fits that its lobes allow, and the basis made by hand."""

from .fit import bases
from .page import number
from .study import Figure, Reading, Study

LOBES = 5
METHOD, STARTS = "power-mean", 6  # the defaults of fit-basis


def reading(run, method, starts):
    basis = run.work / "chosen.basis.xml"
    words = ("fit-basis", run.paints, "--lobes", LOBES, "--mirror", "yes", "--method", method, "--starts", starts, "-o", basis)
    found, best, raw = run.repeated(*words)
    fits, _ = run.tool("fit-paint", run.paints, "--basis", basis, "--method", "deltae", "-o", run.work / "fitted.xml")
    chosen = found["sets"][-1]
    return Reading(f"{method}, {starts} start{'s' * (starts > 1)}", best, chosen["objective"], method,
                   (method, starts) == (METHOD, STARTS), raw,
                   {"de00": fits["de00_mean"], "evaluations": chosen["evaluations"]}, again=lambda: run.tool(*words)[1])


def by_number(run):
    """Rows (basis, lobes, exponents, largest and mean error, mean dE00) of sets of each number and of the one made by hand."""
    files, sets = bases(run)
    for each in sets:
        fits, _ = run.tool("fit-paint", run.paints, "--basis", files[each["lobes"]], "-o", run.work / "fitted.xml")
        yield ("found", each["lobes"], " ".join(map(number, each["exponents"])), each["max_error"], each["mean_error"],
               fits["de00_mean"])
    fits, _ = run.tool("fit-paint", run.paints, "--basis", run.data / "b7.basis.xml", "-o", run.work / "fitted.xml")
    yield "by hand (b7)", 7, "1.3 6 20 70 250 900 3000", float("nan"), float("nan"), fits["de00_mean"]


def study(run):
    starts = [reading(run, method, n) for method in ("power-mean", "lm")
              for n in (1, STARTS)]
    aim = "RMS error, largest + mean of a paint (L*)"
    figures = [Figure("basis-starts", f"{LOBES} lobes: error of the library against the time of finding them, by the starts",
                      starts, "time of fit-basis (s)", aim, front=False,
                      note="There is no dashed line here: more starts are a precaution against a poor local minimum. That one "
                      "is enough for this library does not mean that they are enough for another one.")]
    rows = [(r.setting, r.time_s, r.numbers["evaluations"], r.error, r.numbers["de00"]) for r in starts]
    return Study("Choosing a basis", f"fit-basis looks for {LOBES} exponents for the whole library; one of its settings is "
                 "varied at a time. Its error is the figure that fit-basis minimizes, beyond the floor of each paint. The mean "
                 "dE00 is that of the fits of least color difference in the first table, which varies the settings, and that "
                 "of fit-paint by its defaults in the second, which has every number of lobes.",
                 figures, [("Starts and method", ("settings", "time (s)", "evaluations", aim, "dE00 mean"), rows),
                           ("Numbers of lobes", ("basis", "lobes", "exponents", "largest error", "mean error", "dE00 mean"),
                            list(by_number(run)))])
