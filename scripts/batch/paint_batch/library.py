"""Cuts paint XML into paints and puts it together again, as text, so that every element stays as it is."""

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n<paints xmlns="urn:goniochrome:paint:1" version="1">\n'
TAIL = "</paints>\n"
START, END = b"<paint ", b"</paint>"
BLOCK = 1 << 20


def places(path):
    """(start, length) in bytes of every paint in a file that a tool wrote; this takes constant memory."""
    with open(path, "rb") as file:
        held, base = b"", 0
        while block := file.read(BLOCK):
            held += block
            at = 0
            while (start := held.find(START, at)) >= 0 and (end := held.find(END, start)) >= 0:
                at = end + len(END)
                yield base + start, at - start
            keep = start if start >= 0 else max(at, len(held) - len(START))
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
    parts = text.split("<paint ")[1:]
    return ["<paint " + part[:part.index("</paint>")] + "</paint>" for part in parts]


def document(paints):
    return HEAD + "".join(f"  {paint}\n" for paint in paints) + TAIL
