"""Paints with a color map in image light: sets of tilted lobes against the integral of the map, and what the plan takes."""

import os
import pathlib

from shared.sphere import sphere_obj

from .study import Figure, Reading, Study

LOOKUPS = "8,16,32,64"
SIZES = {"sphere": "320x320", "vehicle": "640x360", "shape": "320x180"}
# Probes that are made with the test data, and measured ones.
LIGHTS = {"studio": "studio.exr", "sky": "outdoor.exr"}
MEASURED = {"studio, measured": "studio_small_03_1k.hdr", "sky, measured": "rooitou_park_1k.hdr"}
PLANNED = (1.5, 0.8)  # tolerances that the plan is given
SAMPLES = 7  # beside the first one, over which the time of a frame is taken


class Stage:
    """The paints, meshes and lights; each of them is made once."""

    def __init__(self, run):
        self.run, self.basis = run, run.data / "b7.basis.xml"
        folder = os.environ.get("GONIOCHROME_DATA")
        self.shared = pathlib.Path(folder) if folder else None
        self.paints, self.lights = {}, {}
        self.fit(run.data / "travel.paints.xml", "films")
        cayman = self.shared / "brdf/cornell/cayman.brdf" if self.shared else None
        if cayman and cayman.is_file() and not run.quick:
            self.fit(cayman, "cayman")
        sphere = run.work / "sphere.obj"
        sphere.write_text(sphere_obj(96))
        self.meshes = {"sphere": sphere}
        vehicle = self.shared / "mesh/vehicle.obj" if self.shared else None
        if vehicle and vehicle.is_file():
            self.meshes["vehicle"] = vehicle
        else:
            self.meshes["shape"] = run.mesh

    def fit(self, source, name):
        path = self.run.work / f"{name}.xml"
        results, _ = self.run.tool("fit-paint", "--basis", self.basis, source, "-o", path, "--color-map", self.run.work,
                                   "--tilts", LOOKUPS)
        for paint in results["tilts"]:
            self.paints[paint["name"]] = (f"{path}#{paint['name']}", [each["lookups"] for each in paint["sets"]])

    def probes(self):
        """{name: file}"""
        found = {name: self.run.data / file for name, file in LIGHTS.items()}
        if self.shared and not self.run.quick:
            measured = {name: self.shared / "probes" / file for name, file in MEASURED.items()}
            found = {name: path for name, path in measured.items() if path.is_file()} or found
        return found

    def light(self, name, source):
        if name not in self.lights:
            env = self.run.work / f"interference-{len(self.lights)}.env.exr"
            self.run.tool("prefilter-envmap", source, "--basis", self.basis, "--verify", 0, "-o", env)
            self.lights[name] = ("--env", env, "--check-source", source)
        return self.lights[name]


class View:
    """A paint on a mesh in a light, drawn with any effects."""

    def __init__(self, stage, paint, mesh, light):
        self.run = stage.run
        self.words = ("--mesh", stage.meshes[mesh], "--paint", stage.paints[paint][0], *light, "--size", SIZES[mesh],
                      "--engine", "cpu", "-o", self.run.work / "picture.exr")

    def drawn(self, effects, *more):
        return self.run.tool("render-osmesa", *self.words, "--effects", *effects, *more)

    def checked(self, effects):
        checks = 40 if self.run.quick else 80
        return self.drawn(effects, "--samples", 1, "--check", f"{checks},model")[0]

    def seconds(self, effects):
        """The processor time of a picture with one sample of each pixel, and with SAMPLES more."""
        return tuple(self.drawn(effects, "--samples", n)[1] for n in (1, 1 + SAMPLES))


def frame_s(pairs):
    """The processor time of a frame of one sample, without what a picture takes only once, from the least of each kind."""
    few, many = (min(times) for times in zip(*pairs))
    return max((many - few) / SAMPLES, 1e-6)


def only_to(level, sets):
    """The effects with the first `level` sets of so many."""
    return ",".join(("all", "-rays", *(f"-travel-{k + 1}" for k in range(level, sets))))


def reading(name, results, pairs, numbers):
    return Reading(name, error=results["error"]["de00_mean"], method=numbers["scene"], time_s=frame_s(pairs),
                   raw_s=tuple(frame_s([pair]) for pair in pairs), numbers=numbers | {"p95": results["error"]["de00_p95"]})


def readings_of(run, stage, scene, light):
    paint, mesh, probe = scene
    sets = stage.paints[paint][1]
    view = View(stage, paint, mesh, light)
    drawings = {"lobes" if level == 0 else f"{sets[level - 1]} look-ups": (only_to(level, len(sets)),)
                for level in range(len(sets) + 1)}
    drawings |= {f"planned for {de00:g}": ("auto,-rays", "--tolerance", de00) for de00 in PLANNED}
    checked = {name: view.checked(effects) for name, effects in drawings.items()}
    pairs = {name: [] for name in drawings}
    for _ in range(run.repeats):  # in turn, since the machine may have other work
        for name, effects in drawings.items():
            pairs[name].append(view.seconds(effects))
    for name in drawings:
        taken = [row["effect"] for row in checked[name]["plan"]
                 if row["decision"] == "drawn" and row["effect"].startswith("tilts-")]
        yield reading(name, checked[name], pairs[name],
                      {"scene": ", ".join((paint, mesh, probe)), "taken": sets[len(taken) - 1] if taken else 0,
                       "times_lobes": frame_s(pairs[name]) / frame_s(pairs["lobes"])})


def study(run):
    stage = Stage(run)
    readings = []
    for paint in stage.paints:
        for mesh in list(stage.meshes)[: 1 if run.quick or paint != next(iter(stage.paints)) else None]:
            for probe, source in stage.probes().items():
                readings += readings_of(run, stage, (paint, mesh, probe), stage.light(probe, source))
    scenes = dict.fromkeys(r.numbers["scene"] for r in readings)

    def best(most_times):
        """The reading of each scene that errs least within so many times the frame time of its lobes."""
        for scene in scenes:
            usable = [r for r in readings if r.numbers["scene"] == scene and r.numbers["times_lobes"] <= most_times
                      and not r.setting.startswith("planned")]
            yield min(usable, key=lambda r: r.error)

    two, four = list(best(2)), list(best(4))
    run.say(f"interference: {sum(r.error <= 1.5 and r.numbers['p95'] <= 5 for r in two)} of {len(two)} within a mean of 1.5 and "
            f"5 for 95 % at twice the time of the lobes, {sum(r.error <= 0.8 for r in four)} within a mean of 0.8 at four times")
    rows = [(*r.numbers["scene"].split(", ", 2), r.setting, r.numbers["taken"], 1e3 * r.time_s, r.numbers["times_lobes"], r.error,
             r.numbers["p95"]) for r in readings]
    figure = Figure("interference", "Tilted lobes: mean dE00 to the integral of the color map against time",
                    [r for r in readings if not r.setting.startswith("planned")], "processor time of a frame (s)", "dE00, mean",
                    apart=True, note="Each line is a scene. From top to bottom: lobes alone, and sets of more and more look-ups.")
    return Study("Interference paints in image light",
                 "Paints whose color turns with the angle of the viewer, drawn from prefiltered maps by their lobes alone, by each "
                 "set of tilted lobes, and as the plan chooses for a tolerance. Errors are those of random visible pixels against "
                 "the integral of the paint's color map over the whole environment. Times are the processor time of a frame of one "
                 f"sample, from the mean of {SAMPLES}, by the least of several runs in turn, and are also told as multiples of the "
                 "time with lobes alone.", [figure],
                 [("Sets of tilted lobes",
                   ("paint", "mesh", "light", "drawn with", "look-ups taken", "frame (ms)", "times the lobes", "dE00 mean", "95 %"),
                   rows)])
