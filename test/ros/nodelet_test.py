#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The nodelet loads, publishes, listens, refuses a bad scene without harming its manager, and unloads at once."""
import subprocess
import sys
import time
import unittest

import roslib.packages
import rospy
import rostest
from curtain_sim.msg import WindSource
from curtain_testing import Curtain, billow, publisher, wait_until, wind_message


class NodeletTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("nodelet_test")
        cls.curtain = Curtain("/curtain")
        cls.curtain.next()

    def test_1_listens_and_publishes(self):
        wind = publisher("/wind_source", WindSource)
        wind.publish(wind_message())
        self.curtain.wait_for(lambda s: billow(s) > 0.1, "the curtain blows")

    def test_2_refuses_a_bad_scene(self):
        """The loader ends with an error, the manager and its other curtain go on."""
        rospy.set_param("/bad/scene", {"cloth": {"rows": 1, "columns": 8}})
        self.assertNotEqual(self.nodelet("load", "curtain_sim/CurtainNodelet", "manager", "__name:=bad"), 0)
        self.curtain.next()

    def test_3_unloads_at_once(self):
        start = time.monotonic()
        self.assertEqual(self.nodelet("unload", "/curtain", "manager"), 0)
        self.assertLess(time.monotonic() - start, 1.5, "less than a second, and the start of the tool")
        wait_until(lambda: self.curtain._subscriber.get_num_connections() == 0, "its topics are gone")

    @staticmethod
    def nodelet(*arguments):
        tool = roslib.packages.find_node("nodelet", "nodelet")[0]
        return subprocess.run([tool] + list(arguments), timeout=20.0, check=False).returncode


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "nodelet", NodeletTest, sys.argv)
