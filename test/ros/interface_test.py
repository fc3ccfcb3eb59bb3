#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The node's topics have their names and types and do what they say; bad messages are dropped and counted."""
import math
import sys
import time
import unittest

import rosgraph
import rospy
import rostest
import tf2_ros
from curtain_sim.msg import DragForce, WindSource
from curtain_testing import (Curtain, Listener, billow, distance, drag_message, node_position, points, publisher,
                             static_frame, wait_until, wind_message)
from geometry_msgs.msg import Point, Vector3
from visualization_msgs.msg import Marker, MarkerArray

NODE = "/stage/curtain"
ROWS, COLUMNS, FOLDS = 10, 8, 3
NAN = float("nan")
INF = float("inf")


class InterfaceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("interface_test")
        cls.curtain = Curtain(NODE)
        cls.curtain.next()
        cls.wind = publisher("/stage/wind_source", WindSource)
        cls.drag = publisher("/stage/drag_force", DragForce)

    def setUp(self):
        self.wind.publish(WindSource(action=WindSource.DELETEALL))
        self.drag.publish(DragForce(action=DragForce.DELETEALL))
        self.curtain.wait_for(lambda s: billow(s) < 0.02, "the curtain hangs still")

    def statistics(self):
        return self.curtain.next().statistics

    def test_topics_have_their_names_and_types(self):
        """Inputs in the node's namespace, outputs under its name; nothing else of ours."""
        master = rosgraph.Master("/interface_test")
        types = dict(master.getTopicTypes())
        self.assertEqual(types["/diagnostics"], "diagnostic_msgs/DiagnosticArray")
        self.assertEqual(types[NODE + "/state"], "curtain_sim/CurtainState")
        self.assertEqual(types[NODE + "/mesh"], "visualization_msgs/Marker")
        self.assertEqual(types[NODE + "/markers"], "visualization_msgs/MarkerArray")
        self.assertEqual(types[NODE + "/contacts"], "curtain_sim/Contacts")
        self.assertEqual(types[NODE + "/loads"], "curtain_sim/Loads")
        self.assertEqual(types[NODE + "/summary"], "curtain_sim/Summary")
        published, subscribed, _ = master.getSystemState()
        inputs = [topic for topic, nodes in subscribed if NODE in nodes]
        outputs = [topic for topic, nodes in published if NODE in nodes]
        self.assertEqual(sorted(t for t in inputs if "handles" not in t),
                         [NODE + "/grasp/cancel", NODE + "/grasp/goal", "/stage/drag_force", "/stage/wind_source"],
                         "no obstacle: no tf2")
        self.assertEqual(sorted(t for t in outputs if t != "/rosout" and "handles" not in t),
                         ["/diagnostics", NODE + "/contacts", NODE + "/grasp/feedback", NODE + "/grasp/result",
                          NODE + "/grasp/status", NODE + "/loads", NODE + "/markers", NODE + "/mesh",
                          NODE + "/parameter_descriptions", NODE + "/parameter_updates", NODE + "/points", NODE + "/state",
                          NODE + "/summary"])
        served = [service for service, nodes in master.getSystemState()[2] if NODE in nodes]
        self.assertEqual(sorted(s[len(NODE) + 1:] for s in served if "handles" not in s and "logger" not in s),
                         ["attach", "detach", "distance", "export_mesh", "load", "pause", "reset", "save", "set_material", "set_parameters", "step"])
        self.assertEqual(types["/stage/wind_source"], "curtain_sim/WindSource")
        self.assertEqual(types["/stage/drag_force"], "curtain_sim/DragForce")

    def test_state_is_whole(self):
        """Every array has its documented size, is finite, and the hung edge is where the scene hangs it."""
        state = self.curtain.next()
        self.assertEqual(state.header.frame_id, "world")
        self.assertEqual((state.rows, state.columns, state.folds, state.closed), (ROWS, COLUMNS, FOLDS, False))
        for array in (state.positions, state.velocities, state.forces):
            self.assertEqual(len(array), 3 * ROWS * COLUMNS)
            self.assertTrue(all(math.isfinite(x) for x in array))
        self.assertEqual(len(state.fold_nodes), 3 * ROWS * (COLUMNS - 1) * (FOLDS - 1))
        for column in range(COLUMNS):
            self.assertLess(distance(node_position(state, 0, column), (0.1 * column, 0.0, 2.0)), 1e-6)
        self.assertEqual((len(state.warp_rest), len(state.weft_rest)), (ROWS - 1, ROWS * (COLUMNS - 1)))
        self.assertTrue(all(rest > 0.0 for rest in state.warp_rest + state.weft_rest))
        self.assertTrue(state.statistics.finite)
        self.assertGreater(state.statistics.substeps_total, 0)
        self.assertEqual(state.statistics.absent_obstacles, 0)

    def test_frames_are_evenly_stamped(self):
        """A frame is 1/60 s after the one before it, in its stamp and in simulated time, unless frames were dropped."""
        self.curtain.clear()
        states = wait_until(lambda: self.curtain.count() > 120 and self.curtain.messages(), "two seconds passed")
        for a, b in zip(states, states[1:]):
            frames = b.statistics.frame - a.statistics.frame
            dropped = b.statistics.dropped_frames - a.statistics.dropped_frames
            self.assertAlmostEqual(b.statistics.simulated_time - a.statistics.simulated_time, frames / 60.0, delta=1e-9)
            # The stamp is taken from two clocks, one after the other: the thread may be held up between them.
            self.assertAlmostEqual((b.header.stamp - a.header.stamp).to_sec(), (frames + dropped) / 60.0, delta=5e-3)
        self.assertLess(abs((rospy.Time.now() - self.curtain.next().header.stamp).to_sec()), 0.5)

    def test_wind_message_moves_the_curtain(self):
        """Wind along +y blows the curtain to +y; without it the curtain comes back."""
        self.wind.publish(wind_message())
        self.curtain.wait_for(lambda s: billow(s) > 0.1, "the curtain blows")
        self.wind.publish(wind_message(action=WindSource.DELETE))
        self.curtain.wait_for(lambda s: billow(s) < 0.02, "the curtain hangs again")

    def test_wind_ends_with_its_lifetime(self):
        self.wind.publish(wind_message(lifetime=0.5))
        self.curtain.wait_for(lambda s: billow(s) > 0.04, "the curtain blows")
        self.curtain.wait_for(lambda s: billow(s) < 0.02, "the wind is over")

    def test_wind_in_another_frame(self):
        """A source in a frame that is turned about z by half blows to -y."""
        broadcaster = tf2_ros.StaticTransformBroadcaster()
        static_frame(broadcaster, "world", "turned", (0.7, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))
        message = wind_message()
        message.header.frame_id = "turned"

        def blows():  # the frame and the message come on two ways: the first messages may overtake it
            self.wind.publish(message)
            return min(self.curtain.next().positions[1::3]) < -0.1
        wait_until(blows, "the curtain blows the other way")

    def test_drag_force_moves_its_node(self):
        """A force on a corner of the hem moves this corner, and most of all this corner."""
        self.drag.publish(drag_message(row=9, column=7, force=Vector3(0.0, 0.3, 0.0)))
        state = self.curtain.wait_for(lambda s: node_position(s, 9, 7)[1] > 0.1, "the corner moves")
        self.assertEqual(max(range(COLUMNS), key=lambda c: node_position(state, 9, c)[1]), 7)
        self.drag.publish(drag_message(action=DragForce.DELETE))
        self.curtain.wait_for(lambda s: billow(s) < 0.02, "let go")

    def test_drag_spring_takes_its_node_to_the_target(self):
        """A stiff spring holds its node at a target that the cloth can reach, to what the weight pulls it off."""
        target = (0.35, 0.4, 1.4)
        self.drag.publish(drag_message(mode=DragForce.SPRING, target=Point(*target), stiffness=200.0))
        # The cloth weighs 0.13 kg: 1.3 N at most on 200 N/m is 7 mm.
        self.curtain.wait_for(lambda s: distance(node_position(s, 9, 4), target) < 0.03, "the node is at the target")

    def test_drag_by_point_takes_the_nearest_node(self):
        where = node_position(self.curtain.next(), 9, 0)
        self.drag.publish(drag_message(row=-1, column=-1, point=Point(where[0] - 0.02, 0.01, where[2] - 0.02),
                                       force=Vector3(0.0, 0.3, 0.0)))
        state = self.curtain.wait_for(lambda s: node_position(s, 9, 0)[1] > 0.1, "the corner moves")
        self.assertEqual(max(range(COLUMNS), key=lambda c: node_position(state, 9, c)[1]), 0)

    def test_bad_messages_are_dropped_and_counted(self):
        """Each one counts once, moves nothing, and the node goes on."""
        def spoilt(message, spoil):
            spoil(message)
            return message
        winds = [spoilt(wind_message(), lambda m: setattr(m, "pressure", NAN)),
                 spoilt(wind_message(), lambda m: setattr(m, "radius", 0.0)),
                 spoilt(wind_message(), lambda m: setattr(m, "id", "")),
                 spoilt(wind_message(), lambda m: setattr(m, "action", 7)),
                 spoilt(wind_message(), lambda m: setattr(m.pose.position, "x", INF)),
                 spoilt(wind_message(), lambda m: (setattr(m.pose.orientation, "z", 0.0),
                                                   setattr(m.pose.orientation, "w", 0.0)))]
        push = Vector3(0.0, 0.5, 0.0)
        drags = [drag_message(row=10, force=push), drag_message(column=8, force=push),
                 drag_message(row=-1, force=push), drag_message(force=Vector3(0.0, NAN, 0.0)),
                 drag_message(mode=DragForce.SPRING, target=Point(INF, 0.0, 0.0)),
                 drag_message(mode=9, force=push), drag_message(radius=-1.0, force=push),
                 drag_message(lifetime=NAN, force=push)]
        before = self.statistics().dropped_invalid
        for message in winds:
            self.wind.publish(message)
        for message in drags:
            self.drag.publish(message)
        expected = before + len(winds) + len(drags)
        state = self.curtain.wait_for(lambda s: s.statistics.dropped_invalid >= expected, "all are dropped")
        self.assertEqual(state.statistics.dropped_invalid, expected)
        frame = state.statistics.frame
        state = self.curtain.wait_for(lambda s: s.statistics.frame > frame + 30, "the node goes on")
        self.assertLess(billow(state), 0.02)
        self.assertTrue(state.statistics.finite)

    def test_unknown_frame_is_dropped_and_counted(self):
        before = self.statistics().dropped_untransformed
        message = wind_message()
        message.header.frame_id = "nowhere"
        self.wind.publish(message)
        self.curtain.wait_for(lambda s: s.statistics.dropped_untransformed == before + 1, "it is dropped")
        drag = drag_message(force=Vector3(0.0, 0.5, 0.0))
        drag.header.frame_id = "nowhere"
        self.drag.publish(drag)
        state = self.curtain.wait_for(lambda s: s.statistics.dropped_untransformed == before + 2, "it is dropped")
        self.assertLess(billow(state), 0.02)

    def test_mesh_is_one_triangle_list(self):
        """Two triangles per fine quad, finite, in the world frame, as long as somebody looks."""
        mesh = Listener(NODE + "/mesh", Marker)
        marker = mesh.next()
        mesh.close()
        self.assertEqual((marker.type, marker.action), (Marker.TRIANGLE_LIST, Marker.ADD))
        self.assertEqual(marker.header.frame_id, "world")
        self.assertEqual(len(marker.points), 3 * 2 * (ROWS - 1) * (COLUMNS - 1) * FOLDS)
        self.assertTrue(all(math.isfinite(p.x + p.y + p.z) for p in marker.points))
        self.assertEqual(marker.lifetime, rospy.Duration(0))
        self.assertEqual(marker.color.a, 1.0)

    def test_markers_have_their_namespaces(self):
        self.wind.publish(wind_message(pressure=0.0))
        listener = Listener(NODE + "/markers", MarkerArray)
        shown = lambda: listener.last() and {m.ns: m for m in listener.last().markers if m.action == Marker.ADD}
        markers = wait_until(lambda: shown() if shown() and "wind" in shown() else None, "the wind is shown")
        self.assertEqual(set(markers), {"wires", "nodes", "folds", "wind"})
        self.assertEqual(len(markers["wires"].points), 2 * ((ROWS - 1) * COLUMNS + ROWS * (COLUMNS - 1)))
        self.assertEqual(len(markers["nodes"].points), ROWS * COLUMNS)
        self.assertEqual(len(markers["folds"].points), ROWS * (COLUMNS - 1) * (FOLDS - 1))
        self.wind.publish(WindSource(action=WindSource.DELETEALL))
        wait_until(lambda: "wind" not in shown(), "the wind is taken away")
        listener.close()

    def test_nothing_is_built_for_nobody(self):
        """No mesh and no markers are sent while nobody subscribes; no state either."""
        def quiet_second():
            start = self.statistics()
            end = self.curtain.wait_for(lambda s: s.statistics.frame > start.frame + 60, "a second passed").statistics
            return (start.meshes_sent, start.markers_sent) == (end.meshes_sent, end.markers_sent)
        wait_until(quiet_second, "earlier listeners are gone and nothing is sent")
        start = self.statistics()
        mesh = Listener(NODE + "/mesh", Marker)
        self.curtain.wait_for(lambda s: s.statistics.meshes_sent > start.meshes_sent + 5, "a mesh for a listener")
        self.assertEqual(self.statistics().markers_sent, start.markers_sent)

        before = self.statistics()
        self.curtain.close()
        start = time.monotonic()
        wait_until(lambda: time.monotonic() - start > 1.0, "a second passed without listeners to the state")
        mesh.close()
        type(self).curtain = Curtain(NODE)
        after = self.statistics()
        self.assertGreater(after.frame - before.frame, after.states_sent - before.states_sent + 20)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "interface", InterfaceTest, sys.argv)
