"""travel.paints.xml: paints of interference flakes, from the physics of a thin film, read at many pairs of angles in plane."""

import math

import numpy

from shared import colors
from shared.numbers import shortest

COAT, FILM = 1.5, 1.38  # refractive indices of the coat and of magnesium fluoride
WAVELENGTHS_NM = numpy.arange(400.0, 701.0, 5.0)
LIGHTS_DEG = range(5, 76, 10)
VIEWS_DEG = range(-75, 76, 10)
GLARE_DEG = 10

# name: thickness of the film in nm, amplitude reflectances of its half-transparent and of its opaque metal, reflectance of the
# ground under the flakes, how much light the flakes send back, and the standard deviation of their tilt in degrees
PAINTS = {
    "film_green_violet": (590.0, 0.42, 0.52, 0.02, 1.6, 14.0),
    "film_gold_teal": (430.0, 0.4, 0.55, 0.03, 1.8, 11.0),
}


def matching_functions():
    """The CIE 1931 functions by the sums of Gaussians of [Wyman2013], of one sum: rows x, y, z."""
    def bump(peak, below, above):
        t = (WAVELENGTHS_NM - peak) * numpy.where(WAVELENGTHS_NM < peak, below, above)
        return numpy.exp(-0.5 * t * t)
    x = 0.362 * bump(442.0, 0.0624, 0.0374) + 1.056 * bump(599.8, 0.0264, 0.0323) - 0.065 * bump(501.1, 0.0490, 0.0382)
    y = 0.821 * bump(568.8, 0.0213, 0.0247) + 0.286 * bump(530.9, 0.0613, 0.0322)
    z = 1.217 * bump(437.0, 0.0845, 0.0278) + 0.681 * bump(459.0, 0.0385, 0.0725)
    return numpy.stack([x, y, z])


def reflectance(thickness_nm, first, second, incidence):
    """What a metal-film-metal flake reflects of light at this angle in the coat: Airy's sum of all reflections."""
    inside = math.sqrt(max(0.0, 1 - (COAT / FILM * math.sin(incidence)) ** 2))  # cosine in the film
    turn = numpy.exp(1j * 4 * math.pi * FILM * thickness_nm * inside / WAVELENGTHS_NM)
    amplitude = (first + second * turn) / (1 + first * second * turn)
    return numpy.abs(amplitude) ** 2


def transmittance(angle):
    """Of the coat's surface for unpolarized light at this angle in air."""
    inside = math.asin(math.sin(angle) / COAT)
    one, other = math.cos(angle), math.cos(inside)
    s, p = (one - COAT * other) / (one + COAT * other), (COAT * one - other) / (COAT * one + other)
    return 1 - 0.5 * (s * s + p * p)


def factor(paint, light, view):
    """The reflectance factor at each wavelength, of angles from the normal in radians, the light's own side positive."""
    thickness_nm, first, second, ground, flakes, spread_deg = paint
    into, out = (math.asin(math.sin(angle) / COAT) for angle in (light, view))
    flake, incidence = 0.5 * (into + out), 0.5 * abs(into - out)
    tilted = math.exp(-0.5 * (math.degrees(flake) / spread_deg) ** 2)
    share = flakes * tilted / (math.cos(into) + math.cos(out))
    return transmittance(light) * transmittance(view) * (ground + share * reflectance(thickness_nm, first, second, incidence))


def lab(values):
    """The color under light of equal energy, relative to the perfect diffuser, which counts as D65."""
    functions = matching_functions()
    return colors.lab(functions @ values / functions.sum(axis=1) * numpy.array(colors.WHITE))


def rows(paint):
    """The name of each geometry, and its color."""
    for light_deg in LIGHTS_DEG:
        for view_deg in VIEWS_DEG:
            aspecular_deg = light_deg + view_deg  # the mirror direction is at -light
            if abs(aspecular_deg) < GLARE_DEG:
                continue
            yield f"{light_deg}as{aspecular_deg}", lab(factor(paint, math.radians(light_deg), math.radians(view_deg)))


def travel_paints_xml():
    """The bytes of the file."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>',
             "<!-- Computed from a thin film, not measured; made by scripts/make-testdata. -->",
             '<paints xmlns="urn:goniochrome:paint:1" version="1">']
    for name, paint in PAINTS.items():
        lines += [f'  <paint name="{name}" class="interference">', '    <measurement illuminant="D65" observer="2">']
        for geometry, color in rows(paint):
            L, a, b = (shortest(round(float(value), 3)) for value in color)
            lines.append(f'      <lab geometry="{geometry}" L="{L}" a="{a}" b="{b}"/>')
        lines += ["    </measurement>", '    <gloss angle="60">85</gloss>', "  </paint>"]
    return "\n".join(lines + ["</paints>", ""]).encode()
