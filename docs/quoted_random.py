# SPDX-License-Identifier: BSD-3-Clause
"""Reads figures of the random scenes, from docs/stress/random.md and its table."""
import csv
import gzip
import math
import os
import re
import sys

from figure_text import fixed, outwards, short
from quoted_tables import ROOT, read


def drawn(name):
    """A row of the table of random scenes: everyday, wild, sudden."""
    found = re.search(r"^\| \**%s\** \| (.*) \|$" % name, read("docs/stress/random.md"), re.M)
    if not found:
        sys.exit("docs/stress/random.md has no row '%s'" % name)
    return [int(cell.strip("*")) for cell in found[1].split(" | ")]


def told(name):
    """Figures of that table as it tells them: shares [%]."""
    found = re.search(r"^\| %s \| (.*) \|$" % re.escape(name), read("docs/stress/random.md"), re.M)
    if not found:
        sys.exit("docs/stress/random.md has no row '%s'" % name)
    return [cell.replace(" %", "") for cell in found[1].split(" | ")]


def percents(name):
    """Bounds of what that table has of the kinds of scenes [%]."""
    shares = [float(text) for text in told(name)]
    return [fixed(outwards(pick(shares), side, 1.0)) for pick, side in ((min, -1), (max, 1))]


def pulled_apart():
    """The worst link of all random scenes, over its length."""
    with gzip.open(os.path.join(ROOT, "docs/stress/random.csv.gz"), "rt", encoding="utf-8") as text:
        return short(max(float(row["stretch"]) for row in csv.DictReader(text) if row["method"] != "paper"))


def part(name):
    """Of the random scenes with it how many hold, and how many there are."""
    found = re.search(r"^\| %s \| (\d+) \| (\d+) \|" % name, read("docs/stress/random.md"), re.M)
    if not found:
        sys.exit("docs/stress/random.md has no row of scenes with %s" % name)
    return [found[2], found[1]]


def held():
    """Of each kind of random scenes how many held, of how many."""
    return [str(count) for kind in zip(drawn("hold"), drawn("scenes")) for count in kind]


def rarity():
    """N such that at most one scene in N fails, with a confidence of 95 %: the upper bound of a Poisson mean, rounded down to tens."""
    failures = sum(drawn("scenes")) - sum(drawn("hold"))
    low, high = 0.0, 10.0 + 3.0 * failures
    while high - low > 1e-9:
        mean = 0.5 * (low + high)
        seen_or_fewer = sum(math.exp(-mean) * mean ** k / math.factorial(k) for k in range(failures + 1))
        low, high = (mean, high) if seen_or_fewer > 0.05 else (low, mean)
    return "%.0f" % outwards(sum(drawn("scenes")) / high, -1, 10.0)
