# SPDX-License-Identifier: BSD-3-Clause
"""The runs of scripts/sweep are those of curtain_batch, in one table; and what docs/sweeps.md tells to type."""
import json
import os
import pty
import re
import subprocess

from sweep_testing import BATCH, ROOT, SCENE, SweepTest, module


class Results(SweepTest):
    def test_runs_are_those_of_curtain_batch(self):
        self.params("duration: 0.3\nparameters:\n  cloth.material: [silk, canvas]\n  wind[0].pressure: {min: 1.0, max: 4.0, steps: 2}\n")
        self.sweep()
        rows = self.rows()
        self.assertEqual([(row["run"], row["cloth.material"], row["wind[0].pressure"], row["exit_code"], row["error"]) for row in rows],
                         [("1", "silk", "1.0", "0", ""), ("2", "silk", "4.0", "0", ""), ("3", "canvas", "1.0", "0", ""), ("4", "canvas", "4.0", "0", "")])
        self.write("own.yaml", SCENE.replace("pressure: 3.0", "pressure: 4.0").replace("folds: 3", "folds: 3, material: silk"))
        subprocess.run([BATCH, "own.yaml", "--duration", "0.3", "--stats", "own.json"], cwd=self.folder, check=True)
        own = json.loads(self.read("own.json"))
        self.assertEqual(rows[1]["state_hash"], own["state_hash"])
        self.assertEqual(float(rows[1]["energy.final"]), own["energy"]["final"])
        self.assertEqual(len({row["state_hash"] for row in rows}), 4)
        self.assertFalse(os.path.exists(self.of("params.sweep", "summary.png")))
        log = self.read("params.sweep", "joblog")
        del self.environment["PYTHONPATH"]
        self.sweep()
        if module("matplotlib"):
            with open(self.of("params.sweep", "summary.png"), "rb") as file:
                self.assertEqual(file.read(4), b"\x89PNG")
        self.assertEqual(self.read("params.sweep", "joblog"), log, "a sweep that is done makes no run again")

    def test_a_scene_that_fails_is_a_row(self):
        meshes = os.path.join(ROOT, "test/meshes")
        self.write("scene.yaml", SCENE + "obstacles: [{name: box, shape: mesh, mesh: none, position: [0, 1, 0]}]\n")
        self.params("duration: 0.1\nmetrics: [state_hash]\nparameters:\n  obstacles[0].mesh: [%s/cube_binary.stl, %s/bad_garbage.stl]\n" % (meshes, meshes))
        self.sweep()
        good, bad = self.rows()
        self.assertEqual((good["exit_code"], good["error"], bad["exit_code"], bad["state_hash"]), ("0", "", "2", ""))
        self.assertIn("bad_garbage.stl", bad["error"])
        self.assertNotEqual(good["state_hash"], "")

    def test_what_looks_like_a_date_is_a_text(self):
        self.write("scene.yaml", SCENE.replace("id: fan", "id: 2024-01-01"))
        self.params("duration: 0\nparameters:\n  contact.friction: [0.1]\n")
        self.sweep()
        self.assertIn("2024-01-01", self.read("params.sweep", "runs", "1.yaml"))

    def test_trajectories_are_in_one_file(self):
        h5py = module("h5py")
        if h5py is None:
            self.skipTest("python3-h5py is not installed")
        self.params("duration: 0.2\nparameters:\n  contact.friction: [0.1, 0.5]\n")
        self.sweep("--hdf5", "states.h5")
        with h5py.File(self.of("states.h5")) as file:
            self.assertEqual(list(file), ["1", "2"])
            self.assertEqual(file["2"].attrs["contact.friction"], 0.5)
            self.assertEqual(file["2/positions"].shape, (3, 12, 10, 3))
            self.assertEqual(file["2/velocities"].shape, (3, 12, 10, 3))
            self.assertEqual([round(t, 12) for t in file["2/t"]], [0.0, 0.1, 0.2])
            last = self.read("params.sweep", "runs", "2.csv").splitlines()[-1].split(",")
            self.assertEqual([float(x) for x in last[3:6]], list(file["2/positions"][-1, -1, -1]))
        self.refused("trajectories", "another sweep")

    def test_trajectories_have_any_number_of_states(self):
        h5py = module("h5py")
        if h5py is None:
            self.skipTest("python3-h5py is not installed")
        # As a list their times would be longer than the 128 KB that Linux has for one argument.
        self.params("duration: 0.1\nsamples_per_second: 100000\nparameters:\n  cloth.rows: [4]\n  cloth.columns: [4]\n")
        self.sweep("--hdf5", "states.h5")
        with h5py.File(self.of("states.h5")) as file:
            self.assertEqual(file["1/positions"].shape, (10001, 4, 4, 3))

    def test_parameters_in_another_order_are_another_sweep(self):
        by_name = "  contact.friction: [0.1, 0.5]\n", "  solver.seed: [1, 2]\n"
        self.params("duration: 0.1\nparameters:\n" + by_name[0] + by_name[1])
        self.sweep()
        self.params("duration: 0.1\nparameters:\n" + by_name[1] + by_name[0])
        self.refused("order of parameters", "another sweep")

    def test_a_terminal_sees_progress_and_the_time_left(self):
        self.params("duration: 0.1\nparameters:\n  contact.friction: [0.1, 0.2, 0.3]\n")
        ours, theirs = pty.openpty()
        process = subprocess.Popen(self.command(), cwd=self.folder, env=dict(self.environment, TERM="xterm"), stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=theirs)
        os.close(theirs)
        seen = b""
        try:
            while part := os.read(ours, 4096):
                seen += part
        except OSError:  # the other end is closed
            pass
        os.close(ours)
        self.assertEqual(process.wait(), 0)
        self.assertRegex(seen.decode(errors="replace"), r"100% 3:0=\d+s")


class Page(SweepTest):
    """What docs/sweeps.md tells to type."""

    def test_its_commands_work(self):
        with open(os.path.join(ROOT, "docs/sweeps.md"), encoding="utf-8") as file:
            page = file.read()
        for name, text in re.findall(r"^```yaml (\S+)\n(.*?)^```$", page, re.M | re.S):
            self.write(name, text)
        for name in ("scripts", "config"):
            os.symlink(os.path.join(ROOT, name), self.of(name))
        commands = [line for block in re.findall(r"^```sh\n(.*?)^```$", page, re.M | re.S) for line in block.splitlines()
                    if line.startswith("scripts/sweep") and "--hosts" not in line]
        self.assertGreater(len(commands), 1)
        for command in commands:
            result = subprocess.run(["sh", "-c", command + " --curtain-batch " + BATCH], cwd=self.folder, env=self.environment, text=True,
                                    stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=120, check=False)
            self.assertEqual(result.returncode, 0, command + "\n" + result.stderr)
            self.assertIn("none failed", result.stdout)
