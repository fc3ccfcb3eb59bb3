# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of demos with a robot share: their clock, a record of all frames, and the verdict on them."""
import threading
import time

import numpy as np
import rospy
import tf2_ros
from curtain_sim.msg import CurtainState
from curtain_sim.srv import Step
from curtain_testing import wait_until
from std_srvs.srv import Trigger

NODE = "/curtain/curtain_node"
ROBOT = "/curtain/demo_robot"
FRAMES = ("base_footprint", "gripper_tip")  # the one is sent by the robot, the other by robot_state_publisher
STRETCH_TOLERANCE = 1e-3  # solver.stretch_tolerance


class Record:
    """Makes frames, in lock-step: each when the robot has sent where it is after the one before, so that what happens does not
    depend on what else the computer does. Keeps them: stamps, positions [m] of shape [rows, columns, 3], statistics."""

    def __init__(self, places):
        self._places = places
        self._lock = threading.Lock()
        self._frames = []
        self._began = None
        self._subscriber = rospy.Subscriber(NODE + "/state", CurtainState, self._take, queue_size=600, tcp_nodelay=True)
        rospy.wait_for_service(NODE + "/step", 60.0)
        self._step = rospy.ServiceProxy(NODE + "/step", Step, persistent=True)
        begin = time.monotonic()
        while self._began is None:  # what is sent while some of the others still start is lost: it is sent again in the next frame
            assert time.monotonic() - begin < 60.0, "the robot does not start"
            stamp = self._advance()
            if self._robot_is_there(stamp):
                self._began = rospy.get_param(ROBOT + "/began", None)
            else:
                time.sleep(0.1)

    def _take(self, state):
        positions = np.array(state.positions, np.float32).reshape(state.rows, state.columns, 3)
        with self._lock:
            self._frames.append((state.header.stamp, positions, state.statistics))

    def count(self):
        with self._lock:
            return len(self._frames)

    def frames(self):
        with self._lock:
            return list(self._frames)

    def last(self):
        with self._lock:
            return self._frames[-1]

    def _advance(self):
        answer = self._step(1)
        assert answer.success, answer.message
        return answer.stamp

    def _robot_is_there(self, stamp):
        return all(self._places.at(frame, stamp) is not None for frame in FRAMES)

    def run_until_time(self, end):
        """end: since the robot's start, by its clock [s]."""
        stamp = self._advance()
        while self.since_start(stamp) < end:
            wait_until(lambda: self._robot_is_there(stamp), "the robot is there")
            stamp = self._advance()
        wait_until(lambda: self.last()[0] == stamp, "the last frame has come")

    def since_start(self, stamp):
        """Of the robot, by its clock [s]."""
        return stamp.to_sec() - self._began

    def node(self, row, column):
        """Its places in all frames, shape [frames, 3]."""
        return np.array([positions[row, column] for _, positions, _ in self.frames()])

    def times(self):
        """Of all frames, since the robot's start [s]."""
        return np.array([self.since_start(stamp) for stamp, _, _ in self.frames()])


class Places:
    """Where frames of tf2 are, and were in the last minute and a half."""

    def __init__(self):
        self.buffer = tf2_ros.Buffer(rospy.Duration(90.0))
        self.listener = tf2_ros.TransformListener(self.buffer)

    def at(self, frame, stamp):
        """[m] in the world; None: not known."""
        try:
            place = self.buffer.lookup_transform("world", frame, stamp).transform.translation
        except (tf2_ros.LookupException, tf2_ros.ExtrapolationException, tf2_ros.ConnectivityException):
            return None
        return np.array([place.x, place.y, place.z])


def assert_frames_are_sound(test, record):
    """60 a second, none dropped; links of their length, nothing given up, nothing crossed or pierced in any frame."""
    frames = record.frames()
    last = frames[-1][2]
    test.assertAlmostEqual(60.0 * (frames[-1][0] - frames[0][0]).to_sec(), last.frame - frames[0][2].frame, delta=0.5)
    for _, _, statistics in frames:
        test.assertLessEqual(max(statistics.warp_stretch, statistics.weft_stretch), STRETCH_TOLERANCE * (1.0 + 1e-9))
    for count in ("dropped_frames", "last_resort_substeps", "stops", "obstacles_waited", "restarts", "dropped_invalid", "dropped_untransformed"):
        test.assertEqual(getattr(last, count), 0, count)
    verdict = rospy.ServiceProxy("judge_frames/verdict", Trigger)
    verdict.wait_for_service(20.0)
    answer = verdict()
    test.assertTrue(answer.success, answer.message)
    rospy.loginfo(answer.message)
