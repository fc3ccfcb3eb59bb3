# SPDX-License-Identifier: BSD-3-Clause
"""Types and docstrings of the module are those of its code, and it has what the engine's Simulator has."""
import ast
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import curtain_engine

import testing

STUB = os.path.join(os.path.dirname(curtain_engine.__file__), "__init__.pyi")

# Methods of Simulator that Python has under another name than their own in snake_case.
RENAMED = {
    "copyPositions": "positions", "copyVelocities": "velocities", "copyForces": "forces", "copyContactForces": "contact_forces",
    "copyTensions": "warp_tensions", "copyRestLengths": "rest_lengths", "copyRods": "rods", "copyFineMesh": "fine_positions",
    "fineMeshTopology": "fine_triangles", "copyContactPoints": "contact_points", "copyLineTensions": "line_tensions",
    "position": "positions", "mass": "masses", "obstacleCount": "obstacles", "finePiercings": "piercings", "drives": "drive",
}
# And what Python does without: revision() is for caches in C++; a shape can't be asked yet.
WITHOUT = {"revision", "obstacleShape"}


def public(names):
    return {name for name in names if not name.startswith("_")}


def arguments(function):
    """Names, kinds and defaults of a function's parameters, without types. An infinite default is ... in a stub."""
    parameters = function.args
    defaults = [ast.unparse(value).replace("inf", "...") for value in parameters.defaults]
    only = [ast.unparse(value).replace("inf", "...") if value else None for value in parameters.kw_defaults]
    return [one.arg for one in parameters.args], defaults, [one.arg for one in parameters.kwonlyargs], only


@unittest.skipIf(sys.version_info < (3, 9), "ast.unparse came with Python 3.9")
class Stub(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with open(STUB, encoding="utf-8") as file:
            cls.stub = ast.parse(file.read())
        cls.classes = {node.name: node for node in cls.stub.body if isinstance(node, ast.ClassDef) and not node.name.startswith("_")}

    def test_names_are_those_of_the_module(self):
        self.assertEqual(set(self.classes), public(dir(curtain_engine)))
        for name, node in self.classes.items():
            functions = {entry.name for entry in node.body if isinstance(entry, ast.FunctionDef)}
            self.assertEqual(public(functions), public(dir(getattr(curtain_engine, name))), name)
        self.assertTrue(os.path.exists(os.path.join(os.path.dirname(STUB), "py.typed")))

    def test_parameters_are_those_of_the_code(self):
        count = 0
        for name, node in self.classes.items():
            for entry in node.body:
                if not isinstance(entry, ast.FunctionDef):
                    continue
                member = vars(getattr(curtain_engine, name))[entry.name]
                decorators = [ast.unparse(decorator) for decorator in entry.decorator_list]
                with self.subTest(name + "." + entry.name):
                    self.assertEqual(isinstance(member, property), "property" in decorators)
                    if isinstance(member, property):
                        self.assertIsNone(member.fset)
                        continue
                    # pybind11 writes the signature in front of what the code says of the function.
                    signature = getattr(getattr(curtain_engine, name), entry.name).__doc__.splitlines()[0]
                    code = ast.parse("def %s: ..." % signature).body[0]
                    self.assertEqual(arguments(entry), arguments(code))
                    count += 1
        self.assertGreater(count, 50)

    def test_everything_has_a_docstring(self):
        self.assertIn("SI units", curtain_engine.__doc__)
        for name in self.classes:
            kind = getattr(curtain_engine, name)
            self.assertGreater(len(kind.__doc__), 50)
            for member in public(dir(kind)):
                text = re.sub(r"^\w+\(.*\n\n?", "", getattr(kind, member).__doc__)
                self.assertGreater(len(text), 10, "%s.%s" % (name, member))

    def test_has_what_the_engines_simulator_has(self):
        with open(os.path.join(testing.ROOT, "include/curtain_sim/simulator.h"), encoding="utf-8") as file:
            body = file.read().split("class Simulator {")[1].split(" private:")[0]
        methods = set(re.findall(r"^  [\w:<>&, ]+?[ &](\w+)\([^;]*;", body, re.M)) - {"Simulator"}
        self.assertGreater(len(methods), 70)
        for method in methods - WITHOUT:
            name = RENAMED.get(method) or re.sub(r"[A-Z]", lambda letter: "_" + letter[0].lower(), method)
            self.assertTrue(hasattr(curtain_engine.Simulator, name), "no %s for %s()" % (name, method))

    @unittest.skipUnless(shutil.which("mypy"), "mypy is not installed (Debian: mypy)")
    @unittest.skipUnless(importlib.util.find_spec("numpy.typing"), "this NumPy has no types, as those before 1.21")
    def test_mypy_takes_the_example_and_sees_mistakes(self):
        with tempfile.TemporaryDirectory() as folder:
            wrong = os.path.join(folder, "wrong.py")
            with open(wrong, "w", encoding="utf-8") as file:
                file.write("import curtain_engine\nsim = curtain_engine.Simulator({})\n")
                file.write("sim.step('2')\nsim.positions.nope\nsim.energy['heat']\n")
            environment = dict(os.environ, MYPYPATH=os.path.dirname(os.path.dirname(STUB)))
            result = subprocess.run(["mypy", "--strict", "--cache-dir", folder, os.path.join(testing.ROOT, "docs/examples/open_curtain.py"), wrong],
                                    env=environment, stdout=subprocess.PIPE, text=True, check=False)
        self.assertIn("Found 3 errors in 1 file (checked 2 source files)", result.stdout)
        self.assertEqual(re.findall(r"wrong.py:(\d+): error", result.stdout), ["3", "4", "5"])


if __name__ == "__main__":
    unittest.main()
