#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Two curtains live side by side in two namespaces: each has its scene, its frame, its wind."""
import sys
import unittest

import rospy
import rostest
from curtain_sim.msg import WindSource
from curtain_testing import Curtain, billow, publisher, wind_message


class NamespacesTest(unittest.TestCase):
    def test_wind_reaches_one_curtain_only(self):
        rospy.init_node("namespaces_test")
        left, right = Curtain("/left/curtain"), Curtain("/right/curtain")
        self.assertEqual((left.next().rows, right.next().rows), (10, 9))
        self.assertEqual((left.last().header.frame_id, right.last().header.frame_id), ("world", "stage"))
        wind = publisher("/left/wind_source", WindSource)
        right.clear()
        wind.publish(wind_message())
        left.wait_for(lambda s: billow(s) > 0.1, "the left curtain blows")
        right.next()
        self.assertLess(max(billow(state) for state in right.messages()), 0.01)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "namespaces", NamespacesTest, sys.argv)
