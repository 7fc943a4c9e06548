"""A book of so many paints that it is several pages: which paint is on which page, and the index of all of them.

The pages are books of their own, with a folder beside each. The paints are sorted by class and hue before they are cut into pages,
so that each page has neighbors in color. The index finds a paint by name or code and shows what is on which page.
"""

import json
import pathlib
import re

from paint_book import library
from paint_book.colors import srgb
from paint_book.page import GROUP_SWATCH, address_beside, group_name, in_script, text
from shared import paint_text

HERE = pathlib.Path(__file__).parent
ANGLES = (15, 45, 110)  # of the colors of a paint in the index


def entries(fitted):
    """What the index has of each paint of a file of paint XML, in the order of the book. This reads one paint after the other."""
    found = []
    for place in paint_text.places(fitted):
        document = paint_text.document(paint_text.paints_at(fitted, place, place))
        paint = library.read_text(document)[0]
        in_set, group = paint.place()
        groups = library.CHROMATIC + library.NEUTRAL
        key = (list(library.SETS).index(in_set), groups.index(group), *paint.order())
        found.append({"key": key, "place": place, "set": in_set, "group": group, "name": paint.name, "code": paint.code,
                      "class": paint.paint_class, "colors": [srgb(paint.lab_at(angle)) for angle in ANGLES]})
    found.sort(key=lambda entry: entry["key"])
    return found


def with_colors(fitted, path):
    """The file of the paints of a file of paint XML that have a color to show, and messages that name the others. It is written to
    `path` if there are others. This reads one paint after the other."""
    kept, left_out = [], []
    for place in paint_text.places(fitted):
        paint = paint_text.paints_at(fitted, place, place)[0]
        try:
            if "<lab" not in paint and "<appearance" not in paint:  # else it has a color, and need not be parsed here
                library.read_text(paint_text.document([paint]))
            kept.append({"place": place})
        except ValueError as error:
            left_out.append(str(error))
    if not left_out:
        return fitted, left_out
    write_paints(fitted, kept, path)
    return path, left_out


def cut(found, most):
    """The entries as lists for pages of about equal length, of at most `most` paints each."""
    count = -(-len(found) // most)
    return [found[i * len(found) // count : (i + 1) * len(found) // count] for i in range(count)]


def write_paints(fitted, members, path):
    """Writes the paints of a page as paint XML, in the order of the page."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(paint_text.HEAD)
        for entry in members:
            file.write(f"  {paint_text.paints_at(fitted, entry['place'], entry['place'])[0]}\n")
        file.write(paint_text.TAIL)


def page_path(index, number):
    """The path of a page, counted from 1, of the book with that index."""
    return index.with_name(f"{index.stem}-{number:03}{index.suffix}")


def heading(members):
    """What a page is called in the index: its sets and groups, from the first to the last."""
    first, last = members[0], members[-1]
    names = [f"{library.SETS[one['set']][0]}, {group_name(one['group']).lower()}" for one in (first, last)]
    return names[0] if names[0] == names[1] else f"{names[0]}, to {names[1]}"


def links(index, number, count):
    """The links of a page to its neighbors and to the index, as HTML."""
    def link(to, label):
        return f'<a href="{text(address_beside(to, index))}">{label}</a>'

    before = link(page_path(index, number - 1), "&#8592; page before") if number > 1 else ""
    after = link(page_path(index, number + 1), "next page &#8594;") if number < count else ""
    return (f'<nav class="pages" aria-label="Pages">{before} {link(index, f"Index, page {number} of {count}")} {after}</nav>')


def index_page(title, summary, pages, index):
    """The HTML of the index of these lists of entries."""
    rows, items = [], []
    for number, members in enumerate(pages, 1):
        shown = members[:: max(1, len(members) // 60)]
        colors = ",".join(entry["colors"][1] for entry in shown)
        counts = {}
        for entry in members:
            counts[entry["group"]] = counts.get(entry["group"], 0) + 1
        groups = "".join(f'<span><span class="swatch" style="background:{GROUP_SWATCH[group]}"></span>{count}</span> '
                         for group, count in counts.items())
        address = text(address_beside(page_path(index, number), index))
        items.append(f'<li><a href="{address}"><b>Page {number}</b> {text(heading(members))}'
                     f'<span class="strip" style="background:linear-gradient(90deg,{colors})"></span>'
                     f'<small>{len(members)} paints: {groups}</small></a></li>')
        rows.append({"page": address_beside(page_path(index, number), index),
                     "paints": [[entry["name"], entry["code"], entry["class"], "".join(entry["colors"])] for entry in members]})
    parts = {"title": text(title), "summary": text(summary), "style": (HERE / "page.css").read_text().replace("{{aspect}}", "1"),
             "pages": "\n".join(items), "data": in_script(rows), "script": (HERE / "index.js").read_text()}
    return re.sub(r"{{([a-z]+)}}", lambda mark: parts[mark[1]], (HERE / "index.html").read_text())
