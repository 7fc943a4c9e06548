"""The whole chain from measured paint and HDR light to a picture: the settings of all stages together."""

import itertools

from .scene import Scene, Settings, total_de00, total_s
from .study import Figure, Reading, Study

PAINT = "silver_black_flop"
TARGETS = (2, 1, 0.5, 0.2, 0.1)


def ladder(quick):
    """The settings that are tried."""
    bases, effects = (("b5",), ("2", "0.5")) if quick else (("b5", "b7"), ("2", "0.5", "all"))
    fits = (("l1", True),) if quick else (("l1", True), ("deltae", True))
    integrals = ("integral 0.5",) if quick else ("integral 2", "integral 0.5", "integral 0.1")
    every = [Settings(b, *f, 1e-1, e) for e, b, f in itertools.product(effects, bases, fits)]
    every += [Settings(bases[-1], "l1", False, 1e-1, "0.5"), Settings(bases[-1], *fits[-1], 1e-3, "0.5")]
    return every + [Settings("b5", *fits[-1], 1e-1, e) for e in integrals]


def study(run):
    paint, = run.named([PAINT])
    scene = Scene(run, paint, checks=40 if run.quick else 100)
    readings = []
    for settings in ladder(run.quick):
        numbers = scene.picture(settings)
        before_s = numbers["fit_s"] + numbers["prefilter_s"]
        method = "integral" if settings.integral() else f"effects: {settings.effects}"
        kept = {k: v for k, v in numbers.items() if k not in ("plan", "all_render_s")}
        readings.append(Reading(setting=str(settings), raw_s=tuple(before_s + s for s in numbers["all_render_s"]),
                                time_s=total_s(numbers), error=total_de00(numbers), method=method, numbers=kept))
    figure = Figure("chain", f"{paint}: dE00 of the picture against the time of all stages", readings,
                    "time of all stages (s)", "dE00, mean", joined=False)
    best = min(readings, key=lambda r: r.error)
    rows = []
    for target in TARGETS:
        meeting = sorted((r for r in readings if r.error <= target), key=lambda r: r.time_s)
        rows.append((target, meeting[0].setting, meeting[0].time_s, meeting[0].error) if meeting else
                    (target, "not reached; the best settings are " + best.setting, best.time_s, best.error))
    parts = [(r.setting, r.numbers["fit_de00"], r.numbers["render_de00"],
              r.numbers["fit_s"] * 1e3, r.numbers["prefilter_s"], r.numbers["render_s"]) for r in figure.pareto()]
    text = ("The error of a picture is at most the sum of two errors: that of the fit to the measured colors, and that of the "
            "picture to the fitted paint under the whole environment. Times are processor time of all stages; the effects of a "
            "frame take little of it, compared with reading the mesh. Most of the error of a fit comes from readings that differ "
            "on the two sides of specular, and weights for several views (fit-paint --views auto) take it away. Finer maps soon "
            "change nothing: the error that is left comes from light that changes unevenly within the part of a broad lobe above "
            "the horizon, which a map that depends on one direction cannot represent. render-osmesa --engine integral uses no "
            "maps and reaches any error.")
    return Study("The whole chain", text,
                 [figure], [("For a mean dE00 of", ("at most", "use", "time (s)", "dE00"), rows),
                            ("Where the error and the time of the best settings come from",
                             ("settings", "dE00 of the fit", "dE00 of the picture", "fit (ms)", "prefilter (s)", "render (s)"),
                             parts)])
