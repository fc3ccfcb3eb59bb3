# SPDX-License-Identifier: BSD-3-Clause
"""PARAMS.yaml to the values of a sweep."""
import math
import os
import re
import sys
import unittest

from sweep_testing import ROOT

sys.path.insert(0, os.path.join(ROOT, "scripts"))
from curtain_sweep.design import Design  # noqa: E402
from curtain_sweep.problem import Problem  # noqa: E402
from curtain_sweep.scenes import put  # noqa: E402


class Designs(unittest.TestCase):
    """PARAMS.yaml to values."""

    RANGES = {"a": {"min": 2.0, "max": 4.0}, "b": {"min": 1e-3, "max": 10.0, "scale": "log"}, "c": ["x", "y", "z"]}

    def test_a_latin_hypercube_meets_every_stratum_once(self):
        for seed in (1, 2):
            runs = Design({"design": "latin_hypercube", "count": 30, "seed": seed, "parameters": self.RANGES}).runs()
            a, b, c = zip(*runs)
            self.assertEqual(sorted(int((value - 2.0) / 2.0 * 30) for value in a), list(range(30)))
            self.assertEqual(sorted(int((math.log10(value) + 3.0) / 4.0 * 30) for value in b), list(range(30)))
            self.assertEqual(sorted(c), ["x"] * 10 + ["y"] * 10 + ["z"] * 10)
            self.assertNotEqual(list(a), sorted(a))

    def test_the_same_seed_gives_the_same_runs_everywhere(self):
        given = {"design": "random", "count": 3, "seed": 7, "parameters": {"a": {"min": 0.0, "max": 1.0}}}
        # random.Random(7).random(), which Python promises to keep.
        self.assertEqual(Design(given).runs(), [[0.32383276483316237], [0.15084917392450192], [0.6509344730398537]])
        self.assertNotEqual(Design(dict(given, seed=8)).runs(), Design(given).runs())

    def test_random_values_stay_in_their_range(self):
        runs = Design({"design": "random", "count": 500, "parameters": dict(self.RANGES, n={"min": 3, "max": 5, "integer": True})}).runs()
        a, b, c, n = zip(*runs)
        self.assertTrue(all(2.0 <= value <= 4.0 for value in a) and all(1e-3 <= value <= 10.0 for value in b))
        self.assertEqual((set(c), set(n)), ({"x", "y", "z"}, {3, 4, 5}))
        self.assertAlmostEqual(sum(value < 0.1 for value in b) / 500, 0.5, delta=4 * math.sqrt(0.25 / 500))  # 4 standard deviations

    def test_whole_numbers_have_their_share_of_the_range(self):
        count = 6000
        for scale, low, high, shares in (("linear", 3, 5, [1 / 3] * 3), ("linear", 2.6, 5.9, [1 / 3] * 3),
                                         ("log", 2, 4, [math.log((n + 1) / n) / math.log(5 / 2) for n in (2, 3, 4)])):
            given = {"min": low, "max": high, "scale": scale, "integer": True}
            # Every stratum is met once: the ends of a number's share cut two of them, so its count is off by 2 at most.
            values = [run[0] for run in Design({"design": "latin_hypercube", "count": count, "parameters": {"n": given}}).runs()]
            numbers = range(math.ceil(low), math.floor(high) + 1)
            self.assertEqual(set(values), set(numbers))
            for n, share in zip(numbers, shares):
                self.assertAlmostEqual(values.count(n), share * count, delta=2)
        grid = Design({"parameters": {"n": {"min": 12, "max": 24, "steps": 4, "integer": True}, "m": {"min": 1, "max": 1000, "steps": 4, "integer": True, "scale": "log"}}})
        self.assertEqual([p.values for p in grid.parameters], [[12, 16, 20, 24], [1, 10, 100, 1000]])

    def test_a_grid_has_all_combinations(self):
        runs = Design({"parameters": {"a": [1, 2], "b": {"min": 1.0, "max": 100.0, "steps": 3, "scale": "log"}}}).runs()
        self.assertEqual([run[0] for run in runs], [1, 1, 1, 2, 2, 2])
        for run, value in zip(runs, (1.0, 10.0, 100.0) * 2):
            self.assertAlmostEqual(run[1], value, delta=1e-12 * value)  # of exp(log())

    def test_what_is_wrong_is_named(self):
        friction = {"contact.friction": [0.1]}
        for given, text in (({"parameters": {"a": {"min": "1e-3 m", "max": 1.0, "steps": 3}}}, "a.min: must be a number, is the text '1e-3 m'"),
                            ({"parameters": {"a": {"min": 0.0, "max": 1.0, "steps": 3, "scale": "log"}}}, "a.min: must be > 0"),
                            ({"parameters": {"a": {"min": 0.0, "max": 1.0}}}, "a.steps: is missing"),
                            ({"parameters": {"a": {"min": 0.0}}, "design": "random", "count": 2}, "a.max: is missing"),
                            ({"parameters": {"a": {"min": 0.0, "mx": 1.0}}}, "a.mx: is not a known key, did you mean max"),
                            ({"parameters": {"a": {"min": 2.6, "max": 2.9, "integer": True}}}, "a: there is no whole number from min 2.6 to max 2.9"),
                            ({"parameters": {"a": {"min": 1, "max": 10**400}}}, "a.max: must be a finite number"),
                            ({"parameters": {"a": {"min": -1.0e308, "max": 1.0e308}}}, "a: from min -1e+308 to max 1e+308 is too far"),
                            ({"parameters": friction, "samples_per_second": 1000001}, "samples_per_second: at most 1000000 states"),
                            ({"parameters": {"a": []}}, "a: the list is empty"),
                            ({"parameters": {"a": 3}}, "a: must be a list of values or {min, max}"),
                            ({"parameters": {"a b": [3]}}, "'a b' is no key"),
                            ({"parameters": {}}, "parameters: must name"),
                            ({"parameters": friction, "desing": "grid"}, "desing: is not a known key, did you mean design"),
                            ({"parameters": friction, "design": "lhs"}, "design: must be grid, latin_hypercube or random, is lhs"),
                            ({"parameters": friction, "design": "random"}, "count: is missing"),
                            ({"parameters": friction, "design": "random", "count": 0}, "count: must be a whole number in [1, "),
                            ({"parameters": friction, "count": 3}, "count: a grid has"),
                            ({"parameters": friction, "duration": -1.0}, "duration: must be a finite number >= 0, is -1.0"),
                            ({"parameters": friction, "seed": 0.5}, "seed: must be a whole number"),
                            ({"parameters": {"a": {"min": 0.0, "max": 1.0, "steps": 1000}, "b": list(range(2000))}}, "2000000 runs"),
                            ([], "must be keys")):
            with self.subTest(given), self.assertRaisesRegex(Problem, re.escape(text)):
                Design(given)

    def test_keys_are_found_by_their_path(self):
        scene = {"wind": [{"pressure": 1}, {}], "cloth": {"rows": 3}, "air": None}
        put(scene, "wind[1].pressure", 5)
        put(scene, "cloth.rows", 7)
        put(scene, "air.density", 1.3)
        put(scene, "solver.seed", 2)
        self.assertEqual(scene, {"wind": [{"pressure": 1}, {"pressure": 5}], "cloth": {"rows": 7}, "air": {"density": 1.3},
                                 "solver": {"seed": 2}})
        for path, text in {"winds[0].pressure": "did you mean wind", "wind[2].pressure": "wind[2]", "cloth.rows.n": "cloth.rows"}.items():
            with self.assertRaisesRegex(Problem, re.escape(text)):
                put(scene, path, 1)
