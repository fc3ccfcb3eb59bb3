#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Several cloths: ~state has all of them, ~layers says whose columns are whose, each has a state and a rail of its own."""
import math
import sys
import unittest

import actionlib
import numpy
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from curtain_sim.msg import CurtainState, DragForce, Labels, Layers, OpenCurtainAction, OpenCurtainGoal, Summary
from curtain_sim.srv import SetMaterial
from curtain_testing import Curtain, Listener, drag_message, publisher, service, wait_until
from sensor_msgs.msg import Image
from std_msgs.msg import Float64

NODE = "/curtain"
ROWS = 9
COLUMNS = {"cloth": slice(0, 13), "dark": slice(13, 22), "banner": slice(22, 27)}


def nodes(state):
    return numpy.array(state.positions).reshape(ROWS, state.columns, 3)


class LayersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("layers_test")
        cls.curtain = Curtain(NODE)
        cls.states = {name: Listener("%s/layers/%s/state" % (NODE, name), CurtainState) for name in COLUMNS}
        cls.summary = Listener(NODE + "/summary", Summary)
        cls.curtain.next()

    def listen(self, topic, kind):
        listener = Listener(NODE + topic, kind)
        self.addCleanup(listener.close)
        return listener

    def test_columns_are_named(self):
        layers = wait_until(self.listen("/layers", Layers).last, "it is latched")
        self.assertEqual(layers.names, list(COLUMNS))
        self.assertEqual(list(layers.first_columns), [0, 13, 22])
        self.assertEqual(list(layers.columns), [13, 9, 5])

    def test_each_state_is_its_part_of_all(self):
        def of_one_frame():
            """All of them."""
            parts = {name: {m.header.stamp: m for m in listener.messages()[-40:]} for name, listener in self.states.items()}
            whole = {m.header.stamp: m for m in self.curtain.messages()[-40:]}
            common = set(whole).intersection(*parts.values())
            return (whole[max(common)], {name: part[max(common)] for name, part in parts.items()}) if common else None
        whole, parts = wait_until(of_one_frame, "all are there")
        self.assertEqual(whole.columns, 27)
        self.assertEqual(sorted(zip(whole.slit_columns, whole.slit_rows)), [(12, 0), (17, 0), (21, 0)])
        folds = numpy.array(whole.fold_nodes).reshape(ROWS, 26, 2, 3)
        for name, columns in COLUMNS.items():
            part, count = parts[name], columns.stop - columns.start
            self.assertEqual((part.rows, part.columns, part.folds), (ROWS, count, 3))
            self.assertTrue((nodes(part) == nodes(whole)[:, columns]).all())
            own = numpy.array(part.fold_nodes).reshape(ROWS, count - 1, 2, 3)
            self.assertTrue((own == folds[:, columns.start:columns.stop - 1]).all())
            self.assertEqual((len(part.warp_rest), len(part.weft_rest)), (ROWS - 1, ROWS * (count - 1)))
            self.assertEqual((len(part.velocities), len(part.forces)), (3 * ROWS * count, 3 * ROWS * count))
        self.assertAlmostEqual(sum(parts["dark"].warp_rest), 1.2, delta=1e-5)
        self.assertEqual((list(parts["dark"].slit_columns), list(parts["dark"].slit_rows)), ([4], [0]))
        self.assertEqual(list(parts["banner"].slit_columns), [])

    def wait_for_opening(self, name, opening):
        def opened():
            message = self.summary.last()
            if message is None:
                return False
            value = message.opening if name == "cloth" else message.openings[message.layers.index(name)]
            return abs(value - opening) < 2e-3
        wait_until(opened, "%s is open by %g" % (name, opening))

    def test_each_rail_opens_by_itself(self):
        first, dark = publisher(NODE + "/open", Float64), publisher(NODE + "/layers/dark/open", Float64)
        first.publish(0.0)
        dark.publish(0.8)
        self.wait_for_opening("dark", 0.8)
        self.wait_for_opening("cloth", 0.0)
        self.assertTrue(math.isnan(self.summary.last().openings[1]), "the banner has no rail")
        first.publish(0.7)
        self.wait_for_opening("cloth", 0.7)
        client = actionlib.SimpleActionClient(NODE + "/layers/dark/open_curtain", OpenCurtainAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(20.0)))
        client.send_goal(OpenCurtainGoal(opening=0.0))
        self.assertTrue(client.wait_for_result(rospy.Duration(30.0)))
        self.assertEqual(client.get_state(), GoalStatus.SUCCEEDED)
        self.wait_for_opening("dark", 0.0)
        self.wait_for_opening("cloth", 0.7)
        first.publish(0.0)
        self.wait_for_opening("cloth", 0.0)

    def test_pulls_name_nodes_by_their_columns_of_all(self):
        drag = publisher("/drag_force", DragForce)
        message = drag_message(row=8, column=24, id="pull", lifetime=3.0)
        message.force.y = -0.5
        drag.publish(message)
        state = self.curtain.wait_for(lambda s: nodes(s)[8, 24, 1] < -0.2, "the banner is pulled")
        self.assertLess(abs(nodes(state)[8, 6, 1]), 0.15, "the first cloth is not")
        message.action = DragForce.DELETE
        drag.publish(message)

    def test_material_is_that_of_a_layer(self):
        set_material = service(NODE, "set_material", SetMaterial)
        self.assertTrue(set_material("velvet", "banner", [], []).success)
        answer = set_material("velvet", "nobody", [], [])
        self.assertFalse(answer.success)
        self.assertIn("layer", answer.message)

    def test_labels_tell_them_apart(self):
        names = wait_until(self.listen("/depth/label_names", Labels).last, "they are latched")
        self.assertEqual(names.names, ["background", "cloth", "dark", "banner"])
        image = wait_until(self.listen("/depth/labels", Image).last, "the camera sees")
        labels = numpy.frombuffer(image.data, "<u2").reshape(image.height, image.width)
        self.assertEqual(set(labels.flat) & {1, 3}, {1, 3}, "the dark one is behind the first")
        left, right = numpy.argwhere(labels == 1)[:, 1], numpy.argwhere(labels == 3)[:, 1]
        self.assertLess(left.max(), right.min())


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "layers", LayersTest, sys.argv)
