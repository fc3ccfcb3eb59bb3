#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""However /clock runs, every frame is made or counted; however the transforms come, an obstacle is where they say or is left
out, which is counted and told."""
import sys
import time

import rospy
import rostest
from curtain_sim.msg import Contacts
from curtain_testing import OK, WARN, Diagnostics, Listener, assert_stream_is_sound, wait_until, wind_message
from driven_curtain import DrivenCurtain

FRAME = DrivenCurtain.FRAME
TIMEOUT = 0.5  # s, ~obstacle_timeout
HERE = -0.6    # m, the ball's y, clear of the curtain


class FaultsClockTest(DrivenCurtain):
    NAME = "faults_clock_test"  # each test begins earlier than the one before: a new run

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.long = rospy.get_param("/long", False)
        cls.diagnostics = Diagnostics("/curtain")
        cls.contacts = Listener("/curtain/contacts", Contacts)

    def tearDown(self):
        assert_stream_is_sound(self.curtain.messages())

    def assert_all_counted(self, first):
        """Each frame of the grid since then was made or counted as dropped."""
        for state in self.curtain.messages():
            if state.statistics.restarts != first.statistics.restarts:
                continue
            due = (state.header.stamp - first.header.stamp).to_sec() / FRAME
            frames = state.statistics.frame - first.statistics.frame
            dropped = state.statistics.dropped_frames - first.statistics.dropped_frames
            self.assertAlmostEqual(due, frames + dropped, delta=1e-3)

    def test_1_clock_at_a_hundred_times(self):
        """As many frames as can be are made, all others are counted, and the diagnostics warn."""
        first = self.begin(900000.0)
        end = time.monotonic() + (20.0 if self.long else 1.5)
        while time.monotonic() < end:
            self.set_clock(self.now + 0.5)
            time.sleep(0.005)
        self.diagnostics.wait_for("simulation", WARN, "frames dropped")
        goal = self.now
        self.curtain.wait_for(lambda s: s.header.stamp.to_sec() > goal - FRAME, "the last frames are made")
        self.assert_all_counted(first)
        self.assertGreater(self.curtain.last().statistics.dropped_frames, 1000)

    def test_2_clock_jumps_both_ways(self):
        """An hour ahead: four frames, the others counted. An hour back: a new run, said and counted. Again and again."""
        first = self.begin(800000.0)
        for _ in range(5):
            self.set_clock(self.now + 3600.0)
            goal = self.now
            self.curtain.wait_for(lambda s: abs(s.header.stamp.to_sec() - goal) < 1e-6, "the frame of now is made")
            self.assert_all_counted(first)
            jumps = self.curtain.last().statistics.clock_jumps_back
            first = self.begin(self.now - 3600.0)
            self.assertEqual(first.statistics.clock_jumps_back, jumps + 1)
        self.diagnostics.wait_for("simulation", WARN, "clock jumped back")

    def test_3_clock_stands(self):
        """While it does the diagnostics go on, and messages wait; with the next tick they are taken."""
        self.begin(700000.0)
        self.run_until(self.now + 0.2)
        taken = self.curtain.last().statistics.messages_taken
        self.wind.publish(wind_message(pressure=0.0))
        told = self.diagnostics.count()
        wait_until(lambda: self.diagnostics.count() > told + 5, "the diagnostics go on")
        self.assertEqual(self.curtain.last().statistics.messages_taken, taken)
        self.run_until(self.now + FRAME)
        self.assertEqual(self.curtain.last().statistics.messages_taken, taken + 1)

    # ---- transforms ------------------------------------------------------------------------------------------------

    def drive(self, transforms, condition, what, seconds=5.0):
        """Frame by frame with transforms(now) sent before each, until condition(state)."""
        end = self.now + seconds
        while self.now < end:
            transforms(self.now + FRAME)
            self.run_until(self.now + FRAME)
            if condition(self.curtain.last()):
                return self.curtain.last()
        raise AssertionError("driven %g s in vain until %s" % (seconds, what))

    def begin_with_ball(self, start):
        self.begin(start)
        return self.drive(lambda now: self.ball_at(now, HERE), lambda s: s.statistics.absent_obstacles == 0,
                          "the ball is there")

    def left_out_and_back(self, transforms, what, why):
        """With these transforms the ball is left out no sooner than its timeout, which is told with the reason, and comes back
        with good ones."""
        before = self.curtain.last()
        lost = self.drive(transforms, lambda s: s.statistics.absent_obstacles == 1, "the ball is left out: " + what)
        self.assertGreater((lost.header.stamp - before.header.stamp).to_sec(), TIMEOUT - 3 * FRAME)
        self.assertEqual(lost.statistics.obstacles_lost, before.statistics.obstacles_lost + 1)
        self.diagnostics.wait_for("obstacles", WARN, "'ball' is left out", ("ball on ball", why))
        self.drive(lambda now: self.ball_at(now, HERE), lambda s: s.statistics.absent_obstacles == 0, "it is back: " + what)

    def test_4_late(self):
        self.begin_with_ball(600000.0)
        self.diagnostics.wait_for("obstacles", OK, patience=30.0)
        late = self.curtain.last().statistics.late_poses
        self.left_out_and_back(lambda now: self.ball_at(now - 10.0, HERE), "ten seconds late", "s old")
        # Late poses are those between half of the timeout and all of it: 12 or 13 frames of 0.02 s, one or two less where
        # the last good transform came a frame late.
        self.assertIn(self.curtain.last().statistics.late_poses - late, range(10, 15))

    def test_5_one_from_the_future(self):
        """A stray transform ten seconds ahead does not take the ball along: it stays where the others say."""
        self.begin_with_ball(500000.0)
        self.ball_at(self.now + 10.0, 5.0)
        early = self.curtain.last().statistics.early_poses
        state = self.drive(lambda now: self.ball_at(now, HERE), lambda s: s.statistics.early_poses >= early + 50, "it is seen")
        self.assertEqual(state.statistics.absent_obstacles, 0)
        self.diagnostics.wait_for("obstacles", WARN, "ahead of the clock")
        origins = [o.origin.y for m in self.contacts.messages()[-40:] for o in m.obstacles]
        self.assertGreater(len(origins), 30)
        # Between a transform of at most three frames ago and the stray one: 5.6 m * 0.06 s / 10 s.
        for y in origins:
            self.assertAlmostEqual(y, HERE, delta=0.04)

    def test_6_all_from_the_future(self):
        """A sender whose clock is twelve seconds ahead, more than tf2 keeps: nobody knows where the ball is now."""
        self.begin_with_ball(400000.0)
        before = self.curtain.last().statistics
        self.begin(350000.0)
        self.drive(lambda now: self.ball_at(now + 12.0, HERE), lambda s: s.statistics.early_poses > before.early_poses + 30,
                   "it is seen")
        self.assertEqual(self.curtain.last().statistics.absent_obstacles, 1)
        self.diagnostics.wait_for("obstacles", WARN, "'ball' is left out", ("ball on ball", "ahead of the clock"))

    def test_7_renamed(self):
        self.begin_with_ball(300000.0)
        self.left_out_and_back(lambda now: self.ball_at(now, HERE, child="bell"), "renamed", "s old")

    def test_8_tree_in_two(self):
        self.begin_with_ball(200000.0)
        self.left_out_and_back(lambda now: self.ball_at(now, HERE, parent="island"), "on an island",
                               "not part of the same tree")

    def test_9_loop(self):
        """The ball's parents go round in a circle: tf2 finds no end, the node goes on."""
        self.begin_with_ball(100000.0)

        def circle(now):
            self.ball_at(now, 0.1, parent="a", child="b")
            self.ball_at(now, 0.1, parent="b", child="a")
            self.ball_at(now, 0.1, parent="a")
        self.left_out_and_back(circle, "in a loop", "loop")

    def test_9b_out_of_the_world(self):
        """1e12 m away, and NaN: the first is left out, the second tf2 itself refuses."""
        self.begin_with_ball(50000.0)
        self.left_out_and_back(lambda now: self.ball_at(now, 1e12), "out of the world", "further than")
        self.left_out_and_back(lambda now: self.ball_at(now, float("nan")), "nowhere", "s old")


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "faults_clock", FaultsClockTest, sys.argv)
