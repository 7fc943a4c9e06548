"""Installs Debian packages that a script needs."""

import importlib
import importlib.util
import pathlib
import subprocess
import sys

SCRIPTS = pathlib.Path(__file__).resolve().parents[1]
MODULES = {"numpy": "python3-numpy", "OpenImageIO": "python3-openimageio"}


def install(*packages):
    """Installs those of the packages that are missing, as common.sh does it for the bash scripts; SystemExit if that fails."""
    done = subprocess.run(["bash", "-c", 'source "$1/common.sh" && install "${@:2}"', sys.argv[0], str(SCRIPTS), *packages],
                          check=False)
    if done.returncode:
        sys.exit(done.returncode)


def install_modules(*modules):
    """Installs those of the Python modules that are missing; call this before they are imported."""
    missing = [MODULES[module] for module in modules if not importlib.util.find_spec(module)]
    if missing:
        install(*missing)
        importlib.invalidate_caches()
