# SPDX-License-Identifier: BSD-3-Clause
"""The programs of docs/python.md run and print what the page says."""
import os
import re
import subprocess
import sys
import tempfile
import unittest

import testing

PROGRAM = re.compile(r"^```python (?P<name>\w+\.py)\n(?P<text>.*?)^```$(?P<between>.*?)^```text\n(?P<output>.*?)^```$", re.M | re.S)


class Page(unittest.TestCase):
    def test_programs_print_what_it_says(self):
        with open(os.path.join(testing.ROOT, "docs/python.md"), encoding="utf-8") as file:
            page = file.read()
        programs = list(PROGRAM.finditer(page))
        self.assertEqual(len(programs), page.count("```python"))
        self.assertGreaterEqual(len(programs), 4)
        with tempfile.TemporaryDirectory() as folder:
            for program in programs:
                with self.subTest(program["name"]):
                    self.assertNotIn("```", program["between"])
                    path = os.path.join(folder, program["name"])
                    with open(path, "w", encoding="utf-8") as file:
                        file.write(program["text"])
                    # A minute, or it hangs: as several threads once did that were the first to ask for an array.
                    result = subprocess.run([sys.executable, path], cwd=testing.ROOT, stdout=subprocess.PIPE,
                                            stderr=subprocess.STDOUT, text=True, timeout=60, check=False)
                    self.assertEqual(result.stdout, program["output"])

    def test_the_environment_opens_its_curtain(self):
        path = os.path.join(testing.ROOT, "docs/examples/open_curtain.py")
        result = subprocess.run([sys.executable, path], stdout=subprocess.PIPE, text=True, timeout=60, check=True)
        self.assertRegex(result.stdout, r"^opening 0\.8\d after \d+ steps\n$")


if __name__ == "__main__":
    unittest.main()
