"""The bases of lobes."""

from shared.basis import basis_xml


def b5():
    """Five lobes and a mirror: a quick basis for tests and for a first look."""
    return basis_xml("b5", [2, 12, 60, 300, 1500])


def b7():
    """Seven lobes and a mirror: the basis of scripts/demo."""
    return basis_xml("b7", [1.3, 6, 20, 70, 250, 900, 3000])
