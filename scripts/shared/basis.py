"""Bases of lobes: the exponents that all paints of a library share."""

from shared.numbers import shortest


def basis_xml(name, exponents):
    """The bytes of a basis file with these ascending exponents and a mirror."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>',
             f'<basis xmlns="urn:goniochrome:basis:1" name="{name}">']
    lines += [f"  <exponent>{shortest(exponent)}</exponent>" for exponent in exponents]
    lines += ["  <mirror/>", "</basis>", ""]
    return "\n".join(lines).encode()
