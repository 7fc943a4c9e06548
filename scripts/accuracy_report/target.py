"""The cheapest settings of all stages together that bring a picture within a wanted error, proven by the check."""

import dataclasses
import itertools
import pathlib

from .scene import STEEP, Scene, Settings, total_de00, total_s

SCENES = ("signal_red,studio", "candy_red,outdoor", "silver_fine,studio")
BASES, METHODS = ("b5", "b7", "steep"), ("l1", "l2", "deltae")
TOLERANCES, EFFECTS = (1e-1, 3e-2, 1e-2, 1e-3), ("2", "0.5")  # and all effects
MAXIMAL = Settings("b7", "deltae", True, 1e-4, "all")
WORTH_IT = 0.99  # fewer effects are looked at where they bring the time of all stages below this part
CHOOSING, PROVING = 100, 500  # random pixels, of two seeds


def scene_of(run, text):
    """PAINT or PAINT,PROBE; the probe is a file, or studio or outdoor of the test data."""
    paint, _, probe = text.partition(",")
    if not probe:
        return Scene(run, paint, checks=CHOOSING)
    data = run.data / f"{probe}.exr"
    return Scene(run, paint, data if data.is_file() else pathlib.Path(probe).resolve(), checks=CHOOSING)


def fits(scene, basis):
    """Every fit to a basis, cheapest first: (settings, dE00 of the fit)."""
    every = [Settings(basis, method, views, MAXIMAL.prefilter, "all") for method, views in itertools.product(METHODS, (False, True))]
    return [(s, scene.fit(s)[1]) for s in sorted(every, key=lambda s: scene.fit(s)[2])]


def with_all_effects(scene, basis):
    """(time of all stages, settings) for every tolerance of the prefilter, with the truest fit."""
    fit = min(fits(scene, basis), key=lambda f: f[1])[0]
    for tolerance in TOLERANCES:
        settings = dataclasses.replace(fit, prefilter=tolerance)
        yield total_s(scene.cost(settings)), settings


def with_fewer_effects(scene, settings):
    """(time, settings) of the tolerances of render-osmesa that are worth their error."""
    whole = total_s(scene.cost(settings))
    for effects in EFFECTS:
        fewer = dataclasses.replace(settings, effects=effects)
        seconds = total_s(scene.cost(fewer))
        if seconds < WORTH_IT * whole:
            yield seconds, fewer


def proven(scene, settings, target):
    """The first check, at a few pixels, with the cheapest fit that leaves room for what the picture misses; then another
    at many other pixels: (settings, what that found, pixels), or None."""
    missed = scene.error(settings)["render_de00"]
    enough = [s for s, de00 in fits(scene, settings.basis) if de00 + missed <= target]
    if not enough:
        return None
    chosen = dataclasses.replace(enough[0], prefilter=settings.prefilter, effects=settings.effects)
    proof = scene.error(chosen, "--seed", 2, checks=PROVING)
    return (chosen, proof) if total_de00(proof) <= target else None


def found(scene, target):
    """(settings, proof) of the cheapest settings within the target, or None. From the cheapest upward; first, though,
    whether the most exact of a basis are within the target at all. Fewer effects are looked at where all were enough."""
    table = []
    for basis in BASES:
        rows = sorted(with_all_effects(scene, basis), key=lambda row: row[0])
        if total_de00(scene.error(rows[-1][1])) <= target:
            table += rows
    for _, settings in sorted(table, key=lambda row: row[0]):
        answer = proven(scene, settings, target)
        if not answer:
            continue
        cheaper = (proven(scene, fewer, target) for _, fewer in sorted(with_fewer_effects(scene, settings), key=lambda row: row[0]))
        return next((a for a in cheaper if a), answer)
    return None


def told(scene, target):
    """Prints what was found for a scene; returns whether the target was reached."""
    name = f"{scene.paint}, {scene.probe.stem}"
    dearest = scene.picture(MAXIMAL)
    answer = found(scene, target)
    if not answer:
        print(f"{name}: dE00 {target:g} is not reached: {total_de00(dearest):.2f} (fit {dearest['fit_de00']:.2f}, picture {dearest['render_de00']:.2f}) with {MAXIMAL}", flush=True)
        return False
    settings, proof = answer
    seconds, most = total_s(scene.cost(settings)), total_s(dearest)
    print(f"{name}: dE00 {total_de00(proof):.2f} (fit {proof['fit_de00']:.2f}, picture {proof['render_de00']:.2f}, {PROVING} pixels) in {seconds:.2f} s; "
          f"everything at its dearest: {total_de00(dearest):.2f} in {most:.2f} s, {most / seconds:.1f} times as long")
    if settings.basis in STEEP:
        print(f"  {settings.basis}.basis.xml: exponents {', '.join(map(str, STEEP[settings.basis]))} and a mirror")
    for command in settings.commands():
        print(f"  {command}")
    print(flush=True, end="")
    return True


def report(run, target, scenes):
    """Tells of each scene; returns whether all were brought within the target."""
    run.repeats = 2
    reached = [told(scene_of(run, text), target) for text in scenes or SCENES]
    return all(reached)
