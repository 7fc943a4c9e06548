"""Paints with a color map in image light: sets of tilted lobes against the integral of the map."""

from shared.sphere import sphere_obj

from .study import Figure, Reading, Study

LOOKUPS = "8,16,32,64"
LIGHTS = ("studio", "outdoor")  # probes of testdata


def readings_of(run, name, sets, words):
    """The readings of a paint under a light: by its lobes alone, and by its sets of tilted lobes."""
    for level in range(len(sets) + 1):
        left_out = (f"-travel-{k + 1}" for k in range(level, len(sets)))
        drawn = (*words, "--effects", ",".join(("all", "-rays", *left_out)))
        checks = "40,model" if run.quick else "80,model"
        error = run.tool("render-osmesa", *drawn, "--samples", 1, "--check", checks)[0]["error"]
        _, best, raw = run.repeated("render-osmesa", *drawn, "--samples", 16)
        setting = f"{sets[level - 1]} look-ups" if level else "lobes alone"
        yield Reading(f"{name}, {setting}", best, error["de00_mean"], name, raw_s=raw, numbers={"p95": error["de00_p95"]})


def study(run):
    basis, fitted, sphere = run.data / "b7.basis.xml", run.work / "films.xml", run.work / "interference.obj"
    sphere.write_text(sphere_obj(96))
    paints = f"{run.data / 'travel.paints.xml'}{'#film_gold_teal' if run.quick else ''}"
    found, _ = run.tool("fit-paint", "--basis", basis, paints, "-o", fitted, "--color-map", run.work, "--tilts", LOOKUPS)
    readings, rows = [], []
    for light in LIGHTS[: 1 if run.quick else None]:
        source, env = run.data / f"{light}.exr", run.work / f"interference-{light}.env.exr"
        run.tool("prefilter-envmap", source, "--basis", basis, "--verify", 0, "-o", env)
        for paint in found["tilts"]:
            words = ("--mesh", sphere, "--paint", f"{fitted}#{paint['name']}", "--env", env, "--check-source", source,
                     "--size", "320x320", "--engine", "cpu", "-o", run.work / "picture.exr")
            some = list(readings_of(run, f"{paint['name']}, {light}", [each["lookups"] for each in paint["sets"]], words))
            rows += [(r.setting, r.time_s, r.time_s / some[0].time_s, r.error, r.numbers["p95"]) for r in some]
            readings += some
    figure = Figure("interference", "Tilted lobes: mean dE00 to the integral of the color map against time", readings,
                    "time of a picture of 16 samples (s)", "dE00, mean", apart=True,
                    note="Each line is a paint under a light. From top to bottom: lobes alone, and sets of more look-ups.")
    return Study("Interference paints in image light",
                 "Paints whose color turns with the angle of the viewer, drawn on a sphere from prefiltered maps by their lobes "
                 "alone and by each set of tilted lobes (fit-paint --tilts). Errors are those of random visible pixels against "
                 "the integral of the paint's color map over the whole environment.", [figure],
                 [("Sets of tilted lobes",
                   ("paint, light, drawn with", "16 samples (s)", "times the lobes", "dE00 mean", "95 %"), rows)])
