# SPDX-License-Identifier: BSD-3-Clause
"""Tables of what is measured outside of bench/run, since it needs a ROS master, a display or Python's module."""
import csv
import datetime
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def git(*words):
    """What it says."""
    return subprocess.run(("git",) + words, check=True, stdout=subprocess.PIPE, universal_newlines=True, cwd=ROOT).stdout.strip()


def stamp():
    """Commit, date and processor."""
    if git("status", "--porcelain", "--", "src", "include", "CMakeLists.txt", "cmake"):
        sys.exit("changes of the sources are not committed, so no commit tells what is measured")
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        processor = next((line.split(":")[1].strip() for line in file if line.startswith("model name")), "not noted")
    return [git("rev-parse", "--short=8", "HEAD"), datetime.datetime.now(datetime.timezone.utc).date().isoformat(), processor]


STAMP = stamp()  # before anything is measured


def keep(name, columns, rows):
    """Writes docs/bench/NAME.csv, each row with its stamp. What is measured is to be a build of this checkout."""
    with open(os.path.join(ROOT, "docs", "bench", name + ".csv"), "w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([columns + ["commit", "date", "processor"]] + [row + STAMP for row in rows])
