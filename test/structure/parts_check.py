#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Nothing optional stops the build: configures the package as where all of it is missing, and reads what is said of that.

  parts_check.py BUILD_FOLDER [CMAKE_ARGUMENT ...]
"""
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MISSING = ["-DCMAKE_DISABLE_FIND_PACKAGE_" + name + "=ON" for name in ("TinyGLTF", "rosbag_storage", "rviz", "fcl")] + [
    "-DCURTAIN_" + name + "=NO" for name in ("embree3_LIBRARY", "embree4_LIBRARY", "pybind11_HEADERS")]
# Each part, and the package to install.
WITHOUT_ROS = {"Python module": "pybind11-dev", "curtain_export, glTF": "libtinygltf-dev"}
WITH_ROS = {"camera and lidar": "libembree-dev", "rviz display": "librviz-dev"}


def main():
    """Exit code 0: as it should be."""
    folder, arguments = sys.argv[1], sys.argv[2:]
    os.makedirs(os.path.join(folder, "devel/lib/python3/dist-packages"), exist_ok=True)
    done = subprocess.run(["cmake", "-S", ROOT, "-B", folder] + MISSING + arguments, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          universal_newlines=True, check=False)
    said = [line for line in done.stdout.splitlines() if "curtain_sim: " in line]
    expected = dict(WITHOUT_ROS)
    if any(line.endswith("node and nodelet: yes") for line in said):
        expected.update(WITH_ROS)
    missing = [part for part, package in expected.items()
               if not any(part + ": no: " in line and package in line for line in said)]
    if done.returncode != 0 or missing:
        print(done.stdout)
        print("not said to be left out: " + ", ".join(missing))
        return 1
    print("\n".join(said))
    return 0


if __name__ == "__main__":
    sys.exit(main())
