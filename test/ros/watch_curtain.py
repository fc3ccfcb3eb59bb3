#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Listens to a topic of a curtain in a process of its own, which a test can stop and kill: watch_curtain.py NODE TOPIC"""
import sys

import rospy
from curtain_sim.msg import CurtainState
from visualization_msgs.msg import Marker


def main():
    node, topic = sys.argv[1:3]
    rospy.init_node("watch_curtain", anonymous=True)
    rospy.Subscriber(node + "/" + topic, Marker if topic == "mesh" else CurtainState,
                     lambda message: print("got %.9f" % message.header.stamp.to_sec(), flush=True), queue_size=1)
    rospy.spin()


if __name__ == "__main__":
    main()
