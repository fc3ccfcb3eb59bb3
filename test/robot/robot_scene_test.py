#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/robot_scene: links are where the joints have them, and cloth lies on them. Runs by ctest, which says where curtain_batch is."""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest

import numpy
import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
WAITER = os.path.join(ROOT, "test/ros/robot.urdf")
SHEET = {
    "cloth": {"rows": 16, "columns": 16, "height": 0.6, "width": 0.6},
    "hang": {"from": [-0.3, 0.3, 1.2], "to": [0.3, 0.3, 1.2], "tilt": 0.5 * math.pi},
    "pins": "none",
    "air": {"inside": 0.5, "border": 0.5, "corner": 0.5},
}
ARM = """<robot name="arm">
  <link name="base"/>
  <joint name="first" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 1"/><axis xyz="0 0 2"/></joint>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="second" type="continuous"><parent link="upper"/><child link="lower"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>
    <mimic joint="first" multiplier="-2" offset="0.1"/></joint>
  <link name="lower"><collision><origin xyz="0 0.3 0" rpy="0.2 0 0"/><geometry><mesh filename="m/part.stl"/></geometry></collision></link>
  <joint name="lift" type="prismatic"><parent link="lower"/><child link="hand"/><axis xyz="0 0 1"/></joint>
  <link name="hand"><collision><geometry><box size="1 2 3"/></geometry></collision></link>
</robot>"""


def turned(angle):
    """About z."""
    return numpy.array([[math.cos(angle), -math.sin(angle), 0.0], [math.sin(angle), math.cos(angle), 0.0], [0.0, 0.0, 1.0]])


def matrix(q):
    """Of x, y, z, w."""
    v, w = numpy.array(q[:3]), q[3]
    cross = numpy.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])
    return numpy.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross


class RobotScene(unittest.TestCase):
    batch = os.environ.get("CURTAIN_BATCH")

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.scene = self.write("scene.yaml", yaml.safe_dump(SHEET))

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def run_it(self, *arguments):
        return subprocess.run([sys.executable, os.path.join(ROOT, "scripts/robot_scene"), self.scene] + list(arguments),
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)

    def made(self, *arguments):
        result = self.run_it(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return {obstacle["name"]: obstacle for obstacle in yaml.safe_load(result.stdout)["obstacles"]}

    def test_links_are_where_the_joints_have_them(self):
        arm = self.write("arm.urdf", ARM)
        joints = self.write("joints.csv", "t,first,lift\n0,0.3,0\n2,1.5,0.4\n")
        made = self.made(arm, joints, "--at", "5,0,0", "--padding", "0.01")
        self.assertEqual(sorted(made), ["hand", "lower", "upper"])
        self.assertEqual(made["hand"]["size"], [1.0, 2.0, 3.0])
        self.assertEqual(made["lower"]["mesh"], os.path.join(self.folder, "m/part.stl"))
        self.assertTrue(all(obstacle["padding"] == 0.01 for obstacle in made.values()))
        self.assertEqual(len(made["hand"]["motion"]), 61, "30 a second")
        for number, key in enumerate(made["hand"]["motion"]):
            share = number / 60.0
            first, lift = 0.3 + 1.2 * share, 0.4 * share
            second = 0.1 - 2.0 * first
            elbow = numpy.array([5.0, 0.0, 1.0]) + turned(first) @ [1.0, 0.0, 0.0]
            upper, lower = made["upper"]["motion"][number], made["lower"]["motion"][number]
            self.assertAlmostEqual(key["time"], 2.0 * share, delta=1e-12)
            numpy.testing.assert_allclose(upper["position"], [5.0, 0.0, 1.0] + turned(first) @ [0.5, 0.0, 0.0], atol=1e-12)
            numpy.testing.assert_allclose(lower["position"], elbow + turned(first + second) @ [0.0, 0.3, 0.0], atol=1e-12)
            roll = numpy.array([[1.0, 0.0, 0.0], [0.0, math.cos(0.2), -math.sin(0.2)], [0.0, math.sin(0.2), math.cos(0.2)]])
            numpy.testing.assert_allclose(matrix(lower["orientation"]), turned(first + second) @ roll, atol=1e-12)
            numpy.testing.assert_allclose(key["position"], elbow + [0.0, 0.0, lift], atol=1e-12)

    def test_without_joints_it_stands(self):
        made = self.made(WAITER, "--links", "tray", "fin.*")
        self.assertEqual(sorted(made), ["finger_1", "tray/0", "tray/1"])
        self.assertFalse(any("motion" in obstacle for obstacle in made.values()))

    @unittest.skipUnless(batch, "no curtain_batch")
    def test_a_sheet_lies_on_the_tray(self):
        """Its plates are level at 0.5 rad; they bear the sheet's weight, and nothing goes through them as they tilt."""
        for end, level in (("0.5", True), ("0.3", False)):
            joints = self.write("joints.csv", "t,tilt\n0,0.5\n3,0.5\n4,%s\n" % end)
            scene, stats, wrenches = (os.path.join(self.folder, name) for name in ("out.yaml", "stats.json", "wrenches.csv"))
            self.assertEqual(self.run_it(WAITER, joints, "--links", "base", "tray", "slider", "--out", scene).returncode, 0)
            subprocess.run([self.batch, scene, "--duration", "4.2", "--stats", stats, "--wrenches", wrenches], check=True)
            with open(stats, encoding="utf-8") as file:
                self.assertFalse(any(json.load(file)["piercings"].values()))
            if not level:
                continue
            with open(wrenches, encoding="utf-8") as file:
                last = list(csv.DictReader(file))[-10:]
            force = sum(float(row["fz"]) for row in last if row["obstacle"].startswith("tray") and row["t"] == last[-1]["t"])
            self.assertAlmostEqual(force, -0.2 * 0.36 * 9.81, delta=0.01)

    def test_bad_input_is_named(self):
        arm = self.write("arm.urdf", ARM)
        table = self.write("table.csv", "t,first\n0,0.0\n0,1.0\n")
        cases = [
            (["nowhere.urdf"], "nowhere.urdf"),
            ([self.write("no.urdf", "<house/>")], "must be a URDF"),
            ([self.write("half.urdf", "<robot")], "half.urdf"),
            ([self.write("float.urdf", ARM.replace("prismatic", "floating"))], "joint 'lift': must be one of fixed, revolute"),
            ([self.write("axis.urdf", ARM.replace("0 0 2", "0 0 0"))], "joint 'first': axis: must have a length > 0"),
            ([self.write("size.urdf", ARM.replace("1 2 3", "1 2"))], "collision geometry 'hand': size: must be 3 numbers"),
            ([self.write("loop.urdf", ARM.replace('<parent link="base"/>', '<parent link="hand"/>'))], "hangs on itself"),
            ([arm, table], "times increase"),
            ([arm, self.write("third.csv", "t,third\n0,1\n")], "'third' is no joint that moves by itself, known are first, lift"),
            ([arm, self.write("led.csv", "t,second\n0,1\n")], "'second' is no joint"),
            ([arm, self.write("word.csv", "t,first\n0,up\n")], "row 1: must be 2 numbers"),
            ([arm, "--links", "leg"], "--links: 'leg' names no link"),
            ([arm, "--at", "1,2"], "--at: must be 3 numbers"),
        ]
        for arguments, text in cases:
            result = self.run_it(*arguments)
            self.assertEqual(result.returncode, 2, (arguments, result.stderr))
            self.assertEqual(result.stdout, "")
            self.assertIn(text, result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.scene = self.write("taken.yaml", yaml.safe_dump(dict(SHEET, obstacles=[{"name": "hand", "radius": 1.0}])))
        self.assertIn("of these names already: hand", self.run_it(arm).stderr)


if __name__ == "__main__":
    unittest.main()
