"""Files that are whole or not there."""

import contextlib
import fcntl
import json
import os
import pathlib


def write(path, text):
    partial = pathlib.Path(f"{path}.{os.getpid()}.partial")
    partial.write_text(text, encoding="utf-8")
    os.replace(partial, path)


def write_json(path, value):
    write(path, json.dumps(value, indent=1) + "\n")


def read_json(path):
    return json.loads(pathlib.Path(path).read_text(encoding="utf-8"))


@contextlib.contextmanager
def locked(folder):
    """Keeps a second process out of a folder; the lock goes with the process, however that ends."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
