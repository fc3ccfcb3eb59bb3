# SPDX-License-Identifier: BSD-3-Clause
"""Several cloths: their columns by name, their rails and fabrics."""
import unittest

import numpy

import curtain_engine


def scene():
    rail = {"path": [[0.0, 0.1, 2.0], [0.8, 0.1, 2.0]], "carriers": {"every": 2}}
    return {
        "cloth": {"rows": 7, "columns": 6, "height": 1.0, "width": 0.8, "folds": 2},
        "hang": {"from": [0.0, 0.0, 2.0], "to": [0.8, 0.0, 2.0]},
        "contact": {"self": True},
        "layers": [{"name": "dark", "cloth": {"rows": 7, "columns": 9, "height": 1.2, "width": 0.9, "folds": 2, "material": "blackout"},
                    "rail": rail}],
    }


class LayersTest(unittest.TestCase):
    def setUp(self):
        self.simulator = curtain_engine.Simulator(scene())

    def test_columns_go_by_name(self):
        layers = self.simulator.layers
        self.assertEqual(layers, {"cloth": slice(0, 6, 1), "dark": slice(6, 15, 1)})
        self.assertEqual(self.simulator.columns, 15)
        top = self.simulator.positions[0]
        self.assertTrue((top[layers["cloth"], 1] == 0.0).all())
        self.assertAlmostEqual(top[layers["dark"], 1].mean(), 0.1, delta=0.05)
        warp, weft = self.simulator.rest_lengths()
        self.assertEqual((warp.shape, weft.shape), ((6,), (7, 14)))
        rods = self.simulator.rods()
        self.assertEqual(rods.shape, (6, 15))
        self.assertTrue(numpy.allclose(rods.sum(axis=0), [1.0] * 6 + [1.2] * 9))

    def test_rails_and_fabrics_go_by_name(self):
        self.simulator.set_opening(0.5, layer="dark")
        for _ in range(200):
            self.simulator.step()
        self.assertAlmostEqual(self.simulator.opening("dark"), 0.5, delta=1e-3)
        self.assertEqual(self.simulator.opening(), 0.0)
        self.assertGreaterEqual(self.simulator.drive_force("dark"), 0.0)
        self.assertEqual(len(self.simulator.rail_points(0.1)), 0)
        self.assertGreater(len(self.simulator.rail_points(0.1, layer="dark")), 5)
        self.assertEqual(self.simulator.self_crossings(), 0)
        masses = numpy.array(self.simulator.masses()).reshape(7, 15)
        self.simulator.set_cloth(layer="dark", material="velvet")
        changed = numpy.array(self.simulator.masses()).reshape(7, 15)
        self.assertTrue((changed[:, :6] == masses[:, :6]).all())
        self.assertTrue((changed[1:, 6:] > 1.4 * masses[1:, 6:]).all(), "0.4773 over 0.3111 kg/m^2")

    def test_what_is_not_there_is_named(self):
        with self.assertRaisesRegex(ValueError, "rail"):
            self.simulator.set_opening(0.5)
        with self.assertRaisesRegex(ValueError, "layer"):
            self.simulator.opening("nobody")
        with self.assertRaisesRegex(ValueError, "layer"):
            self.simulator.set_cloth(layer="nobody", shear=1.0)
        bad = scene()
        bad["layers"][0]["cloth"]["rows"] = 8
        with self.assertRaisesRegex(ValueError, r"layers\[0\]\.cloth\.rows: must be that of the first cloth, 7, is 8"):
            curtain_engine.Simulator(bad)


if __name__ == "__main__":
    unittest.main()
