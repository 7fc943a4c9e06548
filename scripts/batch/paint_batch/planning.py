"""Prepares what all shards share, measures what a paint costs, and cuts the library into shards of about equal time."""

import contextlib
import pathlib
import sys
import tempfile
import time

from shared import paint_text as library
from shared.tools import Failed

from . import choosing, files
from .steps import Shard, scene_name
from .tools import Tools

PROBE = 400  # paints, spread over the library, whose cost is measured
PICTURED = 3  # those of them that are drawn with a check, each by a run of its own
STREAMED = 20  # those of them that are drawn by a stream
JOB_S = 0.5  # the seconds that a workflow engine and Python add to a shard

# Seconds on a core of a server of 2020, for the plan that is printed before anything is measured.
TYPICAL = {"clean_s": 0.0001, "environment_s": 1.0, "stream_s": 0.0005, "picture_s": 0.03, "alone_s": 0.25, "integral_s": 2.0,
           "check_pixel_s": 0.01, "start_s": 0.1}


def roughly_counted(path):
    """The number of paints in a library: exact for paint XML, estimated from the size of the file for tables."""
    if path == "-" or not pathlib.Path(path).is_file():
        return 0
    paints = sum(1 for _ in library.places(path))
    return paints or max(1, pathlib.Path(path).stat().st_size // 150)


def announce(options):
    """Prints what will be done, with a time from typical costs. The measured time follows after the preparation."""
    paints = roughly_counted(options.library)
    scenes = len(options.env) * len(options.mesh) * len(options.view)
    pictured_s = (min(PICTURED, paints) * TYPICAL["alone_s"] if options.target_de00 else
                  min(STREAMED, paints) * TYPICAL["picture_s"] + 2 * TYPICAL["alone_s"]) * scenes
    probed_s = min(PROBE, paints) * 2 * TYPICAL["stream_s"] + pictured_s + 2 * TYPICAL["start_s"]
    unfiltered = sum(not env.endswith(".env.exr") for env in options.env)
    prepare_s = paints * TYPICAL["clean_s"] + unfiltered * TYPICAL["environment_s"] + probed_s
    picture_s, choice, checked = TYPICAL["picture_s"], "", ""
    if options.target_de00:
        picture_s = TYPICAL["alone_s"] + options.check * TYPICAL["check_pixel_s"]
        choice, checked = choosing.announced(options, paints, scenes, TYPICAL), f", each checked at {options.check} pixels"
    work_s = paints * (TYPICAL["stream_s"] + scenes * picture_s)
    print(f"plan: {options.library}, about {paints} paints\n{choice}"
          f"  prepare, once: clean the library, filter {len(options.env)} environments, measure {min(PROBE, paints)} paints: "
          f"about {prepare_s:.0f} s\n"
          f"  in shards: fit-paint, paint-stats, goniogeom-index, colorsnap, {scenes} pictures a paint{checked}: "
          f"about {work_s:.0f} s of work, {work_s / options.cores:.0f} s on {options.cores} cores\n"
          "  merge the report, write the chapters of the book\n"
          "(from typical costs of a tool; the measured estimate follows the preparation)", file=sys.stderr, flush=True)


def clean_library(options, out):
    """Writes the paints that can be read, and the messages about those that cannot."""
    tools = Tools()
    out.mkdir(parents=True, exist_ok=True)
    clean = out / "library.paints.xml"
    rejected = out / "rejected.json"
    if not (clean.exists() and rejected.exists()):
        converted, reports = out / "converted.paints.xml", [out / "convert.tmp.json", out / "clean.tmp.json"]
        tools.run("paint-convert", "-q", "-k", "--report", reports[0], "--to", "xml", options.library, "-o", converted)
        tools.run("paint-stats", "-q", "-k", "-f", "paints", "--report", reports[1], converted, "-o", clean)
        files.write_json(rejected, [warning for report in reports
                                    for warning in files.read_json(report)["results"].get("warnings", [])])
        for file in [converted, *reports]:
            file.unlink()


def filtered(options, out, source, basis, target):
    """The filtered environment of a source, which is made in the folder of the batch unless the source is one already."""
    if source.endswith(".env.exr"):
        return pathlib.Path(source).absolute()
    name = pathlib.Path(source).stem
    words = ["--size", options.env_size]
    if target:  # The name has the settings, because a plan that was interrupted may choose others.
        name = f"{name}-{pathlib.Path(basis).name.split('.')[0]}-{target['prefilter']:g}"
        words, source = ["--tolerance", target["prefilter"]], pathlib.Path(source).absolute()
    made = out / "environments" / f"{name}.env.exr"
    made.parent.mkdir(exist_ok=True)
    if not made.exists():
        Tools().run("prefilter-envmap", "-q", *words, "--basis", basis, source, "-o", made)
    return pathlib.Path("out") / made.relative_to(out)  # Every scratch folder has a link "out" to the batch.


def prepared_scenes(options, out, basis, target):
    """The scenes of the batch: every mesh and view in every environment."""
    scenes = []
    for source in options.env:
        env = filtered(options, out, source, basis, target)
        scenes += [{"env": str(env), "mesh": str(pathlib.Path(mesh).absolute()), "view": view,
                    "name": scene_name(source, mesh, view),
                    **({"source": str(pathlib.Path(source).absolute())} if target else {})}
                   for mesh in options.mesh for view in options.view]
    return scenes


def stream_seconds(work, paints, folder):
    """The seconds of all steps except the pictures."""
    work.tools.seconds = {}
    for step in (work.fit, work.stats, work.index, work.snap):
        work.tools.lines(step, paints, folder)
    return sum(work.tools.seconds.values())


def measured(plan, out, places):
    """The seconds of a paint, of a picture and of a start of all tools, from PROBE paints, of which STREAMED are drawn or, with
    --target-de00, PICTURED."""
    paints = library.spread(out / "library.paints.xml", places, PROBE)
    with tempfile.TemporaryDirectory(prefix="paint-batch-") as scratch:
        folder = pathlib.Path(scratch)
        work = Shard(plan, out)
        work.tools.lines(work.snap, paints[:1], folder)  # This makes the index that all shards share.
        start_s = stream_seconds(work, paints[:1], folder)
        stream_s = max(0, stream_seconds(work, paints, folder) - start_s) / max(1, len(paints) - 1)
        fitted = [fit[0] for fit in work.tools.lines(work.fit, paints, folder) if not isinstance(fit, Failed)]
        if not work.target:
            picture_s, scenes_s = streamed_seconds(plan, work, fitted[:STREAMED], folder)
            return {"start_s": start_s + scenes_s + JOB_S, "stream_s": stream_s, "picture_s": picture_s}
        drawn_s = picture_seconds(plan, work, fitted, lambda scene, paint: work.draw(scene, paint, folder, "p.png"))
        checked_s = picture_seconds(plan, work, fitted, lambda scene, paint: work.checked(scene, 0, paint, folder, "p.png"))
    return {"start_s": start_s + JOB_S, "stream_s": stream_s, "picture_s": checked_s, "check_s": max(0, checked_s - drawn_s)}


def streamed_seconds(plan, work, fitted, folder):
    """(the seconds of a picture in a stream, the seconds that a shard takes to begin the streams of all scenes)"""
    def seconds(count):
        work.tools.seconds = {}
        for scene in plan["scenes"]:
            with contextlib.suppress(Failed):
                work.render(scene, fitted[:count], folder, "p{index}.png")
        return work.tools.seconds.get("render-osmesa", 0)

    if not fitted or not plan["scenes"]:
        return 0.0, 0.0
    one_s, scenes = seconds(1), len(plan["scenes"])
    if len(fitted) == 1:
        return one_s / scenes, 0.0
    picture_s = max(0, seconds(len(fitted)) - one_s) / (len(fitted) - 1) / scenes
    return picture_s, max(0, one_s - scenes * picture_s)


def picture_seconds(plan, work, fitted, draw):
    """The seconds of a picture, from PICTURED of the fitted paints."""
    work.tools.seconds = {}
    drawn = 0
    for paint in fitted[:PICTURED]:
        for scene in plan["scenes"]:
            with contextlib.suppress(Failed):
                draw(scene, paint)
                drawn += 1
    return work.tools.seconds.get("render-osmesa", 0) / max(1, drawn)


def make(options):
    """Writes plan.json into options.out and returns (the plan, the seconds that this took).

    A plan that is already there is kept, so that a batch that is continued has the same shards.
    """
    out = options.out.absolute()
    if (out / "plan.json").exists():
        plan = files.read_json(out / "plan.json")
        held = plan.get("target", {}).get("de00")
        if held != options.target_de00:
            made = f"for a mean dE00 of {held:g}" if held else "without --target-de00"
            raise Failed(f"{out / 'plan.json'} was made {made}: give another --out, or the same target again")
        return plan, 0.0
    started = time.monotonic()
    clean_library(options, out)
    places = list(library.places(out / "library.paints.xml"))
    if not places:
        raise Failed(f"{options.library}: there is no paint in it that can be read")
    basis, target = choosing.choose(options, out, places) if options.target_de00 else (options.basis.absolute(), None)
    scenes = prepared_scenes(options, out, basis, target)
    plan = {"library": str(options.library), "basis": str(basis), "gloss": options.gloss, "size": options.size,
            "against": str(options.against.absolute() if options.against else out / "library.paints.xml"), "scenes": scenes,
            "chapter": options.chapter, "paints": len(places), "cores": options.cores, **({"target": target} if target else {})}
    cost = measured(plan, out, places)
    paint_s = cost["stream_s"] + cost["picture_s"] * len(scenes)
    # A shard takes about shard_s. Every core gets at least two shards, if a shard then still takes 20 times its overhead.
    wanted = max(len(places) * paint_s / options.shard_s, min(2 * options.cores, len(places) * paint_s / (20 * cost["start_s"])))
    size = options.shard_paints or max(1, round(len(places) / max(1, wanted)))
    cuts = range(0, len(places), size)
    plan["shards"] = [{"first": i, "places": [places[i], places[min(i + size, len(places)) - 1]]} for i in cuts]
    work_s = len(places) * paint_s + len(cuts) * cost["start_s"]
    plan["estimate"] = {**cost, "paint_s": paint_s, "work_s": work_s, "elapsed_s": work_s / min(options.cores, len(cuts))}
    files.write_json(out / "plan.json", plan)
    return plan, time.monotonic() - started


def explain(plan, took_s):
    """Prints the estimate that follows from measured costs."""
    e, target = plan["estimate"], plan.get("target")
    chosen = f"{choosing.explained(target)}\n" if target else ""
    checked = f", of which its check at {target['check']} pixels takes {e['check_s'] * 1000:.0f} ms" if target else ""
    print(f"{chosen}{plan['paints']} paints, {len(plan['scenes'])} pictures each, in {len(plan['shards'])} shards; "
          f"prepared in {took_s:.1f} s\n"
          f"measured: {e['stream_s'] * 1000:.1f} ms a paint to fit, tell, check and search, "
          f"{e['picture_s'] * 1000:.0f} ms a picture{checked}\n"
          f"estimate: {e['work_s']:.0f} s of work, {e['elapsed_s']:.0f} s on {plan['cores']} cores", file=sys.stderr)
