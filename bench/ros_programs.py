# SPDX-License-Identifier: BSD-3-Clause
"""A ROS master and this package's programs, for the tables that need them."""
import contextlib
import os
import subprocess
import time

import rosgraph
import roslib.packages


def program(name):
    """Path of a program of this package."""
    return roslib.packages.find_node("curtain_sim", name)[0]


@contextlib.contextmanager
def master(port):
    """A master of one's own, until the block ends."""
    os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % port
    core = subprocess.Popen(["roscore", "-p", str(port)], stdout=subprocess.DEVNULL)
    try:
        while not rosgraph.is_master_online():
            time.sleep(0.05)
        yield
    finally:
        core.terminate()
        core.wait()
