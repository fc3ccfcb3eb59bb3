#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Under use_sim_time the curtain follows /clock: it stands with it, counts what it drops, and starts again with it."""
import sys
import time

import rospy
import rostest
from curtain_sim.srv import Step
from curtain_testing import Listener, billow, wait_until, wind_message
from driven_curtain import DrivenCurtain
from rosgraph_msgs.msg import Log
from std_srvs.srv import SetBool
from visualization_msgs.msg import Marker

FRAME = DrivenCurtain.FRAME


class ClockTest(DrivenCurtain):
    NAME = "clock_test"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.log = Listener("/rosout", Log)

    def test_1_frames_follow_the_clock(self):
        """Fifty frames a simulated second, stamped with the clock, however fast it runs."""
        first = self.begin(100.0)
        self.run_until(self.now + 1.0)
        state = self.curtain.last()
        self.assertEqual(state.statistics.frame, 51)
        self.assertAlmostEqual((state.header.stamp - first.header.stamp).to_sec(), 1.0, delta=1e-6)
        self.assertAlmostEqual(state.statistics.simulated_time, 51 * FRAME, delta=1e-9)
        self.assertEqual(state.statistics.dropped_frames, 0)

    def test_2_paused_clock_is_a_pause(self):
        """The same time again and again, for half a second: no frame."""
        count = self.curtain.count()
        end = time.monotonic() + 0.5
        while time.monotonic() < end:
            self.set_clock(self.now)
            time.sleep(0.01)
        self.assertEqual(self.curtain.count(), count)

    def test_3_too_late_is_dropped_and_counted(self):
        """A clock that leaps ahead by a second: four frames are made up for, 46 are dropped."""
        frame = self.curtain.last().statistics.frame
        self.set_clock(self.now + 1.0)
        goal = self.now
        state = self.curtain.wait_for(lambda s: abs(s.header.stamp.to_sec() - goal) < 1e-6, "the last frame is made")
        self.assertEqual(state.statistics.dropped_frames, 46)
        self.assertEqual(state.statistics.frame, frame + 4)
        wait_until(lambda: any(m.msg.startswith("dropped 46 frames (46 so far): /clock went on by 1 s within 0.0")
                               for m in self.log.messages()), "it says so, and blames the clock")

    def test_4_clock_that_jumps_back_resets(self):
        """A new run: the cloth and its time start again, the wind of the old run is gone, stamps are of the new run."""
        self.wind.publish(wind_message())
        end = self.now + 1.0
        while self.now < end and not billow(self.curtain.last()) > 0.05:
            self.run_until(self.now + FRAME)
        self.assertGreater(billow(self.curtain.last()), 0.05)
        dropped = self.curtain.last().statistics.dropped_frames
        first = self.begin(50.0)
        self.assertEqual(first.statistics.restarts, 1)
        self.assertLess(first.header.stamp.to_sec(), 55.0)
        self.run_until(self.now + 1.0)
        last = self.curtain.last()
        self.assertEqual(last.statistics.frame, 51)
        self.assertLess(billow(last), 0.01)
        self.assertEqual(last.statistics.dropped_frames, dropped, "counted since the node's start")

    def test_5_obstacles_start_again_with_the_clock(self):
        """A transform of the old run's future places nothing in the new run; the new run's does."""
        def drive_with_ball(condition, y, what):
            end = self.now + 4.0
            while self.now < end:
                self.ball_at(self.now, y)
                self.run_until(self.now + FRAME)
                if condition(self.curtain.last()):
                    return self.curtain.last()
            raise AssertionError(what)
        drive_with_ball(lambda s: s.statistics.absent_obstacles == 0, -0.6, "the ball comes")
        first = self.begin(20.0)
        self.assertEqual(first.statistics.restarts, 2)
        self.run_until(self.now + 0.2)
        self.assertEqual(self.curtain.last().statistics.absent_obstacles, 1, "its transform is of another run")
        drive_with_ball(lambda s: s.statistics.absent_obstacles == 0, -0.6, "the ball comes back")

    def test_6_pause_stops_the_frames_while_the_clock_runs(self):
        """What the clock passes by is neither made nor dropped; frames by ~step are for clocks that are not others'."""
        self.assertTrue(rospy.ServiceProxy("/curtain/pause", SetBool)(True).success)
        answer = rospy.ServiceProxy("/curtain/step", Step)(1)
        self.assertFalse(answer.success)
        self.assertIn("the node follows /clock", answer.message)
        before, start = self.curtain.last(), self.now
        mesh = Listener("/curtain/mesh", Marker)  # who comes in a pause sees the curtain, too

        def seen():
            """Sets the clock on; the time that the node is known to have passed by."""
            self.set_clock(self.now + FRAME)
            return mesh.last() and mesh.last().header.stamp.to_sec()
        passed = wait_until(lambda: (seen() or 0.0) >= start + 50 * FRAME - 1e-6 and seen(), "a second passes by")
        mesh.close()
        self.assertTrue(rospy.ServiceProxy("/curtain/pause", SetBool)(False).success)
        self.set_clock(self.now + FRAME)
        goal = self.now
        state = self.curtain.wait_for(lambda s: abs(s.header.stamp.to_sec() - goal) < 1e-6, "the next frame is made")
        late = round((goal - passed) / FRAME)  # what it may have missed while it went on
        frames = state.statistics.frame - before.statistics.frame
        dropped = state.statistics.dropped_frames - before.statistics.dropped_frames
        self.assertLessEqual(frames + dropped, late)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "clock", ClockTest, sys.argv)
