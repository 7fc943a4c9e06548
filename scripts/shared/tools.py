"""Where the tools of the toolchain are, and how a script runs them."""

import os
import pathlib
import shutil
import subprocess

SCRIPTS = pathlib.Path(__file__).resolve().parents[1]
DATA = SCRIPTS.parent / "testdata"  # It stands beside the scripts in a checkout and also where the project is installed.


class Failed(Exception):
    """A tool or a script failed: `said` tells why, and `status` is the exit status. The text begins with `command` if given."""

    def __init__(self, said, status=3, command=""):
        super().__init__(f"{command}: {said}" if command else said)
        self.said, self.status = said, status


def builds_folder():
    """The folder of all builds, as common.sh has it."""
    return pathlib.Path(os.environ.get("GONIOCHROME_BUILD_FOLDER") or SCRIPTS.parent / "build").absolute()


def tools_folder():
    """The folder of the tools: that which they were installed in with this script, else that of those in PATH, else that of this
    checkout's release build."""
    if SCRIPTS.parts[-3:] == ("share", "goniochrome", "scripts"):
        installed = SCRIPTS.parents[2] / "bin"
        if (installed / "render-osmesa").exists():
            return installed
    found = shutil.which("render-osmesa")
    return pathlib.Path(found).parent.absolute() if found else builds_folder() / "release/bin"


def put_tools_into_path():
    """Lets this process and those that it starts find the tools by their names."""
    os.environ["PATH"] = os.pathsep.join([str(tools_folder()), os.environ.get("PATH", os.defpath)])


def run_tool(program, *words, done=(0, 1), given=b"", cwd=None, command=""):
    """Runs a program with `given` as its standard input and returns its standard output, as bytes.

    An exit status that is not in `done` raises Failed with the first line that the program said, behind `command`.
    """
    ended = subprocess.run([program, *map(str, words)], input=given, capture_output=True, check=False, cwd=cwd)
    if ended.returncode not in done:
        said = ended.stderr.decode(errors="replace").strip().splitlines()
        raise Failed(said[0] if said else f"{pathlib.Path(program).name} ended with exit status {ended.returncode}",
                        ended.returncode, command)
    return ended.stdout
