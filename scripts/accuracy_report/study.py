"""The parts of a study, which readings of it no other one beats, and how a study runs the tools."""

import dataclasses
import json
import pathlib
import resource
import shutil
import sys
import tempfile
import xml.etree.ElementTree

from shared.tools import DATA, run_tool


@dataclasses.dataclass
class Reading:
    """A setting, the time that it takes and its error."""

    setting: str
    time_s: float  # the least of the repetitions
    error: float
    method: str = ""  # The readings of one method are one line of the plot.
    default: bool = False
    raw_s: tuple = ()  # the seconds of every repetition
    numbers: dict = dataclasses.field(default_factory=dict)  # whatever else was measured
    again: object = None  # () -> seconds: measures the time once more

    def retime(self):
        self.raw_s = (*self.raw_s, self.again())
        self.time_s = min(self.raw_s)


@dataclasses.dataclass
class Figure:
    """Readings on one pair of axes. With `front` these are time and error, and less of both is better."""

    name: str  # the name of the SVG file
    title: str
    readings: list
    x_label: str = "time (s)"
    y_label: str = "error"
    front: bool = True
    apart: bool = False  # The methods are different jobs: a default competes only with its own method, and no front is drawn.
    note: str = ""  # the text below the plot
    x: object = None  # reading -> x; without it, x is the time
    y: object = None  # reading -> y; without it, y is the error
    logarithmic: str = "both"
    joined: bool = True  # A line joins the readings of a method.

    SMALLER = 0.99  # An error that is smaller by less than 1 % is the same one.

    def point(self, reading):
        return (self.x(reading) if self.x else reading.time_s, self.y(reading) if self.y else reading.error)

    def dominations(self, scatter):
        """Each default that is dominated, with the first reading that dominates it."""
        for one in (r for r in self.readings if r.default and self.front):
            for other in self.readings:
                if other is one or (self.apart and other.method != one.method):
                    continue
                faster = other.time_s * scatter < one.time_s and other.error <= one.error
                truer = other.error * scatter < one.error and other.time_s <= one.time_s
                if faster or truer:
                    yield one, other
                    break

    def pareto(self):
        """The readings that no other reading beats in both time and error, in the order of their times."""
        best, front = float("inf"), []
        for reading in sorted(self.readings, key=lambda r: (r.time_s, r.error)):
            if reading.error < self.SMALLER * best:
                best = reading.error
                front.append(reading)
        return front


@dataclasses.dataclass
class Study:
    """A chapter of the page: its text, its figures and its tables."""

    title: str
    text: str
    figures: list = dataclasses.field(default_factory=list)
    tables: list = dataclasses.field(default_factory=list)  # (caption, head, rows)

    # A default is dominated if another reading is better by more than this factor in time or error and not worse in the other.
    # The times of one machine scatter by about as much.
    SCATTER = 1.25
    ROUNDS = 6

    def settle(self):
        """Measures the times of defaults that seem dominated, and of what dominates them, again and in turn.

        A verdict therefore does not rest on one moment in which the machine was busy.
        """
        for figure in self.figures:
            for _ in range(self.ROUNDS):
                doubted = [r for pair in figure.dominations(self.SCATTER) for r in pair]
                for reading in doubted if all(r.again for r in doubted) else ():
                    reading.retime()

    def dominated_defaults(self):
        for figure in self.figures:
            for one, other in figure.dominations(self.SCATTER):
                yield (f"{figure.title}: {one.setting} ({one.time_s:.3g} s, {one.error:.2g}) by "
                       f"{other.setting} ({other.time_s:.3g} s, {other.error:.2g})")


def processor_s():
    """The processor time of all tools so far. Other work on the machine does not count, and every thread does."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Run:
    """The tools, a folder to work in, and what the user asked for."""

    SHORT_S, ENOUGH_S = 0.2, 2  # Runs below SHORT_S are repeated more often; after ENOUGH_S seconds no run is repeated.

    def __init__(self, folder, options):
        self.folder, self.options = folder, options
        self.quick = options.quick
        self.repeats = 1 if options.quick else 2
        self.kept = {}  # the results of stages that several pictures share
        self.paints, self.probe, self.mesh = (p.resolve() for p in (options.paints, options.probe, options.mesh))
        self.output = options.output
        self.data = DATA

    def __enter__(self):
        self.work = pathlib.Path(tempfile.mkdtemp(prefix="accuracy-"))
        return self

    def __exit__(self, *unused):
        shutil.rmtree(self.work, ignore_errors=True)

    def say(self, text):
        print(f"accuracy-report: {text}", file=sys.stderr, flush=True)

    def named(self, wanted):
        """The wanted paints that the library has; if it has none of them, its first paints, as many as are wanted."""
        names = [paint.get("name") for _, paint in xml.etree.ElementTree.iterparse(self.paints) if paint.tag.endswith("}paint")]
        return [name for name in wanted if name in names] or names[: len(wanted)]

    def tool(self, name, *words):
        """Runs a tool and returns (the results of its report, the seconds of processor time of the whole process)."""
        report = self.work / "report.json"
        before = processor_s()
        # Status 4 is that of a picture whose time ended before its tolerance was met.
        run_tool(self.folder / name, *words, "--report", report, "--quiet", cwd=self.work, done=(0, 1, 4),
                 command=" ".join(map(str, (name, *words))))
        return json.loads(report.read_text())["results"], processor_s() - before

    def wanted(self, all_s):
        """The number of repetitions, of which these are known."""
        return self.repeats * (2 if not self.quick and min(all_s, default=0) < self.SHORT_S else 1)

    def timed(self, once, *seconds):
        """The times of a Reading, as its arguments: the seconds that are known, and those of calls of `once`."""
        all_s = list(seconds)
        while len(all_s) < self.wanted(all_s) and sum(all_s) < self.ENOUGH_S:
            all_s.append(once())
        return {"time_s": min(all_s), "raw_s": tuple(all_s), "again": once}

    def shading(self, *words):
        """The seconds that render-osmesa takes to shade every pixel once."""
        return 1e-3 * self.tool("render-osmesa", *words, "--check", 1)[0]["left_out"]["shading_ms"]

    def repeated(self, name, *words):
        """Runs a tool several times, a short one more often: (the results of the last run, the least seconds, all seconds)."""
        all_s = []
        while len(all_s) < self.wanted(all_s) and sum(all_s) < self.ENOUGH_S:
            results, seconds = self.tool(name, *words)
            all_s.append(seconds)
        return results, min(all_s), tuple(all_s)
