#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""many_curtains.launch: eight curtains with scenes by turns, each in its namespace and its frame, in one process a machine; the
second machine is reached by ssh.

It is this one: an sshd of the test's own, with keys of its own, for a user of another name. roslaunch starts nodes by ssh where
the machine's user is not its own, and takes its own from the environment. Where there is no sshd or paramiko all are here.
"""
import getpass
import importlib.util
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest

import rosnode
import rospy
import rostest
import yaml
from curtain_sim.msg import WindSource
from curtain_testing import Curtain, Process, billow, publisher, wait_until, wind_message

SCENES = {"low": {"cloth": {"rows": 10, "columns": 8, "height": 0.9, "width": 0.7}},
          "high": {"cloth": {"rows": 12, "columns": 8, "height": 1.1, "width": 0.7}}}
SSHD = "/usr/sbin/sshd"
ELSEWHERE = 3  # of the eight


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class SecondMachine:
    """This one, by ssh: a daemon that lets in who has the key that lies in a home of its own."""

    def __init__(self, folder):
        self.port = free_port()
        keys = os.path.join(folder, ".ssh")
        os.makedirs(keys, mode=0o700)
        for name in ("host_key", "id_ed25519"):
            subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", os.path.join(keys, name)], check=True)
        with open(os.path.join(keys, "host_key.pub")) as file:
            host_key = " ".join(file.read().split()[:2])
        with open(os.path.join(keys, "known_hosts"), "w") as file:  # roslaunch looks for the name, paramiko with the port
            file.write("127.0.0.1 %s\n[127.0.0.1]:%d %s\n" % (host_key, self.port, host_key))
        options = {"Port": self.port, "ListenAddress": "127.0.0.1", "HostKey": os.path.join(keys, "host_key"), "PidFile": "none",
                   "AuthorizedKeysFile": os.path.join(keys, "id_ed25519.pub"), "UsePAM": "no", "StrictModes": "no",
                   "PasswordAuthentication": "no"}
        configuration = os.path.join(keys, "sshd_config")
        with open(configuration, "w") as file:
            file.writelines("%s %s\n" % option for option in options.items())
        if os.geteuid() == 0:
            os.makedirs("/run/sshd", exist_ok=True)  # sshd wants it
        self.daemon = Process([SSHD, "-D", "-e", "-f", configuration])
        wait_until(self.answers, "sshd listens\n" + self.daemon.output())
        self.loader = os.path.join(folder, "env.sh")
        devel = os.environ["CMAKE_PREFIX_PATH"].split(os.pathsep)[0]
        with open(self.loader, "w") as file:
            file.write("#!/bin/sh\nexport ROS_HOSTNAME=localhost ROS_HOME='%s' PATH=/usr/bin:$PATH\nexec '%s/env.sh' \"$@\"\n"
                       % (folder, devel))
        os.chmod(self.loader, 0o755)

    def answers(self):
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    @staticmethod
    def missing():
        """What there is not that it takes; empty: nothing."""
        devel = os.environ["CMAKE_PREFIX_PATH"].split(os.pathsep)[0]
        there = {SSHD: os.access(SSHD, os.X_OK), "ssh-keygen": shutil.which("ssh-keygen"),
                 "python3-paramiko": importlib.util.find_spec("paramiko"), "env.sh": os.path.exists(os.path.join(devel, "env.sh"))}
        return [name for name, found in there.items() if not found]


class ManyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("many_test")

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="curtain_many_")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def launch(self):
        """The eight; the names of their processes."""
        for name, scene in SCENES.items():
            scene["hang"] = {"from": [0.0, 0.0, 2.0], "to": [0.7, 0.0, 2.0]}
            scene["air"] = {"inside": 1.0, "border": 1.0, "corner": 1.0}
            with open(os.path.join(self.folder, name + ".yaml"), "w") as file:
                yaml.safe_dump(scene, file)
        command = ["roslaunch", "curtain_sim", "many_curtains.launch", "scenes:=low high", "folder:=" + self.folder, "rviz:=false"]
        managers = ["/curtains_here"]
        environment = dict(os.environ, HOME=self.folder)
        missing = SecondMachine.missing()
        if missing:
            print("skipped the second machine: there is no " + ", ".join(missing))
        else:
            machine = SecondMachine(self.folder)
            self.addCleanup(machine.daemon.kill)
            command += ["elsewhere:=127.0.0.1", "elsewhere_port:=%d" % machine.port, "elsewhere_user:=" + getpass.getuser(),
                        "elsewhere_env:=" + machine.loader, "elsewhere_count:=%d" % ELSEWHERE]
            environment["LOGNAME"] = "somebody_else"
            managers.append("/curtains_elsewhere")
        launch = Process(command, env=environment)
        self.addCleanup(launch.kill)
        return launch, managers

    def test_eight_curtains_in_one_process_a_machine(self):
        launch, managers = self.launch()
        curtains = [Curtain("/curtain_%d/curtain_node" % number) for number in range(1, 9)]
        try:
            wait_until(lambda: all(curtain.last() for curtain in curtains), "all eight send\n" + launch.output(), 60.0)
        except AssertionError:
            print(launch.output())
            raise
        self.assertEqual([curtain.last().rows for curtain in curtains], [10, 12] * 4, "scenes by turns")
        self.assertEqual([curtain.last().header.frame_id for curtain in curtains], ["curtain_%d" % number for number in range(1, 9)])
        processes = [self.process_of(manager) for manager in managers]
        self.assertEqual(len(set(processes)), len(managers))
        self.assertEqual([self.came_by_ssh(process) for process in processes], [False, True][:len(managers)])
        senders = {self.process_of("/curtain_%d/curtain_node" % number) for number in range(1, 9)}
        self.assertEqual(senders & set(processes), set(), "the loaders are processes of their own")
        self.assertEqual([self.sender(number) for number in range(1, 9)],
                         [managers[0 if number <= 8 - ELSEWHERE else -1] for number in range(1, 9)])
        self.wind_reaches_one(curtains)
        launch.interrupt()
        launch.wait(40.0)
        wait_until(lambda: not any(os.path.exists("/proc/%d" % process) for process in processes), "all ends, elsewhere, too")

    def wind_reaches_one(self, curtains):
        """A wind in the namespace of the last, in its own frame, moves nobody else."""
        wind = publisher("/curtain_8/wind_source", WindSource)
        for curtain in curtains:
            curtain.clear()
        message = wind_message()
        message.header.frame_id = "curtain_8"
        wind.publish(message)
        curtains[7].wait_for(lambda state: billow(state) > 0.1, "the eighth blows")
        for curtain in curtains[:7]:
            curtain.next()
            self.assertLess(max(billow(state) for state in curtain.messages()), 0.01)

    @staticmethod
    def process_of(node):
        import rosgraph
        import xmlrpc.client
        uri = rosgraph.Master("/many_test").lookupNode(node)
        return xmlrpc.client.ServerProxy(uri).getPid("/many_test")[2]

    @staticmethod
    def came_by_ssh(process):
        with open("/proc/%d/environ" % process) as environment:
            return "SSH_CONNECTION=" in environment.read()

    @staticmethod
    def sender(number):
        """The node that publishes a curtain's state."""
        published = dict((topic, nodes) for topic, nodes in rospy.get_master().getSystemState()[2][0])
        nodes = published["/curtain_%d/curtain_node/state" % number]
        assert len(nodes) == 1, nodes
        return nodes[0]


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "many", ManyTest, sys.argv)
