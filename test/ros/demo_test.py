#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The demo runs: the fan's messages blow the curtain, the ball's frame is known, nothing is dropped as wrong."""
import sys
import unittest

import rospy
import rostest
import tf2_ros
from curtain_sim.msg import WindSource
from curtain_testing import Curtain, Listener, wait_until

NODE = "/curtain/curtain_node"


class DemoTest(unittest.TestCase):
    def test_demo_runs(self):
        rospy.init_node("demo_test")
        curtain = Curtain(NODE)
        wind = Listener("/curtain/wind_source", WindSource)
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        wait_until(lambda: buffer.can_transform("world", "ball", rospy.Time(0)), "the ball is broadcast")
        wait_until(lambda: wind.count() > 10, "the fan blows")
        directions = {round(m.pose.orientation.z, 3) for m in wind.messages()}
        self.assertGreater(len(directions), 3, "it sweeps")
        curtain.wait_for(lambda s: max(s.positions[1::3]) > 0.2, "the curtain blows")
        curtain.wait_for(lambda s: s.statistics.absent_obstacles == 0, "all obstacles are there")
        if rospy.get_param(NODE + "/scene/obstacles", []):
            curtain.wait_for(lambda s: s.statistics.contacts > 0, "the ball touches the curtain", 30.0)
        statistics = curtain.next().statistics
        self.assertTrue(statistics.finite)
        self.assertEqual(statistics.restarts, 0)
        self.assertEqual(statistics.dropped_invalid, 0)
        self.assertEqual(statistics.dropped_overflow, 0)
        listener.unregister()


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "demo", DemoTest, sys.argv)
