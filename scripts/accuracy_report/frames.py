"""Frame rates: lights, lobes and engines, of paints and of textures whose every texel has lobes; and the cost of the operator."""

from shared.tools import Failed

from .study import Study

LIGHTS = ("40,50,0.2,0.6,1@0", "-60,20,0.5,0.5,0.6@0", "10,70,0.8,0.7,0.5@0")
BODY = ("Hood", "Fender_L", "Fender_R", "Roof", "Door_L", "Door_R", "Quarter_L", "Quarter_R", "Deck", "Bumper_F", "Rear")
CAMERA = ("--samples", 1, "--camera", "3.6,1.75,4.6,0,0.5,0.1,25")
PAINT, TEXTURE, LOBES = "silver_fine", "nameplate.sbrdf.exr", 3


def engines(run, words):
    """The engines that draw here: gpu only where there is one."""
    found = ["cpu", "gl"]
    try:
        run.tool("render-osmesa", *words, "--engine", "gpu")
        found.append("gpu")
    except Failed:
        run.say("frames: there is no gpu")
    return found


def frame_ms(run, *words, options=((),)):
    """The least of several frames for each of these options, which take turns, in ms of the clock."""
    frames = [[run.tool("render-osmesa", *words, *more)[0]["frame_ms"] for more in options]
              for _ in range(1 if run.quick else 5)]
    return [min(each) for each in zip(*frames)]


def surfaces(run):
    """(surface, lobes, options) of every surface."""
    for lobes in (1, LOBES):
        fitted = run.work / f"frames-{lobes}.xml"
        run.tool("fit-paint", "--basis", run.data / "b7.basis.xml", "--lobes", lobes, run.paints, "-o", fitted)
        paint = ("--paint", f"{fitted}#{run.named([PAINT])[0]}")
        textures = [word for part in BODY for word in ("--texture", f"{part}={run.data / TEXTURE}")]
        off = "".join(f",-texture-{lobe}" for lobe in range(lobes, LOBES))
        yield "paint", lobes, (*paint, "--effects", "all,-rays")
        yield "lobes in each texel", lobes, (*paint, *textures, "--effects", f"all,-rays{off}")


def study(run):
    scene = ("--mesh", run.data / "speed-shape.obj", *CAMERA, "-o", run.work / "frame.exr")
    rows, operators = [], []
    drawn = None
    for surface, lobes, words in surfaces(run):
        drawn = drawn or engines(run, (*scene, *words, "--light", LIGHTS[0], "--size", "64x64"))
        for count in (1, 3):
            lights = [word for light in LIGHTS[:count] for word in ("--light", light)]
            rates = [1e3 / frame_ms(run, *scene, *words, *lights, "--size", "800x600", "--engine", engine)[0]
                     for engine in drawn]
            rows.append((surface, count, lobes, *rates))
        if surface == "paint" and lobes == LOBES:
            for engine in drawn:
                plain, fitted = frame_ms(run, *scene, *words, *lights, "--size", "400x400", "--engine", engine,
                                         options=(("--operator", "plain"), ("--operator", "fitted")))
                operators.append((engine, 1e3 / plain, 1e3 / fitted, fitted / plain - 1))
    return Study("Frame rates", "Frames in a second of the clock with everything loaded: the body of the speed shape in 800 x 600 "
                 "pixels, one sample each, with lamps from 1 to 3 and lobes from 1 to 3, as in table 1 of [McAllister2002], where "
                 "surfaces with lobes in each texel were drawn at 50.7 frames a second with one lamp and one lobe, and at 7.57 "
                 "with three of each. Lobes in each texel are shaded on the processor, whatever the engine. The operator of "
                 "colored light is compared with the plain product in 400 x 400 pixels, where [GranierDamez2004] had 160 "
                 "instead of 170 frames a second, 6 % more time.",
                 [], [("Lamps, lobes and engines", ("surface", "lamps", "lobes", *(f"{engine} (1/s)" for engine in drawn)), rows),
                      ("The operator of colored light",
                       ("engine", "plain (1/s)", "fitted (1/s)", "more time, as a share"), operators)])
