#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every demo of config/demos is complete: its keys are known, its frames come from somewhere, its scene runs a second and stays whole,
docs/gallery.md shows it.

  demos_check.py CURTAIN_BATCH     Needs no ROS.
"""
import functools
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DEMOS = os.path.join(ROOT, "config", "demos")
NUMBER, TEXT, FLAG, ANY = (int, float), str, bool, object


def vector(*sizes):
    """A list of so many numbers."""
    def check(value):
        return isinstance(value, list) and (not sizes or len(value) in sizes) and all(isinstance(part, NUMBER) for part in value)
    return check


XYZ = vector(3)


def color(value):
    return XYZ(value) and all(0.0 <= part <= 1.0 for part in value)


def rows(*sizes):
    """A list of lists of so many numbers."""
    def check(value):
        return isinstance(value, list) and all(vector(*sizes)(row) for row in value)
    return check


def path(*sizes):
    """Rows, the first number of which is a time that grows."""
    def check(value):
        return rows(*sizes)(value) and all(a[0] < b[0] for a, b in zip(value, value[1:]))
    return check


# What demo.yaml may hold: keys of a map, in a list [of such maps]; "!" is required.
WAVE = {"rate!": NUMBER, "phase": NUMBER, "move": XYZ, "turn": XYZ}
TILES = {"size!": vector(2), "gap": color, "vary": NUMBER, "shift": NUMBER, "joint": NUMBER}
PLACED = {"shape!": TEXT, "frame": TEXT, "at": XYZ, "turn": XYZ, "color!": color}
SCENERY = {
    "box": {"size!": XYZ},
    "tube": {"path!": rows(3), "radius!": NUMBER, "round": FLAG},
    "ball": {"radius!": NUMBER, "scale": XYZ},
    "panel": {"size!": vector(2), "tiles": TILES, "fade": FLAG, "shades": rows(5)},
    "spokes": {"radius!": NUMBER, "count!": int, "to!": XYZ, "thickness!": NUMBER},
    "sky": {"radius": NUMBER, "zenith!": color},
}
CLOTH = {"pattern": TEXT, "color": color, "pattern_color": color, "pattern_size": NUMBER, "sheen": NUMBER, "translucency": NUMBER}
DEMO = {
    "frames": [{"frame!": TEXT, "parent": TEXT, "at": XYZ, "turn": XYZ, "waves": [WAVE],
                "drift": {"move!": XYZ, "period!": NUMBER, "begin": NUMBER}}],
    "winds": [{"id!": TEXT, "frame": TEXT, "at": XYZ, "direction": XYZ, "sweep": NUMBER, "sweep_rate": NUMBER, "radius!": NUMBER,
               "half_angle": NUMBER, "pressure!": NUMBER, "unsteadiness": NUMBER, "correlation_time": NUMBER, "ring_jet": FLAG,
               "shadow": FLAG, "moves": FLAG, "rest": vector(2)}],
    "hands": [{"id!": TEXT, "row": int, "column": int, "point": XYZ, "period!": NUMBER, "offset": NUMBER, "path!": path(4),
               "stiffness": NUMBER, "radius": NUMBER}],
    "openings": [{"period!": NUMBER, "path!": path(2), "layer": TEXT}],
    "follow": {"frame!": TEXT, "lag": NUMBER},
    "scenery!": ANY,
    "gallery": {"at": NUMBER, "step": NUMBER, "picture": int},
    "look!": {"camera!": {"from!": XYZ, "at!": XYZ, "frame": TEXT, "view": NUMBER}, "background!": color,
              "cloth!": CLOTH, "layers": ANY, "wind": FLAG, "handles": FLAG, "robot": FLAG},
}
GRASP = {"from!": NUMBER, "until!": NUMBER, "radius": NUMBER, "stiffness": NUMBER, "break_force": NUMBER, "pinch_force": NUMBER,
         "friction": NUMBER}
ROBOT = {"period!": NUMBER, "poses!": ANY, "base!": path(4), "fingers!": path(2), "grasps": [GRASP],
         "arm!": [{"t!": NUMBER, "joints": TEXT, "move": XYZ, "node": vector(2), "turn": XYZ, "offset": XYZ}]}


def problems(value, wanted, key):
    """What is wrong with a value, in words."""
    if isinstance(wanted, list):
        if not isinstance(value, list):
            return ["%s is no list" % key]
        return [text for i, item in enumerate(value) for text in problems(item, wanted[0], "%s[%d]" % (key, i))]
    if isinstance(wanted, dict):
        if not isinstance(value, dict):
            return ["%s is no map" % key]
        names = {name.rstrip("!"): kind for name, kind in wanted.items()}
        found = ["%s: unknown key %s" % (key, name) for name in value if name not in names]
        found += ["%s: %s is missing" % (key, name[:-1]) for name in wanted if name.endswith("!") and name[:-1] not in value]
        return found + [text for name in value if name in names for text in problems(value[name], names[name], key + "." + name)]
    if isinstance(wanted, (type, tuple)):
        good = isinstance(value, wanted) and (wanted in (ANY, FLAG) or not isinstance(value, bool))
    else:
        good = wanted(value)
    return [] if good else ["%s is %r" % (key, value)]


def scenery_problems(entries):
    found = []
    for i, entry in enumerate(entries):
        shape = entry.get("shape")
        found += problems(entry, dict(PLACED, **SCENERY[shape]), "scenery[%d]" % i) if shape in SCENERY else ["no shape %r" % shape]
    return found


def has_robot(name):
    return name.startswith("robot_")


def robot_links():
    with open(os.path.join(ROOT, "config", "robot", "curtain_robot.urdf"), encoding="utf-8") as file:
        return set(re.findall(r'<link name="(\w+)"', file.read()))


def demo_names():
    return sorted(os.listdir(DEMOS))


def load(name, file):
    with open(os.path.join(DEMOS, name, file), encoding="utf-8") as text:
        return yaml.safe_load(text)


def of_each(test):
    """A test that is made of each demo."""
    @functools.wraps(test)
    def run(self):
        self.assertGreater(len(demo_names()), 10)
        for name in demo_names():
            with self.subTest(demo=name):
                test(self, name)
    return run


class Demos(unittest.TestCase):
    batch = None

    @of_each
    def test_folders_are_complete(self, name):
        self.assertEqual(sorted(os.listdir(os.path.join(DEMOS, name))), ["demo.yaml"] + ["robot.yaml"] * has_robot(name) + ["scene.yaml"])

    @of_each
    def test_keys_are_known(self, name):
        demo = load(name, "demo.yaml")
        self.assertEqual(problems(demo, DEMO, "demo") + scenery_problems(demo["scenery"]), [])

    @of_each
    def test_patterns_are_those_of_the_display(self, name):
        with open(os.path.join(ROOT, "src", "rviz", "surface", "fabric.cpp"), encoding="utf-8") as file:
            self.assertIn('"%s"' % load(name, "demo.yaml")["look"]["cloth"].get("pattern", "Linen"), file.read())

    @of_each
    def test_frames_are_broadcast(self, name):
        demo, scene = load(name, "demo.yaml"), load(name, "scene.yaml")
        known = robot_links() if has_robot(name) else set()
        known |= {"world", demo.get("follow", {}).get("frame")} | {frame["frame"] for frame in demo.get("frames", [])}
        asked = {obstacle.get("frame", "world") for obstacle in scene.get("obstacles", [])}
        asked |= {frame.get("parent", "world") for frame in demo.get("frames", [])}
        asked |= {entry.get("frame", "world") for key in ("winds", "scenery") for entry in demo.get(key, [])}
        self.assertEqual(asked - known, set())
        camera = demo["look"]["camera"].get("frame")
        self.assertIn(camera, {None} | known)

    def test_robots_move_as_they_can(self):
        for name in filter(has_robot, demo_names()):
            robot, cloth = load(name, "robot.yaml"), load(name, "scene.yaml")["cloth"]
            self.assertEqual(problems(robot, ROBOT, name), [])
            self.assertTrue(load(name, "demo.yaml")["look"]["robot"])
            times = [entry["t"] for entry in robot["arm"]]
            self.assertEqual(times, sorted(set(times)))
            for entry in robot["arm"]:
                self.assertEqual(sum(key in entry for key in ("joints", "move", "node")), 1, entry)
                self.assertIn(entry.get("joints"), {None} | set(robot["poses"]))
                row, column = entry.get("node", (0, 0))
                self.assertTrue(row < cloth["rows"] and column < cloth["columns"], entry)
                self.assertEqual("node" in entry, "turn" in entry, entry)
            # It begins anew where it ended.
            ends = [robot["arm"], robot["base"], robot["fingers"]]
            for rows in ends:
                begin, end = ([row[1:] if isinstance(row, list) else row["joints"]] for row in (rows[0], rows[-1]))
                self.assertEqual(begin, end)
            self.assertLessEqual(max(rows[-1]["t"] if rows is ends[0] else rows[-1][0] for rows in ends), robot["period"])
            holds = [time for grasp in robot.get("grasps", []) for time in (grasp["from"], grasp["until"])]
            self.assertEqual(holds, sorted(set(holds)))

    @of_each
    def test_hands_and_openings_find_what_they_move(self, name):
        demo, scene = load(name, "demo.yaml"), load(name, "scene.yaml")
        for hand in demo.get("hands", []):
            self.assertTrue("point" in hand or ("row" in hand and "column" in hand), "neither node nor point")
            self.assertLess(hand.get("row", -1), scene["cloth"]["rows"])
            self.assertLess(hand.get("column", -1), scene["cloth"]["columns"])
            self.assertLessEqual(hand["path"][-1][0], hand["period"])
        rails = {layer["name"]: layer.get("rail") for layer in scene.get("layers", [])}
        rails[None] = scene.get("rail")
        for opening in demo.get("openings", []):
            self.assertTrue(rails.get(opening.get("layer")), "nothing opens without a rail")
        for layer, cloth in demo["look"].get("layers", {}).items():
            self.assertIn(layer, rails)
            self.assertEqual(problems(cloth, CLOTH, layer), [])

    @of_each
    def test_scenes_run_and_stay_whole(self, name):
        with tempfile.TemporaryDirectory() as folder:
            stats = os.path.join(folder, "stats.json")
            result = subprocess.run([self.batch, os.path.join(DEMOS, name, "scene.yaml"), "--duration", "1", "--stats", stats],
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
            self.assertEqual(result.returncode, 0, result.stdout)
            with open(stats, encoding="utf-8") as file:
                figures = json.load(file)
        self.assertTrue(figures["finite"])
        self.assertEqual(figures["self_crossings"], 0)
        self.assertFalse(any(figures["piercings"].values()), figures["piercings"])
        self.assertLessEqual(max(figures["stretch_max"].values()), 1e-3 * (1.0 + 1e-9))
        self.assertTrue(load(name, "scene.yaml")["contact"]["self"])

    @of_each
    def test_the_gallery_shows_each(self, name):
        with open(os.path.join(ROOT, "docs", "gallery.md"), encoding="utf-8") as file:
            page = file.read()
        self.assertRegex(page, r"(?m)^## `%s`$" % name)
        for kind in ("png", "gif"):
            self.assertIn("(gallery/%s.%s)" % (name, kind), page)
            self.assertTrue(os.path.exists(os.path.join(ROOT, "docs", "gallery", "%s.%s" % (name, kind))))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    Demos.batch = sys.argv.pop()
    unittest.main()
