"""Compares the time of prefilter-envmap with that of the bare transforms of the same degrees by ducc0, on one core.

ducc0 comes from pip, into a virtual environment beside the build. Its time is that of spherical harmonic transforms alone: from
the rows of the map to the coefficients, and from these to the directions of the texels. Ours is that of the whole process.
"""

import json
import os
import resource
import subprocess

from cross_check.with_mitsuba import VENV
from shared.tools import DATA, run_tool

SIZE, TOLERANCE = 128, 1e-4


class NotHere(Exception):
    """ducc0 cannot be had; the text says why."""


# Reads {"width", "height", "analyses": [degree...], "syntheses": [degree...], "size"}; prints the processor seconds.
TRANSFORMS = """
import json, math, sys, time
import ducc0, numpy
ask = json.load(sys.stdin)
random = numpy.random.default_rng(1)
side = 2 * (numpy.arange(ask["size"]) + .5) / ask["size"] - 1
x, y = numpy.meshgrid(side, side)
one = numpy.ones_like(x)
faces = [(one, y, x), (-one, y, x), (x, one, y), (x, -one, y), (x, y, one), (x, y, -one)]
d = numpy.concatenate([numpy.stack(face, -1).reshape(-1, 3) for face in faces])
d /= numpy.linalg.norm(d, axis=1)[:, None]
loc = numpy.stack([numpy.arccos(d[:, 1]), numpy.arctan2(d[:, 0], -d[:, 2]) % (2 * math.pi)], -1)
rows = random.random((1, ask["height"], ask["width"]))
def once():
    begin = time.process_time()
    for degree in ask["analyses"]:
        for channel in range(3):
            ducc0.sht.adjoint_synthesis_2d(map=rows, spin=0, lmax=degree, mmax=degree, geometry="F1", nthreads=1)
    for degree in ask["syntheses"]:
        alm = random.random((1, (degree + 1) * (degree + 2) // 2)) + 0j
        for channel in range(3):
            ducc0.sht.synthesis_general(alm=alm, spin=0, lmax=degree, loc=loc, epsilon=1e-6, nthreads=1)
    return time.process_time() - begin
once()
print(min(once() for _ in range(3)))
"""


def python_with_ducc0():
    """The Python of the virtual environment, with ducc0 in it. Raises NotHere."""
    python = VENV / "bin/python"
    steps = [] if python.exists() else [["/usr/bin/python3", "-m", "venv", "--system-site-packages", VENV]]
    steps.append([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "ducc0"])
    for step in steps:
        done = subprocess.run(step, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode:
            raise NotHere(f"pip cannot install it: {(done.stdout.strip().splitlines() or ['no message'])[-1]}")
    return python


def processor_s(bin_dir, at, *options):
    """The processor time of one run of prefilter-envmap on one thread."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run_tool(bin_dir / "prefilter-envmap", DATA / "studio.exr", "--basis", DATA / "b7.basis.xml", "--size", SIZE, "--tolerance",
             TOLERANCE, "--threads", 1, "-q", "-o", at / "studio.env.exr", *options)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def lines(bin_dir, at):
    """Yields (what, figure, bound, why). Raises NotHere."""
    python = python_with_ducc0()
    report = at / "report.json"
    processor_s(bin_dir, at, "--verify", 20, "--report", report)
    results = json.loads(report.read_text())["results"]
    error = max(lobe["max_rel_error"] for lobe in results["lobes"])
    degrees = [lobe["degree"] for lobe in results["lobes"] if lobe["degree"] > 0]
    analyses = {max([lobe["degree"] for lobe in results["lobes"] if lobe["method"] == method], default=0)
                for method in ("harmonics", "harmonics+bright")} - {0}
    ask = {"width": results["source"]["width"], "height": results["source"]["height"], "size": SIZE,
           "analyses": sorted(analyses), "syntheses": degrees}
    done = subprocess.run([python, "-c", TRANSFORMS], input=json.dumps(ask), capture_output=True, text=True, check=False,
                          env={**os.environ, "OMP_NUM_THREADS": "1"})
    if done.returncode:
        raise NotHere(f"it does not run: {(done.stderr.strip().splitlines() or ['no message'])[-1]}")
    ours = min(processor_s(bin_dir, at) for _ in range(3))
    yield ("prefilter-envmap, 7 lobes of 128 texels, largest relative error of 20 texels a lobe", error, TOLERANCE, "its tolerance")
    yield (f"ducc0, {float(done.stdout):.2f} s for the transforms alone; prefilter-envmap, {ours:.2f} s for all it does, ratio",
           ours / float(done.stdout), 3, "both on one core; a build without optimization takes longer")
