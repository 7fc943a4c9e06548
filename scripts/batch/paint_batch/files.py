"""JSON files, and folders that one process at a time works in."""

import contextlib
import fcntl
import json
import pathlib

from shared.files import write_whole
from shared.tools import Failed


def write_json(path, value):
    write_whole(path, json.dumps(value, indent=1) + "\n")


def read_json(path):
    return json.loads(pathlib.Path(path).read_text(encoding="utf-8"))


def read_plan(out):
    """The plan of the batch in the folder `out`."""
    try:
        return read_json(out / "plan.json")
    except FileNotFoundError:
        raise Failed(f"{out}: there is no batch: `paint-batch plan LIBRARY --out {out}` makes one") from None


def check_number(number, count, what, out):
    """Refuses the number of a part of the batch in the folder `out`, of which there are `count`, if there is no such part."""
    if not 0 <= number < count:
        has = f"they are numbered 0 to {count - 1}" if count else "it has none"
        raise Failed(f"{out}: there is no {what} {number}: {has}")


@contextlib.contextmanager
def locked(folder):
    """Keeps other processes out of a folder; the lock ends with this process, however the process ends."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
