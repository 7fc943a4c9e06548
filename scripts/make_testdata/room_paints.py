"""rooms.paints.xml: what the walls and the furniture of cornell.obj and lounge.obj are painted with, as weights of lobes."""

import math

from shared.numbers import shortest

# name: reflectance of the diffuse part in linear Rec.2020; then lobes as (exponent, the share of light in it), and the mirror's weight
PAINTS = {
    "white": ((0.75, 0.75, 0.75), (), 0),
    "gray": ((0.5, 0.5, 0.5), (), 0),
    "black": ((0.0, 0.0, 0.0), (), 0),
    "red": ((0.62, 0.07, 0.05), (), 0),
    "green": ((0.1, 0.42, 0.09), (), 0),
    "ceiling_blue": ((0.12, 0.3, 0.85), (), 0),
    "wall_red": ((0.7, 0.18, 0.13), (), 0),
    "wall_pink": ((0.72, 0.36, 0.4), (), 0),
    "carpet_purple": ((0.32, 0.1, 0.36), (), 0),
    "floor_wood": ((0.36, 0.2, 0.1), ((40, 0.02),), 0.3),
    "sofa_orange": ((0.74, 0.3, 0.06), (), 0),
    "cushion_red": ((0.68, 0.06, 0.06), (), 0),
    "lacquer_black": ((0.02, 0.02, 0.02), (), 1),
    "vase_white": ((0.55, 0.55, 0.52), (), 0.5),
    "ball_metal": ((0.02, 0.02, 0.02), ((60, 0.4), (600, 0.3)), 1),
    "painting_red": ((0.75, 0.08, 0.1), (), 0),
    "painting_yellow": ((0.8, 0.62, 0.08), (), 0),
    "frame_gold": ((0.2, 0.13, 0.04), ((25, 0.4),), 0),
    "steel": ((0.1, 0.1, 0.1), ((30, 0.3), (200, 0.2)), 0),
}


def triple(names, values):
    """Three attributes."""
    return " ".join(f'{name}="{shortest(round(value, 6))}"' for name, value in zip(names, values))


def paint(name):
    """The lines of one paint."""
    diffuse, lobes, mirror = PAINTS[name]
    yield f'  <paint name="{name}">'
    yield '    <lobes space="lin_rec2020_scene" basis="stated" method="stated" max_de00="0" mean_de00="0">'
    yield "      <diffuse " + triple("rgb", [r / math.pi for r in diffuse]) + "/>"
    tint = (1.0, 0.78, 0.42) if name == "frame_gold" else (1.0, 1.0, 1.0)
    for exponent, share in lobes:
        peak = share * (exponent + 1) / (2 * math.pi)
        yield f'      <lobe exponent="{exponent}" ' + triple(("ddr", "ddg", "ddb"), [peak * t for t in tint]) + ' gr="0" gg="0" gb="0"/>'
    if mirror:
        yield '      <lobe exponent="mirror" ddr="0" ddg="0" ddb="0" ' + triple(("gr", "gg", "gb"), [mirror] * 3) + "/>"
    yield "    </lobes>"
    yield "  </paint>"


def room_paints_xml():
    """The bytes of rooms.paints.xml."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', '<paints xmlns="urn:goniochrome:paint:1" version="1">']
    for name in PAINTS:
        lines += paint(name)
    return ("\n".join(lines + ["</paints>"]) + "\n").encode()
