#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the figures that pages quote from the tables of the book (docs/bench, docs/stress, docs/figures.csv) into the pages:
docs/make_figures.py. With --check it only says which figures are not what the tables have.
"""
import os
import re
import sys

from quoted_figures import FIGURES
from quoted_tables import ROOT, read, rows, stress_stamps

NUMBER = r"(-?\d+(?: \d{3})*(?:\.\d+)?(?:e-?\d+)?)"


def unnamed():
    """Pages that do not name the processor which the studies were measured on."""
    known = sorted({row["processor"] for row in rows("stamps") + stress_stamps()} - {"not noted"})
    named = [name.replace("(R)", "").replace(" Processor", "") for name in known]
    return ["%s does not name %s" % (path, name) for path in ("README.md", "docs/accuracy.md") for name in named
            if "an %s" % name not in read(path)]


def find(page, text):
    """Where a text of FIGURES stands in a page, wherever its lines break."""
    pattern = NUMBER.join(re.sub(r"(?:\\? )+", r"\\s+", re.escape(part)) for part in text.split("{}"))
    places = list(re.finditer(pattern, page))
    return places[0] if len(places) == 1 else None


def main():
    """Writes, or says what is wrong."""
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(__doc__)
    wrong = unnamed()
    for path, entries in FIGURES.items():
        page = read(path)
        for text, figures in entries:
            place = find(page, text)
            if place is None:
                wrong.append("%s has not once: %s" % (path, text))
                continue
            for k in range(len(figures), 0, -1):  # the last one first: what is before it stays where it is
                if place[k] != figures[k - 1]:
                    line = page.count("\n", 0, place.start(k)) + 1
                    if sys.argv[1:]:
                        before = text.split("{}")[k - 1][-30:]
                        wrong.append("%s:%d: %s%s, but the table has %s" % (path, line, before, place[k], figures[k - 1]))
                    else:
                        page = page[:place.start(k)] + figures[k - 1] + page[place.end(k):]
        if not sys.argv[1:]:
            with open(os.path.join(ROOT, path), "w", encoding="utf-8", newline="") as file:
                file.write(page)
    if wrong:
        sys.exit("\n".join(wrong) + "\ndocs/make_figures.py writes what the tables have; docs/quoted_figures.py has the text around each figure")


if __name__ == "__main__":
    main()
