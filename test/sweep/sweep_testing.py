# SPDX-License-Identifier: BSD-3-Clause
"""For tests of scripts/sweep: runs it in a folder of its own. CURTAIN_BATCH in the environment is the program that it runs."""
import csv
import importlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SWEEP = [sys.executable, os.path.join(ROOT, "scripts/sweep")]
BATCH = os.environ["CURTAIN_BATCH"]
SCENE = """
cloth: {rows: 12, columns: 10, folds: 3}
wind:
  - {id: fan, position: [0.5, -1.0, 1.0], direction: [0, 1, 0], pressure: 3.0}
"""
NO_PICTURE = "sweep: summary.png is left out: python3-matplotlib is not installed\n"
TIMED = re.compile(r"wall_s|ms_per_frame|stages|host")


def module(name):
    """A module, or none where it is not installed."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


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
