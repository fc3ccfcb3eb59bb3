# SPDX-License-Identifier: BSD-3-Clause
"""The scene of every run: the given one with the run's values in it. Which keys there are, and which values they take, knows
curtain_batch --check alone."""
import copy
import hashlib
import os
import re
import subprocess
import tempfile
import urllib.parse

import yaml

from curtain_sweep.design import load_yaml
from curtain_sweep.problem import Problem, near

CHUNK = 1000  # scenes a call of curtain_batch --check: names of a few bytes, far below the longest command line


class Plain(yaml.SafeDumper):
    """Without anchors: what is given twice is written twice."""

    def ignore_aliases(self, data):
        return True


def put(scene, path, value):
    """Sets the key at a path like wind[0].pressure."""
    steps = [int(index) if index else name for name, index in re.findall(r"(\w+)(?![\w\]])|\[(\d+)\]", path)]
    place, way = scene, ""
    for step, following in zip(steps, steps[1:] + [None]):
        there = "%s[%d]" % (way, step) if isinstance(step, int) else "%s.%s" % (way, step) if way else step
        if isinstance(step, int):
            if not isinstance(place, list) or step >= len(place):
                raise Problem("%s: the scene has no %s" % (path, there))
        elif not isinstance(place, dict):
            raise Problem("%s: %s of the scene has no keys" % (path, way))
        elif following is not None and place.get(step) is None:
            if isinstance(following, int):
                raise Problem("%s: the scene has no list %s%s" % (path, there, near(step, place)))
            place[step] = {}
        if following is None:
            place[step] = copy.deepcopy(value)
        else:
            place, way = place[step], there


class Scenes:
    """The scenes of all runs, as text, and the mesh files they need beside them."""

    def __init__(self, path, design):
        self.base = load_yaml(path)
        if not isinstance(self.base, dict):
            raise Problem("%s: is no scene" % path)
        self.folder = os.path.dirname(os.path.abspath(path))
        self.meshes = {}  # name beside the scenes: path
        self.texts = [self.text(design, values) for values in design.runs()]
        self.names = ["%0*d" % (len(str(len(self.texts))), n + 1) for n in range(len(self.texts))]

    def text(self, design, values):
        """A run's scene."""
        scene = copy.deepcopy(self.base)
        for parameter, value in zip(design.parameters, values):
            put(scene, parameter.name, value)
        for obstacle in scene.get("obstacles") or []:
            if isinstance(obstacle, dict) and isinstance(obstacle.get("mesh"), str):
                obstacle["mesh"] = self.bring(obstacle["mesh"])
        return yaml.dump(scene, Dumper=Plain, sort_keys=False, default_flow_style=None, width=100)

    def bring(self, mesh):
        """The name of a copy beside the scenes, so that it comes to other machines with them; packages must be there."""
        scheme, _, rest = mesh.rpartition("://")
        if scheme not in ("", "file"):
            return mesh
        path = os.path.normpath(os.path.join(self.folder, urllib.parse.unquote(rest) if scheme else mesh))
        if not os.path.isfile(path):
            raise Problem("obstacles: there is no mesh file %s" % path)
        taken = {of: name for name, of in self.meshes.items()}
        name = taken.get(path, "mesh%d_%s" % (len(taken) + 1, os.path.basename(path)))
        self.meshes[name] = path
        return name

    def mesh_hashes(self):
        """Of the files' contents."""
        hashes = {}
        for name, path in self.meshes.items():
            with open(path, "rb") as file:
                hashes[name] = hashlib.sha256(file.read()).hexdigest()
        return hashes

    def write(self, folder):
        """Puts scenes and meshes into a folder."""
        for name, text in zip(self.names, self.texts):
            with open(os.path.join(folder, name + ".yaml"), "w", encoding="utf-8") as file:
                file.write(text)
        for name, path in self.meshes.items():
            with open(path, "rb") as source, open(os.path.join(folder, name), "wb") as file:
                file.write(source.read())

    def check(self, batch):
        """Has curtain_batch read all of them; the first that is wrong is the problem."""
        with tempfile.TemporaryDirectory(prefix="sweep-") as folder:
            self.write(folder)
            for first in range(0, len(self.names), CHUNK):
                names = self.names[first:first + CHUNK]
                answer = subprocess.run([batch, "--check"] + [name + ".yaml" for name in names], cwd=folder, text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
                if answer.returncode == 0:
                    continue
                bad = re.findall(r"^curtain_batch: (\w+)\.yaml: ", answer.stderr, re.M)
                if not bad:
                    raise Problem("%s --check: %s" % (batch, answer.stderr.strip() or "exit code %d" % answer.returncode))
                text = answer.stderr.split("\ncurtain_batch: ")[0].replace("curtain_batch: ", "")
                more = "" if len(bad) == 1 else " (and %d more scenes)" % (len(bad) - 1)
                raise Problem("run %s: %s%s" % (bad[0], text.strip().replace(bad[0] + ".yaml: ", ""), more))
