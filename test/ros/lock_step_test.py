#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""With ~publish_clock the node is the clock: others' time advances by its frames alone, which ~step makes."""
import os
import re
import sys
import tempfile
import time
import unittest

import numpy
import rospy
import rostest
from curtain_sim.msg import DragForce
from curtain_sim.srv import Load, Save, Step
from curtain_testing import OK, Curtain, Diagnostics, Listener, assert_stream_is_sound, publisher, service, wait_until
from geometry_msgs.msg import TransformStamped
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage

NODE = "/curtain/curtain_node"
ORIGIN = 1.0  # s, that the clock begins at


class LockStepTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("learner")
        cls.ticks = Listener("/clock", Clock)
        cls.curtain = Curtain(NODE)
        cls.step, cls.reset = service(NODE, "step", Step), service(NODE, "reset", Trigger)
        cls.pause = service(NODE, "pause", SetBool)
        wait_until(lambda: cls.curtain._subscriber.get_num_connections() > 0, "the node is there")

    def good(self, answer):
        self.assertTrue(answer.success, answer.message)
        return answer

    def stepped(self, frames):
        """The answer, and the state that comes with it."""
        answer = self.good(self.step(frames))
        wait_until(lambda: rospy.Time.now() == answer.stamp, "the clock says so here, too")
        return answer, self.curtain.wait_for(lambda s: s.header.stamp == answer.stamp, "the state is here")

    def test_1_stands_at_the_start(self):
        """There is a time before the first frame, and nothing but ~step takes it on."""
        wait_until(lambda: rospy.Time.now().to_sec() == ORIGIN, "the clock has a time")
        Diagnostics(NODE).wait_for("simulation", OK, "paused")
        self.assertEqual(rospy.Time.now().to_sec(), ORIGIN)
        self.assertEqual(self.curtain.count(), 0)

    def test_2_advances_by_steps_alone(self):
        """A frame is 1/60 s of everybody's time, its number and its stamp are known, and each state is had."""
        for k in range(1, 31):
            answer, state = self.stepped(1)
            self.assertEqual(answer.frame, k)
            self.assertEqual(state.statistics.frame, k)
            self.assertAlmostEqual(answer.stamp.to_sec(), ORIGIN + k / 60.0, delta=1e-9)
            self.assertAlmostEqual(answer.simulated_time, k / 60.0, delta=1e-12)
        self.assertEqual([m.clock for m in self.ticks.messages()][1:],
                         [s.header.stamp for s in self.curtain.messages()])

    def test_3_batches(self):
        """Of a batch the last state comes, at least; the clock is where it ends."""
        before, _ = self.stepped(1)
        answer, _ = self.stepped(100)
        self.assertAlmostEqual((answer.stamp - before.stamp).to_sec(), 100 / 60.0, delta=2e-9)
        self.assertEqual(self.curtain.last().statistics.dropped_frames, 0)

    def test_4_frames_age_by_this_clock(self):
        """An obstacle broadcast once a frame is there, however long the learner thinks between two."""
        transforms = publisher("/tf", TFMessage)

        def send():
            transform = TransformStamped()
            transform.header.stamp = rospy.Time.now()
            transform.header.frame_id, transform.child_frame_id = "world", "ball"
            transform.transform.translation.y = -1.0
            transform.transform.rotation.w = 1.0
            transforms.publish(TFMessage([transform]))

        def there():
            send()
            return self.stepped(1)[1].statistics.absent_obstacles == 0
        wait_until(there, "the ball is there")
        start = time.monotonic()
        wait_until(lambda: time.monotonic() - start > 1.0, "twice ~obstacle_timeout has passed elsewhere")
        _, state = self.stepped(1)
        self.assertEqual(state.statistics.absent_obstacles, 0)
        _, state = self.stepped(40)  # 0.67 s without a transform
        self.assertEqual(state.statistics.absent_obstacles, 1)

    def test_5_reset_and_load_begin_a_run_but_the_clock_goes_on(self):
        path = os.path.join(tempfile.mkdtemp(), "state")
        before, first = self.stepped(1)
        self.good(service(NODE, "save", Save)(path))
        _, later = self.stepped(20)
        self.good(self.reset())
        answer, state = self.stepped(1)
        self.assertEqual((answer.frame, state.statistics.frame), (1, 1))
        self.assertAlmostEqual((answer.stamp - later.header.stamp).to_sec(), 1 / 60.0, delta=2e-9)
        self.good(service(NODE, "load", Load)(path))
        answer, again = self.stepped(20)
        self.assertEqual(again.positions, later.positions, "the same motion")
        self.assertEqual(answer.frame, before.frame + 20)
        self.assertAlmostEqual((answer.stamp - state.header.stamp).to_sec(), 20 / 60.0, delta=2e-9)
        assert_stream_is_sound(self.curtain.messages())

    def test_6_the_example_in_the_docs_runs(self):
        """The code of docs/node.md, as it stands there."""
        root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
        with open(os.path.join(root, "docs", "node.md")) as file:
            section = file.read().split("\n## Lock-step\n")[1].split("\n## ")[0]
        code = re.search(r"```python\n(.*?)```", section, re.S)[1]
        space = {}
        code = re.sub(r"(?m)^rospy\.init_node.*$", "", code)  # this one is a node already
        exec(compile(code, "docs/node.md", "exec"), space)
        self.assertEqual(len(space["episode"]), 100)
        self.assertGreater(max(space["episode"]), 0.05, "the force has moved the hem")
        publisher("/curtain/drag_force", DragForce).publish(DragForce(action=DragForce.DELETEALL))

    def test_7_runs_at_the_pace_of_real_time(self):
        """Not paused, it is the same clock by the computer's: never faster, and no frame is called dropped."""
        begin, wall = self.good(self.step(1)).stamp, time.monotonic()
        self.good(self.pause(False))
        state = self.curtain.wait_for(lambda s: (s.header.stamp - begin).to_sec() > 1.0, "a second passes")
        self.assertGreaterEqual(time.monotonic() - wall, (state.header.stamp - begin).to_sec() - 2.0 / 60.0)
        self.good(self.pause(True))
        self.assertEqual(self.curtain.last().statistics.dropped_frames, 0)
        assert_stream_is_sound(self.curtain.messages())

    def test_8_views_are_of_the_frames_asked_for(self):
        """Each request's last frame has its view, others have it at their rate; from where the camera was then."""
        begin = self.good(self.step(1)).stamp
        transforms = publisher("/tf", TFMessage)
        images = Listener("/curtain/curtain_node/depth/image", Image)

        def camera(ahead):
            """Looks down, and rises by 10 m/s from 0 m; the floor is at -1 m."""
            transform = TransformStamped()
            transform.header.stamp = begin + rospy.Duration(ahead)
            transform.header.frame_id, transform.child_frame_id = "world", "camera"
            transform.transform.translation.x = 5.0
            transform.transform.translation.z = 10.0 * ahead
            transform.transform.rotation.x = 1.0
            return transform
        transforms.publish(TFMessage([camera(0.0), camera(0.4)]))
        first = images.next()
        self.assertEqual(first.header.stamp, begin, "in the pause: of its frame")

        def views_of(frames):
            images.clear()
            stamp = self.good(self.step(frames)).stamp
            wait_until(lambda: images.last() and images.last().header.stamp == stamp, "the last frame's view is here")
            return images.messages()
        images.clear()
        stamps = [self.good(self.step(1)).stamp for _ in range(8)]  # no time for views between two
        wait_until(lambda: images.last() and images.last().header.stamp == stamps[-1], "the last frame's view is here")
        seen = [first] + images.messages()
        self.assertEqual([view.header.stamp for view in seen[1:]], stamps)
        views = views_of(12)  # 0.2 s: two at 10 Hz, and the last one where it is neither
        self.assertIn(len(views), (2, 3))
        for view in seen + views:
            depths = numpy.frombuffer(view.data, "<f4")
            numpy.testing.assert_allclose(depths, 1.0 + 10.0 * (view.header.stamp - begin).to_sec(), atol=1e-5)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "lock_step", LockStepTest, sys.argv)
