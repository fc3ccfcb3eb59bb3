#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""robot_curtain.launch: the robot takes the curtain by its free edge near the hem, draws it open by two metres and lets go, comes back and
draws it shut; the hand is pulled at no harder than the curtain's weight and the rail's friction account for, and nothing crosses in
any frame."""
import sys
import unittest

import numpy as np
import rospy
import rostest
from curtain_sim.msg import GraspActionFeedback, GraspActionResult
from curtain_testing import Listener
from robot_testing import NODE, ROBOT, Places, Record, assert_frames_are_sound

GRAVITY = 9.81
HOSPITAL = 0.1972  # kg/m^2, of that material (docs/materials.md)


def distance_to_path(point, corners):
    """[m]; the path goes straight from corner to corner."""
    corners = np.array(corners)
    begins, ways = corners[:-1], np.diff(corners, axis=0)
    shares = np.sum((point - begins) * ways, axis=1) / np.maximum(np.sum(ways * ways, axis=1), 1e-12)
    return np.linalg.norm(begins + np.clip(shares, 0.0, 1.0)[:, None] * ways - point, axis=1).min()


class RobotCurtainTest(unittest.TestCase):
    def test_robot_opens_the_curtain_lets_go_and_shuts_it(self):
        rospy.init_node("robot_curtain_test")
        places = Places()
        felt, ended = Listener(NODE + "/grasp/feedback", GraspActionFeedback), Listener(NODE + "/grasp/result", GraspActionResult)
        record = Record(places)
        scene, motion = rospy.get_param(NODE + "/scene"), rospy.get_param(ROBOT + "/robot")
        opens, shuts = motion["grasps"]
        row, column = next(entry["node"] for entry in motion["arm"] if "node" in entry)
        record.run_until_time(motion["period"] + 1.0)
        times, edge, carrier = record.times(), record.node(row, column), record.node(0, column)

        def at(values, time):
            return values[np.argmin(np.abs(times - time))]

        # The free edge hangs at the rail's end; when the hand lets go its carrier has come two metres, and there it stays.
        self.assertAlmostEqual(at(carrier, 0.5)[0], scene["rail"]["path"][1][0], delta=0.01)
        opened = at(carrier, 0.5)[0] - at(carrier, opens["until"] + 0.5)[0]
        self.assertGreaterEqual(opened, 2.0)
        self.assertGreaterEqual(at(carrier, 0.5)[0] - at(carrier, shuts["from"])[0], 2.0)
        self.assertGreaterEqual(at(carrier, shuts["until"] + 0.5)[0] - at(carrier, shuts["from"])[0], 2.0)

        # It was held: it went where the fingers had been within the last tenth of a second, in the region that they took.
        frames = record.frames()
        behind = [rospy.Duration(k / 60.0) for k in range(7)]
        for hold in (opens, shuts):
            held = np.flatnonzero((times > hold["from"] + 0.5) & (times < hold["until"] - 0.5))
            off = [distance_to_path(edge[i], [places.at("gripper_tip", frames[i][0] - late) for late in behind]) for i in held[::10]]
            self.assertGreater(len(off), 20)
            rospy.loginfo("held within %.3f m", max(off))
            self.assertLess(max(off), hold["radius"])

        # It was let go: it swings back under its carrier, and hangs there while the robot is away.
        for time in (shuts["from"] - 2.0, motion["period"]):
            self.assertLess(np.linalg.norm((at(edge, time) - at(carrier, time))[:2]), 0.05, "at %g s" % time)
        results = [message.result for message in ended.messages()]
        self.assertEqual([result.end for result in results], [GraspActionResult().result.CANCELLED] * 2)
        self.check_pull(felt, record, scene, motion)
        assert_frames_are_sound(self, record)

    def check_pull(self, felt, record, scene, motion):
        """The mean of each second is at most the weight that hangs on the rail. While the hand draws evenly it is at least the friction of
        the carriers that slide: of the weight of their columns, and of what the hand pulls down itself."""
        cloth, carriers, times = scene["cloth"], scene["rail"]["carriers"], record.times()
        weight = GRAVITY * (HOSPITAL * cloth["width"] * cloth["height"] + cloth["columns"] * carriers["mass"])
        pulls = [(record.since_start(m.header.stamp), m.feedback.pull.wrench.force, m.feedback.nodes) for m in felt.messages()]
        self.assertTrue(all(nodes > 0 for _, _, nodes in pulls))
        pulls = np.array([[time, force.x, force.y, force.z] for time, force, _ in pulls])

        def mean(begin):
            return pulls[(pulls[:, 0] >= begin) & (pulls[:, 0] < begin + 1.0), 1:].mean(axis=0)

        for hold in motion["grasps"]:
            for begin in np.arange(hold["from"] + 0.1, hold["until"] - 1.1, 0.5):
                self.assertLess(np.linalg.norm(mean(begin)), weight, "in the second from %g s on" % begin)

        # The base goes evenly in the middle half of its move; the gripper's z axis is up.
        starts, ends = next((a, b) for a, b in zip(motion["base"], motion["base"][1:]) if a[1] - b[1] > 2.0)
        begin = starts[0] + 0.75 * (ends[0] - starts[0]) - 1.0
        first, last = (record.frames()[np.argmin(np.abs(times - time))][1][0, :, 0] for time in (begin, begin + 1.0))
        slid = first - last > 0.9 * (first - last)[-1]
        self.assertGreater((first - last)[-1], 0.3, "the hand draws it")
        down = mean(begin)[2]
        least = carriers["friction"] * (weight * np.count_nonzero(slid) / cloth["columns"] + down)
        self.assertGreater(np.hypot(*mean(begin)[:2]), least)
        rospy.loginfo("pulled by %.2f N along the rail, friction is at least %.2f N; %.2f N down; %.1f N hang there",
                      np.hypot(*mean(begin)[:2]), least, down, weight)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "robot_curtain", RobotCurtainTest, sys.argv)
