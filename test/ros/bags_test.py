#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A curtain that was recorded is replayed without its node, every frame of it, and seen in rviz, which has nothing else; and it is
exported.

rviz runs on an X server of its own (Xvfb); without that, or our display, the bag is replayed all the same.
"""
import glob
import io
import os
import struct
import sys
import xmlrpc.client

import rosbag
import roslib.packages
import rosnode
import rospy
import rostest
from curtain_testing import Curtain, NodeProcess, Process, program, wait_until
from screen_testing import ScreenTest

NODE = "/curtain/curtain_node"
SCENE = {"cloth": {"rows": 20, "columns": 16, "height": 1.8, "width": 2.0},
         "hang": {"from": [-0.6, 0.0, 2.0], "to": [1.2, 0.0, 2.0]},
         "obstacles": [{"name": "ball", "shape": "sphere", "radius": 0.2, "position": [0.3, 0.5, 1.0]}],
         "wind": [{"id": "fan", "position": [0.3, -1.5, 1.0], "direction": [0.0, 1.0, 0.0], "radius": 0.5, "pressure": 3.0}]}
MUCH = 0.05  # of the picture's pixels


def is_red(red, green, blue):
    """As the cloth of config/curtain.rviz is."""
    return red > 50 and red > 1.6 * green and red > 1.6 * blue


def stamps(states):
    return [state.header.stamp for state in states]


def content(state):
    """What was sent: rospy counts messages itself."""
    state.header.seq = 0
    buffer = io.BytesIO()
    state.serialize(buffer)
    return buffer.getvalue()


class BagsTest(ScreenTest):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("bags_test")

    def launch(self, name, *arguments, environment=None):
        """As from a shell that is in the test's folder."""
        where = dict(environment or os.environ, PWD=self.folder)
        return Process(["roslaunch", "curtain_sim", name] + list(arguments), cwd=self.folder, env=where)

    def record(self, bag):
        """A second of a node's life at least; what was sent in that second."""
        node = NodeProcess(NODE, {"scene": SCENE, "handles": False})
        curtain = Curtain(NODE)
        curtain.next()
        recorder = self.launch("record.launch", "bag:=" + bag)
        try:
            wait_until(lambda: self.recorded_topics() >= {NODE + "/state", NODE + "/markers"}, "somebody records\n" + recorder.output())
            begin = curtain.count()
            wait_until(lambda: curtain.count() > begin + 70, "frames come")
        finally:
            recorder.interrupt()
            recorder.wait()
            node.interrupt()
            node.wait()
        curtain.close()
        return curtain.messages()[begin + 1:begin + 61]

    @staticmethod
    def recorded_topics():
        """What the node sends to a recorder, by its connections: they come after what the master knows."""
        _, _, uri = rospy.get_master().lookupNode(NODE)
        _, _, connections = xmlrpc.client.ServerProxy(uri).getBusInfo("/bags_test")
        return {topic for _, other, direction, _, topic, *_ in connections if direction == "o" and "/record" in other}

    def test_a_bag_is_all_that_a_replay_needs(self):
        sent = self.record("run")
        bags = glob.glob(os.path.join(self.folder, "run_*.bag"))
        self.assertEqual(len(bags), 1, os.listdir(self.folder))
        with rosbag.Bag(bags[0]) as bag:
            recorded = [message for _, message, _ in bag.read_messages(NODE + "/state")]
            self.assertGreater(bag.get_message_count(NODE + "/markers"), 3)
            self.assertEqual(bag.get_compression_info().compression, "lz4")
        first = stamps(recorded).index(sent[0].header.stamp)
        self.assertEqual(stamps(recorded)[first:first + len(sent)], stamps(sent), "every frame is in the bag")
        self.replay(os.path.basename(bags[0]), recorded)
        self.export(os.path.basename(bags[0]), recorded)

    def replay(self, bag, recorded):
        curtain = Curtain(NODE)
        prefixes = os.environ["CMAKE_PREFIX_PATH"].split(os.pathsep)
        seen = any(os.path.exists(os.path.join(prefix, "lib", "libcurtain_rviz.so")) for prefix in prefixes)
        seen = seen and self.installed("rviz", "Xvfb", "import")
        environment = self.start_screen() if seen else dict(os.environ)
        player = self.launch("replay.launch", "bag:=" + bag, "rviz:=%s" % str(seen).lower(), environment=environment)
        try:
            wait_until(lambda: curtain.count() == len(recorded), "the bag is played\n" + player.output(), 40.0)
            if seen:
                self.assertNotIn(NODE, rosnode.get_node_names())
                wait_until(lambda: self.share(environment, is_red) > MUCH, "the cloth is in the picture\n" + player.output(), 40.0)
                player.interrupt()
            player.wait()  # else it ends with the bag
        finally:
            player.kill()
        self.assertEqual(stamps(curtain.messages()), stamps(recorded))
        self.assertTrue(all(content(a) == content(b) for a, b in zip(curtain.messages(), recorded)), "bit for bit")

    def export(self, bag, recorded):
        if not roslib.packages.find_node("curtain_sim", "curtain_export"):
            print("skipped: curtain_export was not built")
            return
        exporting = Process([program("curtain_export"), bag, "--out", "run.glb", "--rate", "60"], cwd=self.folder)
        self.assertEqual(exporting.wait(), 0, exporting.output())
        with open(os.path.join(self.folder, "run.glb"), "rb") as file:
            magic, version, length = struct.unpack("<4sII", file.read(12))
        self.assertEqual((magic, version, length), (b"glTF", 2, os.path.getsize(os.path.join(self.folder, "run.glb"))))
        # A frame may come early by the computer's clock, and two share a tick.
        frames = int(exporting.output().split()[1])
        self.assertTrue(0.9 * len(recorded) <= frames <= len(recorded) + 1, exporting.output())

    def test_a_bag_that_is_not_there_is_told(self):
        player = self.launch("replay.launch", "bag:=none.bag", "rviz:=false")
        player.wait()
        self.assertIn("Error opening file: none.bag", player.output())


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "bags", BagsTest, sys.argv)
