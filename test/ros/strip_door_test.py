#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""strip_door.launch: the robot drives through the door of strips at 1 m/s and back; the strips give way, hang still again, and
nothing crosses in any frame."""
import sys
import unittest

import numpy as np
import rospy
import rostest
from robot_testing import ROBOT, Places, Record, assert_frames_are_sound


class StripDoorTest(unittest.TestCase):
    def test_robot_goes_through_and_strips_come_back(self):
        rospy.init_node("strip_door_test")
        places = Places()
        record = Record(places)
        motion = rospy.get_param(ROBOT + "/robot")
        (_, _, begin, _), (there, _, end, _), (leaves, _, _, _), (back, _, _, _) = motion["base"]
        record.run_until_time(motion["period"] + 1.0)
        frames, times = record.frames(), record.times()

        # The base, 1 m/s at the door on both ways.
        driven = [(stamp.to_sec(), places.at("base_footprint", stamp)) for stamp, _, _ in frames]
        driven = np.array([[t, place[1]] for t, place in driven if place is not None])
        self.assertAlmostEqual(driven[:, 1].min(), min(begin, end), delta=1e-3)
        self.assertAlmostEqual(driven[:, 1].max(), max(begin, end), delta=1e-3)
        at_door = np.abs(driven[:, 1]) < 0.5
        speed = np.diff(driven[:, 1]) / np.diff(driven[:, 0])
        both = at_door[1:] & at_door[:-1]
        for way in (1.0, -1.0):
            self.assertAlmostEqual(np.median(speed[both & (way * speed > 0.0)]), way, delta=0.02)

        # The strips give way: their hems are further off than the robot is high, and on both sides.
        hem = np.array([positions[-1, :, 1] for _, positions, _ in frames])
        self.assertGreater(hem.max(), 0.4)
        self.assertLess(hem.min(), -0.4)

        # And hang still again before it comes back, and at the end.
        start = frames[0][1]
        for rest in (leaves, motion["period"]):
            near = np.argmin(np.abs(times - rest))
            self.assertLess(np.abs(frames[near][1] - start).max(), 0.05, "at %.1f s" % rest)
        assert_frames_are_sound(self, record)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "strip_door", StripDoorTest, sys.argv)
