"""What is done with a shard: the fit, indices, panel check, nearest paint and pictures of every paint, and its row."""

import json
import os
import pathlib
import re
import shutil
import tempfile

from shared import paint_text as library
from shared.files import write_whole
from shared.tools import Failed

from . import files
from .tools import Tools, json_lines

COLUMNS = ["paint", "name", "class", "fit", "de00_max", "de00_mean", "gamut_de00", "flop_index", "chroma_index",
           "hue_shift_index", "worst_deg", "nearest", "nearest_distance", "pictures", "failed"]
# A paint with one of these is drawn by a run of its own. In a stream its picture could depend on the paints before it, by effects
# that these call for.
ALONE = re.compile("<(anisotropy|colorMap|tilts)[ />]")
TARGETED = ["worst_scene", "picture_de00", "total_de00", "within"]  # more columns with --target-de00


def columns(plan):
    return COLUMNS + TARGETED if "target" in plan else COLUMNS


def frame_words(view, size):
    """The options of render-osmesa that the pictures of a scene have in common."""
    return ["--camera", view, "--size", size, "--background", "0.3,0.3,0.3"]


def scene_name(source, mesh, view):
    return f"{pathlib.Path(source).name.split('.')[0]}-{pathlib.Path(mesh).stem}-{view}"


class Checks:
    """The results of the checks of pictures, written as each is drawn, so that an interrupted shard draws none of them again."""

    def __init__(self, path):
        self.path, self.found = path, {}
        for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else []:
            try:
                picture, de00 = json.loads(line)
                self.found[picture] = de00
            except ValueError:
                pass  # The shard was killed while it wrote this line.

    def add(self, picture, de00):
        self.found[picture] = de00
        with open(self.path, "a", encoding="utf-8") as file:
            file.write("\n" + json.dumps([picture, de00]))


class Shard:
    def __init__(self, plan, out, checks=None, drawn=None):
        """`drawn` is a folder beside the pictures, in which those of streams are written until they get their names."""
        self.plan, self.out, self.checks, self.drawn, self.tools = plan, out, checks, drawn, Tools()
        self.target = plan.get("target")

    def fit(self, given, folder):
        fitted, report = folder / "fitted.paints.xml", folder / "fit.json"
        gloss = ["--gloss", self.plan["gloss"]] if self.plan["gloss"] else []
        self.tools.run("fit-paint", "-q", "--threads", 1, "--basis", self.plan["basis"], *self.chosen("fit"), *gloss,
                       "--report", report, given, "-o", fitted)
        return list(zip(library.cut(fitted.read_text(encoding="utf-8")), files.read_json(report)["results"]["paints"]))

    def chosen(self, stage):
        """The options that --target-de00 chose for a stage."""
        if self.target:
            return self.target[stage]
        # Rays would take most of the time of a batch.
        return ["--effects", "auto,-rays"] if stage == "render" else []

    def stats(self, given, folder):
        out = folder / "stats.jsonl"
        self.tools.run("paint-stats", "-q", "--threads", 1, "-f", "json", given, "-o", out)
        return json_lines(out)

    def index(self, given, folder):
        report = folder / "index.json"
        self.tools.run("goniogeom-index", "-q", "--threads", 1, "--worst", "--report", report, given, "-o", "/dev/null")
        return files.read_json(report)["results"]["paints"]

    def snap(self, given, folder):
        out = folder / "snap.jsonl"
        self.tools.run("colorsnap", "-q", "--threads", 1, "-l", self.plan["against"], "-k", 2, "-f", "json", given, "-o", out)
        return json_lines(out)

    def draw(self, scene, paint, folder, picture, *more):
        """Draws a picture, whole or not at all. The path `picture` is relative to `folder`, where "out" is a link to the batch.

        A picture contains the command that made it. With this link the paths in it are the same for any shard and any folder.
        """
        self.render(scene, [paint], folder, picture, *more)

    def render(self, scene, paints, folder, pattern, *more):
        """Draws paints by one run of render-osmesa, in `folder`, where "out" is a link to the batch."""
        write_whole(folder / "given.paints.xml", library.document(paints))
        if not (folder / "out").exists():
            (folder / "out").symlink_to(self.out, target_is_directory=True)
        self.tools.run("render-osmesa", "-q", "--threads", 1, "--mesh", scene["mesh"], "--env", scene["env"], "--paint",
                       "given.paints.xml", *frame_words(scene["view"], self.plan["size"]), *self.chosen("render"), *more,
                       "-o", pattern, cwd=folder)

    def draw_stream(self, scene, paints, folder):
        """Draws paints, given as {number: text}, by one run, and returns why those without a picture have none, by number.

        The run writes each picture whole, as soon as it is drawn, into the folder `drawn`. If this process is killed, the next one
        finds there what was drawn.
        """
        self.settle(scene)
        numbers = [number for number in paints if not picture_path(self.out, scene, number).exists()]
        if not numbers:
            return {}
        self.drawn.mkdir(exist_ok=True)
        files.write_json(self.drawn / "numbers.json", {"scene": scene["name"], "numbers": numbers})
        if not (folder / "drawn").exists():
            (folder / "drawn").symlink_to(self.drawn, target_is_directory=True)
        report, failed = folder / "drawn.json", {}
        report.unlink(missing_ok=True)
        try:
            self.render(scene, [paints[number] for number in numbers], folder, "drawn/{index}.png", "--report", "drawn.json")
            told = files.read_json(report)["results"]["pictures"]
            failed = {number: Failed(one["message"]) for number, one in zip(numbers, told) if one["status"] == "failed"}
        except Failed as error:
            if len(numbers) == 1:
                return {numbers[0]: error}
            self.settle(scene)
            half = {number: paints[number] for number in numbers[: len(numbers) // 2]}
            rest = {number: paints[number] for number in numbers[len(numbers) // 2 :]}
            return self.draw_stream(scene, half, folder) | self.draw_stream(scene, rest, folder)
        self.settle(scene)
        return {number: failed.get(number) or Failed("it was not drawn") for number in numbers
                if not picture_path(self.out, scene, number).exists()}

    def settle(self, scene):
        """Gives the pictures of a stream of this scene, which may have been killed, their names."""
        if self.drawn is None or not (self.drawn / "numbers.json").exists():
            return
        begun = files.read_json(self.drawn / "numbers.json")
        if begun["scene"] != scene["name"]:
            return
        for index, number in enumerate(begun["numbers"], 1):
            if (picture := self.drawn / f"{index:04}.png").exists():
                os.replace(picture, picture_path(self.out, scene, number))
        (self.drawn / "numbers.json").unlink()

    def checked(self, scene, number, paint, folder, picture):
        """Draws a picture; returns its mean dE00 to the reference integrator, at random pixels that differ for every paint."""
        self.draw(scene, paint, folder, picture, "--check", self.target["check"], "--check-source", scene["source"],
                  "--seed", self.target["seed"] + number, "--report", "check.json")
        error = files.read_json(folder / "check.json")["results"]["error"]
        if not error["checked_pixels"]:
            raise Failed(f"{scene['name']}: not a pixel of the mesh is in the picture")
        return error["de00_mean"]

    def checked_pictures(self, number, paint, folder):
        """Draws the pictures of a paint that are not there yet; returns {scene: mean dE00}."""
        found = {}
        for scene in self.plan["scenes"]:
            picture = picture_path("out", scene, number)
            there = picture_path(self.out, scene, number).exists()
            if not there or str(picture) not in self.checks.found:
                self.checks.add(str(picture), self.checked(scene, number, paint, folder, picture))
            found[scene["name"]] = self.checks.found[str(picture)]
        return found

    def pictures(self, paints, folder):
        """Draws the pictures of paints, given as {number: text}; returns why those without all pictures have none, by number."""
        failed = {}
        for scene in self.plan["scenes"]:
            streamed = {number: paint for number, paint in paints.items() if not ALONE.search(paint)}
            failed |= self.draw_stream(scene, streamed, folder)
            for number, paint in paints.items():
                if number in streamed or picture_path(self.out, scene, number).exists():
                    continue
                try:
                    self.draw(scene, paint, folder, picture_path("out", scene, number))
                except Failed as error:
                    failed[number] = error
        return failed

    def rows(self, first, paints, folder):
        """[(row, fitted text)] of the paints; the row of a paint that fails has the message, and its pictures are not drawn."""
        steps = {"fit": self.fit, "stats": self.stats, "index": self.index, "snap": self.snap}
        results = {name: self.tools.lines(step, paints, folder) for name, step in steps.items()}
        rows, given = [], {}
        for i, paint in enumerate(paints):
            got = {name: result[i] for name, result in results.items()}
            fitted = paint if isinstance(got["fit"], Failed) else got["fit"][0]
            row = row_of(first + i, got) | dict.fromkeys(TARGETED if self.target else ())
            if "fit" not in row["failed"]:
                given[first + i] = fitted
            rows.append((row, fitted))
        failed = {} if self.target else self.pictures(given, folder)
        for row, fitted in rows:
            number = row["paint"]
            try:
                if number in failed:
                    raise failed[number]
                if number in given:
                    found = self.checked_pictures(number, fitted, folder) if self.target else {}
                    row["pictures"] = len(self.plan["scenes"])
                    if found and row["de00_mean"] is not None:
                        row |= verdict(row["de00_mean"], found, self.target["de00"])
            except Failed as error:
                row["failed"]["picture"] = str(error)
            row["failed"] = {step: without(message, folder) for step, message in row["failed"].items()}
        return rows


def verdict(fit_de00, pictures, target):
    """The columns about the target. The worst picture is at most `total_de00` from the measured paint."""
    scene = max(pictures, key=pictures.get)
    total = fit_de00 + pictures[scene]
    return {"worst_scene": scene, "picture_de00": pictures[scene], "total_de00": round(total, 9),
            "within": "yes" if total <= target else "no"}


def picture_path(out, scene, number):
    return pathlib.Path(out) / "pictures" / scene["name"] / f"{number:06d}.png"


def without(message, folder):
    """A message without the folder of this run, so that it is the same for any shards."""
    return str(message).replace(f"{folder}/", "")


def row_of(number, got):
    """The row of a paint, made of the results of the steps. Missing values are None."""
    failed = {name: str(result) for name, result in got.items() if isinstance(result, Failed)}
    fit = {} if "fit" in failed else got["fit"][1]
    stats, index, snap = ({} if name in failed else got[name] for name in ("stats", "index", "snap"))
    if fit.get("status") == "failed":
        failed["fit"] = fit.get("message") or "not fitted"
    if index.get("status", "done") != "done":
        failed["index"] = index.get("message") or index["status"]
    name = stats.get("name") or fit.get("name")
    nearest = next((match for match in snap.get("matches", []) if match["name"] != name), {})
    return {"paint": number, "name": name, "class": stats.get("class"), "fit": fit.get("status"),
            **{key: fit.get(key) for key in ("de00_max", "de00_mean", "gamut_de00")},
            **{key: stats.get(key) for key in ("flop_index", "chroma_index", "hue_shift_index")},
            "worst_deg": index.get("worst_deg"), "nearest": nearest.get("name"), "nearest_distance": nearest.get("distance"),
            "pictures": 0, "failed": failed}


def run_shard(out, number):
    """Does shard `number` of the plan in `out`, unless it is done. It is done when done.json is there, which is written last."""
    plan = files.read_plan(out)
    files.check_number(number, len(plan["shards"]), "shard", out)
    shard = plan["shards"][number]
    folder = out / "shards" / f"{number:04d}"
    with files.locked(folder):
        if (folder / "done.json").exists():
            return
        with open(folder / "log", "a", encoding="utf-8") as log:
            print("begun", file=log)
        for scene in plan["scenes"]:
            picture_path(out, scene, 0).parent.mkdir(parents=True, exist_ok=True)
        work = Shard(plan, out, Checks(folder / "checks"), folder / "drawn")
        with tempfile.TemporaryDirectory(prefix="paint-batch-") as scratch:
            paints = library.paints_at(out / "library.paints.xml", *shard["places"])
            rows = work.rows(shard["first"], paints, pathlib.Path(scratch))
        write_whole(folder / "fitted.txt", "".join(f"  {fitted}\n" for _, fitted in rows))
        files.write_json(folder / "rows.json", [row for row, _ in rows])
        shutil.rmtree(folder / "drawn", ignore_errors=True)
        with open(folder / "log", "a", encoding="utf-8") as log:
            print("finished", file=log)
        files.write_json(folder / "done.json", {"tools_s": work.tools.seconds})
