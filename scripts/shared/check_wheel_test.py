"""check_wheel tells the libraries of a wheel from those of the compilers and from others."""

import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from shared.check_wheel import foreign, newest

LISTING = """	linux-vdso.so.1 (0x00007ffd2a5f2000)
	libImath.so.29 => /venv/lib/goniochrome.libs/libImath.so.29 (0x00007f1c0)
	libstdc++.so.6 => /lib/x86_64-linux-gnu/libstdc++.so.6 (0x00007f1c1)
	libc.so.6 => /lib/x86_64-linux-gnu/libc.so.6 (0x00007f1c2)
	/lib64/ld-linux-x86-64.so.2 (0x00007f1c3)
"""


class Libraries(unittest.TestCase):
    def test_those_of_the_wheel_and_of_the_compilers_are_no_fault(self):
        self.assertEqual(foreign(LISTING, "/venv"), [])
        self.assertEqual(foreign("\tstatically linked\n", "/venv"), [])

    def test_those_of_the_system_and_those_that_are_missing_are(self):
        self.assertEqual(foreign(LISTING, "/other"), ["libImath.so.29 => /venv/lib/goniochrome.libs/libImath.so.29 (0x00007f1c0)"])
        self.assertEqual(foreign("\tlibtbb.so.12 => not found\n", "/venv"), ["libtbb.so.12 => not found"])

    def test_a_folder_whose_name_begins_alike_is_outside(self):
        self.assertEqual(len(foreign("\tlibz.so.1 => /venv2/libz.so.1 (0x0)\n", "/venv")), 1)

    def test_the_newest_version_is_found_among_bytes(self):
        content = b"\x7fELF\0GLIBC_2.4\0GLIBC_2.34\0GLIBC_2.9\0GLIBCXX_3.4.30\0GLIBCXX_3.4\0"
        self.assertEqual(newest(content), {"GLIBC_2": 34, "GLIBCXX_3.4": 30})
        self.assertEqual(newest(b"nothing"), {})


if __name__ == "__main__":
    unittest.main()
