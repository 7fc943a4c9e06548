"""Cuts paint XML into paints and puts it together again, as text, so that every element stays as it is."""

import re

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n<paints xmlns="urn:goniochrome:paint:1" version="1">\n'
TAIL = "</paints>\n"
BLOCK = 1 << 20
# A tag of an element named paint, as tools write it: no ">" stands in an attribute.
TAG = re.compile(rb"<(/?)paint(?=[\s/>])([^>]*?)(/?)>")
FOREIGN = re.compile(rb"""\sxmlns=["'](?!urn:goniochrome:paint:1["'])""")


class Tags:
    """Tells where paints begin and end. An element of that name may also stand in one, in another vocabulary."""

    def __init__(self):
        self.depth, self.start = 0, None

    def take(self, match, base=0):
        """The (start, end) of the paint that ends with this tag, or None."""
        closes, attributes, empty = match.groups()
        if closes:
            self.depth -= 1
        else:
            if self.depth == 0:
                self.start = None if FOREIGN.search(attributes) else base + match.start()
            self.depth += 0 if empty else 1
        if self.depth > 0 or self.start is None:
            return None
        start, self.start = self.start, None
        return start, base + match.end()


def places(path):
    """(start, length) in bytes of every paint in a file that a tool wrote; this takes constant memory."""
    with open(path, "rb") as file:
        held, base, tags = b"", 0, Tags()
        while block := file.read(BLOCK):
            held += block
            at = 0
            for match in TAG.finditer(held):
                at = match.end()
                if found := tags.take(match, base):
                    yield found[0], found[1] - found[0]
            # A tag that the block cuts is looked at again with the next one.
            keep = max(at, held.rfind(b"<", at)) if held.rfind(b"<", at) >= 0 else len(held)
            base, held = base + keep, held[keep:]


def paints_at(path, first, last):
    """The texts of the paints from the place `first` to the place `last`; a place is (start, length)."""
    with open(path, "rb") as file:
        file.seek(first[0])
        text = file.read(last[0] + last[1] - first[0]).decode()
    return cut(text)


def spread(path, places, count):
    """The texts of at most `count` paints, spread evenly over a library."""
    count = min(count, len(places))
    chosen = [places[i * len(places) // count] for i in range(count)]
    return [paints_at(path, place, place)[0] for place in chosen]


def cut(text):
    """The elements of the paints in a text."""
    data, tags = text.encode(), Tags()
    found = (tags.take(match) for match in TAG.finditer(data))
    return [data[start:end].decode() for start, end in filter(None, found)]


def document(paints):
    return HEAD + "".join(f"  {paint}\n" for paint in paints) + TAIL
