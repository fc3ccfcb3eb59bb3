# SPDX-License-Identifier: BSD-3-Clause
"""Bad input of scripts/sweep is one message before anything is written."""
import os
import signal
import subprocess
import sys

from sweep_testing import ROOT, SCENE, SweepTest


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
