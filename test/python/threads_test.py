# SPDX-License-Identifier: BSD-3-Clause
"""Frames are made without the GIL, can be interrupted, and keep other threads out; nothing leaks."""
import os
import signal
import threading
import unittest

import curtain_engine
import numpy

import testing


class Interrupted(Exception):
    """Raised by the test's signal."""


def interrupt(_signal, _frame):
    raise Interrupted


class Threads(unittest.TestCase):
    def test_other_threads_run_and_are_kept_out(self):
        sim = curtain_engine.Simulator(testing.scene(solver={"rest_speed": 0.0}))
        positions = sim.positions
        refused = []
        done = threading.Event()

        def knock():
            """Calls in until that is refused, which it only is while frames are made; then interrupts them."""
            while not refused and not done.is_set():
                try:
                    sim.snapshot()
                except RuntimeError as error:
                    refused.append(str(error))
            for call in (lambda: sim.time, lambda: sim.positions, lambda: sim.step(), lambda: sim.set_friction(0.2), lambda: sim.reset(),
                         lambda: sim.restore(b""), lambda: sim.contact_points(), lambda: sim.obstacles):
                try:
                    call()
                except RuntimeError as error:
                    refused.append(str(error))
            os.kill(os.getpid(), signal.SIGUSR1)

        before = signal.signal(signal.SIGUSR1, interrupt)
        thread = threading.Thread(target=knock)
        try:
            # Some seconds of computing, if nobody interrupts; that happens in the first of them.
            with self.assertRaises(Interrupted):
                thread.start()
                sim.step(200000)
        finally:
            done.set()
            thread.join()
            signal.signal(signal.SIGUSR1, before)
        self.assertEqual(refused, ["the simulator is in use: another thread is in one of its methods"] * 9)
        # It stopped between two frames: the arrays show them, and it goes on.
        frames = sim.statistics["frames"]
        self.assertLess(frames, 200000)
        self.assertTrue(numpy.array_equal(positions, sim.positions.copy()))
        twin = curtain_engine.Simulator(testing.scene(solver={"rest_speed": 0.0}))
        twin.step(frames)
        self.assertEqual(twin.state_hash(), sim.state_hash())
        sim.step()

    def test_simulators_side_by_side_have_their_own_bits(self):
        scenes = [testing.scene(solver={"seed": seed}, cloth={"rows": 8 + seed, "columns": 6, "height": 1.0, "width": 0.8}) for seed in range(4)]

        def run(scene):
            sim = curtain_engine.Simulator(scene)
            for _ in range(100):
                sim.step()
            return sim.state_hash()

        alone = [run(scene) for scene in scenes]
        together = [None] * len(scenes)

        def work(k):
            together[k] = run(scenes[k])

        threads = [threading.Thread(target=work, args=(k,)) for k in range(len(scenes))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(together, alone)
        self.assertEqual(len(set(alone)), len(alone))


class Memory(unittest.TestCase):
    # What malloc may keep at the top of the heap before it gives it back: M_TRIM_THRESHOLD and M_TOP_PAD of glibc, 128 KiB each.
    KEPT = 2 * 128 * 1024

    def test_simulators_and_arrays_do_not_leak(self):
        scene = curtain_engine.Scene(testing.scene(obstacles=[testing.BALL]))

        def use():
            sim = curtain_engine.Simulator(scene)
            arrays = [sim.positions, sim.velocities, sim.forces, sim.fine_positions, sim.fine_triangles, sim.weft_tensions]
            sim.set_wind({"id": "other", "pressure": 1.0})
            sim.step()
            sim.restore(sim.snapshot())
            try:
                sim.set_state(arrays[3], arrays[1])
            except ValueError:
                pass
            return arrays

        for _ in range(50):
            use()
        before = testing.memory()
        for _ in range(400):  # the smallest thing here, an array of 48 doubles and a dict, times this, is more than is kept
            use()
        self.assertLess(testing.memory() - before, self.KEPT)


if __name__ == "__main__":
    unittest.main()
