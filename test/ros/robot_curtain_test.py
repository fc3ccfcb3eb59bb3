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
from robot_testing import NODE, Places, Record, assert_frames_are_sound

GRAVITY = 9.81


class RobotCurtainTest(unittest.TestCase):
    def test_robot_opens_the_curtain_lets_go_and_shuts_it(self):
        rospy.init_node("robot_curtain_test")
        places = Places()
        felt, ended = Listener(NODE + "/grasp/feedback", GraspActionFeedback), Listener(NODE + "/grasp/result", GraspActionResult)
        record = Record()
        scene, motion = rospy.get_param(NODE + "/scene"), rospy.get_param("/curtain/demo_robot/robot")
        opens, shuts = motion["grasps"]
        row, column = next(entry["node"] for entry in motion["arm"] if "node" in entry)
        record.wait_until_time(motion["period"] + 1.0, "the robot has opened and shut the curtain")
        times, edge, carrier = record.times(), record.node(row, column), record.node(0, column)

        import pickle
        pickle.dump(dict(times=times, edge=edge, carrier=carrier, begin=record.frames()[0][0].to_sec(), top=[p[0] for _, p, _ in record.frames()],
            edgecol=[p[:, -1] for _, p, _ in record.frames()],
            stats=[(s.step_ms, s.dropped_frames, s.last_resort_substeps, s.stops, s.warp_stretch, s.weft_stretch, s.opening, s.substeps, s.asleep) for _, _, s in record.frames()],
            felt=[(m.header.stamp.to_sec(), m.feedback.nodes, m.feedback.pull.wrench.force.x, m.feedback.pull.wrench.force.y, m.feedback.pull.wrench.force.z) for m in felt.messages()],
            tips=[places.at("gripper_tip", f[0]) for f in record.frames()],
            ended=[(m.header.stamp.to_sec(), m.result.end, m.result.message, m.status.status) for m in ended.messages()]), open("/tmp/rc.pickle", "wb"))

        def at(values, time):
            return values[np.argmin(np.abs(times - time))]

        # The free edge hangs at the rail's end; when the hand lets go its carrier has come two metres, and there it stays.
        self.assertAlmostEqual(at(carrier, 0.5)[0], scene["rail"]["path"][1][0], delta=0.01)
        opened = at(carrier, 0.5)[0] - at(carrier, opens["until"] + 0.5)[0]
        self.assertGreaterEqual(opened, 2.0)
        self.assertGreaterEqual(at(carrier, 0.5)[0] - at(carrier, shuts["from"])[0], 2.0)
        self.assertGreaterEqual(at(carrier, shuts["until"] + 0.5)[0] - at(carrier, shuts["from"])[0], 2.0)

        # It was held: it went with the fingers, in the region that they took.
        frames = record.frames()
        for hold in (opens, shuts):
            held = (times > hold["from"] + 0.5) & (times < hold["until"] - 0.5)
            off = [places.at("gripper_tip", frames[i][0]) - edge[i] for i in np.flatnonzero(held)[::10]]
            self.assertGreater(len(off), 20)
            self.assertLess(max(np.linalg.norm(o) for o in off), hold["radius"])

        # It was let go: it swings back under its carrier, and hangs there while the robot is away.
        for time in (shuts["from"] - 2.0, motion["period"]):
            self.assertLess(np.linalg.norm((at(edge, time) - at(carrier, time))[:2]), 0.05, "at %g s" % time)
        results = [message.result for message in ended.messages()]
        self.assertEqual([result.end for result in results], [GraspActionResult().result.CANCELLED] * 2)
        self.check_pull(felt, scene, opens)
        assert_frames_are_sound(self, record)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "robot_curtain", RobotCurtainTest, sys.argv)
