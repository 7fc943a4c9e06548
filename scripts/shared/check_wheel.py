"""Checks the wheel that is installed in the environment of this Python, and prints what it takes from the system.

  venv/bin/python scripts/shared/check_wheel.py FILE.whl

Every command answers --version, the five lines of Python in README.md run, and its programs and libraries load no library from
outside but those of the C and C++ compilers, which are no newer than those of Debian 12. The exit status is 1 if one does not hold.
"""

import importlib.metadata
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

TOP = pathlib.Path(__file__).resolve().parents[2]
OF_COMPILERS = re.compile(r"(ld-linux-x86-64|linux-vdso|lib(c|m|dl|rt|pthread|util|stdc\+\+|gcc_s))\.so\.[0-9]+")
NEWEST = {"GLIBC_2": 36, "GLIBCXX_3.4": 30}  # those of Debian 12


def foreign(listing, inside):
    """The libraries that ldd lists, are not below `inside`, and are none of the compilers; "not found" is among them."""
    names = []
    for line in listing.splitlines():
        words = line.split()
        if not words or words[:2] == ["statically", "linked"]:
            continue
        path = words[2] if "=>" in words and len(words) > 2 else words[0]
        if not OF_COMPILERS.fullmatch(pathlib.PurePath(words[0]).name) and not os.path.realpath(path).startswith(str(inside) + "/"):
            names.append(line.strip())
    return names


def newest(content):
    """The newest version of each library of the compilers that is named in a program: {"GLIBC_2": 34}."""
    found = {}
    for name, number in re.findall(rb"\b(GLIBC_2|GLIBCXX_3\.4)\.([0-9]+)\b", content):
        found[name.decode()] = max(int(number), found.get(name.decode(), 0))
    return found


def main(wheel):
    prefix = pathlib.Path(sys.prefix).resolve()
    os.environ["PATH"] = f"{prefix}/bin:/usr/bin:/bin"
    faults, outside, versions = [], set(), {}
    files = [pathlib.Path(file.locate()).resolve() for file in importlib.metadata.files("goniochrome")]

    commands = [file.stem for file in files if file.parent.name == "man1"]
    for command in commands:
        if subprocess.run([command, "--version"], capture_output=True, check=False).returncode:
            faults.append(f"{command} --version fails")
    if not commands:
        faults.append("there are no man pages")

    programs = [file for file in files if file.is_file() and file.read_bytes()[:4] == b"\x7fELF"]
    for program in programs:
        listing = subprocess.run(["ldd", program], capture_output=True, text=True, check=False).stdout
        outside.update(match[0] for match in OF_COMPILERS.finditer(listing))
        faults += [f"{program} loads from outside: {line}" for line in foreign(listing, prefix)]
        for name, number in newest(program.read_bytes()).items():
            versions[name] = max(number, versions.get(name, 0))
            if number > NEWEST[name]:
                faults.append(f"{program} needs {name}.{number}, Debian 12 has {name}.{NEWEST[name]}")

    lines = re.search(r"(?:^    .*\n)*^    import goniochrome.*\n(?:^    .*\n)*", (TOP / "README.md").read_text(), re.M)[0]
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "testdata").symlink_to(TOP / "testdata")
        done = subprocess.run([sys.executable, "-c", re.sub("^    ", "", lines, flags=re.M)], cwd=folder, check=False)
        if done.returncode or not pathlib.Path(folder, "silver.svg").exists():
            faults.append("the five lines of Python fail")

    unpacked = sum(file.file_size for file in zipfile.ZipFile(wheel).infolist())
    print(f"{pathlib.Path(wheel).name}: {os.path.getsize(wheel) / 1e6:.0f} MB, unpacked {unpacked / 1e6:.0f} MB; {len(commands)} commands, "
          f"{len(programs)} programs and libraries")
    print("from outside:", *sorted(outside), "up to", *(f"{name}.{number}" for name, number in sorted(versions.items())))
    print(*faults, sep="\n", end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    sys.exit(main(sys.argv[1]))
