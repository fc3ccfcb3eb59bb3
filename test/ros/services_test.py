#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Services of the node do what they say, refuse what is wrong in words, and hold up neither the stream nor each other,
whoever calls, dies, or stops."""
import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import unittest

import rospy
import rostest
from actionlib import ActionClient, CommState
from actionlib_msgs.msg import GoalStatus
from curtain_sim.msg import GraspAction, GraspGoal, GraspResult, WindSource
from curtain_sim.srv import Distance, ExportMesh, Load, Save, Step
from curtain_testing import (OK, Curtain, Diagnostics, NodeProcess, assert_stream_is_sound, billow, distance,
                             node_position, publisher, wait_until, wind_message)
from std_srvs.srv import SetBool, Trigger

NODE = "/stage/curtain"
ROWS, COLUMNS, FOLDS = 10, 8, 3
BALL, RADIUS = (0.35, 1.5, 1.6), 0.2
TRIANGLES = 2 * (ROWS - 1) * (COLUMNS - 1) * FOLDS
TYPES = {"reset": Trigger, "pause": SetBool, "step": Step, "save": Save, "load": Load, "export_mesh": ExportMesh,
         "distance": Distance}
AWAKE = {"cloth": {"rows": 10, "columns": 8}, "solver": {"rest_speed": 0.0, "substeps": 64}}  # 100000 frames take a while
CALLER = """
import rospy
from curtain_sim.srv import Step
rospy.init_node("caller", anonymous=True)
rospy.wait_for_service("%s/step")
print("calls", flush=True)
rospy.ServiceProxy("%s/step", Step)(100000)
"""


class Services:
    """Callers of a node's services, one connection for each call: safe from any thread."""

    def __init__(self, node):
        for name, kind in TYPES.items():
            rospy.wait_for_service(node + "/" + name, 20.0)
            setattr(self, name, rospy.ServiceProxy(node + "/" + name, kind))


class ServicesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("services_test")
        cls.curtain = Curtain(NODE)
        cls.curtain.next()
        cls.wind = publisher("/stage/wind_source", WindSource)
        cls.call = Services(NODE)
        cls.grasp = ActionClient(NODE + "/grasp", GraspAction)
        wait_until(lambda: all(end.get_num_connections() > 0 for end in (cls.grasp.pub_goal, cls.grasp.status_sub)), "~grasp is there")
        cls.folder = tempfile.mkdtemp()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def setUp(self):
        """Begins with a curtain that runs from its start; ends with the stream whole."""
        self.good(self.call.pause(False))
        self.good(self.call.reset())
        self.curtain.clear()

    def tearDown(self):
        self.good(self.call.pause(False))
        self.curtain.next()
        assert_stream_is_sound(self.curtain.messages())

    def path(self, name):
        return os.path.join(self.folder, name)

    def good(self, answer):
        self.assertTrue(answer.success, answer.message)
        return answer

    def refused(self, answer, *words):
        self.assertFalse(answer.success)
        for word in words:
            self.assertIn(word, answer.message)
        return answer

    def state_of(self, frame):
        return self.curtain.wait_for(lambda s: s.statistics.frame == frame, "frame %d is published" % frame)

    def test_reset(self):
        """Back to the start when it is answered, without the wind that came since."""
        self.wind.publish(wind_message())
        blown = self.curtain.wait_for(lambda s: billow(s) > 0.1, "the curtain blows")
        self.good(self.call.reset())
        self.good(self.call.pause(True))
        frame = self.good(self.call.step(1)).frame
        state = self.state_of(frame)
        self.assertEqual(state.statistics.restarts, blown.statistics.restarts + 1)
        self.assertLess(state.statistics.frame, blown.statistics.frame)
        self.assertLess(billow(state), 1e-3)
        self.assertEqual(len(state.winds), 0)

    def test_pause_stops_the_frames_and_counts_none_as_dropped(self):
        before = self.curtain.next().statistics
        self.assertEqual(self.good(self.call.pause(True)).message, "paused")
        self.good(self.call.pause(True))
        Diagnostics(NODE).wait_for("simulation", OK, "paused")  # a second of the clock has passed by
        last = self.curtain.last().statistics.frame
        frame = self.good(self.call.step(1)).frame
        self.assertEqual(self.state_of(frame).statistics.frame, last + 1)
        self.assertEqual(self.good(self.call.pause(False)).message, "running")
        after = self.curtain.wait_for(lambda s: s.statistics.frame > frame + 120, "the stream goes on").statistics
        self.assertEqual(after.dropped_frames, before.dropped_frames)
        self.assertEqual(after.restarts, before.restarts)

    def test_step_makes_as_many_frames_as_asked_for(self):
        self.good(self.call.pause(True))
        first = self.good(self.call.step(1))
        for frames in (1, 2, 10, 200):
            answer = self.good(self.call.step(frames))
            self.assertEqual(answer.frame, first.frame + frames)
            self.assertAlmostEqual(answer.simulated_time - first.simulated_time, frames / 60.0, delta=1e-9)
            state = self.state_of(answer.frame)
            self.assertEqual(state.header.stamp, answer.stamp)
            self.assertEqual(state.statistics.simulated_time, answer.simulated_time)
            first = answer

    def test_step_refuses_what_can_not_be(self):
        self.refused(self.call.step(5), "pause it first")
        self.good(self.call.pause(True))
        self.refused(self.call.step(0), "[1, 100000]", "is 0")
        self.refused(self.call.step(100001), "is 100001")

    def test_step_ends_with_what_it_is_a_part_of(self):
        """Going on, a reset and a load answer who waits for frames at once, and say how many were made."""
        path = self.path("state")
        self.good(self.call.save(path))
        ends = {"told to go on": lambda: self.call.pause(False), "was reset": self.call.reset,
                "snapshot was loaded": lambda: self.call.load(path)}
        for words, end in ends.items():
            self.good(self.call.pause(True))
            answers = []
            caller = threading.Thread(target=lambda: answers.append(self.call.step(100000)))
            start = self.good(self.call.step(1)).frame
            self.state_of(start)
            self.curtain.clear()  # of frames with higher numbers, from before a reset
            caller.start()
            self.curtain.wait_for(lambda s: s.statistics.frame > start + 5, "it has begun")
            self.good(end())
            caller.join(20.0)
            self.refused(answers[0], words, "of 100000 frames were made")

    def test_save_and_load(self):
        """The same state, and the same motion from it on, to the bit; stamps go on rising."""
        self.wind.publish(wind_message())
        self.curtain.wait_for(lambda s: billow(s) > 0.1, "the curtain blows")
        self.good(self.call.pause(True))
        path = self.path("state.snapshot")
        saved = self.good(self.call.save(path))
        first = self.state_of(self.good(self.call.step(30)).frame)
        self.curtain.clear()
        loaded = self.good(self.call.load(path))
        self.assertEqual(loaded.simulated_time, saved.simulated_time)
        second = self.state_of(self.good(self.call.step(30)).frame)
        self.assertEqual(second.positions, first.positions)
        self.assertEqual(second.statistics.simulated_time, first.statistics.simulated_time)
        self.assertEqual(second.statistics.restarts, first.statistics.restarts + 1)
        self.assertGreater(second.header.stamp, first.header.stamp)

    def grasp_the_hem(self):
        """A goal that has come to the node, which is paused. Its region is where the hem is."""
        goal = GraspGoal(frame="world", region=GraspGoal.NODES, rows=[ROWS - 1] * COLUMNS, columns=list(range(COLUMNS)))
        handle = self.grasp.send_goal(goal)
        wait_until(lambda: handle.get_comm_state() == CommState.PENDING, "the goal has come")
        return handle

    def hem(self, state):
        return [node_position(state, ROWS - 1, column) for column in range(COLUMNS)]

    def test_grasp_acts_in_the_next_frame(self):
        self.wind.publish(wind_message())
        self.curtain.wait_for(lambda s: billow(s) > 0.1, "the curtain blows")
        self.good(self.call.pause(True))
        before = self.state_of(self.good(self.call.step(1)).frame)
        handle = self.grasp_the_hem()
        after = self.state_of(self.good(self.call.step(1)).frame)
        self.assertEqual(self.hem(after), self.hem(before), "it is held in the first frame after the goal")
        wait_until(lambda: handle.get_goal_status() == GoalStatus.ACTIVE, "the goal is taken")
        handle.cancel()
        wait_until(lambda: handle.get_comm_state() == CommState.DONE or self.call.step(1), "it is let go")
        free = self.state_of(self.good(self.call.step(5)).frame)
        self.assertNotEqual(self.hem(free), self.hem(after))

    def test_load_lets_go(self):
        """Of what is held, and of what the snapshot says was held when it was saved."""
        self.wind.publish(wind_message())
        self.curtain.wait_for(lambda s: billow(s) > 0.1, "the curtain blows")
        self.good(self.call.pause(True))
        handle = self.grasp_the_hem()
        held = self.state_of(self.good(self.call.step(1)).frame)
        path = self.path("held.snapshot")
        self.good(self.call.save(path))
        self.curtain.clear()
        self.good(self.call.load(path))
        wait_until(lambda: handle.get_comm_state() == CommState.DONE, "the goal is over")
        os.remove(path)
        self.assertEqual(handle.get_result().end, GraspResult.RESET)
        self.assertNotEqual(self.hem(self.state_of(self.good(self.call.step(5)).frame)), self.hem(held))

    def test_paths_that_can_not_be_are_refused(self):
        for call in (self.call.save, self.call.export_mesh, self.call.load):
            self.refused(call(""), "path: is empty")
            self.refused(call("state.ply"), "'state.ply' must be a whole path")
        for call in (self.call.save, self.call.export_mesh):
            self.refused(call(self.path("nowhere/mesh.ply")), "there is no folder", "nowhere")
            self.refused(call(self.folder), "is a folder")
            self.refused(call("/proc/mesh.ply"), "/proc/mesh.ply", "cannot be written")
        self.refused(self.call.load(self.path("nothing")), self.path("nothing"), "No such file")
        self.refused(self.call.load(self.folder), "it is not a file")
        for name in ("mesh", "mesh.dae", ".ply", "mesh.PLY"):
            self.refused(self.call.export_mesh(self.path(name)), "must end in .ply, .obj or .stl")
        self.assertEqual(os.listdir(self.folder), [])

    def test_files_that_are_no_state_of_this_scene_are_refused(self):
        self.good(self.call.pause(True))
        path = self.path("state.snapshot")
        saved = self.good(self.call.save(path))
        with open(path, "rb") as file:
            whole = file.read()
        spoilt = bytearray(whole)
        spoilt[len(spoilt) // 2] ^= 1
        other = NodeProcess("/other", {"scene": {"cloth": {"rows": 12, "columns": 8}}, "start_paused": True})
        self.good(Services("/other").save(self.path("other.snapshot")))
        other.interrupt()
        other.wait()
        with open(self.path("other.snapshot"), "rb") as file:
            other_scene = file.read()
        bad = {"is cut short": whole[:len(whole) // 2], "checksum is wrong": bytes(spoilt),
               "is no snapshot": b"cloth: {rows: 10}\n", "of another scene": other_scene}
        before = self.state_of(self.good(self.call.step(1)).frame)
        for words, content in bad.items():
            with open(self.path("bad"), "wb") as file:
                file.write(content)
            self.refused(self.call.load(self.path("bad")), words)
        after = self.good(self.call.step(1))
        self.assertEqual(after.frame, before.statistics.frame + 1, "nothing changed")
        self.assertGreater(after.simulated_time, saved.simulated_time)
        for name in os.listdir(self.folder):
            os.remove(self.path(name))

    def test_export_mesh(self):
        """Each format holds the same mesh as the state of that time."""
        self.good(self.call.pause(True))
        state = self.state_of(self.good(self.call.step(1)).frame)
        for name in ("mesh.ply", "mesh.obj", "mesh.stl"):
            answer = self.good(self.call.export_mesh(self.path(name)))
            self.assertEqual(answer.triangles, TRIANGLES)
            self.assertEqual(answer.simulated_time, state.statistics.simulated_time)
        with open(self.path("mesh.obj")) as file:
            lines = [line.split() for line in file]
        vertices = [tuple(map(float, words[1:])) for words in lines if words[0] == "v"]
        faces = [[int(word) - 1 for word in words[1:]] for words in lines if words[0] == "f"]
        self.assertEqual(len(faces), TRIANGLES)
        a_row = (COLUMNS - 1) * FOLDS + 1
        for row, column in ((0, 0), (4, 3), (ROWS - 1, COLUMNS - 1)):
            where = vertices[row * a_row + column * FOLDS]
            self.assertLess(distance(where, node_position(state, row, column)), 1e-6, "as ~state has it, in floats")
        with open(self.path("mesh.ply")) as file:
            self.assertIn("element face %d\n" % TRIANGLES, file.read())
        with open(self.path("mesh.stl"), "rb") as file:
            stl = file.read()
        self.assertEqual(struct.unpack_from("<I", stl, 80)[0], TRIANGLES)
        for index, face in enumerate(faces):
            corners = struct.unpack_from("<9f", stl, 84 + 50 * index + 12)
            for k, vertex in enumerate(face):
                self.assertLess(distance(corners[3 * k:3 * k + 3], vertices[vertex]), 1e-6)
        for name in os.listdir(self.folder):
            os.remove(self.path(name))

    def test_distance(self):
        """As far from the ball as the nearest node of ~state, or nearer by what its quad's flatness makes."""
        self.good(self.call.pause(True))
        state = self.state_of(self.good(self.call.step(1)).frame)
        answer = self.good(self.call.distance([]))
        self.assertEqual((answer.names, answer.frame_id), (["ball"], state.header.frame_id))
        self.assertEqual(answer.simulated_time, state.statistics.simulated_time)
        nodes = min(distance(node_position(state, row, column), BALL) for row in range(ROWS) for column in range(COLUMNS)) - RADIUS
        self.assertLessEqual(answer.distances[0], nodes + 1e-6)
        self.assertGreater(answer.distances[0], nodes - 0.01, "half of a link of 0.1 m at 1 m: 1.3 mm on a plane")
        points = [(p.x, p.y, p.z) for p in (answer.on_cloth[0], answer.on_obstacle[0])]
        self.assertAlmostEqual(distance(*points), answer.distances[0], delta=1e-9)
        self.assertAlmostEqual(distance(points[1], BALL), RADIUS, delta=1e-9)
        self.assertEqual(self.good(self.call.distance(["ball", "ball"])).distances, 2 * answer.distances)
        self.refused(self.call.distance(["bal"]), "no obstacle 'bal'", "'ball'")

    def test_a_caller_that_dies_holds_up_nobody(self):
        """Killed while its 100000 frames are made: others get theirs, and the stream goes on at 60 Hz."""
        self.good(self.call.pause(True))
        start = self.good(self.call.step(1)).frame
        caller = subprocess.Popen([sys.executable, "-c", CALLER % (NODE, NODE)], stdout=subprocess.PIPE)
        self.curtain.wait_for(lambda s: s.statistics.frame > start + 5, "its frames are made")
        caller.kill()
        caller.wait()
        caller.stdout.close()
        for _ in range(5):
            before = self.curtain.next().statistics.frame
            self.assertGreater(self.good(self.call.step(10)).frame, before)
        self.good(self.call.save(self.path("state")))
        self.good(self.call.export_mesh(self.path("mesh.stl")))
        self.good(self.call.pause(False))
        os.remove(self.path("mesh.stl"))
        running = rospy.Time.now()
        begin = self.curtain.wait_for(lambda s: s.header.stamp > running, "the clock makes frames again")
        end = self.curtain.wait_for(lambda s: s.statistics.frame >= begin.statistics.frame + 120, "frames come")
        dropped = end.statistics.dropped_frames - begin.statistics.dropped_frames
        frames = end.statistics.frame - begin.statistics.frame
        # Stamps are of two clocks, read one after the other: the thread may be held up between them.
        self.assertAlmostEqual((end.header.stamp - begin.header.stamp).to_sec(), (frames + dropped) / 60.0, delta=5e-3)

    def test_all_at_once(self):
        """Many callers of everything: each is answered, and what they leave behind is a curtain as ever."""
        path = self.path("state")
        self.good(self.call.save(path))
        deeds = [lambda c: c.reset(), lambda c: c.pause(True), lambda c: c.pause(False), lambda c: c.step(7),
                 lambda c: c.step(0), lambda c: c.save(path), lambda c: c.load(path),
                 lambda c: c.export_mesh(path + ".stl"), lambda c: c.export_mesh("x")]
        answered, failed = [], []

        def work(seed):
            chance, call = random.Random(seed), Services(NODE)
            try:
                for _ in range(40):
                    answered.append(chance.choice(deeds)(call))
            except Exception as error:
                failed.append(error)
        threads = [threading.Thread(target=work, args=(seed,)) for seed in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(100.0)
        self.assertEqual(failed, [])
        self.assertEqual(len(answered), 240)
        for name in os.listdir(self.folder):
            os.remove(self.path(name))

    def test_callers_are_answered_when_the_node_stops(self):
        node = NodeProcess("/going", {"scene": dict(AWAKE), "start_paused": True})
        call = Services("/going")
        states, answers = Curtain("/going"), []
        threads = [threading.Thread(target=lambda: answers.append(call.step(100000))) for _ in range(6)]
        for thread in threads:
            thread.start()
        states.wait_for(lambda s: s.statistics.frame > 10, "frames are made")
        node.interrupt()
        self.assertEqual(node.wait(5.0), 0)
        for thread in threads:
            thread.join(5.0)
            self.assertFalse(thread.is_alive())
        # Four are served at a time. Of the others the connection ends: their threads have ended with an error.
        for answer in answers:
            self.refused(answer, "the node stops")
        self.assertGreater(len(answers), 0)

    def test_publish_clock_needs_simulated_time(self):
        node = NodeProcess("/clock_of_its_own", {"scene": {"cloth": {"rows": 10, "columns": 8}}, "publish_clock": True})
        self.assertEqual(node.wait(), 1)
        self.assertEqual(node.output().count("FATAL"), 1)
        self.assertIn("/clock_of_its_own/publish_clock: needs /use_sim_time", node.output())


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "services", ServicesTest, sys.argv)
