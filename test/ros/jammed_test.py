#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""An obstacle that waits for jammed cloth is told, and drawn, where it is, and /diagnostics names it; cloth that is stopped stays
awake, and is warned of."""
import sys
import unittest

import rospy
import rostest
from curtain_sim.msg import Contacts, Statistics
from curtain_testing import OK, WARN, Curtain, Diagnostics, Listener, MovingFrame, distance, points
from visualization_msgs.msg import MarkerArray

RADIUS = 0.15
BEFORE = (0.4, -0.3, 0.42)   # it touches nothing here
THROUGH = (0.4, 0.05, 0.42)  # and can't get here
ROUNDING = 1e-6              # of positions in single precision


class JammedTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("jammed_test")
        cls.curtain = Curtain("/curtain")
        cls.contacts = Listener("/curtain/contacts", Contacts)
        cls.markers = Listener("/curtain/markers", MarkerArray)
        cls.diagnostics = Diagnostics("/curtain")
        cls.ball = MovingFrame("world", "hand", BEFORE)

    def deepest(self):
        """How deep nodes are in the ball of the same frame [m], and the ball's lag; over all frames that both told of."""
        nodes = {state.header.stamp: points(state.positions) for state in self.curtain.messages()}
        told = [(m.obstacles[0], nodes[m.header.stamp]) for m in self.contacts.messages()
                if m.obstacles and m.header.stamp in nodes]
        self.assertGreater(len(told), 30)
        deepest = max(RADIUS - min(distance(node, (ball.origin.x, ball.origin.y, ball.origin.z)) for node in around)
                      for ball, around in told)
        return deepest, told[-1][0].lag

    def test_1_a_ball_that_waits(self):
        self.diagnostics.wait_for("obstacles", OK, "all 1 there")
        for listener in (self.curtain, self.contacts):
            listener.clear()
        self.ball.move_to(THROUGH, 0.42)
        frame = self.curtain.last().statistics.frame
        self.curtain.wait_for(lambda s: s.statistics.frame > frame + 30, "half a second passed")
        self.assertGreater(self.curtain.last().statistics.obstacles_waited, 0.1)
        deepest, lag = self.deepest()
        print("a node is %.1f mm inside the ball at most, which is %.1f mm behind" % (1e3 * deepest, 1e3 * lag))
        self.assertLess(deepest, ROUNDING)
        self.assertGreater(lag, 0.1)
        drawn = [m for m in self.markers.next().markers if m.ns == "obstacles"][0].pose.position
        self.assertAlmostEqual(drawn.y, THROUGH[1] - lag, delta=0.01)
        values = self.diagnostics.wait_for("obstacles", WARN, "m behind 'hand'", ("ball on hand", "m behind"))
        self.assertGreater(float(values["seconds waited for cloth"]), 0.1)

    def test_2_a_sheet_that_is_stopped(self):
        """It stands before the ball only because its substeps are stopped: it does not sleep."""
        state = self.curtain.wait_for(lambda s: s.statistics.stops_last > 0, "it is stopped")
        self.diagnostics.wait_for("simulation", WARN, "substeps stopped")
        frame = state.statistics.frame
        state = self.curtain.wait_for(lambda s: s.statistics.frame > frame + 120, "it would have slept")
        self.assertFalse(state.statistics.asleep)
        self.assertGreater(state.statistics.stops_last, 0)
        self.assertEqual(state.statistics.quality, Statistics.STOPPED)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "jammed", JammedTest, sys.argv)
