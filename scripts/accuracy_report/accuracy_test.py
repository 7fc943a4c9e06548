"""What the report decides and writes, without any tool: /usr/bin/python3 accuracy_test.py"""

import contextlib
import io
import pathlib
import sys
import tempfile
import types
import unittest

import numpy
import OpenImageIO

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from accuracy_report import command, page  # noqa: E402
from accuracy_report.study import Figure, Reading, Study  # noqa: E402
from shared import pictures  # noqa: E402


def figure(*rows, **more):
    """A figure of rows (name, time, error), which may go on with True for a default and with a method."""
    def reading(name, time_s, error, default=False, *method):
        return Reading(name, time_s, error, raw_s=(time_s,), default=bool(default), method="".join(method))
    return Figure("f", "A figure", [reading(*row) for row in rows], **more)


class Front(unittest.TestCase):
    def test_pareto_is_what_no_other_beats_in_both(self):
        f = figure(("slow", 9, 1), ("good", 3, 2), ("worse", 4, 3), ("fast", 1, 8),
                   ("equal error, slower", 5, 2), ("equal time, worse", 3, 4))
        self.assertEqual([r.setting for r in f.pareto()], ["fast", "good", "slow"])
        self.assertEqual([r.setting for r in figure(("fast", 1, 2), ("hardly better", 2, 1.99), ("better", 3, 1.9)).pareto()],
                         ["fast", "better"])
        self.assertEqual(figure().pareto(), [])

    def dominated(self, *rows, **more):
        return list(Study("S", "", [figure(*rows, **more)]).dominated_defaults())

    def test_a_default_is_dominated_by_more_than_the_scatter_of_times(self):
        text, = self.dominated(("default", 1.3, 2, True), ("other", 1, 2))
        self.assertIn("A figure: default (1.3 s, 2) by other (1 s, 2)", text)
        self.assertTrue(self.dominated(("default", 1, 1.3, True), ("other", 1, 1)))
        self.assertFalse(self.dominated(("default", 1.2, 2, True), ("other", 1, 2)))
        self.assertFalse(self.dominated(("default", 9, 1, True), ("other", 1, 1.01)), "the other one errs more")
        self.assertFalse(self.dominated(("one", 9, 9), ("other", 1, 1)), "no default")
        self.assertFalse(self.dominated(("default", 9, 9, True), ("other", 1, 1), front=False))

    def test_apart_holds_a_default_against_its_own_method(self):
        rows = ("default", 9, 9, True, "one"), ("other", 1, 1, False, "another")
        self.assertTrue(self.dominated(*rows))
        self.assertFalse(self.dominated(*rows, apart=True))
        self.assertTrue(self.dominated(*rows, ("its own", 1, 1, False, "one"), apart=True))

    def test_a_busy_moment_is_measured_again(self):
        study = Study("S", "", [figure(("default", 5, 1, True), ("other", 1, 1))])
        times = {"default": iter((3, 1.1, 0.9)), "other": iter((2, 2, 2))}
        for reading in study.figures[0].readings:
            reading.again = times[reading.setting].__next__
        study.settle()
        self.assertFalse(list(study.dominated_defaults()))
        default, other = study.figures[0].readings
        self.assertEqual((default.raw_s, default.time_s), ((5, 3, 1.1), 1.1), "no longer than needed, and every time is kept")
        self.assertEqual(other.raw_s, (1, 2, 2))

    def test_a_dominated_default_fails_the_report(self):
        study = Study("Fake", "Nothing.", tables=[("t", ("a",), [(1,)])])
        study.dominated_defaults = lambda: ["figure: default by other"]
        command.STUDIES["fake"] = "none"
        sys.modules["accuracy_report.fake"] = types.SimpleNamespace(study=lambda run: study)
        with tempfile.TemporaryDirectory() as folder:
            tool = pathlib.Path(folder) / "render-osmesa"
            tool.touch(0o755)
            with contextlib.redirect_stderr(io.StringIO()) as told:
                self.assertEqual(command.main(["fake", "--bin", folder, "-o", folder]), 1)
            self.assertIn("dominated default: figure: default by other", told.getvalue())
            written = (pathlib.Path(folder) / "index.html").read_text()
            self.assertIn("Dominated default:</strong> figure: default by other", written)
            study.dominated_defaults = lambda: []
            with contextlib.redirect_stderr(io.StringIO()):
                self.assertEqual(command.main(["fake", "--bin", folder, "-o", folder]), 0)


class Words(unittest.TestCase):
    def test_numbers_are_written_as_people_do(self):
        for value, text in ((1098.4, "1100"), (0.000454321, "0.000454"), (1.88e-5, "1.88e-5"), (9.3e-14, "0"), (0.0, "0"),
                            (123456.0, "123000"), (7, "7"), (float("nan"), "-"), ("b7", "b7")):
            self.assertEqual(page.number(value), text)

    def test_texts_are_escaped(self):
        self.assertIn("&lt;b&gt;", page.table("c", ("h",), [("<b>",)]))


class Pictures(unittest.TestCase):
    def test_an_exr_is_read_as_it_was_written(self):
        rows = [[(x / 7 - y, x * y, 0.5, 1.0) for x in range(37)] for y in range(35)]
        names = ("lobe0.n", "B", "A", "R")  # EXR stores channels by name, in another order
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "p.exr"
            for stored_as in (numpy.float32, numpy.float16):
                path.write_bytes(pictures.exr_file(rows, stored_as, "", names))
                read = pictures.channels(path)
                for i, name in enumerate(names):
                    expected = [[float(stored_as(texel[i])) for texel in row] for row in rows]
                    self.assertEqual(read[name].tolist(), expected)

    def test_the_same_pixels_give_the_same_file(self):
        once = pictures.exr_file([[(1, 2, 3)]], numpy.float32, "")
        self.assertNotIn(b"capDate", once)  # the time of writing, which OpenImageIO adds by itself

    def test_what_is_no_picture_is_named(self):
        with self.assertRaisesRegex(ValueError, "accuracy_test.py"):
            pictures.channels(__file__)
        with self.assertRaisesRegex(ValueError, "nowhere.exr"):
            pictures.channels("nowhere.exr")

    def test_colors_are_not_multiplied_by_alpha(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "p.png"
            spec = OpenImageIO.ImageSpec(1, 1, 4, "uint8")
            spec.attribute("oiio:UnassociatedAlpha", 1)
            file = OpenImageIO.ImageOutput.create(str(path))
            self.assertTrue(file.open(str(path), spec) and file.write_image(numpy.array([[[255, 51, 0, 51]]], numpy.uint8)))
            file.close()
            read = pictures.channels(path)
        for name, value in (("R", 1), ("G", 0.2), ("B", 0), ("A", 0.2)):
            self.assertAlmostEqual(float(read[name][0, 0]), value, places=6)


if __name__ == "__main__":
    unittest.main()
