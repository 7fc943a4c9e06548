"""The tools of the toolchain, as functions of a paint book."""

import json
import shutil
import sys

from shared.tools import Failed, run_tool, tools_folder

BACKGROUND = "0.3,0.3,0.3"  # a neutral gray, scene-linear


class Tools:
    def __init__(self, folder=None):
        """`folder` has the tools; without it, those of PATH or of this checkout's release build are used."""
        self.folder = folder or tools_folder()

    def run(self, name, *words, given=b""):
        """Runs a tool with `given` as its standard input and returns its standard output, as bytes."""
        return run_tool(self.program(name), *words, given=given)

    def program(self, name):
        """The path of a tool."""
        program = shutil.which(name, path=self.folder)
        if not program:
            raise Failed(f"{name} is not in {self.folder}: build the project (scripts/demo does) or give --bin")
        return program

    def paint_xml(self, library, basis, gloss, folder):
        """The path of the library as paint XML in which every paint is fitted to `basis`, or keeps its lobes if that is None.

        `gloss` is assumed for paints that do not state it.
        """
        plain, fitted = folder / "library.paints.xml", folder / "fitted.paints.xml"
        self.run("paint-convert", library, "-o", plain, given=sys.stdin.buffer.read() if library == "-" else b"")
        if basis is None:
            return plain
        self.run("fit-paint", plain, "--basis", basis, *(["--gloss", gloss] if gloss else []), "-o", fitted)
        return fitted

    def environment(self, env, basis, folder):
        """The path of the prefiltered environment."""
        if str(env).endswith(".env.exr"):
            return env
        filtered = folder / "light.env.exr"
        # It serves few starts of render-osmesa, for which the further maps would not pay.
        self.run("prefilter-envmap", env, "--basis", basis, "--no-open-maps", "-o", filtered)
        return filtered

    def pictures(self, paints, mesh, env, size, orbit, folder):
        """Draws 0001.png, 0002.png, ... in `folder`: the paints of a paint XML file, in order, on a mesh."""
        program = self.program("render-osmesa")
        # A book shows all of its paints, so that a paint that cannot be drawn, exit status 1, is an error here.
        run_tool(program, "--mesh", mesh, "--paint", paints, "--trim", "--env", env, "--size", f"{size[0]}x{size[1]}",
                 "--camera", orbit, "--samples", 4, "--background", BACKGROUND, "--effects", "auto,-rays", "-o",
                 folder / "{index}.png", done=(0,))

    def sheets(self, paints, mesh, env, size, orbit, cells, pattern):
        """Draws the same pictures as tiles of sheets of that many columns and rows. Returns the messages of the paints that
        could not be drawn, whose tiles are empty."""
        report = run_tool(self.program("render-osmesa"), "--mesh", mesh, "--paint", paints, "--trim", "--env", env,
                          "--size", f"{size[0]}x{size[1]}", "--camera", orbit, "--samples", 4, "--background", BACKGROUND,
                          "--effects", "auto,-rays", "--sheet", f"{cells[0]}x{cells[1]}", "-o", pattern, "--quiet",
                          "--report", "-")
        return [one["message"] for one in json.loads(report)["results"]["pictures"] if one["status"] == "failed"]

    def handoff(self, document, kind):
        """The text of a paint, which is given as paint XML, in another format. It contains no path of this machine."""
        return self.run("paint-convert", "--to", kind, given=document.encode()).decode()
