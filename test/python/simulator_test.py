# SPDX-License-Identifier: BSD-3-Clause
"""A simulator from Python moves as the engine does, and shows what the engine knows."""
import gc
import json
import os
import re
import subprocess
import tempfile
import unittest

import curtain_engine
import numpy
from numpy.testing import assert_allclose, assert_array_equal

import testing


def simulator(**changes):
    return curtain_engine.Simulator(testing.scene(**changes))


class Motion(unittest.TestCase):
    def test_has_the_bits_of_curtain_batch(self):
        path = os.path.join(testing.ROOT, "config", "scenes", "tied_curtain.yaml")
        with tempfile.TemporaryDirectory() as folder:
            stats = os.path.join(folder, "stats.json")
            subprocess.run([os.environ["CURTAIN_BATCH"], path, "--duration", "0.2", "--stats", stats], check=True,
                           stdout=subprocess.DEVNULL)
            with open(stats, encoding="utf-8") as file:
                batch = json.load(file)
        scene = curtain_engine.Scene.from_file(path)
        sim = curtain_engine.Simulator(scene)
        sim.step(batch["frames"])
        self.assertEqual("%016x" % sim.state_hash(), batch["state_hash"])

    def test_a_snapshot_goes_on_with_the_same_bits(self):
        sim = simulator()
        sim.step(10)
        snapshot = sim.snapshot()
        sim.step(10)
        end, positions = sim.state_hash(), sim.positions.copy()
        other = simulator()
        other.restore(snapshot)
        self.assertEqual(other.time, 10 / 60)
        for _ in range(10):
            other.step()
        self.assertEqual(other.state_hash(), end)
        assert_array_equal(other.positions, positions)
        other.reset()
        self.assertEqual((other.time, other.state_hash()), (0.0, simulator().state_hash()))

    def test_set_state_sets_it(self):
        sim = simulator(pins="none", gravity=[0, 0, 0], wind=[])
        positions = sim.positions + [0.0, 0.0, 1.0]
        velocities = numpy.broadcast_to(numpy.float32([0.5, 0, 0]), positions.shape)  # another dtype, no copy needed
        sim.set_state(positions, velocities)
        assert_array_equal(sim.positions, positions)
        assert_array_equal(sim.velocities, velocities)
        sim.set_air({"inside": 0.0, "border": 0.0, "corner": 0.0})
        sim.step(30)  # half a second of free flight; steps of 1/60 s add up 60 roundings at most
        assert_allclose(sim.positions, positions + [0.25, 0.0, 0.0], atol=60 * numpy.spacing(4.0))


class Arrays(unittest.TestCase):
    def test_are_live_shared_and_read_only(self):
        sim = simulator(drag=[{"id": "pull", "node": [7, 5], "force": [0.5, 0.3, 0.0]}])
        grid = (sim.rows, sim.columns)
        for name, shape in [("positions", grid + (3,)), ("velocities", grid + (3,)), ("forces", grid + (3,)),
                            ("contact_forces", grid + (3,)), ("warp_tensions", grid), ("weft_tensions", grid),
                            ("fine_positions", (sim.rows, 5 * 6 + 1, 3))]:
            with self.subTest(name):
                array = getattr(sim, name)
                self.assertEqual((array.shape, array.dtype), (shape, numpy.float64))
                self.assertTrue(array.flags.c_contiguous)
                self.assertTrue(numpy.shares_memory(array, getattr(sim, name)), "a copy was made")
                self.assertRaises(ValueError, array.__setitem__, 0, 1.0)
                self.assertRaises(ValueError, array.setflags, write=True)
                part, before = array[2:], array[2:].copy()
                sim.step(3)
                assert_array_equal(part, getattr(sim, name)[2:])
                if name != "contact_forces":
                    self.assertFalse(numpy.array_equal(part, before), "does not show the new state")

    def test_show_every_change(self):
        sim = simulator()
        positions, velocities = sim.positions, sim.velocities
        sim.step(20)
        moved, snapshot = positions.copy(), sim.snapshot()
        sim.reset()
        assert_array_equal(positions, simulator().positions)
        assert_array_equal(velocities, 0.0)
        sim.restore(snapshot)
        assert_array_equal(positions, moved)
        sim.set_state(moved + 1.0, numpy.ones_like(moved))
        assert_array_equal(positions, moved + 1.0)
        assert_array_equal(velocities[1:], 1.0)

    def test_one_that_nobody_held_is_up_to_date(self):
        sim, other = simulator(), simulator()
        before = sim.positions.copy()  # no array is held now
        sim.step(5)
        other.step(5)
        assert_array_equal(sim.positions, other.positions)
        self.assertFalse(numpy.array_equal(sim.positions, before))

    def test_outlive_their_simulator(self):
        sim = simulator()
        positions, triangles = sim.positions[1:, 2], sim.fine_triangles
        sim.step(2)
        copies = positions.copy(), triangles.copy()
        del sim
        gc.collect()
        others = [simulator() for _ in range(5)]  # would get the memory, were it free
        others[0].step()
        assert_array_equal(positions, copies[0])
        assert_array_equal(triangles, copies[1])

    def test_the_fine_mesh_is_one(self):
        sim = simulator()
        sim.step(5)
        points, triangles = sim.fine_positions.reshape(-1, 3), sim.fine_triangles
        self.assertEqual((triangles.dtype, triangles.shape), (numpy.uint32, (2 * 7 * 30, 3)))
        assert_array_equal(numpy.unique(triangles), numpy.arange(len(points)))
        assert_array_equal(sim.fine_positions[:, ::6], sim.positions)
        assert_allclose(numpy.linalg.norm(sim.fine_normals(), axis=2), 1.0, rtol=4 * numpy.spacing(1.0))

    def test_lengths_masses_and_pins_are_those_of_the_scene(self):
        sim = simulator()
        warp, weft = sim.rest_lengths()
        assert_allclose(warp, 1.0 / 7.0)
        assert_allclose(weft, numpy.full((8, 5), 0.8 / 5.0))
        assert_allclose(sim.masses().sum(), 0.2 * 0.8)
        assert_array_equal(sim.pinned(), numpy.arange(8)[:, None] == numpy.zeros((1, 6)))
        self.assertEqual(sim.nearest_node(sim.positions[3, 2] + 1e-3), (3, 2))


class Parts(unittest.TestCase):
    def test_winds_and_drags_are_as_given(self):
        sim = simulator()
        fan = sim.winds[0]
        self.assertEqual((fan["id"], fan["pressure"]), ("fan", 2.0))
        sim.set_wind(dict(fan, id="other", pressure=1e-06))
        self.assertEqual([(wind["id"], wind["pressure"]) for wind in sim.winds], [("fan", 2.0), ("other", 1e-06)])
        self.assertEqual((sim.remove_wind("other"), sim.remove_wind("other")), (True, False))
        sim.set_drag({"id": "pull", "node": [7, 5], "force": numpy.array([0.0, 0.3, 0.0])})
        self.assertEqual(sim.drags[0]["node"], [7, 5])
        sim.clear_winds()
        sim.clear_drags()
        self.assertEqual((sim.winds, sim.drags), ([], []))

    def test_what_may_change_changes(self):
        sim = simulator(solver={"position_tolerance": 1e-3})
        sim.set_gravity([0, 0, -1.62])
        sim.set_air({"inside": 0.7})
        sim.set_frame_rate(30)
        sim.set_friction(0.5)
        sim.set_cloth(material="velvet")
        self.assertEqual(sim.scene.to_dict()["cloth"]["shear"], 50)
        sim.set_cloth(shear=20, surface_density=0.3)
        sim.set_stretch_tolerance(1e-4)
        sim.set_position_tolerance(1e-2)
        sim.set_budget(5)
        scene = sim.scene.to_dict()
        self.assertEqual((scene["gravity"], scene["air"]["inside"], scene["air"]["border"]), ([0, 0, -1.62], 0.7, 0.4))
        self.assertEqual((scene["cloth"]["shear"], scene["cloth"]["surface_density"]), (20, 0.3))
        solver = scene["solver"]
        self.assertEqual((solver["frame_rate"], scene["contact"]["friction"], solver["stretch_tolerance"],
                          solver["position_tolerance"], solver["budget_ms"]), (30, 0.5, 1e-4, 1e-2, 5))
        sim.step()
        self.assertEqual(sim.time, 1 / 30)

    def test_what_is_covered(self):
        """A ball behind the cloth is hidden from the front, and not from behind."""
        sim = simulator(obstacles=[{"name": "ball", "radius": 0.1, "position": [0.4, 2.0, 1.6]}])
        self.assertEqual(sim.covered("ball", (0, 1, 0)), 0.0)
        self.assertGreater(sim.covered("ball", (0, -1, 0)), 0.9)
        ball = sim.obstacle_pose("ball")[0]
        self.assertEqual((sim.hides(ball, (0, 1, 0)), sim.hides(ball, (0, -1, 0))), (False, True))

    def test_pins_and_hands_move_what_they_hold(self):
        sim = simulator()
        positions = sim.positions
        target = positions[0, 5] - [0.1, 0, 0]
        sim.move_pin((0, 5), target)
        at = positions[7, 0].copy()
        sim.set_grasp("hand", at, radius=0.01)
        sim.set_grasp("other", positions[7, 5], nodes=[(7, 5), numpy.array([7, 4])], stiffness=100.0, break_force=1e-3)
        sim.move_grasp("hand", at + [0, 0.05, 0])
        sim.step()
        assert_array_equal(positions[0, 5], target)
        assert_allclose(positions[7, 0], at + [0, 0.05, 0], rtol=1e-15)
        state = sim.grasp_state("hand")
        self.assertEqual((state["nodes"], state["holds"], state["end"], state["slipped"]), ([(7, 0)], True, "", 0.0))
        self.assertEqual((state["force"].shape, state["torque"].shape), ((3,), (3,)))
        self.assertLess(state["force"][2], 0.0)  # it weighs
        self.assertEqual(sim.grasp_state("other")["end"], "broken")
        self.assertEqual(sim.grasps, ["hand", "other"])
        self.assertEqual((sim.release_grasp("hand"), sim.release_grasp("hand"), sim.grasp_state("hand")), (True, False, None))
        sim.release_all_grasps()
        self.assertEqual(sim.grasps, [])

    def test_the_rail_opens(self):
        sim = simulator(rail={"path": [[0, 0, 2], [0.8, 0, 2]], "carriers": {"columns": [0, 3, 5]}}, wind=[])
        self.assertEqual(sim.carriers(), [(0, 0), (0, 3), (0, 5)])
        points = sim.rail_points(0.25)
        assert_allclose(points[:, 0], [0, 0.2, 0.4, 0.6, 0.8], atol=1e-15)
        self.assertIsNone(sim.drive)
        sim.set_drive(1.0, 50.0)
        sim.set_opening(1.0)
        self.assertEqual(sim.drive, {"speed": 1.0, "force": 50.0})
        sim.step(60)
        self.assertGreater(sim.statistics["opening"], 0.99)
        sim.release_drive()
        self.assertIsNone(sim.drive)

    def test_tie_backs_and_lines(self):
        sim = simulator(tie_back=[{"id": "tie", "row": 4, "point": [0.1, 0.0, 1.4], "first_column": 0, "last_column": 2}],
                        lines=[{"id": "cord", "nodes": [[7, 5]], "to": [1.0, 0.5, 1.0]}])
        self.assertTrue(sim.tie_back_closed("tie"))
        sim.set_tie_back("tie", False)
        self.assertFalse(sim.tie_back_closed("tie"))
        sim.set_line_end("cord", [1.1, 0.5, 1.0])
        sim.step()
        assert_allclose(sim.line_end("cord"), [1.1, 0.5, 1.0])
        self.assertEqual(sim.line_tensions("cord").shape, (1,))
        assert_allclose(numpy.linalg.norm(sim.line_pull("cord")), sim.line_tensions("cord")[0])

    def test_obstacles_push_and_are_pushed(self):
        sim = simulator(obstacles=[testing.BALL, dict(testing.BALL, name="far", position=[9, 9, 9])])
        self.assertEqual(sim.obstacles, ["ball", "far"])
        for frame in range(40):
            sim.set_obstacle_pose("ball", [0.4, 0.5 - 0.01 * frame, 1.4])
            sim.step()
        position, orientation = sim.obstacle_pose("ball")
        assert_allclose(position, [0.4, 0.11, 1.4])
        assert_array_equal(orientation, [0, 0, 0, 1])
        assert_array_equal(sim.obstacle_target("ball")[0], position)
        self.assertEqual(sim.obstacle_lag("ball"), 0.0)
        sim.set_obstacle_pose("ball", position + [0.0, 0.03, 0.04])  # it is not there yet
        assert_array_equal(sim.obstacle_pose("ball")[0], position)
        assert_allclose(sim.obstacle_target("ball")[0], position + [0.0, 0.03, 0.04])
        assert_allclose(sim.obstacle_lag("ball"), 0.05)
        sim.set_obstacle_pose("ball", position)
        wrench, points = sim.contact_wrench("ball"), sim.contact_points()
        self.assertGreater(wrench["force"][1], 0.0)  # the wind blows the cloth at it
        self.assertGreater(wrench["contacts"], 0)
        self.assertLess(sim.contact_forces[..., 1].sum(), 0.0)
        count = len(points["obstacle"])
        self.assertGreater(count, 0)
        assert_array_equal(points["obstacle"], 0)
        self.assertEqual([points[name].shape for name in ("position", "normal", "normal_force", "friction")],
                         [(count, 3), (count, 3), (count,), (count, 3)])
        distances = numpy.linalg.norm(points["position"] - position, axis=1)
        assert_allclose(distances, 0.2, atol=0.05)  # on its surface, or on an element that bridges it
        assert_array_equal(sim.contact_wrench("far")["force"], 0.0)
        near = sim.obstacle_distance("ball")
        self.assertLess(abs(near["distance"]), 0.01)  # it touches
        self.assertAlmostEqual(numpy.linalg.norm(near["on_cloth"] - near["on_obstacle"]), abs(near["distance"]), delta=1e-12)
        self.assertGreater(sim.obstacle_distance("far")["distance"], 0.1)
        self.assertEqual(sim.piercings("ball"), {"nodes": 0, "edges": 0, "faces": 0})
        self.assertEqual(sim.piercings("ball", fine=True)["nodes"], 0)
        self.assertEqual(sim.self_crossings(), 0)
        sim.set_obstacle_present("ball", False)
        self.assertFalse(sim.obstacle_present("ball"))
        sim.step()
        self.assertEqual(sim.contact_wrench("ball")["contacts"], 0)

    def test_work_is_the_energy_that_came_in(self):
        sim = simulator(wind=[], air={"inside": 0.0, "border": 0.0, "corner": 0.0})
        sim.count_work(True)
        energies = [sim.energy]
        for _ in range(20):
            sim.step()
            energies.append(sim.energy)
        self.assertEqual(sim.statistics["substeps"], 20)
        work, start, (before, end) = sim.work, energies[0], energies[-2:]
        # The ledger's velocities are half a substep late, so its works lie between those of this frame and of the one before.
        self.assertTrue(start["potential"] - before["potential"] < work["gravity"] < start["potential"] - end["potential"])
        self.assertTrue(before["kinetic"] < work["kinetic"] + start["kinetic"] < end["kinetic"])
        self.assertEqual(set(work), {"gravity", "elastic", "dissipated", "forces", "drive", "pins", "obstacles", "kinetic"})

    def test_statistics_have_every_member_of_the_engines(self):
        with open(os.path.join(testing.ROOT, "include/curtain_sim/statistics.h"), encoding="utf-8") as file:
            body = re.search(r"struct Statistics \{(.*?)\n\};", file.read(), re.S)[1]
        members = set(re.findall(r"^  [\w:<>, ]+ (\w+)(?: = [^;]+|\{\});", body, re.M))
        self.assertGreater(len(members), 30)
        sim = simulator()
        sim.step(3)
        self.assertEqual(set(sim.statistics), members)
        self.assertEqual(sim.statistics["frames"], 3)
        self.assertIn("warp", sim.statistics["stage_seconds"])

    def test_the_plan_says_what_runs(self):
        self.assertIn("+ wind 'fan'", simulator().plan())
        self.assertIn("- obstacles", simulator().plan())


if __name__ == "__main__":
    unittest.main()
