"""Bright spots: what cutting the bright parts of an environment by each horizon, one by one, does to error and time."""

import functools

from .scene import CAMERA
from .study import Figure, Reading, Study

PAINT = "silver_fine"
SIZE = ("--size", "320x180")
COUNTS = (0, 2, 12, 32)
QUICK = (0, 12)
DEFAULT = 12


def study(run):
    basis = run.data / "b7.basis.xml"
    fitted = run.work / "spots.xml"
    run.tool("fit-paint", "--basis", basis, run.paints, "-o", fitted)
    paint = f"{fitted}#{run.named([PAINT])[0]}"
    readings, rows = [], []
    lights = {"probe": run.probe, "outdoor": run.data / "outdoor.exr"}
    for light, image in list(lights.items())[: 1 if run.quick else None]:
        for count in QUICK if run.quick else COUNTS:
            env = run.work / f"spots-{light}-{count}.env.exr"
            made, filter_s = run.tool("prefilter-envmap", image, "--basis", basis, "--spots", count, "-o", env)
            words = ("--mesh", run.mesh, "--paint", paint, "--env", env, *SIZE, *CAMERA[2:], "--effects", "all,-rays",
                     "-o", run.work / "spots.exr")
            checked, _ = run.tool("render-osmesa", *words, "--check", "80,model" if run.quick else "200,model")
            timed = run.timed(functools.partial(run.shading, *words))
            error, kept = checked["error"], len(made.get("spots", ()))
            setting = f"{light}, --spots {count}"
            readings.append(Reading(setting, error=error["de00_p95"], method=light, default=count == DEFAULT, **timed,
                                    numbers={"mean": error["de00_mean"]}))
            rows.append((setting, kept, error["de00_mean"], error["de00_p95"], 1e3 * timed["time_s"], filter_s))
    figure = Figure("spots", "The 95th percentile of dE00 to the exact sum of the light, against the time of shading", readings,
                    "time of shading every pixel once (s)", "dE00, 95 %", apart=True,
                    note="From left to right more of the light is in spots. Nothing is in the way of the light here.")
    head = ("setting", "spots found", "dE00 mean", "95 %", "shading (ms)", "prefilter (s)")
    return Study("Bright spots", "prefilter-envmap --spots N keeps the bright part of an environment as up to N discs, which "
                 "render-osmesa cuts by the horizon of each point; maps alone know one direction at each point, and cannot. An "
                 "environment without small bright parts has fewer spots, or none.",
                 [figure], [("What spots cost and are worth", head, rows)])
