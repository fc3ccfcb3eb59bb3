#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Takes docs/sensors.png from rviz itself: the demo curtain, and what sensors.launch makes of it.

  docs/make_sensor_picture.py [--out FILE]

In an environment with a build of this package, as docs/make_gallery.py, whose screen it draws on.
"""
import argparse
import os
import subprocess
import tempfile
import time

import rospy
import yaml
from make_gallery import ROOT, Figures, Programs, convert, fill_screen, start_screen

AT = 11.0  # s of the demo: the ball is before the curtain, the fan at it
# Sensor, displays that are switched on.
PANELS = [("camera", ["Curtain", "Details"]), ("camera", ["Points"]), ("camera", ["Depth"]), ("lidar", ["Points"])]


def configuration(names, folder):
    """config/sensors.rviz with these displays alone. Returns where."""
    with open(os.path.join(ROOT, "config", "sensors.rviz"), encoding="utf-8") as file:
        config = yaml.safe_load(file)
    manager = config["Visualization Manager"]
    for display in manager["Displays"]:
        display["Enabled"] = display["Value"] = display["Name"] in names
        if display["Name"] == "Curtain":
            display["Wind"] = display["Legend"] = False
    manager["Views"]["Current"].update({"Distance": 3.2, "Pitch": 0.12, "Yaw": 5.3, "Focal Point": {"X": 0.25, "Y": -0.3, "Z": 1.2}})
    config["Window Geometry"]["Displays"] = {"collapsed": True}
    config["Window Geometry"]["Hide Left Dock"] = True
    path = os.path.join(folder, "panel.rviz")
    with open(path, "w", encoding="utf-8") as file:
        yaml.safe_dump(config, file)
    return path


def take(sensor, names, folder, port):
    """One panel, a run of its own, each at about the same moment."""
    shot = os.path.join(folder, "%s_%s.xwd" % (sensor, names[0]))
    figures = Figures()
    with Programs() as programs:
        launch = programs.start(os.path.join(folder, "launch.log"), "roslaunch", "-p", port, "curtain_sim", "sensors.launch",
                                "sensor:=" + sensor, "rviz:=false")
        figures.wait_until(0.5, launch)
        programs.start(os.path.join(folder, "rviz.log"), "rosrun", "curtain_sim", "curtain_rviz", "-d", configuration(names, folder),
                       "--fullscreen")
        figures.wait_until(AT - 4.0, launch)
        fill_screen()
        figures.wait_until(AT, launch)
        subprocess.run(["import", "-silent", "-window", "root", "xwd:" + shot], check=True)
    print("%s, %s: %s" % (sensor, names[0], figures.line()), flush=True)
    return shot


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", default=os.path.join(ROOT, "docs", "sensors.png"))
    parser.add_argument("--port", default="11412", help="of the ROS master")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, Programs() as programs:
        os.environ.update(DISPLAY=":" + start_screen(programs, folder), LIBGL_ALWAYS_SOFTWARE="1", XDG_RUNTIME_DIR=folder,
                          ROS_HOME=folder, ROS_MASTER_URI="http://localhost:" + arguments.port)
        programs.start(os.path.join(folder, "roscore.log"), "roscore", "-p", arguments.port)
        time.sleep(4.0)
        rospy.init_node("sensor_picture", anonymous=True, disable_signals=True)
        shots = [take(sensor, names, folder, arguments.port) for sensor, names in PANELS]
        # The middle of each, side by side.
        convert(*["xwd:" + shot for shot in shots], "-gravity", "center", "-crop", "1000x1200+0+0", "+repage", "-resize", "300",
                "+append", "-quality", "95", arguments.out)
        rospy.signal_shutdown("done")


if __name__ == "__main__":
    main()
