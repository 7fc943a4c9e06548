"""Times pictures of the defaults beside Mitsuba 3, alone and with Open Image Denoise, to an equal error.

The error is that of one picture against long paths of the engine path, whose agreement with Mitsuba with_mitsuba measures; it is
the 95th percentile of dE00 over the pixels of the mesh. Times are processor time, those of Mitsuba without reading, compiling and
the setting up of the denoiser.
"""

import math
import subprocess

import numpy

from cross_check import with_mitsuba
from cross_check.with_mitsuba import VENV, NotHere, difference, p95
from shared.tools import run_tool

SIZE, REFERENCE_DE00 = 320, 0.35
SAMPLES = (4, 16, 64, 256)


def interpreter():
    """That of with_mitsuba, with a denoiser; NotHere says why there is none."""
    python, environment = with_mitsuba.interpreter()
    if subprocess.run([python, "-c", "import pyoidn"], capture_output=True, check=False).returncode:
        done = subprocess.run([VENV / "bin/pip", "install", "-q", "pyoidn"], capture_output=True, check=False)
        if done.returncode:
            raise NotHere("pip cannot install the package pyoidn")
    return python, environment


def time_to(error, found):
    """Processor seconds at which the error of a series (seconds, error) is this one, along straight lines of both logarithms.

    Beyond the last it is the least that is possible: no error falls faster than that of samples, which halves in four times the time.
    """
    found = sorted(found)
    for (t0, e0), (t1, e1) in zip(found, found[1:]):
        if e1 <= error < e0:
            return t0 * (t1 / t0) ** (math.log(e0 / error) / math.log(e0 / e1))
    if found[0][1] <= error:
        return found[0][0]
    return found[-1][0] * (found[-1][1] / error) ** 2


def lines(bin_dir, at):
    """(what, figure, bound, why) of each scene but the Cornell box; it prints the errors and times beside it."""
    python, environment = interpreter()
    for case in with_mitsuba.cases(bin_dir, at, SIZE):
        if case.name != "Cornell box":
            yield compared(case, bin_dir, python, environment, at)


def compared(case, bin_dir, python, environment, at):
    """The line of one scene: our processor seconds beside those of Mitsuba and the denoiser to our error, as a ratio."""
    truth, covered, _ = case.ours(bin_dir, REFERENCE_DE00, 7)
    run_tool(bin_dir / "prefilter-envmap", at / "probe.exr", "--for", at / "p.xml", "-q", "-o", at / "maps.env.exr", done=(0,),
             command="prefilter-envmap")
    case.words = [{"path": "auto", at / "probe.env.exr": at / "maps.env.exr"}.get(word, word) for word in case.words]
    white = float(numpy.quantile((truth @ numpy.transpose(with_mitsuba.XYZ_FROM_REC2020))[..., 1][covered], 0.9)) / 0.5

    def error(picture):
        return p95(difference(picture[covered], truth[covered], white))
    ours, _, seconds = case.ours(bin_dir, 1, 1)
    alone, clean = [], []
    for samples in SAMPLES:
        picture, told = case.theirs(python, environment, "llvm_ad_rgb", samples, 2, 11)
        alone.append((told["seconds"][0], error(picture) * math.sqrt(2)))  # The mean of two passes has half of the variance of one.
        picture, told = case.theirs(python, environment, "llvm_ad_rgb", samples, 2, 11, denoise=True)
        clean.append((told["seconds"][0] + told["denoise_s"], error(picture)))
    reached = error(ours)
    print(f"     {case.name}: ours {reached:.2f} dE00 in {seconds:.1f} s; samples, error and seconds of Mitsuba "
          + ", ".join(f"{n}: {e:.2f} {t:.1f}" for n, (t, e) in zip(SAMPLES, alone)) + "; denoised "
          + ", ".join(f"{e:.2f} {t:.1f}" for t, e in clean)
          + f"; to our error Mitsuba takes at least {time_to(reached, alone) / seconds:.1f} times as long, denoised "
          f"{time_to(reached, clean) / seconds:.1f} times", flush=True)
    return (f"{case.name}, defaults, our time beside that of Mitsuba with a denoiser, to equal error", seconds / time_to(reached, clean),
            1.0, "the light of maps is known without samples")
