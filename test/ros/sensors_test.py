#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""~points and ~depth hold what a sensor would see, in its frame; programs that others wrote understand them."""
import ctypes
import sys
import unittest

import numpy
import rosgraph
import rospy
import rostest
import tf2_ros
from curtain_sim.msg import Labels
from curtain_sim.srv import Step
from curtain_testing import (OK, WARN, Curtain, Diagnostics, Listener, NodeProcess, Process, distance, node_position,
                             program, publisher, static_frame, wait_until)
from sensor_msgs.msg import CameraInfo, Image, PointCloud2, PointField

ROWS, COLUMNS = 10, 8
HEIGHT, WIDTH = 0.9, 0.7
FOCUS, PIXELS_WIDE, PIXELS_HIGH = 100.0, 160, 120
# The camera is 2 m before the curtain, which hangs in the plane y = 0, and looks along +y.
CAMERA = (0.35, -2.0, 1.55)
FORWARD = (-0.5 ** 0.5, 0.0, 0.0, 0.5 ** 0.5)
# Single precision of coordinates of a few metres, a few roundings.
ROUNDING = 2e-6
LIBRARIES = {"depth_image_proc": "libdepth_image_proc.so.0d", "pcl_ros": "libpcl_ros_filters.so.0d"}
POINT = numpy.dtype([("xyz", "<f4", 3), ("normal", "<f4", 3), ("node", "<i4"), ("uv", "<f4", 2), ("speed", "<f4")])


def points_of(cloud):
    """Its points by row and column."""
    assert cloud.point_step == POINT.itemsize and len(cloud.data) == cloud.row_step * cloud.height
    return numpy.frombuffer(cloud.data, POINT).reshape(cloud.height, cloud.width)


def depths_of(image):
    return numpy.frombuffer(image.data, "<f4").reshape(image.height, image.width)


def camera_info(**fields):
    info = CameraInfo(width=PIXELS_WIDE, height=PIXELS_HIGH, distortion_model="plumb_bob", D=[0.0] * 5)
    info.header.frame_id = "camera"
    info.K = [FOCUS, 0.0, 79.5, 0.0, FOCUS, 59.5, 0.0, 0.0, 1.0]
    for key, value in fields.items():
        setattr(info, key, value)
    return info


def has_library(name):
    try:
        ctypes.CDLL(LIBRARIES[name])
        return True
    except OSError:
        return False


class SensorsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("sensors_test")
        cls.frames = tf2_ros.StaticTransformBroadcaster()

    def listen(self, topic, message_type):
        listener = Listener(topic, message_type)
        self.addCleanup(listener.close)
        return listener

    def place(self, child, position, rotation=(0.0, 0.0, 0.0, 1.0)):
        static_frame(self.frames, "world", child, position, rotation)

    def open_eyes(self):
        """The camera and the ball are where they are, the camera is known; its newest image."""
        self.place("camera", CAMERA, FORWARD)
        self.place("ball", (0.35, -0.5, 1.55))
        infos = publisher("/camera/camera_info", CameraInfo)
        images = self.listen("/camera/curtain/depth/image", Image)

        def sees_the_ball():
            infos.publish(camera_info())
            image = images.last()
            # The nearest of the ball is 1.5 m - 0.2 m off.
            return image if image and abs(depths_of(image)[59, 79] - 1.3) < 0.01 else None
        return wait_until(sees_the_ball, "the camera sees the ball")

    def test_all_round(self):
        """Points of the asked density, each beside its node, in the world's frame; the same spots in every cloud."""
        state = Curtain("/round/curtain").next()
        clouds = self.listen("/round/curtain/points", PointCloud2)
        cloud = clouds.next()
        self.assertEqual([(f.name, f.offset, f.datatype) for f in cloud.fields],
                         [(name, 4 * i, PointField.INT32 if name == "node" else PointField.FLOAT32) for i, name in
                          enumerate("x y z normal_x normal_y normal_z node u v speed".split())])
        self.assertEqual(cloud.header.frame_id, "world")
        self.assertTrue(cloud.is_dense)
        points = points_of(cloud)
        self.assertEqual(points.shape, (1, round(4000.0 * HEIGHT * WIDTH)))
        for point in points[0]:
            row, column = divmod(int(point["node"]), COLUMNS)
            # Half a link either way, and as much again for a curtain that has not come to rest.
            self.assertLess(distance(point["xyz"], node_position(state, row, column)), 0.15)
            self.assertLess(abs(point["uv"][1] - 0.1 * row), 0.051)
        numpy.testing.assert_allclose(numpy.linalg.norm(points["normal"], axis=-1), 1.0, atol=ROUNDING)
        again = points_of(clouds.next())
        numpy.testing.assert_array_equal(points["uv"], again["uv"])

    def test_camera(self):
        """Bad camera_infos are dropped and named; with a good one depths are those of the scene."""
        diagnostics = Diagnostics("/camera/curtain")
        curtain = Curtain("/camera/curtain")
        clouds = self.listen("/camera/curtain/points", PointCloud2)
        dropped = curtain.next().statistics.dropped_invalid
        infos = publisher("/camera/camera_info", CameraInfo)
        if not clouds.last():
            diagnostics.wait_for("obstacles", WARN, "~points sees nothing")
        for bad, text in [
                (camera_info(K=[0.0] * 9), "fx: must be a number in [0.001, 1000000], is 0"),
                (camera_info(width=0), "width: must be a number in [1, 8192], is 0"),
                (camera_info(distortion_model="equidistant", D=[0.1] * 4), "must be plumb_bob"),
                (camera_info(distortion_model="rational_polynomial", D=[0.1] * 8), "must be plumb_bob"),
                (camera_info(D=[-3.0, 0.0, 0.0, 0.0, 0.0]), "has no inverse at the pixel"),
                (camera_info(binning_x=2, binning_y=2), "binning_x"),
                (camera_info(R=[float("nan")] * 9), "R: must be finite"),
                (camera_info(P=[100.0] + [float("inf")] * 11), "P: must be finite"),
                (camera_info(K=[float("nan")] + [1.0] * 8), "K: must have no skew")]:
            for _ in range(2):  # the second time it is known
                infos.publish(bad)
                dropped += 1
                curtain.wait_for(lambda s: s.statistics.dropped_invalid == dropped, "it is dropped")
                diagnostics.wait_for("inputs", WARN, value=("last", text))
        image = self.open_eyes()
        self.assertEqual((image.width, image.height, image.encoding, image.header.frame_id),
                         (PIXELS_WIDE, PIXELS_HIGH, "32FC1", "camera"))
        depths = depths_of(image)
        # The wall is at y = 1: a depth of 3 m wherever nothing is before it, as in the corners.
        for row, column in [(0, 0), (0, -1), (-1, 0), (-1, -1)]:
            self.assertAlmostEqual(depths[row, column], 3.0, delta=ROUNDING)
        # The curtain hangs 2 m off, and its folds are flat: it is as wide as its hung edge. Beside the ball is cloth.
        self.assertAlmostEqual(depths[40, 64], 2.0, delta=0.05)
        info = wait_until(self.listen("/camera/curtain/depth/camera_info", CameraInfo).last, "camera_info comes")
        self.assertEqual(info.K, tuple(camera_info().K))
        self.assertEqual(info.P[:3], tuple(camera_info().K[:3]), "filled in")
        diagnostics.wait_for("obstacles", OK)
        points = points_of(clouds.next())
        self.assertEqual(points.shape, (PIXELS_HIGH, PIXELS_WIDE))
        self.assertEqual(points["node"][59, 79], -1, "the ball")
        self.assertGreaterEqual(points["node"][40, 64], 0)

    def test_labels(self):
        """What each pixel shows, named; the same on the depth image; nodes where it is cloth."""
        self.open_eyes()
        topic = "/camera/curtain/depth/"
        depths, labels, nodes = (self.listen(topic + name, Image) for name in ("image", "labels", "nodes"))
        names = wait_until(self.listen(topic + "label_names", Labels).last, "the names are there").names
        self.assertEqual(names, ["background", "cloth", "wall", "ball"])

        def of_one_frame():
            by_stamp = [{m.header.stamp: m for m in listener.messages()[-20:]} for listener in (depths, labels, nodes)]
            stamps = set(by_stamp[0]) & set(by_stamp[1]) & set(by_stamp[2])
            return [messages[max(stamps)] for messages in by_stamp] if stamps else None
        depth, label, node = wait_until(of_one_frame, "all three are there, of one frame")
        self.assertEqual((label.encoding, node.encoding, label.header.frame_id), ("16UC1", "32SC1", "camera"))
        depth = depths_of(depth)
        label = numpy.frombuffer(label.data, "<u2").reshape(depth.shape)
        node = numpy.frombuffer(node.data, "<i4").reshape(depth.shape)
        self.assertEqual(label[59, 79], names.index("ball"))
        self.assertEqual(label[40, 64], names.index("cloth"))
        for row, column in [(0, 0), (0, -1), (-1, 0), (-1, -1)]:
            self.assertEqual(label[row, column], names.index("wall"))
        self.assertTrue((depth[label == names.index("ball")] < 1.55).all())
        numpy.testing.assert_array_equal(node >= 0, label == names.index("cloth"))
        self.assertLess(node.max(), ROWS * COLUMNS)

    def test_lidar(self):
        """A paused node has a view of every frame that is asked for; its noise is new in each."""
        self.place("lidar", (0.35, -1.0, 1.5))
        clouds = self.listen("/lidar/curtain/points", PointCloud2)
        step = rospy.ServiceProxy("/lidar/curtain/step", Step)
        wait_until(lambda: clouds.last(), "the lidar sees something while the node is paused")
        seen = []
        for _ in range(3):
            stamp = step(1).stamp
            cloud = wait_until(lambda: next((c for c in clouds.messages() if c.header.stamp == stamp), None),
                               "the view of this frame comes")
            seen.append(points_of(cloud))
        self.assertEqual(seen[0].shape, (8, 400))
        both = [~numpy.isnan(points["xyz"][..., 0]) for points in seen]
        self.assertGreater(both[0].sum(), 100)
        numpy.testing.assert_array_less(seen[0]["xyz"][both[0]][:, 1], 1.2)
        self.assertFalse(numpy.array_equal(seen[0]["xyz"], seen[1]["xyz"], equal_nan=True))

    @unittest.skipUnless(has_library("depth_image_proc"), "no libdepth-image-proc0d")
    def test_depth_image_proc(self):
        """Its point_cloud_xyz makes of the depth image the points that are on ~points."""
        self.open_eyes()
        self.host("depth_image_proc", "depth_image_proc::PointCloudXyzNodelet", "/xyz",
                  "image_rect:=/camera/curtain/depth/image", "points:=/xyz/points")
        theirs = self.listen("/xyz/points", PointCloud2)
        ours = self.listen("/camera/curtain/points", PointCloud2)

        def pair():
            of = {c.header.stamp: c for c in ours.messages()[-20:]}
            return next(((c, of[c.header.stamp]) for c in theirs.messages() if c.header.stamp in of), None)
        their, our = wait_until(pair, "both have a cloud of the same frame")
        self.assertEqual(their.header.frame_id, "camera")
        offsets = {f.name: f.offset for f in their.fields}
        record = numpy.dtype({"names": ["x", "y", "z"], "formats": ["<f4"] * 3,
                              "offsets": [offsets[n] for n in "xyz"], "itemsize": their.point_step})
        their_points = numpy.frombuffer(their.data, record).reshape(their.height, their.width)
        our_points = points_of(our)["xyz"]
        self.assertFalse(numpy.isnan(our_points).any())
        for axis, name in enumerate("xyz"):
            numpy.testing.assert_allclose(our_points[..., axis], their_points[name], atol=ROUNDING)

    @unittest.skipUnless(has_library("pcl_ros"), "no libpcl-ros-filters0d")
    def test_pcl(self):
        """pcl_ros thins out the cloud: fewer points, one a voxel, within what went in."""
        self.open_eyes()
        rospy.set_param("/voxel", {"leaf_size": 0.1, "filter_field_name": "z", "filter_limit_min": 0.5,
                                   "filter_limit_max": 2.5})
        self.host("pcl_ros", "VoxelGrid", "/voxel", "/voxel/input:=/camera/curtain/points")
        cloud = self.listen("/voxel/output", PointCloud2).next()
        offsets = {f.name: f.offset for f in cloud.fields}
        record = numpy.dtype({"names": ["x", "y", "z"], "formats": ["<f4"] * 3,
                              "offsets": [offsets[n] for n in "xyz"], "itemsize": cloud.point_step})
        points = numpy.frombuffer(cloud.data, record)
        self.assertGreater(len(points), 20)
        self.assertLess(len(points), PIXELS_WIDE * PIXELS_HIGH // 10)
        self.assertGreater(points["z"].min(), 1.25, "the ball is the nearest")
        self.assertLess(points["z"].max(), 2.5, "the wall is cut off")
        voxels = numpy.floor(numpy.stack([points[n] for n in "xyz"], -1) / 0.1)
        # A mean may be rounded over its voxel's side.
        self.assertGreater(len(numpy.unique(voxels, axis=0)), 0.98 * len(points))

    def host(self, package, nodelet, name, *remaps):
        host = Process([program("curtain_nodelet_host"), LIBRARIES[package], nodelet, name,
                        "__name:=host_of_" + package] + list(remaps))
        self.addCleanup(host.kill)

    def test_nothing_for_nobody(self):
        """Without a listener no frame is looked up."""
        subscribed = rosgraph.Master("/sensors_test").getSystemState()[1]
        listeners = {topic: nodes for topic, nodes in subscribed}
        self.assertNotIn("/round/curtain", listeners.get("/tf", []))

    def test_bad_parameters(self):
        """The node refuses to start, and names all of them at once."""
        scene = {"cloth": {"rows": ROWS, "columns": COLUMNS}}
        for points, texts in [
                ({"sensor": "camera", "camera": {"fx": 0.0}, "rate": "fast", "min_range": 20.0},
                 ["points/camera.fx: must be a number in [0.001, 1000000], is 0", "points/rate",
                  "points/min_range: must be less than max_range"]),
                ({"density": 1.0e8}, ["points/density: gives 200000000 points"])]:
            node = NodeProcess("/bad/curtain", {"points": points, "scene": scene})
            self.addCleanup(node.kill)
            self.assertEqual(node.wait(), 1, node.output())
            self.assertEqual(node.output().count("FATAL"), 1, node.output())
            for text in texts:
                self.assertIn(text, node.output())


if __name__ == "__main__":
    rostest.rosrun("curtain_sim", "sensors", SensorsTest, sys.argv)
