"""Files that are either whole or not there."""

import os
import pathlib


def write_whole(path, content):
    """Writes text or bytes to a file beside `path` and renames it, so that nobody ever sees half a file."""
    partial = pathlib.Path(f"{path}.{os.getpid()}.partial")
    try:
        partial.write_bytes(content if isinstance(content, bytes) else content.encode())
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)
