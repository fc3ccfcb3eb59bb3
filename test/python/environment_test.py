# SPDX-License-Identifier: BSD-3-Clause
"""The example docs/examples/open_curtain.py: an environment that gymnasium's interface fits."""
import inspect
import os
import sys
import unittest

import numpy

import testing

sys.path.insert(0, os.path.join(testing.ROOT, "docs", "examples"))
from open_curtain import STEPS, OpenCurtain  # noqa: E402


class Environment(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.environment = OpenCurtain()

    def episode(self, seed, policy):
        """All that comes of an episode."""
        observation, info = self.environment.reset(seed=seed)
        self.assertEqual(info, {})
        observations, rewards = [observation], []
        while True:
            observation, reward, terminated, truncated, info = self.environment.step(policy(observation))
            observations.append(observation)
            rewards.append(reward)
            self.assertEqual((type(reward), type(terminated), type(truncated), type(info)), (float, bool, bool, dict))
            if terminated or truncated:
                return numpy.array(observations), numpy.array(rewards), terminated, truncated

    def test_has_the_interface_and_at_most_80_lines(self):
        self.assertEqual(str(inspect.signature(OpenCurtain.reset)).split(" -> ")[0].count("Optional"), 2)
        self.assertEqual(list(inspect.signature(OpenCurtain.reset).parameters), ["self", "seed", "options"])
        self.assertEqual(list(inspect.signature(OpenCurtain.step).parameters), ["self", "action"])
        with open(os.path.join(testing.ROOT, "docs/examples/open_curtain.py"), encoding="utf-8") as file:
            self.assertLessEqual(len(file.readlines()), 80)

    def test_who_pulls_opens_it_and_who_does_not_does_not(self):
        observations, rewards, terminated, _ = self.episode(1, lambda _: numpy.float32([-0.5, 0, 0]))
        self.assertTrue(terminated)
        self.assertEqual((observations.dtype, observations.shape[1:]), (numpy.float32, (88,)))
        self.assertTrue(numpy.isfinite(observations).all())
        self.assertGreater(observations[-1, 3], 0.8)
        # The rewards add up to the way that was opened; observations are rounded to floats.
        numpy.testing.assert_allclose(rewards.sum(), observations[-1, 3] - observations[0, 3], atol=1e-6)
        _, rewards, terminated, truncated = self.episode(1, lambda _: numpy.zeros(3, dtype=numpy.float32))
        self.assertEqual((terminated, truncated, len(rewards)), (False, True, STEPS))
        self.assertLess(rewards.sum(), 0.1)

    def test_a_hand_that_tears_loses(self):
        _, rewards, terminated, _ = self.episode(1, lambda _: numpy.float32([1, 0, -1]))
        self.assertTrue(terminated)
        self.assertLess(rewards[-1], -0.9)

    def test_a_seed_gives_an_episode(self):
        def random():
            generator = numpy.random.default_rng(5)
            return lambda _: generator.uniform(-1, 1, 3)

        first, again, other = (self.episode(seed, random())[0] for seed in (3, 3, 4))
        numpy.testing.assert_array_equal(first, again)
        self.assertFalse(numpy.array_equal(first[0], other[0]))

    def test_a_thousand_resets_take_no_memory(self):
        def play(times):
            for _ in range(times):
                self.environment.reset()
                self.environment.step(numpy.float32([-1, 0, 0]))

        play(100)  # buffers and malloc's arenas find their size
        before = testing.memory()
        play(1000)
        # An observation a reset kept would be 350 kB, a snapshot 150 MB. malloc keeps 2 x 128 KiB at most at the top of the heap.
        self.assertLess(testing.memory() - before, 256 * 1024)


if __name__ == "__main__":
    unittest.main()
