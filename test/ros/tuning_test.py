#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""dynamic_reconfigure shows what holds, changes it from the next frame on, and puts back what is refused."""
import os
import sys
import tempfile
import unittest

import rospy
import rostest
from curtain_sim.srv import Load, Save, SetMaterial
from curtain_testing import WARN, Curtain, Diagnostics, NodeProcess, wait_until
from dynamic_reconfigure.client import Client

NODE = "/stage/curtain"
SCENE = {"cloth": {"rows": 10, "columns": 8}, "contact": {"friction": 0.45}}
NAN = float("nan")


class TuningTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("tuning_test")
        cls.curtain = Curtain(NODE)
        cls.curtain.next()
        cls.client = Client(NODE, timeout=20.0)
        cls.at_start = dict(cls.client.get_configuration(timeout=20.0))
        cls.scene = rospy.get_param(NODE + "/scene")

    def setUp(self):
        self.client.update_configuration({k: v for k, v in self.at_start.items() if k != "groups"})

    def weight(self):
        """Force on the cloth along z in the last state [N]."""
        return sum(self.curtain.next().forces[2::3])

    def shown(self, name, value):
        """Waits until the client was told so."""
        wait_until(lambda: self.client.get_configuration(timeout=5.0)[name] == value, "%s is shown as %s" % (name, value))

    def test_shows_what_the_node_started_with(self):
        """The parameters and the scene, not the defaults of the .cfg; ~scene is as it was set."""
        self.assertEqual(self.at_start["mesh_rate"], 15.0)
        self.assertEqual(self.at_start["contact_friction"], 0.45)
        self.assertEqual(self.at_start["solver_budget_ms"], 15.0)
        self.assertEqual(self.at_start["air_inside"], 1.0)
        self.assertEqual(self.at_start["air_law"], "continuous")
        self.assertEqual(self.at_start["gravity_z"], -9.81)
        self.assertEqual(rospy.get_param(NODE + "/scene"), self.scene)
        self.assertEqual(self.scene["solver"], {"budget_ms": 15.0})

    def test_gravity_and_air_act_from_the_next_frame_on(self):
        whole = self.weight()
        self.assertEqual(self.client.update_configuration({"gravity_z": -9.81 / 6.0})["gravity_z"], -9.81 / 6.0)
        wait_until(lambda: abs(self.weight() - whole / 6.0) < 1e-3 * abs(whole), "it weighs a sixth")
        answer = self.client.update_configuration({"gravity_x": 3.0, "air_inside": 0.2, "air_fast_gain": 0.1})
        self.assertEqual((answer["gravity_x"], answer["air_inside"], answer["air_fast_gain"]), (3.0, 0.2, 0.1))
        self.curtain.wait_for(lambda s: sum(s.positions[0::3]) > 0.36 * len(s.positions) / 3.0, "it leans to +x")
        self.shown("air_inside", 0.2)

    def test_another_fabric(self):
        """Denser cloth weighs more, at once; a known fabric brings all that is known of it, and no other name is one."""
        whole = self.weight()
        self.assertEqual(self.client.update_configuration({"cloth_surface_density": 0.4})["cloth_surface_density"], 0.4)
        wait_until(lambda: abs(self.weight() - 2.0 * whole) < 1e-3 * abs(whole), "it weighs twice as much")
        frame = self.curtain.next().statistics.frame
        rospy.wait_for_service(NODE + "/set_material", 20.0)
        set_material = rospy.ServiceProxy(NODE + "/set_material", SetMaterial)
        answer = set_material("velvet", "", [], [])
        self.assertTrue(answer.success, answer.message)
        self.shown("cloth_surface_density", 0.4773)
        self.shown("cloth_shear", 50.0)
        self.shown("contact_friction", 0.6)
        self.curtain.wait_for(lambda s: s.statistics.frame > frame + 30, "frames come, and are counted on")
        answer = set_material("tweed", "", [], [])
        self.assertFalse(answer.success)
        self.assertIn("material: must be none, cotton_voile", answer.message)

    def test_a_part_of_another_fabric(self):
        """A part weighs what its fabric does; what lies on it goes; material none takes it away; no other part is one."""
        rospy.wait_for_service(NODE + "/set_material", 20.0)
        set_material = rospy.ServiceProxy(NODE + "/set_material", SetMaterial)
        whole = self.weight()
        rows, columns = self.curtain.next().rows, self.curtain.next().columns
        # All of it but the fabric's own keys, as a patch: weights go by the density of velvet over that of the cloth.
        self.assertTrue(set_material("velvet", "", [0, rows - 1], [0, columns - 1]).success)
        share = 0.4773 / rospy.get_param(NODE + "/cloth_surface_density")
        wait_until(lambda: abs(self.weight() - share * whole) < 1e-3 * abs(whole), "it weighs as velvet does")
        answer = set_material("silk", "", [2, rows], [])
        self.assertFalse(answer.success)
        self.assertIn("cloth.patches[1].rows: must be [first, last] with 0 <= first <= last <= %d" % (rows - 1), answer.message)
        self.assertTrue(set_material("none", "", [0, rows - 1], []).success)
        wait_until(lambda: abs(self.weight() - whole) < 1e-3 * abs(whole), "the patch is gone")

    def test_rates(self):
        self.client.update_configuration({"state_rate": 10.0})
        self.curtain.next()
        self.curtain.clear()
        states = wait_until(lambda: self.curtain.count() > 6 and self.curtain.messages(), "states come")
        self.assertEqual({b.statistics.frame - a.statistics.frame for a, b in zip(states[1:], states[2:])}, {6})
        self.client.update_configuration({"state_rate": 0.0, "solver_frame_rate": 25.0})
        self.curtain.next()
        self.curtain.clear()
        states = wait_until(lambda: self.curtain.count() > 20 and self.curtain.messages(), "states come")
        for a, b in zip(states[1:], states[2:]):
            frames = b.statistics.frame - a.statistics.frame
            dropped = b.statistics.dropped_frames - a.statistics.dropped_frames
            self.assertAlmostEqual(b.statistics.simulated_time - a.statistics.simulated_time, frames / 25.0, delta=1e-9)
            # The stamp is taken from two clocks, one after the other: the thread may be held up between them.
            self.assertAlmostEqual((b.header.stamp - a.header.stamp).to_sec(), (frames + dropped) / 25.0, delta=5e-3)

    def test_budget(self):
        """One that nothing can keep shortens frames; given back, they are whole."""
        before = self.curtain.next().statistics.shortened_frames
        self.client.update_configuration({"solver_budget_ms": 1e-4, "gravity_x": 1.0})
        self.curtain.wait_for(lambda s: s.statistics.shortened_frames > before + 5, "frames are shortened")
        self.client.update_configuration({"solver_budget_ms": 0.0})
        first = self.curtain.next().statistics.shortened_frames
        frame = self.curtain.next().statistics.frame
        state = self.curtain.wait_for(lambda s: s.statistics.frame > frame + 60, "frames come")
        self.assertEqual(state.statistics.shortened_frames, first)

    def test_what_is_refused_is_put_back_counted_and_told(self):
        health = Diagnostics(NODE)
        refused = self.curtain.next().statistics.dropped_invalid
        answer = self.client.update_configuration({"solver_position_tolerance": 1e-3, "mesh_tolerance": 0.01})
        self.assertEqual((answer["solver_position_tolerance"], answer["mesh_tolerance"]), (0.0, 0.01))
        self.curtain.wait_for(lambda s: s.statistics.dropped_invalid == refused + 1, "it is counted")
        health.wait_for("inputs", WARN, value=("last dropped", "solver.position_tolerance: must stay 0"))
        for name, value in (("air_law", "thick"), ("contact_friction", NAN), ("gravity_z", NAN), ("mesh_rate", NAN),
                            ("obstacle_timeout", NAN), ("solver_frame_rate", NAN)):
            self.assertEqual(self.client.update_configuration({name: value})[name], self.at_start[name], name)
            self.shown(name, self.at_start[name])
        state = self.curtain.wait_for(lambda s: s.statistics.dropped_invalid == refused + 7, "all are counted")
        self.assertTrue(state.statistics.finite)

    def test_beyond_a_range_is_its_end(self):
        """As dynamic_reconfigure does it."""
        answer = self.client.update_configuration({"contact_friction": 11.0, "mesh_rate": -3.0})
        self.assertEqual((answer["contact_friction"], answer["mesh_rate"]), (10.0, 1e-9))

    def test_a_state_that_is_loaded_brings_its_values(self):
        path = os.path.join(tempfile.mkdtemp(), "state")
        self.assertTrue(rospy.ServiceProxy(NODE + "/save", Save)(path).success)
        changed = {"gravity_z": -2.0, "air_border": 0.5, "contact_friction": 0.1, "solver_frame_rate": 30.0}
        self.client.update_configuration(dict(changed, mesh_rate=5.0))
        self.shown("gravity_z", -2.0)
        answer = rospy.ServiceProxy(NODE + "/load", Load)(path)
        self.assertTrue(answer.success, answer.message)
        for name in changed:
            self.shown(name, self.at_start[name])
            self.assertEqual(rospy.get_param(NODE + "/" + name), self.at_start[name])
        self.shown("mesh_rate", 5.0)  # is the node's own

    def test_a_node_that_is_started_again(self):
        """Begins with its scene and with what the parameters are now; nothing is called unknown; ~scene is untouched.
        With a snapshot the values come back that it was left with."""
        path = os.path.join(tempfile.mkdtemp(), "state")
        node = NodeProcess("/again", {"scene": SCENE, "snapshot_file": path})
        tuned = {"gravity_z": -3.0, "contact_friction": 0.7, "markers_rate": 3.0, "solver_frame_rate": 50.0}
        Client("/again", timeout=20.0).update_configuration(tuned)
        node.interrupt()
        self.assertEqual(node.wait(), 0)
        self.assertEqual(rospy.get_param("/again/scene"), SCENE)
        for snapshot, expected in ((True, tuned), (False, dict(tuned, gravity_z=-9.81, contact_friction=0.45,
                                                               solver_frame_rate=60.0))):
            if not snapshot:
                os.remove(path)
            node = NodeProcess("/again", None)
            states = Curtain("/again")
            shown = Client("/again", timeout=20.0).get_configuration(timeout=20.0)
            self.assertEqual({name: shown[name] for name in tuned}, expected)
            first, second = states.next(), states.next()
            self.assertAlmostEqual((second.statistics.simulated_time - first.statistics.simulated_time) /
                                   (second.statistics.frame - first.statistics.frame),
                                   1.0 / expected["solver_frame_rate"], delta=1e-9)
            node.interrupt()
            self.assertEqual(node.wait(), 0)
            self.assertNotIn("is not a known key", node.output())
            self.assertEqual("restored the snapshot" in node.output(), snapshot, node.output())


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "tuning", TuningTest, sys.argv)
