# SPDX-License-Identifier: BSD-3-Clause
"""What the rostests share: waiting on conditions with a deadline, and listening to a curtain."""
import os
import signal
import subprocess
import threading
import time

import roslib.packages
import rospy
import tf2_ros
from curtain_sim.msg import CurtainState, DragForce, WindSource
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


class NodeProcess:
    """A curtain_node started by the test itself, to see how it starts and ends."""

    def __init__(self, name, parameters):
        if rospy.has_param(name):
            rospy.delete_param(name)
        rospy.set_param(name, parameters)
        program = roslib.packages.find_node("curtain_sim", "curtain_node")
        assert program, "curtain_node is built"
        namespace, _, node = name.rpartition("/")
        environment = dict(os.environ, ROS_NAMESPACE=namespace or "/", ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
        self._process = subprocess.Popen([program[0], "__name:=" + node], env=environment, universal_newlines=True,
                                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
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
        self._process.send_signal(signal.SIGINT)

    def wait(self, patience=PATIENCE):
        """Exit code, or AssertionError when it does not end."""
        try:
            code = self._process.wait(patience)
        except subprocess.TimeoutExpired:
            self.kill()
            raise AssertionError("the node still runs after %g s:\n%s" % (patience, self.output()))
        self._reader.join(5.0)
        return code

    def kill(self):
        if self.running():
            self._process.kill()
            self._process.wait()
