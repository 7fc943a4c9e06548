"""The indices of every paint, which paint-stats computes."""

import json

# The flags of a paint, and what the card of the paint says about each.
FLAGS = {"dark": "so dark that the flop index says nothing",
         "achromatic": "the face has no hue",
         "through_gray": "the color passes through gray, so the direction of the hue travel is not defined",
         "gamut": "some of its color lies outside the working space of the picture"}


def put_into(paints, tools, path, gloss):
    """Sets `indices` and `flags` of the paints, which were read from `path`.

    `gloss` is what was assumed for paints without a gloss reading, or None.
    """
    glossless = f"no gloss reading, drawn with {gloss} units" if gloss else "no gloss reading, drawn matt"
    for paint, line in zip(paints, tools.run("paint-stats", path, "--format", "json").decode().splitlines(), strict=True):
        paint.indices = json.loads(line)
        paint.flags = [FLAGS[flag] for flag in paint.indices["flags"] if flag in FLAGS]
        if not paint.gloss:
            paint.flags.append(glossless)
