#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The robot of the demos is sound: its URDF is one that the parser of ROS takes, its meshes are closed and those that the script makes,
its masses and limits are such as a robot can have.

  robot_check.py     Needs no ROS; of it check_urdf (liburdfdom-tools), where that is installed.
"""
import filecmp
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml
from collections import Counter

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ROBOT = os.path.join(ROOT, "config", "robot")
URDF = os.path.join(ROBOT, "curtain_robot.urdf")
MESHES = os.path.join(ROBOT, "meshes")


def triangles(path):
    """Corners of a binary STL's triangles."""
    with open(path, "rb") as file:
        data = file.read()
    count, = struct.unpack_from("<I", data, 80)
    numbers = [struct.unpack_from("<12f", data, 84 + 50 * i) for i in range(count)]
    return [(n[3:6], n[6:9], n[9:12]) for n in numbers]


class Robot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = xml.parse(URDF).getroot()

    @unittest.skipUnless(shutil.which("check_urdf"), "no check_urdf")
    def test_urdf_is_taken(self):
        result = subprocess.run(["check_urdf", URDF], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertIn("root Link: base_footprint", result.stdout)

    def test_all_meshes_are_there_and_used(self):
        used = {mesh.get("filename") for mesh in self.robot.iter("mesh")}
        self.assertEqual(used, {"package://curtain_sim/config/robot/meshes/" + name for name in os.listdir(MESHES)})

    def test_meshes_are_what_the_script_makes(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, os.path.join(ROBOT, "make_meshes"), folder], check=True)
            for name in os.listdir(MESHES):
                self.assertTrue(filecmp.cmp(os.path.join(MESHES, name), os.path.join(folder, name), shallow=False), name)

    def test_meshes_are_closed_and_seen_from_outside(self):
        for name in os.listdir(MESHES):
            edges, volume = Counter(), 0.0
            for a, b, c in triangles(os.path.join(MESHES, name)):
                edges.update([(a, b), (b, c), (c, a)])
                volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                           + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0
            self.assertTrue(all(count == 1 and edges[b, a] == 1 for (a, b), count in list(edges.items())), name)
            self.assertGreater(volume, 1e-4, name)

    def test_bodies_can_be(self):
        """Principal moments of inertia of a body: each is at most the sum of the other two."""
        for link in self.robot.iter("link"):
            bodies = link.find("collision") is not None
            self.assertEqual(bodies, link.find("inertial") is not None, link.get("name"))
            self.assertEqual(bodies, link.find("visual") is not None, link.get("name"))
            if bodies:
                self.assertGreater(float(link.find("inertial/mass").get("value")), 0.0)
                inertia = link.find("inertial/inertia")
                moments = sorted(float(inertia.get(key)) for key in ("ixx", "iyy", "izz"))
                self.assertGreater(moments[0], 0.0)
                self.assertLessEqual(moments[2], moments[0] + moments[1], link.get("name"))

    def test_joints_have_limits(self):
        kinds = Counter(joint.get("type") for joint in self.robot.iter("joint"))
        self.assertEqual(kinds, {"revolute": 6, "prismatic": 2, "continuous": 4, "fixed": 2})
        for joint in self.robot.iter("joint"):
            if joint.get("type") in ("revolute", "prismatic"):
                limit = joint.find("limit")
                self.assertLess(float(limit.get("lower")), float(limit.get("upper")), joint.get("name"))


if __name__ == "__main__":
    unittest.main()
