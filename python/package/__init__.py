"""Paint that changes its color with the angle: readings, fits to cosine lobes, color differences, and light from all around.

Directions are unit vectors away from the surface, in the frame whose z is the normal. Angles are in degrees. RGB is linear
Rec.2020, 1 is the perfect diffuser; Lab is relative to the perfect diffuser under the illuminant of the paint. Functions raise
Error, a ValueError, with the message of the tools.
"""

import ctypes
import json
import os
import warnings
from collections.abc import Sequence

import numpy
from numpy.typing import ArrayLike, NDArray

__all__ = ["Basis", "Environment", "Error", "Lobe", "LobeFit", "Paint", "PrefilteredEnvironment", "PrefilteredLobe", "aspecular_deg",
           "delta_e_2000", "delta_e_76", "directions", "fit", "lab_from_rgb", "read_basis", "read_environment", "read_paints",
           "read_prefiltered", "rgb_from_lab", "write_paints"]

Floats = NDArray[numpy.float64]
Texels = NDArray[numpy.float32]
Path = str | os.PathLike[str]

try:
    _library = ctypes.CDLL(os.path.join(os.path.dirname(__file__), "libgoniochrome.so"))
except OSError as error:
    raise ImportError(f"goniochrome cannot load its library: {error}: install the package anew") from None


class Error(ValueError):
    """An input is wrong; the message says where and what would be right."""


class _Keep(ctypes.c_void_p):
    """A share in an object of the library, which stays in its place until the last share goes."""

    def __del__(self, release=_library.goniochrome_release):
        release(self)

    def __reduce__(self):
        raise TypeError("objects of goniochrome are in memory alone: write_paints() makes a file of paints")


def _call(name, *values, out=None, keep=None):
    """The facts that a function of the library returns, each object with `keep`; or the array of shape `out` that it fills."""
    last = keep if out is None else numpy.empty(out)
    values += () if last is None else (last,)
    if wrong := [text for text in values if isinstance(text, bytes) and 0 in text]:
        raise Error(f"{wrong[0]!r} has a null character")
    kinds = {int: ctypes.c_size_t, float: ctypes.c_double, numpy.ndarray: lambda array: array.ctypes, _Keep: ctypes.byref}
    arguments = [kinds.get(type(value), lambda other: other)(value) for value in values]
    function = _library["goniochrome_" + name]
    function.restype = ctypes.c_char_p
    facts = json.loads(function(*arguments), object_hook=None if keep is None else lambda facts: {**facts, "keep": keep})
    if isinstance(facts, str):
        raise Error(facts)
    return facts if out is None else last


def _places(paints):
    if wrong := [one for one in paints if not isinstance(one, Paint)]:
        raise TypeError(f"{wrong[0]!r} is no Paint")
    return (ctypes.c_void_p * len(paints))(*(paint._facts["place"] for paint in paints)), len(paints)


def _triples(array, what):
    array = numpy.ascontiguousarray(array, float)
    if array.shape[-1] != 3:
        raise Error(f"{what}: the last axis has to have three numbers")
    return array


def _constant(numbers):
    array = numpy.array(numbers, float)
    array.flags.writeable = False
    return array


def _fact(name, make, doc=None):
    """A read-only attribute: what `make` makes of the fact of that name."""
    return property(lambda owner: make(owner._facts[name]), doc=doc)


class _Object:
    """An object of which the library states facts."""

    def __init__(self, facts):
        self._facts = facts


class _Texels(_Object):
    """An object whose texels numpy sees in place, read only, in an array that keeps the object."""

    @property
    def __array_interface__(self):
        return {"version": 3, "shape": tuple(self._facts["shape"]), "typestr": numpy.dtype(numpy.float32).str,
                "data": (self._facts["texels"], True)}


class Lobe(_Object):
    """One cosine lobe about the mirror direction; an exponent of inf stands for the mirror."""
    exponent: float = _fact("exponent", float)
    directional_diffuse: Floats = _fact("directional_diffuse", _constant, "K_DD in 1/sr, shape (3,).")
    gloss: Floats = _fact("gloss", _constant, "K_G in 1/sr, of the mirror a share of Fresnel's reflectance; shape (3,).")


class LobeFit(_Object):
    """The lobes of a paint, and the CIEDE2000 differences of the fit from the readings."""
    coat_index: float = _fact("coat_index", float, "The refractive index of the coat; 1: there is none.")
    mean_de00: float = _fact("mean_de00", float)
    max_de00: float = _fact("max_de00", float)
    lobes: list[Lobe] = _fact("lobes", lambda lobes: [Lobe(facts) for facts in lobes])
    diffuse: Floats = _fact("diffuse", _constant, "K_D in 1/sr, shape (3,).")


class Paint(_Object):
    """A paint of a file or of a fit."""
    name: str = _fact("name", str)
    code: str = _fact("code", str)
    paint_class: str = _fact("paint_class", str, "solid, metallic, pearl, interference or unknown.")
    illuminant: str = _fact("illuminant", str)
    observer_deg: int = _fact("observer_deg", int)
    geometries: list[str] = _fact("geometries", list, "The names of the n readings, such as 45as15.")
    readings: Floats = _fact("readings", lambda rows: numpy.array(rows, float).reshape(-1, 3), "CIELAB, shape (n, 3).")
    lobes: LobeFit | None = _fact("lobes", lambda facts: facts and LobeFit(facts))

    @property
    def metrics(self) -> dict[str, float]:
        """The numbers of paint-stats by name; nan where one does not apply."""
        return {name: float(value) for name, value in _call("metrics", self._facts["place"]).items()}

    def curve(self, aspecular_deg: ArrayLike) -> Floats:
        """CIELAB at these angles off the mirror direction, shape (n, 3)."""
        angles = numpy.ascontiguousarray(aspecular_deg, float)
        return _call("curve", self._facts["place"], angles, angles.size, out=(angles.size, 3))

    def brdf(self, light: ArrayLike, view: ArrayLike) -> Floats:
        """f in 1/sr without the mirror, shape (..., 3), for directions of shape (..., 3). The paint has to have lobes."""
        light, view = _triples(light, "light"), _triples(view, "view")
        if light.size != view.size:
            raise Error("light and view have to have as many directions")
        return _call("brdf", self._facts["place"], light, view, light.size // 3, out=light.shape)

    def __repr__(self) -> str:
        return f'<goniochrome.Paint "{self.name}">'


class Basis(_Object):
    """The exponents that the paints of a library are fitted with."""
    name: str = _fact("name", str)
    mirror: bool = _fact("mirror", bool)
    exponents: Floats = _fact("exponents", _constant, "Ascending, shape (n,).")

    def __init__(self, exponents: Sequence[float], mirror: bool = True, name: str = "basis") -> None:
        super().__init__({"exponents": sorted(map(float, exponents)), "mirror": mirror, "name": name})


class Environment(_Texels):
    """Light from every direction, texel by texel as it came from its file."""
    texels: Texels = property(numpy.asarray, doc="Radiance, shape (height, width, 3), a view.")
    layout: str = _fact("layout", str, "lat-long, cube (six faces from the top), cube-edges or angular.")

    def directions(self) -> Floats:
        """Shape (height, width, 3)."""
        return _call("directions", self._facts["place"], out=self._facts["shape"])

    def solid_angles(self) -> Floats:
        """In sr, shape (height, width)."""
        return _call("solid_angles", self._facts["place"], out=self._facts["shape"][:2])


class PrefilteredLobe(_Texels):
    """An environment filtered by one lobe."""
    exponent: float = _fact("exponent", float)
    max_error: float = _fact("max_error", float, "Relative, as it was measured.")
    texels: Texels = property(numpy.asarray, doc="Shape (6, n, n, 3) of a cube, (height, width, 3) of other layouts; a view.")


class PrefilteredEnvironment(_Object):
    """An environment filtered by every lobe of a basis."""
    source: str = _fact("source", str)
    diffuse: PrefilteredLobe = _fact("diffuse", PrefilteredLobe, "pi times it is the irradiance.")
    mirror: PrefilteredLobe = _fact("mirror", PrefilteredLobe, "The environment itself.")
    lobes: list[PrefilteredLobe] = _fact("lobes", lambda lobes: [PrefilteredLobe(facts) for facts in lobes], "Exponents ascending.")


def read_paints(path: Path) -> list[Paint]:
    """The paints of a paint XML file, or those of FILE#NAME,NAME."""
    read = _call("read_paints", os.fsencode(path), keep=_Keep())
    for warning in read["warnings"]:
        warnings.warn(warning, stacklevel=2)
    return [Paint(facts) for facts in read["paints"]]


def write_paints(path: Path, paints: Sequence[Paint]) -> None:
    """Writes a paint XML file, whole or not at all."""
    _call("write_paints", os.fsencode(path), *_places(paints))


def read_basis(path: Path) -> Basis:
    """The basis of a basis XML file."""
    return Basis(**_call("read_basis", os.fsencode(path)))


def fit(paints: Sequence[Paint], basis: Basis, method: str = "l1", coat_index: float | None = None) -> list[Paint]:
    """The paints with lobes, fitted on all cores. Methods: l1, l2, deltae. No coat_index: that of the paint, or what its gloss asks for."""
    options = str.encode(basis.name), basis.exponents, basis.exponents.size, basis.mirror, str.encode(method)
    coat = None if coat_index is None else ctypes.byref(ctypes.c_double(coat_index))
    return [Paint(facts) for facts in _call("fit", *_places(paints), *options, coat, keep=_Keep())]


def delta_e_2000(x: ArrayLike, y: ArrayLike) -> Floats:
    """CIEDE2000 of colors of shape (..., 3), shape (...). y may be one color."""
    return _difference(True, _triples(x, "x"), _triples(y, "y"))


def delta_e_76(x: ArrayLike, y: ArrayLike) -> Floats:
    """As delta_e_2000(), but of CIE 1976."""
    return _difference(False, _triples(x, "x"), _triples(y, "y"))


def _difference(is_2000, x, y):
    if y.size not in (x.size, 3):
        raise Error("y has to have as many colors as x, or one")
    return _call("delta_e", is_2000, x, x.size // 3, y, y.size // 3, out=x.shape[:-1])


def lab_from_rgb(rgb: ArrayLike, illuminant: str = "D65", observer_deg: int = 10) -> Floats:
    """CIELAB of reflectance factors in linear Rec.2020, shape (..., 3)."""
    rgb = _triples(rgb, "rgb")
    return _call("convert", True, rgb, rgb.size // 3, str.encode(illuminant), float(observer_deg), out=rgb.shape)


def rgb_from_lab(lab: ArrayLike, illuminant: str = "D65", observer_deg: int = 10) -> Floats:
    """Reflectance factors in linear Rec.2020 of CIELAB, shape (..., 3)."""
    lab = _triples(lab, "lab")
    return _call("convert", False, lab, lab.size // 3, str.encode(illuminant), float(observer_deg), out=lab.shape)


def directions(geometries: Sequence[str]) -> tuple[Floats, Floats]:
    """The unit directions to the light and to the viewer of geometries such as 45as15, each of shape (n, 3)."""
    pairs = [_call("geometry", str.encode(name))[:2] for name in geometries]
    return tuple(numpy.array(pairs, float).reshape(-1, 2, 3).swapaxes(0, 1))


def aspecular_deg(geometry: str) -> float:
    """The angle of a geometry off the mirror direction, 0 to 180."""
    return _call("geometry", str.encode(geometry))[2]


def read_environment(path: Path) -> Environment:
    """Any image that prefilter-envmap reads."""
    return Environment(_call("read_environment", os.fsencode(path), keep=_Keep()))


def read_prefiltered(path: Path) -> PrefilteredEnvironment:
    """An .env.exr file of prefilter-envmap."""
    return PrefilteredEnvironment(_call("read_prefiltered", os.fsencode(path), keep=_Keep()))
