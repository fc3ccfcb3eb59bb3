#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""~attach ties cloth to a frame, which it then moves with; it is untied by ~detach, a lost frame, a pull, a reset."""
import sys
import unittest

import numpy
import rospy
import rostest
from curtain_sim.srv import Attach, AttachRequest, Detach, Step
from curtain_testing import Curtain, node_position, service, wait_until
from geometry_msgs.msg import Point, TransformStamped, Vector3
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

NODE = "/curtain/curtain_node"
CORNER = numpy.array([0.7, 0.0, 1.1])  # where node [9, 7] starts


class TiesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("ties_test")
        cls.transforms = rospy.Publisher("/tf", TFMessage, queue_size=10)  # nobody listens until a tie asks for it
        cls.curtain = Curtain(NODE)
        cls.step, cls.reset = service(NODE, "step", Step), service(NODE, "reset", Trigger)
        cls.attach, cls.detach = service(NODE, "attach", Attach), service(NODE, "detach", Detach)
        wait_until(lambda: cls.curtain._subscriber.get_num_connections() > 0, "the node is there")

    def setUp(self):
        self.assertTrue(self.reset().success)
        self.place = CORNER.copy()

    def send(self):
        transform = TransformStamped()
        transform.header.stamp = rospy.Time.now()
        transform.header.frame_id, transform.child_frame_id = "world", "gripper"
        transform.transform.translation = Vector3(*self.place)
        transform.transform.rotation.w = 1.0
        self.transforms.publish(TFMessage([transform]))

    def stepped(self, frames=1, sends=True):
        for _ in range(frames):
            if sends:
                self.send()
            answer = self.step(1)
            self.assertTrue(answer.success, answer.message)
            wait_until(lambda: rospy.Time.now() == answer.stamp, "the clock says so here, too")
        return self.curtain.wait_for(lambda s: s.header.stamp == answer.stamp, "the state is here")

    def tie(self, **fields):
        """The answer, once the frame is known."""
        def answered():
            self.send()
            answer = self.attach(AttachRequest(frame="gripper", **fields))
            return None if "frame 'gripper'" in answer.message else answer
        return wait_until(answered, "the frame is known")

    def corner(self, state):
        return numpy.array(node_position(state, 9, 7))

    def test_1_the_nearest_node_follows_until_it_is_untied(self):
        answer = self.tie()
        self.assertTrue(answer.success, answer.message)
        self.assertEqual((answer.tied_rows, answer.tied_columns), ((9,), (7,)))
        self.stepped(3)
        self.place += [-0.1, 0.2, 0.1]

        def arrived():
            return numpy.linalg.norm(self.corner(self.stepped()) - self.place) < 1e-6
        wait_until(arrived, "it is where the frame is")
        answer = self.detach("nobody")
        self.assertFalse(answer.success)
        self.assertIn("there are 'gripper'", answer.message)
        self.assertTrue(self.detach("gripper").success)
        self.assertGreater(numpy.linalg.norm(self.corner(self.stepped(60)) - self.place), 0.05)
        self.assertIn("nothing is tied", self.detach("gripper").message)

    def test_2_regions_and_nodes(self):
        answer = self.tie(id="ball", radius=0.12)
        self.assertEqual(sorted(zip(answer.tied_rows, answer.tied_columns)), [(8, 7), (9, 6), (9, 7)])
        answer = self.tie(id="nodes", rows=[9, 9], columns=[0, 1], stiffness=200.0)
        self.assertEqual((answer.tied_rows, answer.tied_columns), ((9, 9), (0, 1)))
        self.assertTrue(self.tie(id="box", point=Point(-0.35, 0.0, 0.4), size=Vector3(0.11, 0.1, 0.11)).success)
        self.assertTrue(self.detach("").success)
        self.assertIn("nothing is tied", self.detach("ball").message)

    def test_3_bad_calls_are_refused_in_words(self):
        for fields, text in [
                ({"radius": 0.1, "rows": [9], "columns": [7]}, "one of radius, size and rows"),
                ({"radius": -1.0}, "radius: must be a number in [1e-09, 1000000000], is -1"),
                ({"rows": [99], "columns": [0]}, "row in [0, 9]"),
                ({"rows": [9], "columns": []}, "as many entries as rows"),
                ({"rows": [0], "columns": [0]}, "is pinned by the scene"),
                ({"radius": 0.01, "point": Point(1.0, 0.0, 0.0)}, "holds no free node"),
                ({"point": Point(float("nan"), 0.0, 0.0)}, "point: must be 3 times a number"),
                ({"stiffness": -3.0}, "stiffness")]:
            answer = self.tie(**fields)
            self.assertFalse(answer.success, text)
            self.assertIn(text, answer.message)
        self.assertTrue(self.tie().success)
        self.assertIn("holds the cloth already", self.tie().message)
        answer = self.attach(AttachRequest(frame="nowhere"))
        self.assertFalse(answer.success)
        self.assertIn("frame 'nowhere'", answer.message)

    def test_4_a_lost_frame_a_pull_and_a_reset_untie(self):
        self.assertTrue(self.tie().success)
        self.stepped(3)
        self.stepped(20, sends=False)  # 0.33 s without a transform
        self.assertIn("nothing is tied", self.detach("gripper").message)
        self.assertTrue(self.tie(break_force=0.5).success)
        self.place += [0.5, 0.0, 0.0]
        self.stepped(30)
        self.assertIn("nothing is tied", self.detach("gripper").message)
        self.place = CORNER.copy()
        self.assertTrue(self.tie(radius=0.6).success)
        self.assertTrue(self.reset().success)
        self.assertIn("nothing is tied", self.detach("gripper").message)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "ties", TiesTest, sys.argv)
