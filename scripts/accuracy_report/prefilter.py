"""Prefiltering: tolerance and size against the exact sum, beside the sum over all pairs and a naive mip chain."""

import dataclasses
import json
import os
import resource
import subprocess

from .study import Failed, Figure, Reading, Study

EXPONENTS = "6,20,70,250,900,3000"  # and 1, the diffuse lobe
SIZE = 128
DEFAULT_TOLERANCE = 1e-3
ENOUGH_S = 1  # after so much of its time, a setting is not repeated


def shared_processor_s():
    """Processor time of all tools so far, shared by the cores: other work on the machine does not count."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (used.ru_utime + used.ru_stime) / (os.cpu_count() or 1)


def size_name(size):
    return "texels by --size auto" if size == "auto" else f"{size} texels"


def ours(run, size, tolerance, verify):
    """One setting of prefilter-envmap: reading, filtering and writing, and the verified error."""
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
    """Readings of the benchmark on the same probe, or none where it was not built."""
    program = run.folder / "envmap_bench"
    if not os.access(program, os.X_OK):
        return []
    done = subprocess.run([str(program), f"--benchmark_filter={pattern}", "--benchmark_format=json"], capture_output=True,
                          text=True, env={**os.environ, "GONIOCHROME_PROBE": str(run.probe)})
    if done.returncode:
        raise Failed(f"{program}: {done.stderr.strip() or done.returncode}")
    return json.loads(done.stdout)["benchmarks"]


def rivals(run):
    """The sum over all pairs and the naive mip chain; their processor time, shared by the cores."""
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
    """The same with the error of a lookup between texels."""
    return dataclasses.replace(reading, error=reading.error + reading.numbers["lookup_error"], method=method, default=False)


def by_lobe(reading):
    """Rows of a table: what each lobe of one reading took and how far it is off."""
    return [(f"{lobe['exponent']:g}", lobe["method"], lobe["degree"], lobe["predicted_time_s"] * 1e3, lobe["time_s"] * 1e3,
             lobe["predicted_error"], lobe["max_rel_error"], lobe["lookup_error"], lobe["energy_ratio"] - 1)
            for lobe in reading.numbers["lobes"]]


def study(run):
    verify = 20 if run.quick else 50
    tolerances = (1e-2, 1e-3, 1e-4) if run.quick else (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
    sizes, few = ((64, 128), tolerances) if run.quick else ((32, 64, 128, 256, 512), (1e-2, 1e-3, 1e-4))
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
    all_sizes = Figure("prefilter-sizes", "The same for every size: what a texel of the file errs", spread, x_label="time (s)",
                       y_label="largest relative error", front=False,
                       note="No front: more texels are another job; what they are good for is below.")
    auto = [ours(run, "auto", t, verify) for t in few[: 2 if run.quick else None]]
    lookup = [looked_up(r, f"tolerance {r.numbers['tolerance']:g}")
              for t in few for size in sizes for r in sweep[size] if r.numbers["tolerance"] == t]
    lookup += [looked_up(r, "--size auto") for r in auto]
    lookup[-len(auto) + few.index(DEFAULT_TOLERANCE)].default = True
    fetched = Figure("prefilter-lookup", "What a texel and a bilinear lookup err for the sharpest lobe, size by size", lookup,
                     x_label="time (s)", y_label="error of texel and lookup")
    tables = [(f"Lobe by lobe at {SIZE} texels, tolerance {DEFAULT_TOLERANCE:g}",
               ("exponent", "method", "degree", "predicted (ms)", "took (ms)",
                "predicted error", "largest error", "lookup error", "energy - 1"),
               by_lobe(next(r for r in main if r.default)))]
    for reading in spread + lookup:
        reading.numbers = {k: v for k, v in reading.numbers.items() if k != "lobes"}
    for reading in main:
        reading.numbers = {k: v for k, v in reading.numbers.items() if k != "lobes"}
    finest, before = (min(r.time_s for r in main if r.numbers["tolerance"] == t) for t in (tolerances[-1], 1e-4))
    text = (f"Exponents 1,{EXPONENTS} of {run.probe.name}. Errors are the largest of {verify} random texels of each lobe and of "
            "the brightest and darkest, relative to the texel or a thousandth of the mean, against the sum in double precision "
            "over every texel as a constant patch. Half floats hold 5e-4, so tolerances of 1e-1 to 1e-3 write the same file; "
            "below, the file is float"
            + (f", and a tolerance of {tolerances[-1]:g} takes {finest / before:.0f} times as long as one of 1e-4: "
               "the cliff to know about" if tolerances[-1] < 1e-4 else "") +
            ". The sum over all pairs takes texels as points at their centers, which costs it the sharp lobes; the naive mip "
            "chain averages the source first, which moves the sun: below 32 texels it is the faster and errs by all there is. "
            "Times are processor time shared by the cores; ours have reading and writing in them, the others not.")
    return Study("Prefiltering", text, [against, all_sizes, fetched], tables)
