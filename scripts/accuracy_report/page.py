"""The page, its plots and the CSV of raw readings."""

import csv
import datetime
import html
import pathlib
import platform
import subprocess

from .study import processor_s

FRONT = "#222222"  # the color of the dashed line and of the rings around defaults

STYLE = """
body{font:16px/1.5 sans-serif;color:#1c1c1c;background:#fff;max-width:62rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.7rem}h2{margin-top:2.5rem;border-bottom:1px solid #bbb}nav a{margin-right:1rem;white-space:nowrap}
table{border-collapse:collapse;margin:1rem 0;font-size:.85rem;line-height:1.35}
th,td{padding:.2rem .5rem;text-align:right;border-bottom:1px solid #ddd;vertical-align:bottom}
.text{text-align:left}caption{text-align:left;font-weight:bold;padding:.3rem 0}
figure{margin:1.5rem 0}figcaption{color:#444;font-size:.9em}svg{max-width:100%;height:auto}
@media print{body{max-width:none;margin:0;font-size:10pt}nav{display:none}\
table{font-size:8pt}h2{break-after:avoid}figure,tr{break-inside:avoid}}
"""
READING = ("Each point of a plot is a setting: the lower it lies, the smaller its error, and the farther left, the faster it is. "
           "The dashed line joins the settings that no other one beats in both. A ring marks a default setting. A plot without a "
           "dashed line shows different jobs, or one of its axes is not a time.")


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def machine():
    cores = len([1 for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("processor")])
    return f"{processor()}, {cores} cores, {datetime.date.today().isoformat()}"


def number(value):
    """A value with three digits, and with a power of ten only if it is very small."""
    if not isinstance(value, float):
        return str(value)
    if value != value:
        return "-"
    if abs(value) < 1e-12:
        return "0"
    short = f"{value:.3g}"
    if abs(value) >= 100:
        short = f"{float(short):.0f}"
    return short.replace("e-0", "e-")


def table(caption, head, rows):
    def cell(tag, value, like):
        side = ' class="text"' if isinstance(like, str) else ""
        return f"<{tag}{side}>{html.escape(number(value))}</{tag}>"
    first = rows[0] if rows else head
    heads = "".join(cell("th", name, like) for name, like in zip(head, first))
    body = "".join(f"<tr>{''.join(cell('td', value, like) for value, like in zip(row, first))}</tr>\n" for row in rows)
    return f"<table><caption>{html.escape(caption)}</caption><tr>{heads}</tr>\n{body}</table>\n"


def plot(run, figure):
    """Draws a figure with draw-plot(1) and returns its SVG, which is also kept as a file beside the page."""
    rows = []
    if figure.front and not figure.apart:
        rows += [("best known", *figure.point(r), "dashed", FRONT) for r in figure.pareto()]
    for reading in figure.readings:
        rows.append((reading.method, *figure.point(reading), "both" if figure.joined else "points", ""))
    rows += [("default", *figure.point(r), "rings", FRONT) for r in figure.readings if r.default]
    points = run.work / "points.csv"
    with points.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("series", "x", "y", "style", "color"))
        writer.writerows((str(s).replace(",", ";"), *rest) for s, *rest in rows)
    out = run.output / f"{figure.name}.svg"
    subprocess.run([str(run.folder / "draw-plot"), str(points), "--title", figure.title, "--x-label", figure.x_label,
                    "--y-label", figure.y_label, "--logarithmic", figure.logarithmic, "--width", "900", "--height",
                    "420", "--quiet", "-o", str(out)], check=True)
    return out.read_text()


def anchor(study):
    return study.title.lower().replace(" ", "-")


def chapter(run, study):
    """The HTML of a study."""
    parts = [f"<h2 id=\"{anchor(study)}\">{html.escape(study.title)}</h2>\n<p>{html.escape(study.text)}</p>\n"]
    for figure in study.figures:
        note = f"<figcaption>{html.escape(figure.note)}</figcaption>" if figure.note else ""
        parts.append(f"<figure>{plot(run, figure)}{note}</figure>\n")
    parts += [table(caption, head, rows) for caption, head, rows in study.tables]
    parts += [f"<p><strong>Dominated default:</strong> {html.escape(text)}</p>\n" for text in study.dominated_defaults()]
    return "".join(parts)


def write(run, studies, seconds):
    with (run.output / "readings.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("study", "figure", "method", "setting", "default", "time_s", "error", "all_times_s", "numbers"))
        for study in studies:
            for figure in study.figures:
                for r in figure.readings:
                    times = " ".join(f"{s:.6g}" for s in r.raw_s)
                    numbers = " ".join(f"{k}={number(v)}" for k, v in r.numbers.items())
                    writer.writerow((study.title, figure.name, r.method, r.setting, int(r.default),
                                     f"{r.time_s:.6g}", f"{r.error:.6g}", times, numbers))
    parts = [chapter(run, study) for study in studies]
    contents = " ".join(f'<a href="#{anchor(study)}">{html.escape(study.title)}</a>' for study in studies)
    inputs = ", ".join(p.name for p in (run.paints, run.probe, run.mesh))
    (run.output / "index.html").write_text(
        f"<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>What accuracy costs</title>\n"
        f"<meta name=\"viewport\" content=\"width=device-width\"><style>{STYLE}</style></head>\n"
        "<body><h1>What accuracy costs</h1>\n"
        f"<p>Measured with {html.escape(inputs)} on {html.escape(machine())}, "
        f"in {seconds:.0f} s with {processor_s():.0f} s of processor time{', quick' if run.quick else ''}. "
        f"Every reading, with every repetition, is in <a href=\"readings.csv\">readings.csv</a>.</p>\n<p>{READING}</p>\n"
        f"<nav>{contents}</nav>\n{''.join(parts)}</body></html>\n")
