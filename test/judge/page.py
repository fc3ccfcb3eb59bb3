#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes FOLDER/random.md from random.csv.gz and stamps.csv there: page.py FOLDER [--check]; --check compares instead, exit code 1 when it differs."""
import contextlib
import csv
import io
import math
import os
import statistics
import sys

from table import rows_of

KINDS = {
    "everyday": "cloth of 0.05 to 1 kg/m², 4 to 60 rows and columns (log-uniform), pulls of up to 30 N, wind of up to 100 Pa, balls and other shapes "
                "passing at up to 5 m/s, 10 to 240 frames a second, pinned anyhow",
    "wild": "1 g/m² to 10 kg/m², 2 to 100 rows and columns (log-uniform), pulls of up to 1 MN, 100 kPa, obstacles at up to 50 m/s, pins that jerk, "
            "gravity that turns, 5 to 1000 frames a second, any method",
    "sudden": "a gust, a pull, gravity or a jerk of the rail that sets in within a frame, 2 to 80 cm before a plate 5 to 10 mm thick",
}
# Rise of the energy over what moves on beyond which a scene is run once more, in steps of a sixteenth (test/judge/court.cpp: what links may hide, and
# what a step can't foresee). It holds if less is left there.
MAX_RISE = {"everyday": 0.0465, "sudden": 0.72}
EDGES = [1e-6, 1e-5, 1e-4, 3e-4, 5e-4, 1e-3, 2e-3]


def share(part, whole):
    return f"{100.0 * part / whole:.1f} %" if whole else "–"


def page(rows, stamp):
    print("# Random scenes\n")
    print("`test/judge/run` draws scenes from seeds, over all keys and sizes (`test/drawn`, `test/judge/draw.cpp`), simulates them and judges every frame:\n\n"
          "- Numbers are finite; no link is too long (no rod too short) by more than twice the tolerance of 1e-3; a frame needs at most 2000 solves.\n"
          "- Nothing crosses or pierces, by brute force at every frame (in long scenes of large cloth at every n-th).\n"
          "- The energy does not rise above what forces, pins and obstacles supply (not in wild scenes, nor in sudden ones where a step can't foresee it).\n"
          "- Of the method `paper`: numbers are finite, nothing crosses or pierces, rods keep their lengths where nothing touches; wefts are not judged.\n"
          "- In some scenes a second run, continued from a snapshot in its middle and with its caches cleared at random, ends with the same bits.\n\n"
          "[Which checks are left out of which scenes](../accuracy.md#random-scenes). Scenes that failed are kept in `test/judge/cases`, made as small as "
          "possible.\n")
    processors = sorted({row["processor"] for row in rows})
    print("Commit {commit}, {date}: {scenes} scenes, of seeds from {first} on, on {processors}. The first seed is the time at which the run began, and any "
          "change of the engine or the judge begins a new table, so the engine cannot have been tuned to these scenes. `test/judge/run` continues "
          "this table up to 20 010 scenes. They are the same on any machine but for times; [random.csv.gz](random.csv.gz) has all.\n".format(
              scenes=len(rows), first=min(int(row["seed"]) for row in rows), processors=" and ".join(processors), **stamp))
    for kind, what in KINDS.items():
        print(f"- **{kind}**: {what}.")
    print("\n| | " + " | ".join(KINDS) + " |\n|---" + "|---" * len(KINDS) + "|")
    of = {kind: [row for row in rows if row["kind"] == kind] for kind in KINDS}

    def line(title, value):
        print(f"| {title} | " + " | ".join(value(of[kind]) if of[kind] else "–" for kind in KINDS) + " |")

    number = lambda row, key: float(row[key])
    total = lambda some, key: sum(number(row, key) for row in some)
    most = lambda some, key: max(number(row, key) for row in some)
    line("scenes", lambda some: str(len(some)))
    line("**hold**", lambda some: f"**{sum(row['holds'] == '1' for row in some)}**")
    middle = lambda values: "%.0f" % statistics.median(values)
    line("nodes, median", lambda some: middle(int(row["rows"]) * int(row["columns"]) for row in some))
    line("frames, median", lambda some: middle(int(row["frames"]) for row in some))
    line("scenes of more than 1000 nodes", lambda some: str(sum(int(row["rows"]) * int(row["columns"]) > 1000 for row in some)))
    line("largest scene, nodes", lambda some: str(max(int(row["rows"]) * int(row["columns"]) for row in some)))
    # Links are what the exact methods promise.
    exact = lambda some: [row for row in some if row["method"] != "paper"]
    line("of the paper's method", lambda some: str(len(some) - len(exact(some))))
    alone = lambda some: [row for row in exact(some) if row["links_excused"] == "0" and row["holds"] == "1"]
    line("`paper` left out: worst link of a scene that holds, where no hand may have pulled links apart", lambda some: f"{most(alone(some), 'stretch'):.2e}")
    lower = 0.0
    for edge in EDGES:
        line(f"scenes whose worst link is off by {f'{lower:.0e}' if lower else 0} to {edge:.0e}",
             lambda some, a=lower, b=edge: str(sum(a < number(row, "stretch") <= b or (a == 0.0 and number(row, "stretch") <= b) for row in exact(some))))
        lower = edge
    line("scenes whose worst link is off by more, where a hand may have pulled links apart", lambda some: str(sum(number(row, "stretch") > EDGES[-1] and row["holds"] == "1" for row in exact(some))))
    # What the verdict is of.
    line("frames checked by brute force", lambda some: share(total(some, "brute_forced"), total(some, "frames")))
    line("of these, with self-contact, whose crossings are excused", lambda some: share(total(some, "crossings_excused"), total(some, "crossings")))
    line("`paper` left out: frames in which a hand may have pulled links apart", lambda some: share(total(exact(some), "links_excused"), total(exact(some), "frames")))
    line("checks for piercing that are excused (one for each obstacle and frame)", lambda some: share(total(some, "obstacles_excused"), total(some, "obstacles")))
    line("`paper` left out: frames whose energy is judged", lambda some: "none" if some[0]["kind"] == "wild" else
         share(total(exact(some), "energy_judged"), total(exact(some), "frames")))
    line("scenes in which the energy is judged in no frame", lambda some: "all" if some[0]["kind"] == "wild" else str(sum(row["energy_judged"] == "0" for row in exact(some))))
    if any(number(row, "energy_finer") > 0 and number(row, "energy_gain") <= MAX_RISE.get(row["kind"], 0.0) for row in rows):
        sys.exit("a scene was run in finer steps though its energy rose by less than MAX_RISE: it is not what test/judge/court.cpp has")
    rose = lambda some: [row for row in exact(some) if number(row, "energy_judged") > 0 and number(row, "energy_gain") > MAX_RISE.get(row["kind"], math.inf)]
    line("a rise of the energy counts above", lambda some: f"{MAX_RISE[some[0]['kind']]:g}" if some[0]["kind"] in MAX_RISE else "–")
    line("scenes run again in finer steps, since their energy rose by more", lambda some: str(len(rose(some))) if some[0]["kind"] in MAX_RISE else "–")
    line("largest such rise", lambda some: f"{most(rose(some), 'energy_gain'):.2f}" if rose(some) else "–")
    line("largest rise of these scenes in finer steps", lambda some: f"{most(rose(some), 'energy_finer'):.2g}" if rose(some) else "–")
    line("scenes that needed the last resort", lambda some: share(sum(number(row, "last_resort") > 0 for row in some), len(some)))
    line("substeps of the last resort", lambda some: share(total(some, "last_resort"), total(some, "substeps")))
    line("substeps in which the cloth stayed where it was", lambda some: share(total(some, "stops"), total(some, "substeps")))
    line("scenes with such substeps", lambda some: share(sum(number(row, "stops") > 0 for row in some), len(some)))
    mostly = lambda some, key: share(sum(2 * number(row, key) > number(row, "substeps") for row in some), len(some))
    line("scenes with more than half of their substeps of the last resort", lambda some: mostly(some, "last_resort"))
    line("scenes in which the cloth stayed where it was in more than half of the substeps", lambda some: mostly(some, "stops"))
    line("momentum cut, median of the scenes with any [N s]",
         lambda some: (lambda cut: f"{statistics.median(cut):.2g}" if cut else "–")([number(row, "momentum_cut") for row in some if number(row, "momentum_cut") > 0]))
    line("maximum number of solves in a frame", lambda some: f"{most(some, 'max_solves'):.0f}")
    line("rejected, of all solves", lambda some: share(total(some, "rejected"), total(some, "rejected") + total(some, "substeps")))
    line("slowest frame, s", lambda some: f"{most(some, 'slowest_frame_s'):.2g}")
    line("processor time, s", lambda some: f"{total(some, 'seconds'):.0f}")
    parts = sorted({part for row in rows for part in row["parts"].split("+") if part})
    print("\nBy what scenes have, of all kinds together:\n")
    print("| with | scenes | hold | substeps of the last resort | us of the processor a frame and node, median |\n|---|---|---|---|---|")
    for part in ["anything or nothing", *parts]:
        some = [row for row in rows if part not in parts or part in row["parts"].split("+")]
        cost = statistics.median(1e6 * number(row, "seconds") / (number(row, "frames") * number(row, "rows") * number(row, "columns")) for row in some)
        print(f"| {part} | {len(some)} | {sum(row['holds'] == '1' for row in some)} | {share(total(some, 'last_resort'), total(some, 'substeps'))} "
              f"| {cost:.2g} |")
    failed = [f"{row['kind']} {row['seed']}" for row in rows if row["holds"] != "1"]
    if failed:
        print("\nDid not hold when they were drawn; since then mended, or described in docs/accuracy.md: " + ", ".join(failed) + ".")


def main():
    folder = sys.argv[1]
    with open(os.path.join(folder, "stamps.csv"), newline="", encoding="utf-8") as stamps:
        stamp, = [row for row in csv.DictReader(stamps) if row["table"] == "random"]
    text = io.StringIO()
    with contextlib.redirect_stdout(text):
        page(rows_of(os.path.join(folder, "random.csv.gz")), stamp)
    path = os.path.join(folder, "random.md")
    if sys.argv[2:] != ["--check"]:
        with open(path, "w", encoding="utf-8") as file:
            file.write(text.getvalue())
        return
    with open(path, encoding="utf-8") as file:
        if file.read() != text.getvalue():
            sys.exit("%s is not what the table beside it says: run test/judge/page.py %s" % (path, folder))


if __name__ == "__main__":
    main()
