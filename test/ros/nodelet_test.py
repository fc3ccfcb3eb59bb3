#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The nodelet loads, publishes, listens, refuses a bad scene without harming its manager, and unloads at once."""
import subprocess
import sys
import threading
import time
import unittest

import rosgraph
import roslib.packages
import rospy
import rostest
from curtain_sim.msg import WindSource
from curtain_sim.srv import Step
from curtain_testing import Curtain, billow, publisher, wait_until, wind_message
from std_srvs.srv import SetBool


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

    def test_3_serves(self):
        """Whoever waits for many frames holds up neither others nor the stream of this manager."""
        rospy.wait_for_service("/curtain/step")
        step, pause = rospy.ServiceProxy("/curtain/step", Step), rospy.ServiceProxy("/curtain/pause", SetBool)
        self.assertTrue(pause(True).success)
        self.waiting = []
        caller = threading.Thread(target=lambda: self.waiting.append(step(100000)), daemon=True)
        caller.start()
        before = self.curtain.next().statistics.frame
        answer = rospy.ServiceProxy("/curtain/step", Step)(3)
        self.assertTrue(answer.success, answer.message)
        self.assertGreaterEqual(answer.frame, before + 3)
        self.assertTrue(pause(False).success)
        caller.join(20.0)
        self.assertIn("told to go on", self.waiting[0].message)

    def test_4_unloads_at_once(self):
        """Also while somebody waits for frames, who is told."""
        self.assertTrue(rospy.ServiceProxy("/curtain/pause", SetBool)(True).success)
        answers = []
        caller = threading.Thread(target=lambda: answers.append(rospy.ServiceProxy("/curtain/step", Step)(100000)),
                                  daemon=True)
        caller.start()
        self.curtain.next()
        start = time.monotonic()
        self.assertEqual(self.nodelet("unload", "/curtain", "manager"), 0)
        self.assertLess(time.monotonic() - start, 1.5, "less than a second, and the start of the tool")
        caller.join(20.0)
        self.assertEqual([answer.message.split(":")[0] for answer in answers], ["the node stops"])
        wait_until(lambda: not self.published("/curtain/state"), "its topics are gone")

    @staticmethod
    def published(topic):
        """Whether the master knows somebody who publishes it."""
        return any(name == topic for name, _ in rosgraph.Master("/nodelet_test").getSystemState()[0])

    @staticmethod
    def nodelet(*arguments):
        tool = roslib.packages.find_node("nodelet", "nodelet")[0]
        return subprocess.run([tool] + list(arguments), timeout=20.0, check=False).returncode


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "nodelet", NodeletTest, sys.argv)
