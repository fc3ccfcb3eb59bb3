# SPDX-License-Identifier: BSD-3-Clause
"""Reads figures from the tables of the book: docs/bench/*.csv, docs/stress and docs/figures.csv, as the pages tell them."""
import csv
import math
import os
import sys

from figure_text import bound, fixed, outwards, short, within

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PROBLEMS = ("slope", "belt", "scarf", "Atwood")  # of the closed forms
RIVALS = ("symplectic Euler", "Runge-Kutta 4", "Baraff-Witkin", "PBD", "XPBD", "btSoftBody")


def read(path):
    """A file of the checkout."""
    with open(os.path.join(ROOT, path), encoding="utf-8", newline="") as file:
        return file.read()


def rows(table, **wanted):
    """Rows of a benchmark's table that have what is wanted in these columns, with numbers as such."""
    lines = csv.DictReader(read("docs/bench/%s.csv" % table).splitlines())
    found = [row for row in lines if all(row[key] == wanted[key] for key in wanted)]
    if not found:
        sys.exit("docs/bench/%s.csv has no row of %s" % (table, wanted))
    return [{key: number(text) for key, text in row.items()} for row in found]


def number(text):
    """A number as such, other text as it is."""
    try:
        return float(text)
    except ValueError:
        return text


def one_row(table, **wanted):
    """The only row that has what is wanted."""
    found = rows(table, **wanted)
    if len(found) != 1:
        sys.exit("docs/bench/%s.csv has %d rows of %s" % (table, len(found), wanted))
    return found[0]


def one(table, column, **wanted):
    """A cell."""
    return one_row(table, **wanted)[column]


def swing(method, error, column="ms_min"):
    """The fastest setting of a method, or of any of them, that is at least this true after a second of the swing."""
    methods = (method,) if isinstance(method, str) else method
    good = [row for row in rows("work_precision", scene="swing") if row["method"] in methods and row["error_m"] <= error]
    return min(good, key=lambda row: row["ms_min"])[column]


def took(method, error):
    """Its ms, as they are told."""
    return short(swing(method, error))


def blown(wind):
    """ms a frame of the gathered curtain in its fan."""
    return short(one("gusts", "ms_min", wind=wind, method="auto", setting="default"))


def seen(view, column="ms_look", digits=2):
    """ms of a sensor's view."""
    return short(one("sensing", column, view=view), digits)


def energy(method):
    """Relative drift of our energy after a minute."""
    return short(one("energy", "drift", method=method, setting="substeps 8", t_s="60"))


def refined():
    """By which factor the errors of cantilevers fall from the coarsest to the finest, with auto."""
    error = {(row["case"], row["rods"]): row["error"] for row in rows("fabric", test="cantilever", method="auto")}
    return [error[case, 10.0] / error[case, 80.0] for case in {case for case, _ in error}]


def sheet(method, setting, column="ms_median", size="44x40"):
    """What a sheet hung by two corners and dropped flat takes."""
    return one("hard_spot", column, sheet=size, method=method, setting=setting)


def coarser(method, column):
    """Of the setting that just misses 1 mm after a second of the swing."""
    setting = "substeps 128; iterations 1" + ("; compliance 0 m/N" if method == "XPBD" else "")
    row = one_row("work_precision", scene="swing", method=method, setting=setting)
    assert row["error_m"] > 1e-3 and swing(method, 1e-3, "setting").startswith("substeps 256;"), "it no longer just misses 1 mm"
    return row[column]


def early(method, setting, size="44x40"):
    """How far off it is after 0.1 s [m]."""
    return one("hard_spot_motion", "error_m", sheet=size, method=method, setting=setting, t_s="0.1")


def frame(scene, column="ms_median_min"):
    """A frame in contact [ms]."""
    return short(one("contact_frames", column, scene=scene))


def both(scene):
    """Median and 99 % of a frame in contact [ms]."""
    return [frame(scene), frame(scene, "ms_99_min")]


def cores(scene):
    """Median of a frame in contact on one core and on two [ms]."""
    return [frame(scene + "; one core"), frame(scene + "; two cores")]


def engine(scene, name, setting, column="ms_median"):
    """What an engine takes or leaves in the same scene."""
    return one("engines", column, scene=scene, engine=name, setting=setting)


def keeping(scene, name, overlength):
    """Rows of an engine's settings that keep the links so short and the ball out, touching itself if it can."""
    return [row for row in rows("engines", scene=scene, engine=name) if row["stretch_max"] <= overlength and row["nodes_inside"] == 0 and
            (name == "Jolt" or "without self-contact" not in row["setting"]) and row["setting"] != "default; five waves"]


def fastest(scene, name, overlength):
    """The fastest of them."""
    return min(keeping(scene, name, overlength), key=lambda row: row["ms_median"])


def keeps(scene, name, overlength):
    """Its ms a frame, and what crosses."""
    best = fastest(scene, name, overlength)
    return [short(best["ms_median"]), fixed(best["crossings_end"])]


def rivalled(scene, name, overlength):
    """Its ms a frame and misfit."""
    best = fastest(scene, name, overlength)
    return [short(best["ms_median"]), short(best["stretch_max"])]


def clear(scene, name, overlength):
    """The fastest of them with nothing crossing at the end."""
    return min((row for row in keeping(scene, name, overlength) if row["crossings_end"] == 0), key=lambda row: row["ms_median"])


def clears(scene, name, overlengths=(0.1, 0.01, 0.001)):
    """ms a frame of such."""
    return [short(clear(scene, name, overlength)["ms_median"]) for overlength in overlengths]


def in_real_time(scene, name):
    """Least misfit in a frame of 1/60 s and what crosses then, and the least where nothing does."""
    quick = [row for row in keeping(scene, name, math.inf) if row["ms_median"] <= 1e3 / 60]
    best = min(quick, key=lambda row: row["stretch_max"])
    return [within(best["stretch_max"]), fixed(best["crossings_end"]), within(min(row["stretch_max"] for row in quick if row["crossings_end"] == 0))]


def cleared(scene, name, overlength):
    """ms a frame and misfit of the fastest setting with nothing crossing."""
    row = clear(scene, name, overlength)
    return [short(row["ms_median"]), within(row["stretch_max"])]


def apart(name, overlengths=(0.1, 0.01, 0.001)):
    """The same with the ball, where nothing crosses."""
    return [keeps(BALL, name, overlength)[0] for overlength in overlengths]


def together(scene, name, overlengths=(0.1, 0.01, 0.001)):
    """The same of cloth that touches itself."""
    return [text for overlength in overlengths for text in keeps(scene, name, overlength)]


def least(problem, method, error=math.inf):
    """The fastest of a method's settings that is as true of contact in closed form, or, without a bound, the truest."""
    found = [row for row in rows("closed_forms", problem=problem, method=method) if row["error"] <= error]
    return min(found, key=lambda row: row["error" if error == math.inf else "ms_median"])


def touched(problem, method):
    """ms a frame of the fastest setting that is off by a hundredth."""
    return short(least(problem, method, 1e-2)["ms_median"])


def drapes(fabric):
    """Coefficients of the shell and of our grids [%]."""
    return ["%.0f" % (100.0 * row["coefficient"]) for row in rows("fabric_drape", fabric=fabric)]


def per_frame(feature, state, column="instructions"):
    """Instructions or ns a frame of the 44 x 40 nodes."""
    return 44 * 40 * one("features", column, feature=feature, state=state)


def ratio(feature, decimals=3, state="idle"):
    """Instructions with a feature over those without."""
    return fixed(per_frame(feature, state) / per_frame(feature, "off"), decimals)


def largest(table, column, **wanted):
    """The largest of a column, whatever its sign."""
    return max(abs(row[column]) for row in rows(table, **wanted))


def grid(scene, size, threads="1", column="ms_min"):
    """ms a frame of a scene by its size."""
    lines, columns = size.split(" x ")
    return one("scaling", column, scene=scene, series="both", method="auto", threads=threads, rows=lines, columns=columns)


def at(size, rival, column="ms_min"):
    """A rival's ms a frame of the swing by its size; infinite where it takes no part."""
    lines, columns = size.split(" x ")
    found = [row for row in rows("scaling", scene="swing", threads="1", rows=lines, columns=columns) if row["method"] == rival]
    return found[0][column] if found else math.inf


def kept(figure):
    """Least and largest value of a figure that tests keep."""
    found = [row for row in csv.DictReader(read("docs/figures.csv").splitlines()) if row["figure"] == figure]
    if len(found) != 1:
        sys.exit("docs/figures.csv has %d rows of %s" % (len(found), figure))
    return [float(found[0]["least"]), float(found[0]["largest"])]


def most(figure):
    """A bound on it: its largest value, rounded up."""
    return within(kept(figure)[1])


def told_by(figure, digits=2):
    """The value of a figure that is kept once."""
    return short(kept(figure)[1], digits)


def between(figure):
    """Bounds of it on both sides: its least value rounded down, its largest rounded up."""
    return [bound(value, side) for value, side in zip(kept(figure), (-1, 1))]


def share(figure):
    """Bounds of what should be one, as far as they differ from it."""
    decimals = [3 if abs(1.0 - value) > 1e-3 else 4 for value in kept(figure)]
    return [fixed(outwards(value, side, 10.0 ** -digits), digits) for value, side, digits in zip(kept(figure), (-1, 1), decimals)]


def drifts(*methods):
    """By how much energy of the undamped swing is off after a minute with methods of others, least and largest."""
    off = [abs(row["drift"]) for row in rows("energy", t_s="60") if row["method"] in methods]
    return [bound(min(off), -1), within(max(off))]


def nearest_nets():
    """Of how many nets ours are nearer to the minimum than any rival's setting, of how many."""
    best = {}
    for row in rows("nets"):
        net, whose = (row["case"], row["n"], row["D"]), "rivals" if row["method"] in RIVALS else row["method"]
        best.setdefault(net, {}).setdefault(whose, []).append(abs(row["relative_error"]))
    won = sum(min(of["auto"]) < min(of["rivals"]) for of in best.values())
    return [str(won), str(len(best))]


def drape(cloth, nodes):
    """Coefficient, spread [%] and folds of a sample."""
    row = one_row("drape", cloth=cloth, nodes=nodes)
    return ["%.1f" % row[column] for column in ("coefficient", "spread", "folds")]


def tortures(*cases, method=""):
    """Of cases of the stress tests, with a method or any of ours, a bound on the rise of the energy."""
    found = [float(row["energy_gain"]) for row in csv.DictReader(read("docs/stress/matrix.csv").splitlines())
             if row["case"] in cases and row["method"] != "paper" and method in ("", row["method"])]
    return within(max(found))


def demo(name):
    """What a frame of a demo's scene takes, and what comes of it."""
    row = one_row("whole_scenes_demos", demo=name)
    return (["%.1f" % row[column] for column in ("ms_median", "ms_99", "ms_max", "substeps")] + [short(row["stretch_max"])] +
            [fixed(row[column]) for column in ("crossings", "piercings", "last_resort")])


def demo_in_node(name):
    """The same of the demo itself, and how many frames were not ready in time."""
    row = one_row("demos_in_node", demo=name)
    return (["%.1f" % row[column] for column in ("ms_median", "ms_99", "ms_max")] + [fixed(row[column]) for column in ("dropped", "frames")] +
            [short(row["stretch_max"])] + [fixed(row[column]) for column in ("crossings", "piercings", "last_resort")])


def tried(family, *wanted):
    """How many of a family's trials are as all of these say, of how many."""
    found = rows("trials", family=family)
    return [str(sum(all(is_so(row) for is_so in wanted) for row in found)), str(len(found))]


def falls_asleep(row):
    """Of a trial."""
    return row["asleep_s"] != ""


def waits(row):
    """Longer than a frame."""
    return row["waited_s"] > 0.02


def strains(row):
    """The last resort was needed."""
    return row["last_resort"] > 0


def keeps_straining(row):
    """It still is in the end."""
    return row["last_resort_last_second"] > 0


def is_light(row):
    """Of a load."""
    return row["times_the_cloth"] < 5


def folds(shear, *columns, method="auto"):
    """Columns of the folds of gathered cloth by its shear."""
    row = one_row("trials", family="folds", shear=shear, what=method)
    return [fixed(row[column], FOLDS[column]) for column in columns]


def stepped(client, listeners, batch):
    """Frames a second by ~step."""
    return fixed(one("step_rate", "frames_per_s_median", client=client, listeners=str(listeners), batch=str(batch)))


FOLDS = {"depth_mm": 1, "depth_4s_mm": 1, "wefts": 3, "substeps": 1}  # decimals
DROPPED, STRAIGHT = "sheet dropped by two corners", ("straight row", "straight row of 5 x 5")
SHAKEN = ("straight row of shaking pins", "straight row of trembling pins")
BUDGETS = "".join("\n| | %d ms | {} ms | {} | {} %% |" % budget for budget in (4, 2, 1))


def whole(scene, method="auto", budget="0", column="ms_median"):
    """Of a whole scene, bench/whole_scenes."""
    return one("whole_scenes", column, scene=scene, method=method, budget_ms=budget)


def unhurried(scene, method="auto"):
    """Median and 99 % of a frame [ms]."""
    return [short(whole(scene, method, column=column)) for column in ("ms_median", "ms_99")]


def pair(scene):
    """The same, of the paper's method and the default."""
    return unhurried(scene, "paper") + unhurried(scene)


def hurried(scene):
    """99 % of a frame [ms], late frames, motion left out [%] with budgets of 4, 2, 1 ms."""
    return [text for budget in ("4", "2", "1")
            for text in (short(whole(scene, budget=budget, column="ms_99")), fixed(whole(scene, budget=budget, column="late_frames")),
                         short(100.0 * whole(scene, budget=budget, column="left_out")))]


def megabytes(what, compression="none", digits=2):
    """Of what is written of a scene."""
    return short(1e-6 * one("file_sizes", "bytes", what=what, compression=compression), digits)


def stress_stamps():
    """Of what and on what the tables of docs/stress were made."""
    return list(csv.DictReader(read("docs/stress/stamps.csv").splitlines()))


def soaked(column):
    """A column of the soak's table."""
    return [float(row[column]) for row in csv.DictReader(read("docs/stress/soak.csv").splitlines())]


HOUSEHOLD = [("linen napkin", "50 x 50 cm, on a plate of 30 cm | linen"), ("linen rag", "35 x 50 cm, on 21 cm | linen"),
             ("bed sheet", "35 x 40 cm, on 21 cm | cotton broadcloth")]
BALL, GATHERED, FINE = "ball 44 x 40", "gathered 44 x 40", "gathered 105 x 96"
ASLEEP, AWAKE = fixed(per_frame("rest: all sleeps", "active")), fixed(round(per_frame("rest: all sleeps", "off"), -3))
CAMERA, NOISE, PORES = "camera 640 x 480", "; nguyen_2012 and dropouts", "; porosity 0.2"
HANDCRAFTED = rows("ccd", set="handcrafted")
DUELS = [("auto", "default"), ("XPBD", "substeps 256; iterations 1; compliance 0 m/N"),
         ("auto", "substeps 16"), ("XPBD", "substeps 1024; iterations 1; compliance 0 m/N")]
COARSE = ("XPBD", "substeps 64; iterations 1; compliance 0 m/N")
PACKED = ("none", "lz4", "bz2")
BOUNDS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
