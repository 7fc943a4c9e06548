"""Lab as the colors of a screen, for swatches, dots and strips. The pictures come from the renderer."""

D65 = (0.95047, 1.0, 1.08883)


def srgb(lab):
    """`#rrggbb` of a Lab triple. The white of Lab becomes the white of the screen, and channels outside its gamut are clipped."""
    fy = (lab[0] + 16) / 116
    x, y, z = (white * cube(f) for white, f in zip(D65, (fy + lab[1] / 500, fy, fy - lab[2] / 200)))
    linear = (3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
              -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
              0.0556434 * x - 0.2040259 * y + 1.0572252 * z)
    return "#" + "".join(f"{round(255 * encoded(channel)):02x}" for channel in linear)


def cube(f):
    return f ** 3 if f > 6 / 29 else (f - 4 / 29) * 3 * (6 / 29) ** 2


def encoded(linear):
    linear = min(max(linear, 0.0), 1.0)
    return 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055


def strip(paint, last_deg=110, steps=12):
    """A CSS background of the colors of the paint from 15 degrees (left) to `last_deg`. It ends at the border, where it would begin again."""
    angles = [15 + (last_deg - 15) * i / (steps - 1) for i in range(steps)]
    return f"linear-gradient(90deg,{','.join(srgb(paint.lab_at(angle)) for angle in angles)}) padding-box"


def gloss_border(paint, width=3):
    """A CSS border of `width` pixels whose gray is the gloss of the paint, from black for 0 to white for 100 gloss units; dashed if unknown."""
    gloss = paint.gloss.get(60.0, next(iter(paint.gloss.values()), None))
    if gloss is None:
        return f"{width}px dashed #808080"
    gray = round(2.55 * min(max(float(gloss), 0), 100))
    return f"{width}px solid #{gray:02x}{gray:02x}{gray:02x}"
