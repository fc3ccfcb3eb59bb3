#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""With ~snapshot_file a node that ended, however it did, goes on where it was; what can't be read or written is told, and
harms nothing."""
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rospy
import rostest
from curtain_sim.msg import WindSource
from curtain_testing import (OK, WARN, Curtain, Diagnostics, MovingFrame, NodeProcess, assert_stream_is_sound, billow,
                             node_position, publisher, wait_until, wind_message)

NAME = "/stage/curtain"


def parameters(file, period, rows=10, obstacles=()):
    return {"handles": False, "snapshot_file": file, "snapshot_period": period, "diagnostic_period": 0.2,
            "scene": {"cloth": {"rows": rows, "columns": 8, "height": 0.9, "width": 0.7},
                      "hang": {"from": [0.0, 0.0, 2.0], "to": [0.7, 0.0, 2.0]},
                      "air": {"inside": 1.0, "border": 1.0, "corner": 1.0}, "obstacles": list(obstacles)}}


class FaultsSnapshotTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("faults_snapshot_test")
        cls.diagnostics = Diagnostics(NAME)

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="curtain_snapshot_")
        self.file = os.path.join(self.folder, "curtain.snapshot")
        self.nodes = []
        self.curtain = Curtain(NAME)
        self.mounted = False

    def tearDown(self):
        for node in self.nodes:
            node.kill()
        self.curtain.close()
        if self.mounted:
            subprocess.run(["umount", self.folder], check=False)
        shutil.rmtree(self.folder, ignore_errors=True)

    def start(self, period=0.2, **kwargs):
        self.curtain.clear()
        self.diagnostics.clear()
        node = NodeProcess(NAME, parameters(self.file, period, **kwargs))
        self.nodes.append(node)
        return node

    def end(self, node, number, code):
        node.send_signal(number)
        self.assertEqual(node.wait(), code, node.output())
        states = self.curtain.messages()
        assert_stream_is_sound(states)
        return states[-1]

    def blow(self, **fields):
        wind = publisher("/stage/wind_source", WindSource)
        wind.publish(wind_message(**fields))
        self.curtain.wait_for(lambda s: billow(s) > 0.1, "the curtain blows")
        wind.unregister()

    def first(self):
        wait_until(self.curtain.count, "the node is there")
        return self.curtain.messages()[0]

    def test_1_killed_and_started_again(self):
        """SIGKILL: it goes on from the last snapshot in time, with the cloth and the wind as they were then."""
        node = self.start()
        self.first()
        self.blow()
        written = self.curtain.last().statistics.snapshots_written
        self.curtain.wait_for(lambda s: s.statistics.snapshots_written > written + 2, "snapshots are written")
        last = self.end(node, signal.SIGKILL, -signal.SIGKILL)
        self.start()
        first = self.first()
        # The last one is no older than its period of 0.2 s and the time it takes to write it: a second on a busy disk.
        self.assertGreater(first.statistics.restored_time, last.statistics.simulated_time - 1.5)
        self.assertLessEqual(first.statistics.restored_time, last.statistics.simulated_time + 1.0 / 60.0)
        self.assertAlmostEqual(first.statistics.simulated_time, first.statistics.frame / 60.0, delta=1e-6)
        self.assertGreaterEqual(first.statistics.simulated_time, first.statistics.restored_time)
        self.assertGreater(billow(first), 0.05)
        self.assertGreater(first.header.stamp, last.header.stamp)
        self.curtain.wait_for(lambda s: s.statistics.simulated_time > first.statistics.simulated_time + 1.0, "it goes on")
        self.assertGreater(billow(self.curtain.last()), 0.05, "in the wind that was there")
        assert_stream_is_sound(self.curtain.messages())

    def test_2_told_to_end(self):
        """SIGTERM and SIGINT write the very last state: the next run's first frame is the one after it."""
        for number in (signal.SIGTERM, signal.SIGINT):
            node = self.start(period=1000.0)
            self.first()
            self.blow()
            last = self.end(node, number, 0)
            node = self.start(period=1000.0)
            first = self.first()
            # ~state of the last frame or two may not have come before the node ended.
            self.assertIn(round(60.0 * first.statistics.restored_time) - last.statistics.frame, range(5))
            self.assertGreaterEqual(first.statistics.frame, last.statistics.frame)
            moved = max(abs(a - b) for a, b in zip(node_position(first, 9, 4), node_position(last, 9, 4)))
            self.assertLess(moved, 0.2, "it has not begun anew")
            self.end(node, signal.SIGKILL, -signal.SIGKILL)
            os.remove(self.file)

    def test_3_lifetimes_go_on(self):
        """A wind of three simulated seconds has what is left of them, however long nothing ran."""
        node = self.start(period=1000.0)
        self.first()
        self.blow(lifetime=3.0)
        last = self.end(node, signal.SIGTERM, 0)
        time.sleep(3.5)  # the wind would be over, were it for the clock on the wall
        self.start(period=1000.0)
        first = self.first()
        self.assertLess(last.statistics.simulated_time, 3.5, "it was not over before")
        self.assertGreater(billow(first), 0.05)
        self.curtain.wait_for(lambda s: s.statistics.simulated_time > first.statistics.simulated_time + 0.5, "half a second on")
        self.assertGreater(billow(self.curtain.last()), 0.05, "it still blows")
        self.curtain.wait_for(lambda s: billow(s) < 0.02, "it is over")

    def test_4_refused(self):
        """Cut short, of another scene: named in one warning, begun at the scene's start, and put aside in time."""
        node = self.start()
        self.curtain.wait_for(lambda s: s.statistics.snapshots_written > 1, "a snapshot is written")
        self.end(node, signal.SIGTERM, 0)
        with open(self.file, "rb") as file:
            whole = file.read()
        for name, bytes_, rows in (("cut short", whole[:len(whole) // 2], 10), ("of another scene", whole, 12)):
            with open(self.file, "wb") as file:
                file.write(bytes_)
            node = self.start(rows=rows)
            first = self.first()
            self.assertEqual(first.statistics.restored_time, 0.0, name)
            self.assertLess(first.statistics.simulated_time, 5.0)
            self.diagnostics.wait_for("snapshots", WARN, "not restored")
            self.curtain.wait_for(lambda s: s.statistics.snapshots_written > 1, "another is written")
            self.end(node, signal.SIGTERM, 0)
            warnings = [line for line in node.output().splitlines() if "WARN" in line and self.file in line]
            self.assertEqual(len(warnings), 1, node.output())
            self.start(rows=rows)
            self.assertGreater(self.first().statistics.restored_time, 0.0, name)
            self.end(self.nodes[-1], signal.SIGTERM, 0)
            self.assertEqual(sorted(os.listdir(self.folder)), ["curtain.snapshot", "curtain.snapshot.refused"], "nothing is left over")
            with open(self.file + ".refused", "rb") as file:
                self.assertEqual(file.read(), bytes_, name)

    def test_5_what_is_no_snapshot_is_left_alone(self):
        with open(self.file, "w") as file:
            file.write("cloth: {rows: 10, columns: 8}\n")
        node = self.start()
        self.first()
        self.diagnostics.wait_for("snapshots", WARN, "there is another file")
        self.end(node, signal.SIGTERM, 0)
        with open(self.file) as file:
            self.assertEqual(file.read(), "cloth: {rows: 10, columns: 8}\n")

    def test_6_disk_full(self):
        """Frames go on, each failure is counted and told, the last good snapshot stays, with room again they are written."""
        node = self.start()
        self.curtain.wait_for(lambda s: s.statistics.snapshots_written > 1, "a snapshot is written")
        # Files of this process end at 1000 bytes: less than a snapshot's header and 80 nodes of six doubles.
        self.fails_and_recovers(node, lambda: resource.prlimit(node.pid(), resource.RLIMIT_FSIZE, (1000, -1)),
                                lambda: resource.prlimit(node.pid(), resource.RLIMIT_FSIZE, (-1, -1)))
        self.end(node, signal.SIGTERM, 0)

    def test_7_disk_full_in_earnest(self):
        """The same on a file system that is full. Passes with a message where this test may not mount one."""
        mount = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "curtain_test", self.folder], check=False,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if mount.returncode != 0:
            print("skipped: may not mount: " + mount.stdout.decode())
            return
        self.mounted = True
        node = self.start()
        self.curtain.wait_for(lambda s: s.statistics.snapshots_written > 1, "a snapshot is written")
        ballast = os.path.join(self.folder, "ballast")

        def fill():
            with open(ballast, "wb", buffering=0) as file:
                try:
                    while True:
                        file.write(b"x" * 4096)
                except OSError:
                    pass
        self.fails_and_recovers(node, fill, lambda: os.remove(ballast))
        self.end(node, signal.SIGTERM, 0)

    def test_8_obstacles_stay(self):
        """An obstacle that was there is there from the first frame on, before its frame is heard of; where nobody sends it any
        more it is left out after its timeout, as ever."""
        ball = {"name": "ball", "frame": "ball", "shape": "sphere", "radius": 0.2}
        frame = MovingFrame("world", "ball", (0.35, -0.1, 1.3))
        node = self.start(period=1000.0, obstacles=[ball])
        self.curtain.wait_for(lambda s: billow(s) > 0.08, "the ball holds the curtain out")  # its front is at 0.1 m
        self.end(node, signal.SIGTERM, 0)
        node = self.start(period=1000.0, obstacles=[ball])
        self.curtain.wait_for(lambda s: s.statistics.simulated_time > s.statistics.restored_time + 1.5, "it goes on")
        self.assertEqual({s.statistics.absent_obstacles for s in self.curtain.messages()}, {0})
        self.assertGreater(min(billow(s) for s in self.curtain.messages()), 0.05)
        frame.stop()
        self.end(node, signal.SIGTERM, 0)  # within the timeout
        self.start(period=1000.0, obstacles=[ball])
        self.assertEqual(self.first().statistics.absent_obstacles, 0)
        self.curtain.wait_for(lambda s: s.statistics.absent_obstacles == 1, "it is left out")
        self.assertEqual(self.curtain.last().statistics.obstacles_lost, 1)

    def fails_and_recovers(self, node, fill, make_room):
        fill()
        failed = self.curtain.last().statistics.snapshots_failed
        state = self.curtain.wait_for(lambda s: s.statistics.snapshots_failed > failed + 3, "writing fails")
        self.diagnostics.wait_for("snapshots", WARN, "was not written")
        self.assertIn("snapshot could not be written", node.output())
        with open(self.file, "rb") as file:
            kept = file.read()
        self.assertGreater(len(kept), 1000, "the last good one is still whole")
        first = state.statistics.frame
        self.curtain.wait_for(lambda s: s.statistics.frame > first + 60, "frames go on")
        written = self.curtain.last().statistics.snapshots_written
        make_room()
        self.curtain.wait_for(lambda s: s.statistics.snapshots_written > written + 1, "there is room again")
        self.diagnostics.wait_for("snapshots", OK)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "faults_snapshot", FaultsSnapshotTest, sys.argv)
