"""Rendering: what the plan leaves out and what that costs in color, the engines, and the maps of textures and brushes."""

import functools

from shared.basis import basis_xml

from .scene import Scene, Settings
from .scenes import Stage
from .study import Figure, Reading, Study

PAINTS = ("silver_black_flop", "blue_to_purple")
QUARTERS = (2.9296875, 11.71875, 46.875, 187.5, 750, 3000)  # These exponents let one cube hold all lobes in its levels.
DEFAULT = "0.5"
TILTS = ("4", "8", "16", "32", "0.005", "0.001")  # the last but one is what --tilts takes by itself


def choices(run):
    """The settings that are tried: a value of --tolerance, or none or all as a value of --effects."""
    return ("none", "2", "0.5", "all") if run.quick else ("none", "2", "0.5", "0.1", "all")


def words(choice):
    return (choice,) if choice in ("none", "all") else ("auto", "--tolerance", choice)


def reading(run, method, choice, numbers, shading, default):
    """A reading of what a check found; `shading` is a function that measures the seconds of shading once more."""
    kept = sum(1 for row in numbers["plan"] if row["decision"] == "drawn")
    return Reading(f"{method}, {choice}", error=numbers["render_de00"], method=method, default=default,
                   **run.timed(shading, 1e-3 * numbers["shading_ms"]), numbers={"p95": numbers["render_p95"], "effects": kept})


def probed(scene, method, choice, *more, default=False):
    """A reading of a paint under the probe."""
    settings = Settings("b7", "l1", False, 1e-3, choice)
    numbers = scene.error(settings, *more)

    def shading():
        return 1e-3 * scene.error(settings, *more, checks=1)["shading_ms"]

    return reading(scene.run, method, choice, numbers, shading, default)


def plain(run, paint):
    """Readings of a paint under the probe: every tolerance with each engine."""
    scene = Scene(run, paint)
    return [probed(scene, engine, choice, "--engine", engine, default=(engine, choice) == ("cpu", DEFAULT))
            for engine in ("gl", "cpu") for choice in choices(run)]


def staged(run, stage, drawn, method, choice, default):
    """A reading of a scene of the study of ten scenes, by the words that it is drawn with."""
    results = stage.picture(*drawn)
    error = results["error"]
    numbers = {"render_de00": error["de00_mean"], "render_p95": error["de00_p95"], "plan": results["plan"],
               "shading_ms": results["left_out"]["shading_ms"]}
    return reading(run, method, choice, numbers, functools.partial(stage.shading, *drawn), default)


def textured(run):
    """Readings of a texture whose lobes look into a cube for each exponent, or into the levels of one cube."""
    basis = run.work / "quarters.basis.xml"
    basis.write_bytes(basis_xml("quarters", QUARTERS))
    stage, scene = Stage(run, basis), ("jet_black", "texture", "studio")
    return [staged(run, stage, (scene, *words(choice), "--texture-maps", maps), maps, choice, (maps, choice) == ("cubes", DEFAULT))
            for maps in ("cubes", "mip") for choice in ("none", "2", DEFAULT, "0.1", "all")]


def brushed(run):
    """Readings of a brushed paint by the number of tilted normals that draw it, or their error."""
    stage, scene = Stage(run), ("silver_fine", "brushed", "studio")
    return [staged(run, stage, (scene, "auto", "--tilts", tilts), "brushed", tilts, tilts == "0.005") for tilts in TILTS]


def study(run):
    scenes = {paint: plain(run, paint) for paint in run.named(PAINTS[:1] if run.quick else PAINTS)}
    if not run.quick:
        scenes["jet_black with a texture"] = textured(run)
        scenes["silver_fine, brushed"] = brushed(run)
    figures, rows = [], []
    for name, readings in scenes.items():
        figures.append(Figure(f"render-{name.split(',')[0].split(' ')[0]}",
                              f"{name}: mean dE00 to the reference integrator against time", readings,
                              "time of shading every pixel once (s)", "dE00, mean"))
        rows += [(name, r.setting, r.numbers["effects"], 1e3 * r.time_s, r.error, r.numbers["p95"]) for r in readings]
    return Study("Rendering", "Each point is a tolerance of render-osmesa, which leaves out the lobes and look-ups that change "
                 "less. The time is that of shading every pixel once, since effects change nothing else; the error is that of "
                 "random visible pixels against the exact lobe model under the whole environment. The texture looks into a cube "
                 "for each exponent or into the levels of one cube (--texture-maps). The brushed paint is "
                 "drawn about so many tilted normals, or as many as an error asks for (--tilts).", figures,
                 [("What is left out, and what that costs",
                   ("scene", "method, effects to dE00", "drawn", "shading (ms)", "dE00 mean", "95 %"), rows)])
