"""The book as an HTML page that needs no other file."""

import base64
import html
import json
import math
import os
import pathlib
import re
import urllib.parse

from paint_book import library
from paint_book.colors import gloss_border, srgb, strip
from paint_book.plot import plot

HERE = pathlib.Path(__file__).parent

# Each index, its name, and what it tells.
INDICES = {"flop_index": ("Flop index", "how much lightness travels"),
           "chroma_index": ("Chroma index", "how much chroma travels"),
           "hue_shift_index": ("Hue-shift index", "how far the flop leaves the hue of the face")}
GROUP_SWATCH = {"red": "#b5413c", "yellow": "#c9a227", "green": "#3f8f5c", "blue": "#3a6ea8",
                "light": "#f2f2f2", "medium": "#999999", "dark": "#333333"}
FILES = [("paints.xml", "application/xml"), ("csv", "text/csv"), ("cxf", "application/xml")]


def text(value):
    return html.escape(str(value), quote=True)


def number(value, digits=1):
    return "n/a" if value is None else f"{round(value, digits) + 0.0:.{digits}f}"  # 0.0 takes the sign off a zero


def address_beside(file, page_file):
    """The address of `file` in links of `page_file`."""
    return urllib.parse.quote(os.path.relpath(file, pathlib.Path(page_file).parent))


def page(title, summary, paints, pictures, documents, size, studio=None, beside=None, links=""):
    """The HTML. `pictures[i]` is a PNG, as bytes; `documents[i]` has the texts of FILES; `size` is that of a picture in pixels.
    `studio` is the address of a page of paint-studio, or None. `beside` is what page.js needs to know of the folder that has
    pictures, cards and texts, which are then not in the page, or None. `links` is HTML that leads to other pages."""
    filed = {}
    for index, paint in enumerate(paints):
        filed.setdefault(paint.place(), []).append(index)
    for members in filed.values():
        members.sort(key=lambda index: paints[index].order())
    sets = [key for key in library.SETS if any(place[0] == key for place in filed)]
    style = (HERE / "page.css").read_text().replace("{{aspect}}", f"{size[0]}/{size[1]}")
    parts = {"links": links, "title": text(title), "summary": text(summary), "style": style,
             "script": (HERE / "page.js").read_text(), "classes": class_boxes(paints),
             "ranges": "".join(range_slider(index, paints) for index in INDICES),
             "groups": group_links(sets, filed),
             "sets": "".join(set_section(key, filed, paints, pictures, size) for key in sets),
             "cards": "" if beside else "\n".join(
                 f'<template id="card-{index}">{card(paint, size, studio)}</template>' for index, paint in enumerate(paints)),
             "data": in_script(rows_beside(paints) if beside else rows_inside(paints, documents)),
             "beside": f'<script type="application/json" id="beside">{in_script(beside)}</script>' if beside else ""}
    return re.sub(r"{{([a-z]+)}}", lambda mark: parts[mark[1]], (HERE / "page.html").read_text())


def in_script(value):
    """JSON that contains no "<" and therefore cannot end its own element."""
    return json.dumps(value, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c")


def found_by(paint):
    """What a paint is searched and filtered by."""
    return {"name": paint.name, "code": paint.code, "class": paint.paint_class,
            **{index: paint.indices[index] for index in INDICES}}


def downloads(paint, texts):
    return [{"name": f"{file_stem(paint.name)}.{ending}", "type": kind, "text": document}
            for (ending, kind), document in zip(FILES, texts)]


def rows_inside(paints, documents):
    """What page.js needs of each paint whose tile is in the page."""
    return [{**found_by(paint), "files": downloads(paint, texts)} for paint, texts in zip(paints, documents)]


def rows_beside(paints):
    """What page.js makes the tile of each paint from."""
    return [{**found_by(paint), "kind": kind_of(paint), "strip": strip(paint), "border": gloss_border(paint)}
            for paint in paints]


def file_stem(name):
    return "".join(c if c.isalnum() or c in "-_+." else "_" for c in name).lstrip(".") or "paint"


def class_boxes(paints):
    boxes = []
    for key in library.CLASSES:
        count = sum(paint.paint_class == key for paint in paints)
        if count:
            boxes.append(f'<label><input type="checkbox" name="class" value="{key}" checked> {key.capitalize()} '
                         f'<span class="count">{count}</span></label>')
    return "".join(boxes)


def nice_step(span):
    """The smallest step of at least a hundredth of `span` that is 1, 2 or 5 times a power of ten."""
    step = 10 ** math.floor(math.log10(max(span, 1) / 100))
    return next(step * factor for factor in (1, 2, 5, 10) if step * factor * 100 >= span or factor == 10)


def range_slider(index, paints):
    name, meaning = INDICES[index]
    values = [paint.indices[index] for paint in paints if paint.indices[index] is not None] or [0]
    step = max(nice_step(max(values) - min(values)), 0.1)
    low, high = math.floor(min(values) / step), math.ceil(max(values) / step)
    high = max(high, low + 1)
    missing = len(paints) - len(values)
    hint = f"; {missing} without one show while it reads \u201call\u201d" if missing else ""

    def end(which, value):
        return (f'<input type="range" min="{low * step:g}" max="{high * step:g}" step="{step:g}" value="{value * step:g}" '
                f'aria-label="{name}, {which}">')

    return (f'<fieldset class="range" data-index="{index}"><legend>{name} <output></output></legend>'
            f"{histogram(values, low * step, high * step)}"
            f'<div class="pair">{end("at least", low)}{end("at most", high)}</div>'
            f'<p class="hint">{meaning}{hint}</p></fieldset>')


def histogram(values, low, high, bins=40):
    counts = [0] * bins
    for value in values:
        counts[min(int((value - low) / (high - low) * bins), bins - 1)] += 1
    bars = "".join(f'<rect x="{i}" y="{1 - count / max(counts):.3f}" width="0.85" height="{count / max(counts):.3f}"/>'
                   for i, count in enumerate(counts) if count)
    return f'<svg viewBox="0 0 {bins} 1" preserveAspectRatio="none" aria-hidden="true">{bars}</svg>'


def groups_of(key, filed):
    return [group for group in library.CHROMATIC + library.NEUTRAL if (key, group) in filed]


def group_links(sets, filed):
    items = []
    for key in sets:
        inner = "".join(
            f'<li><a href="#{key}-{group}">{swatch(group)}'
            f'{group_name(group)} <span class="count">{len(filed[key, group])}</span></a></li>'
            for group in groups_of(key, filed))
        count = sum(len(filed[key, group]) for group in groups_of(key, filed))
        items.append(f'<li><a href="#{key}">{library.SETS[key][0]} <span class="count">{count}</span></a><ul>{inner}</ul></li>')
    return f"<ul>{''.join(items)}</ul>"


def swatch(group):
    return f'<span class="swatch" style="background:{GROUP_SWATCH[group]}"></span>'


def group_name(group):
    return group.capitalize() + (" neutrals" if group in library.NEUTRAL else "s")


def set_section(key, filed, paints, pictures, size):
    groups = []
    for group in groups_of(key, filed):
        members = filed[key, group]
        tiles = "\n".join(tile(index, paints[index], pictures[index], size) for index in members) if pictures else ""
        order = "" if pictures else f' data-paints="{json.dumps(members, separators=(",", ":"))}"'
        groups.append(f'<section class="group" aria-labelledby="{key}-{group}"><h3 id="{key}-{group}">'
                      f'{swatch(group)}{group_name(group)} <span class="count"></span></h3>'
                      f'<ul class="tiles"{order}>\n{tiles}\n</ul></section>\n')
    return (f'<section class="set" aria-labelledby="{key}"><h2 id="{key}">{library.SETS[key][0]} <span class="count"></span>'
            f"</h2>\n{''.join(groups)}</section>\n")


def kind_of(paint):
    flop = paint.indices["flop_index"]
    return paint.paint_class if flop is None else f"{paint.paint_class}, flop {number(flop)}"


def tile(index, paint, picture, size):
    return (f'<li data-paint="{index}"><button type="button" class="tile" aria-haspopup="dialog">'
            f'<img alt="" width="{size[0]}" height="{size[1]}" src="{picture_address(picture)}">'
            f'<span class="strip" style="background:{strip(paint)};border:{gloss_border(paint)}"></span>'
            f'<span class="label">{text(paint.name)}<small>{text(kind_of(paint))}</small></span></button></li>')


def picture_address(picture):
    """The address of a PNG that is in the page."""
    return f"data:image/png;base64,{base64.b64encode(picture).decode()}"


def studio_link(paint, studio):
    """A link that opens the paint in the page of paint-studio at the address `studio`; empty without one."""
    address = f"{studio}#paint={urllib.parse.quote(paint.name, safe='')}" if studio else ""
    return f'<a href="{text(address)}">Open in the studio</a>' if studio else ""


def lab_cells(lab):
    return "".join(f"<td>{number(value, 2)}</td>" for value in lab)


def card(paint, size, studio, beside=False):
    """The card of a paint. Its picture is missing here: page.js takes it from the tile, or from the sheet `beside` the page."""
    heading = ", ".join(filter(None, [paint.code and f"code {paint.code}", paint.paint_class, paint.condition]))
    rows = [(row.geometry, row.lab) for row in paint.rows]
    if paint.appearance:
        rows += [("face", paint.appearance["face"]), (f"flop, from {paint.appearance['travel']:.4g}\u00b0",
                                                        paint.appearance["flop"])]
    table = "".join(f'<tr><td><span class="swatch" style="background:{srgb(lab)}"></span>{text(name)}</td>{lab_cells(lab)}</tr>'
                    for name, lab in rows)
    facts = [(name, number(paint.indices[key])) for key, (name, _) in INDICES.items()]
    facts.append(("Hue travel, degrees", number(paint.indices["hue_travel_deg"])))
    facts += [(f"Gloss at {angle:g}\u00b0, units", number(value)) for angle, value in sorted(paint.gloss.items())]
    facts.append(("Travel of the curve, degrees", number(paint.indices["travel_deg"])))
    facts.append(("Curve off the readings, worst dE00", number(paint.indices["residual_de00"], 2)))
    if paint.fit:
        facts.append(("Picture off the readings, mean dE00", number(paint.fit["mean"], 2)))
    figures = "".join(f'<tr><th scope="row">{text(name)}</th><td>{value}</td></tr>' for name, value in facts)
    link = studio_link(paint, studio)
    notes = "".join(f'<p class="hint">Note: {text(flag)}.</p>' for flag in paint.flags)
    label = f"{text(paint.name)} on the mesh"
    picture = (f'<span class="picture" role="img" aria-label="{label}"></span>' if beside else
               f'<img alt="{label}" width="{size[0]}" height="{size[1]}">')
    return (f'<div class="sheet"><h2 id="card-name">{text(paint.name)}<small>{text(heading)}</small></h2>'
            f'<div>{picture}'
            f'<span class="strip" style="background:{strip(paint)};border:{gloss_border(paint)}"></span>'
            '<div class="ends"><span>15\u00b0</span><span>aspecular angle</span><span>110\u00b0</span></div>'
            f'<div class="downloads" role="group" aria-label="Downloads"><span>Download</span></div>{link}</div>'
            f'<div>{plot(paint)}</div>'
            '<table><caption>Color</caption><thead><tr><th>geometry</th><th>L*</th><th>a*</th><th>b*</th></tr></thead>'
            f'<tbody>{table}</tbody></table>'
            f'<div><table><caption>Figures</caption><tbody>{figures}</tbody></table>{notes}</div></div>')
