"""The paints as paint XML, as long CSV and as wide CSV, all from one table."""

import collections

from shared.numbers import shortest
from make_testdata.paint_table import TABLE

Paint = collections.namedtuple("Paint", "name paint_class gloss_60 rows")  # rows: [(geometry, (L, a, b))]

SIX_ANGLES = ["45as-15", "45as15", "45as25", "45as45", "45as75", "45as110"]
ANGLES = {3: ["45as15", "45as45", "45as110"], 6: SIX_ANGLES}


def paints():
    """The paints of the table, in its order."""
    result = []
    for line in TABLE.splitlines():
        if not line or line.startswith("#"):
            continue
        name, paint_class, gloss_60, values = line.split(None, 3)
        labs = [tuple(float(number) for number in angle.split()) for angle in values.split("|")]
        result.append(Paint(name, paint_class, float(gloss_60), list(zip(ANGLES[len(labs)], labs))))
    return result


def paint_xml():
    """The bytes of the paint XML."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>',
             "<!-- Designed paints, not measured; made by scripts/make-testdata. -->",
             '<paints xmlns="urn:goniochrome:paint:1" version="1">']
    for paint in paints():
        lines.append(f'  <paint name="{paint.name}" class="{paint.paint_class}">')
        lines.append('    <measurement illuminant="D65" observer="10">')
        for geometry, lab in paint.rows:
            L, a, b = map(shortest, lab)
            lines.append(f'      <lab geometry="{geometry}" L="{L}" a="{a}" b="{b}"/>')
        lines.append("    </measurement>")
        lines.append(f'    <gloss angle="60">{shortest(paint.gloss_60)}</gloss>')
        lines.append("  </paint>")
    return "\n".join(lines + ["</paints>", ""]).encode()


def long_csv():
    """The bytes of the long table, which has a row for each angle."""
    lines = ["sample,geometry,illuminant,observer,L,a,b"]
    for paint in paints():
        for geometry, lab in paint.rows:
            lines.append(",".join([paint.name, geometry, "D65", "10", *map(shortest, lab)]))
    return "\n".join(lines + [""]).encode()


def wide_csv():
    """The bytes of the wide table, which has a row for each paint; the cells of angles that were not read are empty."""
    columns = [geometry.removeprefix("45as") for geometry in SIX_ANGLES]
    lines = [",".join(["sample", "illuminant", "observer"] + [c + angle for angle in columns for c in "Lab"])]
    for paint in paints():
        labs = dict(paint.rows)
        cells = [",".join(map(shortest, labs[g])) if g in labs else ",," for g in SIX_ANGLES]
        lines.append(",".join([paint.name, "D65", "10", *cells]))
    return "\n".join(lines + [""]).encode()
