# SPDX-License-Identifier: BSD-3-Clause
"""Scenes from dicts, text and files, and back, with the errors of the scene file's reader."""
import math
import os
import pickle
import subprocess
import tempfile
import unittest

import curtain_engine
import numpy

import testing

SCENES = os.path.join(testing.ROOT, "config", "scenes")


def error(function, *arguments):
    """Text of the ValueError that the call raises."""
    try:
        function(*arguments)
    except ValueError as refused:
        return str(refused)
    raise AssertionError("nothing was refused")


class Scenes(unittest.TestCase):
    def test_every_scene_file_comes_back_from_dict_and_text(self):
        files = [name for name in sorted(os.listdir(SCENES)) if name.endswith(".yaml")]
        self.assertGreater(len(files), 5)
        for name in files:
            with self.subTest(name):
                scene = curtain_engine.Scene.from_file(os.path.join(SCENES, name))
                self.assertEqual(curtain_engine.Scene(scene.to_dict()), scene)
                self.assertEqual(curtain_engine.Scene.from_yaml(scene.to_yaml()), scene)
                self.assertEqual(pickle.loads(pickle.dumps(scene)), scene)

    def test_values_keep_their_bits_and_types(self):
        # 1e-06 is how Python writes it and text in YAML 1.1; 0.1 + 0.2 needs 17 digits; the names look like numbers.
        scene = testing.scene(
            wind=[{"id": name, "pressure": 0.1 + 0.2, "start": 1e-06, "end": math.inf} for name in ("1e-6", "true", "7", "é")],
            drag=[{"id": "a", "node": (7, 0), "force": numpy.array([0, 1e-300, 1], dtype=float)}],
            solver={"seed": 2**64 - 1, "frame_rate": numpy.float32(50), "substeps": numpy.int64(3)})
        values = curtain_engine.Scene(scene).to_dict()
        self.assertEqual([wind["id"] for wind in values["wind"]], ["1e-6", "true", "7", "é"])
        wind = values["wind"][0]
        self.assertEqual((wind["pressure"], wind["start"], wind["end"], wind["shadow"]), (0.1 + 0.2, 1e-06, math.inf, False))
        self.assertEqual(values["drag"][0]["node"], [7, 0])
        self.assertEqual(values["drag"][0]["force"], [0.0, 1e-300, 1.0])
        self.assertEqual((values["solver"]["seed"], values["solver"]["frame_rate"], values["solver"]["substeps"]), (2**64 - 1, 50.0, 3))
        self.assertNotEqual(curtain_engine.Scene(scene), curtain_engine.Scene(testing.scene()))

    def test_text_that_is_wholly_a_number_is_that_number(self):
        scene = curtain_engine.Scene(testing.scene(solver={"stretch_tolerance": str(3e-06), "substeps": "3"}))
        self.assertEqual(scene.to_dict()["solver"]["stretch_tolerance"], 3e-06)
        self.assertEqual(scene.to_dict()["solver"]["substeps"], 3)
        self.assertIn('is the text "3e-06 m"', error(curtain_engine.Scene, testing.scene(solver={"stretch_tolerance": "3e-06 m"})))

    def test_a_motion_keeps_the_pose_that_it_does_not_say(self):
        lying = [0.0, 0.6, 0.0, 0.8]
        bar = {"name": "bar", "shape": "capsule", "radius": 0.1, "length": 1.0, "position": [1, 2, 3], "orientation": lying,
               "motion": [{"time": 0.0, "position": [0, 0, 0]}, {"time": 1.0}]}
        poses = curtain_engine.Scene(testing.scene(obstacles=[bar])).to_dict()["obstacles"][0]["motion"]
        self.assertEqual([pose["orientation"] for pose in poses], [lying, lying])
        self.assertEqual([pose["position"] for pose in poses], [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]])

    def test_problems_have_the_texts_that_curtain_batch_prints(self):
        text = "cloth: {rows: 1, colums: 3, width: \"2 m\"}\nwind: [{id: a, radius: -1}]\npins: 7\n"
        values = {"cloth": {"rows": 1, "colums": 3, "width": "2 m"}, "wind": [{"id": "a", "radius": -1}], "pins": 7}
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.yaml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            batch = subprocess.run([os.environ["CURTAIN_BATCH"], path], stderr=subprocess.PIPE, text=True, check=False)
            self.assertEqual(batch.returncode, 2)
            of_file = error(curtain_engine.Scene.from_file, path)
            self.assertIn(of_file, batch.stderr)
        self.assertIn("cloth.colums: is not a known key, did you mean columns?", of_file)
        self.assertEqual(len(of_file.splitlines()), 6)
        self.assertEqual(error(curtain_engine.Scene.from_yaml, text), of_file.replace(path + ": ", ""))
        self.assertEqual(error(curtain_engine.Scene, values), of_file.replace(path + ": ", ""))
        self.assertEqual(error(curtain_engine.Simulator, values), error(curtain_engine.Scene, values))

    def test_refuses_what_has_no_place_in_a_scene(self):
        ring = {}
        ring["cloth"] = ring
        for values, text in [({"pins": {1, 2}}, "pins: must be a number, text, a list or a dict, is a set"),
                             ({"wind": [{"id": object()}]}, "wind[0].id: must be a number, text, a list or a dict, is a object"),
                             ({1: 2}, "a key must be text, is 1"), (ring, "is nested too deeply"),
                             ({"wind": [{"id": "\ud800"}]}, "wind[0].id: is no text that UTF-8 has"),
                             ({"cloth": {"rows": numpy.nan, "columns": None}}, "cloth.rows: must be an integer in [2, 4096], is .nan"),
                             ({"cloth": {"rows": 8, "columns": None}}, "cloth.columns: must be an integer in [2, 4096], is empty")]:
            with self.subTest(text):
                self.assertIn(text, error(curtain_engine.Scene, values))
        with self.assertRaisesRegex(TypeError, "must be a Scene or a dict, is a str"):
            curtain_engine.Simulator("scene.yaml")
        self.assertIn("No such file", error(curtain_engine.Scene.from_file, "/no/such.yaml"))
        missing = testing.scene(obstacles=[{"name": "cup", "shape": "mesh", "mesh": "/no/cup.stl"}])
        self.assertIn("/no/cup.stl", error(curtain_engine.Simulator, missing))


if __name__ == "__main__":
    unittest.main()
