#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""With a viewer's frame ~mesh has the triangles that the viewer can tell apart; all of them while tf2 does not know it."""
import sys
import unittest

import rospy
import rostest
import tf2_ros
from curtain_testing import OK, WARN, Curtain, Diagnostics, Listener, static_frame, wait_until
from visualization_msgs.msg import Marker

ROWS, COLUMNS, FOLDS = 10, 8, 6
QUADS = (ROWS - 1) * (COLUMNS - 1)


class ViewerTest(unittest.TestCase):
    def test_detail_follows_the_viewer(self):
        rospy.init_node("viewer_test")
        curtain = Curtain("/curtain")
        curtain.next()
        mesh = Listener("/curtain/mesh", Marker)
        triangles = lambda: len(mesh.last().points) // 3
        mesh.next()
        self.assertEqual(triangles(), 2 * QUADS * FOLDS, "no camera yet: every triangle")
        diagnostics = Diagnostics("/curtain")
        diagnostics.wait_for("obstacles", WARN, "mesh_viewer_frame")
        broadcaster = tf2_ros.StaticTransformBroadcaster()
        static_frame(broadcaster, "world", "camera", (0.25, -200.0, 1.5))
        wait_until(lambda: triangles() == 2 * QUADS, "the camera is far away: two triangles a quad")
        diagnostics.wait_for("obstacles", OK)
        static_frame(broadcaster, "world", "camera", (0.25, -15.0, 1.5))
        wait_until(lambda: 2 * QUADS < triangles() < 2 * QUADS * FOLDS, "it comes nearer")
        self.assertEqual(len(mesh.last().colors), len(mesh.last().points))
        self.assertEqual(len(curtain.last().fold_nodes), 3 * ROWS * (COLUMNS - 1) * (FOLDS - 1), "the state has all nodes")


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "viewer", ViewerTest, sys.argv)
