"""Paints that are searched for: sketch-fit against the paint in which a picture was drawn, trompe-fit against flush panels."""

import itertools
import statistics

from .study import Figure, Reading, Study

# A paint whose colors are known at every angle. At 45 deg its curve is at 0.29 of the way from the flop to the face.
PLANTED = """<paints xmlns="urn:goniochrome:paint:1" version="1">
<paint name="steel"><gloss angle="60">85</gloss>\
<appearance travel="80"><face L="75" a="-5" b="-20"/><flop L="25" a="-2" b="-10"/></appearance></paint>
</paints>
"""
SHAPE = 16 / 10  # the width of a picture, divided by its height
ANGLE_DEG = 2
VARIED = ("face_l", "face_l,travel", "face_l,flop_l,travel", "face_l,face_ab,flop_l,flop_ab,travel")
LIGHTS = ("--lights", "30,45,60", "--views", "as15:105:15")


def drawn(run, light, width):
    """Draws the planted paint and returns (picture, buffers).

    All effects are drawn, since a lobe that the picture leaves out cannot be found in it.
    """
    picture, buffers = run.work / "sketch.png", run.work / "sketch.exr"
    words = ("--mesh", run.data / "speed-shape.obj", "--paint", run.work / "planted-fitted.xml", *light,
             "--size", f"{width}x{int(width / SHAPE)}", "--samples", 1, "--effects", "all,-rays")
    run.tool("render-osmesa", *words, "-o", picture)
    run.tool("render-osmesa", *words, "--aov", "normal,aspecular,lambert,mask,part", "-o", buffers)
    return picture, buffers


def sketches(run):
    """Readings of sketch-fit by the size of the picture, under a lamp and in an environment."""
    planted, env, found = run.work / "planted.xml", run.work / "planted.env.exr", run.work / "found.xml"
    planted.write_text(PLANTED)
    basis = ("--basis", run.data / "b7.basis.xml")
    run.tool("fit-paint", *basis, planted, "-o", run.work / "planted-fitted.xml")
    run.tool("prefilter-envmap", run.probe, *basis, "-o", env)
    lights = {"lamp": (("--light", "35,45"), basis), "environment": (("--env", env), ("--env", env))}
    for (name, (light, told)), width in itertools.product(lights.items(), (80, 160) if run.quick else (80, 160, 320)):
        picture, buffers = drawn(run, light, width)
        results, best, raw = run.repeated("sketch-fit", "--image", picture, "--buffers", buffers, *told, "-o", found)
        snapped, _ = run.tool("colorsnap", found, "--library", planted, "--metric", "de00", "-o", run.work / "match.tsv")
        error = snapped["queries"][0]["matches"][0]["mean_de"]
        numbers = {"n": width * int(width / SHAPE), "used": results["pixels_used"], "fit_s": results["fit_s"],
                   "model": results["model"]}
        yield Reading(f"{name}, {width} pixels wide", best, error, name, raw_s=raw, numbers=numbers)


def hidden(run, vary, objective, *mode):
    """A reading of trompe-fit for the whole library, with panels that are turned by ANGLE_DEG."""
    words = ("trompe-fit", run.paints, "--angle", ANGLE_DEG, *LIGHTS, "--vary", vary, "--objective", objective,
             "--mode", *mode, "-o", run.work / "hidden.xml")
    results, best, raw = run.repeated(*words)
    fits = [fit for fit in results.get("fits", [results]) if fit["status"] != "failed"]
    paints = len({fit.get("name", "").partition(".light")[0] for fit in fits})  # --mode rows makes a fit for each light.
    left, largest, before = (statistics.mean(fit[when][what] for fit in fits)
                             for when, what in (("after", "rms"), ("after", "max"), ("before", "rms")))
    return Reading(f"{vary}; {objective}; {' '.join(mode)}", best / paints, left, objective,
                   raw_s=tuple(s / paints for s in raw), numbers={"before": before, "largest": largest},
                   again=lambda: run.tool(*words)[1] / paints)


def study(run):
    seen = list(sketches(run))
    panels = [hidden(run, vary, "rms", "all") for vary in VARIED] + [hidden(run, VARIED[-1], "max", "all")]
    next(r for r in panels if r.setting.startswith(f"{VARIED[-1]}; rms")).default = True
    modes = [hidden(run, VARIED[-1], "rms", *mode) for mode in (("single", "--at", "45,0"), ("rows",))]
    figures = [Figure("sketch", "sketch-fit: dE00 to the paint that was drawn against the size of the picture", seen,
                      "pixels of the picture", "dE00, mean", front=False, x=lambda r: r.numbers["n"],
                      note="There is no dashed line here: the size is not a setting of sketch-fit. Its times are in the table."),
               Figure("trompe", f"trompe-fit: difference left between panels turned by {ANGLE_DEG} deg against time", panels,
                      "time for a paint (s)", "dE76, RMS over the geometries",
                      note="The points differ in what may change, from only L* of the face to all five parameters.")]
    sketch_rows = [(r.setting, r.numbers["used"], r.time_s, r.numbers["fit_s"], r.error, r.numbers["model"]) for r in seen]
    trompe_rows = [(r.setting, 1e3 * r.time_s, r.numbers["before"], r.error, r.numbers["largest"]) for r in panels + modes]
    text = ("A paint with known colors is drawn with all effects under a lamp and in the environment, as PNG, and sketch-fit "
            "looks for it in pictures of several sizes. The error is the mean dE00, at the export angles, of the paint that it "
            "finds. trompe-fit looks for the paint of the second panel, for every paint of the library, under lights at 30, 45 "
            "and 60 deg and for viewers from 15 to 105 deg beside their mirror directions. Its error is the difference that is "
            "left between the two panels.")
    return Study("Paints that are searched for", text, figures,
                 [("sketch-fit",
                   ("light, picture", "pixels used", "time (s)", "fit alone (s)", "dE00", "model"), sketch_rows),
                  ("trompe-fit",
                   ("may change; objective; mode", "time (ms)", "before, RMS", "left, RMS", "left, largest"), trompe_rows)])
