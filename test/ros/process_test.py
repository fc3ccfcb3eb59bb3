#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A node with a bad parameter refuses to start and names it; one that is interrupted is gone within a second."""
import copy
import sys
import time
import unittest

import rospy
import rostest
from curtain_testing import Curtain, NodeProcess, wait_until

SCENE = {"cloth": {"rows": 10, "columns": 8, "height": 0.9, "width": 0.7},
         "hang": {"from": [0.0, 0.0, 2.0], "to": [0.7, 0.0, 2.0]}}
BALL = {"name": "ball", "shape": "sphere", "radius": 0.2}


def parameters(**own):
    return dict(own, scene=copy.deepcopy(SCENE))


def with_scene(path, value):
    """Good parameters but for one of the scene; path is dotted."""
    result = parameters()
    place = result["scene"]
    *parents, last = path.split(".")
    for parent in parents:
        place = place.setdefault(parent, {})
    place[last] = value
    return result


class ProcessTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("process_test")

    def setUp(self):
        self.node = None

    def tearDown(self):
        if self.node:
            self.node.kill()

    def refuses(self, params, *names):
        """The node exits with 1 and one message that holds all the names."""
        self.node = NodeProcess("/stage/curtain", params)
        code = self.node.wait()
        output = self.node.output()
        self.assertEqual(code, 1, output)
        self.assertEqual(output.count("FATAL"), 1, output)
        for name in names:
            self.assertIn(name, output)

    def test_wrong_parameters_of_the_node(self):
        """Everything wrong is named at once: text for a number, a fraction for a count, a number for a switch."""
        self.refuses(parameters(obstacle_timeout="1e-6 s", max_catch_up=7.6, handles=1, mesh_rate=-1.0),
                     "/stage/curtain/obstacle_timeout", 'the text "1e-6 s"', "/stage/curtain/max_catch_up", "7.6",
                     "/stage/curtain/handles", "/stage/curtain/mesh_rate")

    def test_no_scene(self):
        self.refuses({"world_frame": "world"}, "/stage/curtain/scene: missing")

    def test_scene_with_text_for_a_number(self):
        self.refuses(with_scene("solver.stretch_tolerance", "1e-6 m"), "/stage/curtain/scene", "solver.stretch_tolerance",
                     "1e-6 m")

    def test_scene_with_unknown_key(self):
        self.refuses(with_scene("cloth.colums", 8), "cloth.colums")

    def test_scene_with_one_row(self):
        self.refuses(with_scene("cloth.rows", 1), "cloth.rows", "2")

    def test_scene_with_pins_outside_the_grid(self):
        self.refuses(with_scene("pins", [[0, 0], [10, 0]]), "pins")

    def test_scene_hung_wider_than_its_width(self):
        self.refuses(with_scene("hang.to", [0.9, 0.0, 2.0]), "hang")

    def test_scene_with_a_value_that_is_not_finite(self):
        self.refuses(with_scene("cloth.height", float("inf")), "cloth.height")

    def test_mesh_that_is_missing(self):
        """The mesh is loaded at the start: one that is not there is named, with its obstacle."""
        obstacle = {"name": "statue", "shape": "mesh", "mesh": "file:///nowhere/statue.stl"}
        self.refuses(with_scene("obstacles", [obstacle]), "statue", "/nowhere/statue.stl")

    def test_unknown_parameter_is_a_warning(self):
        self.node = NodeProcess("/stage/curtain", parameters(mesh_rat=10.0))
        curtain = Curtain("/stage/curtain")
        curtain.next()
        wait_until(lambda: "/stage/curtain/mesh_rat" in self.node.output(), "the warning names the parameter")
        curtain.close()

    def interrupt_within_a_second(self, params):
        self.node = NodeProcess("/stage/curtain", params)
        curtain = Curtain("/stage/curtain")
        curtain.next()
        start = time.monotonic()
        self.node.interrupt()
        code = self.node.wait()
        self.assertLess(time.monotonic() - start, 1.0)
        self.assertEqual(code, 0, self.node.output())
        curtain.close()

    def test_shutdown_takes_less_than_a_second(self):
        self.interrupt_within_a_second(parameters())

    def test_shutdown_does_not_wait_for_frames_or_tf(self):
        """One frame a second, and an obstacle whose frame nobody broadcasts."""
        params = with_scene("obstacles", [dict(BALL, frame="nowhere")])
        params["scene"]["solver"] = {"frame_rate": 1.0}
        self.interrupt_within_a_second(params)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "process", ProcessTest, sys.argv)
