"""Compares pictures of the engine path with Mitsuba 3: the same mesh, light and lobes, and the time to equal error.

Mitsuba comes from pip, into a virtual environment beside the build. Its variant llvm_ad_rgb is the fastest that it has on a
processor: the others follow one ray at a time, and would ask Python for the BSDF at every surface.
Times are processor time of tracing, without what comes before it: reading, building trees and compiling.
"""

import json
import math
import os
import pathlib
import resource
import subprocess
import time

import numpy

from cross_check.meshes import read_obj
from shared import packages, pictures
from shared.colors import XYZ_FROM_REC2020, de2000, lab_of_rec2020
from shared.files import write_whole
from shared.tools import DATA, SCRIPTS, Failed, builds_folder, run_tool


class NotHere(Exception):
    """Mitsuba cannot be had; the text says why."""


VENV = builds_folder() / "cross-check"
REC2020_FROM_REC709 = ((0.627403896, 0.329283038, 0.043313066), (0.069097289, 0.919540395, 0.011362316),
                       (0.016391439, 0.088013308, 0.895595253))
FOV_DEG, BOUNCES = 34.0, 6
CORNELL = {"Red": "red", "Green": "green", "Lamp": "black"}
CORNELL_LIGHT = (20.0, 18.0, 15.0)


def silver():
    """A paint of seven lobes: half of its light in flakes, a tenth diffuse, and a coat."""
    lobes = []
    for exponent, share, gloss in ((1.3, 0.1, 0), (6, 0.12, 0), (20, 0.12, 0), (70, 0.08, 0), (250, 0.04, 0), (900, 0, 0.02)):
        unit = (exponent + 1) / (2 * math.pi)
        lobes.append([exponent, [share * unit * c for c in (1, 0.99, 0.97)], [gloss * unit] * 3])
    return {"diffuse": [0.1 / math.pi] * 3, "lobes": lobes, "mirror": [0.5] * 3}


def matt(reflectance):
    """A diffuse paint."""
    return {"diffuse": [r / math.pi for r in reflectance], "lobes": [], "mirror": [0, 0, 0]}


CORNELL_PAINTS = {"white": matt((0.75, 0.75, 0.75)), "red": matt((0.62, 0.07, 0.05)), "green": matt((0.1, 0.42, 0.09)),
                  "black": matt((0, 0, 0))}


def paints_xml(paints):
    """The text of a paint file."""
    def three(names, values):
        return " ".join(f'{name}="{value:.9g}"' for name, value in zip(names, values))
    lines = ['<paints xmlns="urn:goniochrome:paint:1" version="1">']
    for name, paint in paints.items():
        lines.append(f'<paint name="{name}"><lobes space="lin_rec2020_scene" basis="stated" method="stated" max_de00="0" mean_de00="0">')
        lines.append("<diffuse " + three("rgb", paint["diffuse"]) + "/>")
        for exponent, dd, gloss in [*paint["lobes"], *([["mirror", [0, 0, 0], paint["mirror"]]] if any(paint["mirror"]) else [])]:
            lines.append(f'<lobe exponent="{exponent}" ' + three(("ddr", "ddg", "ddb"), dd) + " "
                         + three(("gr", "gg", "gb"), gloss) + "/>")
        lines.append("</lobes></paint>")
    return "\n".join([*lines, "</paints>", ""])


def interpreter():
    """(a Python that has mitsuba, the environment to run it in); NotHere says why there is none."""
    packages.install("python3-venv", "libllvm19")
    python = VENV / "bin/python"
    if subprocess.run([python, "-c", "import mitsuba"], capture_output=True, check=False).returncode if python.exists() else True:
        done = subprocess.run(["/usr/bin/python3", "-m", "venv", VENV], capture_output=True, check=False)
        if done.returncode == 0:
            done = subprocess.run([VENV / "bin/pip", "install", "-q", "mitsuba", "numpy"], capture_output=True, check=False)
        if done.returncode:
            raise NotHere("pip cannot install the package mitsuba")
    # LLVM 15 of Debian 12 fails on the programs that Mitsuba writes ("cannot select").
    library = next(iter(sorted(pathlib.Path("/usr/lib").glob("*/libLLVM*19*"))), None)
    return python, {**os.environ, **({"DRJIT_LIBLLVM_PATH": str(library)} if library else {})}


def light_bulbs(probe, at):
    """Writes the probe with 128 x 64 texels for the tools, and for Mitsuba with each of them cut into 8 x 8, in Rec.2020.

    Mitsuba blends neighboring texels, so that only the eighth of a texel at each edge differs.
    """
    channels = pictures.channels(probe)
    rgb = numpy.stack([channels[name] for name in "RGB"], -1).astype(float)
    rows, columns = (size // parts for size, parts in zip(rgb.shape[:2], (64, 128)))
    coarse = rgb[:64 * rows, :128 * columns].reshape(64, rows, 128, columns, 3).mean((1, 3))
    # A lamp of a few texels is the same in both, but its noise would hide all else.
    coarse = numpy.minimum(coarse, 40 * coarse.mean())
    write_whole(at / "probe.exr", pictures.exr_file(coarse, numpy.float32, "a probe with lamps cut off"))
    fine = (coarse @ numpy.transpose(REC2020_FROM_REC709)).repeat(8, 0).repeat(8, 1)
    numpy.save(at / "probe.npy", fine.astype(numpy.float32))


def processor_s():
    """The processor time of all programs so far, every thread's; other work on the machine does not count."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Case:
    """One scene: the words for the tool, and the description for Mitsuba."""

    def __init__(self, name, at, size, mesh, dressed, camera, probe):
        self.name, self.at, self.size = name, at, size
        self.eye, self.target = camera
        self.words = ["--mesh", mesh, "--camera", ",".join(f"{v:.9g}" for v in (*self.eye, *self.target, FOV_DEG)),
                      "--engine", "path", "--bounces", BOUNCES, "--floor", "none", "--operator", "none",
                      "--exposure", 0, "--samples", 1, "-q"]
        if probe:
            self.words += ["--env", at / "probe.env.exr"]
        parts = read_obj(mesh)
        if probe:  # All parts wear one paint.
            self.words += ["--paint", at / "p.xml#silver"]
            starts = numpy.cumsum([0] + [len(part[1]) for part in parts])
            parts = [("all", *(numpy.concatenate([part[k] for part in parts]) for k in (1, 2)),
                      numpy.concatenate([part[3] + start for part, start in zip(parts, starts)]))]
        else:
            self.words += ["--paint", at / "p.xml#white", "--emit", "Lamp=" + ",".join(map(str, CORNELL_LIGHT))]
            for part, paint in dressed.items():
                self.words += ["--part", f"{part}={at / 'p.xml'}#{paint}"]
        self.told = {"parts": [self.part(number, part, dressed, probe) for number, part in enumerate(parts)],
                     "environment": str(at / "probe.npy") if probe else None, "eye": list(self.eye), "target": list(self.target),
                     "fov_deg": FOV_DEG, "size": [size, size], "bounces": BOUNCES}

    def part(self, number, part, dressed, probe):
        """What Mitsuba is told of a part."""
        name = part[0]
        paths = {}
        for key, array in zip(("positions", "normals", "triangles"), part[1:]):
            paths[key] = str(self.at / f"{self.name}-{number}-{key}.npy")
            numpy.save(paths[key], array)
        paint = silver() if probe else CORNELL_PAINTS[dressed.get(name, "white")]
        return {**paths, "paint": paint, "emission": list(CORNELL_LIGHT) if name == "Lamp" and not probe else [0, 0, 0]}

    def ours(self, bin_dir, tolerance, seed, size=None):
        """(the picture, what it covers, the processor seconds of the whole tool)"""
        out, before = self.at / "ours.exr", processor_s()
        run_tool(bin_dir / "render-osmesa", *self.words, "--tolerance", tolerance, "--seed", seed, "--size",
                 f"{size or self.size}x{size or self.size}", "-o", out, done=(0,), command="render-osmesa")
        seconds = processor_s() - before
        channels = pictures.channels(out)
        return numpy.stack([channels[name] for name in "RGB"], -1).astype(float), channels["A"] > 0.99, seconds

    def theirs(self, python, environment, variant, samples, passes, seed, denoise=False):
        """(the mean of the passes, or the last one denoised; what Mitsuba said of its time)"""
        scene, out = self.at / "scene.json", self.at / "theirs.npy"
        scene.write_text(json.dumps({**self.told, "variant": variant, "samples": samples, "passes": passes, "seed": seed,
                                     "denoise": denoise}))
        done = subprocess.run([python, SCRIPTS / "cross_check/draw_with_mitsuba.py", scene, out], capture_output=True, text=True,
                              env=environment, check=False)
        if done.returncode:
            said = done.stderr.strip().splitlines()
            raise Failed(said[-1] if said else f"exit status {done.returncode}", command="mitsuba")
        return numpy.load(out).astype(float), json.loads(done.stdout.strip().splitlines()[-1])


def cases(bin_dir, at, size):
    """The scenes; with GONIOCHROME_DATA the vehicle and the teapot, else the speed shape."""
    data = os.environ.get("GONIOCHROME_DATA")
    probe = sorted(pathlib.Path(data, "probes").glob("studio*"))[0] if data else DATA / "studio.exr"
    light_bulbs(probe, at)
    # Paths take their light from the image itself; the maps are only the file that names it.
    run_tool(bin_dir / "prefilter-envmap", at / "probe.exr", "-e", 1, "--size", 8, "--verify", 0, "-q", "-o", at / "probe.env.exr",
             done=(0,), command="prefilter-envmap")
    (at / "p.xml").write_text(paints_xml({"silver": silver(), **CORNELL_PAINTS}))
    yield Case("Cornell box", at, size, DATA / "cornell.obj", CORNELL, ((0.0, 1.0, 4.3), (0.0, 1.0, 0.0)), False)
    meshes = {name: pathlib.Path(data, "mesh", f"{name}.obj") for name in ("teapot", "vehicle")} if data else {
        "speed shape": DATA / "speed-shape.obj"}
    for name, mesh in meshes.items():
        points = numpy.concatenate([part[1] for part in read_obj(mesh)])
        low, high = points.min(0), points.max(0)
        middle, radius = (low + high) / 2, numpy.linalg.norm(high - low) / 2
        eye = middle + radius * 3.0 * numpy.array((0.6, 0.35, 0.72))
        yield Case(name, at, size, mesh, {}, (tuple(eye), tuple(middle)), True)


def difference(one, two, white):
    """CIEDE2000 of two arrays of Rec.2020 colors before a white of this luminance."""
    return de2000(lab_of_rec2020(one, white), lab_of_rec2020(two, white))


def p95(values):
    """The 95th percentile."""
    return float(numpy.quantile(values, 0.95))


def compared(case, bin_dir, python, environment, samples, tolerance):
    """Figures of one scene; errors are 95th percentiles of dE00, and times are those of tracing to the error of our picture."""
    (one, covered, seconds), (two, _, _) = (case.ours(bin_dir, tolerance, seed) for seed in (1, 2))
    loading = case.ours(bin_dir, 100, 1, size=4)[2]  # what comes before tracing: hardly a pixel is drawn
    halves = [case.theirs(python, environment, "llvm_ad_rgb", samples, 4, seed) for seed in (1, 101)]
    (b1, told), (b2, _) = halves
    ours, theirs = (one + two) / 2, (b1 + b2) / 2
    white = float(numpy.quantile((theirs @ numpy.transpose(XYZ_FROM_REC2020))[..., 1][covered], 0.9)) / 0.5

    def apart(x, y):
        return difference(x[covered], y[covered], white)
    found = apart(ours, theirs)
    noise = 0.5 * math.hypot(p95(apart(one, two)), p95(apart(b1, b2)))
    # Errors of one picture of ours and of one pass of theirs, each against the mean of the other's.
    ours_error = p95(apart(one, two)) / math.sqrt(2)
    pass_error = p95(apart(b1, b2)) / math.sqrt(2) * 2  # each half has four passes
    pass_s = min(told["seconds"])
    return {"difference": p95(found), "noise": noise, "bright": float((ours[covered].mean() / theirs[covered].mean()) - 1),
            "ours_s": max(seconds - loading, 1e-3), "loading_s": loading, "ours_de00": ours_error, "theirs_s": pass_s * (pass_error / ours_error) ** 2,
            "version": told["version"], "pixels": int(covered.sum())}


def lines(bin_dir, at, size=64, samples=128, tolerance=0.7):
    """(what, figure, bound, why) of each comparison; it prints a line of times beside each."""
    python, environment = interpreter()
    for case in cases(bin_dir, at, size):
        began = time.perf_counter()
        f = compared(case, bin_dir, python, environment, samples, tolerance)
        yield (f"Mitsuba {f['version']}, {case.name}, 95th percentile of dE00 over {f['pixels']} pixels", f["difference"],
               1.3 * f["noise"] + 0.2, f"noise of both {f['noise']:.2f}, and edges of texels and triangles")
        print(f"     {case.name}: to an error of {f['ours_de00']:.2f} dE00 ours takes {f['ours_s']:.2f} s (and {f['loading_s']:.2f} s "
              f"before), Mitsuba {f['theirs_s']:.2f} s, which is {f['theirs_s'] / f['ours_s']:.1f} times as long; our mean is "
              f"{100 * f['bright']:+.2f} % off theirs; {time.perf_counter() - began:.0f} s for all of this", flush=True)
