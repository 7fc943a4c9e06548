"""A picture that goes through all stages at chosen settings: what it costs, and how far it is from the exact picture."""

import dataclasses

from shared.basis import basis_xml
from shared.tools import Failed

# Bases beside those of testdata. What a picture misses most is light that changes across the part of a lobe above the horizon.
# Lobes that are narrower than the flop of a paint reach less below the horizon, so that they miss less of it; fitting for several
# views takes up what the fit then lacks.
STEEP = {"steep": (4, 15, 60, 300, 1500)}

CAMERA = ("--size", "320x180", "--samples", "1", "--camera", "3.6,1.75,4.6,0,0.5,0.1,25")


@dataclasses.dataclass(frozen=True)
class Settings:
    """The knobs of the three stages."""

    basis: str  # b5 or b7 of testdata, or one of STEEP
    method: str  # the method of fit-paint
    views: bool  # whether paints whose readings call for it are fitted for several angles of the viewer
    prefilter: float  # the tolerance of prefilter-envmap
    effects: str  # the tolerance of render-osmesa in dE00, or all, or none; "integral X" sums the probe itself, to X dE00

    def fit_words(self):
        return ("--method", self.method, *(("--views", "auto") if self.views else ()))

    def integral(self):
        """The tolerance of the integral, or an empty text if maps are looked up instead."""
        engine, _, tolerance = self.effects.partition(" ")
        return tolerance if engine == "integral" else ""

    # Chains, maps and effects of open light are studied without what the mesh does to light, which has studies of its own.
    def render_words(self):
        if self.integral():
            return ("--engine", "integral", "--tolerance", self.integral(), "--effects", "auto,-rays")
        if self.effects in ("all", "none"):
            return ("--effects", f"{self.effects},-rays")
        return ("--tolerance", self.effects, "--effects", "auto,-rays")

    def __str__(self):
        limit = self.integral()
        if self.effects in ("all", "none"):
            effects = self.effects
        else:
            effects = f"integral to {limit} dE00" if limit else f"effects to {self.effects} dE00"
        return f"{self.basis}, {self.method}{', views' if self.views else ''}, prefilter {self.prefilter:g}, {effects}"

    def commands(self):
        """The commands of these settings, without the files that go in and out."""
        return (f"fit-paint --basis {self.basis}.basis.xml {' '.join(self.fit_words())}",
                f"prefilter-envmap --basis {self.basis}.basis.xml --tolerance {self.prefilter:g}",
                f"render-osmesa {' '.join(self.render_words())}")


class Scene:
    """A paint on a mesh under a probe.

    A stage that several settings share runs once for all scenes of a run; its time counts for each of them.
    """

    def __init__(self, run, paint, probe=None, frame=CAMERA, checks=40, *, mesh=None, basis=None, fitting=()):
        self.run, self.paint, self.probe = run, paint, probe or run.probe
        self.mesh, self.frame, self.checks = mesh or run.mesh, frame, checks
        self.basis = basis  # the file of the only basis, instead of those that Settings name
        self.fitting = fitting  # more words for fit-paint

    def basis_file(self, settings):
        if self.basis:
            return self.basis
        if settings.basis not in STEEP:
            return self.run.data / f"{settings.basis}.basis.xml"
        path = self.run.work / f"{settings.basis}.basis.xml"
        path.write_bytes(basis_xml(settings.basis, STEEP[settings.basis]))
        return path

    def fit(self, settings):
        """(the fitted library, the mean dE00 of the paint at its readings, the seconds for one paint)"""
        key = (settings.basis, *settings.fit_words(), *self.fitting)
        if key not in self.run.kept:
            out = self.run.work / f"{'-'.join(key)}.xml"
            words = ("--basis", self.basis_file(settings), *settings.fit_words(), *self.fitting, self.run.paints, "-o", out)
            results, seconds, _ = self.run.repeated("fit-paint", *words)
            self.run.kept[key] = out, {p["name"]: p["de00_mean"] for p in results["paints"]}, seconds / len(results["paints"])
        out, de00, seconds = self.run.kept[key]
        if de00.get(self.paint) is None:
            raise Failed(f"{self.run.paints}: there is no paint {self.paint} that can be fitted")
        return out, de00[self.paint], seconds

    def environment(self, settings):
        """(the prefiltered probe, the seconds that this took)"""
        key = (self.probe, settings.basis, settings.prefilter)
        if key not in self.run.kept:
            out = self.run.work / f"{len(self.run.kept)}-{self.probe.stem}.env.exr"  # Probes of two folders may share a name.
            words = ("--basis", self.basis_file(settings), "--tolerance", settings.prefilter, "--verify", 0, "-o", out)
            _, seconds, _ = self.run.repeated("prefilter-envmap", self.probe, *words)
            self.run.kept[key] = out, seconds
        return self.run.kept[key]

    def words(self, settings):
        fitted, env = self.fit(settings)[0], self.environment(settings)[0]
        return ("--mesh", self.mesh, "--paint", f"{fitted}#{self.paint}", "--env", env, *self.frame, *settings.render_words(),
                "-o", self.run.work / "picture.exr")

    def cost(self, settings, *more):
        """The seconds of each stage, every repetition of the last one, and the least milliseconds of a frame."""
        frames, seconds = [], []
        for _ in range(self.run.repeats):
            results, taken = self.run.tool("render-osmesa", *self.words(settings), *more)
            frames.append(results["frame_ms"])
            seconds.append(taken)
        return {"fit_s": self.fit(settings)[2], "prefilter_s": self.environment(settings)[1], "render_s": min(seconds),
                "frame_ms": min(frames), "all_render_s": tuple(seconds)}

    def error(self, settings, *more, checks=None):
        """dE00 of the fit to the readings, dE00 of the picture to the reference integrator, the time of shading, and the plan."""
        results, _ = self.run.tool("render-osmesa", *self.words(settings), *more, "--check", checks or self.checks)
        error = results["error"]
        if not error["checked_pixels"]:
            raise Failed(f"{self.mesh}: not a pixel of it is in the picture, seen by {' '.join(self.frame)}")
        return {"fit_de00": self.fit(settings)[1], "render_de00": error["de00_mean"], "render_p95": error["de00_p95"],
                "shading_ms": results["left_out"]["shading_ms"], "plan": results.get("plan", [])}

    def picture(self, settings, *more):
        """What cost() and error() return, together."""
        return self.cost(settings, *more) | self.error(settings, *more)


def total_s(numbers):
    """The seconds of all stages for a picture."""
    return numbers["fit_s"] + numbers["prefilter_s"] + numbers["render_s"]


def total_de00(numbers):
    """The mean dE00 of the picture to the measured paint, which is at most that of the fit plus that of the picture."""
    return numbers["fit_de00"] + numbers["render_de00"]
