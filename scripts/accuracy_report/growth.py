"""How times grow with the size of the job: the exponents, and the steps that are steeper than the others."""

import csv
import math
import random
import statistics

from .prefilter import EXPONENTS
from .scene import CAMERA
from .study import Figure, Reading, Study


def write_probe(path, height):
    """Writes an uncompressed Radiance file, twice as wide as high: a sky that gets brighter upward, and a lamp."""
    with path.open("wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + f"-Y {height} +X {2 * height}\n".encode())
        for row in range(height):
            sky = bytes((60 + 120 * (height - row) // height, 80 + 90 * (height - row) // height, 90, 129))
            lamp = bytes((200, 190, 180, 135)) if height // 4 <= row < height // 4 + max(1, height // 16) else sky
            wide = max(1, height // 16)
            file.write(sky * (height - wide) + lamp * wide + sky * height)


def write_library(path, count, seed):
    """Writes a table of random metallics with three angles each."""
    draw = random.Random(seed)
    with path.open("w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("sample", "geometry", "illuminant", "observer", "L", "a", "b"))
        for i in range(count):
            face = draw.uniform(20, 110), draw.uniform(-50, 50), draw.uniform(-50, 50)
            for angle, part in ((15, 1), (45, 0.5), (110, 0.3)):
                rows.writerow((f"p{i}", f"45as{angle}", "D65", 10, *(f"{v * part:.3f}" for v in face)))


def curve(readings):
    """(the exponent over the larger half of the sizes, the steepest step, its exponent) of times against sizes."""
    points = [(math.log(r.numbers["n"]), math.log(r.time_s)) for r in readings]
    steps = [(y1 - y0) / (x1 - x0) for (x0, y0), (x1, y1) in zip(points, points[1:])]
    steepest = max(range(len(steps)), key=steps.__getitem__)
    slope = statistics.linear_regression(*zip(*points[(len(points) - 1) // 2:])).slope
    return slope, f"{readings[steepest].numbers['n']} to {readings[steepest + 1].numbers['n']}", steps[steepest]


def prefiltering(run):
    heights, sizes = ((128, 256), (64, 128)) if run.quick else ((256, 512, 1024), (64, 128, 256))
    probe, out = run.work / "probe.hdr", run.work / "growth.env.exr"
    for height in heights:
        write_probe(probe, height)
        _, best, raw = run.repeated("prefilter-envmap", probe, "-e", EXPONENTS, "--size", 128, "-o", out)
        yield "prefilter-envmap: rows of the probe", height, best, raw
    write_probe(probe, 512)
    for size in sizes:
        _, best, raw = run.repeated("prefilter-envmap", probe, "-e", EXPONENTS, "--size", size, "-o", out)
        yield "prefilter-envmap: texels of a face", size, best, raw


def fitting(run):
    table, library, queries = run.work / "growth.csv", run.work / "growth.xml", run.work / "queries.xml"
    write_library(table, 200, seed=1)
    run.tool("paint-convert", table, "-o", queries)
    for count in (100, 1000) if run.quick else (100, 1000, 4000):
        write_library(table, count, seed=count)
        run.tool("paint-convert", table, "-o", library)
        for method in ("l2", "deltae"):
            _, best, raw = run.repeated("fit-paint", "--basis", run.data / "b7.basis.xml", "--method", method, library,
                                        "-o", run.work / "fitted.xml")
            yield f"fit-paint {method}: paints", count, best, raw
        _, best, raw = run.repeated("goniogeom-index", library, "--worst", "-o", run.work / "index.tsv")
        yield "goniogeom-index: paints", count, best, raw
        _, best, raw = run.repeated("colorsnap", queries, "--library", library, "-o", run.work / "match.tsv")
        yield "colorsnap: paints of the library", count, best, raw


def rendering(run):
    fitted, env = run.work / "fitted.xml", run.work / "studio.env.exr"
    run.tool("fit-paint", "--basis", run.data / "b7.basis.xml", run.paints, "-o", fitted)
    run.tool("prefilter-envmap", run.probe, "--basis", run.data / "b7.basis.xml", "-o", env)
    # CAMERA[2:] leaves the size out. With all effects, every size draws the same ones.
    words = ("--mesh", run.mesh, "--paint", f"{fitted}#silver_black_flop", "--effects", "all,-rays", *CAMERA[2:],
             "-o", run.work / "p.exr")
    def frame(*more):
        frames = [run.tool("render-osmesa", *words, *more)[0]["frame_ms"] * 1e-3 for _ in range(run.repeats)]
        return min(frames), tuple(frames)
    for width in (160, 320, 640) if run.quick else (160, 320, 640, 1280):
        yield "render-osmesa: pixels", width * width * 9 // 16, *frame("--env", env, "--size", f"{width}x{width * 9 // 16}")
    for lights in (1, 4, 16):
        directions = [word for i in range(lights) for word in ("--light", f"{360 * i / lights - 180:.1f},40")]
        yield "render-osmesa: lights", lights, *frame(*directions, "--size", "640x360")


def study(run):
    kinds = {}
    for part in (prefiltering, fitting, rendering):
        for kind, n, best, raw in part(run):
            reading = Reading(setting=f"{kind} {n}", time_s=best, error=0.0, method=kind, raw_s=raw, numbers={"n": n})
            kinds.setdefault(kind, []).append(reading)
    readings = [r for rs in kinds.values() for r in rs]
    figure = Figure("growth", "Time against the size of the job", readings,
                    x_label="size: rows, texels, paints, pixels or lights", y_label="time (s)", front=False,
                    x=lambda r: r.numbers["n"], y=lambda r: r.time_s,
                    note="There is no dashed line here: these are the times of different jobs.")
    rows = [(kind, f"{rs[0].numbers['n']} to {rs[-1].numbers['n']}", rs[0].time_s, rs[-1].time_s, *curve(rs))
            for kind, rs in kinds.items()]
    text = ("An exponent of 1 means that the time is proportional to the size. Exponents are taken over the larger half of the "
            "sizes, where the start of the tool counts least. If the exponent of the steepest step is far above the others, "
            "doubling the job costs more there than elsewhere. Probes of growing size are filtered to 128 texels along a face, "
            "and faces of growing size from a probe of 1024 x 512 texels; lights in growing numbers shine on 640 x 360 pixels, "
            "and pictures of growing size are lit by the probe. Times of render-osmesa are those of a frame, all others are "
            "processor time of the whole tool.")
    head = ("what grows", "sizes", "least (s)", "most (s)", "exponent", "steepest step", "its exponent")
    return Study("Growth", text, [figure], [("Growth", head, rows)])
