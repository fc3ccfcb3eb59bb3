#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A handle that is pulled takes its node along; let go, or fallen silent, it gives the node free and follows it."""
import sys
import unittest

import rospy
import rostest
from curtain_testing import Curtain, Listener, billow, distance, node_position, publisher, wait_until
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit, InteractiveMarkerUpdate

HEM = 9
TARGET = (0.4, 0.4, 1.4)


class HandlesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("handles_test")
        cls.curtain = Curtain("/curtain")
        cls.feedback = publisher("/curtain/handles/feedback", InteractiveMarkerFeedback)
        cls.curtain.next()

    def send(self, event, position=TARGET):
        message = InteractiveMarkerFeedback()
        message.header.frame_id = "world"
        message.client_id = "handles_test"
        message.marker_name = "handle_4"
        message.control_name = "pull"
        message.event_type = event
        message.pose.position.x, message.pose.position.y, message.pose.position.z = position
        message.pose.orientation.w = 1.0
        self.feedback.publish(message)

    def test_1_five_handles_on_the_hem(self):
        init = Listener("/curtain/handles/update_full", InteractiveMarkerInit)
        markers = {m.name: m for m in wait_until(init.last, "the handles are there").markers}
        self.assertEqual(sorted(markers), ["handle_0", "handle_2", "handle_4", "handle_6", "handle_8"])
        self.assertEqual(markers["handle_0"].header.frame_id, "world")

    def test_2_pulled_handle_takes_its_node_along(self):
        self.send(InteractiveMarkerFeedback.MOUSE_DOWN, node_position(self.curtain.last(), HEM, 4))
        self.send(InteractiveMarkerFeedback.POSE_UPDATE)
        # Weight of the cloth on the spring: 0.14 kg * g / 100 N/m = 14 mm at most.
        self.curtain.wait_for(lambda s: distance(node_position(s, HEM, 4), TARGET) < 0.05, "the node is at the handle")

    def test_3_released_handle_gives_its_node_free(self):
        self.send(InteractiveMarkerFeedback.POSE_UPDATE)
        self.curtain.wait_for(lambda s: billow(s) > 0.3, "the node is pulled")
        self.send(InteractiveMarkerFeedback.MOUSE_UP)
        self.curtain.wait_for(lambda s: billow(s) < 0.05, "the node swings back")

    def test_4_silent_handle_lets_go(self):
        """An rviz that is closed with a handle in its hand sends nothing any more."""
        self.send(InteractiveMarkerFeedback.POSE_UPDATE)
        self.curtain.wait_for(lambda s: billow(s) > 0.3, "the node is pulled")
        self.curtain.wait_for(lambda s: billow(s) < 0.05, "the node swings back")

    def test_5_free_handle_follows_its_node(self):
        """While somebody looks, the handle is sent where its node is, about ten times a second."""
        updates = Listener("/curtain/handles/update", InteractiveMarkerUpdate)

        def shown():
            for message in reversed(updates.messages()):
                for pose in message.poses:
                    if pose.name == "handle_0":
                        return (pose.pose.position.x, pose.pose.position.y, pose.pose.position.z)
            return None
        self.send(InteractiveMarkerFeedback.POSE_UPDATE)  # another handle pulls the whole hem
        self.curtain.wait_for(lambda s: node_position(s, HEM, 0)[1] > 0.05, "the corner moves with its neighbours")
        self.send(InteractiveMarkerFeedback.MOUSE_UP)
        self.curtain.wait_for(lambda s: billow(s) < 0.02, "the curtain hangs again")
        wait_until(lambda: shown() and distance(shown(), node_position(self.curtain.last(), HEM, 0)) < 0.01,
                   "the handle is at its node")
        updates.close()


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "handles", HandlesTest, sys.argv)
