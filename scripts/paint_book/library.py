"""The paints of a library: what paint XML says about them, and their places in the book."""

import dataclasses
import math
import re
import xml.etree.ElementTree as tree

NAMESPACE = "urn:goniochrome:paint:1"
tree.register_namespace("", NAMESPACE)

CLASSES = ["solid", "metallic", "pearl", "interference", "unknown"]

# The sets of a book and their groups. Metallics and pearls are in one set, since the eye often cannot distinguish them.
SETS = {"solids": ("Solids", ["solid"]),
        "effects": ("Metallics, pearls and interference colors", ["metallic", "pearl", "interference"]),
        "unknown": ("Not classified", ["unknown"])}
CHROMATIC = ["red", "yellow", "green", "blue"]
NEUTRAL = ["light", "medium", "dark"]

# A chromatic group ends halfway between two of the hues (CIELAB, degrees) that most people call pure: 25, 93, 165 and 246.
HUE_ENDS = [(59, "red"), (129, "yellow"), (205, "green"), (315.5, "blue"), (360, "red")]
NEUTRAL_CHROMA = 7  # A paint whose average chroma is smaller is grouped by its lightness.
LIGHT_L, MEDIUM_L = 66, 33


@dataclasses.dataclass
class Row:
    """A reading: its geometry, its aspecular angle, which has a sign in plane, and Lab."""
    geometry: str
    angle_deg: float
    in_plane: bool
    lab: tuple


@dataclasses.dataclass
class Paint:
    name: str
    code: str
    paint_class: str
    condition: str
    rows: list
    gloss: dict
    appearance: dict  # face, flop, travel and residual; empty if the paint has no appearance
    element: tree.Element
    fit: dict  # the dE00 of the lobes to the readings, max and mean; empty if the paint has no lobes
    indices: dict = dataclasses.field(default_factory=dict)
    flags: list = dataclasses.field(default_factory=list)

    def lab_at(self, angle_deg):
        """Lab at an unsigned aspecular angle: that of the reading at 45as<angle>, else of the curve, else between readings."""
        for row in self.rows:
            if row.in_plane and row.angle_deg == angle_deg:
                return row.lab
        if self.appearance:
            return self.curve_at(angle_deg)
        return between_rows([row for row in self.rows if row.in_plane and row.angle_deg >= 0] or self.rows, angle_deg)

    def curve_at(self, angle_deg):
        """Lab by the clamped quadratic of face, flop and travel: goniochrome-paint(7), "PAINT REPRESENTATIONS"."""
        face, flop, travel = (self.appearance[key] for key in ("face", "flop", "travel"))
        share = ((travel - min(angle_deg, travel)) / (travel - 15)) ** 2
        return tuple(o + (f - o) * share for f, o in zip(face, flop))

    def average(self):
        """(L*, chroma, hue in degrees), averaged over 15, 45 and 110 degrees."""
        labs = [self.lab_at(angle) for angle in (15, 45, 110)]
        lightness, a, b = (sum(values) / 3 for values in zip(*labs))
        return lightness, sum(math.hypot(lab[1], lab[2]) for lab in labs) / 3, math.degrees(math.atan2(b, a)) % 360

    def place(self):
        """(set, group): where the paint stands in the book."""
        in_set = next((key for key, (_, classes) in SETS.items() if self.paint_class in classes), "unknown")
        lightness, chroma, hue = self.average()
        if chroma < NEUTRAL_CHROMA:
            return in_set, "light" if lightness >= LIGHT_L else "medium" if lightness >= MEDIUM_L else "dark"
        return in_set, next(group for end, group in HUE_ENDS if hue <= end)

    def order(self):
        """The key that sorts a group: neutrals go from light to dark, colors around the hue circle from magenta on."""
        lightness, chroma, hue = self.average()
        if chroma < NEUTRAL_CHROMA:
            return (-lightness, self.name)
        return ((hue - HUE_ENDS[-2][0]) % 360, self.name)

    def document(self):
        """Paint XML with this paint only."""
        return (f'<?xml version="1.0" encoding="UTF-8"?>\n<paints xmlns="{NAMESPACE}" version="1">\n  '
                + tree.tostring(self.element, encoding="unicode").replace(f' xmlns="{NAMESPACE}"', "", 1).strip()
                + "\n</paints>\n")


def between_rows(rows, angle_deg):
    """Lab on straight lines between readings, and that of the last reading beyond them."""
    rows = sorted(rows, key=lambda row: abs(row.angle_deg))
    if angle_deg <= abs(rows[0].angle_deg):
        return rows[0].lab
    for near, far in zip(rows, rows[1:]):
        start, end = abs(near.angle_deg), abs(far.angle_deg)
        if start < end and angle_deg <= end:
            t = (angle_deg - start) / (end - start)
            return tuple(n + t * (f - n) for n, f in zip(near.lab, far.lab))
    return rows[-1].lab


GEOMETRY = re.compile(r"r?(?:[0-9.]+as)?(-?[0-9.]+)(az-?[0-9.]+)?")


def row_of(element):
    name = element.get("geometry")
    match = GEOMETRY.fullmatch(name)
    if not match:
        raise ValueError(f'geometry "{name}"')
    return Row(name, float(match[1]), not match[2] and not name.startswith("r"), lab_of(element))


def lab_of(element):
    return tuple(float(element.get(key)) for key in "Lab")


def paint_of(element):
    def q(tag):
        return f"{{{NAMESPACE}}}{tag}"

    measurement = element.find(q("measurement"))
    appearance = element.find(q("appearance"))
    condition, rows, curve = "D65, 10 deg observer", [], {}
    if measurement is not None:
        condition = f"{measurement.get('illuminant', 'D65')}, {measurement.get('observer', '10')} deg observer"
        rows = [row_of(lab) for lab in measurement.iter(q("lab"))]
    if appearance is not None:
        curve = {"face": lab_of(appearance.find(q("face"))), "flop": lab_of(appearance.find(q("flop"))),
                 "travel": float(appearance.get("travel")), "residual": appearance.get("residual_de00")}
    lobes = element.find(q("lobes"))
    fit = {} if lobes is None else {key: float(lobes.get(f"{key}_de00")) for key in ("max", "mean")}
    gloss = {float(reading.get("angle", "60")): float(reading.text) for reading in element.iter(q("gloss"))}
    return Paint(element.get("name"), element.get("code") or "", element.get("class") or "unknown", condition, rows,
                 gloss, curve, element, fit)


def read(path):
    """The paints of a paint XML file. A paint that has no color to show is a ValueError."""
    return paints_in(tree.parse(path).getroot())


def read_text(document):
    """The paints of a text of paint XML, as read() has them."""
    return paints_in(tree.fromstring(document.encode()))


def paints_in(root):
    paints = []
    for element in root.iter(f"{{{NAMESPACE}}}paint"):
        paint = paint_of(element)
        if not paint.rows and not paint.appearance:
            raise ValueError(f'paint "{paint.name}" has neither measured rows nor an appearance')
        paints.append(paint)
    return paints
