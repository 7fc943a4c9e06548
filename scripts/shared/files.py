"""Files that are either whole or not there."""

import os
import pathlib
import re
import shutil
import sys

OPEN_FILE = re.compile(r"(?:/dev/fd|/proc/self/fd)/([0-9]+)")
NAMES = {"-": 1, "/dev/stdout": 1, "/dev/stderr": 2}


def write_whole(path, content):
    """Writes text or bytes to a file beside `path` and renames it, so that nobody ever sees half a file.

    "-" is standard output. What is no plain file (a device, a pipe) is written to and not replaced, and so is a name of an
    open file. A file that is replaced keeps its mode, its owner where that is allowed, and the links that lead to it.
    """
    # Names from the command line may hold bytes outside UTF-8, which the text must not.
    content = content if isinstance(content, bytes) else content.encode(errors="replace")
    named = OPEN_FILE.fullmatch(str(path))
    descriptor = int(named[1]) if named else NAMES.get(str(path))
    if descriptor is not None:
        with open(os.dup(descriptor), "wb") as stream:
            stream.write(content)
        return
    target = pathlib.Path(os.path.realpath(path))
    if target.exists() and not target.is_file():
        with open(target, "wb") as stream:
            stream.write(content)
        return
    partial = target.parent / f".{os.getpid()}.partial"
    try:
        partial.write_bytes(content)
        if target.exists():
            take_over(partial, target)
        os.replace(partial, target)
    finally:
        partial.unlink(missing_ok=True)


def take_over(new, old):
    """Gives the new file the owner of the old one, where that is allowed, and its mode."""
    status = old.stat()
    try:
        os.chown(new, status.st_uid, status.st_gid)
    except PermissionError:
        pass
    shutil.copymode(old, new)


def open_closed_descriptors():
    """Opens /dev/null on what is closed of standard input, output and error, lest the next file take their place.

    It is opened the wrong way round: to read a closed standard input and to write to a closed standard output stay errors.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDONLY if number == 1 else os.O_WRONLY)
            os.set_inheritable(number, True)
            if number == 1:
                sys.stdout = open(1, "w", encoding="utf-8")
            if number == 2:
                sys.stderr = open(2, "w", encoding="utf-8")
