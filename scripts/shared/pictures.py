"""Pictures as numpy arrays: read in any format of OpenImageIO, written as EXR; and the directions of a lat-long picture.

It needs the Debian packages python3-numpy and python3-openimageio.
"""

import math
import pathlib
import tempfile

import numpy
import OpenImageIO

OpenImageIO.attribute("debug", 0)

REC709 = (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329)  # x and y of red, green, blue and white


def direction(column, row, width, height):
    """The unit vector (+Y up) that a point of a lat-long picture is seen in.

    The center of the picture looks along +Z, and its left quarter along +X.
    """
    latitude = math.pi * (0.5 - row / height)
    longitude = 2 * math.pi * (0.5 - column / width)
    ring = math.cos(latitude)
    return (ring * math.sin(longitude), math.sin(latitude), ring * math.cos(longitude))


def channels(path):
    """{name of a channel: its values as a float32 array of rows from the top}.

    Integers are scaled to 0..1, and colors are not multiplied by alpha. ValueError if the file cannot be read.
    """
    settings = OpenImageIO.ImageSpec()
    settings.attribute("oiio:UnassociatedAlpha", 1)
    file = OpenImageIO.ImageInput.open(str(path), settings)
    if file is None:
        raise ValueError(f"{path}: {OpenImageIO.geterror().strip()}")
    spec, pixels = file.spec(), file.read_image("float")
    if pixels is None:
        raise ValueError(f"{path}: {file.geterror().strip()}")
    pixels = pixels.reshape(spec.height, spec.width, spec.nchannels)
    return {name: pixels[:, :, i] for i, name in enumerate(spec.channelnames)}


def exr_file(rows, stored_as, comments, names=("R", "G", "B")):
    """The bytes of an EXR with ZIP compression.

    `rows`, from the top, are lists of texels with one value for each of the names; `stored_as` is numpy.float16 or numpy.float32.
    """
    pixels = numpy.array(rows, stored_as)
    spec = OpenImageIO.ImageSpec(pixels.shape[1], pixels.shape[0], len(names), "half" if stored_as is numpy.float16 else "float")
    spec.channelnames = tuple(names)
    spec.attribute("compression", "zip:9")
    spec.attribute("chromaticities", OpenImageIO.TypeDesc("float[8]"), REC709)
    spec.attribute("comments", comments)
    spec.attribute("software", "make-testdata")
    # OpenImageIO would add the time of writing, and the same pixels would never give the same file again. It leaves a date out
    # that is not text.
    spec.attribute("DateTime", 0)
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "picture.exr"
        file = OpenImageIO.ImageOutput.create("exr")
        if not (file.open(str(path), spec) and file.write_image(pixels) and file.close()):
            raise OSError(f"{path}: {file.geterror()}")
        return path.read_bytes()
