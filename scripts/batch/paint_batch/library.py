"""Paint XML cut into paints and put together again, as text: every element stays as it came."""

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n<paints xmlns="urn:goniochrome:paint:1" version="1">\n'
TAIL = "</paints>\n"
START, END = b"<paint ", b"</paint>"
BLOCK = 1 << 20


def places(path):
    """Start and length in bytes of every paint of a file that a tool wrote, in constant memory."""
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
    """The text of the paints whose places are first..last (each start, length)."""
    with open(path, "rb") as file:
        file.seek(first[0])
        text = file.read(last[0] + last[1] - first[0]).decode()
    return cut(text)


def spread(path, places, count):
    """The text of at most `count` paints, evenly over a library."""
    count = min(count, len(places))
    chosen = [places[i * len(places) // count] for i in range(count)]
    return [paints_at(path, place, place)[0] for place in chosen]


def cut(text):
    """The paints of a text, each an element of its own."""
    parts = text.split("<paint ")[1:]
    return ["<paint " + part[:part.index("</paint>")] + "</paint>" for part in parts]


def document(paints):
    return HEAD + "".join(f"  {paint}\n" for paint in paints) + TAIL
