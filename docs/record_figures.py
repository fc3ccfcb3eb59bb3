#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Gathers the figures that tests keep (test/figures.h) from their reports into docs/figures.csv, from where docs/make_figures.py
takes them into the pages.

  docs/record_figures.py [--check] [REPORTS]

REPORTS is the folder of the reports that a run of all tests has left (build/test_results/curtain_sim). With --check it only says
which figures are not what docs/figures.csv has.
"""
import csv
import glob
import os
import sys
import xml.etree.ElementTree

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TABLE = os.path.join(ROOT, "docs", "figures.csv")
COLUMNS = ["figure", "least", "largest", "test"]


def kept(reports):
    """Figure: its values, and the test."""
    found = {}
    for path in sorted(glob.glob(os.path.join(reports, "gtest-test_*.xml"))):
        for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
            for entry in case.iter("property"):
                word, _, name = entry.get("name").partition(" ")
                if word == "figure":
                    values, tests = found.setdefault(name.partition(" ")[2], (set(), set()))
                    values.add(entry.get("value"))
                    tests.add("%s.%s" % (case.get("classname").split("/")[-1], case.get("name").split("/")[0]))
    return found


def table(found):
    """Rows, by name."""
    return [[name, min(values, key=float), max(values, key=float), " ".join(sorted(tests))] for name, (values, tests) in sorted(found.items())]


def agree(row, other):
    """Rows of the same figures. Of rounding errors only that they are such: tests are compiled in more ways than the engine."""
    return row is not None and other is not None and all(
        max(abs(a), abs(b)) < 1e-9 or abs(a - b) <= 1e-3 * max(abs(a), abs(b)) for a, b in zip(map(float, row[1:3]), map(float, other[1:3])))


def main():
    """Writes, or says what is wrong."""
    check = sys.argv[1:2] == ["--check"]
    words = sys.argv[2:] if check else sys.argv[1:]
    if len(words) > 1 or any(word.startswith("-") for word in words):
        sys.exit(__doc__)
    rows = table(kept(words[0] if words else os.path.join(ROOT, "build", "test_results", "curtain_sim")))
    if not rows:
        sys.exit("no report of a test has figures there; run all tests")
    if not check:
        with open(TABLE, "w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([COLUMNS] + rows)
        return
    with open(TABLE, encoding="utf-8", newline="") as file:
        known = {row[0]: row for row in list(csv.reader(file))[1:]}
    measured = {row[0]: row for row in rows}
    wrong = ["%s: %s, but the tests have %s" % (name, known.get(name, ["", "none"])[1:3], measured.get(name, ["", "none"])[1:3])
             for name in sorted(set(known) | set(measured)) if not agree(known.get(name), measured.get(name))]
    if wrong:
        sys.exit("docs/figures.csv is of another engine:\n" + "\n".join(wrong) + "\ndocs/record_figures.py, then docs/make_figures.py, renew the pages")


if __name__ == "__main__":
    main()
