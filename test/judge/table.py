#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The kept table of random scenes: what `curtain_judge --csv` wrote of each, of which sources it is and on what it was computed.

  table.py TABLE SOURCES first                    prints its first seed, nothing if it has no scenes of these sources
  table.py TABLE SOURCES unpack FOLDER FIRST N    its scenes of these sources, if they begin with FIRST, N of a kind a file, as the judge wrote them
  table.py TABLE SOURCES pack FOLDER PROCESSOR    the table anew of the folder's files; those without a processor were computed here
"""
import csv
import gzip
import io
import os
import sys

OURS = ["sources", "processor"]  # columns that the judge does not write


def rows_of(table):
    if not os.path.exists(table):
        return []
    with gzip.open(table, "rt", newline="", encoding="utf-8") as text:
        return list(csv.DictReader(text))


def write(out, rows):
    table = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
    table.writeheader()
    table.writerows(rows)


def unpack(rows, folder, first, number):
    blocks = {}
    for row in rows:
        blocks.setdefault(first + (int(row["seed"]) - first) // number * number, []).append(row)
    for seed, block in blocks.items():
        with open(os.path.join(folder, "%d.csv" % seed), "w", newline="", encoding="utf-8") as out:
            # What holds stays the last column.
            write(out, [{**{name: row[name] for name in OURS}, **{name: row[name] for name in row if name not in OURS}} for row in block])


def pack(table, sources, folder, processor):
    rows = []
    for name in os.listdir(folder):
        if name.endswith(".csv"):
            with open(os.path.join(folder, name), newline="", encoding="utf-8") as text:
                rows += [{**row, "sources": sources, "processor": row.get("processor", processor)} for row in csv.DictReader(text)]
    names = [name for name in rows[0] if name not in OURS] + OURS
    rows = [{name: row[name] for name in names} for row in rows]
    text = io.StringIO()
    write(text, sorted(rows, key=lambda row: (row["kind"], int(row["seed"]))))
    with open(table, "wb") as out, gzip.GzipFile("", "wb", 9, out, 0) as packed:  # the same rows, the same bytes
        packed.write(text.getvalue().encode())


def main():
    table, sources, command, *rest = sys.argv[1:]
    rows = [row for row in rows_of(table) if row["sources"] == sources]
    first = min((int(row["seed"]) for row in rows), default=None)
    if command == "first":
        print(first or "")
    elif command == "unpack":
        if first == int(rest[1]):
            unpack(rows, rest[0], first, int(rest[2]))
    elif command == "pack":
        pack(table, sources, *rest)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
