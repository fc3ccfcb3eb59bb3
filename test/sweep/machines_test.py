# SPDX-License-Identifier: BSD-3-Clause
"""scripts/sweep over ssh: to this machine, by an sshd of the test's own on a high port, under the names localhost and 127.0.0.1."""
import getpass
import os
import shutil
import socket
import subprocess
import time
import unittest

from sweep_testing import BATCH, ROOT, SCENE, SweepTest

SSHD = "/usr/sbin/sshd"


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
                   "StrictHostKeyChecking no\nLogLevel ERROR\nControlMaster auto\nControlPath %s/%%h\nControlPersist 60\n" %
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
