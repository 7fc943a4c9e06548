"""The command line: which studies run, with which files, and where the page goes."""

import importlib
import os
import pathlib
import sys
import time

from shared import packages
from shared.manual import Manual, parser_of
from shared.tools import DATA, Failed, tools_folder

from . import page, target
from .study import Run

# The studies in the order of the page. Each is a module beside this one with study(run) -> Study.
STUDIES = {
    "paths": "pictures and paths: error against time for tolerances, limits, engines and bounces, and growth",
    "chain": "the whole chain: where the error of a picture comes from, and what it costs to lower it",
    "edges": "edges: few samples in a pixel against hundreds",
    "render": "rendering: effects, engine, textures and brushes against the reference integrator",
    "spots": "bright spots of an environment that each horizon cuts by itself: their number against the exact sum",
    "interference": "paints with a color map in image light: sets of tilted lobes against the integral of the map",
    "isolines": "color maps under a lamp: treatments of the critical angle, with and without the projection factor",
    "prefilter": "prefiltering: tolerance and size against the exact sum",
    "basis": "choosing a basis: starts, method and number of lobes against what its lobes can do",
    "fit": "fitting: method, lobes and target against the measured colors",
    "lobes": "fewer lobes: smaller bases, the best lobes of a basis, and pruning, against the time of drawing",
    "inverse": "paints that are searched for: sketches by their size, and panels that hide a misalignment",
    "growth": "growth of times with probes, maps, paints, pixels and lights, and where it is steepest",
    "frames": "frame rates: lights, lobes and engines, of paints and of lobes in each texel, and the cost of the operator",
}


MANUAL = Manual(
    "accuracy-report", "measure the error and the time of every option that sets an accuracy", [
        "accuracy-report varies the settings of the tools, holds each result against an exact reference, and writes an HTML page, "
        "a CSV of every reading, and the plots as SVG. A default setting is dominated if another setting is better in time or "
        "error and not worse in the other.",
        "The studies need the Python modules numpy and OpenImageIO. Where they are missing, their Debian packages are installed, "
        "which takes root or sudo."],
    "0: the work is done. 1: a default setting is dominated, or --target-de00 is not reached. 2: the command line is wrong. 3: an "
    "input is wrong, a file cannot be read or written, or a tool failed.",
    [("Compare ways to fit the paints of a library, in a few seconds", "accuracy-report --quick fit -o accuracy"),
     ("Do the same for the metallics of a library of your own",
      "paint-stats -w 'class==metallic' -f paints testdata/paints.paints.xml -o own.paints.xml && accuracy-report --quick --paints "
      "own.paints.xml fit -o own"),
     ("List the studies", "accuracy-report --help | head -n 20")],
    ["goniochrome-accuracy(7)", "render-osmesa(1)", "paint-batch(1)"])


def parse(arguments):
    parser = parser_of(MANUAL)
    listed = "; ".join(f"{n} ({STUDIES[n]})" for n in STUDIES)
    parser.add_argument("studies", nargs="*", metavar="STUDY", help="the studies to run, by default all: " + listed)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("accuracy"), metavar="DIR",
                        help="the folder to write to [accuracy]")
    parser.add_argument("--quick", action="store_true", help="try fewer settings, which takes about a minute on two cores")
    parser.add_argument("--bin", type=pathlib.Path, metavar="DIR",
                        help="the folder of the tools [that of the installed command, then PATH, then build/release/bin]")
    parser.add_argument("--paints", type=pathlib.Path, default=DATA / "paints.paints.xml", metavar="FILE[#NAME]",
                        help="the library to use, or the paints of it that NAME means [that of testdata]")
    parser.add_argument("--probe", type=pathlib.Path, default=DATA / "studio.exr", metavar="FILE",
                        help="the HDR panorama to use [the studio of testdata]")
    parser.add_argument("--mesh", type=pathlib.Path, default=DATA / "speed-shape.obj", metavar="FILE",
                        help="the mesh to use [the speed shape of testdata]")
    parser.add_argument("--target-de00", type=float, metavar="X",
                        help="instead of studies, find and prove the cheapest settings that bring scenes within a mean dE00 of X")
    parser.add_argument("--scene", action="append", metavar="PAINT[,PROBE]",
                        help="with --target-de00: a paint, and its probe if it is not that of --probe; may be given several "
                        "times [three scenes of testdata]")
    options = parser.parse_intermixed_args(arguments)
    if options.target_de00 is not None and not options.target_de00 > 0:
        parser.error(f"--target-de00 is {options.target_de00:g}: give a color difference above 0")
    if options.scene and options.target_de00 is None:
        parser.error("--scene goes with --target-de00")
    for name in options.studies:
        if name not in STUDIES:
            parser.error(f"there is no study {name}: choose of {', '.join(STUDIES)}")
    library = options.paints
    if "#" in library.name and not library.is_file():
        library = pathlib.Path(str(library).rpartition("#")[0])
    for path in (library, options.probe, options.mesh):
        if not path.is_file():
            print(f"accuracy-report: {path}: there is no such file", file=sys.stderr)
            sys.exit(3)
    return options


def main(arguments=None):
    options = parse(arguments)
    folder = options.bin or tools_folder()
    if not os.access(folder / "render-osmesa", os.X_OK):
        print(f"accuracy-report: {folder}: the tools are not there: build them (cmake --preset release && "
              "cmake --build --preset release), or name their folder with --bin", file=sys.stderr)
        return 3
    try:
        return work(folder, options)
    except (Failed, OSError) as failure:
        print(f"accuracy-report: {failure}", file=sys.stderr)
        return 3


def work(folder, options):
    """Runs what the options ask for and returns the exit status."""
    if options.target_de00 is not None:
        with Run(folder.resolve(), options) as run:
            return 0 if target.report(run, options.target_de00, options.scene) else 1
    if options.output.exists() and not options.output.is_dir():
        raise Failed(f"{options.output}: is a file: --output names the folder of the page")
    options.output.mkdir(parents=True, exist_ok=True)
    start = time.monotonic()
    studies = []
    packages.install_modules("numpy", "OpenImageIO")
    modules = {name: importlib.import_module(f".{name}", __package__) for name in options.studies or STUDIES}
    with Run(folder.resolve(), options) as run:
        for name, module in modules.items():
            run.say(f"{name}: {STUDIES[name]}")
            studies.append(module.study(run))
            studies[-1].settle()
            page.write(run, studies, time.monotonic() - start)  # A run that is ended early leaves the page of its studies so far.
    dominated = [text for study in studies for text in study.dominated_defaults()]
    for text in dominated:
        print(f"accuracy-report: dominated default: {text}", file=sys.stderr)
    run.say(f"{options.output / 'index.html'}: {len(studies)} studies in {time.monotonic() - start:.0f} s")
    return 1 if dominated else 0
