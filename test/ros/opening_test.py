#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A curtain on a rail opens and shuts by ~open and by ~open_curtain, and ~tie_back gathers it; what is out of range is
refused and counted."""
import math
import sys
import threading
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from curtain_sim.msg import OpenCurtainAction, OpenCurtainGoal
from curtain_sim.srv import TieBack
from curtain_testing import Curtain, Listener, publisher, wait_until
from std_msgs.msg import Float64
from visualization_msgs.msg import MarkerArray

MASTER = 20  # its column


class OpeningTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("opening_test")
        cls.curtain = Curtain("/curtain")
        cls.open = publisher("/curtain/open", Float64)
        cls.client = actionlib.SimpleActionClient("/curtain/open_curtain", OpenCurtainAction)
        assert cls.client.wait_for_server(rospy.Duration(20.0))
        cls.curtain.next()

    def setUp(self):
        # By a goal, not by ~open: a message that is still on its way would take the place of the test's own goal.
        self.send(opening=0.0)
        self.assertEqual(self.wait_for_end()[0], GoalStatus.SUCCEEDED)
        self.wait_for_opening(0.0)

    def wait_for_opening(self, opening):
        return self.curtain.wait_for(lambda s: abs(s.statistics.opening - opening) < 1e-6, "it is open by %g" % opening)

    def send(self, feedback=None, **fields):
        self.client.send_goal(OpenCurtainGoal(**fields), feedback_cb=feedback)

    def wait_for_end(self):
        """The goal's terminal state and result."""
        done = threading.Event()
        threading.Thread(target=lambda: (self.client.wait_for_result(), done.set()), daemon=True).start()
        wait_until(done.is_set, "the goal has ended", 40.0)
        return self.client.get_state(), self.client.get_result()

    def test_topic_moves_the_master(self):
        shut = self.curtain.last().positions[3 * MASTER]
        self.open.publish(1.0)
        opened = self.wait_for_opening(1.0).positions[3 * MASTER]
        self.assertGreater(shut, 0.95)
        self.assertLess(opened, 0.1)

    def test_markers_show_rail_and_carriers(self):
        listener = Listener("/curtain/markers", MarkerArray)
        wait_until(listener.last, "markers come")
        markers = {m.ns: m for m in listener.last().markers}
        rail = [(p.x, p.y, p.z) for p in markers["rail"].points]
        self.assertEqual((rail[0], rail[-1]), ((0.0, 0.0, 2.0), (1.0, 0.0, 2.0)))
        carriers = markers["carriers"].points
        self.assertEqual(len(carriers), 6)  # every fourth of 21 columns
        self.assertTrue(all(p.y == 0.0 and abs(p.z - 2.0) < 1e-12 for p in carriers))
        listener.close()

    def test_service_ties_it_back_and_lets_it_go(self):
        tie_back = rospy.ServiceProxy("/curtain/tie_back", TieBack)
        tie_back.wait_for_service(20.0)

        def farthest(state):
            nodes = range(6 * 21, 6 * 21 + 9)
            return max(math.dist(state.positions[3 * n:3 * n + 3], (0.2, 0.0, 1.5)) for n in nodes)

        self.assertTrue(tie_back("tie", True).success)
        self.curtain.wait_for(lambda s: farthest(s) <= 0.1001, "it is tied")
        self.assertTrue(tie_back("tie", False).success)
        self.curtain.wait_for(lambda s: farthest(s) > 0.12, "it is let go")
        answer = tie_back("rope", True)
        self.assertFalse(answer.success)
        self.assertIn("'tie'", answer.message)

    def test_lines_and_loads_are_drawn(self):
        listener = Listener("/curtain/markers", MarkerArray)
        wait_until(listener.last, "markers come")
        markers = {(m.ns, m.id): m for m in listener.last().markers}
        self.assertEqual(len(markers["lines", 0].points), 2)
        self.assertEqual(len(markers["lines", 1].points), 1)
        self.assertEqual(markers["lines", 0].points[1], markers["lines", 1].points[0])
        listener.close()

    def test_action_says_how_far_it_is_and_that_it_has_arrived(self):
        heard = []
        self.send(heard.append, opening=0.6)
        state, result = self.wait_for_end()
        self.assertEqual(state, GoalStatus.SUCCEEDED)
        self.assertAlmostEqual(result.opening, 0.6, delta=2e-3)
        openings = [f.opening for f in heard]
        self.assertGreater(len(openings), 5)
        self.assertEqual(openings, sorted(openings))
        self.assertTrue(all(0.0 <= f.force <= 20.0 + 1e-9 for f in heard))

    def test_speed_is_that_of_the_goal(self):
        began = self.curtain.last().statistics.simulated_time
        self.send(opening=1.0, speed=0.5)
        self.wait_for_end()
        # 0.9 m at 0.5 m/s; a frame or two more until everybody has heard of it.
        self.assertGreater(self.curtain.last().statistics.simulated_time - began, 1.7)

    def test_too_weak_a_drive_is_given_up(self):
        self.send(opening=1.0, force=0.01)
        state, result = self.wait_for_end()
        self.assertEqual(state, GoalStatus.ABORTED)
        self.assertIn("force", result.message)
        self.curtain.wait_for(lambda s: s.statistics.drive_force == 0.0, "the drive has let go")

    def test_cancelled_goal_lets_go(self):
        self.send(opening=1.0, speed=0.1)
        self.curtain.wait_for(lambda s: s.statistics.opening > 0.05, "it opens")
        self.client.cancel_goal()
        state, _ = self.wait_for_end()
        self.assertEqual(state, GoalStatus.PREEMPTED)
        self.curtain.wait_for(lambda s: s.statistics.drive_force == 0.0, "the drive has let go")

    def test_topic_takes_the_place_of_a_goal(self):
        self.send(opening=1.0, speed=0.1)
        self.curtain.wait_for(lambda s: s.statistics.opening > 0.05, "it opens")
        self.open.publish(0.0)
        state, result = self.wait_for_end()
        self.assertEqual(state, GoalStatus.PREEMPTED)
        self.assertIn("~open", result.message)
        self.wait_for_opening(0.0)

    def test_what_is_out_of_range_is_refused_and_counted(self):
        refused = self.curtain.last().statistics.dropped_invalid
        for opening in (-0.1, 1.1, float("nan")):
            self.open.publish(opening)
        self.send(opening=2.0)
        state, result = self.wait_for_end()
        self.assertEqual(state, GoalStatus.REJECTED)
        self.assertIn("opening: must be a number in [0, 1]", result.message)
        self.send(opening=0.5, speed=-1.0)
        self.assertEqual(self.wait_for_end()[0], GoalStatus.REJECTED)
        self.curtain.wait_for(lambda s: s.statistics.dropped_invalid == refused + 5, "all five are counted")
        self.assertAlmostEqual(self.curtain.last().statistics.opening, 0.0, delta=1e-6)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "opening", OpeningTest, sys.argv)
