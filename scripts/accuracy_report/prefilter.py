"""Prefiltering: tolerance and size against the exact sum, compared with the sum over all pairs and with a naive mip chain."""

import dataclasses
import json
import os
import subprocess

from shared.tools import Failed

from .study import Figure, Reading, Study, processor_s

EXPONENTS = "6,20,70,250,900,3000"  # The diffuse lobe, whose exponent is 1, is always there.
SIZE = 128
DEFAULT_TOLERANCE = 1e-3
ENOUGH_S = 1  # When its runs have taken so long, a setting is not repeated again.


def shared_processor_s():
    """The processor time of all tools so far, divided by the cores. Other work on the machine does not count."""
    return processor_s() / (os.cpu_count() or 1)


def size_name(size):
    return "texels by --size auto" if size == "auto" else f"{size} texels"


def ours(run, size, tolerance, verify):
    """The reading of a setting of prefilter-envmap: the time to read, filter and write, and the verified error."""
    name = f"{size_name(size)}, tolerance {tolerance:g}"
    words = (run.probe, "-e", EXPONENTS, "--no-mirror", "--size", size, "--tolerance", tolerance, "-o", run.work / "out.env.exr")

    def once():
        before = shared_processor_s()
        run.tool("prefilter-envmap", *words)
        return shared_processor_s() - before

    times = []
    while len(times) < (2 if run.quick else 3) and sum(times) < ENOUGH_S:
        times.append(once())
    results, _ = run.tool("prefilter-envmap", *words, "--verify", verify)
    lobes = results["lobes"]
    worst = max(lobe["max_rel_error"] for lobe in lobes)
    return Reading(setting=name, time_s=min(times), error=worst, raw_s=tuple(times), again=once,
                   numbers={"size": size, "tolerance": tolerance, "mean_error": max(lobe["mean_rel_error"] for lobe in lobes),
                            "lookup_error": max(lobe["lookup_error"] for lobe in lobes),
                            "predicted_s": sum(lobe["predicted_time_s"] for lobe in lobes), "lobes": lobes})


def benchmark(run, pattern):
    """The results of the benchmark on the same probe; none if it was not built."""
    program = run.folder / "envmap_bench"
    if not os.access(program, os.X_OK):
        return []
    done = subprocess.run([str(program), f"--benchmark_filter={pattern}", "--benchmark_format=json"], capture_output=True,
                          text=True, env={**os.environ, "GONIOCHROME_PROBE": str(run.probe)})
    if done.returncode:
        raise Failed(f"{program}: {done.stderr.strip() or done.returncode}")
    return json.loads(done.stdout)["benchmarks"]


def rivals(run):
    """Readings of the sum over all pairs and of the naive mip chain; their processor time is divided by the cores."""
    cores = os.cpu_count() or 1
    readings = []
    for b in benchmark(run, f"BM_AgainstAllPairs/size:{SIZE}"):
        once = b["all_pairs_processor_s"] / cores
        readings.append(Reading("all pairs, float", once, b["all_pairs_max_error"], "all pairs", raw_s=(once,)))
    for b in benchmark(run, f"BM_BoxMip/source:.*/size:{SIZE}"):
        source = b["name"].split("source:")[1].split("/")[0]
        once = b["processor_s"] / cores
        readings.append(Reading(f"source averaged to {source}", once, b["max_error"], "naive mip chain", raw_s=(once,)))
    return readings


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
    sizes, few = ((64, 128), tolerances) if run.quick else ((32, 64, 128, 256), (1e-2, 1e-3, 1e-4))
    sweep = {size: [ours(run, size, t, verify) for t in (tolerances if size == SIZE else few)] for size in sizes}
    main = []
    for reading in sweep[SIZE]:
        reading.method = f"{SIZE} texels"
        reading.default = reading.numbers["tolerance"] == DEFAULT_TOLERANCE
        main.append(reading)
    against = Figure("prefilter", f"Seven lobes of {SIZE} texels a face: error against time", main + rivals(run),
                     x_label="time (s)", y_label="largest relative error")
    spread = []
    for size in sizes:
        for reading in sweep[size]:
            spread.append(dataclasses.replace(reading, method=f"{size} texels", default=False))
    all_sizes = Figure("prefilter-sizes", "The same for every size: the error of a texel of the file", spread, x_label="time (s)",
                       y_label="largest relative error", front=False,
                       note="There is no dashed line here: to filter more texels is a different job. The plot below shows what "
                       "they are good for.")
    auto = [ours(run, "auto", t, verify) for t in few[: 2 if run.quick else None]]
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
    for reading in main + spread + lookup:
        reading.numbers = {k: v for k, v in reading.numbers.items() if k != "lobes"}
    finest, before = (min(r.time_s for r in main if r.numbers["tolerance"] == t) for t in (tolerances[-1], 1e-4))
    text = (f"{run.probe.name} is filtered by the exponents 1,{EXPONENTS}. The reference is the sum in double precision over "
            f"every texel of the probe as a patch of constant radiance. An error is the largest of {verify} random texels of each "
            "lobe and of its brightest and darkest ones, relative to the texel or to a thousandth of the mean, whichever is larger. "
            "Half floats are exact to 5e-4, so tolerances of 1e-1 to 1e-3 write the same file; below that, the file has floats"
            + (f", and a tolerance of {tolerances[-1]:g} takes {finest / before:.0f} times as long as one of 1e-4"
               if tolerances[-1] < 1e-4 else "") +
            ". The sum over all pairs takes texels as points at their centers and therefore misses the sharp lobes. The naive "
            "mip chain averages the probe first, which moves the sun: below 32 texels it is faster, but its error is as "
            "large as the values. Times are processor time divided by the cores; ours include reading and writing, the others "
            "do not.")
    return Study("Prefiltering", text, [against, all_sizes, fetched], tables)
