"""The cheapest settings of all stages that bring a picture within a wanted error; a check proves that they do."""

import dataclasses
import itertools
import pathlib

from .scene import STEEP, Scene, Settings, total_de00, total_s

SCENES = ("signal_red,studio", "candy_red,outdoor", "silver_fine,studio")
BASES, METHODS = ("b5", "b7", "steep"), ("l1", "l2", "deltae")
TOLERANCES, EFFECTS = (1e-1, 3e-2, 1e-2, 1e-3), ("2", "0.5")  # All effects are tried as well.
INTEGRALS = ("integral 2", "integral 0.5", "integral 0.1")  # for errors that no maps reach
MAXIMAL = Settings("b7", "deltae", True, 1e-4, "all")
WORTH_IT = 0.99  # Fewer effects are tried only if they bring the time of all stages below this part of it.
CHOOSING, PROVING = 100, 500  # numbers of random pixels; the two sets have different seeds


def scene_of(run, text):
    """The scene of PAINT or PAINT,PROBE; the probe is a file, or studio or outdoor of the test data."""
    paint, _, probe = text.partition(",")
    if not probe:
        return Scene(run, paint, checks=CHOOSING)
    data = run.data / f"{probe}.exr"
    return Scene(run, paint, data if data.is_file() else pathlib.Path(probe).resolve(), checks=CHOOSING)


@dataclasses.dataclass
class Job:
    """All that shares its settings: the paints of a library, each in the same scenes. A few paints stand for all."""

    scenes: list  # those of the few paints
    paints: int = 1  # how many paints the library has
    bases: tuple = BASES  # the bases to choose from
    proving: int = PROVING  # the random pixels of the last check

    def seconds(self, settings):
        """The processor time of all stages: every paint is fitted and drawn in its scenes, and every probe is filtered once."""
        costs = [scene.cost(settings) for scene in self.scenes]
        shown = len({scene.paint for scene in self.scenes})
        filtered = {scene.probe: cost["prefilter_s"] for scene, cost in zip(self.scenes, costs)}
        return self.paints * (costs[0]["fit_s"] + sum(cost["render_s"] for cost in costs) / shown) + sum(filtered.values())

    def errors(self, settings, *more, checks=None):
        return [scene.error(settings, *more, checks=checks) for scene in self.scenes]


@dataclasses.dataclass
class Answer:
    """Settings, and the errors that a check of every scene found."""

    settings: Settings
    errors: list

    def worst(self):
        return max(range(len(self.errors)), key=lambda i: total_de00(self.errors[i]))

    def de00(self):
        return total_de00(self.errors[self.worst()])


def fits(job, basis):
    """(settings, dE00 of the fit in each scene) for every fit to a basis, the cheapest first."""
    every = [Settings(basis, method, views, MAXIMAL.prefilter, "all")
             for method, views in itertools.product(METHODS, (False, True))]
    return [(s, [scene.fit(s)[1] for scene in job.scenes]) for s in sorted(every, key=lambda s: job.scenes[0].fit(s)[2])]


def with_all_effects(job, basis):
    """(time of all stages, settings) for every tolerance of the prefilter with the most accurate fit, the cheapest first."""
    fit = min(fits(job, basis), key=lambda f: max(f[1]))[0]
    every = [dataclasses.replace(fit, prefilter=tolerance) for tolerance in TOLERANCES]
    return sorted(((job.seconds(settings), settings) for settings in every), key=lambda row: row[0])


def with_integral(job, basis):
    """(time, settings) of the sums over the probe itself; only the plan uses maps then, so the coarsest are good enough."""
    fit = min(fits(job, basis), key=lambda f: max(f[1]))[0]
    every = [dataclasses.replace(fit, prefilter=TOLERANCES[0], effects=effects) for effects in INTEGRALS]
    return [(job.seconds(settings), settings) for settings in every]


def with_fewer_effects(job, settings):
    """The settings with fewer effects that save enough time to be tried, the cheapest first."""
    if settings.integral():
        return []
    whole = job.seconds(settings)
    every = [dataclasses.replace(settings, effects=effects) for effects in EFFECTS]
    timed = sorted(((job.seconds(fewer), fewer) for fewer in every), key=lambda row: row[0])
    return [fewer for seconds, fewer in timed if seconds < WORTH_IT * whole]


def proven(job, settings, target):
    """The Answer of a check at many pixels; None if no fit leaves room for the error of the picture.

    A first check, at a few other pixels, finds that error; then the cheapest fit that leaves room for it is taken.
    """
    missed = [error["render_de00"] for error in job.errors(settings)]
    enough = [s for s, de00 in fits(job, settings.basis) if all(fit + picture <= target for fit, picture in zip(de00, missed))]
    if not enough:
        return None
    chosen = dataclasses.replace(enough[0], prefilter=settings.prefilter, effects=settings.effects)
    return Answer(chosen, job.errors(chosen, "--seed", 2, checks=job.proving))


def found(job, target):
    """The Answer of the cheapest settings within the target; if there are none, that of the settings that came nearest.

    A basis is considered only if its most exact maps are within the target, or if its fit leaves room for the integral. Settings
    are then tried from the cheapest upward. If all effects of a setting are within the target, fewer effects are tried too.
    """
    table, firsts, proofs = [], [], []
    for basis in job.bases:
        rows = with_all_effects(job, basis)
        finest = min((settings for _, settings in rows), key=lambda settings: settings.prefilter)
        firsts.append(Answer(finest, job.errors(finest)))
        if firsts[-1].de00() <= target:
            table += rows
        if max(error["fit_de00"] for error in firsts[-1].errors) < target:
            table += with_integral(job, basis)
    for _, settings in sorted(table, key=lambda row: row[0]):
        answer = proven(job, settings, target)
        if answer and answer.de00() <= target:
            cheaper = (proven(job, fewer, target) for fewer in with_fewer_effects(job, settings))
            return next((a for a in cheaper if a and a.de00() <= target), answer)
        proofs += [answer] if answer else []
    return min(proofs or firsts, key=Answer.de00)


def told(scene, target):
    """Prints what was found for a scene; returns whether the target was reached."""
    name = f"{scene.paint}, {scene.probe.stem}"
    dearest = scene.picture(MAXIMAL)
    answer = found(Job([scene]), target)
    if answer.de00() > target:
        print(f"{name}: dE00 {target:g} is not reached: {total_de00(dearest):.2f} (fit {dearest['fit_de00']:.2f}, "
              f"picture {dearest['render_de00']:.2f}) with {MAXIMAL}", flush=True)
        return False
    settings, proof = answer.settings, answer.errors[0]
    seconds, most = total_s(scene.cost(settings)), total_s(dearest)
    print(f"{name}: dE00 {total_de00(proof):.2f} (fit {proof['fit_de00']:.2f}, picture {proof['render_de00']:.2f}, "
          f"{PROVING} pixels) in {seconds:.2f} s; "
          f"everything at its dearest: {total_de00(dearest):.2f} in {most:.2f} s, {most / seconds:.1f} times as long")
    if settings.basis in STEEP:
        print(f"  {settings.basis}.basis.xml: exponents {', '.join(map(str, STEEP[settings.basis]))} and a mirror")
    for command in settings.commands():
        print(f"  {command}")
    print(flush=True, end="")
    return True


def report(run, target, scenes):
    """Prints what was found for each scene; returns whether all were brought within the target."""
    run.repeats = 2
    reached = [told(scene_of(run, text), target) for text in scenes or SCENES]
    return all(reached)
