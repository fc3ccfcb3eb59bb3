# SPDX-License-Identifier: BSD-3-Clause
"""PARAMS.yaml: which keys of the scene vary, how far, and by which design; from them the values of every run.

The same file gives the same runs everywhere: random numbers are those of random.Random(seed).random(), the only ones that
Python promises to keep.
"""
import itertools
import json
import math
import random
import re

import yaml

from curtain_sweep.problem import Problem, near

DESIGNS = ("grid", "latin_hypercube", "random")
KEYS = ("design", "seed", "count", "duration", "samples_per_second", "metrics", "parameters")
RANGE_KEYS = ("min", "max", "scale", "steps", "integer")
SCALES = ("linear", "log")
PATH = re.compile(r"[A-Za-z_]\w*(\[\d+\])*(\.[A-Za-z_]\w*(\[\d+\])*)*")
MOST_RUNS = 1000000
MOST_SAMPLES = 1000000


def number(value, name, low=-math.inf):
    """A finite number, at least low. YAML 1.1 takes 1e-6 for text: text that is wholly a number is that number."""
    if isinstance(value, str):
        if not re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", value):
            raise Problem("%s: must be a number, is the text '%s'" % (name, value))
        value = float(value)
    try:
        good = not isinstance(value, bool) and isinstance(value, (int, float)) and math.isfinite(value) and value >= low
    except OverflowError:  # a whole number with more digits than a float has room for
        good = False
    if not good:
        raise Problem("%s: must be a finite number%s, is %s" % (name, " >= %g" % low if low > -math.inf else "", value))
    return value


def whole(value, name, low, high=MOST_RUNS):
    """A whole number in [low, high]."""
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise Problem("%s: must be a whole number in [%d, %d], is %s" % (name, low, high, value))
    return value


def known(keys, names, where):
    """Only keys that there are."""
    for key in keys:
        if key not in names:
            raise Problem("%s%s: is not a known key%s" % (where, key, near(str(key), names) or ", those are " + ", ".join(names)))


class Parameter:
    """A key of the scene that varies: by a list, or by a range."""

    def __init__(self, name, given, design):
        self.name = name
        self.scale = "linear"
        if not isinstance(name, str) or not PATH.fullmatch(name):
            raise Problem("parameters: '%s' is no key of a scene, like contact.friction or wind[0].pressure" % name)
        if isinstance(given, list):
            if not given:
                raise Problem("%s: the list is empty" % name)
            self.values = given
            return
        if not isinstance(given, dict):
            raise Problem("%s: must be a list of values or {min, max}, is %s" % (name, given))
        known(given, RANGE_KEYS, name + ".")
        self.values = None
        for key in ("min", "max"):
            if key not in given:
                raise Problem("%s.%s: is missing" % (name, key))
        self.low, self.high = (number(given[key], "%s.%s" % (name, key)) for key in ("min", "max"))
        self.scale = given.get("scale", "linear")
        self.integer = given.get("integer", False)
        if self.low > self.high:
            raise Problem("%s: min %s is above max %s" % (name, self.low, self.high))
        if self.scale not in SCALES:
            raise Problem("%s.scale: must be linear or log, is %s" % (name, self.scale))
        if self.scale == "log" and self.low <= 0:
            raise Problem("%s.min: must be > 0 with scale: log, is %s" % (name, self.low))
        if not isinstance(self.integer, bool):
            raise Problem("%s.integer: must be true or false, is %s" % (name, self.integer))
        self.judge_width()
        if (design == "grid") != ("steps" in given):
            raise Problem("%s.steps: %s" % (name, "is missing; a grid needs to know how many values the range has"
                                            if design == "grid" else "is for design: grid alone"))
        if design == "grid":
            steps = whole(given["steps"], name + ".steps", 1)
            self.values = list(dict.fromkeys(self.at(k / (steps - 1) if steps > 1 else 0.5) for k in range(steps)))

    def judge_width(self):
        """Of a range: it must have a width in double precision, and if whole numbers are wanted, one within."""
        if not math.isfinite(float(self.high) - float(self.low)):
            raise Problem("%s: from min %g to max %g is too far" % (self.name, self.low, self.high))
        if not self.integer:
            return
        given = self.low, self.high
        self.low, self.high = math.ceil(self.low), math.floor(self.high)
        if self.low > self.high:
            raise Problem("%s: there is no whole number from min %s to max %s" % (self.name, *given))

    def at(self, share):
        """The value at a share of the range, or of the list, [0, 1), for a grid's last step 1. A whole number n has the share of
        [n, n + 1), so that with scale: linear all have the same."""
        if self.values is not None:
            return self.values[int(share * len(self.values))]
        end = self.high + 1 if self.integer else self.high
        if self.scale == "log":
            value = math.exp(math.log(self.low) + share * (math.log(end) - math.log(self.low)))
        else:
            value = self.low + share * (end - self.low)
        value = math.floor(value) if self.integer else float(value)
        return min(max(value, self.low), self.high)  # rounding


class Design:
    """What PARAMS.yaml says, judged."""

    def __init__(self, given):
        if not isinstance(given, dict):
            raise Problem("must be keys with values: %s" % ", ".join(KEYS))
        known(given, KEYS, "")
        self.given = given
        self.design = given.get("design", "grid")
        if self.design not in DESIGNS:
            raise Problem("design: must be %s, is %s" % (" or ".join((", ".join(DESIGNS[:-1]), DESIGNS[-1])), self.design))
        self.seed = whole(given.get("seed", 1), "seed", 0, 2**32 - 1)
        self.duration = number(given.get("duration", 1.0), "duration", 0.0)
        self.samples_per_second = number(given.get("samples_per_second", 10), "samples_per_second", 0.0)
        if self.samples() > MOST_SAMPLES:
            raise Problem("samples_per_second: at most %d states a run are possible, duration has more" % MOST_SAMPLES)
        self.metrics = given.get("metrics")
        if self.metrics is not None and not (isinstance(self.metrics, list) and all(isinstance(m, str) for m in self.metrics)):
            raise Problem("metrics: must be a list of names, is %s" % self.metrics)
        parameters = given.get("parameters")
        if not isinstance(parameters, dict) or not parameters:
            raise Problem("parameters: must name at least one key of the scene with its values")
        self.parameters = [Parameter(name, of, self.design) for name, of in parameters.items()]
        if self.design == "grid":
            if "count" in given:
                raise Problem("count: a grid has as many runs as its values make; leave it out")
            count = math.prod(len(p.values) for p in self.parameters)
            if count > MOST_RUNS:
                raise Problem("parameters: the grid has %d runs, at most %d are possible" % (count, MOST_RUNS))
        elif "count" not in given:
            raise Problem("count: is missing; how many runs shall it be?")
        else:
            self.count = whole(given["count"], "count", 1)

    def samples(self):
        """States of a trajectory, as curtain_batch --sample-rate counts them; without a rate the last one."""
        return math.floor(min(self.duration * self.samples_per_second, MOST_SAMPLES) + 1e-9) + 1

    def runs(self):
        """The values of every run, a list in the order of the parameters for each."""
        if self.design == "grid":
            return [list(values) for values in itertools.product(*(p.values for p in self.parameters))]
        dice = random.Random(self.seed).random
        if self.design == "random":
            return [[p.at(dice()) for p in self.parameters] for _ in range(self.count)]
        # McKay, Beckman, Conover, Technometrics 21 (1979): as many strata of each parameter as there are runs, each is met
        # once, at a random place within it, in a random order.
        columns = []
        for parameter in self.parameters:
            order = sorted(range(self.count), key=[dice() for _ in range(self.count)].__getitem__)
            columns.append([parameter.at((stratum + dice()) / self.count) for stratum in order])
        return [list(values) for values in zip(*columns)]


class Dateless(yaml.SafeLoader):
    """2024-01-01 is a text, as curtain_batch has it."""

    yaml_implicit_resolvers = {first: [(tag, of) for tag, of in resolvers if not tag.endswith(":timestamp")]
                               for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()}


def load_yaml(path):
    """The content of a YAML file: keys, lists, numbers and texts as YAML 1.1 has them, but for dates, which are texts."""
    try:
        with open(path, encoding="utf-8") as file:
            content = yaml.load(file, Loader=Dateless)
        json.dumps(content)  # what a sweep is of is kept as JSON: no other types, nothing that is within itself
        return content
    except OSError as error:
        raise Problem("%s: cannot be read: %s" % (path, error.strerror)) from error
    except (yaml.YAMLError, ValueError, TypeError, RecursionError) as error:  # ValueError: no UTF-8, or a number of 5000 digits
        raise Problem("%s: is not YAML: %s" % (path, " ".join(str(error).split()))) from error


def read_design(path):
    """The design in a file; problems name the file."""
    given = load_yaml(path)
    try:
        return Design(given)
    except Problem as problem:
        raise Problem("%s: %s" % (path, problem)) from None
