"""Cuts paint XML into paints and puts it together again, as text, so that every element stays as it is."""

import re

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n<paints xmlns="urn:goniochrome:paint:1" version="1">\n'
TAIL = "</paints>\n"
BLOCK = 1 << 20
# A tag of any element, as tools write it: no ">" stands in an attribute. Comments and the like come first, since tags may stand in them.
TAG = re.compile(rb"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<[?!][^>]*>|<(/?)([^\s/>!?][^\s/>]*)([^>]*?)(/?)>", re.DOTALL)
FOREIGN = re.compile(rb"""\sxmlns=["'](?!urn:goniochrome:paint:1["'])""")


class Tags:
    """Tells where paints begin and end. Elements of that name may also stand in a paint or beside it, in another vocabulary.

    `level` is the number of elements that a paint stands in: 1 in a document, 0 in a text of paints alone.
    """

    def __init__(self, level):
        self.level, self.depth, self.start = level, 0, None

    def take(self, match, base=0):
        """The (start, end) of the paint that ends with this tag, or None."""
        closes, name, attributes, empty = match.groups()
        if name is None:
            return None
        if closes:
            self.depth -= 1
        else:
            if self.depth == self.level and name == b"paint" and not FOREIGN.search(attributes):
                self.start = base + match.start()
            self.depth += 0 if empty else 1
        if self.depth > self.level or self.start is None:
            return None
        start, self.start = self.start, None
        return start, base + match.end()


def places(path):
    """(start, length) in bytes of every paint in a file that a tool wrote; this takes constant memory."""
    with open(path, "rb") as file:
        held, base, tags = b"", 0, Tags(1)
        while block := file.read(BLOCK):
            held += block
            at = 0
            for match in TAG.finditer(held):
                at = match.end()
                if found := tags.take(match, base):
                    yield found[0], found[1] - found[0]
            # A tag that the block cuts is looked at again with the next one.
            keep = held.find(b"<", at) if held.find(b"<", at) >= 0 else len(held)
            base, held = base + keep, held[keep:]


def paints_at(path, first, last):
    """The texts of the paints from the place `first` to the place `last`; a place is (start, length)."""
    with open(path, "rb") as file:
        file.seek(first[0])
        text = file.read(last[0] + last[1] - first[0]).decode()
    return cut(text, 0)


def spread(path, places, count):
    """The texts of at most `count` paints, spread evenly over a library."""
    count = min(count, len(places))
    chosen = [places[i * len(places) // count] for i in range(count)]
    return [paints_at(path, place, place)[0] for place in chosen]


def cut(text, level=1):
    """The elements of the paints in a text, which is a document, or at level 0 paints alone."""
    data, tags = text.encode(), Tags(level)
    found = (tags.take(match) for match in TAG.finditer(data))
    return [data[start:end].decode() for start, end in filter(None, found)]


def document(paints):
    return HEAD + "".join(f"  {paint}\n" for paint in paints) + TAIL
