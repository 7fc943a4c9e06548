"""Bases of lobes: the exponents that all paints of a library share."""

from make_testdata.numbers import shortest


def basis_xml(name, exponents):
    """The bytes of a basis file with these ascending exponents and a mirror."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>',
             f'<basis xmlns="urn:goniochrome:basis:1" name="{name}">']
    lines += [f"  <exponent>{shortest(exponent)}</exponent>" for exponent in exponents]
    lines += ["  <mirror/>", "</basis>", ""]
    return "\n".join(lines).encode()


def b5():
    """Five lobes and a mirror: a quick basis for tests and for a first look."""
    return basis_xml("b5", [2, 12, 60, 300, 1500])


def b7():
    """Seven lobes and a mirror: the basis of scripts/demo."""
    return basis_xml("b7", [1.3, 6, 20, 70, 250, 900, 3000])
