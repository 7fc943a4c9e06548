"""The page, its plots and the CSV of raw readings."""

import csv
import datetime
import html
import pathlib
import platform
import subprocess

STYLE = """
body{font:16px/1.5 sans-serif;color:#1c1c1c;background:#fff;max-width:62rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.7rem}h2{margin-top:2.5rem;border-bottom:1px solid #bbb}
table{border-collapse:collapse;margin:1rem 0;font-size:.9rem;display:block;overflow-x:auto}
th,td{padding:.2rem .7rem;text-align:right;border-bottom:1px solid #ddd;white-space:nowrap}
th:first-child,td:first-child{text-align:left}caption{text-align:left;font-weight:bold;padding:.3rem 0}
figure{margin:1.5rem 0;overflow-x:auto}figcaption{color:#444}svg{max-width:100%;height:auto}
@media print{body{max-width:none}h2{break-after:avoid}figure,table{break-inside:avoid}}
"""


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def machine():
    cores = len([1 for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("processor")])
    return f"{processor()}, {cores} cores, {datetime.date.today().isoformat()}"


def number(value):
    if isinstance(value, float):
        return f"{value:.3g}" if value == value else "-"
    return str(value)


def table(caption, head, rows):
    cells = lambda tag, row: "".join(f"<{tag}>{html.escape(number(cell))}</{tag}>" for cell in row)
    body = "".join(f"<tr>{cells('td', row)}</tr>\n" for row in rows)
    return f"<table><caption>{html.escape(caption)}</caption><tr>{cells('th', head)}</tr>\n{body}</table>\n"


def plot(run, figure):
    """Draws a figure with draw-plot(1) and returns its SVG; the file is kept beside the page."""
    rows = []
    for reading in figure.readings:
        rows.append((reading.method, *figure.point(reading), "both" if figure.joined else "points"))
    for reading in (r for r in figure.readings if r.default):
        rows.append(("default", *figure.point(reading), "points"))
    if figure.front:
        rows += [("best known", *figure.point(r), "dashed") for r in figure.pareto()]
    points = run.work / "points.csv"
    with points.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("series", "x", "y", "style"))
        writer.writerows((str(s).replace(",", ";"), x, y, style) for s, x, y, style in rows)
    out = run.output / f"{figure.name}.svg"
    subprocess.run([str(run.folder / "draw-plot"), str(points), "--title", figure.title, "--x-label", figure.x_label,
                    "--y-label", figure.y_label, "--logarithmic", figure.logarithmic, "--width", "860", "--height",
                    "420", "--quiet", "-o", str(out)], check=True)
    return out.read_text()


def write(run, studies, seconds):
    with (run.output / "readings.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("study", "figure", "method", "setting", "default", "time_s", "error", "all_times_s", "numbers"))
        for study in studies:
            for figure in study.figures:
                for r in figure.readings:
                    writer.writerow((study.title, figure.name, r.method, r.setting, int(r.default), f"{r.time_s:.6g}", f"{r.error:.6g}",
                                     " ".join(f"{s:.6g}" for s in r.raw_s), " ".join(f"{k}={number(v)}" for k, v in r.numbers.items())))
    parts = []
    for study in studies:
        parts.append(f"<h2>{html.escape(study.title)}</h2>\n<p>{html.escape(study.text)}</p>\n")
        for figure in study.figures:
            parts.append(f"<figure>{plot(run, figure)}</figure>\n")
        for caption, head, rows in study.tables:
            parts.append(table(caption, head, rows))
        for text in study.dominated_defaults():
            parts.append(f"<p><strong>Dominated default:</strong> {html.escape(text)}</p>\n")
    inputs = ", ".join(p.name for p in (run.paints, run.probe, run.mesh))
    (run.output / "index.html").write_text(
        f"<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>What accuracy costs</title>\n"
        f"<meta name=\"viewport\" content=\"width=device-width\"><style>{STYLE}</style></head>\n<body><h1>What accuracy costs</h1>\n"
        f"<p>Measured with {html.escape(inputs)} on {html.escape(machine())}, in {seconds:.0f} s{', quick' if run.quick else ''}. "
        f"Every reading, with every repetition, is in <a href=\"readings.csv\">readings.csv</a>.</p>\n{''.join(parts)}</body></html>\n")
