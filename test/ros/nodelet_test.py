#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The nodelet loads, publishes, listens, refuses a bad scene without harming its manager, and unloads at once."""
import sys
import time
import unittest

import rospy
import rostest
from curtain_sim.msg import WindSource
from curtain_testing import Curtain, billow, publisher, wind_message
from nodelet.srv import NodeletList, NodeletLoad, NodeletUnload


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
        rospy.set_param("/bad/scene", {"cloth": {"rows": 1, "columns": 8}})
        load = rospy.ServiceProxy("/manager/load_nodelet", NodeletLoad)
        # Nodelets that do not load are answered with an error or with success = false, by the manager's version.
        try:
            self.assertFalse(load(name="/bad", type="curtain_sim/CurtainNodelet").success)
        except rospy.ServiceException:
            pass
        self.assertNotIn("/bad", rospy.ServiceProxy("/manager/list", NodeletList)().nodelets)
        self.curtain.next()

    def test_3_unloads_at_once(self):
        start = time.monotonic()
        self.assertTrue(rospy.ServiceProxy("/manager/unload_nodelet", NodeletUnload)("/curtain").success)
        self.assertLess(time.monotonic() - start, 1.0)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "nodelet", NodeletTest, sys.argv)
