"""Tests of the module goniochrome: python_test.py TESTDATA, with the package on PYTHONPATH. Without numpy it ends by 77."""

import concurrent.futures
import copy
import gc
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
try:
    import numpy
except ImportError:
    print("skipped: python3-numpy is not there")
    sys.exit(77)
import goniochrome

DATA = sys.argv.pop(1) if len(sys.argv) > 1 else "testdata"


class Module(unittest.TestCase):
    def setUp(self):
        self.paints = goniochrome.read_paints(DATA + "/paints.paints.xml#silver_fine,jet_black")
        self.silver, self.black = sorted(self.paints, key=lambda paint: paint.name, reverse=True)
        self.basis = goniochrome.read_basis(DATA + "/b7.basis.xml")

    def test_a_fit_is_that_of_the_tool(self):
        fitted = goniochrome.fit(self.paints, self.basis)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder)
            subprocess.run(["fit-paint", "-q", "-b", DATA + "/b7.basis.xml", DATA + "/paints.paints.xml#silver_fine,jet_black", "-o",
                            path / "tool.xml"], check=True)
            goniochrome.write_paints(str(path / "module.xml"), fitted)
            tool, module = (goniochrome.read_paints(str(path / name)) for name in ("tool.xml", "module.xml"))
        for one, two in zip(tool, module, strict=True):
            self.assertEqual(one.lobes.coat_index, two.lobes.coat_index)
            numpy.testing.assert_array_equal(one.lobes.diffuse, two.lobes.diffuse)
            for a, b in zip(one.lobes.lobes, two.lobes.lobes, strict=True):
                self.assertEqual(a.exponent, b.exponent)
                numpy.testing.assert_array_equal(a.directional_diffuse, b.directional_diffuse)
                numpy.testing.assert_array_equal(a.gloss, b.gloss)

    def test_the_lobes_show_the_readings(self):
        (fitted,) = goniochrome.fit([self.silver], self.basis, method="deltae")
        light, view = goniochrome.directions(fitted.geometries)
        self.assertEqual(light.shape, (len(fitted.geometries), 3))
        shown = goniochrome.lab_from_rgb(numpy.pi * fitted.brdf(light, view), fitted.illuminant, fitted.observer_deg)
        apart = goniochrome.delta_e_2000(fitted.readings, shown)
        # The mean of the fit, which has its own share of gloss at the reading next to specular.
        self.assertAlmostEqual(apart.mean(), fitted.lobes.mean_de00, delta=0.05)

    def test_a_coat_has_an_index(self):
        self.assertEqual(goniochrome.fit([self.silver], self.basis, coat_index=1)[0].lobes.coat_index, 1)
        self.assertEqual(goniochrome.fit([self.silver], self.basis, coat_index=1.6)[0].lobes.coat_index, 1.6)
        for wrong in (float("nan"), 0, 0.9, 90):
            with self.assertRaisesRegex(goniochrome.Error, "coat_index"):
                goniochrome.fit([self.silver], self.basis, coat_index=wrong)

    def test_color_differences(self):
        # A pair of Sharma, Wu and Dalal 2005.
        one, two = numpy.array([50, 2.6772, -79.7751]), numpy.array([50, 0, -82.7485])
        self.assertAlmostEqual(float(goniochrome.delta_e_2000(one, two)), 2.0425, places=4)
        many = numpy.tile(one, (4, 5, 1))
        self.assertEqual(goniochrome.delta_e_2000(many, two).shape, (4, 5))
        self.assertAlmostEqual(float(goniochrome.delta_e_76(one, two)), float(numpy.linalg.norm(one - two)))
        lab = goniochrome.lab_from_rgb(goniochrome.rgb_from_lab(many))
        numpy.testing.assert_allclose(lab, many, atol=1e-9)

    def test_geometries_and_curves(self):
        self.assertEqual(goniochrome.aspecular_deg("45as-15"), 15)
        curve = self.silver.curve([15, 110])
        self.assertGreater(curve[0, 0], curve[1, 0] + 20)
        self.assertGreater(self.silver.metrics["flop_index"], 5)
        self.assertLess(abs(self.black.metrics["flop_index"]), self.silver.metrics["flop_index"])

    def test_an_environment_is_not_copied_and_outlives_its_name(self):
        environment = goniochrome.read_environment(DATA + "/studio.exr")
        texels = environment.texels
        self.assertEqual(texels.dtype, numpy.float32)
        self.assertEqual(texels.__array_interface__["data"], environment.texels.__array_interface__["data"])
        self.assertFalse(texels.flags.owndata or texels.flags.writeable)
        before = float(texels.sum())
        solid, directions = environment.solid_angles(), environment.directions()
        self.assertAlmostEqual(float(solid.sum()), 4 * numpy.pi, places=5)
        self.assertEqual(directions.shape, texels.shape)
        del environment
        gc.collect()
        self.assertEqual(before, float(texels.sum()))

    def test_layouts_have_their_names(self):
        with tempfile.TemporaryDirectory() as folder:
            for width, height, layout in ((8, 4, "lat-long"), (4, 24, "cube"), (4, 4, "angular")):
                path = pathlib.Path(folder) / "light.pfm"
                path.write_bytes(f"PF {width} {height} -1\n".encode() + numpy.ones((height, width, 3), "<f4").tobytes())
                environment = goniochrome.read_environment(path)
                self.assertEqual(environment.layout, layout)
                self.assertEqual(environment.texels.shape, (height, width, 3))

    def test_errors_say_what_is_wrong(self):
        for wrong, words in ((lambda: goniochrome.read_paints("none.xml"), "none.xml"),
                             (lambda: goniochrome.directions(["45xx"]), "45xx"),
                             (lambda: goniochrome.delta_e_2000(numpy.zeros(4), numpy.zeros(3)), "three numbers"),
                             (lambda: self.silver.brdf([0, 0, 1], [0, 0, 1]), "has no lobes"),
                             (lambda: goniochrome.fit(self.paints, self.basis, method="best"), "deltae")):
            with self.assertRaisesRegex(goniochrome.Error, words):
                wrong()

    def test_a_lobe_outlives_its_environment(self):
        with tempfile.TemporaryDirectory() as folder:
            path = folder + "/studio.env.exr"
            subprocess.run(["prefilter-envmap", "-q", "--size", "16", "-b", DATA + "/b7.basis.xml", DATA + "/studio.exr", "-o", path],
                           check=True)
            environment = goniochrome.read_prefiltered(path)
        self.assertEqual(environment.mirror.exponent, numpy.inf)
        self.assertEqual([lobe.exponent for lobe in environment.lobes], sorted(lobe.exponent for lobe in environment.lobes))
        texels = environment.lobes[0].texels
        self.assertEqual(texels.shape, (6, 16, 16, 3))
        before = texels.copy()
        del environment
        gc.collect()
        numpy.testing.assert_array_equal(texels, before)

    def test_a_paint_outlives_its_list_and_its_numbers_are_constant(self):
        (fitted,) = goniochrome.fit([self.silver], self.basis)
        lobes, curve = fitted.lobes, self.silver.curve([15, 45])
        self.paints = self.black = None
        gc.collect()
        numpy.testing.assert_array_equal(self.silver.curve([15, 45]), curve)
        with self.assertRaises(ValueError):
            lobes.diffuse[0] = 1
        with self.assertRaises(AttributeError):
            lobes.coat_index = 1

    def test_wrong_shapes_and_classes_are_refused(self):
        for wrong, words in ((lambda: goniochrome.lab_from_rgb(1.), "rgb: the last axis"),
                             (lambda: goniochrome.rgb_from_lab(numpy.zeros((3, 4))), "lab: the last axis"),
                             (lambda: goniochrome.delta_e_76(numpy.zeros((4, 3)), numpy.zeros((2, 3))), "as many colors"),
                             (lambda: self.silver.brdf(numpy.zeros((2, 3)), [0, 0, 1]), "as many directions"),
                             (lambda: goniochrome.lab_from_rgb([0, 0, 0], observer_deg=10.5), "observer 10.5"),
                             (lambda: goniochrome.lab_from_rgb([0, 0, 0], "D99"), "D99"),
                             (lambda: goniochrome.read_basis("b7\0.basis.xml"), "null")):
            with self.assertRaisesRegex(goniochrome.Error, words):
                wrong()
        self.assertTrue(issubclass(goniochrome.Error, ValueError))
        for wrong, words in ((lambda: goniochrome.fit([self.basis], self.basis), "no Paint"),
                             (lambda: goniochrome.fit(self.paints, self.basis, method=1), "int"),
                             (lambda: copy.deepcopy(self.silver), "in memory alone")):
            with self.assertRaisesRegex(TypeError, words):
                wrong()

    def test_two_threads_get_results_and_errors_of_their_own(self):
        def work(name):
            for _ in range(200):
                with self.assertRaisesRegex(goniochrome.Error, name):
                    goniochrome.aspecular_deg(name)
                self.assertEqual(goniochrome.lab_from_rgb(numpy.ones((50, 3))).shape, (50, 3))
            return goniochrome.fit([self.silver], self.basis)[0].lobes.diffuse

        with concurrent.futures.ThreadPoolExecutor(2) as threads:
            one, two = threads.map(work, ("45first", "45second"))
        numpy.testing.assert_array_equal(one, two)

    def test_the_library_serves_every_version_of_python(self):
        library = pathlib.Path(goniochrome.__file__).parent / "libgoniochrome.so"
        self.assertNotRegex(library.read_bytes(), rb"\0_?Py[A-Z_]\w+\0")

    def test_without_its_library_the_import_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "goniochrome").mkdir()
            shutil.copy(goniochrome.__file__, folder + "/goniochrome")
            done = subprocess.run([sys.executable, "-c", "import goniochrome"], cwd=folder, capture_output=True, text=True, check=False)
        self.assertRegex(done.stderr.splitlines()[-1], "^ImportError: goniochrome cannot load its library: .*libgoniochrome.so: ")

    def test_everything_public_has_its_types(self):
        for name in goniochrome.__all__:
            thing = getattr(goniochrome, name)
            self.assertTrue(thing.__doc__, name)
            for member, value in vars(thing).items() if isinstance(thing, type) else [(name, thing)]:
                if not member.startswith("_"):
                    notes = getattr(value, "fget", value)
                    self.assertTrue(member in thing.__annotations__ or "return" in notes.__annotations__, f"{name}.{member}")

    def test_the_example_runs(self):
        done = subprocess.run([sys.executable, pathlib.Path(__file__).parent / "example.py", DATA], capture_output=True, text=True, check=True)
        self.assertIn("flop index", done.stdout)


if __name__ == "__main__":
    unittest.main()
