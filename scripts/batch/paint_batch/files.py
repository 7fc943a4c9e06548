"""JSON files, and folders that one process at a time works in."""

import contextlib
import fcntl
import json
import pathlib

from shared.files import write_whole


def write_json(path, value):
    write_whole(path, json.dumps(value, indent=1) + "\n")


def read_json(path):
    return json.loads(pathlib.Path(path).read_text(encoding="utf-8"))


@contextlib.contextmanager
def locked(folder):
    """Keeps other processes out of a folder; the lock ends with this process, however the process ends."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
