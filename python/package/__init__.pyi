from collections.abc import Sequence

import numpy
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[numpy.float64]

class Error(ValueError):
    """An input is wrong; the message says where and what would be right."""

class Lobe:
    """One cosine lobe about the mirror direction; an exponent of inf stands for the mirror."""
    @property
    def exponent(self) -> float: ...
    @property
    def directional_diffuse(self) -> Floats: """K_DD in 1/sr, shape (3,), a view."""
    @property
    def gloss(self) -> Floats: """K_G in 1/sr, of the mirror a share of Fresnel's reflectance; shape (3,), a view."""

class LobeFit:
    """The lobes of a paint, and the CIEDE2000 differences of the fit from the readings."""
    @property
    def coat_index(self) -> float: """The refractive index of the coat; 1: there is none."""
    @property
    def mean_de00(self) -> float: ...
    @property
    def max_de00(self) -> float: ...
    @property
    def lobes(self) -> list[Lobe]: ...
    @property
    def diffuse(self) -> Floats: """K_D in 1/sr, shape (3,), a view."""

class Paint:
    @property
    def name(self) -> str: ...
    @property
    def code(self) -> str: ...
    @property
    def paint_class(self) -> str: """solid, metallic, pearl, interference or unknown."""
    @property
    def illuminant(self) -> str: ...
    @property
    def observer_deg(self) -> int: ...
    @property
    def geometries(self) -> list[str]: """The names of the n readings, such as 45as15."""
    @property
    def readings(self) -> Floats: """CIELAB, shape (n, 3)."""
    @property
    def lobes(self) -> LobeFit | None: ...
    @property
    def metrics(self) -> dict[str, float]: """The numbers of paint-stats by name; nan where one does not apply."""
    def curve(self, aspecular_deg: ArrayLike) -> Floats: """CIELAB at these angles off the mirror direction, shape (n, 3)."""
    def brdf(self, light: ArrayLike, view: ArrayLike) -> Floats:
        """f in 1/sr without the mirror, shape (..., 3), for directions of shape (..., 3). The paint has to have lobes."""

class Basis:
    """The exponents that the paints of a library are fitted with."""
    def __init__(self, exponents: Sequence[float], mirror: bool = True, name: str = "basis") -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def mirror(self) -> bool: ...
    @property
    def exponents(self) -> Floats: """Ascending, shape (n,), a view."""

class Environment:
    """Light from every direction, texel by texel as it came from its file."""
    @property
    def texels(self) -> NDArray[numpy.float32]: """Radiance, shape (height, width, 3), a view."""
    @property
    def layout(self) -> str: """lat-long, cube (six faces from the top), cube-edges or angular."""
    def directions(self) -> Floats: """Shape (height, width, 3)."""
    def solid_angles(self) -> Floats: """In sr, shape (height, width)."""

class PrefilteredLobe:
    """An environment filtered by one lobe."""
    @property
    def exponent(self) -> float: ...
    @property
    def max_error(self) -> float: """Relative, as it was measured."""
    @property
    def texels(self) -> NDArray[numpy.float32]: """Shape (6, n, n, 3) of a cube, (height, width, 3) of other layouts; a view."""

class PrefilteredEnvironment:
    @property
    def source(self) -> str: ...
    @property
    def diffuse(self) -> PrefilteredLobe: """pi times it is the irradiance."""
    @property
    def mirror(self) -> PrefilteredLobe: """The environment itself."""
    @property
    def lobes(self) -> list[PrefilteredLobe]: """Exponents ascending."""

def read_paints(path: str) -> list[Paint]:
    """The paints of a paint XML file, or those of FILE#NAME,NAME."""
def write_paints(path: str, paints: Sequence[Paint]) -> None:
    """Writes a paint XML file, whole or not at all."""
def read_basis(path: str) -> Basis: ...
def fit(paints: Sequence[Paint], basis: Basis, method: str = "l1", coat_index: float | None = None) -> list[Paint]:
    """The paints with lobes, fitted on all cores. Methods: l1, l2, deltae. No coat_index: that of the paint, or what its gloss asks for."""
def delta_e_2000(x: ArrayLike, y: ArrayLike) -> Floats:
    """CIEDE2000 of colors of shape (..., 3), shape (...). y may be one color."""
def delta_e_76(x: ArrayLike, y: ArrayLike) -> Floats: ...
def lab_from_rgb(rgb: ArrayLike, illuminant: str = "D65", observer_deg: int = 10) -> Floats:
    """CIELAB of reflectance factors in linear Rec.2020, shape (..., 3)."""
def rgb_from_lab(lab: ArrayLike, illuminant: str = "D65", observer_deg: int = 10) -> Floats: ...
def directions(geometries: Sequence[str]) -> tuple[Floats, Floats]:
    """The unit directions to the light and to the viewer of geometries such as 45as15, each of shape (n, 3)."""
def aspecular_deg(geometry: str) -> float:
    """The angle of a geometry off the mirror direction, 0 to 180."""
def read_environment(path: str) -> Environment:
    """Any image that prefilter-envmap reads."""
def read_prefiltered(path: str) -> PrefilteredEnvironment:
    """An .env.exr file of prefilter-envmap."""
