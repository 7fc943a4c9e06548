"""The figures of every paint, from paint-stats."""

import json

# What a paint's flags mean to the reader of its card.
FLAGS = {"dark": "so dark that the flop index says nothing",
         "achromatic": "the face has no hue",
         "through_gray": "the color passes gray, so the sense of the hue travel is open",
         "gamut": "some of its color lies outside the working space of the picture"}


def put_into(paints, tools, path, gloss):
    """Sets `indices` and `flags` of the paints that were read from `path`, in its order; `gloss` was assumed, if any."""
    glossless = f"no gloss reading, drawn with {gloss} units" if gloss else "no gloss reading, drawn matt"
    for paint, line in zip(paints, tools.run("paint-stats", path, "--format", "json").decode().splitlines(), strict=True):
        paint.indices = json.loads(line)
        paint.flags = [FLAGS[flag] for flag in paint.indices["flags"] if flag in FLAGS]
        if not paint.gloss:
            paint.flags.append(glossless)
