#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""package.xml and scripts/packages.txt say the same: what rosdep installs is what scripts/demo and scripts/test install.

Run without arguments. Needs no ROS and no build.
"""
import os
import re
import unittest
import xml.etree.ElementTree

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# Which dependencies of package.xml a group of packages stands for.
TAGS = {
    "build": {"depend", "build_depend", "buildtool_depend"},
    "run": {"depend", "exec_depend"},
    "view": {"depend", "build_depend", "exec_depend"},
    "test": {"depend", "test_depend"},
}


def table():
    """Rows of packages.txt: group, key, packages of Debian, packages of Ubuntu 20.04 with Noetic."""
    with open(os.path.join(ROOT, "scripts/packages.txt"), encoding="utf-8") as file:
        lines = [line.strip() for line in file if line.strip() and not line.startswith("#")]
    return [[cell.strip() for cell in line.split("|")] for line in lines]


def package():
    """The root of package.xml."""
    return xml.etree.ElementTree.parse(os.path.join(ROOT, "package.xml")).getroot()


def keys():
    """Of package.xml: rosdep key -> the tags that it stands in."""
    found = {}
    for element in package():
        if element.tag.endswith("depend"):
            found.setdefault(element.text, set()).add(element.tag)
    return found


class Packages(unittest.TestCase):
    def test_rows_are_whole(self):
        self.assertGreater(len(table()), 60)
        for row in table():
            self.assertEqual(len(row), 4, row)
            self.assertIn(row[0], TAGS)
            for name in (row[2] + " " + row[3]).split():
                self.assertRegex(name, r"^(-|[a-z0-9][a-z0-9.+-]+(@1[1-3])?)$")

    def test_every_key_of_package_xml_has_a_row(self):
        rows = {row[1] for row in table()}
        # What other packages need to build against this one: nothing that is installed here.
        missing = {key for key, tags in keys().items() if tags != {"build_export_depend"}} - rows
        self.assertEqual(missing, set())

    def test_every_row_with_a_key_stands_in_package_xml(self):
        tags = keys()
        for group, key, _, _ in table():
            if key != "-":
                self.assertTrue(tags.get(key, set()) & TAGS[group], "%s of group %s" % (key, group))

    def test_a_ros_package_has_its_name_of_noetic(self):
        for _, key, _, noetic in table():
            if noetic.startswith("ros-noetic-"):
                self.assertEqual(noetic, "ros-noetic-" + key.replace("_", "-"))

    def test_versions_agree(self):
        with open(os.path.join(ROOT, "CMakeLists.txt"), encoding="utf-8") as file:
            version = re.search(r"project\(curtain_sim VERSION ([\d.]+)", file.read()).group(1)
        self.assertEqual(package().find("version").text, version)


if __name__ == "__main__":
    unittest.main()
