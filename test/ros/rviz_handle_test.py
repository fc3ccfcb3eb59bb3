#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A handle that is dragged with the mouse in rviz, shown by config/markers.rviz, takes the hem along.

rviz runs on an X server of its own (Xvfb), the mouse is xdotool's. Passes with a message where one of them is not
installed.
"""
import os
import subprocess
import sys
import time

import roslib.packages
import rospy
import rostest
from curtain_testing import Curtain, Listener, distance, node_position, wait_until
from screen_testing import HEIGHT, WIDTH, ScreenTest
from visualization_msgs.msg import InteractiveMarkerFeedback

NODE = "/curtain/curtain_node"
HEM = 13


class RvizHandleTest(ScreenTest):
    def configuration(self):
        """config/markers.rviz with a camera that looks at the hem from the front."""
        with open(os.path.join(roslib.packages.get_pkg_dir("curtain_sim"), "config", "markers.rviz")) as file:
            text = file.read()
        head, views = text.split("  Views:\n    Current:", 1)
        view = ("\n      Class: rviz/Orbit\n      Distance: 2.5\n      Focal Point: {X: 0.4, Y: 0, Z: 0.7}\n"
                "      Name: Current View\n      Near Clip Distance: 0.01\n      Pitch: 0\n"
                "      Target Frame: <Fixed Frame>\n      Yaw: 4.71239\n    Saved: ~\n")
        path = os.path.join(self.folder, "test.rviz")
        with open(path, "w") as file:
            file.write(head + "  Views:\n    Current:" + view)
            file.write("Window Geometry:\n  Height: %d\n  Width: %d\n  X: 0\n  Y: 0\n  Hide Left Dock: true\n"
                       "  Hide Right Dock: true\n" % (HEIGHT, WIDTH))
            state = [line for line in views.splitlines() if "QMainWindow State" in line]
            file.write(state[0] + "\n  Displays:\n    collapsed: true\n  Views:\n    collapsed: true\n")
        return path

    def handles_on_screen(self, environment):
        """Middles of the round orange patches on the screen [pixel], from the left."""
        picture = subprocess.run(["import", "-window", "root", "-depth", "8", "rgb:-"], env=environment,
                                 stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False).stdout
        if len(picture) != 3 * WIDTH * HEIGHT:
            return []
        orange = set()
        for i in range(WIDTH * HEIGHT):
            red, green, blue = picture[3 * i], picture[3 * i + 1], picture[3 * i + 2]
            # The handles' colour (1, 0.75, 0.1) in any light.
            if red > 110 and 0.55 * red < green < 0.92 * red and blue < 0.35 * red:
                orange.add((i % WIDTH, i // WIDTH))
        middles = []
        while orange:
            patch, edge = [], [orange.pop()]
            while edge:
                x, y = edge.pop()
                patch.append((x, y))
                for neighbour in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
                    if neighbour in orange:
                        orange.remove(neighbour)
                        edge.append(neighbour)
            xs, ys = [x for x, _ in patch], [y for _, y in patch]
            width, height = max(xs) - min(xs) + 1, max(ys) - min(ys) + 1
            # A disc fills pi/4 of its box; icons and text do not.
            if 10 <= width <= 80 and 0.8 < width / height < 1.25 and len(patch) > 0.65 * width * height:
                middles.append((sum(xs) // len(xs), sum(ys) // len(ys)))
        return sorted(middles)

    def test_mouse_drags_the_hem(self):
        if not self.installed("rviz", "Xvfb", "xdotool", "import"):
            return
        rospy.init_node("rviz_handle_test")
        curtain = Curtain(NODE)
        feedback = Listener(NODE + "/handles/feedback", InteractiveMarkerFeedback)
        curtain.next()
        environment = self.start_screen()
        rviz = self.start("rviz", "-d", self.configuration(), env=environment)

        def looks():
            self.assertIsNone(rviz.poll(), "rviz runs\n" + self.log_of("rviz"))
            handles = self.handles_on_screen(environment)
            return handles if len(handles) >= 3 else None
        wait_until(looks, "rviz shows the handles", 60.0)

        def mouse(*arguments):
            subprocess.run(["xdotool"] + [str(a) for a in arguments], env=environment, check=True, timeout=20.0)

        def pressed():
            down = [m for m in feedback.messages() if m.event_type == InteractiveMarkerFeedback.MOUSE_DOWN]
            return down[0].marker_name if down else None

        def press():
            handles = looks()
            if not handles:
                return None
            x, y = handles[len(handles) // 2]
            mouse("mousemove", x + 3, y)
            mouse("mousemove", x, y)
            time.sleep(0.2)  # rviz looks what is under the mouse with its next picture; a press before turns the camera
            mouse("mousedown", 1)
            deadline = time.monotonic() + 1.0
            while not pressed() and time.monotonic() < deadline:
                time.sleep(0.01)
            if not pressed():
                mouse("mouseup", 1)
            return pressed()
        before = curtain.last()
        name = wait_until(press, "rviz takes the handle", 40.0)
        column = int(name.rpartition("_")[2])
        before = node_position(before, HEM, column)
        for _ in range(25):
            mouse("mousemove_relative", "--", 6, -5)

        # Seen from the front, right is +x and up is +z.
        def dragged(state):
            now = node_position(state, HEM, column)
            return now[0] - before[0] > 0.05 and now[2] - before[2] > 0.05
        curtain.wait_for(dragged, "the hem follows the mouse", 30.0)
        updates = [m for m in feedback.messages() if m.event_type == InteractiveMarkerFeedback.POSE_UPDATE]
        self.assertGreater(len(updates), 3)
        self.assertEqual(len({m.marker_name for m in updates}), 1, "one handle in the hand")

        mouse("mouseup", 1)
        curtain.wait_for(lambda s: distance(node_position(s, HEM, column), before) < 0.03,
                         "let go, the hem swings back", 30.0)


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "rviz_handle", RvizHandleTest, sys.argv)
