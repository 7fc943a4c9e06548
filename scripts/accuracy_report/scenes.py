"""Ten scenes: what the plan leaves out, whether that can be seen, and what it saves; and what it says each effect is worth."""

import functools
import math
import os
import pathlib

import numpy

from shared import pictures

from .study import Figure, Reading, Study

SIZE = ("--size", "480x270")

# Each scene has a paint, what the paint has beside its color, and a light: a lamp, or a probe that comes from testdata, is made
# here or, if there are measurements, is measured.
SCENES = (("signal_red", "fitted", "overcast"), ("signal_white", "fitted", "studio"), ("navy_blue", "fitted", "sun"),
          ("silver_black_flop", "fitted", "overcast"), ("candy_red", "fitted", "sunset"), ("candy_red", "fitted", "blue lamp"),
          ("blue_to_purple", "views", "studio"), ("cyan_to_violet", "views", "sunset"),
          ("silver_fine", "brushed", "orange lamp"), ("jet_black", "texture", "studio"))
LAMPS = {"blue lamp": "40,50,0.2,0.6,1", "orange lamp": "40,50,1,0.5,0.2"}  # values of --light
QUICK = (0, 4, 8)
LEAST = 0.01  # the least difference of the plot; nobody sees a smaller one

# Each effect, and the scene of the list above in which it matters.
MATTERS = {"diffuse": 0, "lobes": 3, "gloss": 3, "mirror": 2, "fresnel": 2, "coat": 2, "horizon": 3, "travel": 7, "operator": 4,
           "anisotropy": 8, "lights": 8}
WORDS = {"anisotropy": "brushed"}  # of --effects, where the plan has another
MEASURED = {"overcast": "uffizi.hdr", "studio": "studio_small_03_1k.hdr", "sunset": "venice_sunset_1k.hdr"}


def sky(zenith, horizon, ground, width=256):
    """The bytes of an EXR: a lat-long sky between two colors over ground of one color.

    At the elevation e, the share of the zenith's color is (1 + 2 sin e)/3, as in the overcast sky of the CIE.
    """
    rows = []
    for row in range(width // 2):
        up = pictures.direction(0.5, row + 0.5, width, width // 2)[1]
        share = (1 + 2 * up) / 3
        texel = tuple(share * z + (1 - share) * h for z, h in zip(zenith, horizon)) if up > 0 else ground
        rows.append([texel] * width)
    return pictures.exr_file(rows, numpy.float32, "an even sky between two colors")


MADE = {"overcast": ((1, 1, 1), (0.25, 0.25, 0.25), (0.2, 0.2, 0.2)),
        "sunset": ((0.2, 0.3, 0.6), (2.5, 0.9, 0.3), (0.15, 0.1, 0.06))}


class Stage:
    """The lights and paints of the scenes; each of them is made once."""

    def __init__(self, run, basis=None):
        self.run, self.lights = run, {}
        self.basis = ("--basis", basis or run.data / "b7.basis.xml")

    def paint(self, name, wears):
        """A paint, as a value of --paint: fitted, fitted for several views, or fitted and brushed."""
        path = self.run.work / f"{self.basis[1].stem}-{wears}.xml"
        if not path.exists() and wears == "brushed":
            fitted = pathlib.Path(self.paint(name, "fitted").partition("#")[0]).read_text()
            path.write_text(fitted.replace("<lobes ", '<anisotropy alphaX="0.1" alphaY="0.3"/><lobes '))
        elif not path.exists():
            views = ("--views", "0,30,45,60,75") if wears == "views" else ()
            self.run.tool("fit-paint", *self.basis, *views, self.run.data / "paints.paints.xml", "-o", path)
        return f"{path}#{name}"

    def probe(self, name):
        folder = os.environ.get("GONIOCHROME_DATA")
        if folder and name in MEASURED:
            return pathlib.Path(folder) / "probes" / MEASURED[name]
        if name in MADE:
            path = self.run.work / f"{name}.exr"
            path.write_bytes(sky(*MADE[name]))
            return path
        return self.run.data / {"studio": "studio.exr", "sun": "outdoor.exr"}[name]

    def light(self, name):
        if name in LAMPS:
            return ("--light", LAMPS[name])
        if name not in self.lights:
            source, env = self.probe(name), self.run.work / f"{self.basis[1].stem}-{name}.env.exr"
            self.run.tool("prefilter-envmap", source, *self.basis, "--verify", 0, "-o", env)
            self.lights[name] = ("--env", env, "--check-source", source)
        return self.lights[name]

    def words(self, scene, effects, *more):
        """The options with which render-osmesa draws a scene."""
        paint, wears, light = scene
        if wears == "texture":
            wears, more = "fitted", (*more, "--texture", f"Hood={self.run.data / 'nameplate.sbrdf.exr'}")
        return ("--mesh", self.run.mesh, *SIZE, "--effects", f"{effects},-rays", *self.light(light), "--paint", self.paint(paint, wears),
                *more, "-o", self.run.work / "picture.exr")

    def picture(self, scene, effects, *more):
        """The report of a scene that is drawn with these effects and checked."""
        return self.run.tool("render-osmesa", *self.words(scene, effects, *more), "--check", 40 if self.run.quick else 100)[0]

    def shading(self, *drawn):
        return self.run.shading(*self.words(*drawn))


def named(scene):
    return "{} ({}), {}".format(*scene)


def scene_readings(stage, scene):
    """(a row of the table, the readings of the scene as planned and with all effects)"""
    planned, full = stage.picture(scene, "auto"), stage.picture(scene, "all")
    gone = [row["effect"] for row in planned["plan"] if row["decision"] == "dropped"]
    left = planned["left_out"]
    readings = []
    for effects, results in (("auto", planned), ("all", full)):
        times = stage.run.timed(functools.partial(stage.shading, scene, effects), 1e-3 * results["left_out"]["shading_ms"])
        numbers = {"mean": results["error"]["de00_mean"], "to_all": results["left_out"]["de00_p95"],
                   "predicted": results["plan_de00_p95"]}
        readings.append(Reading(f"{named(scene)}, effects {effects}", error=results["error"]["de00_p95"], method=named(scene),
                                default=effects == "auto", **times, numbers=numbers))
    ms = [1e3 * reading.time_s for reading in readings]
    return (named(scene), " ".join(gone) or "nothing", planned["plan_de00_p95"], left["de00_p95"],
            planned["error"]["de00_p95"], full["error"]["de00_p95"], *ms, planned["plan_ms"]), readings


def effect_row(stage, effect, scene):
    without = stage.picture(scene, f"all,-{WORDS.get(effect, effect)}", "--explain")
    truth = [row["truth_de00_p95"] for row in without["plan"]
             if row["effect"] == effect and row.get("truth_de00_p95") is not None]
    return (effect, named(scene), without["plan_de00_p95"], without["left_out"]["de00_p95"], without["error"]["de00_p95"],
            truth[0] if truth else math.nan)


def study(run):
    stage = Stage(run)
    scenes, readings = [], []
    for i in QUICK if run.quick else range(len(SCENES)):
        row, pair = scene_readings(stage, SCENES[i])
        scenes.append(row)
        readings += pair
    effects = [effect_row(stage, effect, SCENES[i]) for effect, i in MATTERS.items() if not run.quick or i in QUICK]
    within = all(predicted / 2 < checked < 2 * predicted for _, _, predicted, _, checked, _ in effects)
    run.say(f"scenes: {sum(1 for r in scenes if r[3] <= 0.5)} of {len(scenes)} within the tolerance; "
            f"every effect {'' if within else 'NOT '}within a factor 2")
    figure = Figure("scenes", "As planned, and with all effects: dE00 to the exact integral against time", readings,
                    "time of shading every pixel once (s)", "dE00, 95 % of the pixels", apart=True,
                    y=lambda r: max(r.error, LEAST),
                    note="Each line is a scene; its left end is the picture as planned (--effects auto), its right end the "
                    f"picture with all effects. Errors below {LEAST} are drawn at {LEAST}.")
    return Study("Scenes", "The first table shows what --effects auto leaves out of ten scenes at a tolerance of 0.5 dE00, and "
                 "how far the picture then is from the picture with all effects and from the exact integral. The second table "
                 "shows, for every effect, what the plan says that it changes, and the error of the picture without it. All "
                 "differences are 95th percentiles of CIEDE2000; those to the exact integral are of random pixels, the others of "
                 "all pixels.",
                 [figure],
                 [("What is left out", ("scene", "left out", "predicted", "to all effects", "check, planned", "check, all",
                                        "shading (ms)", "all effects (ms)", "planning (ms)"), scenes),
                  ("Each effect forced off where it matters",
                   ("effect", "scene", "predicted", "to all effects", "check", "exact, alone"), effects)])
