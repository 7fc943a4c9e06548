"""Spheres in interference paints under a lamp aside: treatments of the critical angle, with and without the projection factor."""

import numpy

from shared import pictures
from shared.colors import de2000, lab
from shared.quantile import quantile
from shared.sphere import sphere_obj

from .study import Study

XYZ = ((0.636958, 0.144617, 0.168881), (0.262700, 0.677998, 0.059302), (0.0, 0.028073, 1.060985))  # from linear Rec.2020
ASIDE_DEG = (30, 60, 90)  # between the lamp and the viewer
TREATMENTS = ("clip", "slide", "index")
EDGE_DEG = (80, 89)  # the rim of the lit part, by the angle of the lamp from the normal


class Sphere:
    """The sphere in one paint, whose gloss is left out as in the source."""

    def __init__(self, run, paint):
        self.run, self.paint, self.out = run, paint, run.work / "isolines.exr"

    def drawn(self, aside, treatment):
        """(linear Rec.2020 of the lit pixels, the cosine of the lamp there)."""
        self.run.tool("render-osmesa", "--mesh", self.run.work / "isolines.obj", "--paint", self.paint, "--light",
                      f"{aside},0@0", "--camera", "0,0", "--size", "240x240" if self.run.quick else "480x480",
                      "--samples", 1, "--effects", "all,-rays,-gloss", "--engine", "cpu", "--critical-angle", treatment,
                      "--aov", "lambert,mask", "-o", self.out)
        channels = pictures.channels(self.out)
        cosine = channels["lambert"]
        lit = (channels["mask"] == 1) & (cosine > 0.01)
        return numpy.stack([channels[name][lit] for name in "RGB"], -1), cosine[lit]


def rows_of(run, paint, name):
    sphere = Sphere(run, paint)
    for aside in ASIDE_DEG[1:2] if run.quick else ASIDE_DEG:
        clip = None
        for treatment in TREATMENTS:
            light, cosine = sphere.drawn(aside, treatment)
            factors = light / cosine[:, None]  # reflectance factors, which the source draws first
            with_factor, without = (lab(numpy.maximum(rgb, 0) @ numpy.transpose(XYZ)) for rgb in (light, factors))
            angle = numpy.degrees(numpy.arccos(numpy.minimum(cosine, 1)))
            edge = (angle > EDGE_DEG[0]) & (angle < EDGE_DEG[1])
            clip = with_factor if clip is None else clip
            apart = de2000(clip, with_factor)
            yield (name, aside, treatment, float(without[edge, 0].mean()), float(with_factor[edge, 0].mean()),
                   float(apart.mean()), quantile(apart.tolist(), 0.95))


def study(run):
    (run.work / "isolines.obj").write_text(sphere_obj(96))
    fitted = run.work / "isolines.xml"
    paints = f"{run.data / 'travel.paints.xml'}{'#film_gold_teal' if run.quick else ''}"
    results, _ = run.tool("fit-paint", "--basis", run.data / "b7.basis.xml", paints, "-o", fitted, "--color-map", run.work)
    names = [paint["name"] for paint in results["color_maps"]]
    rows = [row for name in names for row in rows_of(run, f"{fitted}#{name}", name)]
    return Study("Isolines beyond the critical angle",
                 "A sphere in an interference paint under a lamp aside of the viewer, after figure 6 of Kirchner: its color map is "
                 "followed by three treatments of the critical angle, each as reflectance factors alone and with the projection "
                 "factor, the cosine of the lamp. Edge is where the lamp stands "
                 f"{EDGE_DEG[0]} to {EDGE_DEG[1]} degrees from the normal: the step there from light to shade is the lightness L* "
                 "itself. The differences of treatments are those of lit pixels, with the factor.", [],
                 [("Treatments and the projection factor",
                   ("paint", "lamp aside (deg)", "treatment", "edge L*, without", "edge L*, with", "from clip, dE00 mean", "95 %"),
                   rows)])
