# SPDX-License-Identifier: BSD-3-Clause
"""The folder of a sweep:

    sweep.json     what it is of: a start with anything else is refused
    lock           held while anything of it runs, also by what a killed sweep has left running
    runs.txt       names of the runs, what parallel reads
    joblog         of parallel: which runs have been made, by whom, how long it took
    runs/          N.yaml, a scene; N.result, its statistics or why there are none; N.csv, its trajectory; meshes
    results.csv    the table
    summary.png    the picture
"""
import fcntl
import json
import os
import re
import shutil
import sys
import time

from curtain_sweep.problem import Problem

OURS = {"sweep.json", "lock", "runs.txt", "joblog", "hosts", "runs", "results.csv", "summary.png"}
LOG_LINE = re.compile(r"(\d+)\t([^\t]*)\t[^\t]*\t([^\t]*)\t\d+\t\d+\t(\d+)\t(\d+)\t[^\n]*\n")


def replace(path, content):
    """Writes a file, of text or bytes, completely or not at all."""
    part = path + ".part"
    try:
        with open(part, "wb") as file:
            file.write(content.encode() if isinstance(content, str) else content)
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)
    except OSError as error:
        if os.path.exists(part):
            os.remove(part)
        raise OSError(error.errno, error.strerror, path) from None


def difference(ours, theirs, name=""):
    """The first key whose value differs, with both; None: they are the same."""
    if isinstance(ours, dict) and isinstance(theirs, dict):
        for key in list(ours) + [key for key in theirs if key not in ours]:
            found = difference(ours.get(key), theirs.get(key), "%s.%s" % (name, key) if name else key)
            if found:
                return found
        return None
    ours, theirs = ("not given" if value is None else json.dumps(value, sort_keys=True) for value in (ours, theirs))
    return None if ours == theirs else "%s is %s, was %s" % (name, ours, theirs)  # texts: 1 is not true


def code_of(entry):
    """Of a line of the log: exit code, or 128 and the signal."""
    return int(entry[4]) or (128 + int(entry[5]) if int(entry[5]) else 0)


class Folder:
    """Opens, or makes, the folder of a sweep and holds its lock."""

    def __init__(self, path):
        self.path = path
        self.lock = None

    def of(self, *names):
        return os.path.join(self.path, *names)

    def open(self, identity, force):
        """identity: what the sweep is of; force: throws away a sweep of anything else."""
        identity = json.loads(json.dumps(identity))
        if os.path.exists(self.path) and not os.path.isdir(self.path):
            raise Problem("%s: is not a folder" % self.path)
        if os.path.isdir(self.path) and not os.path.exists(self.of("sweep.json")) and set(os.listdir(self.path)) - {"lock", "sweep.json.part"}:
            raise Problem("%s: is the folder of something else; give another one with --out" % self.path)
        os.makedirs(self.path, exist_ok=True)
        self.take_lock()
        if os.path.exists(self.of("sweep.json")):
            with open(self.of("sweep.json"), encoding="utf-8") as file:
                try:
                    found = difference(identity, json.load(file))
                except ValueError:
                    found = "sweep.json is damaged"
            if found and not force:
                raise Problem("%s: holds another sweep: %s; give another folder with --out, or --force to lose what it has" %
                              (self.path, found))
            if force:
                self.clear()
        replace(self.of("sweep.json"), json.dumps(identity, indent=1) + "\n")
        os.makedirs(self.of("runs"), exist_ok=True)

    def take_lock(self):
        """Waits for what a killed sweep has left running: its runs end by themselves, and are made again if they were not logged."""
        self.lock = os.open(self.of("lock"), os.O_RDWR | os.O_CREAT, 0o666)
        told = False
        while True:
            try:
                fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return
            except BlockingIOError:
                if not told:
                    print("sweep: %s is in use by another sweep, or by runs that a killed one has left; waiting for them" % self.path,
                          file=sys.stderr)
                told = True
                time.sleep(0.1)

    def clear(self):
        """Removes what a sweep writes, and nothing else. Killed on the way it leaves the folder of a sweep of which nothing is made:
        the log goes first, and what the sweep is of stays, to be replaced."""
        for name in ["joblog"] + sorted(OURS - {"lock", "joblog", "sweep.json"}):
            if os.path.isdir(self.of(name)):
                shutil.rmtree(self.of(name))
            elif os.path.exists(self.of(name)):
                os.remove(self.of(name))

    def mend_log(self, is_made):
        """Removes lines that a kill or a full disk has cut short, and those of good runs of which is_made(number) is not true: those
        runs are made again."""
        def good_line(n, line):
            entry = LOG_LINE.fullmatch(line)
            if not entry:
                return n == 0 and line.startswith("Seq\t") and line.endswith("\n")
            return code_of(entry) != 0 or is_made(int(entry[1]))

        if not os.path.exists(self.of("joblog")):
            return
        with open(self.of("joblog"), encoding="utf-8", errors="replace") as file:
            lines = file.readlines()
        good = [line for n, line in enumerate(lines) if good_line(n, line)]
        if not good:
            os.remove(self.of("joblog"))
        elif good != lines:
            replace(self.of("joblog"), "".join(good))

    def log(self):
        """By number of the run, from 1: the machine, the time it took [s], and whether it was made."""
        made = {}
        if os.path.exists(self.of("joblog")):
            with open(self.of("joblog"), encoding="utf-8", errors="replace") as file:
                for line in file:
                    entry = LOG_LINE.fullmatch(line)
                    if entry:
                        made[int(entry[1])] = (entry[2], entry[3].strip(), code_of(entry))
        return made
