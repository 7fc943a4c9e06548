"""What the mesh does to light, in ten scenes: what the plan says that each effect is worth and costs, and what is true."""

import os
import pathlib

from shared.sphere import sphere_obj

from .study import Figure, Reading, Study

SIZE = ("--size", "160x90", "--samples", "1")
PAINT = "silver_fine"
EFFECTS = ("shadow", "self", "bounce")
# The studio is that of --probe. A mesh that is measured is left out where there are no measurements.
LIGHTS = {"studio": ("studio",), "outdoor": ("outdoor",), "lamp": ("lamp",), "studio and lamp": ("studio", "lamp")}
SCENES = (("ball", "studio"), ("ball", "lamp"), ("speed shape", "studio"), ("speed shape", "outdoor"), ("speed shape", "lamp"),
          ("speed shape", "studio and lamp"), ("box", "studio"), ("box", "outdoor"), ("box", "lamp"), ("box", "studio and lamp"))
MEASURED = {"vehicle": "vehicle.obj", "teapot": "teapot.obj"}
QUICK = (0, 4)
FACTOR, UNSEEN = 1.3, 0.1  # A prediction is true within the factor, or within what nobody sees.


class Stage:
    """The meshes, the light and the paint of the scenes."""

    def __init__(self, run):
        self.run = run
        basis = run.data / "b5.basis.xml"
        self.fitted = run.work / "rays.xml"
        run.tool("fit-paint", "--basis", basis, run.paints, "-o", self.fitted)
        self.paint = f"{self.fitted}#{run.named([PAINT])[0]}"
        self.env = {}
        for name, image in (("studio", run.probe), ("outdoor", run.data / "outdoor.exr")):
            self.env[name] = run.work / f"rays-{name}.env.exr"
            run.tool("prefilter-envmap", image, "--basis", basis, "--verify", 0, "-o", self.env[name])
        ball = run.work / "rays-ball.obj"
        ball.write_text(sphere_obj(32))
        self.meshes = {"ball": ball, "speed shape": run.mesh, "box": run.data / "box.obj"}
        measured = os.environ.get("GONIOCHROME_DATA")
        for name, file in MEASURED.items() if measured else ():
            path = pathlib.Path(measured) / "mesh" / file
            if path.exists():
                self.meshes[name] = path.resolve()

    def scenes(self):
        if self.run.quick:
            return [SCENES[i] for i in QUICK]
        return [*SCENES, *((mesh, light) for mesh in self.meshes if mesh in MEASURED for light in LIGHTS)]

    def words(self, mesh, light):
        words = ["--mesh", self.meshes[mesh], "--paint", self.paint, *SIZE, "-o", self.run.work / "rays.exr"]
        for name in LIGHTS[light]:
            words += ["--light", "40,50"] if name == "lamp" else ["--env", self.env[name]]
        return words


def holds(predicted, true):
    return abs(predicted - true) <= UNSEEN or true / FACTOR <= predicted <= true * FACTOR


def figures(stage, mesh, light):
    """(the results of a scene as it is drawn by default and checked, the seconds of it and of the same without rays)"""
    words = stage.words(mesh, light)
    checked, _ = stage.run.tool("render-osmesa", *words, "--check", "300,truth")
    drawn, with_s, _ = stage.run.repeated("render-osmesa", *words)
    _, without_s, _ = stage.run.repeated("render-osmesa", *words, "--effects", "auto,-rays")
    return checked, drawn, with_s, without_s


def study(run):
    stage = Stage(run)
    rows, costs, readings = [], [], []
    for mesh, light in stage.scenes():
        checked, drawn, with_s, without_s = figures(stage, mesh, light)
        plan = {row["effect"]: row for row in checked["plan"]}
        for effect in EFFECTS:
            predicted, true = plan[effect]["de00_p95"] or 0, checked["error"]["worth"][effect]
            rows.append((mesh, light, effect, predicted, true, "yes" if holds(predicted, true) else "no",
                         plan[effect]["decision"]))
            readings.append(Reading(f"{mesh}, {light}: {effect}", with_s, predicted, method=effect, numbers={"true": true}))
        rays = drawn.get("rays") or {}
        costs.append((mesh, light, checked["error"]["de00_p95"], rays.get("noise_de00_p95", 0), rays.get("samples", 0),
                      checked["plan_ms"], with_s, without_s))
    run.say(f"rays: {sum(1 for r in rows if r[5] == 'yes')} of {len(rows)} findings within a factor {FACTOR} or {UNSEEN} dE00")
    figure = Figure("rays", "What effects of rays change: the first pass against the truth", readings, "true change (dE00)",
                    "change by the first pass (dE00)", front=False, joined=False, x=lambda r: max(r.numbers["true"], 0.01),
                    y=lambda r: max(r.error, 0.01), note="Figures below 0.01 are drawn at 0.01.")
    return Study("Effects of rays", "The first table has, for each effect of rays, what the first pass of the picture finds that "
                 "it changes, and what it changes in path traced truth at random pixels: 95th percentiles of CIEDE2000. The "
                 "second has the error that the check finds, and what drawing with these effects costs: samples of a point, and "
                 "the processor time of the whole tool with rays and without.", [figure],
                 [("What they change", ("mesh", "light", "effect", "first pass", "true", "within", "decision"), rows),
                  ("Cost", ("mesh", "light", "checked", "noise", "samples", "planning (ms)", "with (s)", "without (s)"), costs)])
