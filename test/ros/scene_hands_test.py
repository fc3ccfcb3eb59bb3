#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hands and pins that a scene moves by itself do so in the node, too, from its start and from a snapshot."""
import os
import sys
import tempfile
import unittest

import numpy
import rospy
import rostest
from curtain_sim.srv import Load, Save, Step
from curtain_testing import Curtain, Listener, node_position, service, wait_until
from rosgraph_msgs.msg import Log
from std_srvs.srv import Trigger

NODE = "/curtain/curtain_node"
COLUMNS = 8


class SceneHandsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("scene_hands_test")
        cls.log = Listener("/rosout", Log)
        cls.curtain = Curtain(NODE)
        cls.step, cls.reset = service(NODE, "step", Step), service(NODE, "reset", Trigger)
        wait_until(lambda: cls.curtain._subscriber.get_num_connections() > 0, "the node is there")

    def stepped(self, frames):
        answer = self.step(frames)
        self.assertTrue(answer.success, answer.message)
        return self.curtain.wait_for(lambda s: s.header.stamp == answer.stamp, "the state is here")

    def test_1_hold_move_and_let_go(self):
        for _ in range(2):
            state = self.stepped(90)  # 1.5 s
            corner = node_position(state, 9, 7)
            self.assertLess(numpy.linalg.norm(numpy.array(corner) - [0.6, 0.3, 1.4]), 1e-6)
            state = self.stepped(60)  # 2.5 s: it hangs again, and the pins are where they go
            self.assertLess(node_position(state, 9, 7)[2], 1.35)
            for column in range(COLUMNS):
                self.assertAlmostEqual(node_position(state, 0, column)[2], 2.1, delta=1e-6)
            self.assertTrue(self.reset().success)

    def test_2_go_on_from_a_snapshot(self):
        path = os.path.join(tempfile.mkdtemp(), "state")
        self.stepped(48)  # 0.8 s: the hand is on its way
        self.assertTrue(service(NODE, "save", Save)(path).success)
        later = self.stepped(20)
        self.assertTrue(self.reset().success)
        answer = service(NODE, "load", Load)(path)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(self.stepped(20).positions, later.positions, "the same motion")

    def test_3_what_is_missed_is_told(self):
        def told():
            return [m.msg for m in self.log.messages() if "hand 'far' took nothing at 0.2 s" in m.msg]
        wait_until(lambda: len(told()) > 0, "the warning is in the log")


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "scene_hands", SceneHandsTest, sys.argv)
