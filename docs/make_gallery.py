#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Takes the pictures of docs/gallery from rviz itself: of each demo a picture (NAME.png) and an animated strip (NAME.gif).

  docs/make_gallery.py [NAME ...] [--seconds S] [--out FOLDER]

In an environment with a build of this package (source build/devel/setup.bash). rviz draws in software, on an X server of its
own. The strip shows the demo from `gallery.at` of its demo.yaml [s] on, default 12, or from S on, a picture every
`gallery.step` [s]; number `gallery.picture` of them, default 0, is the large one.
Printed of each: frames and computing time of the node. Needs Xvfb, rviz, xdotool, ImageMagick.
"""
import argparse
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time

import rospy
import yaml
from curtain_sim.msg import CurtainState

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
DEMOS = os.path.join(ROOT, "config", "demos")
WIDTH, HEIGHT = 1920, 1280  # of the screen; rviz fills it, and pictures are made smaller: that smooths edges
PICTURE, STRIP = 960, 480  # widths of what is kept
FRAMES, STEP = 24, 0.2  # of the strip; s
STATE = "/curtain/curtain_node/state"


class Programs:
    """What runs in the background, ended with the block, the last first."""

    def __init__(self):
        self.running = []

    def __enter__(self):
        return self

    def start(self, log, *command, **options):
        with open(log, "w", encoding="utf-8") as file:
            process = subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, **options)
        self.running.append(process)
        return process

    def __exit__(self, *_):
        for process in reversed(self.running):
            process.send_signal(signal.SIGINT)
            try:
                process.wait(15.0)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def start_screen(programs, folder):
    """An X server; its display."""
    reader, writer = os.pipe()
    programs.start(os.path.join(folder, "screen.log"), "Xvfb", "-displayfd", str(writer), "-screen", "0",
                   "%dx%dx24" % (WIDTH, HEIGHT), "-nolisten", "tcp", "-nocursor", pass_fds=(writer,))
    os.close(writer)
    with os.fdopen(reader) as answer:
        return answer.readline().strip()


def fill_screen():
    """Without a window manager nobody else makes rviz as large as the screen."""
    subprocess.run(["xdotool", "search", "--sync", "--onlyvisible", "--class", "rviz", "windowmove", "0", "0", "windowsize", str(WIDTH),
                    str(HEIGHT)], check=True, timeout=60.0)


class Figures:
    """Computing time of the node's frames, from ~state."""

    def __init__(self):
        self.states = []
        self.subscriber = rospy.Subscriber(STATE, CurtainState, lambda state: self.states.append(state.statistics), queue_size=5)

    def wait_until(self, simulated, launch):
        deadline = time.monotonic() + 60.0 + 2.0 * simulated
        while not self.states or self.states[-1].simulated_time < simulated:
            if launch.poll() is not None or time.monotonic() > deadline:
                sys.exit("the demo does not come to %g s" % simulated)
            time.sleep(0.05)

    def line(self):
        self.subscriber.unregister()
        times = [figures.step_ms for figures in self.states]
        last = self.states[-1]
        return "%d frames, %d dropped; %.2f ms each (99 %%: %.2f); %d restarts, %d stops, %d messages refused" % (
            last.frame, last.dropped_frames, statistics.median(times), sorted(times)[int(0.99 * len(times))], last.restarts,
            last.stops, last.dropped_invalid + last.dropped_untransformed)


def convert(*arguments):
    subprocess.run(["convert", *arguments], check=True)


def take(name, folder, port, seconds, out):
    """Starts a demo, takes its pictures, ends it."""
    with open(os.path.join(DEMOS, name, "demo.yaml"), encoding="utf-8") as file:
        gallery = yaml.safe_load(file).get("gallery", {})
    at = seconds or gallery.get("at", 12.0)
    step = gallery.get("step", STEP)
    shots = [os.path.join(folder, "%s_%02d.xwd" % (name, i)) for i in range(FRAMES)]
    figures = Figures()
    with Programs() as programs:
        launch = programs.start(os.path.join(folder, name + ".log"), "roslaunch", "-p", port, "curtain_sim", "demo.launch",
                                "scene:=" + name, "output:=log", "rviz_args:=--fullscreen")
        figures.wait_until(1.0, launch)
        fill_screen()
        figures.wait_until(at, launch)
        begin = time.monotonic()
        for i, shot in enumerate(shots):
            time.sleep(max(0.0, begin + i * step - time.monotonic()))
            # Asked of the server, which answers between two pictures of rviz; its memory can hold parts of both.
            programs.start(os.path.join(folder, "import.log"), "import", "-silent", "-window", "root", "xwd:" + shot)
        for shot in programs.running[-FRAMES:]:
            shot.wait()
        text = figures.line()
    convert("xwd:" + shots[gallery.get("picture", 0)], "-resize", str(PICTURE), "-quality", "95", os.path.join(out, name + ".png"))
    convert("-delay", "%d" % round(100 * step), "-loop", "0", *("xwd:" + shot for shot in shots), "-resize", str(STRIP), "+dither",
            "-colors", "128", "-fuzz", "1.5%", "-layers", "Optimize", os.path.join(out, name + ".gif"))
    for shot in shots:
        os.remove(shot)
    print("%s: %s" % (name, text), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", default=sorted(os.listdir(DEMOS)))
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--out", default=os.path.join(ROOT, "docs", "gallery"))
    parser.add_argument("--port", default="11411", help="of the ROS master")
    arguments = parser.parse_args()
    for name in arguments.names:
        if not os.path.exists(os.path.join(DEMOS, name, "demo.yaml")):
            sys.exit("no demo '%s'; there are: %s" % (name, " ".join(sorted(os.listdir(DEMOS)))))
    os.makedirs(arguments.out, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, Programs() as programs:
        os.environ.update(DISPLAY=":" + start_screen(programs, folder), LIBGL_ALWAYS_SOFTWARE="1", XDG_RUNTIME_DIR=folder,
                          ROS_HOME=folder, ROS_MASTER_URI="http://localhost:" + arguments.port)
        programs.start(os.path.join(folder, "roscore.log"), "roscore", "-p", arguments.port)
        time.sleep(4.0)
        rospy.init_node("gallery", anonymous=True, disable_signals=True)
        for name in arguments.names:
            take(name, folder, arguments.port, arguments.seconds, arguments.out)
        rospy.signal_shutdown("done")


if __name__ == "__main__":
    main()
