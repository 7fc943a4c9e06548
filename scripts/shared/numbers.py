"""How scripts write numbers into files."""


def shortest(value):
    """The shortest decimal that is read back as `value`, without `.0` at its end."""
    text = repr(value)
    return text[:-2] if text.endswith(".0") else text
