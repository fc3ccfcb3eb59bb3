# SPDX-License-Identifier: BSD-3-Clause
"""scripts/sweep, killed at any moment or with a full disk, goes on and neither loses nor doubles a run."""
import glob
import os
import random
import resource
import signal
import subprocess
import time

from sweep_testing import BATCH, SweepTest, module


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
        """Lines of the job log, its head counted before it is there, too."""
        try:
            return max(1, len(self.read("params.sweep", "joblog").splitlines()))
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
        self.params("design: latin_hypercube\ncount: 20\nduration: 20.0\nparameters:\n  wind[0].pressure: {min: 1.0, max: 9.0}\n  solver.seed: [1, 2]\n")
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
