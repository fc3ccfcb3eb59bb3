# SPDX-License-Identifier: BSD-3-Clause
"""Bad input is one clear ValueError that names it, and changes nothing."""
import math
import unittest

import curtain_engine
import numpy

import testing

NAN = math.nan


class BadInput(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sim = curtain_engine.Simulator(testing.scene(obstacles=[testing.BALL]))
        cls.sim.step(3)

    def refused(self, call, *texts):
        """The call of the simulator is a ValueError with these texts, and the simulator stays as it is."""
        before = self.sim.snapshot()
        with self.assertRaises(ValueError) as raised:
            call(self.sim)
        for text in texts:
            self.assertIn(text, str(raised.exception))
        self.assertEqual(self.sim.snapshot(), before)

    def test_arrays(self):
        good = self.sim.positions.copy()
        holed = good.copy()
        holed[3, 4, 1] = NAN
        far = good.copy()
        far[7, 5, 2] = 1e300
        wanted = "must be an array of real numbers of shape (8, 6, 3), is "
        ragged = "none: " if numpy.lib.NumpyVersion(numpy.__version__) >= "1.24.0" else "of dtype object"
        for bad, text in [(good[:3], wanted + "of shape (3, 6, 3)"), (good.reshape(-1, 3), wanted + "of shape (48, 3)"),
                          (good.astype(complex), wanted + "of dtype complex128"), (good.astype(str), wanted + "of dtype <U32"),
                          (good > 0, wanted + "of dtype bool"), (good.astype(object), wanted + "of dtype object"),
                          ([[1.0, 2.0], [3.0]], wanted + ragged), (None, wanted + "of dtype object"), (7.0, wanted + "of shape ()"),
                          (holed, "[22]: must be finite and within [-1e9, 1e9]"), (far, "[47]: must be finite")]:
            with self.subTest(text):
                self.refused(lambda sim, bad=bad: sim.set_state(bad, good), "positions", text)
                self.refused(lambda sim, bad=bad: sim.set_state(good, bad), "velocities", text)

    def test_points_and_poses(self):
        for bad, text in [([1, 2], "shape (3,), is of shape (2,)"), ([1, NAN, 2], "must be finite, is [ 1. nan  2.]"),
                          (numpy.ma.masked_array([0, 0, 0], [0, 0, 1]), "is masked"), ("abc", "is of dtype <U3"),
                          ([1, "2", 3], "is of dtype"), (numpy.zeros((1, 3)), "is of shape (1, 3)")]:
            with self.subTest(text):
                self.refused(lambda sim, bad=bad: sim.set_gravity(bad), "gravity: must be", text)
                self.refused(lambda sim, bad=bad: sim.move_pin((0, 0), bad), "target: must be", text)
                self.refused(lambda sim, bad=bad: sim.nearest_node(bad), "point: must be", text)
                self.refused(lambda sim, bad=bad: sim.set_obstacle_pose("ball", bad), "ball.position: must be", text)
                self.refused(lambda sim, bad=bad: sim.set_grasp("hand", bad, radius=0.1), "grasp.position: must be", text)
        self.refused(lambda sim: sim.set_obstacle_pose("ball", [0, 0, 0], [0, 0, 0, 2]), "ball.orientation: must be a unit quaternion")
        self.refused(lambda sim: sim.set_obstacle_pose("ball", [0, 0, 0], [0, 0, 1]), "ball.orientation: must be", "shape (4,)")
        self.refused(lambda sim: sim.set_obstacle_pose("ball", [0, 0, 1e300]), "ball.position", "1e+300")

    def test_lengths(self):
        for bad in (NAN, math.inf, -1.0):
            with self.subTest(bad):
                self.refused(lambda sim, bad=bad: sim.piercings("ball", bad), "tolerance: must be a finite number >= 0")
                self.refused(lambda sim, bad=bad: sim.rail_points(bad), "spacing: must be a finite number >= 0.0001")
        self.refused(lambda sim: sim.rail_points(0.0), "spacing: must be a finite number >= 0.0001")

    def test_nodes(self):
        for bad in [(8, 0), (0, 6), (-1, 0), (0, 0, 0), (0.0, 1.0), "ab", 3, (2**70, 0), None]:
            with self.subTest(bad):
                self.refused(lambda sim, bad=bad: sim.move_pin(bad, [0, 0, 2]),
                             "node: must be (row, column), integers in [0, 7] and [0, 5], is " + repr(bad))
        self.refused(lambda sim: sim.move_pin((1, 1), [0, 0, 2]), "node (1, 1): is not pinned")
        self.refused(lambda sim: sim.set_grasp("hand", [0, 0, 2], nodes=[(7, 0), (7, 6)]), "grasp.nodes[1]: must be (row, column)")

    def test_names(self):
        for method in ("obstacle_pose", "obstacle_target", "obstacle_lag", "obstacle_present", "contact_wrench", "obstacle_distance", "piercings"):
            self.refused(lambda sim, method=method: getattr(sim, method)("bal"), 'there is no obstacle "bal", there are ball')
        self.refused(lambda sim: sim.set_obstacle_present("bal", True), 'no obstacle "bal"')
        self.refused(lambda sim: sim.move_grasp("hand", [0, 0, 0]), 'no grasp "hand" holds')
        self.refused(lambda sim: sim.set_tie_back("tie", True), "tie")
        self.refused(lambda sim: sim.tie_back_closed("tie"), 'there is no tie-back "tie"')
        for method in ("line_end", "line_pull", "line_tensions"):
            self.refused(lambda sim, method=method: getattr(sim, method)("cord"), 'there are no lines "cord"')
        self.refused(lambda sim: sim.set_line_end("cord", [0, 0, 0]), 'there are no lines "cord"')

    def test_values_out_of_range(self):
        self.refused(lambda sim: sim.set_wind({"id": "a", "radius": -1, "presure": 3}), "wind.radius: must be",
                     "wind.presure: is not a known key, did you mean pressure?")
        self.refused(lambda sim: sim.set_wind([1]), "wind: must be a map, is a list of 1")
        self.refused(lambda sim: sim.set_drag({"id": "a", "node": [8, 0]}), "drag.node: must be [row, column]")
        self.refused(lambda sim: sim.set_air({"insid": 1}), "air.insid: is not a known key, did you mean inside?")
        self.refused(lambda sim: sim.set_air(3), "air: must be")
        self.refused(lambda sim: sim.set_frame_rate(NAN), "solver.frame_rate: must be a number in [1, 10000]")
        self.refused(lambda sim: sim.set_friction(-1), "contact.friction: must be")
        self.refused(lambda sim: sim.set_cloth(shear=-1), "cloth.shear: must be")
        self.refused(lambda sim: sim.set_cloth(rows=99), "cloth.rows: can't change while it runs")
        self.refused(lambda sim: sim.set_cloth(shears=1), "cloth.shears: is not a known key, did you mean shear?")
        self.refused(lambda sim: sim.set_opening(0.5), "opening: is for cloth on a rail")
        self.refused(lambda sim: sim.set_drive(-1, 1), "drive")
        self.refused(lambda sim: sim.set_grasp("hand", [0, 0, 0]), "grasp: must have one of radius", "has none")
        self.refused(lambda sim: sim.set_grasp("hand", [0, 0, 0], radius=1, size=[1, 1, 1]), "has more")
        self.refused(lambda sim: sim.set_grasp("hand", [0, 0, 0], radius=-1), "grasp.radius: must be")
        self.refused(lambda sim: sim.set_grasp("hand", [9, 9, 9], radius=0.1), "grasp.region: holds no free node")
        self.refused(lambda sim: sim.step(-1), "frames: must be at least 0, is -1")

    def test_snapshots(self):
        good = self.sim.snapshot()
        damaged = good[:200] + bytes([good[200] ^ 1]) + good[201:]
        other = curtain_engine.Simulator(testing.scene()).snapshot()
        for bad in (b"", b"abc", good[:-1], damaged, other):
            self.refused(lambda sim, bad=bad: sim.restore(bad), "snapshot")
        self.sim.restore(good)

    def test_types_that_are_no_values_are_type_errors(self):
        for call in (lambda: self.sim.step(1.5), lambda: self.sim.step("2"), lambda: self.sim.restore("text"),
                     lambda: self.sim.set_friction("0.3"), lambda: self.sim.obstacle_pose(0), lambda: curtain_engine.Simulator(3)):
            self.assertRaises(TypeError, call)
        self.assertRaises(AttributeError, setattr, self.sim, "positions", 0)


if __name__ == "__main__":
    unittest.main()
