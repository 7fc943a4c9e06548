"""Prefiltering: tolerance and size against the exact sum."""

import dataclasses

from .study import Figure, Reading, Study

EXPONENTS = "6,20,70,250,900,3000"  # The diffuse lobe, whose exponent is 1, is always there.
SIZE = 128
DEFAULT_TOLERANCE = 1e-3


def size_name(size):
    return "texels by --size auto" if size == "auto" else f"{size} texels"


def ours(run, size, tolerance, verify):
    """The reading of a setting of prefilter-envmap: the time to read, filter and write, and the verified error."""
    name = f"{size_name(size)}, tolerance {tolerance:g}"
    words = (run.probe, "-e", EXPONENTS, "--no-mirror", "--size", size, "--tolerance", tolerance, "-o", run.work / "out.env.exr")
    results, _ = run.tool("prefilter-envmap", *words, "--verify", verify)
    lobes = results["lobes"]
    worst = max(lobe["max_rel_error"] for lobe in lobes)
    return Reading(setting=name, error=worst, **run.timed(lambda: run.tool("prefilter-envmap", *words)[1]),
                   numbers={"size": size, "tolerance": tolerance, "mean_error": max(lobe["mean_rel_error"] for lobe in lobes),
                            "lookup_error": max(lobe["lookup_error"] for lobe in lobes),
                            "predicted_s": sum(lobe["predicted_time_s"] for lobe in lobes), "lobes": lobes})


def looked_up(reading, method):
    """The same reading, to whose error that of a lookup between texels is added."""
    return dataclasses.replace(reading, error=reading.error + reading.numbers["lookup_error"], method=method, default=False)


def by_lobe(reading):
    """The rows of a table: the time and the errors of each lobe of a reading."""
    return [(f"{lobe['exponent']:g}", lobe["method"], lobe["degree"], lobe["predicted_time_s"] * 1e3, lobe["time_s"] * 1e3,
             lobe["predicted_error"], lobe["max_rel_error"], lobe["lookup_error"], lobe["energy_ratio"] - 1)
            for lobe in reading.numbers["lobes"]]


def study(run):
    verify = 20 if run.quick else 50
    tolerances = (1e-2, 1e-3, 1e-4) if run.quick else (1e-2, 1e-3, 1e-4, 1e-5)
    sizes, few = ((64, 128), (1e-3,)) if run.quick else ((64, 128, 256), (1e-3, 1e-4))
    sweep = {size: [ours(run, size, t, verify) for t in (tolerances if size == SIZE else few)] for size in sizes}
    main = sweep[SIZE]
    for reading in main:
        reading.method = f"{SIZE} texels"
        reading.default = reading.numbers["tolerance"] == DEFAULT_TOLERANCE
    by_tolerance = Figure("prefilter", f"Seven lobes of {SIZE} texels a face: error against time, by the tolerance", main,
                          y_label="largest relative error")
    auto = [ours(run, "auto", t, verify) for t in few]
    lookup = [looked_up(r, f"tolerance {r.numbers['tolerance']:g}")
              for t in few for size in sizes for r in sweep[size] if r.numbers["tolerance"] == t]
    lookup += [looked_up(r, "--size auto") for r in auto]
    lookup[-len(auto) + few.index(DEFAULT_TOLERANCE)].default = True
    fetched = Figure("prefilter-lookup", "The error of a texel plus that of a bilinear lookup, for the sharpest lobe, by size",
                     lookup, x_label="time (s)", y_label="error of texel and lookup")
    tables = [(f"Lobe by lobe at {SIZE} texels, tolerance {DEFAULT_TOLERANCE:g}",
               ("exponent", "method", "degree", "predicted (ms)", "took (ms)",
                "predicted error", "largest error", "lookup error", "energy - 1"),
               by_lobe(next(r for r in main if r.default)))]
    for reading in main + lookup:
        reading.numbers = {k: v for k, v in reading.numbers.items() if k != "lobes"}
    finest, before = (min(r.time_s for r in main if r.numbers["tolerance"] == t) for t in (tolerances[-1], 1e-4))
    text = (f"{run.probe.name} is filtered by the exponents 1,{EXPONENTS}. The reference is the sum in double precision over "
            f"every texel of the probe as a patch of constant radiance. An error is the largest of {verify} random texels of each "
            "lobe and of its brightest and darkest ones, relative to the texel or to a thousandth of the mean, whichever is larger. "
            "Half floats are exact to 5e-4, so tolerances of 1e-1 to 1e-3 write the same file; below that, the file has floats"
            + (f", and a tolerance of {tolerances[-1]:g} takes {finest / before:.0f} times as long as one of 1e-4"
               if tolerances[-1] < 1e-4 else "") +
            ". Times are processor time of the whole tool.")
    return Study("Prefiltering", text, [by_tolerance, fetched], tables)
