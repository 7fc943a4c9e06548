"""Fitting: method, number of lobes and target against the measured colors, and what those lobes cost in a picture."""

import statistics

from .study import Figure, Reading, Study

METHODS = ("l1", "l2", "deltae")
TARGETS = ("measured", "curve")


def part(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def bases(run, sizes):
    """A basis for every number of lobes, chosen for the library itself: the most that so many lobes can do."""
    run.tool("fit-basis", run.paints, "--lobes", f"1..{max(sizes)}", "--starts", 2 if run.quick else 4, "--mirror", "--each", run.work / "lobes-", "-o", run.work / "largest.xml")
    return {size: run.work / f"lobes-{size}.basis.xml" for size in sizes}


def fitted(run, basis, method, target):
    """(time of a paint in s, every repetition, the color differences at the readings)."""
    times, paints = [], []
    for _ in range(1 if run.quick else 3):
        results, _ = run.tool("fit-paint", run.paints, "--basis", basis, "--method", method, "--target", target, "--threads", 1, "-o", run.work / "fitted.xml")
        paints = [paint for paint in results["paints"] if paint["status"] != "failed"]
        times.append(1e-6 * statistics.median(paint["time_us"] for paint in paints))
    errors = [error for paint in paints for error in paint["de00_by_geometry"].values()]
    return min(times), tuple(times), errors, paints


def picture(run, basis):
    """(seconds to prefilter, milliseconds of a frame) with every lobe of a basis, for the library's first fitted paint."""
    filtered, seconds = run.tool("prefilter-envmap", run.probe, "--basis", basis, "-o", run.work / "light.env.exr")
    run.tool("fit-paint", run.paints, "--basis", basis, "--gloss", 90, "-o", run.work / "fitted.xml")
    name = run.most_lobes
    results, _, all_s = run.repeated("render-osmesa", "--mesh", run.mesh, "--paint", f"{run.work / 'fitted.xml'}#{name}", "--env", run.work / "light.env.exr", "-o", run.work / "frame.exr")
    return seconds, results["frame_ms"], all_s


def study(run):
    sizes = (2, 4, 8) if run.quick else (1, 2, 3, 4, 5, 6, 8, 11)
    by_size = bases(run, sizes)
    readings, rows = [], []
    for target in TARGETS:
        for method in METHODS:
            for size, basis in by_size.items():
                time_s, all_s, errors, paints = fitted(run, basis, method, target)
                numbers = {"lobes": size, "p95": part(errors, 0.95), "max": max(errors)}
                readings.append(Reading(f"{method}, {size} lobes, {target}", time_s, statistics.mean(errors), method=f"{method} {target}", raw_s=all_s, numbers=numbers))
                rows.append((method, target, size, 1e6 * time_s, statistics.mean(errors), numbers["p95"], numbers["max"]))
                run.most_lobes = max(paints, key=lambda paint: paint["active_lobes"])["name"]
    costs, cost_rows = [], []
    for size, basis in by_size.items():
        seconds, frame_ms, all_s = picture(run, basis)
        fit = next(r for r in readings if r.method == "deltae measured" and r.numbers["lobes"] == size)
        costs.append(Reading(f"{size} lobes", frame_ms * 1e-3, fit.numbers["p95"], method="deltae measured", raw_s=all_s, numbers={"lobes": size, "prefilter_s": seconds}))
        cost_rows.append((size, seconds, frame_ms, fit.error, fit.numbers["p95"]))
    mean = Figure("fit-mean", "Mean dE00 at the readings against time for a paint", readings, "time for a paint (s)", "dE00, mean")
    p95 = Figure("fit-p95", "The same, 95 % of the readings", readings, "time for a paint (s)", "dE00, 95 %", front=False, y=lambda r: r.numbers["p95"])
    lobes = Figure("fit-lobes", "Mean dE00 against the number of lobes", readings, "lobes", "dE00, mean", front=False, x=lambda r: r.numbers["lobes"], logarithmic="y")
    render = Figure("fit-render", "dE00 at the readings (95 %) against the time of a picture with those lobes", costs, "time of a frame (s)", "dE00, 95 %", front=False)
    return Study("Fitting", "Every paint of the library is fitted to bases of 1 to 11 lobes that fit-basis chose for it, on one thread; the error is that of the color that the lobes predict at "
                 "the readings. What no number of lobes takes away are two sides of specular that differ, and colors outside the working space: fit-paint names them as the limit of a paint.",
                 [mean, p95, lobes, render],
                 [("Method, target and lobes", ("method", "target", "lobes", "time (us)", "dE00 mean", "95 %", "largest"), rows),
                  ("What the lobes cost in a picture", ("lobes", "prefilter (s)", "frame (ms)", "dE00 mean", "95 %"), cost_rows)])
