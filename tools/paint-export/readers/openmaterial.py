"""Evaluates the table of an .xomp file of ASAM OpenMATERIAL 3D, linear between its rows, and checks what its schemas and rules ask for."""

import functools
import json
import pathlib
import re

import numpy


def checked(path, schema):
    """A file, whose second line has to name its schema."""
    text = pathlib.Path(path).read_text(encoding="utf-8")
    found = json.loads(text)
    assert re.match(r'"\$schema": *"https://.*/v1\.1\.0/schemas/' + schema + r'\.json",$', text.split("\n")[1].strip()), path
    about = found["metadata"]
    for name in ("name", "license"):
        assert isinstance(about[name], str)
    for name in ("copyrights", "authors"):
        assert about[name] and all(isinstance(entry, str) for entry in about[name])
    assert re.fullmatch(r"[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}", about["uuid"])
    assert re.fullmatch(r"\d+\.\d+\.\d+", about["materialVersion"]) and about["openMaterial3dVersion"] == "1.1.0"
    return found


@functools.lru_cache(None)
def table(path):
    """Wavelengths, then the angles of incidence, exit and azimuth, and f of each combination."""
    (uri,) = checked(path, "material_schema")["materialProperties"]["brdfUris"]
    assert uri.endswith("_brdf.xompt")
    found = checked(pathlib.Path(path).parent / uri, "material_brdf_schema")
    assert isinstance(found["metadata"]["sources"], str)
    rows = numpy.array(found["brdf"]["lookupTable"])
    assert rows.shape[1] == 5 and (rows >= 0).all() and (rows[:, 1:3] <= 1.570796).all() and (rows[:, 3] <= 6.283185).all()
    assert (numpy.lexsort(rows.T[3::-1]) == numpy.arange(len(rows))).all()
    nm, into, out, turn = (numpy.unique(rows[:, column]) for column in range(4))
    assert list(nm) == found["brdf"]["wavelengths"]
    f = numpy.full([len(axis) for axis in (nm, into, out, turn)], numpy.nan)
    f[tuple(numpy.searchsorted(axis, rows[:, column]) for column, axis in enumerate((nm, into, out, turn)))] = rows[:, 4]
    assert not numpy.isnan(f[:, :, 1:]).any()
    f[:, :, 0] = f[:, :, 0, :1]  # a viewer on the normal has one azimuth
    return nm, into, out, turn, f


def bands(path, light, view):
    """f in each band, one pair of directions a row."""
    nm, *axes, f = table(path)
    turn = abs(numpy.arctan2(light[:, 0] * view[:, 1] - light[:, 1] * view[:, 0], (light * view)[:, :2].sum(1)))
    cells = []
    for axis, at in zip(axes, (numpy.arccos(light[:, 2]), numpy.arccos(view[:, 2]), turn)):
        low = numpy.clip(numpy.searchsorted(axis, at, "right") - 1, 0, len(axis) - 2)
        share = numpy.clip((at - axis[low]) / (axis[low + 1] - axis[low]), 0, 1)
        cells.append(((low, 1 - share), (low + 1, share)))
    return sum(f[:, i, o, k].T * (a * b * c)[:, None] for i, a in cells[0] for o, b in cells[1] for k, c in cells[2])


def reflection(path, light, view):
    """f of each pair of directions, one a row, in Rec.709, of gray paints alone."""
    f = bands(path, light, view)
    assert (f.max(1) - f.min(1) < 1e-4 * f.max(1) + 1e-9).all()
    return numpy.repeat(f.mean(1)[:, None], 3, axis=1)
