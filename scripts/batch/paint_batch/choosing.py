"""The settings of all stages for a wanted color difference, found by the search of scripts/demo --target-de00."""

import argparse
import pathlib
import re
import shutil
import tempfile

from accuracy_report.scene import Scene
from accuracy_report.study import Run
from accuracy_report.target import BASES, CHOOSING, EFFECTS, INTEGRALS, METHODS, TOLERANCES, Job, found
from shared import paint_text as library
from shared.tools import DATA, Failed, tools_folder

from .steps import Shard, frame_words, scene_name

PROBED = 50  # paints, spread over the library, by which the fits are timed
SAMPLES = 8  # those of them whose pictures are checked
PROVING = 200  # the random pixels at which such a picture is checked
SEED = 3  # the seed of the first paint's check; the search uses the seeds 1 and 2


class NotReached(Exception):
    """There are no settings that bring the samples within the target."""


def probed(options, out, places, folder):
    """(name, text) of paints that can be fitted, spread over the library."""
    given = library.spread(out / "library.paints.xml", places, PROBED)
    work = Shard({"basis": options.basis or DATA / f"{BASES[0]}.basis.xml", "gloss": options.gloss}, out)
    fits = work.tools.lines(work.fit, given, folder)
    known = [(fit[1]["name"], text) for text, fit in zip(given, fits)
             if not isinstance(fit, Failed) and fit[1].get("de00_mean") is not None]
    if not known:
        raise Failed(f"{options.library}: none of {len(given)} paints spread over it can be fitted, to choose settings by")
    return known


def renamed(text, name):
    """The text of a paint with another name. FILE#NAME could not name a paint that has a # in its name."""
    return re.sub(r"""(<paint\b[^>]*?\bname=)("[^"]*"|'[^']*')""", rf'\1"{name}"', text, count=1)


def job_of(run, options, names, paints):
    """The Job of every sample in every scene of the batch."""
    basis = options.basis and options.basis.absolute()
    scenes = [Scene(run, name, pathlib.Path(env).absolute(), frame_words(view, options.size), CHOOSING,
                    mesh=pathlib.Path(mesh).absolute(), basis=basis, fitting=("--gloss", options.gloss) if options.gloss else ())
              for name in names for env in options.env for mesh in options.mesh for view in options.view]
    return Job(scenes, paints, (basis.name.split(".")[0],) if basis else BASES, PROVING)


def choose(options, out, places):
    """(the basis, what plan.json tells of the target: the options of the stages, and the errors that prove them)"""
    with tempfile.TemporaryDirectory(prefix="paint-batch-") as scratch:
        folder = pathlib.Path(scratch)
        known = probed(options, out, places, folder)
        count = min(SAMPLES, len(known))
        samples = [i * len(known) // count for i in range(count)]  # The number of a sample is also its name.
        paints = folder / "probed.paints.xml"
        paints.write_text(library.document([renamed(text, i) for i, (_, text) in enumerate(known)]), encoding="utf-8")
        given = argparse.Namespace(quick=True, paints=paints, probe=pathlib.Path(options.env[0]),
                                   mesh=pathlib.Path(options.mesh[0]), output=None)
        with Run(tools_folder(), given) as run:
            job = job_of(run, options, map(str, samples), len(places))
            try:
                answer = found(job, options.target_de00)
            except Failed as failure:
                raise Failed(failure.said) from None  # without the command, whose files are those of the search
            proof = {"paints": count, "pixels": PROVING, **worst_of(job, answer, known)}
            if answer.de00() > options.target_de00:
                raise NotReached(f"a mean dE00 of {options.target_de00:g} is not reached by {count} paint{'s' * (count > 1)} "
                                 f"of the library: at best {told(proof)} with {answer.settings}; "
                                 "nothing is planned: give a larger target")
            basis = job.scenes[0].basis_file(answer.settings)
            if basis.parent == run.work:
                basis = pathlib.Path(shutil.copy(basis, out))
    settings = answer.settings
    return basis, {"de00": options.target_de00, "settings": str(settings), "fit": settings.fit_words(),
                   "prefilter": settings.prefilter, "render": settings.render_words(), "check": options.check, "seed": SEED,
                   "proof": proof}



def worst_of(job, answer, known):
    """The paint and the scene with the largest error."""
    scene, error = job.scenes[answer.worst()], answer.errors[answer.worst()]
    return {"paint": known[int(scene.paint)][0], "scene": scene_name(scene.probe, scene.mesh, scene.frame[1]),
            "fit_de00": error["fit_de00"], "picture_de00": error["render_de00"], "total_de00": answer.de00()}


def told(proof):
    return (f"{proof['total_de00']:.2f} (fit {proof['fit_de00']:.2f}, picture {proof['picture_de00']:.2f}: {proof['paint']}, "
            f"{proof['scene']})")


def announced(options, paints, scenes, typical):
    """The text that tells what the search will do, with a time from typical costs."""
    samples, bases = min(SAMPLES, paints), 1 if options.basis else len(BASES)
    pictures = samples * scenes
    timed_s = bases * len(TOLERANCES) * (len(options.env) * typical["environment_s"] + pictures * typical["alone_s"])
    timed_s += bases * len(INTEGRALS) * pictures * typical["integral_s"]
    pixels = (bases + 3) * CHOOSING + 2 * PROVING  # the checks of the bases, of the cheapest settings, and of what proves them
    checks_s = pictures * (pixels * typical["check_pixel_s"] + (bases + 5) * typical["alone_s"])
    return (f"  choose, once, for a mean dE00 of {options.target_de00:g}: "
            f"the cheapest of {bases} bas{'es' if bases > 1 else 'is'}, {len(METHODS)} methods with and without views, "
            f"{len(TOLERANCES)} tolerances of environments, {len(EFFECTS) + 1} of effects and {len(INTEGRALS)} of the integral, "
            f"for {samples} paint{'s' * (samples > 1)} spread over the library: about {timed_s + checks_s:.0f} s\n")


def explained(target):
    proof = target["proof"]
    return (f"chosen: {target['settings']}\n"
            f"  dE00 {told(proof)} at worst of {proof['paints']} paints, by {proof['pixels']} pixels of each picture")
