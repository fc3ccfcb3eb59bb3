#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes README.md into the folder given from matrix.csv, and soak.csv where it is. With --check it only says whether the page is up
to date."""
import csv
import math
import os
import sys

TEXT = """# Stress

Extreme cases and how the cloth comes through them, made by `test/stress/run`. Cloth of 12 x 10 nodes, 1 m x 1 m, 0.2 kg/m²,
in air that damps a swing by 0.8 of critical, unless the case says otherwise; `test/stress/tortures_of_*.cpp` says what exactly
happens.

A case holds if all of this is true:

- Every number stays finite, and a second run gives the same bits.
- At every frame's end no link is longer than allowed: 2e-3, twice the tolerance, while substeps settle; more where pins or obstacles
  leave no choice.
- The energy never rises by more than the work that is put in plus 1e-2 of a scale: the sum of m g H, the kinetic energy at that time and
  the work of the last 60 frames. Work is that of gravity, winds, drags, pins and obstacles (`Simulator::work()`). The work of the air is not
  added, so a rise that the air takes away in the same frame is not seen. Energy that is lost is not judged: at 1e6 m/s the air takes
  nearly all of it in one substep ([limits](../accuracy.md#limits)).
- The cloth is back at rest for half a second in the time that the air allows, counted from the end of the case.

`paper` corrects wefts once and counts no work of pins: of it only finite numbers are required. Where a row is drawn straight, its kinetic
energy is bounded, too, by the sag that links within their tolerance permit.

A case holds also where the last resort had to cut the motion. Such cells end with a `*`; `last_resort` and `stops` of
[matrix.csv](matrix.csv) count the substeps.

The quick cases were run with every method, the slow ones (grids of up to a million nodes, a million frames, more random seeds) with the
default; `--long` runs them with the others, too. Empty cells were not run.

Each cell: largest overlength of a link (or shortness of a rod) / rise of the energy / time back to rest [s] (–: not tested).
In parentheses: reported, not judged, because the start or the pins leave no choice, or because the method is `paper`. *never*: not within the
allowed time. **Bold**: does not hold. *allowed*: the overlength and
the rise that this case may have where that is not the rule (2e-3 / 0.01); any: not judged.

"""


def size(value):
    """A ratio in a few letters."""
    value = float(value)
    if math.isnan(value):
        return "–"
    if abs(value) < 1e-12:
        return "0"
    return "%.0e" % value if abs(value) < 0.01 or abs(value) >= 100.0 else "%.2g" % value


def judged(row, what, allowed):
    text = size(row[what])
    return "(%s)" % text if math.isinf(float(row[allowed])) else text


def cell(row):
    if row is None:
        return ""
    asked = not math.isnan(float(row["recovery_allowed_s"]))
    back = "%.1f" % float(row["recovery_s"]) if asked and not math.isnan(float(row["recovery_s"])) else ("never" if asked else "–")
    text = "%s / %s / %s" % (judged(row, "stretch", "stretch_allowed"), judged(row, "energy_gain", "energy_allowed"), back)
    if row["finite"] != "1":
        text = "not finite"
    if row["last_resort"] != "0":
        text += " *"
    return text if row["holds"] == "1" else "**" + text + "**"


def allowed(row):
    """Bounds of a case that are not the rule's."""
    bounds = [float(row["stretch_allowed"]), float(row["energy_allowed"])]
    return "" if bounds == [0.002, 0.01] else " / ".join("any" if math.isinf(bound) else "%.2g" % bound for bound in bounds)


def matrix(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    methods, cases = [], {}
    for row in rows:
        if row["method"] not in methods:
            methods.append(row["method"])
        cases.setdefault(row["case"], {})[row["method"]] = row
    lines = ["| case | " + " | ".join(methods) + " | allowed |", "|---" * (len(methods) + 2) + "|"]
    for name, by_method in cases.items():
        lines.append("| %s | %s | %s |" % (name, " | ".join(cell(by_method.get(method)) for method in methods), allowed(by_method["auto"])))
    held = sum(row["holds"] == "1" for row in rows)
    worst = [row for row in rows if row["method"] == "auto"]
    lines.append("")
    lines.append("%d of %d hold; of `auto`, %d of %d, %d of them with the last resort (*)." % (
        held, len(rows), sum(row["holds"] == "1" for row in worst), len(worst), sum(row["last_resort"] != "0" for row in worst)))
    exact = [row for row in rows if row["method"] != "paper"]
    lines.append("Of the %d runs of methods other than `paper`, %d needed the last resort, and in %d the cloth was stopped for some substeps." % (
        len(exact), sum(row["last_resort"] != "0" for row in exact), sum(row["stops"] != "0" for row in exact)))
    return lines


def stamp(folder, table):
    """When and of what a table was measured."""
    with open(os.path.join(folder, "stamps.csv"), newline="", encoding="utf-8") as file:
        found = [row for row in csv.DictReader(file) if row["table"] == table]
    if len(found) != 1:
        sys.exit("%s/stamps.csv does not say of which commit %s.csv is; test/stress/run does" % (folder, table))
    return ["", "Measured {date} at commit {commit} ({processor}).".format(**found[0])]


def soak(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        return []
    lines = ["", "The demo (curtain, ball, fan) as fast as it goes, half a minute of quiet at the end of every "
             "interval. The first row, then one an hour; [soak.csv](soak.csv) has one every ten minutes. Heap: what the program has allocated (`mallinfo2`); memory: "
             "what the system keeps for it.", "",
             "| simulated hours | median ms a frame | longest of ten minutes | sweeps a frame | longest link | height, speed at rest [m, m/s] | memory [kB] | heap [kB] |",
             "|---|---|---|---|---|---|---|---|"]
    shown = rows[:1] + rows[5::6] + ([] if len(rows) % 6 == 0 else rows[-1:])
    for row in shown:
        lines.append("| %.2f | %.2f | %.0f | %.2f | %s | %s, %s | %s | %s |" % (
            float(row["hours"]), float(row["median_ms"]), float(row["longest_ms"]), float(row["sweeps_per_frame"]), row["stretch_max"],
            row["rest_height_m"], row["rest_speed_m_s"], row["resident_kb"], row["heap_kb"]))
    return lines


def main():
    folder = sys.argv[1]
    lines = matrix(os.path.join(folder, "matrix.csv")) + stamp(folder, "matrix")
    if os.path.exists(os.path.join(folder, "soak.csv")):
        lines += ["", "## Soak"] + stamp(folder, "soak") + soak(os.path.join(folder, "soak.csv"))
    path, page = os.path.join(folder, "README.md"), TEXT + "\n".join(lines) + "\n"
    if sys.argv[2:] != ["--check"]:
        with open(path, "w", encoding="utf-8") as file:
            file.write(page)
        return
    with open(path, encoding="utf-8") as file:
        if file.read() != page:
            sys.exit("%s is not what the tables beside it say: run test/stress/page.py %s" % (path, folder))


if __name__ == "__main__":
    main()
