#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Our display in rviz: the cloth has the colour that was chosen, a layer its scale, messages that are wrong do no harm, and
neither rviz nor Ogre complain.

rviz runs on an X server of its own (Xvfb). Passes with a message where the display was not built, or a tool is not installed.
"""
import os
import re
import signal
import subprocess
import sys

import roslib.packages
import rospy
import rostest
from curtain_sim.msg import CurtainState
from curtain_testing import Curtain, publisher, wait_until
from screen_testing import HEIGHT, WIDTH, ScreenTest

NODE = "/curtain/curtain_node"
# Of the picture's pixels; the cloth hangs across most of the view.
MUCH, LITTLE = 0.08, 0.002


def is_green(red, green, blue):
    return green > 40 and green > 1.5 * red and green > 1.5 * blue


def is_violet(red, green, blue):
    return blue > 40 and blue > 1.5 * green and red > 1.3 * green


def is_blue_to_teal(red, green, blue):
    """The lower half of the layers' scale."""
    return blue > 30 and blue > 1.4 * red


class RvizDisplayTest(ScreenTest):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("rviz_display_test")
        cls.curtain = Curtain(NODE)
        cls.curtain.next()

    def built(self):
        prefixes = os.environ["CMAKE_PREFIX_PATH"].split(os.pathsep)
        there = any(os.path.exists(os.path.join(prefix, "lib", "libcurtain_rviz.so")) for prefix in prefixes)
        if not there:
            print("skipped: the display was not built")
        return there and self.installed("rviz", "Xvfb", "import")

    def configuration(self, **changes):
        """config/curtain.rviz with other properties of our display, without wind, and with the cloth in the middle."""
        with open(os.path.join(roslib.packages.get_pkg_dir("curtain_sim"), "config", "curtain.rviz")) as file:
            text = file.read()
        head, begin, ours = text.partition("    - Class: curtain_sim/Curtain\n")
        for key, value in dict(changes, Wind="false").items():
            ours, count = re.subn(r"(?m)^(      (?:  )?%s:) .*$" % key.replace("_", " "), r"\1 " + value, ours, count=1)
            self.assertEqual(count, 1, key)
        text = head + begin + ours
        for key, value in {"X": 0.3, "Y": 0, "Z": 1.2}.items():
            text = re.sub(r"(?ms)(Focal Point:.*?%s:) \S+" % key, r"\1 %g" % value, text, count=1)
        text = re.sub(r"Yaw: .*", "Yaw: 4.71239", text)
        text = re.sub(r"(?m)^  (Height|Width): .*", "", text) + "  Height: %d\n  Width: %d\n" % (HEIGHT, WIDTH)
        path = os.path.join(self.folder, "test.rviz")
        with open(path, "w") as file:
            file.write(text)
        return path

    def start_rviz(self, *arguments, **changes):
        environment = self.start_screen()
        rviz = self.start("rviz", "-l", "-d", self.configuration(**changes), *arguments, env=environment, cwd=self.folder)
        return rviz, environment

    def wait_for_cloth(self, rviz, environment, wanted):
        def looks():
            self.assertIsNone(rviz.poll(), "rviz runs\n" + self.log_of("rviz"))
            return self.share(environment, wanted) > MUCH
        wait_until(looks, "the cloth is in the picture", 60.0)

    def assert_ends_without_complaint(self, rviz):
        """With -l rviz's log has Ogre's in it, so the shader's compiler's, too."""
        rviz.send_signal(signal.SIGINT)
        self.assertEqual(rviz.wait(20.0), 0, self.log_of("rviz"))
        with open(os.path.join(self.folder, "rviz.log"), errors="replace") as log:
            lines = [line for line in log if re.search(r"\[ *(ERROR|FATAL)\]|Exception|curtain_sim.*(error|warning)", line)]
        self.assertEqual(lines, [])

    def test_cloth_has_the_chosen_colour(self):
        if not self.built():
            return
        rviz, environment = self.start_rviz(Color="40; 160; 60", Pattern="Twill")
        self.wait_for_cloth(rviz, environment, is_green)
        self.assertLess(self.share(environment, is_violet), LITTLE)
        self.assert_ends_without_complaint(rviz)

    def test_pattern_has_both_colours(self):
        if not self.built():
            return
        rviz, environment = self.start_rviz(Color="40; 160; 60", Pattern="Stripes", Pattern_Color="120; 30; 150")
        self.wait_for_cloth(rviz, environment, is_green)
        self.assertGreater(self.share(environment, is_violet), 0.2 * MUCH)
        self.assert_ends_without_complaint(rviz)

    def test_tension_is_shown_in_the_scales_colours(self):
        """It is asked for only when it is shown, and most of a hanging cloth bears less than half of the largest."""
        if not self.built():
            return
        master = rospy.get_master()

        def listeners():
            subscribed = dict((topic, nodes) for topic, nodes in master.getSystemState()[2][1])
            return subscribed.get(NODE + "/loads", [])
        self.assertEqual(listeners(), [])
        rviz, environment = self.start_rviz(Color="40; 160; 60", Layer="Tension")
        self.wait_for_cloth(rviz, environment, is_blue_to_teal)
        self.assertEqual(len(listeners()), 1)
        self.assert_ends_without_complaint(rviz)

    def test_wrong_messages_do_no_harm(self):
        """A cloth is shown, then come messages that are wrong in many ways, then the next good one, another cloth, too."""
        if not self.built():
            return
        sender = rospy.Publisher("/fake/state", CurtainState, queue_size=50)
        rviz, environment = self.start_rviz(Color="40; 160; 60", Topic="/fake/state")
        wait_until(lambda: sender.get_num_connections() > 0, "rviz listens", 60.0)
        good = self.curtain.next()
        sender.publish(good)
        self.wait_for_cloth(rviz, environment, is_green)
        for field in ("positions", "velocities", "warp_rest", "weft_rest", "fold_nodes"):
            for wrong in ([], [float("nan")] * len(getattr(good, field)), [0.0] * 7, [1e38] * len(getattr(good, field))):
                message = self.curtain.next()
                setattr(message, field, wrong)
                sender.publish(message)
        for field, wrong in (("rows", 0), ("rows", 2 ** 32 - 1), ("columns", 1), ("folds", 0), ("folds", 10 ** 6), ("closed", True)):
            message = self.curtain.next()
            setattr(message, field, wrong)
            sender.publish(message)
        message = self.curtain.next()
        message.header.frame_id = "a_frame_nobody_knows"
        sender.publish(message)
        good.weft_rest = [1.01 * rest for rest in good.weft_rest]
        sender.publish(good)
        self.wait_for_cloth(rviz, environment, is_green)
        self.assertIsNone(rviz.poll(), "rviz runs\n" + self.log_of("rviz"))


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "rviz_display", RvizDisplayTest, sys.argv)
