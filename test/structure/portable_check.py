#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The sources keep to what the oldest supported tools have: g++ 9, clang 11, Eigen 3.3, Embree 3.

  portable_check.py [COMPILER EIGEN_FOLDER]

With a folder of Eigen 3.3 (EIGEN_FOLDER/Eigen/Core), also compiles the public headers and the files with short vectors against it.
"""
import glob
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# Builtins of compilers, and the files that may use them; all are in g++ 9 and clang 11, but for what a file chooses by compiler.
BUILTINS = {
    "__builtin_ctz": None,
    "__builtin_shuffle": "src/cloth/shuffle.h",
    "__builtin_shufflevector": "src/cloth/shuffle.h",
}
# Names that Eigen has from 3.4 on, as they would be used here.
EIGEN_34 = re.compile(r"\bEigen::(?:seqN?|all|last|lastp1|indexing|Vector<|RowVector<)|\.(?:transformed|reshaped)\(")
EMBREE = re.compile(r"embree[34]/|RTCRayQueryContext|RTCIntersectContext|RTCIntersectArguments")
COMPILER, EIGEN = None, None


def sources(*patterns):
    """Files of the checkout, relative, and their texts without comments."""
    for pattern in patterns:
        for path in sorted(glob.glob(os.path.join(ROOT, pattern), recursive=True)):
            with open(path, encoding="utf-8") as file:
                yield os.path.relpath(path, ROOT), re.sub(r"//[^\n]*", "", file.read())


ALL = ("include/**/*.h", "src/**/*.h", "src/**/*.cpp", "test/**/*.h", "test/**/*.cpp",
       "bench/**/*.h", "bench/**/*.cpp")


class Portable(unittest.TestCase):
    def test_builtins_are_on_the_list(self):
        used = 0
        for name, text in sources(*ALL):
            for builtin in re.findall(r"__builtin_\w+", text):
                self.assertIn(builtin, BUILTINS, name)
                self.assertIn(BUILTINS[builtin], (None, name))
                used += 1
        self.assertGreater(used, 3, "looked in the wrong place")

    def test_eigen_is_used_as_of_3_3(self):
        for name, text in sources(*ALL):
            self.assertIsNone(EIGEN_34.search(text), name)

    def test_one_file_knows_the_version_of_embree(self):
        knowing = [name for name, text in sources(*ALL) if EMBREE.search(text)]
        self.assertEqual(knowing, ["src/sensing/embree.h"])

    def test_headers_and_short_vectors_compile_with_eigen_3_3(self):
        if not EIGEN:
            self.skipTest("no Eigen 3.3")
        names = [name for name, _ in sources("include/**/*.h")]
        names += [name for name, text in sources("src/**/*.cpp") if "/ros/" not in name and "rviz" not in name and
                  re.search(r"CURTAIN_WIDE|omp simd|simd8\.h|shuffle\.h", text)]
        self.assertGreater(len(names), 20)
        with tempfile.NamedTemporaryFile("w", suffix=".cpp") as file:
            file.writelines('#include "%s"\n' % os.path.join(ROOT, name) for name in names if name.endswith(".h"))
            file.flush()
            for path in [file.name] + [os.path.join(ROOT, name) for name in names if name.endswith(".cpp")]:
                done = subprocess.run([COMPILER, "-std=c++17", "-fsyntax-only", "-fopenmp-simd", "-I" + EIGEN, "-I" + ROOT + "/include",
                                       "-I" + ROOT + "/src", path], stderr=subprocess.PIPE, universal_newlines=True, check=False)
                self.assertEqual(done.returncode, 0, path + ":\n" + done.stderr)


def is_eigen_3_3(folder):
    """Whether Eigen 3.3 is there."""
    try:
        with open(os.path.join(folder, "Eigen/src/Core/util/Macros.h"), encoding="utf-8", errors="replace") as file:
            return re.search(r"#define EIGEN_MAJOR_VERSION 3\s", file.read()) is not None
    except OSError:
        return False


if __name__ == "__main__":
    if len(sys.argv) == 3:
        COMPILER, EIGEN = sys.argv[1], sys.argv[2] if is_eigen_3_3(sys.argv[2]) else None
    unittest.main(argv=sys.argv[:1])
