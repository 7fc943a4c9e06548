"""Tables of spectra in CSV."""

import math


def rows(path):
    """(number of the line, its cells) of each line that is not blank; a mark of the encoding is no part of the first."""
    with open(path, encoding="utf-8-sig") as file:
        return [(number, [word.strip() for word in line.split(",")]) for number, line in enumerate(file, 1) if line.strip()]


def is_number(word):
    try:
        return math.isfinite(float(word))
    except ValueError:
        return False


def color_matching(path):
    """(text of the wavelength, [x, y, z]) of each row; a first row of names is to name x, y and z in this order."""
    table = rows(path)
    if table and not is_number(table[0][1][0]):
        number, names = table.pop(0)
        if [[letter for letter in "xyz" if letter in name.lower()] for name in names[1:]] != [["x"], ["y"], ["z"]]:
            raise ValueError(f"{path}:{number}: the columns are {', '.join(names)}: give wavelength, x, y and z bar")
    found = []
    for number, words in table:
        if len(words) != 4 or not all(map(is_number, words)):
            raise ValueError(f"{path}:{number}: give a wavelength and three numbers")
        found.append((words[0], [float(word) for word in words[1:]]))
    return found
