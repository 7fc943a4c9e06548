"""Paint that changes its color with the angle: readings, fits to cosine lobes, color differences, and light from all around.

Directions are unit vectors away from the surface, in the frame whose z is the normal. Angles are in degrees. RGB is linear
Rec.2020, 1 is the perfect diffuser; Lab is relative to the perfect diffuser under the illuminant of the paint. The file
__init__.pyi states the type and the shape of everything. Functions raise Error, a ValueError, with the message of the tools.
"""

try:
    from ._core import (Basis, Environment, Error, Lobe, LobeFit, Paint, PrefilteredEnvironment, PrefilteredLobe, aspecular_deg,
                        delta_e_2000, delta_e_76, directions, fit, lab_from_rgb, read_basis, read_environment, read_paints,
                        read_prefiltered, rgb_from_lab, write_paints)
except ModuleNotFoundError as error:
    if error.name != "goniochrome._core":
        raise
    import pathlib
    import sys
    endings = [path.name.split("-")[1] for path in sorted(pathlib.Path(__file__).parent.glob("_core.cpython-*.so"))]
    raise ImportError(f"this installation of goniochrome has the module for Python {', '.join(f'{e[0]}.{e[1:]}' for e in endings)}, "
                      f"and this is Python {sys.version_info[0]}.{sys.version_info[1]}: use one of those, or install from source") from None

__all__ = ["Basis", "Environment", "Error", "Lobe", "LobeFit", "Paint", "PrefilteredEnvironment", "PrefilteredLobe", "aspecular_deg",
           "delta_e_2000", "delta_e_76", "directions", "fit", "lab_from_rgb", "read_basis", "read_environment", "read_paints",
           "read_prefiltered", "rgb_from_lab", "write_paints"]
