#!/usr/bin/python3
"""Default pictures of meshes, probes and paints: what each costs, and how far it is from a long reference by the same effects.

scripts/bench pictures runs this.
"""

import argparse
import json
import os
import pathlib
import sys
import tempfile
import time

sys.dont_write_bytecode = True

import numpy

from shared import pictures
from shared.colors import de2000, lab_of_rec2020
from shared.tools import DATA, Failed, put_tools_into_path, run_tool

PAINTS = {"silver_fine": "paints", "candy_red": "paints", "film_green_violet": "travel"}
REFERENCE = ("--aov", "part,normal", "--tolerance", "0.3", "--time-limit", "30", "--seed", "7")
FLAT = 1.25  # A pixel that is no brighter than this many times its neighbors is no highlight.
BLACK = 0.005  # of the white
SAME_PIECE = 0.96  # cosine of the normals
MOST_RATIO = 1.25  # of the true noise to that which is told


def scene_files():
    """({name: mesh and its words}, {name: image}): of testdata, and those of GONIOCHROME_DATA where that is set."""
    meshes = {"speed-shape": (DATA / "speed-shape.obj",)}
    probes = {name: DATA / f"{name}.exr" for name in ("studio", "outdoor")}
    folder = os.environ.get("GONIOCHROME_DATA")
    if folder:
        meshes |= {"vehicle": (f"{folder}/mesh/vehicle.obj", "--trim"), "teapot": (f"{folder}/mesh/teapot.obj",)}
        probes = {path.stem: path for path in sorted(pathlib.Path(folder, "probes").glob("*.hdr"))}
    return meshes, probes


class Picture:
    """A picture that render-osmesa drew: its colors, its report, and what the process took."""

    def __init__(self, out, *words):
        report, begin = out.with_suffix(".json"), time.monotonic()
        # A child of this process would count its memory before it becomes another program.
        used = out.with_suffix(".used")
        run_tool("time", "--quiet", "-f", "%U %S %M", "-o", used, "render-osmesa", "-q", *words, "--background", "env",
                 "-o", out, "--report", report, done=(0, 4))
        self.seconds = time.monotonic() - begin
        user_s, system_s, peak_kb = map(float, used.read_text().split())
        self.cpu_s, self.peak_mb = user_s + system_s, peak_kb / 1024
        self.planes = pictures.channels(out)
        self.rgb = numpy.stack([self.planes[name] for name in "RGB"], -1).astype(float)
        self.report = json.loads(report.read_text())["results"]


class Reference(Picture):
    """A long picture, which tells the part and the normal that a pixel shows, too."""

    def __init__(self, out, *words):
        super().__init__(out, *words, *REFERENCE)
        self.part = self.planes["part"]
        self.seen = self.part > 0
        self.normal = numpy.stack([self.planes[f"normal.{axis}"] for axis in "XYZ"], -1)

    def de00_of(self, picture):
        """CIEDE2000 of a picture at each pixel that shows the mesh, before the white of the reference."""
        return de2000(*(lab_of_rec2020(p.rgb[self.seen], self.report["white_luminance"]) for p in (picture, self)))

    def isolated(self, picture):
        """The number of pixels of a picture over twice all their neighbors, on one even piece of surface with these, that are no
        highlights of the reference."""
        height, width = self.part.shape
        middle = (slice(1, -1), slice(1, -1))
        neighbors = [(slice(v, height - 2 + v), slice(u, width - 2 + u))
                     for v in range(3) for u in range(3) if (u, v) != (1, 1)]
        flat = self.seen[middle] & numpy.all([(self.part[at] == self.part[middle]) &
                                              ((self.normal[at] * self.normal[middle]).sum(-1) > SAME_PIECE)
                                              for at in neighbors], 0)
        light, true = picture.rgb.mean(-1), self.rgb.mean(-1)
        flat &= light[middle] > BLACK * self.report["white_luminance"]
        return int((flat & (light[middle] > 2 * numpy.max([light[at] for at in neighbors], 0)) &
                    (true[middle] < FLAT * numpy.max([true[at] for at in neighbors], 0))).sum())


def row(name, words, work, size):
    """Draws a default picture and its reference, prints their row, and returns whether what is told of the noise is true."""
    out = Picture(work / "picture.exr", *words, "--size", size)
    reference = Reference(work / "reference.exr", *words, "--size", size)
    error, rays = reference.de00_of(out), out.report.get("rays", {})
    told, p95 = rays.get("noise_de00_p95", 0.0), float(numpy.quantile(error, 0.95))
    left = reference.report.get("rays", {}).get("noise_de00_p95", 0.0)
    per_1e5 = 1e5 * reference.isolated(out) / reference.seen.size
    print(f"{name:58} {size:>9} {out.seconds:6.2f} {out.cpu_s:6.2f} {out.peak_mb:6.0f}  {error.mean():5.2f} {p95:5.2f}"
          f"  {told:5.2f} {rays.get('error_de00_p95', 0.0):5.2f} {left:5.2f} {per_1e5:6.1f}", flush=True)
    return p95 <= MOST_RATIO * (told ** 2 + left ** 2) ** 0.5


def main():
    parser = argparse.ArgumentParser(prog="bench pictures", description=__doc__)
    parser.add_argument("--size", default="1280x720", help="size of the pictures [%(default)s]")
    parser.add_argument("--only", default="", metavar="WORD", help="draw only pictures whose name has this word")
    chosen = parser.parse_args()
    put_tools_into_path()
    meshes, probes = scene_files()
    names = [f"{mesh} {probe} {paint}" for probe in probes for mesh in meshes for paint in PAINTS]
    if not any(chosen.only in name for name in names):
        parser.error(f"no picture has {chosen.only} in its name; the first is {names[0]}")
    print(f"{'mesh, probe, paint':58} {'size':>9} {'s':>6} {'cpu s':>6} {'MB':>6}  {'mean':>5} {'p95':>5}  {'noise':>5} {'error':>5}"
          f" {'ref.':>5} {'specks':>6}")
    true = True
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for library in sorted(set(PAINTS.values())):
            run_tool("fit-paint", "--basis", DATA / "b7.basis.xml", DATA / f"{library}.paints.xml", "-o", work / f"{library}.xml")
        for probe, image in probes.items():
            env = work / f"{probe}.env.exr"
            for mesh, (obj, *more) in meshes.items():
                for paint, library in PAINTS.items():
                    name = f"{mesh} {probe} {paint}"
                    if chosen.only not in name:
                        continue
                    if not env.exists():
                        run_tool("prefilter-envmap", image, "--basis", DATA / "b7.basis.xml", "-o", env)
                    words = ("--mesh", obj, *more, "--env", env, "--paint", f"{work / library}.xml#{paint}")
                    true &= row(name, words, work, chosen.size)
    return 0 if true else 1


try:
    sys.exit(main())
except Failed as failed:
    print(f"bench pictures: {failed}", file=sys.stderr)
    sys.exit(failed.status)
