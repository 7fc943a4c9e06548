"""Runs the tools, keeps their times, and halves a list of paints until the one that fails stands alone."""

import json
import subprocess
import time

from . import files, library

DONE = (0, 1, 4)  # exit statuses with a result: done, negative verdict, stopped by a limit


class ToolError(Exception):
    """What a tool said when it failed."""


class Tools:
    def __init__(self):
        self.seconds = {}

    def run(self, tool, *arguments, cwd=None):
        started = time.monotonic()
        try:
            done = subprocess.run([tool, *map(str, arguments)], capture_output=True, check=False, stdin=subprocess.DEVNULL,
                                  cwd=cwd)
        except FileNotFoundError:
            raise SystemExit(f"paint-batch: {tool} is not in PATH") from None
        self.seconds[tool] = self.seconds.get(tool, 0) + time.monotonic() - started
        if done.returncode not in DONE:
            said = done.stderr.decode(errors="replace").strip().splitlines()
            raise ToolError(said[0] if said else f"{tool} ended with status {done.returncode}")

    def lines(self, step, paints, folder):
        """step(input, output) on all paints; the result of each, or the ToolError of one that failed."""
        if not paints:
            return []
        try:
            given = folder / "given.paints.xml"
            files.write(given, library.document(paints))
            results = step(given, folder)
            if len(results) != len(paints):
                raise ToolError(f"{len(results)} results for {len(paints)} paints")
            return results
        except ToolError as error:
            if len(paints) == 1:
                return [error]
            half = len(paints) // 2
            return self.lines(step, paints[:half], folder) + self.lines(step, paints[half:], folder)


def json_lines(path):
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
