"""Runs the tools, measures their times, and halves a list of paints until a paint that fails stands alone."""

import json
import time

from shared import paint_text as library
from shared.files import write_whole
from shared.tools import Failed, run_tool

DONE = (0, 1, 4)  # the exit statuses with a result: done, done with a negative verdict, stopped by a limit


class Tools:
    def __init__(self):
        self.seconds = {}

    def run(self, tool, *words, cwd=None):
        started = time.monotonic()
        try:
            run_tool(tool, *words, done=DONE, cwd=cwd)
        except FileNotFoundError:
            raise SystemExit(f"paint-batch: {tool} is not in PATH") from None
        finally:
            self.seconds[tool] = self.seconds.get(tool, 0) + time.monotonic() - started

    def lines(self, step, paints, folder):
        """Runs step(input, output) on all paints and returns a list: the result of each paint, or why it failed, as a Failed."""
        if not paints:
            return []
        try:
            given = folder / "given.paints.xml"
            write_whole(given, library.document(paints))
            results = step(given, folder)
            if len(results) != len(paints):
                raise Failed(f"{len(results)} results for {len(paints)} paints")
            return results
        except Failed as error:
            if len(paints) == 1:
                return [error]
            half = len(paints) // 2
            return self.lines(step, paints[:half], folder) + self.lines(step, paints[half:], folder)


def json_lines(path):
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
