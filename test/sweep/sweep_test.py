#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/sweep: its runs are those of curtain_batch; killed at any moment it goes on and neither loses nor doubles a run; scenes that
fail are rows; bad input is one message before anything is written; other machines over ssh; what docs/sweeps.md tells to type.

    test/sweep/sweep_test.py path/to/curtain_batch [arguments of unittest]

Other machines are this one, by an sshd of the test's own on a high port, under the names localhost and 127.0.0.1.
"""
import csv
import getpass
import glob
import importlib
import json
import math
import os
import pty
import random
import re
import resource
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "scripts"))
from curtain_sweep.design import Design  # noqa: E402
from curtain_sweep.problem import Problem  # noqa: E402
from curtain_sweep.scenes import put  # noqa: E402

SWEEP = [sys.executable, os.path.join(ROOT, "scripts/sweep")]
BATCH = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 and os.path.isfile(sys.argv[1]) else None
SCENE = """
cloth: {rows: 12, columns: 10, folds: 3}
wind:
  - {id: fan, position: [0.5, -1.0, 1.0], direction: [0, 1, 0], pressure: 3.0}
"""
NO_PICTURE = "sweep: summary.png is left out: python3-matplotlib is not installed\n"
TIMED = re.compile(r"wall_s|ms_per_frame|stages|host")
SSHD = "/usr/sbin/sshd"


def module(name):
    """A module, or none where it is not installed."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


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
        for given, text in (({"parameters": {"a": {"min": "1e-3", "max": 1.0, "steps": 3}}}, "a.min: must be a number, is the text '1e-3'"),
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


@unittest.skipUnless(shutil.which("parallel"), "GNU parallel is not installed")
class SweepTest(unittest.TestCase):
    """Runs the program in a folder of its own."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="sweep-test-")
        self.addCleanup(shutil.rmtree, self.folder)
        # Drawing takes longer than the runs of these tests; one test has the picture.
        os.mkdir(self.of("site"))
        self.write("site/sitecustomize.py", "import sys\nsys.modules['matplotlib'] = None\n")
        self.environment = dict(os.environ, PYTHONPATH=self.of("site"))
        self.write("scene.yaml", SCENE)

    def of(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, text):
        with open(self.of(name), "w", encoding="utf-8") as file:
            file.write(text)

    def read(self, *names):
        with open(self.of(*names), encoding="utf-8") as file:
            return file.read()

    def params(self, text):
        self.write("params.yaml", text)

    def command(self, *more):
        return SWEEP + ["scene.yaml", "params.yaml", "--jobs", "2", "--curtain-batch", BATCH] + list(more)

    def sweep(self, *more, code=0, **keys):
        """Runs it; its exit code must be this one, and what it says on stderr is returned."""
        result = subprocess.run(self.command(*more), cwd=self.folder, env=self.environment, text=True, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=120, check=False, **keys)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stderr.replace(NO_PICTURE, "")

    def rows(self, name="params.sweep"):
        return list(csv.DictReader(self.read(name, "results.csv").splitlines()))

    def untimed(self, name="params.sweep"):
        return [{key: value for key, value in row.items() if not TIMED.match(key)} for row in self.rows(name)]

    def refused(self, *fragments, more=()):
        """Exit code 2 with one message, and nothing new in the folder."""
        before = sorted(os.listdir(self.folder))
        said = self.sweep(*more, code=2)
        self.assertEqual((len(said.splitlines()), said[:7]), (1, "sweep: "), said)
        for fragment in fragments:
            self.assertIn(fragment, said)
        self.assertEqual(sorted(os.listdir(self.folder)), before)


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


class BadInput(SweepTest):
    def test_is_one_message_before_anything_is_written(self):
        for text, fragments in {
                "parameters:\n  contact.frictoin: [0.1, 0.2]\n": ["contact.frictoin", "did you mean friction"],
                "parameters:\n  winds[0].pressure: [1.0]\n": ["winds[0].pressure", "did you mean wind"],
                "parameters:\n  contact.friction: [0.1, -0.2]\n": ["run 2", "contact.friction", "[0, 10]", "-0.2"],
                "parameters:\n  contact.friction: {min: 1.0, max: 0.5, steps: 3}\n": ["params.yaml: contact.friction", "1.0", "0.5"],
                "metrics: [stretch_max.wrap]\nparameters:\n  contact.friction: [0.1]\n": ["stretch_max.wrap", "did you mean stretch_max.warp"],
                "parameters:\n  contact.friction: !!set {0.1}\n": ["params.yaml", "not YAML", "set"],
                "parameters: [": ["params.yaml", "not YAML"]}.items():
            with self.subTest(text):
                self.params(text)
                self.refused(*fragments)

    def test_files_and_programs_that_are_missing_are_named(self):
        self.params("parameters:\n  contact.friction: [0.1]\n")
        self.refused("nowhere", more=["--curtain-batch", "nowhere/curtain_batch"])
        self.refused("hosts.txt", "No such file", more=["--hosts", "hosts.txt"])
        self.refused("--hdf5", "no folder", more=["--hdf5", "no folder/a.h5"])
        self.write("site/sitecustomize.py", "import sys\nsys.modules['h5py'] = None\n")
        self.refused("python3-h5py", more=["--hdf5", "a.h5"])
        os.remove(self.of("scene.yaml"))
        self.refused("scene.yaml", "No such file")

    def test_without_parallel_it_says_so(self):
        self.params("parameters:\n  contact.friction: [0.1]\n")
        self.environment["PATH"] = self.folder
        self.refused("GNU parallel")

    def test_another_sweep_in_the_folder_is_kept(self):
        self.params("duration: 0.1\nparameters:\n  contact.friction: [0.1]\n")
        self.sweep()
        table = self.read("params.sweep", "results.csv")
        self.params("duration: 0.1\nparameters:\n  contact.friction: [0.2]\n")
        self.refused("params.sweep", "contact.friction", "0.2", "0.1", "--out", "--force")
        self.assertEqual(self.read("params.sweep", "results.csv"), table)
        self.write("scene.yaml", SCENE.replace("rows: 12", "rows: 13"))
        self.refused("cloth.rows is 13, was 12")
        self.assertTrue(os.path.exists(self.of("params.sweep", "joblog")))
        # Killed inside --force, at the worst of moments: the other sweep's, of which nothing is made.
        self.write("killed.py", "import os, signal, sys\nsys.path.insert(0, sys.argv[1])\nimport curtain_sweep.folder as folder\n"
                   "folder.replace = lambda *_: os.kill(os.getpid(), signal.SIGKILL)\nfolder.Folder('params.sweep').open({}, True)\n")
        killed = subprocess.run([sys.executable, "killed.py", os.path.join(ROOT, "scripts")], cwd=self.folder, check=False)
        self.assertEqual(killed.returncode, -signal.SIGKILL)
        self.assertFalse(os.path.exists(self.of("params.sweep", "joblog")))
        self.refused("cloth.rows is 13, was 12")
        self.sweep("--force")
        self.assertEqual([row["contact.friction"] for row in self.rows()], ["0.2"])
        self.sweep("--out", "another")
        os.mkdir(self.of("mine"))
        self.write("mine/thesis.txt", "years of work")
        self.refused("mine", "something else", more=["--out", "mine", "--force"])


class Interrupted(SweepTest):
    """Killed, and a disk that is full."""

    def setUp(self):
        super().setUp()
        self.params("design: latin_hypercube\ncount: 20\nduration: 6.0\nparameters:\n  wind[0].pressure: {min: 1.0, max: 9.0}\n  solver.seed: [1, 2]\n")

    def start(self):
        """Starts it, and waits until it has made another run; none: it is done before."""
        process = subprocess.Popen(self.command(), cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, start_new_session=True)
        before, deadline = self.logged(), time.monotonic() + 60
        while self.logged() == before and time.monotonic() < deadline:
            if process.poll() is not None:
                return None
            time.sleep(0.005)
        return process

    def logged(self):
        try:
            return len(self.read("params.sweep", "joblog").splitlines())
        except FileNotFoundError:
            return 1

    def good_lines(self):
        """Of the job log, those of runs that were made; the last may be cut short."""
        lines = self.read("params.sweep", "joblog").split("\n")[1:-1]
        return [line for line in lines if line.split("\t")[6:8] == ["0", "0"]]

    def test_one_sweep_at_a_time_is_at_work_in_a_folder(self):
        process = self.start()
        os.killpg(process.pid, signal.SIGSTOP)  # it has not ended before the second one begins
        second = subprocess.Popen(self.command(), cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, universal_newlines=True)
        try:
            self.assertTrue(any("params.sweep is in use by another sweep" in line for line in second.stderr))
        finally:
            os.killpg(process.pid, signal.SIGCONT)
        self.assertEqual(process.wait(), 0)
        second.communicate()
        self.assertEqual(second.returncode, 0)
        self.assertEqual(len(self.good_lines()), 20)

    def family(self, pid):
        """The process and all that came of it."""
        children = {}
        for status in glob.glob("/proc/[0-9]*/stat"):
            try:
                with open(status, encoding="utf-8", errors="replace") as file:
                    head, _, rest = file.read().rpartition(")")
                children.setdefault(int(rest.split()[1]), []).append(int(head.split()[0]))
            except OSError:
                continue  # it has ended meanwhile
        found = [pid]
        for parent in found:
            found += children.get(parent, [])
        return found

    def test_killed_at_any_moment_it_loses_and_doubles_no_run(self):
        self.sweep("--out", "whole")
        dice = random.Random(20)
        kills, kept = 0, set()
        for attempt in range(6):
            process = self.start()
            if process is None:
                break
            time.sleep(dice.uniform(0.0, 0.1))
            family = self.family(process.pid)
            # All of it; it alone, with parallel and runs left over; parallel alone.
            victims = [family, family[:1], family[1:2]][attempt % 3]
            for pid in victims:
                try:
                    os.kill(pid, signal.SIGKILL)
                    kills += 1
                except ProcessLookupError:
                    pass
            process.wait()
            kept |= set(self.good_lines())
        self.sweep()
        self.assertGreater(kills, 5)
        self.assertEqual(kept - set(self.good_lines()), set(), "what was made is not made again")
        self.assertEqual(self.untimed(), self.untimed("whole"))
        made = [line.split("\t")[0] for line in self.good_lines()]
        self.assertEqual(sorted(map(int, made)), list(range(1, 21)), "each is logged as made once")

    def test_interrupted_it_ends_its_runs_and_says_so(self):
        self.params("design: random\ncount: 20\nduration: 60.0\nparameters:\n  solver.seed: [1, 2]\n")  # longer than it may take to end
        process = self.start()
        family = self.family(process.pid)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=30), 4)
        deadline = time.monotonic() + 30
        while any(os.path.exists("/proc/%d" % pid) for pid in family) and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertEqual([pid for pid in family if os.path.exists("/proc/%d" % pid)], [], "nothing is left running")
        self.assertTrue(0 < len(self.rows()) < 20, "what is made is in the table")

    def test_a_line_of_the_log_that_is_cut_short_is_made_again(self):
        self.params("count: 5\ndesign: random\nduration: 0.1\nparameters:\n  wind[0].pressure: {min: 1.0, max: 9.0}\n")
        self.sweep()
        rows = self.untimed()
        log = self.read("params.sweep", "joblog")
        for length in (len(log) - 9, 20):
            self.write("params.sweep/joblog", log[:length])
            self.sweep()
            self.assertEqual(self.untimed(), rows)

    def test_runs_whose_files_are_not_whole_are_made_again(self):
        self.params("duration: 0.1\nparameters:\n  contact.friction: [0.1, 0.2, 0.3, 0.4]\n")
        hdf5 = ["--hdf5", "a.h5"] if module("h5py") else []
        self.sweep(*hdf5)
        rows = self.untimed()
        os.remove(self.of("params.sweep", "runs", "1.result"))
        self.write("params.sweep/runs/2.result", "")
        self.write("params.sweep/runs/3.result", self.read("params.sweep", "runs", "3.result")[:-20])
        if hdf5:
            self.write("params.sweep/runs/4.csv", self.read("params.sweep", "runs", "4.csv")[:-20])
        self.sweep(*hdf5)
        self.assertEqual(self.untimed(), rows)
        self.assertEqual(sorted(int(line.split("\t")[0]) for line in self.good_lines()), [1, 2, 3, 4])

    def test_a_run_whose_files_do_not_come_is_not_made(self):
        self.params("duration: 0.1\nparameters:\n  contact.friction: [0.1, 0.2]\n")
        # As parallel has it where its --return fails: the job is logged as good.
        self.write("curtain_batch", '#!/bin/sh\n%s "$@" || exit\n[ -e "%s" ] || [ "$1" != 2.yaml ] || [ "$2" = --check ] || rm -f 2.result\n' %
                   (BATCH, self.of("mended")))
        os.chmod(self.of("curtain_batch"), 0o755)
        said = self.sweep("--curtain-batch", self.of("curtain_batch"), code=4)
        self.assertEqual(said, "sweep: 1 of 2 runs are not made, the first is 2; nothing is lost, start the same command again\n")
        self.assertEqual([row["run"] for row in self.rows()], ["1"])
        self.write("mended", "")
        self.sweep("--curtain-batch", self.of("curtain_batch"))
        self.assertEqual([row["run"] for row in self.rows()], ["1", "2"])

    def test_a_full_disk_is_told_and_nothing_is_lost(self):
        # A limit of file sizes in place of the disk's: trajectories do not fit, everything else does.
        self.params("count: 8\ndesign: random\nduration: 0.5\nsamples_per_second: 60\nparameters:\n  wind[0].pressure: {min: 1.0, max: 9.0}\n")
        if module("h5py") is None:
            self.skipTest("python3-h5py is not installed")
        limit = 200000
        said = self.sweep("--hdf5", "a.h5", code=4, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        self.assertRegex(said, r"^sweep: \d of 8 runs are not made: run \d: exit code 4: .*cannot be written: File too large; "
                         "nothing is lost, start the same command again\n$")
        self.sweep("--hdf5", "a.h5")
        self.assertEqual([row["exit_code"] for row in self.rows()], ["0"] * 8)
        self.assertGreater(os.path.getsize(self.of("params.sweep", "runs", "1.csv")), limit)
        os.remove(self.of("a.h5"))
        said = self.sweep("--hdf5", "a.h5", code=4, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        self.assertEqual(said, "sweep: a.h5: File too large; nothing is lost, start the same command again\n")
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("a.h5")], [])


@unittest.skipUnless(os.path.exists(SSHD) and shutil.which("ssh") and shutil.which("rsync"), "openssh-server or rsync is not installed")
class Machines(SweepTest):
    """This machine under two names."""

    def setUp(self):
        super().setUp()
        if os.geteuid() == 0:
            os.makedirs("/run/sshd", exist_ok=True)  # where root's sshd confines itself
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        for key in ("host", "user"):
            subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", self.of(key)], check=True)
        self.write("sshd_config", "Port %d\nListenAddress 127.0.0.1\nHostKey %s\nPidFile %s\nAuthorizedKeysFile %s\nStrictModes no\n"
                   "PasswordAuthentication no\nKbdInteractiveAuthentication no\nUsePAM no\n" % (port, self.of("host"), self.of("pid"), self.of("user.pub")))
        # One connection a machine for all that parallel and rsync do.
        self.write("ssh_config", "Host *\nPort %d\nUser %s\nIdentityFile %s\nIdentitiesOnly yes\nUserKnownHostsFile /dev/null\n"
                   "StrictHostKeyChecking no\nLogLevel ERROR\nControlMaster auto\nControlPath %s/%%h\nControlPersist 3\n" %
                   (port, getpass.getuser(), self.of("user"), self.folder))
        self.server = subprocess.Popen([SSHD, "-D", "-f", self.of("sshd_config"), "-E", self.of("sshd.log")])
        self.addCleanup(self.stop)
        deadline = time.monotonic() + 20
        while subprocess.run(["ssh", "-F", self.of("ssh_config"), "-o", "BatchMode=yes", "localhost", "true"], check=False,
                             stderr=subprocess.DEVNULL).returncode != 0:
            if self.server.poll() is not None or time.monotonic() > deadline:
                self.skipTest("sshd does not run here: " + self.read("sshd.log"))

    def stop(self):
        for host in ("localhost", "127.0.0.1"):
            subprocess.run(["ssh", "-F", self.of("ssh_config"), "-O", "exit", host], check=False, stderr=subprocess.DEVNULL)
        self.server.terminate()
        self.server.wait()

    def over(self, hosts, *more):
        self.write("hosts", hosts)
        return ["--hosts", "hosts", "--ssh", "ssh -F " + self.of("ssh_config"), "--jobs", "1"] + list(more)

    def test_runs_are_spread_over_machines(self):
        shutil.copy(os.path.join(ROOT, "test/meshes/cube_binary.stl"), self.folder)
        self.write("scene.yaml", SCENE + "obstacles: [{name: box, shape: mesh, mesh: cube_binary.stl, position: [0, 1, 0]}]\n")
        self.params("duration: 0.1\nparameters:\n  contact.friction: [0.1, 0.2, 0.3, 0.4]\n")
        self.sweep("--out", "here")
        # Nobody listens at 127.0.0.2.
        said = self.sweep(*self.over("localhost\n127.0.0.1  # the second\n127.0.0.2\n"))
        self.assertEqual(len(said.splitlines()), 1, said)
        self.assertRegex(said, "host 127.0.0.2 does not answer: .*; the runs go to the other hosts")
        self.assertEqual({row["host"] for row in self.rows()}, {"localhost", "127.0.0.1"})
        self.assertEqual(self.untimed(), self.untimed("here"))
        self.refused("no host is left", "127.0.0.2", more=self.over("127.0.0.2\n", "--out", "nothing"))

    def test_machines_must_have_the_same_program(self):
        self.params("duration: 0.1\nparameters:\n  contact.friction: [0.1]\n")
        self.write("curtain_batch", '#!/bin/sh\n[ -z "$SSH_CONNECTION" ] && exec %s "$@"\necho curtain_batch 0.0.1\n' % BATCH)
        os.chmod(self.of("curtain_batch"), 0o755)
        self.refused("host localhost has curtain_batch 0.0.1", more=self.over("localhost\n", "--curtain-batch", self.of("curtain_batch")))


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


if __name__ == "__main__":
    if BATCH is None:
        sys.exit(__doc__)
    unittest.main()
