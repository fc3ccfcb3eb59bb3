#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A node that drops frames says why: its frames take too long, or it was not given its time. (clock.test: /clock leaps.)"""
import re
import signal
import sys
import time
import unittest

import rospy
import rostest
from curtain_testing import Curtain, NodeProcess, wait_until

NAME = "/late/curtain"


class LatenessTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("lateness_test")

    def start(self, rows, frame_rate):
        node = NodeProcess(NAME, {"scene": {
            "cloth": {"rows": rows, "columns": rows, "height": 1.0, "width": 1.0},
            "hang": {"from": [0.0, 0.0, 2.0], "to": [1.0, 0.0, 2.0]},
            "wind": [{"id": "fan", "position": [0.5, -1.5, 1.5], "direction": [0.0, 1.0, 0.0], "pressure": 3.0, "radius": 1.0,
                      "unsteadiness": 1.0}],
            "solver": {"frame_rate": float(frame_rate)}}})
        self.addCleanup(node.kill)
        wait_until(lambda: "curtain of" in node.output(), "it runs")
        return node

    def test_1_the_computer_was_busy(self):
        """A process that stands for half a second had no time, however fast its frames are."""
        node = self.start(10, 50)
        curtain = Curtain(NAME)
        curtain.next()
        seen = len(node.output())
        node.send_signal(signal.SIGSTOP)
        time.sleep(0.5)
        node.send_signal(signal.SIGCONT)
        busy = r"dropped \d+ frames \(\d+ so far\): the computer was busy with other things, 0\.[45]\d* s of 0\.[56]"
        wait_until(lambda: re.search(busy, node.output()[seen:]), "it says that it had no time")
        curtain.close()

    def test_2_frames_take_longer_than_they_have(self):
        """10 000 nodes in a gusty wind take more than the tenth of a millisecond that they have."""
        node = self.start(100, 10000)
        slow = r"dropped \d+ frames \(\d+ so far\): a frame takes \S+ ms of the 0\.\d+ ms it has"
        wait_until(lambda: re.search(slow, node.output()), "it says that its frames are slow")


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "lateness", LatenessTest, sys.argv)
