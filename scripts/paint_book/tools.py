"""The tools of the toolchain, as functions."""

import pathlib
import shutil
import subprocess

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]

BACKGROUND = "0.3,0.3,0.3"  # neutral gray, scene-linear


class ToolError(Exception):
    """A tool that failed, in its own words; `status` is its exit status."""

    def __init__(self, message, status=3):
        super().__init__(message)
        self.status = status


class Tools:
    def __init__(self, folder=None):
        """`folder` holds the tools; without it they are looked for in PATH, then in this checkout's release build."""
        build = REPOSITORY / "build" / "release" / "bin"
        self.path = str(folder) if folder else None
        if not folder and not shutil.which("render-osmesa") and build.is_dir():
            self.path = str(build)

    def run(self, name, *arguments, given=b""):
        """Runs a tool on `given` as standard input; gives back its standard output as bytes."""
        program = shutil.which(name, path=self.path)
        if not program:
            where = self.path or "PATH"
            raise ToolError(f"{name} is not in {where}: build the project (scripts/demo does) or give --bin")
        done = subprocess.run([program, *map(str, arguments)], input=given, capture_output=True, check=False)
        if done.returncode not in (0, 1):
            said = done.stderr.decode(errors="replace").strip().splitlines()
            raise ToolError(said[0] if said else f"{name} failed with exit status {done.returncode}", done.returncode)
        return done.stdout

    def paint_xml(self, library, basis, gloss, folder):
        """Path of the library as paint XML, every paint with lobes, or with those that it has where `basis` is None; `gloss` is
        assumed where a paint states none."""
        plain, fitted = folder / "library.paints.xml", folder / "fitted.paints.xml"
        self.run("paint-convert", library, "-o", plain)
        if basis is None:
            return plain
        self.run("fit-paint", plain, "--basis", basis, *(["--gloss", gloss] if gloss else []), "-o", fitted)
        return fitted

    def environment(self, env, basis, folder):
        """Path of the prefiltered environment."""
        if str(env).endswith(".env.exr"):
            return env
        filtered = folder / "light.env.exr"
        self.run("prefilter-envmap", env, "--basis", basis, "-o", filtered)
        return filtered

    def picture(self, paint, mesh, env, size, orbit, out):
        """The bytes of a PNG of one paint on a mesh."""
        self.run("render-osmesa", "--mesh", mesh, "--paint", paint, "--env", env, "--size", f"{size[0]}x{size[1]}",
                 "--orbit", orbit, "--samples", 4, "--background", BACKGROUND, "--threads", 1, "-o", out)
        return out.read_bytes()

    def handoff(self, document, kind):
        """The text of one paint, given as paint XML, in another format; no path of this machine gets into it."""
        return self.run("paint-convert", "--to", kind, given=document.encode()).decode()
