# SPDX-License-Identifier: Apache-2.0
"""What is tried in the scenario matrix: scenes × views × cameras × mistakes × background, and the settings."""

import functools
import itertools
from collections import Counter, namedtuple

AXES = {
    "scene": ["figure", "anchor", "armadillo", "fertility"],
    "views": [8, 12, 24, 48, 72],
    "arc": ["full", "ring", "upper", "front"],
    "data": ["clean", "out5", "out10", "hard", "hardblind", "half"],
    "background": ["none", "wall"],
}
EACH_AT_LEAST = 6
SCENARIOS = 40

# Options of `vdbfuse synth`. Confidences are informative unless said otherwise.
DATA = {
    "clean": [],
    "out5": ["--outliers", "0.05", "--confidence", "none"],
    "out10": ["--outliers", "0.1", "--confidence", "informative"],
    "hard": ["--hard"],  # overlapping confidences
    "hardblind": ["--hard", "--confidence", "none"],
    "half": ["--missing", "0.5"],
}
UP = {"figure": "z", "anchor": "z", "armadillo": "y", "fertility": "y"}


class Scenario(namedtuple("Scenario", AXES)):
    __slots__ = ()

    @property
    def name(self):
        return "-".join(str(value) for value in self)

    @property
    def from_all_sides(self):
        """The scenarios for which the surface is asked for to the last half percent."""
        return self.arc == "full" and self.views >= 24


# Chosen by hand: seen from all sides, with every kind of mistake. The rest is found by coverage.
SEEN_FROM_ALL_SIDES = [
    Scenario("figure", 48, "full", "clean", "none"),
    Scenario("figure", 24, "full", "hard", "none"),
    Scenario("figure", 72, "full", "out5", "wall"),
    Scenario("armadillo", 48, "full", "hardblind", "wall"),
    Scenario("armadillo", 24, "full", "half", "none"),
    Scenario("fertility", 72, "full", "hard", "wall"),
    Scenario("fertility", 24, "full", "hardblind", "none"),
    Scenario("anchor", 48, "full", "out10", "none"),
]


def pairs(scenario):
    return set(itertools.combinations(zip(AXES, scenario), 2))


@functools.cache
def scenarios():
    """The same list always: SEEN_FROM_ALL_SIDES, then whatever holds most pairs of values not yet tried, then
    the rarest values. Every pair of values occurs."""
    chosen = list(SEEN_FROM_ALL_SIDES)
    everything = [Scenario(*values) for values in itertools.product(*AXES.values())]
    tried = set().union(*map(pairs, chosen))
    while len(chosen) < SCENARIOS:
        uses = Counter(entry for scenario in chosen for entry in zip(AXES, scenario))
        share = {(axis, value): uses[axis, value] * len(AXES[axis]) for axis in AXES for value in AXES[axis]}

        def worth(scenario):
            return (len(pairs(scenario) - tried), -sum(share[entry] ** 2 for entry in zip(AXES, scenario)))

        best = max((s for s in everything if s not in chosen), key=worth)
        chosen.append(best)
        tried |= pairs(best)
    return tuple(chosen)


def coverage(chosen):
    """How often each value of each axis occurs: {axis: {value: count}}."""
    return {axis: {value: sum(getattr(s, axis) == value for s in chosen) for value in values}
            for axis, values in AXES.items()}


# The settings. A row is a function of the scenario, the size and the record of the default row (None when
# there is none yet) that returns options of `vdbfuse fuse`.
PARTS = {
    "default": lambda scenario, size, default: [],
    # Section 2.1 of the algorithm, whole, and its second pass.
    "no-reliability": lambda scenario, size, default: ["--no-reliability"],
    "no-denial": lambda scenario, size, default: ["--no-denial"],
    # One v in place of Beta(v; a, 1): two or three views in all are expected to see a point.
    "one-v": lambda scenario, size, default: ["--visibility", f"{2.5 / scenario.views:.6g}"],
    # Denial at any distance behind a surface.
    "no-thickness": lambda scenario, size, default: ["--thickness", "off"],
    "no-return-off": lambda scenario, size, default: ["--no-return", "ignore"],
    # Who knows nothing of the sensor takes one voxel for its noise: 2.7 (small) and 1.3 (full) times the truth.
    "no-calibration": lambda scenario, size, default: ["--noise-scale", f"{size.voxel:g}"],
    "paper": lambda scenario, size, default: ["--rule", "paper"],
    "tsdf": lambda scenario, size, default: ["--method", "tsdf"],
    "oracle": lambda scenario, size, default: [],  # a judgement is given, see scenarios.py
}


def scaled(option, key, factor):
    """`option` at `factor` times what the default row found."""
    return lambda scenario, size, default: None if default is None else [option, f"{factor * default[key]:.6g}"]


def fixed(*options):
    return lambda scenario, size, default: list(options)


SENSITIVITY = {
    "lambda/3": scaled("--lambda", "lambda", 1 / 3),
    "lambda*3": scaled("--lambda", "lambda", 3),
    "mu/2": fixed("--mu", "1"),
    "mu*2": fixed("--mu", "4"),
    "mu*4": fixed("--mu", "8"),
    "noise/2": scaled("--noise-scale", "noise_scale", 0.5),
    "noise*2": scaled("--noise-scale", "noise_scale", 2),
    "a=0.25": fixed("--visibility-prior", "0.25"),
    "a=1": fixed("--visibility-prior", "1"),
    "b=0": fixed("--prior", "0"),
    "b=0.5": fixed("--prior", "0.5"),
}
RESOLUTION = {f"resolution-{n}": fixed("--resolution", str(n)) for n in (128, 256, 512)}
ROWS = {**PARTS, **SENSITIVITY, **RESOLUTION}
GROUPS = {"parts": list(PARTS), "sensitivity": ["default", *SENSITIVITY], "resolution": list(RESOLUTION)}


def applies(scenario, row):
    """Sensitivity and resolution are asked for where the surface is seen from all sides."""
    return row in PARTS or scenario.from_all_sides
