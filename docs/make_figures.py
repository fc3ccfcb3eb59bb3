#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the figures that pages quote from docs/bench/*.csv and docs/stress/random.md into the pages: docs/make_figures.py.
With --check it only says which figures are not what the tables have.

FIGURES has the text around them, with {} for each, as it stands once in its page: who rewrites such a text, rewrites it there, too.
"""
import csv
import math
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
NUMBER = r"(-?\d+(?: \d{3})*(?:\.\d+)?(?:e-?\d+)?)"
PROBLEMS = ("slope", "belt", "scarf")  # of the closed forms
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


def one(table, column, **wanted):
    """A cell."""
    found = rows(table, **wanted)
    if len(found) != 1:
        sys.exit("docs/bench/%s.csv has %d rows of %s" % (table, len(found), wanted))
    return found[0][column]


def short(value, digits=2):
    """As many digits, all of them where it is larger: 0.50, 35, 569, 5.6e-5."""
    if abs(value) < 1e-2:
        return re.sub(r"e-0?", "e-", "%.*e" % (digits - 1, value))
    return "%.0f" % value if abs(value) >= 10 ** digits - 0.5 else ("%#.*g" % (digits, value)).rstrip(".")


def within(value, digits=2):
    """Rounded up: a bound."""
    unit = 10.0 ** (math.floor(math.log10(value)) - digits + 1)
    return short(unit * math.ceil(value / unit * (1.0 - 1e-12)), digits)


def fixed(value, decimals=0):
    """So many decimals, and spaces where there are ten thousands."""
    text = "%.*f" % (decimals, value)
    return "{:,}".format(int(text)).replace(",", " ") if decimals == 0 and abs(value) >= 1e4 else text


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


def peer(name, setting):
    """ms a frame and overlength of an engine with the ball."""
    return [short(engine("ball 44 x 40", name, setting)), short(engine("ball 44 x 40", name, setting, "stretch_max"))]


def keeps(scene, name, overlength):
    """ms a frame of an engine's fastest setting that keeps the links so short and the ball out, touching itself if it can, and what crosses."""
    good = [row for row in rows("engines", scene=scene, engine=name) if row["stretch_max"] <= overlength and row["nodes_inside"] == 0 and
            (name == "Jolt" or "without self-contact" not in row["setting"])]
    best = min(good, key=lambda row: row["ms_median"])
    return [short(best["ms_median"]), fixed(best["crossings_end"])]


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


def drawn(name):
    """A row of the table of random scenes: everyday, wild, sudden."""
    found = re.search(r"^\| \**%s\** \| (.*) \|$" % name, read("docs/stress/random.md"), re.M)
    if not found:
        sys.exit("docs/stress/random.md has no row '%s'" % name)
    return [int(cell.strip("*")) for cell in found[1].split(" | ")]


def told(name):
    """Figures of that table as it tells them: shares [%]."""
    found = re.search(r"^\| %s \| (.*) \|$" % name, read("docs/stress/random.md"), re.M)
    if not found:
        sys.exit("docs/stress/random.md has no row '%s'" % name)
    return [cell.replace(" %", "") for cell in found[1].split(" | ")]


DROPPED = "sheet dropped by two corners"


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
    budgets = ("4", "2", "1")
    return ([short(whole(scene, budget=budget, column="ms_99")) for budget in budgets] +
            [fixed(whole(scene, budget=budget, column="late_frames")) for budget in budgets] +
            [short(100.0 * whole(scene, budget=budget, column="left_out")) for budget in budgets])


def soaked(column):
    """A column of the soak's table."""
    return [float(row[column]) for row in csv.DictReader(read("docs/stress/soak.csv").splitlines())]


def held():
    """Of each kind of random scenes how many held, of how many."""
    return [str(count) for pair in zip(drawn("hold"), drawn("scenes")) for count in pair]


BALL, GATHERED, FINE = "ball 44 x 40", "gathered 44 x 40", "gathered 105 x 96"
PEERS = (peer("NvCloth", "2400 Hz; phases top-down") + peer("Jolt", "LRA; steps a frame 4; iterations 40") +
         peer("Bullet", "substeps 64; piterations 4"))
OURS_WITH_BALL = [short(engine(BALL, "curtain_sim", "default")), within(engine(BALL, "curtain_sim", "default", "stretch_max"))]
ASLEEP, AWAKE = fixed(per_frame("rest: all sleeps", "active")), fixed(round(per_frame("rest: all sleeps", "off"), -3))
QUICK = "600 Hz; self-collision at 9.00 mm; phases top-down"
NVCLOTH = "9600 Hz; self-collision at 20.0 mm; phases even/odd"
CAMERA, NOISE, PORES = "camera 640 x 480", "; nguyen_2012 and dropouts", "; porosity 0.2"
HANDCRAFTED = rows("ccd", set="handcrafted")
DUELS = [("auto", "default"), ("XPBD", "substeps 256; iterations 1; compliance 0 m/N"),
         ("auto", "substeps 16"), ("XPBD", "substeps 1024; iterations 1; compliance 0 m/N")]
BOUNDS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)

FIGURES = {
    "README.md": [
        ("off by less than 1 mm | {} ms of computing; the fastest rival takes {} |", [took("auto", 1e-3), took(RIVALS, 1e-3)]),
        ("off by less than 0.01 mm | {} ms (`leapfrog4`); the fastest rival takes {} |", [took("leapfrog4", 1e-5), took(RIVALS, 1e-5)]),
        ("median (99 %) of a frame | {} ({}) ms;", both("curtain")),
        ("the same without contact | {} ms", [blown("gusts")]),
        ("pushed 0.4 m into a curtain, links within {} | {} ms a frame; NvCloth {} for {}, Jolt {} for {}, Bullet {} for {} |",
         OURS_WITH_BALL[::-1] + PEERS),
        ("44 x 40, median (99 %) | {} ({}) ms;", [short(engine(GATHERED, "curtain_sim", "default", column)) for column in ("ms_median", "ms_99")]),
        ("touches-itself) {} ({}) limp, {} ({}) of cotton |",
         [short(one("gathered", column, scene=scene, method="auto", tolerance="0.001")) for scene in ("limp", "cotton")
          for column in ("ms_median", "ms_99")]),
        ("| links within {}, no edge through a face at the end; NvCloth takes {} ms for {}, {} crossings |",
         [within(engine(GATHERED, "curtain_sim", "default", "stretch_max")),
          short(engine(GATHERED, "NvCloth", NVCLOTH)), short(engine(GATHERED, "NvCloth", NVCLOTH, "stretch_max")),
          fixed(engine(GATHERED, "NvCloth", NVCLOTH, "crossings_end"))]),
        ("(on {} to {} % of the frames), energy | {} of {} hold;",
         [fixed(pick(float(text) for text in told("frames looked at by brute force"))) for pick in (min, max)] +
         [str(sum(drawn("hold"))), str(sum(drawn("scenes")))]),
        ("8 substeps | {} of what it can lose (`leapfrog4`: {}); [automatic", [energy("auto"), energy("leapfrog4")]),
        ("a curtain asleep | {} instructions a frame |", [ASLEEP]),
    ],
    "docs/accuracy.md": [
        ("For 1 % PBD takes {} ms a frame on a slope, {} on", [touched("slope", "PBD"), touched("belt", "PBD")]),
        ("a belt, {} with a scarf; `auto` takes {}, {} and {} ([closed", [touched("scarf", "PBD")] + [touched(problem, "auto") for problem in PROBLEMS]),
        ("PBD is off by {} at best, `auto` by {} in {} ms.",
         [short(least("capstan", "PBD")["error"]), short(least("capstan", "auto")["error"], 1), short(least("capstan", "auto")["ms_median"])]),
        ("An isotropic fabric has {} % of drape by the shell, and {}, {} and {} % by the", drapes("between")),
        ("a limp one {} %, and {}, {} and {} %;", drapes("limp")),
        ("a stiff one {} %, and {}, {} and {} %", drapes("stiff")),
        # -- error against computing time
        ("| **`auto`**, `leapfrog` | **{} ms** | **{}** ({} mm) | **{}** | {} | {} |",
         [took("auto", 1e-2), took("auto", 1e-3), short(1e3 * swing("auto", 1e-3, "error_m"))] + [took("auto", bound) for bound in BOUNDS[2:]]),
        ("| `leapfrog4` | {} | {} ({} mm) | {} | **{}** | **{}** |",
         [took("leapfrog4", 1e-2), took("leapfrog4", 1e-3), short(1e3 * swing("leapfrog4", 1e-3, "error_m"))] +
         [took("leapfrog4", bound) for bound in BOUNDS[2:]]),
        ("| `implicit` (stable, damps) | {} |", [took("implicit", 1e-2)]),
        ("| `paper` (Cheng 2000, Sect. 3) | {} (64 substeps) |", [took("paper", 1e-2)]),
        ("a second of the swing is {} mm at its 16 substeps", [short(1e3 * one("work_precision", "error_m", scene="swing", method="paper", setting="default"))]),
        ("symplectic Euler | {} | {} | {} | {} | |", [took("symplectic Euler", bound) for bound in BOUNDS[:4]]),
        ("Runge–Kutta 4 | {} | {} | {} | {} | |", [took("Runge-Kutta 4", bound) for bound in BOUNDS[:4]]),
        ("Baraff–Witkin | {} |", [took("Baraff-Witkin", 1e-2)]),
        ("| PBD / XPBD | {} / {} | {} / {} |", [took(method, bound) for bound in BOUNDS[:2] for method in ("PBD", "XPBD")]),
        ("btSoftBody (double) | {} |", [took("btSoftBody", 1e-2)]),
        ("`auto` takes {} ms for {} mm.\n",
         [short(one("work_precision", "ms_min", scene="swing", method="auto", setting="default")),
          short(1e3 * one("work_precision", "error_m", scene="swing", method="auto", setting="default"))]),
        ("`auto` takes {} ms a frame and is off by {} um after 0.1 s, XPBD with 256 substeps takes {} ms for {} um; with 16 substeps `auto` takes "
         "{} ms for {} um, XPBD with 1024 takes {} ms for {} um.",
         [text for method, setting in DUELS for text in (short(sheet(method, setting)), short(1e6 * early(method, setting)))]),
        ("in the snap that follows differs more: {} and {} in the first pair, {} and {} in the second.", [short(sheet(method, setting, "stretch")) for method, setting in DUELS]),
        ("confirms to {} um at that time.", [short(1e6 * early(*DUELS[-1]))]),
        ("energy of its start within {} of what it could lose", [energy("auto").lstrip("-")]),
        ("at its 16 substeps, `auto`'s {} mm;",
         [short(1e3 * one("work_precision", "error_m", scene="swing", method="auto", setting="default"))]),
        ("stretch by up to {} of their length in the curtain and {} in the flag",
         [short(whole(name, "paper", column="stretch_max")) for name in ("curtain", "flag without self-contact")]),
        ("without self-contact | {} ({}) | {} ({}) | under", pair("flag without self-contact")),
        ("1760 nodes, without contact | {} ({}) | {} ({}) | 10 |", pair("curtain without contact")),
        ("the same with ball and self-contact | {} ({}) | {} ({}) | |", pair("curtain")),
        ("by two corners, 5 s (without it {} ms a frame, 99 % {}) | 99 % of the frames within {}, {}, {} ms; of 300 late {}, {}, {}; motion left out {}, {}, {} %;",
         unhurried(DROPPED) + hurried(DROPPED)),
        ("with ball and self-contact ({} ms, 99 % {}): within {}, {}, {} ms; late {}, {}, {}; left out {}, {}, {} %:", unhurried("curtain") + hurried("curtain")),
        # -- exactness
        ("within {} (`auto`; `leapfrog` {}; {} nets)",
         [within(largest("nets", "relative_error", method="auto")), within(largest("nets", "relative_error", method="leapfrog")),
          str(len(rows("nets", method="auto")))]),
        ("against the closed form for the model's wind | within {} of its length |", [within(largest("wind", "tip_error_over_L", method="auto"), 1)]),
        ("five eigenfrequencies | within {} (`leapfrog`, 8 substeps), {} (`leapfrog4`), {} with the default substeps |",
         [within(largest("modes", "relative_error", method=method, setting=setting))
          for method, setting in (("leapfrog", "substeps 8"), ("leapfrog4", "substeps 8"), ("auto", "default"))]),
        ("8 substeps | {} of what it can lose, off by {} at most until then (`leapfrog4`: {}); automatic",
         [energy("auto"), short(largest("energy", "drift", method="auto", setting="substeps 8")), energy("leapfrog4")]),
        ("errors fall from 10 to 80 rods by a factor of {} to {}, not", [fixed(pick(refined())) for pick in (min, max)]),
        # -- speed
        ("takes at most {} of the fastest rival's time. At 100 000 nodes it takes {} ms, symplectic Euler {} and XPBD {}, at settings that leave "
         "their links off by {} and {}; ours are within {}. With links within 0.01 the fastest rival takes {} ms.",
         [within(max(grid("swing", size) / min(at(size, rival) for rival in RIVALS) for size in ("16 x 15", "44 x 40", "112 x 90"))),
          short(grid("swing", "400 x 250")), short(at("400 x 250", "symplectic Euler")), short(at("400 x 250", "XPBD")),
          short(at("400 x 250", "symplectic Euler", "stretch")), short(at("400 x 250", "XPBD", "stretch")),
          within(grid("swing", "400 x 250", column="stretch")),
          short(min(at("400 x 250", rival) for rival in RIVALS if at("400 x 250", rival, "stretch") < 0.01))]),
        ("median (longest) frame: {} ({}), {} ({}), {} ({}) ms; XPBD of 44 x 40 with links within {}: {} (",
         [short(sheet("auto", "default", column, size)) for size in ("20x20", "44x40", "100x100") for column in ("ms_median", "ms_max")] +
         [short(sheet(*DUELS[-1], "stretch")), short(sheet(*DUELS[-1]))]),
        ("no contact, one core | {} ms a frame (steady wind {}) |", [blown("gusts"), blown("steady")]),
        ("| {} / {} / {} / {} ms a frame; 100 000 (400 rows) on two cores: {} at best, {} median |",
         [fixed(grid("swing", "16 x 15"), 3)] + [short(grid("swing", size)) for size in ("44 x 40", "112 x 90", "400 x 250")] +
         [short(grid("swing", "400 x 250", "2", column)) for column in ("ms_min", "ms_median")]),
        ("| {} / {} / {} to {} ms a frame, single frames longer (100 000: {} s) |",
         [short(grid("curtain", size)) for size in ("44 x 40", "112 x 90", "400 x 250")] +
         [short(grid("curtain", "400 x 250", column="ms_median")), short(1e-3 * grid("curtain", "400 x 250", column="ms_max"), 1)]),
        ("wind elsewhere {} of the instructions without it, ten winds {}, obstacle beside {},",
         [ratio("wind steady"), ratio("winds: ten"), ratio("obstacle sphere")]),
        ("a robot of thirty links out of reach {} standing and {} moving, since each link's path is a curve ({} of the blown, gathered curtain),",
         [ratio("robot: thirty links"), ratio("robot: thirty links move past a swing"), ratio("robot: thirty links move")]),
        ("drag or damping {}, rest {}; touching itself, flat: {} (", [ratio("drag force"), ratio("rest"), ratio("self-contact", 2)]),
        # -- contact
        ("slowest frame {} / {} ms (ball of 0.15 m at 5 / 20 m/s) and {} / {} (plate edge-on) |",
         [frame("%s through it at %s m/s" % (what, speed), "ms_longest_min") for what in ("ball", "plate") for speed in ("5", "20")]),
        ("| {} / {} / {} ms; {} / {} / {} ms |",
         [fixed(one("contact", "ms_added", scene=scene), decimals) for scene, decimals in (
             ("obstacle out of reach", 3), ("obstacle beside", 3), ("ball in it", 2), ("flat (itself)", 3), ("gathered to 60 % (itself)", 1),
             ("heap on the floor (itself)", 0))]),
        ("| curtain {} ({}), skirt {} ({}), flag {} ({}), sheet {} ({}), parachute {} ({}) ms |",
         [text for scene in ("curtain", "skirt", "flag", "sheet", "parachute") for text in both(scene)]),
        ("with a ball | {} / {}; {} / {}; {} / {} ms |",
         cores("gathered and blown 105 x 96 without contact") + cores("gathered and blown 105 x 96") +
         cores("gathered in steady wind with a ball 105 x 96")),
        ("settled | {} / {}, {} / {} ms; smooth: asleep, bumpy: {} / {} (",
         [text for state in ("smooth; settling", "bumpy; settling", "bumpy; settled") for text in cores("over a mesh 105 x 96; " + state)]),
        ("in overlength | {} ms, {}; {} ms, {}; {} ms, {}; {} ms, {} (", OURS_WITH_BALL + PEERS),
        ("NvCloth's truest setting takes {} ms for {}, its fastest {} for {}.",
         peer("NvCloth", "19200 Hz; phases even/odd") + peer("NvCloth", "60 Hz; phases top-down")),
        ("took up to {} ms;", [short(engine(BALL, "curtain_sim", "default", "ms_99"))]),
        ("of such a ball has {}, longest {} |", [short(one("contact_peers", column, method="auto")) for column in ("ms_median", "ms_longest")]),
        ("#continuous-collision-detection), {} public queries (which: [test/truth](../test/truth/README.md)) | {} missed; false alarms {} % of the handcrafted, none of the cloth's; {} and {} ns",
         [fixed(sum(row["queries"] for row in rows("ccd"))), fixed(sum(row["missed"] for row in rows("ccd"))),
          short(100.0 * sum(row["false_alarms"] for row in HANDCRAFTED) / sum(row["queries"] for row in HANDCRAFTED))] +
         [short(row["ns_min"]) for row in rows("ccd", set="cloth")]),
        # -- the others
        ("before a thin plate | {} of {}, {} of {}, {} of {} held", held()),
        ("everyday scenes', {} % of the wild and {} % of the sudden ones' are\n", told("obstacles excused, of all frames of all")[1:]),
        ("- So of the frames of all obstacles {} % of the", told("obstacles excused, of all frames of all")[:1]),
        ("excused; {}, {} and {} % of the frames", told("frames looked at by brute force")),
        ("- {} of the scenes are of the method `paper`", [str(sum(drawn("of the paper's method")))]),
        ("{} % of the everyday scenes needed the last resort, in {} % of all their substeps, and in {} % of them the cloth was stopped for some "
         "substeps ({} % of all); of the wild ones {} % and {} %.",
         [told(name)[0] for name in ("scenes that needed the last resort", "substeps of the last resort", "scenes in which it did",
                                     "substeps in which the cloth stayed where it was")] +
         [told(name)[1] for name in ("scenes that needed the last resort", "scenes in which it did")]),
        ("median of ten minutes {} to {} ms a frame; longest frame of ten minutes {} to {} ms |",
         [short(pick(soaked(column))) for column in ("median_ms", "longest_ms") for pick in (min, max)]),
        ("| {} instructions a frame, {} us (awake, hanging still: {}, {} us);",
         [ASLEEP, short(1e-3 * per_frame("rest: all sleeps", "active", "ns_min"), 1), AWAKE, short(1e-3 * per_frame("rest: all sleeps", "off", "ns_min"))]),
        ("{} triangles | {} ms of one core ({} with noise, {} with pores),",
         [fixed(one("sensing", "triangles", view=CAMERA)), seen(CAMERA), seen(CAMERA + NOISE), seen(CAMERA + PORES)]),
        ("`~points` of it {} ms more", [seen(CAMERA, "ms_points", 1)]),
    ],
    "docs/compare.md": [
        ("into a curtain, 44 x 40: curtain_sim | {} | {} | {} |", apart("curtain_sim")),
        ("| NvCloth | {} | {} | {} |", apart("NvCloth")),
        ("| Jolt | {} | {} | {} |", apart("Jolt")),
        ("| Bullet | {} | {} | {} |", apart("Bullet")),
        ("blown, 44 x 40, touching itself: curtain_sim | {} ({}) | {} ({}) | {} ({}) |", together(GATHERED, "curtain_sim")),
        ("| NvCloth, touching itself | {} ({}) | {} ({}) |", together(GATHERED, "NvCloth", (0.1, 0.01))),
        ("| Jolt, which does not touch itself | {} ({}) | {} ({}) |", together(GATHERED, "Jolt", (0.1, 0.01))),
        ("| Bullet, touching itself by clusters | {} ({}) |", together(GATHERED, "Bullet", (0.1,))),
        ("blown, 105 x 96, touching itself: curtain_sim | {} ({}) | {} ({}) | {} ({}) |", together(FINE, "curtain_sim")),
        ("| NvCloth, 105 x 96 | {} ({}) | {} ({}) |", together(FINE, "NvCloth", (0.1, 0.01))),
        ("| Jolt, 105 x 96, which does not touch itself | {} ({}) |", together(FINE, "Jolt", (0.1,))),
        ("without that, curtain_sim takes {} ms.", [short(engine(GATHERED, "curtain_sim", "default; without self-contact; five waves"))]),
        ("NvCloth takes {} ms for them, with an overlength of {};",
         [short(engine(FINE, "NvCloth", QUICK)), short(engine(FINE, "NvCloth", QUICK, "stretch_max"))]),
        ("takes it {} ms, curtain_sim {} ms (", [took("XPBD", 1e-3), took("auto", 1e-3)]),
        ("off by less than 10 mm: {} ms.", [took("btSoftBody", 1e-2)]),
    ],
    "docs/layers.md": [
        ("cost {} of what they cost alone", [ratio("layers: each by itself", 2, "active")]),
        ("with `contact.self` {} times as much, while one cloth that is flat costs {}:", [ratio("layers: self-contact", 1), ratio("self-contact", 2)]),
    ],
    "docs/method.md": [
        ("No misses on {} public queries with exact answers, {} and {} ns a query",
         [fixed(sum(row["queries"] for row in rows("ccd")))] + [short(row["ns_min"]) for row in rows("ccd", set="cloth")]),
        ("| swing, 1760 nodes | 27 mm | {} mm |", [short(1e3 * one("work_precision", "error_m", scene="swing", method="auto", setting="default"))]),
        ("A sleeping curtain costs {} instructions a frame, one that is awake and hangs still {}.", [ASLEEP, AWAKE]),
    ],
    "docs/sensors.md": [
        ("takes {} ms of one core, of which the hierarchy of boxes, rebuilt for each view, is {}; its points {} ms more; with noise {}, with pores {};",
         [seen(CAMERA), seen(CAMERA, "ms_hierarchy"), seen(CAMERA, "ms_points", 1), seen(CAMERA + NOISE), seen(CAMERA + PORES)]),
        ("a lidar of 64 x 2048 rays {}; 20 000 points all round {} (",
         [seen("lidar 64 x 2048"), seen("all round; 10 000 points a m^2", "ms_points", 1)]),
    ],
}


def unnamed():
    """Pages that do not name the processor which the studies were measured on."""
    known = sorted({row["processor"] for row in rows("stamps")} - {"not noted"})
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
        sys.exit("\n".join(wrong) + "\ndocs/make_figures.py writes what the tables have, and has the text around each figure")


if __name__ == "__main__":
    main()
