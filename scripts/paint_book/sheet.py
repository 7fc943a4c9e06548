"""Pages of few paints, each with a command to go on from it: sheets of variations around their paint, and palettes of flat chips."""

import math
import pathlib
import re
import shlex
import statistics
import urllib.parse

from paint_book.colors import gloss_border, srgb, strip
from paint_book.page import file_stem, lab_cells, number, picture_address, studio_link, text

HERE = pathlib.Path(__file__).parent
MIDDLE = 4  # of nine tiles
CHIP_BORDER = 12  # pixels
ANGLES = (15, 45, 110)
GLOSS_LEGEND = ("The colors run from 15 to 110 degrees from specular. The border around them shows the gloss at 60 degrees, black for 0 "
                "and white for 100 units, and is dashed where the paint does not state it.")
NUMBER = r"[+-]\d+(\.\d+)?(e[+-]?\d+)?"
KINDS = {"face": r"face-[a-z]+", "flop": r"flop-[a-z]+", "travel": "travel" + NUMBER, "gloss": "gloss" + NUMBER}
OPPOSITES = [("lighter", "darker"), ("red", "cyan"), ("yellow", "blue"), ("green", "magenta")]


def variation_of(name, of):
    """What paint-edit --variations varied to make the paint `name` of the paint `of`, such as travel of red.travel+4; None where it
    did not make it."""
    if not of or not name.startswith(f"{of}."):
        return None
    change = name[len(of) + 1:]
    return next((kind for kind, form in KINDS.items() if re.fullmatch(form, change)), None)


def families(paints):
    """Each paint that its variations follow, with them, as lists of at most nine numbers of paints: the paint first. A variation has
    the name of its paint, a point and what was varied, as paint-edit(1) writes it, and those of a family vary the same."""
    found, leader, kind = [], "", None
    for index, paint in enumerate(paints):
        if kind is not None and variation_of(paint.name, leader) == kind and len(found[-1]) < 2 * MIDDLE + 1:
            found[-1].append(index)
            continue
        leader = paint.name
        kind = variation_of(paints[index + 1].name, leader) if index + 1 < len(paints) else None
        if kind is not None:
            found.append([index])
    return found


def in_tiles(members):
    """A family in the order of its tiles, with the paint in the middle, as render-osmesa(1) has it on its sheets."""
    paint, *around = members
    return around[:MIDDLE] + [paint] + around[MIDDLE:]


def change_of(paint, of):
    """What was varied, such as face-lighter."""
    return paint.name[len(of.name) + 1:]


def worded(change):
    """The words of a change: face lighter, travel -8."""
    return re.sub(r"-(?=[a-z])|(?<=[a-z])(?=[+-][0-9])", " ", change)


def step_of(kind, paint, around):
    """The step of these variations, or None where they do not tell it."""
    made = {change_of(one, paint)[len(kind):].lstrip("-" if kind in ("face", "flop") else ""): one for one in around}
    if kind in ("travel", "gloss"):
        steps = [abs(float(change)) for change in made]
    else:
        pairs = [(made[one], made[other]) for one, other in OPPOSITES if one in made and other in made]
        # A color at the end of its scale was moved by less.
        steps = [statistics.median(math.dist(one.appearance[kind], other.appearance[kind]) / 2 for one, other in pairs)] if all(
            one.appearance and other.appearance for one, other in pairs) and pairs else []
    return f"{min(steps):.4g}" if steps else None


class Commands:
    """The commands that go on from a paint. `library` has the paints; without it, they take the file that the page lets one keep.
    `words` are those options of paint-book that such a page is made with."""

    def __init__(self, library, words):
        self.library, self.words = library, words

    def vary(self, paint, kind, step=None):
        """Makes a sheet of variations around the paint."""
        source = f"{self.library}#{paint.name}" if self.library else file_name(paint)
        edit = ["paint-edit", source, "--variations", kind] + (["--step", step] if step else [])
        book = ["paint-book", "--variations", "-", *self.words, "-o", f"{file_stem(paint.name)}.html"]
        return f"{shlex.join(edit)} | {shlex.join(book)}"


def file_name(paint):
    return f"{file_stem(paint.name)}.paints.xml"


def color_rows(paint):
    return "".join(f'<tr><th scope="row"><span class="swatch" style="background:{srgb(paint.lab_at(angle))}"></span>{angle}\u00b0</th>'
                   f"{lab_cells(paint.lab_at(angle))}</tr>" for angle in ANGLES)


def design(paint):
    """The design as a table: colors, travel and gloss."""
    gloss = "".join(f"; gloss {number(units)} at {angle:g}\u00b0" for angle, units in sorted(paint.gloss.items()))
    return ('<table><thead><tr><th></th><th>L*</th><th>a*</th><th>b*</th></tr></thead>'
            f"<tbody>{color_rows(paint)}</tbody></table>"
            f'<p class="hint">Travel {number(paint.indices["travel_deg"])}\u00b0{gloss}</p>')


def line_of(paint, kind):
    """What variations of this kind change, in a line."""
    if kind == "travel":
        return f"travel {number(paint.indices['travel_deg'])}\u00b0"
    if kind == "gloss":
        return "; ".join(f"gloss {number(units)} at {angle:g}\u00b0" for angle, units in sorted(paint.gloss.items()))
    return "; ".join(f"{angle}\u00b0: {', '.join(number(value) for value in paint.lab_at(angle))}" for angle in (ANGLES[0], ANGLES[-1]))


def go_on(paint, command, studio):
    """What can be done with a paint: its file, the studio, and the command."""
    address = f"data:application/xml;charset=utf-8,{urllib.parse.quote(paint.document(), safe='')}"
    name = text(file_name(paint))
    return (f'<div class="downloads"><a href="{address}" download="{name}" title="{name}">Keep as a file</a>'
            f"{studio_link(paint, studio)}</div><p class=\"hint\">To make variations of it:</p><code>{text(command)}</code>")


def tile(paint, heading, picture, command, size, studio, is_middle=False):
    """A tile with the picture of a paint and the rest to be unfolded, or with a flat chip where there is no picture."""
    further = go_on(paint, command, studio)
    more = (f"<details><summary>Design and command</summary>{design(paint)}{further}</details>" if picture else
            f"{design(paint)}<details><summary>File and command</summary>{further}</details>")
    shown = (f'<img alt="{text(paint.name)} on the mesh" width="{size[0]}" height="{size[1]}" src="{picture_address(picture)}">'
             f'<span class="strip" style="background:{strip(paint)};border:{gloss_border(paint)}"></span>' if picture else
             f'<span class="chip" style="background:{strip(paint)};border:{gloss_border(paint, CHIP_BORDER)}"></span>')
    return (f'<li{" class=middle" if is_middle else ""}>{shown}<div class="text"><h3>{heading}</h3>'
            f"{more}</div></li>")


def variations_page(title, summary, paints, sheets, pictures, size, commands, studio=None):
    """The HTML with a section of tiles for each of `sheets`, which are families() of the paints. `pictures[i]` is the PNG of
    paint i, as bytes; `size` is that of a picture in pixels."""
    sections = []
    for members in sheets:
        middle, around = paints[members[0]], [paints[index] for index in members[1:]]
        kind = variation_of(around[0].name, middle.name)
        step = step_of(kind, middle, around)
        tiles = []
        for index in in_tiles(members):
            paint, is_middle = paints[index], index == members[0]
            change = "as it was" if is_middle else worded(change_of(paint, middle))
            heading = f"{text(change).capitalize()}<small>{text(paint.name)}</small><small>{text(line_of(paint, kind))}</small>"
            tiles.append(tile(paint, heading, pictures[index], commands.vary(paint, kind, step), size, studio, is_middle))
        sections.append(f'<section class="variations"><h2>{text(middle.name)}</h2><ul>\n' + "\n".join(tiles) + "\n</ul></section>")
    legend = f"The paint in the middle is as it was. {GLOSS_LEGEND}"
    return filled(title, summary, legend, sections, size)


def palette_page(title, summary, paints, commands, studio=None):
    """The HTML with a flat chip of each paint, in their order."""
    tiles = []
    for paint in paints:
        notes = ", ".join(filter(None, [paint.code and f"code {paint.code}", paint.paint_class]))
        heading = f"{text(paint.name)}<small>{text(notes)}</small>"
        tiles.append(tile(paint, heading, None, commands.vary(paint, "face"), None, studio))
    sections = ['<section class="palette"><ul>\n' + "\n".join(tiles) + "\n</ul></section>"]
    return filled(title, summary, f"Each chip is a paint. {GLOSS_LEGEND}", sections, (3, 2))


def filled(title, summary, legend, sections, size):
    style = "".join((HERE / name).read_text() for name in ("page.css", "sheet.css")).replace("{{aspect}}", f"{size[0]}/{size[1]}")
    parts = {"title": text(title), "summary": text(summary), "style": style, "legend": text(legend), "sections": "\n".join(sections)}
    return re.sub(r"{{([a-z]+)}}", lambda mark: parts[mark[1]], (HERE / "sheet.html").read_text())
