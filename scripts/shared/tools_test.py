"""shared.tools finds the tools: beside installed scripts, in PATH, and in the builds of a checkout wherever it lies."""

import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from shared import tools


def tool_in(folder):
    folder.mkdir(parents=True)
    (folder / "render-osmesa").touch(mode=0o755)
    return folder


class ToolsFolder(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.top = pathlib.Path(made.name)

    def found(self, scripts, **environment):
        with mock.patch.object(tools, "SCRIPTS", pathlib.Path(scripts)), mock.patch.dict(os.environ, environment, clear=True):
            return tools.tools_folder()

    def test_a_checkout_at_the_top_of_the_file_system(self):
        self.assertEqual(self.found("/src/scripts", PATH="/none"), pathlib.Path("/src/build/release/bin"))
        self.assertEqual(self.found("/scripts", PATH="/none"), pathlib.Path("/build/release/bin"))

    def test_a_folder_for_all_builds(self):
        self.assertEqual(self.found("/src/scripts", PATH="/none", GONIOCHROME_BUILD_FOLDER="/my builds"),
                         pathlib.Path("/my builds/release/bin"))

    def test_tools_in_the_path(self):
        folder = tool_in(self.top / "ein Ort für Lacke")
        self.assertEqual(self.found("/src/scripts", PATH=str(folder)), folder)

    def test_the_tools_that_were_installed_with_the_script(self):
        folder, other = tool_in(self.top / "bin"), tool_in(self.top / "other")
        self.assertEqual(self.found(self.top / "share/goniochrome/scripts", PATH=str(other)), folder)
        # Scripts that lie elsewhere below the same folder are not those of the installation.
        self.assertEqual(self.found(self.top / "share/other/scripts", PATH=str(other)), other)


if __name__ == "__main__":
    unittest.main()
