"""Rendering: what the plan leaves out and what that costs in color, the engines, and the maps of textures and brushes."""

from shared.basis import basis_xml

from .scene import Scene, Settings
from .study import Figure, Reading, Study

PAINT = "silver_black_flop"
QUARTERS = (2.9296875, 11.71875, 46.875, 187.5, 750, 3000)  # These exponents let one cube hold all lobes in its levels.
DEFAULT = "0.5"
CHOICES = ("8", "2", DEFAULT, "all")  # values of --tolerance, and all as a value of --effects
TILTS = ("4", "16", "0.005", "0.001")  # the last but one is what --tilts takes by itself


def probed(scene, method, choice, *more, basis="b7", effects="", default=False):
    """A reading of a paint under the probe; `choice` is what varies, and without `effects` it is those."""
    settings = Settings(basis, "l1", False, 1e-3, effects or choice)
    numbers = scene.error(settings, *more)

    def shading():
        return 1e-3 * scene.error(settings, *more, checks=1)["shading_ms"]

    kept = sum(1 for row in numbers["plan"] if row["decision"] == "drawn")
    return Reading(f"{method}, {choice}", error=numbers["render_de00"], method=method, default=default,
                   **scene.run.timed(shading, 1e-3 * numbers["shading_ms"]),
                   numbers={"p95": numbers["render_p95"], "effects": kept})


def plain(run, paint):
    """Readings of a paint under the probe: every tolerance with each engine."""
    scene = Scene(run, paint)
    return [probed(scene, engine, choice, "--engine", engine, default=(engine, choice) == ("cpu", DEFAULT))
            for engine in ("gl", "cpu") for choice in CHOICES]


def textured(run):
    """Readings of a texture whose lobes look into a cube for each exponent, or into the levels of one cube."""
    basis = run.work / "quarters.basis.xml"
    basis.write_bytes(basis_xml("quarters", QUARTERS))
    scene = Scene(run, *run.named(["jet_black"]), mesh=run.data / "speed-shape.obj", basis=basis)
    texture = ("--texture", f"Hood={run.data / 'nameplate.sbrdf.exr'}")
    return [probed(scene, maps, choice, *texture, "--texture-maps", maps, basis="quarters",
                   default=(maps, choice) == ("cubes", DEFAULT))
            for maps in ("cubes", "mip") for choice in CHOICES[1:]]


class Brushed(Scene):
    """A scene whose paints are brushed."""

    def fit(self, settings):
        fitted, de00, seconds = super().fit(settings)
        path = self.run.work / "brushed.xml"
        path.write_text(fitted.read_text().replace("<lobes ", '<anisotropy alphaX="0.1" alphaY="0.3"/><lobes '))
        return path, de00, seconds


def brushed(run):
    """Readings of a brushed paint by the number of tilted normals that draw it, or their error."""
    scene = Brushed(run, *run.named(["silver_fine"]))
    return [probed(scene, "brushed, --tilts", tilts, "--tilts", tilts, effects=DEFAULT, default=tilts == "0.005")
            for tilts in TILTS]


def study(run):
    scenes = {paint: plain(run, paint) for paint in run.named([PAINT])}
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
