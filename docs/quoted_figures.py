# SPDX-License-Identifier: BSD-3-Clause
"""What pages quote: by page, a text as it stands there once, with {} for each figure, and where these are from. If you change such a
text in a page, change it here as well."""
import math
import statistics

from figure_text import fixed, short, within
from quoted_random import drawn, held, part, percents, pulled_apart, rarity, told
from quoted_tables import (ASLEEP, AWAKE, BALL, BOUNDS, BUDGETS, CAMERA, COARSE, DROPPED, DUELS, FINE, GATHERED, HANDCRAFTED, HOUSEHOLD,
                           NOISE, PACKED, PORES, PROBLEMS, RIVALS, SHAKEN, STRAIGHT, apart, at, between, blown, both, clear, cleared,
                           clears, coarser, cores, demo, demo_in_node, drape, drapes, drifts, early, energy, engine, falls_asleep,
                           fastest, folds, frame, grid, hurried, in_real_time, is_light, keeps_straining, kept, largest, least,
                           megabytes, most, nearest_nets, one, pair, per_frame, ratio, refined, rivalled, rows, seen, share, sheet,
                           soaked, stepped, strains, swing, together, told_by, took, tortures, touched, tried, unhurried, waits, whole)

FIGURES = {
    "README.md": [
        ("below 1 mm (below 0.01 mm) | {} ms (`leapfrog4`: {} ms); the fastest rival {} ms ({} ms) |",
         [took("auto", 1e-3), took("leapfrog4", 1e-5), took(RIVALS, 1e-3), took(RIVALS, 1e-5)]),
        ("median (99th percentile, longest) | {} ({}, {}) ms, each the lower of two runs; without contact the median is {} ms.",
         both("curtain") + [frame("curtain", "ms_longest_min"), blown("gusts")]),
        ("fastest setting with links within 1e-3 | this engine {} ms, NvCloth {}, Jolt {}, Bullet {}; with links within 1e-2: {}, {}, {}, {} ms.",
         [apart(name, (bound,))[0] for bound in (1e-3, 1e-2) for name in ("curtain_sim", "NvCloth", "Jolt", "Bullet")]),
        ("touches itself: median (99th percentile) of a frame | {} ({}) ms;", [short(engine(GATHERED, "curtain_sim", "default", column)) for column in ("ms_median", "ms_99")]),
        ("touches-itself) {} ({}) ms limp, {} ({}) ms of cotton |",
         [short(one("gathered", column, scene=scene, method="auto", tolerance="0.001")) for scene in ("limp", "cotton")
          for column in ("ms_median", "ms_99")]),
        ("| this engine {} ms, links within {}, layers 4 mm apart; NvCloth {} ms, links within {}, layers {} mm apart |",
         [short(engine(GATHERED, "curtain_sim", "default")), within(engine(GATHERED, "curtain_sim", "default", "stretch_max"))] +
         cleared(GATHERED, "NvCloth", 1e-2) + [
          clear(GATHERED, "NvCloth", 1e-2)["setting"].split("at ")[1].split(".")[0]]),
        ("brute force, on {} to {} % of the frames), no unexplained gain of energy where it can be judged | {} of {} hold. But in {} to {} % of the scenes,",
         percents("frames checked by brute force") +
         [fixed(sum(drawn(name))) for name in ("hold", "scenes")] +
         percents("scenes that needed the last resort")),
        ("the longest frame of ten minutes took {} ms in the median and {} ms at worst,", [short(statistics.median(soaked("longest_ms"))), within(max(soaked("longest_ms")))]),
        ("in {} of {} trials it had not left after 5 s.", tried("appears", lambda row: row["outside"] == 0)),
        ("8 substeps | {} of what it can lose (`leapfrog4`: {}); [automatic", [energy("auto"), energy("leapfrog4")]),
        ("a curtain asleep | {} instructions a frame |", [ASLEEP]),
    ],
    "docs/accuracy.md": [
        ("| PBD | {} | {} | {} | {} |", [touched(problem, "PBD") for problem in PROBLEMS]),
        ("| `auto` | {} | {} | {} | {} |\n  | `auto` at its defaults | {} | {} | {} | {} |",
         [touched(problem, "auto") for problem in PROBLEMS] +
         [short(one("closed_forms", "ms_median", problem=problem, method="auto", setting="default")) for problem in PROBLEMS]),
        ("PBD is off by {} at best, `auto` by {} in {} ms with one substep and by {} in {} ms at its defaults.",
         [short(least("capstan", "PBD")["error"]), short(least("capstan", "auto")["error"], 1), short(least("capstan", "auto")["ms_median"])] +
         [short(one("closed_forms", column, problem="capstan", method="auto", setting="default")) for column in ("error", "ms_median")]),
    ] + [
        ("| %s | {} %% | {} %% | {} %% | {} %% |" % fabric, drapes(fabric)) for fabric in ("limp", "between", "stiff")
    ] + [
        # -- error against computing time
        ("| **`auto`**, `leapfrog` | **{} ms** | **{}** ({} mm) | **{}** | {} | {} |",
         [took("auto", 1e-2), took("auto", 1e-3), short(1e3 * swing("auto", 1e-3, "error_m"))] + [took("auto", bound) for bound in BOUNDS[2:]]),
        ("| `leapfrog4` | {} | {} ({} mm) | {} | **{}** | **{}** |",
         [took("leapfrog4", 1e-2), took("leapfrog4", 1e-3), short(1e3 * swing("leapfrog4", 1e-3, "error_m"))] +
         [took("leapfrog4", bound) for bound in BOUNDS[2:]]),
        ("| `implicit` (stable, damps) | {} |", [took("implicit", 1e-2)]),
        ("| `paper` (Cheng 2000, Sect. 3) | {} (64 substeps) |", [took("paper", 1e-2)]),
        ("a second of the swing is {} mm at its 16 substeps", [short(1e3 * one("work_precision", "error_m", scene="swing", method="paper", setting="default"))]),
        ("symplectic Euler | {} | {} | {} | {} | – |", [took("symplectic Euler", bound) for bound in BOUNDS[:4]]),
        ("Runge–Kutta 4 | {} | {} | {} | {} | – |", [took("Runge-Kutta 4", bound) for bound in BOUNDS[:4]]),
        ("Baraff–Witkin | {} |", [took("Baraff-Witkin", 1e-2)]),
        ("| PBD / XPBD | {} / {} | {} / {} |", [took(method, bound) for bound in BOUNDS[:2] for method in ("PBD", "XPBD")]),
        ("btSoftBody (double) | {} |", [took("btSoftBody", 1e-2)]),
        ("`auto` takes {} ms for {} mm.\n",
         [short(one("work_precision", "ms_min", scene="swing", method="auto", setting="default")),
          short(1e3 * one("work_precision", "error_m", scene="swing", method="auto", setting="default"))]),
    ] + [
        ("| %s | {} | {} um | {} |" % name,
         [short(sheet(method, setting)), short(1e6 * early(method, setting)), short(sheet(method, setting, "stretch"))])
        for name, (method, setting) in zip(("`auto`", "XPBD, 256 substeps", "`auto`, 16 substeps", "XPBD, 1024 substeps"), DUELS)
    ] + [
        ("agrees with it to {} um at", [short(1e6 * early(*DUELS[-1]))]),
        ("XPBD with 128 substeps is off by {} mm after {} ms of computing, PBD after {} ms.",
         [short(1e3 * coarser("XPBD", "error_m")), short(coarser("XPBD", "ms_min")), short(coarser("PBD", "ms_min"))]),
        ("XPBD with 64 substeps takes {} ms a frame and is off by {} mm after 0.1 s, but lets links be {} of their length too long in the snap; `auto` takes "
         "{} ms, is off by {} mm, and keeps links within {}.",
         [short(sheet(*COARSE, size="100x100")), short(1e3 * early(*COARSE, size="100x100")), short(sheet(*COARSE, "stretch", "100x100"), 3),
          short(sheet("auto", "default", size="100x100")), short(1e3 * early("auto", "default", "100x100")),
          within(sheet("auto", "default", "stretch", "100x100"))]),
        ("energy of its start within {} of what it could lose", [energy("auto").lstrip("-")]),
        ("at its 16 substeps, `auto`'s {} mm;",
         [short(1e3 * one("work_precision", "error_m", scene="swing", method="auto", setting="default"))]),
        ("stretch by up to {} of their length in the curtain with its ball and {} in the flag",
         [short(whole(name, "paper", column="stretch_max")) for name in ("curtain", "flag without self-contact")]),
        ("without self-contact | {} ({}) | {} ({}) | under", pair("flag without self-contact")),
        ("1760 nodes, without contact | {} ({}) | {} ({}) | 10 |", pair("curtain without contact")),
        ("the same with ball and self-contact | {} ({}) | {} ({}) | |", pair("curtain")),
        ("dropped by two corners, links within {} | none (median {} ms) | {} ms | | |" + BUDGETS,
         [within(largest("whole_scenes", "stretch_max", scene=DROPPED))] + unhurried(DROPPED) + hurried(DROPPED)),
        ("| `curtain` with ball and self-contact | none (median {} ms) | {} ms | | |" + BUDGETS, unhurried("curtain") + hurried("curtain")),
        # -- exactness
        ("rods to within {} of themselves where nothing touches", [most("rods of paper, off by")]),
        ("tried gained or lost at least {} of that, position-based and implicit methods lost {} to {}.",
         drifts("symplectic Euler", "Runge-Kutta 4")[:1] + drifts("PBD", "XPBD", "Baraff-Witkin", "btSoftBody", "implicit")),
        ("minimum of their energy: {} of {} are nearer", nearest_nets()),
        ("| true error {} to {} times the published one", between("true error over the published")),
        ("which is turned | off by {} of the sheet's weight;", [most("wrench of a sheet on a link, off by")]),
        ("| differ by {}, {}, {} of the sum; `leapfrog4` {}, `implicit` {} |",
         [most("blow %s, off by" % blow) for blow in ("from below", "aslant", "spinning", "leapfrog4", "implicit")]),
        ("nodes and links keep at least {} mm on", ["%.1f" % (math.floor(10.0 * kept("padding of 20 mm, kept [mm]")[0]) / 10.0)]),
        ("whose halves collide | kept to {} |", [most("momentum of colliding halves, off by")]),
        ("RMS of its nodes' speeds at most {}, {} mm/s |", [most("at rest on a %s, speed [mm/s]" % what) for what in ("sphere", "table")]),
        ("30 to 240 Hz | {} to {} of the closed form, energy {} of the motion's |",
         share("scarf, of the closed form") + between("scarf, energy over the motion's")[:1]),
        ("loads of 4 to 75 g | {} to {} of the closed form |", share("Atwood, of the closed form")),
        ("loads of 10 g to 5 kg | force on the bar {} to {} of the exact one |", share("force on the bar, of the exact one")),
        ("none driven | within a frame energy rises by {} m g L at most; it is never above that of the start by more than {} m g L |",
         [most("sliding strips, a frame's rise"), most("sliding strips, above the start")]),
        ("gained energy with an earlier engine | within a frame energy rises by {} m g L at most |", [most("sheets on rough meshes, a frame's rise")]),
        ("dropped flat, one core, links within {} at every frame:",
         [within(max(sheet("auto", "default", "stretch", size) for size in ("20x20", "44x40", "100x100")))]),
        ("| {}, {}, {} of 20 124 triangles,", [fixed(kept("triangles from %d m" % far)[0]) for far in (1, 4, 16)]),
        ("no rod gives way) | off by {}, {}, {}, of warp or weft |", [most("elastica of %d, off by" % load) for load in (1, 5, 8)]),
        ("order in the rod's length, 20 to 40 rods | {}, {}, {}.", [told_by("elastica of %d, order" % load, 3) for load in (1, 5, 8)]),
        ("25, 50, 75 rods: frequency | off by {}, {}, {} |", [most("clamped strip, mode %d, off by" % mode) for mode in (1, 2, 3)]),
        ("cotton broadcloth | {} ± {} %, {} | {} ± {} %, {} | | 82.9 % |\n| the same without friction | {} ± {} %, {} | {} ± {} %, {} |",
         [text for cloth in ("cotton broadcloth", "cotton broadcloth without friction") for nodes in ("24", "48") for text in drape(cloth, nodes)]),
        ("polyester faille | {} ± {} %, {} | {} ± {} %, {} | | 28.3 % |\n| the same without friction | {} ± {} %, {} | {} ± {} %, {} |",
         [text for cloth in ("polyester faille", "polyester faille without friction") for nodes in ("24", "48") for text in drape(cloth, nodes)]),
    ] + [
        ("| %s | {} ± {} %%, {} | {} ± {} %%, {} | %s" % (cloth, "{} ± {} %, {} |" if len(grids) > 2 else "| "),
         [text for nodes in grids for text in drape(cloth, nodes)])
        for cloth, grids in [("cotton_voile", ("24", "48")), ("linen", ("24", "48", "96")), ("silk", ("24", "48")),
                             ("polyester", ("24", "48", "96")), ("velvet", ("24", "48")), ("canvas", ("24", "48"))]
    ] + [
        ("| %s, %s | {} %%" % (cloth, words), [fixed(one("drape", "coefficient", cloth=cloth))]) for cloth, words in HOUSEHOLD
    ] + [
        ("| {} limp square sheets that fall on", tried("drapes")[1:]),
        ("[trials](bench/trials.csv)) | {} asleep within 10 s ({} of the {} up to 30 x 30) |",
         tried("drapes", falls_asleep)[:1] + tried("drapes", falls_asleep, lambda row: row["rows"] <= 30)[:1] +
         tried("drapes", lambda row: row["rows"] <= 30)[:1]),
        ("| 0 | {} mm ({} after 4 s) | {} | {} |", folds("0", "depth_mm", "depth_4s_mm", "wefts", "substeps")),
        ("| 1 | {} mm | {} | {} |", folds("1", "depth_mm", "wefts", "substeps")),
        ("| 10 | {} mm; {} with implicit | {} | {}; {} |",
         folds("10", "depth_mm") + folds("10", "depth_mm", method="implicit") + folds("10", "wefts", "substeps") +
         folds("10", "substeps", method="implicit")),
        ("| 100 | {} mm | {} | {} |", folds("100", "depth_mm", "wefts", "substeps")),
        ("Of {} boxes of 0.1 to 0.4 m, put at random into a hanging curtain, the cloth had left {} within 5 s ([trials](bench/trials.csv)). {} of the others still",
         tried("appears", lambda row: row["outside"] == 1)[::-1] + tried("appears", lambda row: row["outside"] == 0 and row["nodes_inside"] == 0)[:1]),
        ("- In {} of {} random scenes the obstacle waited:", tried("waits", lambda row: row["waited_s"] > 0)),
        ("In {} of these it waited for more than 0.02 s, up to {} of the 4 s, {} times while it was lifted against cloth that pins hold. In {} of the scenes",
         tried("waits", waits)[:1] + [short(max(row["waited_s"] for row in rows("trials", family="waits")))] +
         tried("waits", waits, lambda row: "lifts" in row["what"])[:1] + tried("waits", lambda row: row["pierced"] > 0)[:1]),
        ("(`momentum_cut`): {} of {} random loads did, of up to {} times the cloth's weight",
         tried("loads", strains) + [fixed(max(row["times_the_cloth"] for row in rows("trials", family="loads")))]),
        ("{} still did in their fourth second, of {} times the cloth and more. Of the loads below 5 times the cloth it was {} of {}.",
         tried("loads", keeps_straining)[:1] + [fixed(min(row["times_the_cloth"] for row in rows("trials", family="loads") if keeps_straining(row)))] +
         tried("loads", strains, is_light)[:1] + tried("loads", is_light)[:1]),
        ("warp and of the weft (36 x 36 nodes): within {} mm,", [most("rim of isotropic cloth, warp and weft apart [mm]")]),
        ("folds it starts in](method.md#shear), {} mm deep at rest, and is asleep after {} s.",
         [told_by("gathered cloth with shear, folds at rest [mm]"), told_by("gathered cloth with shear, asleep after [s]")]),
        ("that lies on the cloth | off from the friction (why is not known) by {} to {} |",
         between("towel over tablecloth, pull over weight less friction")),
        ("| [random scenes](stress/random.md) with several cloths | {} of {} hold |", part("layers")),
        ("did not sleep, within {} frames", [most("woken cloth, late by frames")]),
        ("its slowest frames take {} to {} ms (105 x 96", sorted(
            frame("over a mesh 105 x 96; %s; settling; one core" % mesh, "ms_longest_min") for mesh in ("smooth", "bumpy"))),
        ("move at up to {} mm/s RMS after 3 s.", [most("at rest on a smaller table, speed [mm/s]")]),
        ("up to {} of m g H more energy than it had (with `implicit` {}),", [tortures(*STRAIGHT, *SHAKEN, method=method) for method in ("auto", "implicit")]),
        ("touches itself has {} of the kinetic energy in short waves that the finest steps give, with `implicit` {} of it",
         [short(one("gathered", "fine", scene="limp", method=method, substeps="0", tolerance="0.001") /
                one("gathered", "fine", scene="limp", method="leapfrog", substeps="128")) for method in ("auto", "implicit")]),
        ("(a whip: {}); with `leapfrog4` up to {} in the [stress tests](stress/README.md). It may also lose energy and regain it ({} of m g H",
         [most("a whip's energy, most above the start"), tortures("no air", method="leapfrog4"),
          between("a whip's energy, most below the start")[0].lstrip("-")]),
        ("within {} (`auto`; `leapfrog` {}; {} nets)",
         [within(largest("nets", "relative_error", method="auto")), within(largest("nets", "relative_error", method="leapfrog")),
          str(len(rows("nets", method="auto")))]),
        ("against the closed form for the model's wind | within {} of its length |", [within(largest("wind", "tip_error_over_L", method="auto"), 1)]),
        ("five eigenfrequencies | within {} (`leapfrog`, 8 substeps), {} (`leapfrog4`), {} with the default substeps |",
         [within(largest("modes", "relative_error", method=method, setting=setting))
          for method, setting in (("leapfrog", "substeps 8"), ("leapfrog4", "substeps 8"), ("auto", "default"))]),
        ("8 substeps | {} of what it can lose, off by {} at most until then (`leapfrog4`: {}); automatic",
         [energy("auto"), within(largest("energy", "drift", method="auto", setting="substeps 8")), energy("leapfrog4")]),
        ("errors fall from 10 to 80 rods by a factor of {} to {}, not", [fixed(pick(refined())) for pick in (min, max)]),
        # -- speed
        ("takes at most {} of the fastest rival's time. At 100 000 nodes it takes {} ms, symplectic Euler {} and XPBD {}, which leave "
         "their links off by {} and {}; ours are within {}. Of these settings of the rivals, the fastest with links within 0.01 takes {} ms",
         [within(max(grid("swing", size) / min(at(size, rival) for rival in RIVALS) for size in ("16 x 15", "44 x 40", "112 x 90"))),
          short(grid("swing", "400 x 250")), short(at("400 x 250", "symplectic Euler")), short(at("400 x 250", "XPBD")),
          short(at("400 x 250", "symplectic Euler", "stretch")), short(at("400 x 250", "XPBD", "stretch")),
          within(grid("swing", "400 x 250", column="stretch")),
          short(min(at("400 x 250", rival) for rival in RIVALS if at("400 x 250", rival, "stretch") < 0.01))]),
        ("median (longest) frame: {} ({}), {} ({}), {} ({}) ms; XPBD of 44 x 40 with links within {}: {} (",
         [short(sheet("auto", "default", column, size)) for size in ("20x20", "44x40", "100x100") for column in ("ms_median", "ms_max")] +
         [within(sheet(*DUELS[-1], "stretch")), short(sheet(*DUELS[-1]))]),
        ("no contact, one core | {} ms a frame (steady wind {}) |", [blown("gusts"), blown("steady")]),
        ("| {} / {} / {} / {} ms a frame; 100 000 (400 rows) on two cores: {} (lowest and median of the runs: {}) |",
         [fixed(grid("swing", "16 x 15"), 3)] + [short(grid("swing", size)) for size in ("44 x 40", "112 x 90", "400 x 250")] +
         [short(grid("swing", "400 x 250", "2", column)) for column in ("ms_min", "ms_median")]),
        ("| {} / {} / {} to {} ms a frame (medians; of 100 000 nodes, of the {} frames that 3 s of computing allow, the longest {} s) |",
         [short(grid("curtain", size)) for size in ("44 x 40", "112 x 90", "400 x 250")] +
         [short(grid("curtain", "400 x 250", column="ms_median")), fixed(grid("curtain", "400 x 250", column="frames")), short(1e-3 * grid("curtain", "400 x 250", column="ms_max"), 1)]),
        ("wind that blows elsewhere {}, ten such winds {}; obstacle beside the cloth {};",
         [ratio("wind steady"), ratio("winds: ten"), ratio("obstacle sphere")]),
        ("a robot of thirty links out of reach {} standing, {} moving (each link's path is a curve), {} moving beside the blown, gathered curtain;",
         [ratio("robot: thirty links"), ratio("robot: thirty links move past a swing"), ratio("robot: thirty links move")]),
        ("drag or damping {}; sleep (`rest_speed`) {}; self-contact of one flat cloth {}, of two in layers {} |",
         [ratio("drag force"), ratio("rest"), ratio("self-contact", 2), ratio("layers: self-contact", 1)]),
        # -- contact
        ("slowest frame, in other scenes: {} / {} ms (ball of radius 0.15 m at 5 / 20 m/s) and {} / {} (plate edge-on) |",
         [frame("%s through it at %s m/s" % (what, speed), "ms_longest_min") for what in ("ball", "plate") for speed in ("5", "20")]),
        ("ball in the cloth | {}; {}; {} ms |",
         [fixed(one("contact", "ms_added", scene=scene), decimals)
          for scene, decimals in (("obstacle out of reach", 3), ("obstacle beside", 3), ("ball in it", 2))]),
        ("crumpling heap | {}; {}; {} ms |",
         [fixed(one("contact", "ms_added", scene=scene), decimals)
          for scene, decimals in (("flat (itself)", 3), ("gathered to 60 % (itself)", 1), ("heap on the floor (itself)", 0))]),
        ("| curtain {} ({}), skirt {} ({}), flag {} ({}), sheet {} ({}), parachute {} ({}) ms |",
         [text for scene in ("curtain", "skirt", "flag", "sheet", "parachute") for text in both(scene)]),
        ("gathered and blown, without contact | {} ({}) ms |", cores("gathered and blown 105 x 96 without contact")),
        ("in a steady wind, with a ball | {} ({}) ms; {} ({}) ms |",
         cores("gathered and blown 105 x 96") + cores("gathered in steady wind with a ball 105 x 96")),
        ("smooth ball; bumpy one | {} ({}) ms; {} ({}) ms |\n| settled there | smooth: asleep; bumpy: {} ({}) ms,",
         [text for state in ("smooth; settling", "bumpy; settling", "bumpy; settled") for text in cores("over a mesh 105 x 96; " + state)]),
        ("| {} ms a frame (99 %: {}), links within {};",
         [short(engine(BALL, "curtain_sim", "default", column)) for column in ("ms_median", "ms_99")] +
         [within(engine(BALL, "curtain_sim", "default", "stretch_max"))]),
        ("of such a ball has {}, longest {} |", [short(one("contact_peers", column, method="auto")) for column in ("ms_median", "ms_longest")]),
        ("#continuous-collision-detection), {} public queries (which: [test/truth](../test/truth/README.md)) | {} missed; false alarms {} % of the handcrafted, none of the cloth's; {} and {} ns",
         [fixed(sum(row["queries"] for row in rows("ccd"))), fixed(sum(row["missed"] for row in rows("ccd"))),
          short(100.0 * sum(row["false_alarms"] for row in HANDCRAFTED) / sum(row["queries"] for row in HANDCRAFTED))] +
         [short(row["ns_min"]) for row in rows("ccd", set="cloth")]),
        # -- the others
        ("before a thin plate | {} of {}, {} of {}, {} of {} held", held()),
        ("This leaves out {} % of the checks (one for each obstacle and frame) of everyday scenes, {} % of wild and {} % of sudden ones.",
         told("checks for piercing that are excused (one for each obstacle and frame)")),
        ("- Brute force checks {}, {} and {} % of the frames:", told("frames checked by brute force")),
        ("- Scenes that did not hold when they were drawn: {}. So at most one in {} of such", [str(sum(drawn("scenes")) - sum(drawn("hold"))), rarity()]),
        ("- {} of the scenes are of the method `paper`", [str(sum(drawn("of the paper's method")))]),
        ("could pull links apart, the worst was off by {}. In {} scenes hands pulled links further, by up to {} times",
         [short(max(float(text) for text in told("`paper` left out: worst link of a scene that holds, where no hand may have pulled links apart")), 3),
          str(sum(drawn("scenes whose worst link is off by more, where a hand may have pulled links apart"))), pulled_apart()]),
        ("in {} everyday and {} sudden scenes).",
         told("scenes run again in finer steps, since their energy rose by more")[::2]),
        ("judged in {} % of the frames of everyday scenes, in {} % of sudden ones; in {} everyday and {} sudden scenes in no frame.",
         told("`paper` left out: frames whose energy is judged")[::2] + told("scenes in which the energy is judged in no frame")[::2]),
        ("A rise counts above {} (everyday) or {} (sudden,", told("a rise of the energy counts above")[::2]),
        ("5 to 1000 Hz; up to {} nodes)", [fixed(drawn("largest scene, nodes")[1])]),
        ("{} % of the everyday scenes needed the last resort, in {} % of all substeps of everyday scenes; in {} % of the scenes the cloth was stopped ({} % of "
         "the substeps). "
         "Of the wild scenes {} % needed the last resort and in {} % the cloth was stopped. In {} % of the everyday scenes and {} % of the wild ones",
         [told(name)[0] for name in ("scenes that needed the last resort", "substeps of the last resort", "scenes with such substeps",
                                     "substeps in which the cloth stayed where it was")] +
         [told(name)[1] for name in ("scenes that needed the last resort", "scenes with such substeps")] +
         told("scenes with more than half of their substeps of the last resort")[:2]),
        ("of the last resort, and in {} and {} % the cloth was stopped in more than half",
         told("scenes in which the cloth stayed where it was in more than half of the substeps")[:2]),
        ("an everyday one has {} nodes and {} frames (medians)", [told(name)[0] for name in ("nodes, median", "frames, median")]),
        ("median of ten minutes {} to {} ms a frame; longest frame of ten minutes: {} ms in the median, above 80 ms in {} of {} ({} ms at worst),",
         [short(pick(soaked("median_ms"))) for pick in (min, max)] +
         [short(statistics.median(soaked("longest_ms"))), str(sum(ms > 80 for ms in soaked("longest_ms"))), str(len(soaked("longest_ms"))),
          within(max(soaked("longest_ms")))]),
        ("| {} instructions a frame, {} us (awake, hanging still: {}, {} us);",
         [ASLEEP, short(1e-3 * per_frame("rest: all sleeps", "active", "ns_min"), 1), AWAKE, short(1e-3 * per_frame("rest: all sleeps", "off", "ns_min"))]),
        ("without subscribers: rospy {}, roscpp {}; another process reads `~state`: {}, {}. One at a time: {}, {}; {}, {} |",
         [stepped(client, listeners, batch) for batch in (10, 1) for listeners in (0, 1) for client in ("rospy", "roscpp")]),
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
        ("| NvCloth, touching itself | {} ({}) | {} ({}) | {} ({}) |", together(GATHERED, "NvCloth")),
        ("| NvCloth, nothing crosses | {} (0) | {} (0) | {} (0) |", clears(GATHERED, "NvCloth")),
        ("| Jolt, which does not touch itself | {} ({}) | {} ({}) |", together(GATHERED, "Jolt", (0.1, 0.01))),
        ("| Bullet, touching itself by clusters | {} ({}) | {} ({}) |", together(GATHERED, "Bullet", (0.1, 0.01))),
        ("| Bullet, nothing crosses | {} (0) |", clears(GATHERED, "Bullet", (0.1,))),
        ("blown, 105 x 96, touching itself: curtain_sim | {} ({}) | {} ({}) | {} ({}) |", together(FINE, "curtain_sim")),
        ("| NvCloth, 105 x 96 | {} ({}) | {} ({}) |", together(FINE, "NvCloth", (0.1, 0.01))),
        ("| NvCloth, 105 x 96, nothing crosses | {} (0) | {} (0) |", clears(FINE, "NvCloth", (0.1, 0.01))),
        ("| Jolt, 105 x 96, which does not touch itself | {} ({}) |", together(FINE, "Jolt", (0.1,))),
        ("| Bullet, 105 x 96, touching itself by clusters | {} ({}) |", together(FINE, "Bullet", (0.1,))),
        ("gathered curtain of 44 x 40 ({} ms, links off by {}; curtain_sim {} ms, {})", rivalled(GATHERED, "NvCloth", 0.01) + rivalled(GATHERED, "curtain_sim", 0.01)),
        ("that was tried: {} times on the gathered curtain of", [fixed(fastest(GATHERED, "NvCloth", 1e-3)["ms_median"] / fastest(GATHERED, "curtain_sim", 1e-3)["ms_median"])]),
        ("With the ball it is {} times, too.", [fixed(fastest(BALL, "NvCloth", 1e-3)["ms_median"] / fastest(BALL, "curtain_sim", 1e-3)["ms_median"])]),
        ("without self-contact curtain_sim takes {} ms ({} at 105 x 96).", [short(engine(scene, "curtain_sim", "default; without self-contact; five waves")) for scene in (GATHERED, FINE)]),
        ("99 % of its frames take up to {} ms (median {}) and at 105 x 96 up to {} ({}); those of NvCloth, at its fastest setting without crossings within "
         "a tenth, {} ({}) and {} ({}).",
         [short(engine(scene, "curtain_sim", "default", column)) for scene in (GATHERED, FINE) for column in ("ms_99", "ms_median")] +
         [short(clear(scene, "NvCloth", 0.1)[column]) for scene in (GATHERED, FINE) for column in ("ms_99", "ms_median")]),
        ("Within 16.7 ms NvCloth keeps their links within {} ({} edges cross), or within {} with nothing crossing; in {} ms it keeps them within {} with",
         in_real_time(FINE, "NvCloth") + cleared(FINE, "NvCloth", 0.2)),
        ("Ours is {} mm (limp) and {} mm (a light cotton) off after a second", [short(1e3 * one("gathered", "apart_60_m", scene=scene, method="auto", tolerance="0.001")) for scene in ("limp", "cotton")]),
        ("Ours with self-contact takes {} ms from five waves.", [short(engine(GATHERED, "curtain_sim", "default; five waves"))]),
        ("XPBD needs {} ms for a second of a swinging sheet with an error below 1 mm, curtain_sim {} ms ([work and precision](bench/README.md#work-and-precision)). "
         "With half as many substeps XPBD just misses 1 mm ({} mm, {} ms).",
         [took("XPBD", 1e-3), took("auto", 1e-3), short(1e3 * coarser("XPBD", "error_m")), short(coarser("XPBD", "ms_min"))]),
        ("curtain_sim takes {} ms a frame and is off by {} um after 0.1 s, XPBD {} ms and {} um (",
         [text for method, setting in DUELS[:2] for text in (short(sheet(method, setting)), short(1e6 * early(method, setting)))]),
        ("takes {} ms for a second of the swing, off by less than 10 mm.", [took("btSoftBody", 1e-2)]),
    ],
    "docs/bags.md": [
        ("while the curtain moves | {} | {} | {} |", [megabytes("~state", how) for how in PACKED]),
        ("starts rviz | {} | {} | {} |", [megabytes("~state with folds", how, 3) for how in PACKED]),
        ("a message of `~markers` | {} | {} | {} |", [megabytes("~markers", how) for how in PACKED]),
        ("a second grows by {} MB/s with lz4",
         [fixed(1e-6 * (60 * one("file_sizes", "bytes", what="~state with folds", compression="lz4") + 10 * one("file_sizes", "bytes", what="~markers", compression="lz4")))]),
        ("301 frames) are {} MB.", [megabytes("glTF of 10 s of curtain")]),
    ],
    "docs/batch.md": [
        ("After 10 s it has {} MB for `curtain.yaml` (1760 nodes), and {} MB for", [megabytes("checkpoint of 10 s of " + scene) for scene in ("curtain", "flag")]),
    ],
    "docs/many.md": [
        ("%s | 1 | {} ms | {} %% of a core | |\n| the same | 8 | {} ms | {} %% of a core | {} times |" % how,
         [short(one("many_cost", column, at_once=at_once, curtains=count))
          for count, columns in (("1", ("ms_per_frame", "idle_percent")), ("8", ("ms_per_frame", "idle_percent", "times_one"))) for column in columns])
        for how, at_once in (("in turn", "0"), ("at once", "1"))
    ],
    "docs/rviz.md": [
        ("of which with new cloth | {}, {} | {}, {} |",
         [fixed(one("rviz_frames", column, configuration=name)) for name in ("curtain.rviz", "markers.rviz")
          for column in ("frames_per_s", "new_cloth_per_s")]),
        ("computing time of a picture | {} ms | {} ms |", [short(one("rviz_frames", "ms_computing", configuration=name)) for name in ("curtain.rviz", "markers.rviz")]),
    ],
    "docs/python.md": [
        ("| `curtain_batch` | {} |\n| `step(n)`, called once | {} |\n| `step()` | {} |",
         [fixed(one("python_rate", "frames_per_s", variant=name)) for name in ("curtain_batch", "step(n)", "step()")]),
        ("with `positions` held, or copied | {}, {} |",
         [fixed(one("python_rate", "frames_per_s", variant=name)) for name in ("and positions held", "positions copied every frame")]),
        ("with `positions` and `velocities` held | {} |", [fixed(one("python_rate", "frames_per_s", variant="and velocities held"))]),
        ("in two threads make {} frames a second by the clock together, one alone {},",
         [fixed(one("python_rate", "frames_per_s", variant="%d simulators in threads" % count)) for count in (2, 1)]),
    ],
    "docs/sweeps.md": [
        ("\n".join(["| {} | {} | {} | {} |"] * 4),
         [text for row in rows("sweeps") for text in (short(row["run_s"]), fixed(row["jobs"]), fixed(row["ratio"], 2), fixed(row["ratio_of_computing_times"], 2))]),
        ("the table and the picture take another {} s at most", [fixed(max(row["start_and_table_s"] for row in rows("sweeps")), 1)]),
    ],
    "docs/gallery.md": [
        (row % name, figures(name))
        for row, figures in (("| `%s` | {}, {}, {} | {} | {} | {}, {} | {} |", demo), ("| `%s` | {}, {}, {} | {}, {} | {} | {}, {} | {} |", demo_in_node))
        for name in ("window", "theatre", "hospital", "shower", "layers", "strip_door", "flag", "skirt", "parachute", "sheet", "laundry", "drone",
                     "curtain", "robot_curtain", "robot_door")
    ],
    "docs/node.md": [
        ("it takes {} ms for a sphere and 44 x 40 nodes, {} ms for a mesh of 50 000 triangles, {} ms for that mesh and 105 x 96 nodes",
         [short(one("obstacle_distance", "ms", shape=shape, rows=count)) for shape, count in (("sphere", "44"), ("mesh", "44"), ("mesh", "105"))]),
    ],
    "docs/layers.md": [
        ("cost {} of what they cost alone", [ratio("layers: each by itself", 2, "active")]),
        ("`contact.self` makes them {} times as expensive, and one flat cloth {} times.", [ratio("layers: self-contact", 1), ratio("self-contact", 2)]),
    ],
    "docs/method.md": [
        ("No misses on {} public queries with exact answers, {} and {} ns a query",
         [fixed(sum(row["queries"] for row in rows("ccd")))] + [short(row["ns_min"]) for row in rows("ccd", set="cloth")]),
        ("off by at most {} of their length at every frame's end, in every scene without contact", [most("rods of paper, off by")]),
        ("| swing, 1760 nodes | {} mm | {} mm |", [short(1e3 * one("work_precision", "error_m", scene="swing", method="paper", setting="default")),
                                                   short(1e3 * one("work_precision", "error_m", scene="swing", method="auto", setting="default"))]),
        ("2 / 4 / 8 / 32 / 64 substeps | {} / {} / {} / {} / {} mm",
         [short(1e3 * one("work_precision", "error_m", scene="swing", method="paper", setting="substeps %d" % count)) for count in (2, 4, 8, 32, 64)]),
        ("chains of 1, 2, 5, 10, 20 rods | {}, {}, {}, {}, {} mm", [told_by("chain of %d by paper, off by [mm]" % rods) for rods in (1, 2, 5, 10, 20)]),
        ("without contact is {} of the length in the curtain, {} in the skirt, {} in the sheet, {} in the flag, whose columns are held by wefts alone, "
         "and {} at the parachute's vent",
         [told_by("wefts of paper without contact, " + scene) for scene in ("curtain", "skirt", "sheet", "flag", "parachute")]),
        ("With it they gain {} at rest and {} while their pins shake", [tortures(*STRAIGHT, method="auto"), tortures(*SHAKEN, method="auto")]),
        ("come to rest and take {} to {} substeps a frame while awake", [fixed(value) for value in kept("taut sheet, substeps a frame")]),
        ("sheets at 0.9999 to 1 of it take {} to {}, and at most {} % of the substeps are of the last resort",
         [fixed(value) for value in kept("sheet at its full width, substeps a frame")] +
         [within(100.0 * kept("taut sheet, share of the last resort")[1])]),
        ("four methods, 1 and 8 substeps | off by {} at most |", [most("terminal speed, off by")]),
        ("r = 0.1 to 1 | off by {} at most |", [most("strip in relative air, angle off by")]),
        ("| mm | {} | {} | {} |", ["%.0f" % kept("flag at %d m/s, RMS of its end [mm]" % speed)[0] for speed in (2, 4, 8)]),
        ("| Hz | {} | {} | {} |", [told_by("flag at %d m/s, frequency [Hz]" % speed) for speed in (2, 4, 8)]),
        ("then moves by {} um at most, and its pull is {} to {} of its weight;",
         [most("heavy load on a line, moves by [um]")] + share("heavy load on a line, pull over its weight")),
        ("pull of a hanging load within {} of its weight; the air's force on a parachute that glides within {} of the weight",
         [most("load on a line, pull off by"), most("parachute, force of the air off by")]),
        ("stay constant to {} of the energy in motion at 32 substeps a frame, {} at the 7",
         [most("hysteresis, energy wavers, 32 substeps"), most("hysteresis, energy wavers, auto")]),
        ("A sleeping curtain costs {} instructions a frame, one that is awake and hangs still {}.", [ASLEEP, AWAKE]),
    ],
    "docs/sensors.md": [
        ("takes {} ms of one core, of which the hierarchy of boxes, rebuilt for each view, is {}; its points {} ms more; with noise {}, with pores {};",
         [seen(CAMERA), seen(CAMERA, "ms_hierarchy"), seen(CAMERA, "ms_points", 1), seen(CAMERA + NOISE), seen(CAMERA + PORES)]),
        ("a lidar of 64 x 2048 rays {}; 20 000 points all round {} (",
         [seen("lidar 64 x 2048"), seen("all round; 10 000 points a m^2", "ms_points", 1)]),
    ],
}
