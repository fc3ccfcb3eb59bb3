#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""An environment with the interface of gymnasium: a hand that holds the free edge of a curtain is to draw it open."""
from __future__ import annotations
from typing import TYPE_CHECKING, Any, Dict, Optional, Tuple

import curtain_engine
import numpy as np
if TYPE_CHECKING:  # NumPy's types came with 1.21
    from numpy.typing import NDArray
    Vector = NDArray[np.float32]

SCENE = {
    "cloth": {"rows": 16, "columns": 25, "height": 2.0, "width": 2.4, "surface_density": 0.2},
    "rail": {"path": [[0.0, 0.0, 2.2], [2.2, 0.0, 2.2]], "carriers": {"every": 4, "friction": 0.1}},
    "air": {"inside": 0.4, "border": 0.4, "corner": 0.4},
}
FRAMES, STEPS = 3, 200  # 1/60 s each, a step; an episode, 10 s
OPEN = 0.8  # of the way that the carriers have


class OpenCurtain:
    """Action: velocity of the hand [m/s], shape (3,), each in [-1, 1]. Observation, shape (88,): position of the hand
    [m], opening of the curtain (0 to 1), and positions [m] of every fourth node along either direction."""

    def __init__(self) -> None:
        self.simulator = curtain_engine.Simulator(SCENE)
        self.simulator.step(120)  # until it hangs still
        self.start = self.simulator.snapshot()
        self.positions = self.simulator.positions  # live: shows the present state
        self.random = np.random.default_rng()
        self.reset()

    def reset(self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None) -> Tuple[Vector, Dict[str, Any]]:
        """The curtain hangs in a draught, nearly shut; the hand has its edge a third to two thirds of the way down."""
        if seed is not None:
            self.random = np.random.default_rng(seed)
        self.simulator.restore(self.start)
        draught = {"position": [self.random.uniform(0.5, 1.7), -2.0, 1.0], "direction": [0.0, 1.0, 0.0]}
        self.simulator.set_wind({"id": "draught", "pressure": self.random.uniform(0.0, 0.5), **draught})
        edge = (int(self.random.integers(5, 11)), self.simulator.columns - 1)
        self.hand = self.positions[edge].copy()
        self.simulator.set_grasp("hand", self.hand, nodes=[edge], stiffness=200.0, break_force=15.0)
        self.steps = 0
        return self.observation(), {}

    def step(self, action: Vector) -> Tuple[Vector, float, bool, bool, Dict[str, Any]]:
        """Moves the hand for 1/20 s. The reward is the way that the curtain has opened, less 1 if the hand loses it."""
        before = self.opening()
        for _ in range(FRAMES):
            self.hand += np.clip(action, -1.0, 1.0) / 60.0
            if self.holds():
                self.simulator.move_grasp("hand", self.hand)
            self.simulator.step()
        self.steps += 1
        lost = not self.holds()
        reward = self.opening() - before - float(lost)
        return self.observation(), reward, lost or self.opening() > OPEN, self.steps >= STEPS, {"lost": lost}

    def holds(self) -> bool:
        """Not so once the pull has reached the hand's break_force."""
        state = self.simulator.grasp_state("hand")
        return state is not None and state["holds"]

    def opening(self) -> float:
        """0 where it is drawn shut, 1 where it is gathered as far as it goes."""
        return float(self.simulator.statistics["opening"])

    def observation(self) -> Vector:
        """A copy: what the simulator shows changes with the next step."""
        parts = [self.hand, [self.opening()], self.positions[::4, ::4].ravel()]
        observation: Vector = np.concatenate(parts).astype(np.float32)
        return observation


if __name__ == "__main__":
    environment, pull = OpenCurtain(), np.array([-0.5, 0.0, 0.0], dtype=np.float32)
    while not any(environment.step(pull)[2:4]):
        pass
    print("opening %.2f after %d steps" % (environment.opening(), environment.steps))
