# SPDX-License-Identifier: BSD-3-Clause
"""For tests that drive /clock themselves, frame by frame, and the transforms with it."""
import time
import unittest

import rospy
from curtain_sim.msg import WindSource
from curtain_testing import Curtain, publisher, wait_until
from geometry_msgs.msg import TransformStamped
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage


class DrivenCurtain(unittest.TestCase):
    """Tests of the node /curtain, 50 frames a second, with a ball on the frame `ball`."""

    FRAME = 0.02  # s
    NAME = "driven"

    @classmethod
    def setUpClass(cls):
        rospy.init_node(cls.NAME)
        cls.clock = publisher("/clock", Clock)
        wait_until(lambda: cls.clock.get_num_connections() > 1, "the node listens to the clock, not only this test")
        cls.wind = publisher("/wind_source", WindSource)
        cls.tf = publisher("/tf", TFMessage)
        cls.curtain = Curtain("/curtain")
        wait_until(lambda: cls.curtain._subscriber.get_num_connections() > 0, "the node is there")
        cls.now = 0.0

    @classmethod
    def set_clock(cls, now):
        cls.now = now
        cls.clock.publish(Clock(clock=rospy.Time.from_sec(now)))

    def run_until(self, end):
        """Drives the clock frame by frame; each is made before the next is asked for."""
        while self.now < end - 1e-9:
            goal = self.now + self.FRAME
            self.set_clock(goal)
            self.curtain.wait_for(lambda s: abs(s.header.stamp.to_sec() - goal) < 1e-6, "the frame of %g s" % goal)

    def begin(self, start):
        """Starts a run of the clock and drives it up to its first frame, which is returned."""
        self.curtain.clear()
        self.set_clock(start)
        while self.curtain.last() is None:
            # A node that was held up may see a later time first: then its first frame is as much later.
            patience = time.monotonic() + 0.1
            while self.curtain.last() is None and time.monotonic() < patience:
                time.sleep(0.002)
            if self.curtain.last() is None:
                self.assertLess(self.now, start + 5.0, "no frame comes")
                self.set_clock(self.now + self.FRAME)
        first = self.curtain.messages()[0]
        self.assertEqual(first.statistics.frame, 1)
        self.assertGreaterEqual(first.header.stamp.to_sec(), start + self.FRAME - 1e-6)
        return first

    def ball_at(self, stamp, y, parent="world", child="ball"):
        transform = TransformStamped()
        transform.header.stamp = rospy.Time.from_sec(stamp)
        transform.header.frame_id = parent
        transform.child_frame_id = child
        transform.transform.translation.x = 0.35
        transform.transform.translation.y = y
        transform.transform.translation.z = 1.4
        transform.transform.rotation.w = 1.0
        self.tf.publish(TFMessage([transform]))
