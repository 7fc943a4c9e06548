"""A book whose pictures and cards lie in a folder beside its page, for libraries of thousands of paints.

The pictures are tiles of contact sheets, so that a page of ten thousand paints shows some hundred files instead of ten thousand.
The cards and the texts for download lie in scripts that are loaded when a card of theirs is opened: a page that is opened as a
file may load scripts, and no other files.
"""

import json
import re
import struct

COLUMNS, ROWS = 6, 6  # of a sheet
CARDS = 36  # in a script


def folder_of(page):
    """The folder of a book's files."""
    return page.with_name(f"{page.stem}.files")


def sheet_name(number):
    return f"tiles-{number:04}.png"


def cards_name(number):
    return f"cards-{number:04}.js"


def tiles(folder, size):
    """Where the pictures are on their sheets, as page.js needs it."""
    with open(folder / sheet_name(1), "rb") as sheet:
        width, height = struct.unpack(">II", sheet.read(24)[16:])
    gap = (width - COLUMNS * size[0]) // (COLUMNS + 1)
    return {"columns": COLUMNS, "rows": ROWS, "width": width, "height": height, "left": gap, "top": gap,
            "right": size[0] + gap, "down": (height - gap) // ROWS, "tile": list(size)}


def write_cards(folder, cards, texts):
    """Writes the cards, as HTML, and the texts of all paints, for each a list of name, type and text."""
    for first in range(0, len(cards), CARDS):
        number = first // CARDS + 1
        rows = [{"card": card, "files": files}
                for card, files in zip(cards[first:first + CARDS], texts[first:first + CARDS])]
        content = f"cardsArrived({number}, {json.dumps(rows, ensure_ascii=False, allow_nan=False)});\n"
        (folder / cards_name(number)).write_bytes(content.encode(errors="replace"))


def csv_texts(table, paints):
    """The table of each paint out of that of all paints; None where they cannot be told apart."""
    head, *lines = table.splitlines(keepends=True)
    texts, before = [], None
    for line in lines:
        if line.startswith('"'):
            return None  # a name that is quoted may hold commas and ends of lines
        name = line.split(",", 1)[0]
        if name != before:
            texts.append(head)
            before = name
        texts[-1] += line
    names = [paint.name for paint in paints]
    told_apart = len(texts) == len(paints) and all(a != b for a, b in zip(names, names[1:]))
    return texts if told_apart else None


OBJECT = re.compile(r"[ ]*<cc:Object .*?</cc:Object>\n", re.DOTALL)
CONDITION = re.compile(r'[ ]*<cc:ColorSpecification Id="([^"]*)">.*?</cc:ColorSpecification>\n', re.DOTALL)


def cxf_texts(document, paints):
    """The CxF of each paint out of that of all paints, with the conditions that it names; None if they are not as many."""
    objects = OBJECT.findall(document)
    if len(objects) != len(paints):
        return None
    first = document.index(objects[0])
    last = document.rindex(objects[-1]) + len(objects[-1])
    head, tail = document[:first], document[last:]
    conditions = {match[1]: match[0] for match in CONDITION.finditer(tail)}
    begin, end = CONDITION.sub("\0", tail, 1).split("\0")[0], CONDITION.sub("", tail)
    end = end[len(begin):]
    texts = []
    for one in objects:
        named = set(re.findall(r'ColorSpecification="([^"]*)"', one))
        alone = re.sub(r' Id="o[0-9]+">', ' Id="o1">', one, count=1)
        texts.append(head + alone + begin + "".join(conditions[name] for name in conditions if name in named) + end)
    return texts
