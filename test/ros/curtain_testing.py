# SPDX-License-Identifier: BSD-3-Clause
"""What the rostests share: waiting on conditions with a deadline, and listening to a curtain."""
import math
import os
import signal
import subprocess
import sys
import threading
import time

import rosgraph
import roslib.packages
import rospy
import tf2_ros
from curtain_sim.msg import CurtainState, DragForce, WindSource
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import TransformStamped

PATIENCE = 20.0  # s, before a condition that should come true soon is called a failure; never slept through


def wait_until(condition, what, patience=PATIENCE):
    """Returns the first true value of condition(); AssertionError naming what when it does not come."""
    deadline = time.monotonic() + patience
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > deadline:
            raise AssertionError("waited %g s in vain until %s" % (patience, what))
        time.sleep(0.005)


def service(node, name, kind):
    """Calls a service of a node, over one connection."""
    rospy.wait_for_service(node + "/" + name, PATIENCE)
    return rospy.ServiceProxy(node + "/" + name, kind, persistent=True)


class Listener:
    """Keeps what arrives on a topic."""

    def __init__(self, topic, message_type):
        self._lock = threading.Lock()
        self._messages = []
        self._subscriber = rospy.Subscriber(topic, message_type, self._take, queue_size=100, tcp_nodelay=True)

    def _take(self, message):
        with self._lock:
            self._messages.append(message)

    def messages(self):
        with self._lock:
            return list(self._messages)

    def last(self):
        with self._lock:
            return self._messages[-1] if self._messages else None

    def count(self):
        with self._lock:
            return len(self._messages)

    def clear(self):
        with self._lock:
            self._messages = []

    def next(self, patience=PATIENCE):
        """A message that arrives after this call."""
        seen = self.count()
        return wait_until(lambda: self.messages()[seen:], "a message comes", patience)[0]

    def close(self):
        self._subscriber.unregister()


class Curtain(Listener):
    """A curtain node's ~state, with its nodes as points."""

    def __init__(self, node):
        Listener.__init__(self, node + "/state", CurtainState)

    def wait_for(self, condition, what, patience=PATIENCE):
        """Waits until condition(state) of the last state is true; returns that state."""
        def check():
            state = self.last()
            return state if state is not None and condition(state) else None
        return wait_until(check, what, patience)


def points(flat):
    return [tuple(flat[i:i + 3]) for i in range(0, len(flat), 3)]


def node_position(state, row, column):
    at = 3 * (row * state.columns + column)
    return tuple(state.positions[at:at + 3])


def distance(a, b):
    return sum((p - q) ** 2 for p, q in zip(a, b)) ** 0.5


def billow(state):
    """Largest y of any node [m]; the test curtains hang in the plane y = 0."""
    return max(state.positions[1::3])


def wind_message(**fields):
    """Wind along +y from a disc in front of the test curtains."""
    message = WindSource()
    message.id = "fan"
    message.action = WindSource.ADD
    message.pose.position.x = 0.35
    message.pose.position.y = -1.0
    message.pose.position.z = 1.5
    message.pose.orientation.z = message.pose.orientation.w = 0.5 ** 0.5
    message.radius = 1.0
    message.half_angle = 0.2
    message.pressure = 4.0
    for key, value in fields.items():
        setattr(message, key, value)
    return message


def drag_message(**fields):
    message = DragForce()
    message.id = "hand"
    message.action = DragForce.ADD
    message.row = 9
    message.column = 4
    for key, value in fields.items():
        setattr(message, key, value)
    return message


def publisher(topic, message_type):
    """A publisher that somebody listens to already."""
    result = rospy.Publisher(topic, message_type, queue_size=50)
    wait_until(lambda: result.get_num_connections() > 0, "somebody listens to " + topic)
    return result


class MovingFrame:
    """Broadcasts a frame of its own at 100 Hz until it is stopped."""

    def __init__(self, parent, child, position):
        self.history = []  # positions that were sent, with the monotonic time of each
        self._parent = parent
        self._child = child
        self._position = tuple(position)
        self._velocity = (0.0, 0.0, 0.0)
        self._goal = None
        self._running = False
        self._broadcaster = tf2_ros.TransformBroadcaster()
        self._thread = None
        self.start()

    def start(self):
        self._running = True
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def stop(self):
        self._running = False
        self._thread.join()

    def move_to(self, position, speed):
        """Goes there evenly [m/s]; returns when it has arrived."""
        self._goal = (tuple(position), speed)
        wait_until(lambda: self._goal is None, "the frame has arrived")

    def put(self, position):
        """Is there at once."""
        self._position = tuple(position)

    def position(self):
        return self._position

    def _run(self):
        period = 0.01
        while self._running and not rospy.is_shutdown():
            if self._goal is not None:
                goal, speed = self._goal
                way = distance(goal, self._position)
                if way <= speed * period:
                    self._position, self._goal = goal, None
                else:
                    share = speed * period / way
                    self._position = tuple(p + share * (g - p) for p, g in zip(self._position, goal))
            transform = TransformStamped()
            transform.header.stamp = rospy.Time.now()
            transform.header.frame_id = self._parent
            transform.child_frame_id = self._child
            translation = transform.transform.translation
            translation.x, translation.y, translation.z = self._position
            transform.transform.rotation.w = 1.0
            self.history.append((time.monotonic(), self._position))
            self._broadcaster.sendTransform(transform)
            time.sleep(period)


def static_frame(broadcaster, parent, child, position, rotation=(0.0, 0.0, 0.0, 1.0)):
    transform = TransformStamped()
    transform.header.stamp = rospy.Time.now()
    transform.header.frame_id = parent
    transform.child_frame_id = child
    translation = transform.transform.translation
    translation.x, translation.y, translation.z = position
    turn = transform.transform.rotation
    turn.x, turn.y, turn.z, turn.w = rotation
    broadcaster.sendTransform(transform)


def program(name):
    """Path of a program or script of this package."""
    found = roslib.packages.find_node("curtain_sim", name)
    assert found, name + " is built"
    return found[0]


class Process:
    """A program started by the test itself; what it prints is kept."""

    def __init__(self, command, **kwargs):
        self._process = subprocess.Popen(command, universal_newlines=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                         **kwargs)
        self._lines = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self._process.stdout:
            self._lines.append(line)

    def output(self):
        return "".join(self._lines)

    def running(self):
        return self._process.poll() is None

    def pid(self):
        return self._process.pid

    def interrupt(self):
        self.send_signal(signal.SIGINT)

    def send_signal(self, number):
        self._process.send_signal(number)

    def resident(self):
        """Memory [bytes]."""
        with open("/proc/%d/statm" % self.pid()) as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def wait(self, patience=PATIENCE):
        """Exit code, or AssertionError when it does not end."""
        try:
            code = self._process.wait(patience)
        except subprocess.TimeoutExpired:
            self.kill()
            raise AssertionError("it still runs after %g s:\n%s" % (patience, self.output()))
        self._reader.join(5.0)
        return code

    def kill(self):
        if self.running():
            self._process.kill()
            self._process.wait()


class NodeProcess(Process):
    """A curtain_node started by the test itself, to see how it starts and ends.

    parameters  are set first; None: those that are there
    master      URI of another ROS master than the test's
    prefix      command that starts it, e.g. ["nice"]
    """

    def __init__(self, name, parameters, master=None, prefix=(), **kwargs):
        server = rosgraph.Master("/curtain_testing", master_uri=master)
        if parameters is not None:
            if server.hasParam(name):
                server.deleteParam(name)
            server.setParam(name, parameters)
        namespace, _, node = name.rpartition("/")
        environment = dict(os.environ, ROS_NAMESPACE=namespace or "/", ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
        if master:
            environment["ROS_MASTER_URI"] = master
        Process.__init__(self, list(prefix) + [program("curtain_node"), "__name:=" + node], env=environment, **kwargs)


class Watcher(Process):
    """A process of its own that listens to a curtain's ~state, and says of each what it checks itself."""

    def __init__(self, node, master=None, topic="state"):
        environment = dict(os.environ, PYTHONUNBUFFERED="1")
        if master:
            environment["ROS_MASTER_URI"] = master
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "watch_curtain.py")
        Process.__init__(self, [sys.executable, script, node, topic], env=environment)

    def count(self):
        return sum(1 for line in list(self._lines) if line.startswith("got"))


class Diagnostics(Listener):
    """What a node says of itself on /diagnostics."""

    def __init__(self, node):
        Listener.__init__(self, "/diagnostics", DiagnosticArray)
        self._node = node.lstrip("/")

    def status(self, name):
        """The last one of that name, or None."""
        for message in reversed(self.messages()):
            for status in message.status:
                if status.name == self._node + ": " + name and status.message != "Node starting up":
                    return status
        return None

    def wait_for(self, name, level, text="", value=("", ""), patience=PATIENCE):
        """Waits until the status has the level, the text in its message, and in its value of that key the other text; returns
        its values."""
        def check():
            status = self.status(name)
            if not status or status.level != level or text not in status.message:
                return None
            return status if any(value[0] in v.key and value[1] in v.value for v in status.values) else None
        try:
            status = wait_until(check, "%s is at level %d: %s" % (name, level, text), patience)
        except AssertionError as error:
            raise AssertionError("%s; the last one: %s" % (error, self.status(name)))
        return {value.key: value.value for value in status.values}


OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR


def assert_stream_is_sound(states):
    """Within a run stamps and frames rise, nothing is NaN, and counts never fall."""
    for a, b in zip(states, states[1:]):
        new_run = b.statistics.restarts > a.statistics.restarts
        if not new_run:
            assert b.header.stamp > a.header.stamp, "stamps rise: %s, %s" % (a.header.stamp, b.header.stamp)
            assert b.statistics.frame > a.statistics.frame, "frames rise"
        for count in ("restarts", "dropped_frames", "dropped_invalid", "dropped_untransformed", "dropped_overflow",
                      "dropped_queue", "messages_taken", "late_poses", "early_poses", "obstacles_lost", "not_finite",
                      "clock_jumps_back"):
            assert getattr(b.statistics, count) >= getattr(a.statistics, count), count
    for state in states:
        assert state.statistics.finite and state.statistics.not_finite == 0
        assert all(math.isfinite(x) for x in state.positions)
        assert all(math.isfinite(x) for x in state.velocities)
