"""Compares files of paint-export with the lobes of their paints, by a reader of its own and none of our code.

  compare.py PAINTS.xml NAME FILE [NAME FILE]...   prints the mean and the largest CIEDE2000 difference over the 17
                                                   geometries, a line for each file

The ending of FILE chooses the reader: rgl.py, mdl.py, materialx.py, enterprise.py, gltf.py, usd.py, radiance.py or
openmaterial.py beside this script.
"""

import importlib
import pathlib
import sys
import xml.etree.ElementTree

import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "scripts"))
from shared.colors import de2000, lab

SPACE = "{urn:goniochrome:paint:1}"
READERS = {".bsdf": "rgl", ".mdl": "mdl", ".mtlx": "materialx", ".dspbr.gltf": "enterprise", ".gltf": "gltf", ".usda": "usd", ".xml": "radiance", ".xomp": "openmaterial"}
XYZ_FROM_REC2020 = numpy.array(((0.636958, 0.144617, 0.168881), (0.262700, 0.677998, 0.059302), (0.0, 0.028073, 1.060985)))
XYZ_FROM_REC709 = numpy.array(((0.412391, 0.357584, 0.180481), (0.212639, 0.715169, 0.072192), (0.019331, 0.119195, 0.950532)))
PLANE = {45: (-15, 15, 25, 45, 75, 110), 15: (-45, -15, 15, 45, 80), 65: (15, 25, 45, 75, 110)}


def geometries():
    """Unit directions to the light and to the viewer, one pair a row; the light stands at the left."""
    lights, views = [], []
    for light, offs in PLANE.items():
        for off in offs:
            lights.append((-light, 0))
            views.append((light - off, 0))
    lights, views = (numpy.radians(numpy.array(pairs, float)[:, 0]) for pairs in (lights, views))
    flat = [numpy.stack([numpy.sin(a), 0 * a, numpy.cos(a)], -1) for a in (lights, views)]
    t, off = numpy.radians(45), numpy.radians(25)  # 45as25az90: off the mirror direction at a right angle to the plane
    beside = [(-numpy.sin(t), 0, numpy.cos(t)), (numpy.cos(off) * numpy.sin(t), numpy.sin(off), numpy.cos(off) * numpy.cos(t))]
    return [numpy.vstack([rows, row]) for rows, row in zip(flat, beside)]


def fresnel(cosine, index):
    """Fresnel's reflectance of a dielectric for unpolarized light."""
    inside = numpy.sqrt(1 - (1 - cosine ** 2) / index ** 2)
    s, p = ((a * cosine - b * inside) / (a * cosine + b * inside) for a, b in ((1, index), (index, 1)))
    return (s * s + p * p) / 2


def by_view(fit, view_deg):
    """The elements that hold weights, each with its share at every angle: views linear between two, or one for all."""
    views = fit.findall(SPACE + "view")
    if not views:
        return [(fit, numpy.ones(len(view_deg)))]
    angles = [float(view.get("angle")) for view in views]
    return [(view, numpy.interp(view_deg, angles, row)) for view, row in zip(views, numpy.eye(len(views)))]


def lobes(path, name, light, view):
    """f of a paint in Rec.2020: goniochrome-lobes(7), "LOBE MODEL"."""
    paint = next(p for p in xml.etree.ElementTree.parse(path).iter(SPACE + "paint") if p.get("name") == name)
    fit, coat = paint.find(SPACE + "lobes"), paint.find(SPACE + "coat")
    def three(node, names):
        return numpy.array([float(node.get(key)) for key in names])
    passes = numpy.ones(len(light))
    if coat is not None and coat.get("index") not in (None, "none", "1"):
        passes = (1 - fresnel(light[:, 2], float(coat.get("index")))) * (1 - fresnel(view[:, 2], float(coat.get("index"))))
    about = numpy.maximum((light * view * (-1, -1, 1)).sum(1), 0)
    read = paint.find(SPACE + "gloss")  # gloss weights hold at the angle of the first reading
    usual = fresnel(numpy.cos(numpy.radians(45 if read is None else float(read.get("angle")))), 1.5)
    shine = fresnel(numpy.linalg.norm(light + view, axis=1) / 2, 1.5) / usual / light[:, 2]
    f = numpy.zeros((len(light), 3))
    for weights, share in by_view(fit, numpy.degrees(numpy.arccos(numpy.clip(view[:, 2], -1, 1)))):
        f += numpy.outer(share * passes, three(weights.find(SPACE + "diffuse"), "rgb"))
        for lobe in weights.findall(SPACE + "lobe"):
            if lobe.get("exponent") != "mirror":
                power = share * about ** float(lobe.get("exponent"))
                f += numpy.outer(passes * power, three(lobe, ("ddr", "ddg", "ddb"))) + numpy.outer(power * shine, three(lobe, ("gr", "gg", "gb")))
    return f


def main():
    paints, *files = sys.argv[1:]
    light, view = geometries()
    for name, file in zip(files[::2], files[1::2], strict=True):
        reader = importlib.import_module(next(reader for ending, reader in READERS.items() if file.endswith(ending)))
        shown = lab(numpy.pi * reader.reflection(file, light, view) @ XYZ_FROM_REC709.T)
        differences = de2000(lab(numpy.pi * lobes(paints, name, light, view) @ XYZ_FROM_REC2020.T), shown)
        print(f"{differences.mean():.4f} {differences.max():.4f}")


if __name__ == "__main__":
    main()
