"""Round trips of sketch-fit: pictures of known paints as render-osmesa draws them by default, and the paints found in them."""

import dataclasses
import itertools
import math
import os
import pathlib
import statistics
import xml.etree.ElementTree

import numpy

from shared import colors

from .study import Figure, Reading, Study

# A solid, a metallic, a candy and an interference paint.
PAINTS = ("arctic_white", "silver_fine", "candy_red", "blue_to_purple")
MESHES = {"teapot": "teapot.obj", "speed shape": "", "vehicle": "vehicle.obj"}  # Without a file it is the mesh of --mesh.
WIDTHS = (320, 640)
LIGHTS = {"lamp": "35,45", "studio": "studio_small_03_1k.hdr", "sky": "rooitou_park_1k.hdr"}
UNMEASURED = {"studio": "studio.exr", "sky": "outdoor.exr"}  # of testdata, where there are no measurements
QUICK = {"paints": ("silver_fine", "candy_red"), "meshes": ("speed shape",), "widths": (200, 320)}
SHAPE = 16 / 10  # the width of a picture, divided by its height
ANGLES_DEG = (15, 25, 45, 75, 110)
WRONG_DE00 = 2  # A larger error needs a warning.

LIGHT_DEG, STEEPEST_VIEW_DEG = 45, 65  # of the instrument that reads a paint under a coat
RGB_TO_XYZ = numpy.array(((0.6369580, 0.1446169, 0.1688810), (0.2627002, 0.6779981, 0.0593017), (0, 0.0280727, 1.0609851)))
BRADFORD = numpy.array(((0.8951, 0.2664, -0.1614), (-0.7502, 1.7135, 0.0367), (0.0389, -0.0685, 1.0296)))
WHITE_10 = numpy.array((0.94811, 1, 1.07304))  # D65 for the observer of 10 deg


def passed(cos, index):
    """The share of unpolarized light that passes the surface of a coat [Born1999, 1.5.2]."""
    if index <= 1:
        return 1
    inside = math.sqrt(1 - (1 - cos * cos) / (index * index))
    across, along = (cos - index * inside) / (cos + index * inside), (inside - index * cos) / (inside + index * cos)
    return 1 - (across * across + along * along) / 2


def at_view(lobes, view_deg):
    """The elements with the weights for a view: of one view after the other with its share of them, or of all views."""
    views = [e for e in lobes if e.tag.endswith("}view")]
    if not views:
        return [(1, lobes)]
    angles = [float(e.get("angle")) for e in views]
    place = float(numpy.interp(view_deg, angles, range(len(angles))))
    before, after = views[int(place)], views[math.ceil(place)]
    return [(1 - place % 1, before), (place % 1, after)]


def shown_lab(paint, angle_deg):
    """Lab that an instrument reads off the lobes of a paint element at an aspecular angle."""
    def child(name):
        return next((e for e in paint.iter() if e.tag.endswith("}" + name)), None)

    def rgb(element, names):
        return numpy.array([float(element.get(name)) for name in names])

    view_deg = min(abs(LIGHT_DEG - angle_deg), STEEPEST_VIEW_DEG)
    total = numpy.zeros(3)
    for share, weights in at_view(child("lobes"), view_deg):
        for element in weights:
            if element.tag.endswith("}diffuse"):
                total = total + share * rgb(element, "rgb")
            elif element.tag.endswith("}lobe") and element.get("exponent") != "mirror":
                total = total + share * max(math.cos(math.radians(angle_deg)), 0) ** float(element.get("exponent")) * rgb(element, ("ddr", "ddg", "ddb"))
    coat = child("coat")
    index = float(coat.get("index")) if coat is not None else 1
    through = passed(math.cos(math.radians(LIGHT_DEG)), index) * passed(math.cos(math.radians(view_deg)), index)
    xyz = RGB_TO_XYZ @ (math.pi * through * total)
    cones = BRADFORD @ WHITE_10 / (BRADFORD @ numpy.array(colors.WHITE))
    adapted = numpy.linalg.solve(BRADFORD, cones * (BRADFORD @ xyz))
    return colors.lab(adapted / WHITE_10 * numpy.array(colors.WHITE))


@dataclasses.dataclass
class Trip:
    """A picture, and how far the colors that were found in it are from those in which it was drawn."""

    paint: str
    mesh: str
    width: int
    light: str
    errors: dict  # dE00 by aspecular angle
    warned: set  # the angles that a warning names
    found: dict  # the report of sketch-fit
    fit_s: float

    def worst(self):
        return max(self.errors.values())

    def unwarned(self):
        """The largest error at an angle that no warning names."""
        return max((e for angle, e in self.errors.items() if angle not in self.warned), default=0)


def doubtful(found):
    """The angles under a lamp about which few pixels stand, or at which the picture is visibly off the paint found."""
    if found["residual_angle"] != "aspecular":
        return set()
    near = {one["from_deg"]: one for one in found["residual"]}
    here = {angle: near.get(angle // 10 * 10) for angle in ANGLES_DEG}
    return {a for a, one in here.items() if not one or one["pixels"] < 20 or one["median_de76"] > 2}


class Stage:
    """The fitted paints, the meshes and the light of the pictures."""

    def __init__(self, run):
        self.run = run
        self.basis = ("--basis", run.data / "b7.basis.xml")
        self.fitted = run.work / "sketches.xml"
        run.tool("fit-paint", *self.basis, run.paints, "-o", self.fitted)
        self.paints = {p.get("name"): p for p in xml.etree.ElementTree.parse(self.fitted).getroot() if p.tag.endswith("}paint")}
        measured = os.environ.get("GONIOCHROME_DATA")
        self.meshes, self.env = {}, {}
        for name, file in MESHES.items():
            path = pathlib.Path(measured or ".") / "mesh" / file if file else run.mesh
            if not file or measured:
                self.meshes[name] = path
        for name, where in LIGHTS.items():
            if name == "lamp":
                continue
            image = pathlib.Path(measured) / "probes" / where if measured else run.data / UNMEASURED[name]
            self.env[name] = run.work / f"sketches-{name}.env.exr"
            run.tool("prefilter-envmap", image, *self.basis, "--verify", 0, "-o", self.env[name])

    def trip(self, paint, mesh, width, light):
        """Draws the paint as by default, and finds it again."""
        lit = ("--light", LIGHTS[light]) if light == "lamp" else ("--env", self.env[light])
        told = self.basis if light == "lamp" else lit
        picture = self.run.work / "trip.exr"
        self.run.tool("render-osmesa", "--mesh", self.meshes[mesh], "--paint", f"{self.fitted}#{paint}", *lit,
                      "--size", f"{width}x{int(width / SHAPE)}", "--aov", "normal,aspecular,lambert,mask,part", "-o", picture)
        found, fit_s = self.run.tool("sketch-fit", "--image", picture, "--buffers", picture, *told, "-o", self.run.work / "trip.xml")
        rows = {float(row["geometry"].removeprefix("45as")): numpy.array((row["L"], row["a"], row["b"])) for row in found["rows"]}
        errors = {a: float(colors.de2000(rows[a], shown_lab(self.paints[paint], a))) for a in ANGLES_DEG}
        warned = {*found["extrapolated_deg"], *doubtful(found)}
        if found["status"] != "fitted":
            warned = set(ANGLES_DEG)  # The fallback says that the answer is a matt color, whatever the angle.
        return Trip(paint, mesh, width, light, errors, warned, found, fit_s)


def study(run):
    stage = Stage(run)
    paints = run.named(QUICK["paints"] if run.quick else PAINTS)
    meshes = [m for m in (QUICK["meshes"] if run.quick else MESHES) if m in stage.meshes]
    trips = []
    for light, mesh, width in itertools.product(LIGHTS, meshes, QUICK["widths"] if run.quick else WIDTHS):
        for paint in paints:
            trips.append(stage.trip(paint, mesh, width, light))
        run.say(f"{light}, {mesh}, {width} pixels wide: median dE00 {statistics.median(t.worst() for t in trips[-len(paints):]):.2f}")
    readings = [Reading(f"{t.paint}, {t.light}, {t.mesh}, {t.width} pixels wide", t.fit_s, t.worst(), f"{t.mesh}, {t.light}",
                        raw_s=(t.fit_s,), numbers={"width": t.width, "mean": statistics.mean(t.errors.values()),
                                                   "unwarned": t.unwarned(), "model": t.found["model"]}) for t in trips]
    every = [error for t in trips for error in t.errors.values()]
    wrong = [t for t in trips if t.unwarned() > WRONG_DE00]
    run.say(f"{len(trips)} round trips: median dE00 {statistics.median(every):.2f} of all readings, "
            f"{sum(t.worst() > WRONG_DE00 for t in trips)} wrong by more than {WRONG_DE00}, {len(wrong)} of them without a warning")
    rows = []
    for light, mesh, width in itertools.product(LIGHTS, meshes, sorted({t.width for t in trips})):
        some = [t for t in trips if (t.light, t.mesh, t.width) == (light, mesh, width)]
        rows.append((f"{light}, {mesh}, {width}", statistics.median(e for t in some for e in t.errors.values()),
                     statistics.median(t.worst() for t in some), max(t.worst() for t in some), max(t.unwarned() for t in some),
                     statistics.mean(t.fit_s for t in some)))
    figure = Figure("sketches", "sketch-fit: largest dE00 of a paint found against the width of its picture", readings,
                    "width (pixels)", "dE00, the largest of five angles", front=False, x=lambda r: r.numbers["width"], joined=False)
    text = ("Each paint is drawn as render-osmesa does by default, with coat, bright spots, shadows and bounced light, and sketch-fit "
            "looks for it in the picture with the plain buffers. The error is the CIEDE2000 difference, at 15, 25, 45, 75 and 110 "
            "deg, from what the lobes that were drawn show to an instrument. A warning names the angles that no pixel shows; under the lamp, angles with fewer than 20 pixels or a residual above 2 dE76 "
            "count as warned of.")
    head = ("light, mesh, width", "dE00, median reading", "median of the largest", "largest", "largest without a warning", "time (s)")
    return Study("Round trips of sketches", text, [figure],
                 [("By scene", head, rows),
                  (f"Wrong by more than {WRONG_DE00} dE00 without a warning", ("picture", "dE00"),
                   [(f"{t.paint}, {t.light}, {t.mesh}, {t.width}", t.unwarned()) for t in wrong])])
