"""How numbers are written."""


def shortest(value):
    """The shortest decimal that reads back as `value`, without a trailing `.0`."""
    text = repr(value)
    return text[:-2] if text.endswith(".0") else text
