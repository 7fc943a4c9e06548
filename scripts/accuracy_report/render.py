"""Rendering: what the plan leaves out against what that is worth, and the two engines."""

from .scene import Scene, Settings
from .study import Figure, Reading, Study

REPEATS = 4
PAINTS = ("signal_red", "silver_black_flop", "blue_to_purple")


def study(run):
    effects = ("none", "2", "0.5", "all") if run.quick else ("none", "5", "2", "1", "0.5", "0.2", "0.1", "all")
    figures, rows = [], []
    for paint in run.named(PAINTS[:1] if run.quick else PAINTS):
        scene = Scene(run, paint)
        readings = []
        for engine in ("gl", "cpu"):
            for choice in effects:
                settings = Settings("b7", "l1", False, 1e-3, choice)
                numbers = scene.error(settings, "--engine", engine)
                shading_s = [1e-3 * ms for ms in (numbers["shading_ms"], *(scene.error(settings, "--engine", engine, checks=1)["shading_ms"] for _ in range(REPEATS)))]
                kept = sum(1 for row in numbers["plan"] if row["decision"] == "drawn")
                readings.append(Reading(setting=f"{engine}, {choice}", time_s=min(shading_s), error=numbers["render_de00"], method=engine, default=(engine, choice) == ("cpu", "0.5"),
                                        raw_s=tuple(shading_s), numbers={"p95": numbers["render_p95"], "effects": kept}))
                rows.append((paint, engine, choice, kept, 1e3 * min(shading_s), numbers["render_de00"], numbers["render_p95"]))
        figures.append(Figure(f"render-{paint}", f"{paint}: mean dE00 to the reference integrator against time", readings, "time of shading every pixel once (s)", "dE00, mean"))
    return Study("Rendering", "Each point is a tolerance of render-osmesa: effects whose estimated worth stays below it are left out. "
                 "The time is that of shading every pixel once, which is all that effects change; the error is that of random visible pixels against the exact lobe model under the whole environment.", figures,
                 [("What is left out, and what that costs", ("paint", "engine", "effects", "drawn", "shading (ms)", "dE00 mean", "p95"), rows)])
