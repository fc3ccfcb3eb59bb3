#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hands take hold of a curtain by ~grasp: it follows their frames, and they let go of it in every way there is."""
import math
import sys

import actionlib
import numpy
import rospy
import rostest
import tf2_ros
from actionlib_msgs.msg import GoalStatus
from curtain_sim.msg import GraspAction, GraspGoal, GraspResult
from curtain_testing import Listener, wait_until
from driven_curtain import DrivenCurtain
from geometry_msgs.msg import TransformStamped
from visualization_msgs.msg import MarkerArray

FRAME = DrivenCurtain.FRAME
TIMEOUT = 0.2  # s, ~grasp_timeout
FAR = numpy.array([0.45, 0.0, 0.8])  # the middle of the hem


def turn(axis, angle):
    """A quaternion x, y, z, w."""
    axis = numpy.array(axis, float) / numpy.linalg.norm(axis)
    return numpy.append(math.sin(0.5 * angle) * axis, math.cos(0.5 * angle))


def rotate(q, v):
    u = numpy.array(q[:3])
    t = 2.0 * numpy.cross(u, v)
    return numpy.array(v) + q[3] * t + numpy.cross(u, t)


def inverse(q):
    return numpy.array([-q[0], -q[1], -q[2], q[3]])


NONE = turn([0, 0, 1], 0.0)


class GraspTest(DrivenCurtain):
    NAME = "grasp_test"

    @classmethod
    def setUpClass(cls):
        super(GraspTest, cls).setUpClass()
        cls.broadcaster = tf2_ros.TransformBroadcaster()
        cls.client = actionlib.ActionClient("/curtain/grasp", GraspAction)
        wait_until(lambda: all(c.get_num_connections() > 0 for c in
                               (cls.client.pub_goal, cls.client.pub_cancel, cls.client.status_sub,
                                cls.client.result_sub, cls.client.feedback_sub)), "the action is there")
        wait_until(lambda: cls.tf.get_num_connections() > 1 or cls.tf.get_num_connections() > 0, "the node hears tf2")
        cls.frames = {}
        cls.goals = []

    def setUp(self):
        self.frames.clear()
        if self.curtain.last() is None:
            self.begin(10.0)
        self.drive(100)  # it comes to rest from the test before
        self.put("gripper", self.hem())

    def tearDown(self):
        for goal in self.goals:
            if not self.over(goal):
                goal.cancel()
                wait_until(lambda: self.over(goal) or self.drive(), "it has let go")
        del self.goals[:]

    def put(self, name, place, rotation=NONE):
        self.frames[name] = (numpy.array(place, float), numpy.array(rotation, float))

    def drive(self, frames=1):
        """Frames of the simulation, with the present transforms sent before each."""
        for _ in range(frames):
            for name, (place, rotation) in self.frames.items():
                message = TransformStamped()
                message.header.frame_id = "world"
                message.header.stamp = rospy.Time.from_sec(self.now + FRAME)
                message.child_frame_id = name
                (message.transform.translation.x, message.transform.translation.y,
                 message.transform.translation.z) = place
                (message.transform.rotation.x, message.transform.rotation.y, message.transform.rotation.z,
                 message.transform.rotation.w) = rotation
                self.broadcaster.sendTransform(message)
            self.run_until(self.now + FRAME)

    def send(self, feedback=None, **fields):
        """A goal that the node knows of; a ball around the gripper unless it says otherwise."""
        goal = GraspGoal(frame="gripper", region=GraspGoal.SPHERE, radius=0.15)
        for key, value in fields.items():
            at = goal
            for part in key.split("__")[:-1]:
                at = getattr(at, part)
            setattr(at, key.split("__")[-1], value)
        self.drive(2)  # the node knows the frames
        handle = self.client.send_goal(goal, feedback_cb=feedback and (lambda _, f: feedback(f)))
        self.goals.append(handle)
        # The server's status comes with the clock, and with what becomes of the goal.
        wait_until(lambda: handle.get_comm_state() != actionlib.CommState.WAITING_FOR_GOAL_ACK or self.drive(),
                   "the goal has come")
        return handle

    def hold(self, feedback=None, **fields):
        """A goal that holds."""
        handle = self.send(feedback, **fields)
        wait_until(lambda: handle.get_goal_status() != GoalStatus.PENDING or self.drive(), "it is taken")
        self.assertEqual(handle.get_goal_status(), GoalStatus.ACTIVE, handle.get_goal_status_text())
        return handle

    @staticmethod
    def over(handle):
        return handle.get_comm_state() == actionlib.CommState.DONE

    def end_of(self, handle, frames=500):
        """Drives until the goal is over: its terminal state and result."""
        for _ in range(frames):
            if self.over(handle):
                break
            self.drive()
        wait_until(lambda: self.over(handle), "the goal is over")
        return handle.get_terminal_state(), handle.get_result()

    def hem(self):
        """The middle of the hem, where it is now."""
        return self.nodes()[12 * 11 + 5]

    def near(self, name, radius=0.15):
        """Nodes within a ball around a frame, and their places in it."""
        place, rotation = self.frames[name]
        return {n: rotate(inverse(rotation), at - place) for n, at in enumerate(self.nodes())
                if numpy.linalg.norm(at - place) <= radius}

    def nodes(self):
        return numpy.array(self.curtain.last().positions).reshape(-1, 3)

    def farthest_from(self, places, pose):
        """Of held nodes, from their places in a frame."""
        place, rotation = pose
        return max(numpy.linalg.norm(rotate(inverse(rotation), self.nodes()[n] - place) - at)
                   for n, at in places.items())

    def test_1_what_is_held_follows_the_frame_at_every_state(self):
        heard = []
        self.hold(heard.append)
        wait_until(lambda: heard, "feedback comes")
        places = self.near("gripper")
        self.assertEqual(len(places), heard[-1].nodes)
        self.assertGreater(len(places), 3)
        sent = [self.frames["gripper"]]
        for k in range(150):  # up to 3 m/s, jerked, turned
            angle = 2.0 * math.pi * k / 50.0
            jerk = 0.02 if k % 7 == 0 else 0.0
            self.put("gripper", FAR + [0.3 * math.sin(angle), 0.3 - 0.3 * math.cos(angle) + jerk, 0.2],
                     turn([0.3, 1.0, 0.2], 0.8 * math.sin(1.7 * angle)))
            self.drive()
            # Transforms and clock come by different ways: what was sent last may come after the frame has begun. Then it
            # is at one that was sent before, never between two.
            sent.append(self.frames["gripper"])
            off = min(self.farthest_from(places, pose) for pose in sent[-10:])
            self.assertLessEqual(off, 1e-4, "frame %d" % k)
        self.assertEqual(heard[-1].slipped, 0.0)

    def test_2_cancelled_it_lets_go(self):
        handle = self.hold()
        self.put("gripper", FAR + [0.0, 0.4, 0.3])
        self.drive(25)
        self.assertGreater(max(self.nodes()[:, 1]), 0.35)
        handle.cancel()
        state, result = self.end_of(handle)
        self.assertEqual((state, result.end), (GoalStatus.PREEMPTED, GraspResult.CANCELLED))
        self.drive(100)
        self.assertLess(max(self.nodes()[:, 1]), 0.2, "it hangs again")

    def test_3_pull_is_in_the_grippers_frame(self):
        heard = []
        self.put("gripper", self.hem(), turn([1, 0, 0], math.pi))  # upside down
        self.hold(heard.append)
        self.put("gripper", FAR + [0.0, 0.0, 0.3], turn([1, 0, 0], math.pi))
        self.drive(150)
        wait_until(lambda: heard[-1].nodes > 0, "feedback comes")
        pull = heard[-1].pull
        self.assertEqual(pull.header.frame_id, "gripper")
        weight = 0.2 * 1.2 * 1.0 * 9.81
        self.assertGreater(pull.wrench.force.z, 0.1 * weight, "down, in a frame that is upside down")
        self.assertLess(pull.wrench.force.z, weight)

    def test_4_ends_by_itself(self):
        handle = self.hold(lifetime=0.3)
        began = self.curtain.last().statistics.simulated_time
        state, result = self.end_of(handle)
        self.assertEqual((state, result.end), (GoalStatus.SUCCEEDED, GraspResult.RELEASED))
        self.assertLessEqual(self.curtain.last().statistics.simulated_time - began, 0.3 + 3 * FRAME)

    def test_5_is_torn_out(self):
        handle = self.hold(break_force=8.0)
        for k in range(60):
            self.put("gripper", FAR - [0.0, 0.0, 0.01 * k])
            self.drive()
            if self.over(handle):
                break
        state, result = self.end_of(handle, 5)
        self.assertEqual((state, result.end), (GoalStatus.ABORTED, GraspResult.BROKEN))
        self.assertIn("reached break_force", result.message)

    def test_6_slips_out(self):
        heard = []
        handle = self.hold(heard.append, pinch_force=0.5, friction=0.5)
        for k in range(120):
            self.put("gripper", FAR - [0.0, 0.0, 0.01 * k])
            self.drive()
            if self.over(handle):
                break
        state, result = self.end_of(handle, 5)
        self.assertEqual((state, result.end), (GoalStatus.ABORTED, GraspResult.SLIPPED_OUT))
        self.assertGreater(result.slipped, 0.05)
        self.assertGreater(max(f.slipped for f in heard), 0.02)

    def test_7_lost_frame(self):
        heard = []
        handle = self.hold(heard.append)
        held = list(self.near("gripper"))
        self.put("gripper", FAR + [0.0, 0.2, 0.1])
        self.drive(5)
        there = self.nodes()[held]
        del self.frames["gripper"]
        lost = self.now
        while self.now < lost + TIMEOUT - 1.5 * FRAME:
            self.drive()
            self.assertLess(numpy.abs(self.nodes()[held] - there).max(), 1e-6, "it holds where it was")
        wait_until(lambda: heard[-1].late, "feedback says so")
        state, result = self.end_of(handle, 5)
        self.assertEqual((state, result.end), (GoalStatus.ABORTED, GraspResult.FRAME_LOST))
        self.assertIn("~grasp_timeout", result.message)
        self.drive(5)
        self.assertGreater(numpy.abs(self.nodes()[held] - there).max(), 1e-3, "it has let go")

    def test_7b_silence_is_made_up_for_at_twice_the_speed(self):
        """A frame that moves evenly is not heard of for 0.16 s: what is held does not jump after it."""
        self.hold()
        held = list(self.near("gripper"))
        start, step = self.hem(), 0.5 * FRAME
        before, fastest = self.nodes()[held], 0.0
        for k in range(1, 41):
            self.put("gripper", start + [0.0, step * k, 0.0])
            if 10 <= k < 18:
                silent = self.frames.pop("gripper")
                self.drive()
                self.frames["gripper"] = silent
            else:
                self.drive()
            there = self.nodes()[held]
            fastest = max(fastest, numpy.linalg.norm(there - before, axis=1).max())
            before = there
        self.assertLessEqual(fastest, 2.0 * step + 1e-4)
        self.assertGreater(fastest, 1.5 * step, "it catches up")
        self.drive(3)
        self.assertLess(abs(self.hem()[1] - start[1] - 40 * step), 1e-4)

    def test_8_several_hands_hand_over(self):
        left = self.hold(region=GraspGoal.NODES, rows=[12, 12], columns=[4, 5])
        self.put("right", self.hem())
        both = []
        right = self.hold(both.append, frame="right", radius=0.25)
        wait_until(lambda: both, "feedback comes")
        listener = Listener("/curtain/markers", MarkerArray)

        def drawn():
            if listener.last() is None:
                self.drive()
                return None
            return [m for m in listener.last().markers if m.ns == "grasps"]
        markers = wait_until(drawn, "markers come")
        self.assertEqual(len(markers[0].points), both[-1].nodes + 2)
        listener.close()
        left.cancel()
        self.assertEqual(self.end_of(left)[1].end, GraspResult.CANCELLED)
        self.put("right", FAR + [0.0, 0.3, 0.2])
        self.drive(25)
        self.assertGreater(max(self.nodes()[:, 1]), 0.29)
        self.assertEqual(right.get_goal_status(), GoalStatus.ACTIVE)

    def refused(self, words, **fields):
        before = self.curtain.last().statistics.dropped_invalid
        handle = self.send(**fields)
        state, result = self.end_of(handle, 5)
        self.assertEqual((state, result.end), (GoalStatus.REJECTED, GraspResult.REFUSED))
        for word in words:
            self.assertIn(word, result.message)
        self.drive()
        self.assertEqual(self.curtain.last().statistics.dropped_invalid, before + 1)

    def test_9_bad_input_is_refused_in_words(self):
        nan = float("nan")
        self.refused(["frame", "'nowhere' is not known in 'world'"], frame="nowhere")
        self.put("away", FAR + [0.0, 9.0, 0.0])
        self.refused(["holds no free node"], frame="away")
        self.refused(["radius: must be a number"], radius=-0.1)
        self.refused(["radius: must be a number"], radius=nan)
        self.refused(["size[1]: must be a number"], region=GraspGoal.BOX, size__x=0.1, size__z=0.1)
        self.refused(["place.position[2]"], place__position__z=nan)
        self.refused(["place.orientation: must be a unit quaternion"], place__orientation__z=3.0)
        self.refused(["break_force: must be a number"], break_force=-1.0)
        self.refused(["pinch_force: must be a number"], pinch_force=-1.0)
        self.refused(["stiffness: must be a number"], stiffness=nan)
        self.refused(["friction: must be a number"], friction=-0.5, pinch_force=1.0)
        self.refused(["lifetime: must be a number"], lifetime=-1.0)
        self.refused(["region: must be SPHERE"], region=7)
        self.refused(["nodes: must list at least one"], region=GraspGoal.NODES)
        self.refused(["columns: must have as many"], region=GraspGoal.NODES, rows=[1, 2], columns=[1])
        self.refused(["nodes[0]: must be [row, column]"], region=GraspGoal.NODES, rows=[13], columns=[0])
        self.refused(["is pinned by the scene"], region=GraspGoal.NODES, rows=[0], columns=[3])
        self.hold(region=GraspGoal.NODES, rows=[8], columns=[3])
        self.refused(["node [8, 3] is held already"], region=GraspGoal.NODES, rows=[8], columns=[3])
        self.refused(["frame: must be no longer than"], frame="f" * 300)

    def test_a_restart_lets_go(self):
        """A clock that jumps back starts the curtain anew: the goal ends, and the cloth hangs as at its start."""
        handle = self.hold()
        self.put("gripper", FAR + [0.0, 0.3, 0.2])
        self.drive(10)
        self.frames.clear()
        self.begin(5.0)
        wait_until(lambda: self.over(handle), "the goal is over")
        self.assertEqual((handle.get_terminal_state(), handle.get_result().end),
                         (GoalStatus.ABORTED, GraspResult.RESET))
        self.assertLess(numpy.abs(self.nodes()[:, 1]).max(), 0.2)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "grasp", GraspTest, sys.argv)
