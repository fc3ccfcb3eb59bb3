#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""rviz comes and goes as it likes, politely or killed: while it is there meshes and markers are made for it, while it is not
none are, and the node keeps its pace. Passes with a message where rviz or Xvfb is not installed."""
import os
import signal
import sys

import roslib.packages
import rospy
import rostest
from curtain_testing import Curtain, assert_stream_is_sound, wait_until
from screen_testing import ScreenTest

NODE = "/curtain/curtain_node"


class RvizReopenTest(ScreenTest):
    def sent(self):
        statistics = self.curtain.next().statistics
        return statistics.meshes_sent, statistics.markers_sent

    def is_quiet(self):
        """Nothing is sent for a second."""
        start = self.curtain.next().statistics
        end = self.curtain.wait_for(lambda s: s.statistics.frame > start.frame + 60, "a second passed").statistics
        return (start.meshes_sent, start.markers_sent) == (end.meshes_sent, end.markers_sent)

    def test_comes_and_goes(self):
        if not self.installed("rviz", "Xvfb"):
            return
        rospy.init_node("rviz_reopen_test")
        self.curtain = Curtain(NODE)
        self.assertEqual(self.sent(), (0, 0), "nobody looks yet")
        environment = self.start_screen()
        configuration = os.path.join(roslib.packages.get_pkg_dir("curtain_sim"), "config", "markers.rviz")
        for ending in (signal.SIGTERM, signal.SIGKILL, signal.SIGTERM):
            before = self.sent()
            rviz = self.start("rviz", "-d", configuration, env=environment)
            wait_until(lambda: all(now > then + 5 for now, then in zip(self.sent(), before)), "rviz is served", 60.0)
            self.assertIsNone(rviz.poll(), "rviz runs\n" + self.log_of("rviz"))
            rviz.send_signal(ending)
            rviz.wait(20.0)
            wait_until(self.is_quiet, "the node has noticed that rviz is gone")
        assert_stream_is_sound(self.curtain.messages())


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "rviz_reopen", RvizReopenTest, sys.argv)
