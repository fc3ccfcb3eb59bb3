# SPDX-License-Identifier: BSD-3-Clause
"""For tests that look at a screen: an X server of their own, and programs on it, which end with the test."""
import os
import shutil
import subprocess
import tempfile
import unittest

WIDTH, HEIGHT = 1000, 800  # of the screen and rviz's window [pixel]


class ScreenTest(unittest.TestCase):
    screens = 0  # started by this process

    @staticmethod
    def installed(*tools):
        """False, with a message, when one of them is not."""
        missing = [tool for tool in tools if shutil.which(tool) is None]
        if missing:
            print("skipped: not installed: " + ", ".join(missing))
        return not missing

    def setUp(self):
        self.processes = []
        self.folder = tempfile.mkdtemp(prefix="curtain_rviz_")

    def tearDown(self):
        for process in reversed(self.processes):
            process.terminate()
            try:
                process.wait(5.0)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def start(self, *command, **kwargs):
        log = open(os.path.join(self.folder, os.path.basename(command[0]) + ".log"), "w")
        process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, **kwargs)
        self.processes.append(process)
        return process

    def log_of(self, program):
        """The end of what a program that was started has said."""
        with open(os.path.join(self.folder, program + ".log"), errors="replace") as log:
            return log.read()[-2000:]

    def start_screen(self):
        """An X server; the environment for its programs. It has a number of its own: one that ends takes away the socket of one of the
        same number that begins."""
        ScreenTest.screens += 1
        reader, writer = os.pipe()
        self.start("Xvfb", ":%d" % (1000 + (os.getpid() * 10 + ScreenTest.screens) % 50000), "-displayfd", str(writer), "-screen", "0", "%dx%dx24" % (WIDTH, HEIGHT), "-nolisten", "tcp",
                   pass_fds=(writer,))
        os.close(writer)
        with os.fdopen(reader) as answer:
            number = answer.readline().strip()
        self.assertTrue(number, "Xvfb starts")
        os.chmod(self.folder, 0o700)
        return dict(os.environ, DISPLAY=":" + number, LIBGL_ALWAYS_SOFTWARE="1", XDG_RUNTIME_DIR=self.folder)

    def share(self, environment, wanted):
        """Of the screen's pixels, those whose colour is wanted."""
        picture = subprocess.run(["import", "-window", "root", "-depth", "8", "rgb:-"], env=environment,
                                 stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False).stdout
        if len(picture) != 3 * WIDTH * HEIGHT:
            return 0.0
        step = 7  # looking at every seventh pixel is enough
        pixels = range(0, WIDTH * HEIGHT, step)
        return sum(wanted(*picture[3 * i:3 * i + 3]) for i in pixels) / len(pixels)
