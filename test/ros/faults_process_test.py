#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The node outlives its master, gives way to its namesake, ends cleanly when it is told to, and goes on when it is starved."""
import os
import signal
import socket
import sys
import time
import unittest

import rosgraph
import rospy
import rostest
from curtain_testing import (PATIENCE, Curtain, NodeProcess, Process, Watcher, assert_stream_is_sound, wait_until)

NAME = "/stage/curtain"
SCENE = {"cloth": {"rows": 10, "columns": 8, "height": 0.9, "width": 0.7},
         "hang": {"from": [0.0, 0.0, 2.0], "to": [0.7, 0.0, 2.0]},
         "wind": [{"id": "fan", "position": [0.35, -1.0, 1.5], "direction": [0.0, 1.0, 0.0], "pressure": 3.0,
                   "unsteadiness": 1.0}]}


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class OwnMaster:
    """A ROS master beside the test's, which can be killed and started anew at the same address."""

    def __init__(self):
        self.port = free_port()
        self.uri = "http://localhost:%d/" % self.port
        self.client = rosgraph.Master("/faults_process_test", master_uri=self.uri)
        self.start()

    def start(self):
        self.process = Process(["rosmaster", "--core", "-p", str(self.port)])
        wait_until(self.is_online, "the master is there")

    def is_online(self):
        try:
            self.client.getPid()
            return True
        except OSError:
            return False

    def knows(self, name):
        try:
            return self.client.lookupNode(name)
        except (rosgraph.MasterError, OSError):
            return None

    def registrations(self, name):
        """What the master knows of a node: topics it publishes, subscribes to, and services."""
        return [sorted(thing for thing, nodes in kind if name in nodes) for kind in self.client.getSystemState()]


class FaultsProcessTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("faults_process_test")
        cls.long = rospy.get_param("/long", False)

    def setUp(self):
        self.processes = []

    def tearDown(self):
        for process in reversed(self.processes):
            process.kill()

    def start(self, process):
        self.processes.append(process)
        return process

    def start_node(self, parameters=True, **kwargs):
        return self.start(NodeProcess(NAME, {"handles": False, "scene": SCENE} if parameters else None, **kwargs))

    def test_1_master_is_restarted(self):
        """Killed: the node and who listens to it go on. Started anew, empty: within seconds it knows the node again, with all
        its topics, services and parameters, and new listeners find it. Once stopped: the node goes on too."""
        master = OwnMaster()
        self.start(master.process)
        node = self.start_node(master=master.uri)
        old_listener = self.start(Watcher(NAME, master=master.uri))
        wait_until(lambda: old_listener.count() > 0, "it hears the curtain")
        before = wait_until(lambda: master.knows(NAME) and master.registrations(NAME), "the master knows the node")
        parameters = master.client.getParam(NAME)
        services = [master.client.lookupService(service) for service in before[2]]

        master.process.kill()
        wait_until(lambda: "does not answer" in node.output(), "the node misses the master")
        heard = old_listener.count()
        wait_until(lambda: old_listener.count() > heard + 60, "who listened hears it on")

        master.start()
        self.start(master.process)
        wait_until(lambda: master.knows(NAME) and master.registrations(NAME) == before, "it is told everything")
        wait_until(lambda: "had forgotten this node" in node.output(), "and says so")
        self.assertEqual(master.client.getParam(NAME), parameters)
        self.assertEqual([master.client.lookupService(service) for service in before[2]], services)
        new_listener = self.start(Watcher(NAME, master=master.uri))
        wait_until(lambda: new_listener.count() > 0, "a new one hears the curtain")
        heard = old_listener.count()
        wait_until(lambda: old_listener.count() > heard + 60, "the old one still does")
        self.assertEqual(node.output().count("had forgotten this node"), 1, "told once")

        master.process.send_signal(signal.SIGSTOP)
        wait_until(lambda: node.output().count("does not answer") == 2, "a master that hangs is one that does not answer")
        heard = old_listener.count()
        wait_until(lambda: old_listener.count() > heard + 60, "the stream goes on")
        master.process.send_signal(signal.SIGCONT)
        wait_until(lambda: node.output().count("answers again") == 2, "it answers again")
        node.interrupt()
        self.assertEqual(node.wait(), 0, node.output())
        wait_until(lambda: not any(master.registrations(NAME)), "a node that ended is not told of again")

        node = self.start_node(master=master.uri)
        wait_until(lambda: "curtain of" in node.output(), "and runs")
        master.process.send_signal(signal.SIGSTOP)
        node.interrupt()
        self.assertEqual(node.wait(), 0, "it ends although its master hangs")

    def test_2_namesake(self):
        """A second node of the same name takes over: the first ends cleanly, and does not come back to the master."""
        first = self.start_node()
        curtain = Curtain(NAME)
        curtain.next()
        second = self.start_node(parameters=False)
        self.assertEqual(first.wait(), 0, first.output())
        curtain.clear()
        curtain.next()
        self.assertTrue(second.running())
        time.sleep(1.5)  # more than a look of the first one's watch, were it alive
        curtain.clear()
        curtain.next()
        self.assertTrue(second.running())
        curtain.close()

    def test_3_sigterm_ends_it_as_sigint_does(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            node = self.start_node()
            curtain = Curtain(NAME)
            curtain.next()
            begin = time.monotonic()
            node.send_signal(number)
            self.assertEqual(node.wait(), 0, node.output())
            self.assertLess(time.monotonic() - begin, 1.0)
            wait_until(lambda: not rosgraph.Master("/faults_process_test").getSystemState()[0] or all(
                NAME not in nodes for _, nodes in rosgraph.Master("/faults_process_test").getSystemState()[0]),
                "the master has forgotten it")
            curtain.close()

    def test_4_starved_of_computing_time(self):
        """At the lowest priority beside busy loops on every core: frames are dropped or not, but none is lost without being
        counted, and stamps rise evenly; afterwards it keeps up again."""
        node = self.start_node(prefix=["nice", "-n", "19"])
        curtain = Curtain(NAME)
        curtain.next()
        curtain.clear()
        loops = [self.start(Process([sys.executable, "-c", "while True: pass"])) for _ in range(3 * os.cpu_count())]
        time.sleep(20.0 if self.long else 5.0)
        states = curtain.messages()
        for loop in loops:
            loop.kill()
        self.assertGreater(len(states), 1, "it still makes frames")
        assert_stream_is_sound(states)
        first, last = states[0], states[-1]
        frames = last.statistics.frame - first.statistics.frame
        dropped = last.statistics.dropped_frames - first.statistics.dropped_frames
        print("starved: %d frames made, %d dropped" % (frames, dropped))
        # Two stamps are taken by two readings of two clocks, each good to a tenth of a millisecond unless the thread was held
        # up in all its tries; a frame is 16.7 ms.
        self.assertAlmostEqual((last.header.stamp - first.header.stamp).to_sec(), (frames + dropped) / 60.0, delta=8e-3)
        curtain.wait_for(lambda s: s.statistics.real_time_factor > 0.9, "it keeps up again", 2.0 * PATIENCE)
        node.interrupt()
        self.assertEqual(node.wait(), 0)
        curtain.close()

    def test_5_watches_nothing(self):
        """Without ~watch_roscpp it makes its frames whatever becomes of the master, and tells a new one nothing."""
        master = OwnMaster()
        self.start(master.process)
        node = self.start(NodeProcess(NAME, {"handles": False, "watch_roscpp": False, "scene": SCENE}, master=master.uri))
        listener = self.start(Watcher(NAME, master=master.uri))
        wait_until(lambda: listener.count() > 0, "it hears the curtain")
        master.process.kill()
        wait_until(lambda: not master.is_online(), "the master is gone")
        master.start()
        self.start(master.process)
        heard = listener.count()
        wait_until(lambda: listener.count() > heard + 180, "who listened hears it on")  # three checks of a watch
        self.assertFalse(any(master.registrations(NAME)))
        self.assertNotIn("WARN", node.output())
        node.interrupt()
        self.assertEqual(node.wait(), 0, node.output())


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "faults_process", FaultsProcessTest, sys.argv)
