"""The whole chain: measured paint and HDR light to a picture, every stage's knob at once."""

import itertools

from .scene import Scene, Settings, total_de00, total_s
from .study import Figure, Reading, Study

TARGETS = (5, 2, 1, 0.5, 0.1)


def ladder(quick):
    """The settings looked at, about in the order of their cost."""
    bases, methods = (("b5", "b7"), ("l1",)) if quick else (("b5", "b7"), ("l2", "l1", "deltae"))
    tolerances, effects = ((1e-1, 1e-3), ("none", "0.5")) if quick else ((1e-1, 1e-2, 1e-3), ("none", "0.5", "all"))
    return [Settings(b, m, t, e) for t, e, b, m in itertools.product(tolerances, effects, bases, methods)]


def study(run):
    scene = Scene(run, "silver_black_flop")
    readings = []
    for settings in ladder(run.quick):
        numbers = scene.picture(settings)
        readings.append(Reading(setting=str(settings), time_s=total_s(numbers), error=total_de00(numbers), method=f"effects {settings.effects}",
                                numbers={k: v for k, v in numbers.items() if k != "plan"}))
    figure = Figure("chain", "silver_black_flop: dE00 of the picture against the time of all stages", readings, "time of all stages (s)", "dE00, mean")
    rows = []
    for target in TARGETS:
        meeting = sorted((r for r in readings if r.error <= target), key=lambda r: r.time_s)
        rows.append((target, meeting[0].setting, meeting[0].time_s, meeting[0].error) if meeting else
                    (target, f"not reached: the best is {min(r.error for r in readings):.2g}", float("nan"), float("nan")))
    parts = [(r.setting, r.numbers["fit_de00"], r.numbers["render_de00"], r.numbers["fit_s"] * 1e3, r.numbers["prefilter_s"], r.numbers["render_s"])
             for r in figure.pareto()]
    return Study("The whole chain", "The error of a picture is at most the sum of what the fit misses of the measured colors and what the picture misses of the fitted paint.",
                 [figure], [("For a mean dE00 of", ("at most", "use", "time (s)", "dE00"), rows),
                            ("Where the error and the time of the best settings come from", ("settings", "dE00 of the fit", "dE00 of the picture", "fit (ms)", "prefilter (s)", "render (s)"), parts)])
