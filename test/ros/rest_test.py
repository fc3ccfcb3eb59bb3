#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A curtain at rest takes next to nothing, moves with the first frame in which something moves it, and says what it does."""
import os
import sys
import time
import unittest

import rospy
import rostest
from curtain_sim.msg import DragForce
from curtain_testing import Curtain, Listener, NodeProcess, billow, drag_message, publisher, wait_until
from geometry_msgs.msg import Vector3
from roscpp.srv import SetLoggerLevel
from rosgraph_msgs.msg import Log

ROWS, COLUMNS = 44, 40
SCENE = {"cloth": {"rows": ROWS, "columns": COLUMNS}, "hang": {"to": [0.8, 0.0, 2.2]},
         "air": {"inside": 0.5, "border": 0.5, "corner": 0.5}, "contact": {"self": True}}


class RestTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("rest_test")
        cls.node = NodeProcess("/stage/curtain", {"scene": SCENE})
        cls.curtain = Curtain("/stage/curtain")
        cls.drag = publisher("/stage/drag_force", DragForce)

    @classmethod
    def tearDownClass(cls):
        cls.node.kill()

    def sleeps(self):
        return self.curtain.wait_for(lambda s: s.statistics.asleep, "the curtain sleeps", patience=30.0)

    def computing_time(self):
        """Of the node's process so far [s]."""
        with open("/proc/%d/stat" % self.node.pid()) as stat:
            fields = stat.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def share_of_a_core(self, seconds):
        before, begin = self.computing_time(), time.monotonic()
        time.sleep(seconds)
        return (self.computing_time() - before) / (time.monotonic() - begin)

    def test_1_sleeps_and_takes_next_to_nothing(self):
        """Nobody listens, nothing moves: at most one percent of a core."""
        self.sleeps()
        self.curtain.close()
        try:
            time.sleep(1.0)  # until the node has noticed that nobody listens
            share = 1.0
            for _ in range(8):  # what else the machine does only adds to it
                share = min(share, self.share_of_a_core(5.0))
                if share <= 0.01:
                    break
        finally:
            type(self).curtain = Curtain("/stage/curtain")
        print("a sleeping curtain's node takes %.2f %% of a core" % (100.0 * share))
        self.assertLessEqual(share, 0.01)

    def test_2_wakes_with_the_frame_that_moves_it(self):
        """A drag reaches a sleeping curtain as fast as any other; asleep, its state keeps coming."""
        asleep = self.sleeps()
        wakes = asleep.statistics.wakes
        time.sleep(0.5)
        self.assertGreater(self.curtain.next().statistics.frame, asleep.statistics.frame + 10)
        self.curtain.clear()
        self.drag.publish(drag_message(row=ROWS - 1, column=COLUMNS // 2, force=Vector3(0.0, 0.2, 0.0)))
        self.curtain.wait_for(lambda s: billow(s) > 0.01, "it moves")
        states = self.curtain.messages()
        first = next(k for k, s in enumerate(states) if s.statistics.wakes > wakes)
        self.assertFalse(states[first].statistics.asleep)
        self.assertTrue(all(s.statistics.substeps == 0 for s in states[:first] if s.statistics.asleep))
        moves = max(abs(v) for v in states[first].velocities)
        self.assertGreater(moves, 1e-3, "it moves in the very frame it wakes in")
        self.drag.publish(DragForce(action=DragForce.DELETEALL))
        self.sleeps()

    def test_3_the_log_says_what_runs(self):
        """At level DEBUG the plan is logged, and again when it changes; at INFO it is not."""
        log = Listener("/rosout", Log)
        self.sleeps()
        set_level = rospy.ServiceProxy("/stage/curtain/set_logger_level", SetLoggerLevel)
        set_level("ros.curtain_sim", "debug")

        def plans():
            return [m.msg for m in log.messages() if m.name == "/stage/curtain" and m.msg.startswith("plan at")]
        wait_until(lambda: plans(), "the plan is in the log")
        self.assertIn("the cloth sleeps", plans()[-1])
        self.assertIn("- self-contact", plans()[-1])
        count = len(plans())
        time.sleep(2.5)
        self.assertEqual(len(plans()), count, "nothing changed")
        self.drag.publish(drag_message(row=ROWS - 1, column=0, force=Vector3(0.0, 0.2, 0.0)))
        wait_until(lambda: len(plans()) > count, "the plan changed")
        self.assertIn("+ drag", plans()[-1])
        set_level("ros.curtain_sim", "info")
        self.drag.publish(DragForce(action=DragForce.DELETEALL))
        time.sleep(1.5)
        count = len(plans())
        self.sleeps()
        self.assertEqual(len(plans()), count)
        log.close()


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "rest_test", RestTest, sys.argv)
