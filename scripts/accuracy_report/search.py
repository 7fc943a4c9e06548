"""Nearest paints: library size, metric, and the two exact methods beside each other."""

import csv
import random

from shared.tools import Failed

from .study import Figure, Reading, Study


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


def distances(results):
    return [[match["distance"] for match in query["matches"]] for query in results["queries"]]


def study(run):
    sizes = (300, 3000) if run.quick else (100, 1000, 10_000, 100_000)
    table, queries = run.work / "queries.csv", run.work / "queries.xml"
    write_library(table, 200, seed=1)
    run.tool("paint-convert", table, "-o", queries)
    readings, rows = [], []
    for size in sizes:
        write_library(table, size, seed=size)
        library = run.work / f"library-{size}.xml"
        run.tool("paint-convert", table, "-o", library)
        for metric in ("de76", "de00"):
            by_method = {}
            for method in ("scan", "tree"):
                words = ("colorsnap", queries, "--library", library, "--metric", metric, "-k", 5, "--method", method,
                         "-o", run.work / "out.tsv")
                runs = [run.tool(*words)[0] for _ in range(1 if run.quick else 2)]
                by_method[method] = distances(runs[0])
                times = tuple(1e-6 * results["query_us"] for results in runs)
                readings.append(Reading(setting=f"{size} paints", time_s=min(times), error=0.0, method=f"{metric} {method}",
                                        raw_s=times, numbers={"size": size}))
            if by_method["scan"] != by_method["tree"]:
                raise Failed(f"tree and scan differ at {size} paints in {metric}")
            scan, tree = (r.time_s for r in readings[-2:])
            rows.append((metric, size, scan * 1e6, tree * 1e6, scan / tree))
    figure = Figure("search", "Time of a query against library size, both methods exact", readings, x_label="paints",
                    y_label="time of a query (s)", front=False, x=lambda r: r.numbers["size"], y=lambda r: r.time_s,
                    note="There is no dashed line here: both methods are exact.")
    return Study("Nearest paint", "The tree and the scan find the same distances to the last bit; only their times differ. "
                 "colorsnap chooses the faster one by itself.", [figure],
                 [("Time of a query", ("metric", "paints", "scan (us)", "tree (us)", "scan / tree"), rows)])
