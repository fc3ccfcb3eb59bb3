#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A wind source with moves_with_frame goes where its tf2 frame goes, every frame; another stays where it was put."""
import sys
import unittest

import rospy
import rostest
from curtain_testing import Curtain, MovingFrame, billow, publisher, wind_message
from curtain_sim.msg import WindSource

AWAY = (50.0, 0.0, 0.0)  # of the robot; the fan's cone reaches nothing from there
HERE = (0.0, 0.0, 0.0)


class WindFramesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("wind_frames_test")
        cls.curtain = Curtain("/curtain")
        cls.wind = publisher("/wind_source", WindSource)
        cls.robot = MovingFrame("world", "robot", AWAY)
        cls.curtain.next()

    def publish(self, **fields):
        message = wind_message(**fields)
        message.header.frame_id = "robot"
        self.wind.publish(message)

    def run_on(self, frames):
        frame = self.curtain.next().statistics.frame
        return self.curtain.wait_for(lambda s: s.statistics.frame > frame + frames, "%d frames passed" % frames)

    def test_1_the_fan_comes_with_its_robot(self):
        self.publish(moves_with_frame=True)
        self.assertLess(billow(self.run_on(60)), 0.01, "the robot is away")
        self.robot.move_to((-2.0, 0.0, 0.0), 60.0)
        self.robot.move_to(HERE, 1.0)
        self.curtain.wait_for(lambda s: billow(s) > 0.1, "the fan blows at the curtain")

    def test_2_and_leaves_with_it(self):
        self.robot.move_to(AWAY, 60.0)
        self.curtain.wait_for(lambda s: billow(s) < 0.02, "the curtain hangs again")

    def test_3_a_lost_frame_leaves_the_fan_where_it_was(self):
        self.robot.put(HERE)
        self.curtain.wait_for(lambda s: billow(s) > 0.1, "the fan is back")
        self.robot.stop()
        self.assertGreater(billow(self.run_on(120)), 0.05, "it goes on blowing")
        self.robot.start()

    def test_4_deleted_is_forgotten(self):
        self.publish(action=WindSource.DELETE)
        self.curtain.wait_for(lambda s: billow(s) < 0.02, "the wind is gone")
        self.robot.move_to((0.1, 0.0, 0.0), 1.0)
        self.assertLess(billow(self.run_on(60)), 0.02, "it does not come back with its frame")

    def test_5_without_the_flag_the_fan_stays(self):
        self.publish()
        self.curtain.wait_for(lambda s: billow(s) > 0.1, "the fan blows at the curtain")
        self.robot.move_to(AWAY, 60.0)
        self.assertGreater(billow(self.run_on(120)), 0.05, "the robot has left without it")
        self.robot.stop()


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "wind_frames", WindFramesTest, sys.argv)
