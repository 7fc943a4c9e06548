"""One picture through all stages at chosen settings: what it costs, and how far it is from the exact one."""

import dataclasses

CAMERA = ("--size", "320x180", "--camera", "3.6,1.75,4.6,0,0.5,0.1", "--fov", "25")


@dataclasses.dataclass(frozen=True)
class Settings:
    """The knobs of the three stages."""

    basis: str  # of testdata: b5, b7
    method: str  # of fit-paint
    prefilter: float  # tolerance of prefilter-envmap
    effects: str  # tolerance of render-osmesa in dE00, or all, or none

    def __str__(self):
        effects = self.effects if self.effects in ("all", "none") else f"effects to {self.effects} dE00"
        return f"{self.basis}, {self.method}, prefilter {self.prefilter:g}, {effects}"


class Scene:
    """A paint on a mesh under a probe. Stages that two settings share run once and count for both."""

    def __init__(self, run, paint, probe=None, frame=CAMERA, checks=None):
        self.run, self.paint, self.probe = run, paint, probe or run.probe
        self.frame = frame
        self.checks = checks or (60 if run.quick else 200)
        self.fits, self.environments = {}, {}

    def fit(self, basis, method):
        if (basis, method) not in self.fits:
            out = self.run.work / f"{basis}-{method}.xml"
            results, seconds = self.run.tool("fit-paint", "--basis", self.run.data / f"{basis}.basis.xml", "--method", method, self.run.paints, "-o", out)
            of_paint = next(p for p in results["paints"] if p["name"] == self.paint)
            self.fits[basis, method] = out, of_paint["de00_mean"], seconds / len(results["paints"])
        return self.fits[basis, method]

    def environment(self, basis, tolerance):
        if (basis, tolerance) not in self.environments:
            out = self.run.work / f"{self.probe.stem}-{basis}-{tolerance:g}.env.exr"
            _, seconds = self.run.tool("prefilter-envmap", self.probe, "--basis", self.run.data / f"{basis}.basis.xml", "--tolerance", tolerance, "--verify", 0, "-o", out)
            self.environments[basis, tolerance] = out, seconds
        return self.environments[basis, tolerance]

    def picture(self, settings, *more):
        """Renders for the time and once more, with the reference integrator, for the error: a dict of seconds by stage,
        dE00 of fit and picture, and the plan."""
        fitted, fit_de00, fit_s = self.fit(settings.basis, settings.method)
        env, prefilter_s = self.environment(settings.basis, settings.prefilter)
        effects = ("--effects", settings.effects) if settings.effects in ("all", "none") else ("--tolerance", settings.effects)
        words = ("--mesh", self.run.mesh, "--paint", f"{fitted}#{self.paint}", "--env", env, *self.frame, *effects, *more, "-o", self.run.work / "picture.exr")
        timed = [self.run.tool("render-osmesa", *words) for _ in range(1 if self.run.quick else 3)]
        results, _ = self.run.tool("render-osmesa", *words, "--check", self.checks)
        error = results["error"]
        return {"fit_s": fit_s, "prefilter_s": prefilter_s, "render_s": min(s for _, s in timed), "fit_de00": fit_de00,
                "frame_ms": min(r["frame_ms"] for r, _ in timed),
                "render_de00": error["de00_mean"], "render_p95": error["de00_p95"], "plan": results.get("plan", [])}


def total_s(numbers):
    """Seconds of all stages for one picture."""
    return numbers["fit_s"] + numbers["prefilter_s"] + numbers["render_s"]


def total_de00(numbers):
    """Mean dE00 of the picture to the measured paint: at most what the fit and the picture are off together."""
    return numbers["fit_de00"] + numbers["render_de00"]
