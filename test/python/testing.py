# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the Python module share. They run by ctest, which says where the module is, or so:

  PYTHONPATH=build/devel/lib/python3/dist-packages python3 -m unittest discover -s test/python -p '*_test.py'
"""
import gc
import os
import resource

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def scene(**changes):
    """A small cloth that swings in a wind; changes: other parts of the scene."""
    values = {
        "cloth": {"rows": 8, "columns": 6, "height": 1.0, "width": 0.8},
        "hang": {"from": [0.0, 0.0, 2.0], "to": [0.8, 0.0, 2.0], "tilt": 0.5},
        "air": {"inside": 0.4, "border": 0.4, "corner": 0.4},
        "wind": [{"id": "fan", "position": [0.4, -1.0, 1.5], "direction": [0.0, 1.0, 0.0], "pressure": 2.0}],
    }
    values.update(changes)
    return values


BALL = {"name": "ball", "shape": "sphere", "radius": 0.2, "position": [0.4, 0.5, 1.4]}


def memory():
    """Resident memory of this process [bytes]."""
    gc.collect()
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * resource.getpagesize()
