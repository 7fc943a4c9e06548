"""What a study is made of, and how it runs tools: readings of error and time, and which of them are worth having."""

import dataclasses
import json
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree


class Failed(Exception):
    """A tool failed; the text is what it printed."""


@dataclasses.dataclass
class Reading:
    """One setting, what it costs and how far it is off."""

    setting: str
    time_s: float  # the least of the repetitions
    error: float
    method: str = ""  # readings of one method make one line of the plot
    default: bool = False
    raw_s: tuple = ()  # every repetition
    numbers: dict = dataclasses.field(default_factory=dict)  # whatever else was measured
    again: object = None  # () -> seconds: takes the time once more

    def retime(self):
        self.raw_s = (*self.raw_s, self.again())
        self.time_s = min(self.raw_s)


@dataclasses.dataclass
class Figure:
    """Readings on one pair of axes. `front`: error against time, where less of both is better."""

    name: str  # of the SVG file
    title: str
    readings: list
    x_label: str = "time (s)"
    y_label: str = "error"
    front: bool = True
    apart: bool = False  # methods are different jobs: a default is held against its own method alone, and no front is drawn
    note: str = ""  # below the plot
    x: object = None  # reading -> x; default: its time
    y: object = None  # reading -> y; default: its error
    logarithmic: str = "both"
    joined: bool = True  # the readings of one method by a line

    def point(self, reading):
        return (self.x(reading) if self.x else reading.time_s, self.y(reading) if self.y else reading.error)

    def dominations(self, scatter):
        """Each default that is dominated, with the first reading that does so."""
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
        """The readings that no other one beats in both, by time."""
        best, front = float("inf"), []
        for reading in sorted(self.readings, key=lambda r: (r.time_s, r.error)):
            if reading.error < best:
                best = reading.error
                front.append(reading)
        return front


@dataclasses.dataclass
class Study:
    """One chapter of the page: prose, figures and tables, all from readings."""

    title: str
    text: str
    figures: list = dataclasses.field(default_factory=list)
    tables: list = dataclasses.field(default_factory=list)  # (caption, head, rows)

    # A default is dominated where another reading is better by more than this factor in one and no worse in the other:
    # times of one machine scatter by so much.
    SCATTER = 1.25
    ROUNDS = 12

    def settle(self):
        """Takes the times of defaults that seem dominated, and of what dominates them, again in turn.

        So no verdict rests on one busy moment.
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
    """Processor time of all tools so far: other work on the machine does not count, and threads count each."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Run:
    """The tools, a folder to work in, and what the user asked for."""

    SHORT_S, ENOUGH_S = 0.2, 4  # shorter runs are repeated more often; after so many seconds none is repeated

    def __init__(self, folder, options):
        self.folder, self.options = folder, options
        self.quick = options.quick
        self.repeats = 1 if options.quick else 3
        self.kept = {}  # results of stages that several pictures share
        self.paints, self.probe, self.mesh = (p.resolve() for p in (options.paints, options.probe, options.mesh))
        self.output = options.output
        self.data = pathlib.Path(__file__).resolve().parents[2] / "testdata"
        self.raw = []  # rows of the CSV

    def __enter__(self):
        self.work = pathlib.Path(tempfile.mkdtemp(prefix="accuracy-"))
        return self

    def __exit__(self, *unused):
        shutil.rmtree(self.work, ignore_errors=True)

    def say(self, text):
        print(f"accuracy-report: {text}", file=sys.stderr, flush=True)

    def named(self, wanted):
        """Those of these paints that the library has; of a library that has none, as many from its beginning."""
        names = [paint.get("name") for _, paint in xml.etree.ElementTree.iterparse(self.paints) if paint.tag.endswith("}paint")]
        return [name for name in wanted if name in names] or names[: len(wanted)]

    def tool(self, name, *words):
        """Runs a tool and returns (results of its report, seconds of processor time of the whole process)."""
        report = self.work / "report.json"
        before = processor_s()
        done = subprocess.run([str(self.folder / name), *map(str, words), "--report", str(report), "--quiet"],
                              cwd=self.work, capture_output=True, text=True)
        seconds = processor_s() - before
        if done.returncode not in (0, 1):
            raise Failed(f"{name} {' '.join(map(str, words))}: {done.stderr.strip() or done.returncode}")
        return json.loads(report.read_text())["results"], seconds

    def timed(self, once, *seconds):
        """What a Reading wants of time: the seconds known, and those of several calls of `once`."""
        all_s = (*seconds, *(once() for _ in range(self.repeats)))
        return {"time_s": min(all_s), "raw_s": all_s, "again": once}

    def shading(self, *words):
        """The seconds that render-osmesa needs to shade every pixel once."""
        return 1e-3 * self.tool("render-osmesa", *words, "--check", 1)[0]["left_out"]["shading_ms"]

    def repeated(self, name, *words):
        """The same several times, short ones more often: (results of the last, the least seconds, all seconds)."""
        all_s = []
        while len(all_s) < self.repeats * (2 if min(all_s, default=0) < self.SHORT_S else 1) and sum(all_s) < self.ENOUGH_S:
            results, seconds = self.tool(name, *words)
            all_s.append(seconds)
        return results, min(all_s), tuple(all_s)
