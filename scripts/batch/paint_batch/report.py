"""The merged report: its content depends only on the library and the options, not on shards, times or restarts."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from shared import paint_text as library
from shared.files import write_whole
from shared.quantile import quantile

from . import files
from .steps import TARGETED, columns, picture_path


def shard_folders(out, plan):
    return [out / "shards" / f"{number:04d}" for number in range(len(plan["shards"]))]


def spread(values):
    """The median, the 95th percentile and the largest value."""
    return {name: quantile(values, share) for name, share in (("median", 0.5), ("p95", 0.95), ("max", 1))}


class Verdict:
    """Which paints are within --target-de00: those of which the fit and the worst picture together are."""

    NAMED = 10  # how many of the worst paints are named on standard error

    def __init__(self, target):
        self.target, self.totals, self.missed = target, [], []

    def add(self, row):
        if row["within"] is None:
            return
        self.totals.append(row["total_de00"])
        if row["within"] == "no":
            self.missed.append({key: row[key] for key in ("paint", "name", "de00_mean", *TARGETED[:-1])})

    def summary(self):
        self.missed.sort(key=lambda row: (-row["total_de00"], row["paint"]))
        return {**{key: self.target[key] for key in ("de00", "settings", "check", "proof")},
                "paints": len(self.totals), "within": len(self.totals) - len(self.missed),
                "missed_by_fit": sum(row["de00_mean"] > self.target["de00"] for row in self.missed),
                "total_de00": spread(self.totals), "not_within": self.missed}

    def told(self):
        """The text that says how many paints are within the target, and which of the others to look at first."""
        found = self.summary()
        lines = [f"target dE00 {found['de00']:g}: {found['within']} of {found['paints']} drawn paints within it, by a check of "
                 f"{found['check']} pixels a picture, with {found['settings']}"]
        if self.totals:
            figures = ", ".join(f"{name} {de00:.2f}" for name, de00 in found["total_de00"].items())
            lines.append(f"  fit and worst picture together: {figures}")
        if self.missed:
            lines.append(f"  not within, worst first; {found['missed_by_fit']} of these {len(self.missed)} by their fit alone:")
        for row in self.missed[: self.NAMED]:
            lines.append(f"    {row['name']} {row['total_de00']:.2f} (fit {row['de00_mean']:.2f}, "
                         f"picture {row['picture_de00']:.2f}, {row['worst_scene']})")
        if len(self.missed) > self.NAMED:
            lines.append(f"    and {len(self.missed) - self.NAMED} more: see not_within in report.json")
        return "".join(f"{line}\n" for line in lines)


def merge(out):
    """Writes report.tsv (a line for each paint), report.json (summary and failures), fitted.paints.xml and times.json."""
    plan = files.read_plan(out)
    summary = {"paints": 0, "fitted": 0, "pictures": 0, "rejected": files.read_json(out / "rejected.json"), "failed": []}
    errors, seconds, named = [], {}, columns(plan)
    verdict = Verdict(plan["target"]) if "target" in plan else None
    table, fitted = out / "report.tsv.partial", out / "fitted.paints.xml.partial"
    with open(table, "w", encoding="utf-8") as rows, open(fitted, "w", encoding="utf-8") as paints:
        print("\t".join(named), file=rows)
        paints.write(library.HEAD)
        for folder in shard_folders(out, plan):
            for row in files.read_json(folder / "rows.json"):
                print("\t".join(cell(row[column]) for column in named), file=rows)
                summary["paints"] += 1
                summary["fitted"] += "fit" not in row["failed"]
                summary["pictures"] += row["pictures"]
                if row["failed"]:
                    summary["failed"].append({"paint": row["paint"], "name": row["name"], **row["failed"]})
                if row["de00_max"] is not None:
                    errors.append(row["de00_max"])
                if verdict:
                    verdict.add(row)
            paints.write((folder / "fitted.txt").read_text(encoding="utf-8"))
            for tool, spent in files.read_json(folder / "done.json")["tools_s"].items():
                seconds[tool] = seconds.get(tool, 0) + spent
        paints.write(library.TAIL)
    summary["fit_de00"] = spread(errors)
    if verdict:
        summary["target"] = verdict.summary()
    os.replace(table, out / "report.tsv")
    os.replace(fitted, out / "fitted.paints.xml")
    files.write_json(out / "times.json", {"estimate": plan["estimate"], "tools_s": seconds, "work_s": sum(seconds.values())})
    files.write_json(out / "report.json", summary)
    tell(plan, summary, verdict, sum(seconds.values()))
    return summary


def tell(plan, summary, verdict, work_s):
    print(f"{summary['paints']} paints, {summary['fitted']} fitted, {summary['pictures']} pictures, "
          f"{len(summary['failed'])} failed, {len(summary['rejected'])} messages about unreadable ones\n"
          f"{verdict.told() if verdict else ''}"
          f"time in tools: {work_s:.1f} s, estimated {plan['estimate']['work_s']:.1f} s", file=sys.stderr)


def cell(value):
    if value is None:
        return "n/a"
    if isinstance(value, dict):
        return "; ".join(f"{step}: {message}" for step, message in value.items())
    return str(value).replace("\t", " ").replace("\n", " ")


def chapters(plan):
    """The number of chapters of the book: none where there are no pictures."""
    return -(-plan["paints"] // plan["chapter"]) if plan["chapter"] and plan["scenes"] else 0


def book(out, chapter):
    """Writes a chapter of the paint book, with the pictures of the first scene."""
    plan = files.read_plan(out)
    files.check_number(chapter, chapters(plan), "chapter", out)
    first, last = chapter * plan["chapter"], (chapter + 1) * plan["chapter"]
    scene = plan["scenes"][0]
    skipped = {entry["paint"] for entry in files.read_json(out / "report.json")["failed"]}
    numbers = [number for number in range(first, min(last, plan["paints"])) if number not in skipped]
    places = list(library.places(out / "fitted.paints.xml"))
    page = out / f"book-{chapter + 1:03d}.html"
    if not numbers:
        write_whole(page, f"<!DOCTYPE html><title>Paints {first + 1} to {min(last, plan['paints'])}</title>"
                    "<p>No paint of this chapter could be drawn; see report.json.\n")
        return
    with tempfile.TemporaryDirectory(prefix="paint-batch-") as scratch:
        folder = pathlib.Path(scratch)
        paints = [library.paints_at(out / "fitted.paints.xml", places[n], places[n])[0] for n in numbers]
        write_whole(folder / "chapter.paints.xml", library.document(paints))
        (folder / "out").symlink_to(out, target_is_directory=True)
        for index, number in enumerate(numbers):
            shutil.copy(picture_path(out, scene, number), folder / f"{index}.png")
        program = pathlib.Path(__file__).resolve().parents[2] / "paint-book"
        width, height = plan["size"].split("x")
        fitted = ["--fitted"] if "target" in plan else []  # With only --basis, paint-book would fit the paints anew.
        subprocess.run([program, folder / "chapter.paints.xml", "--quiet", "--jobs", "1", "--basis", plan["basis"], *fitted,
                        "--mesh", scene["mesh"], "--env", scene["env"], "--size", f"{width}x{height}", "--pictures", folder,
                        "--title", f"Paints {first + 1} to {min(last, plan['paints'])}", "-o", page], check=True, cwd=folder)
