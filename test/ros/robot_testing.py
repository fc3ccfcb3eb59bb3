# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of demos with a robot share: a record of all frames, and the verdict on them."""
import threading

import numpy as np
import rospy
import tf2_ros
from curtain_sim.msg import CurtainState
from curtain_testing import wait_until
from std_srvs.srv import Trigger

NODE = "/curtain/curtain_node"
ROBOT = "/curtain/demo_robot"
STRETCH_TOLERANCE = 1e-3  # solver.stretch_tolerance


class Record:
    """All frames: stamps, positions [m] of shape [rows, columns, 3], statistics."""

    def __init__(self):
        self._lock = threading.Lock()
        self._frames = []
        self._began = None
        self._subscriber = rospy.Subscriber(NODE + "/state", CurtainState, self._take, queue_size=600, tcp_nodelay=True)
        wait_until(self.count, "the curtain moves", 60.0)

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

    def wait_until_time(self, time, what):
        """time: since the robot's start, by its clock [s]."""
        wait_until(lambda: rospy.has_param(ROBOT + "/began"), "the robot starts", 60.0)
        self._began = rospy.get_param(ROBOT + "/began")
        wait_until(lambda: self.last()[0].to_sec() >= self._began + time, what, 60.0 + 2.0 * time)

    def since_start(self, stamp):
        """Of the robot, by its clock [s]. Simulated time falls behind it by the frames that are dropped."""
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
    """60 a second, made or told as dropped; links of their length, nothing given up, nothing crossed or pierced in any
    frame. How many are dropped depends on what else the computer does: that is told, not judged."""
    frames = record.frames()
    first, last = frames[0][2], frames[-1][2]
    dropped, made = last.dropped_frames - first.dropped_frames, last.frame - first.frame
    test.assertAlmostEqual(60.0 * (frames[-1][0] - frames[0][0]).to_sec(), made + dropped, delta=0.5)
    for _, _, statistics in frames:
        test.assertLessEqual(max(statistics.warp_stretch, statistics.weft_stretch), STRETCH_TOLERANCE * (1.0 + 1e-9))
    for count in ("last_resort_substeps", "stops", "obstacles_waited", "restarts", "dropped_invalid", "dropped_untransformed"):
        test.assertEqual(getattr(last, count), 0, count)
    verdict = rospy.ServiceProxy("judge_frames/verdict", Trigger)
    verdict.wait_for_service(20.0)
    answer = verdict()
    test.assertTrue(answer.success, answer.message)
    rospy.loginfo("%d frames dropped of %d; %s", dropped, made, answer.message)
