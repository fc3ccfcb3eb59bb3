#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The default demo: a hand takes the cloth, leads it and lets it go; the rail is told to open and shut; nothing is refused."""
import sys
import unittest

import rospy
import rostest
from curtain_sim.msg import DragForce
from curtain_testing import Curtain, Listener, wait_until

NODE = "/curtain/curtain_node"


class DemoWindowTest(unittest.TestCase):
    def test_hand_pulls_and_rail_shuts(self):
        rospy.init_node("demo_window_test")
        curtain = Curtain(NODE)
        hands = Listener("/curtain/drag_force", DragForce)
        demo = rospy.get_param("/curtain/demo_motion/demo")
        begin, end = demo["hands"][0]["path"][0], demo["hands"][0]["path"][-1]
        wait_until(lambda: any(m.action == DragForce.ADD for m in hands.messages()), "the hand takes the cloth", 40.0)
        curtain.wait_for(lambda s: s.statistics.messages_taken > 0, "the node hears of it")
        wait_until(lambda: hands.messages()[-1].action == DragForce.DELETE, "the hand lets go", 40.0)
        places = [(m.target.x, m.target.y, m.target.z) for m in hands.messages() if m.action == DragForce.ADD]
        for axis, values in enumerate(zip(*places)):
            self.assertLess(max(abs(values[0] - begin[1 + axis]), abs(values[-1] - end[1 + axis])), 0.05, "it goes along its path")
        wide, narrow = demo["openings"][0]["path"][0][1], demo["openings"][0]["path"][1][1]
        curtain.wait_for(lambda s: abs(s.statistics.opening - narrow) < 0.01, "the rail shuts from %g to %g" % (wide, narrow), 40.0)
        statistics = curtain.next().statistics
        self.assertEqual(statistics.dropped_invalid + statistics.dropped_untransformed, 0)
        self.assertEqual(statistics.restarts, 0)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "demo_window", DemoWindowTest, sys.argv)
