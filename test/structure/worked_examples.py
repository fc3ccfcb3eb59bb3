#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Does what some pages of docs say, in a copy of the sources, compiles it and runs its tests and scenes.

  worked_examples.py BUILD_FOLDER CURTAIN_BATCH [CMAKE_ARGUMENT ...]
  worked_examples.py --renew                 writes the pages' diffs anew, for the sources of today

Of a page count: diff blocks, applied in their order; and blocks that name a file after the language, "```cpp PATH". What comes of
it is built without optimisation; scenes need none of it and are run with the given curtain_batch. Copies are only written where
they differ, so that a second run compiles nothing.
"""
import difflib
import filecmp
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
COPIED = ("CMakeLists.txt", "cmake", "config", "docs/make_pages.py", "docs/keys.md", "include", "msg", "src", "test/float_traps.h",
          "test/known_keys.h", "test/scene", "package.xml")
# In this order; and how many files a page may change, beside those that are new.
PAGES = {"docs/add_a_force.md": 4, "docs/add_a_scheme.md": 6, "docs/add_a_scene.md": 0, "docs/add_a_constraint.md": 5}
BLOCK = re.compile(r"^```(?P<kind>\w+)(?: (?P<path>\S+))?\n(?P<text>.*?)^```$", re.M | re.S)
OUTER = """cmake_minimum_required(VERSION 3.16)
project(worked_examples CXX)
add_subdirectory(tree)
find_package(GTest REQUIRED)
file(GLOB tests CONFIGURE_DEPENDS {tests})
add_executable(test_examples ${{tests}} tree/test/scene/template_test.cpp)
set_target_properties(test_examples PROPERTIES CXX_STANDARD 17)
target_include_directories(test_examples PRIVATE tree/src tree/test)
target_compile_definitions(test_examples PRIVATE CURTAIN_SOURCE_DIR="${{CMAKE_CURRENT_SOURCE_DIR}}/tree")
target_link_libraries(test_examples PRIVATE curtain_engine GTest::gtest_main)
"""


def run(*command, **options):
    """A command that must succeed."""
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, **options)
    if result.returncode != 0:
        sys.exit("%s\n%s\nexit code %d" % (" ".join(command), result.stdout, result.returncode))
    return result.stdout


def write(path, text):
    """Makes a file with its folder."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def copy_sources(tree):
    """What the engine is built of."""
    for name in COPIED:
        source, target = os.path.join(ROOT, name), os.path.join(tree, name)
        if not os.path.exists(source):
            continue
        os.makedirs(os.path.dirname(target), exist_ok=True)
        (shutil.copytree if os.path.isdir(source) else shutil.copy)(source, target)


def read(path):
    """Text of a file."""
    with open(path, encoding="utf-8") as file:
        return file.read()


def files_of(diff):
    """What a diff changes."""
    return re.findall(r"^\+\+\+ b/(\S+)", diff, re.M)


def apply(diff, tree):
    """Applies a diff, on lines that have moved and between others than it was made for, too."""
    run("patch", "-p1", "--forward", "--no-backup-if-mismatch", "-d", tree, input=diff)


def as_of_today(page):
    """A page with the diffs that it would have if they were made now, each after those before it."""
    def renewed(block):
        if block["kind"] != "diff":
            return block[0]
        names = files_of(block["text"])
        before = {name: read(os.path.join(tree, name)).splitlines(True) for name in names}
        apply(block["text"], tree)
        diffs = [difflib.unified_diff(before[name], read(os.path.join(tree, name)).splitlines(True), "a/" + name, "b/" + name, n=2)
                 for name in names]
        return "```diff\n" + "".join(line for diff in diffs for line in diff) + "```"

    with tempfile.TemporaryDirectory() as folder:
        tree = os.path.join(folder, "tree")
        copy_sources(tree)
        return BLOCK.sub(renewed, read(os.path.join(ROOT, page)))


def follow(page, tree):
    """Does what a page says. Returns the new files that it names."""
    text = read(os.path.join(ROOT, page))
    places = re.compile(r"^@@ .* @@$", re.M)  # where lines are may change
    if places.sub("", text) != places.sub("", as_of_today(page)):
        sys.exit("%s: its diffs are of older sources; worked_examples.py --renew writes them anew" % page)
    created, changed = [], set()
    for block in BLOCK.finditer(text):
        if block["kind"] == "diff":
            changed.update(files_of(block["text"]))
            apply(block["text"], tree)
        elif block["path"]:
            write(os.path.join(tree, block["path"]), block["text"])
            created.append(block["path"])
    if not created:
        sys.exit("%s names no new file: nothing of it is tested" % page)
    if len(changed) > PAGES[page]:
        sys.exit("%s changes %d files, at most %d are wanted: %s" % (page, len(changed), PAGES[page], sorted(changed)))
    return created


def sync(new, old):
    """Makes the folder old what new is; files that are the same keep their times."""
    names = set()
    for folder, _, files in os.walk(new):
        for name in files:
            relative = os.path.relpath(os.path.join(folder, name), new)
            names.add(relative)
            source, target = os.path.join(new, relative), os.path.join(old, relative)
            if not os.path.exists(target) or not filecmp.cmp(source, target, shallow=False):
                os.makedirs(os.path.dirname(target), exist_ok=True)
                shutil.copyfile(source, target)
    for folder, _, files in os.walk(old):
        for name in files:
            if os.path.relpath(os.path.join(folder, name), old) not in names:
                os.remove(os.path.join(folder, name))


def check_scene(batch, scene):
    """A scene runs, the cloth comes to lie on something, and nothing goes through anything."""
    with tempfile.TemporaryDirectory() as folder:
        stats = os.path.join(folder, "stats.json")
        run(batch, scene, "--duration", "2", "--stats", stats)
        with open(stats, encoding="utf-8") as file:
            result = json.load(file)
    wrong = ["self_crossings"] if result["self_crossings"] != 0 else []
    wrong += ["piercings"] if any(result["piercings"].values()) else []
    wrong += ["stretch_max"] if max(result["stretch_max"].values()) > 1e-3 * (1.0 + 1e-9) else []
    wrong += ["wrenches"] if not any(any(wrench["force"]) for wrench in result["wrenches"].values()) else []
    if wrong or not result["finite"]:
        sys.exit("%s: %s in %s" % (scene, wrong, json.dumps(result)))


def main():
    if sys.argv[1:] == ["--renew"]:
        for page in PAGES:
            text = as_of_today(page)
            with open(os.path.join(ROOT, page), "w", encoding="utf-8") as file:
                file.write(text)
        return
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    build, batch, arguments = os.path.abspath(sys.argv[1]), sys.argv[2], sys.argv[3:]
    with tempfile.TemporaryDirectory() as folder:
        fresh = os.path.join(folder, "tree")
        copy_sources(fresh)
        created = [path for page in PAGES for path in follow(page, fresh)]
        run(sys.executable, os.path.join(fresh, "docs", "make_pages.py"))
        sync(fresh, os.path.join(build, "tree"))
    tests = [path for path in created if path.endswith("_test.cpp")]
    outer = os.path.join(build, "CMakeLists.txt")
    text = OUTER.format(tests=" ".join("tree/" + path for path in tests))
    if not os.path.exists(outer) or read(outer) != text:
        write(outer, text)
    objects = os.path.join(build, "objects")
    run("cmake", "-S", build, "-B", objects, "-DCMAKE_BUILD_TYPE=None", "-DCMAKE_CXX_FLAGS=-O0", "-DBUILD_TESTING=OFF",
        "-DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON", "-DCURTAIN_UNITY=ON", *arguments)
    run("cmake", "--build", objects, "-j2", "--target", "test_examples")
    print(run(os.path.join(objects, "test_examples")))
    scenes = [path for path in created if path.startswith("config/scenes/")]
    for scene in scenes:
        check_scene(batch, os.path.join(build, "tree", scene))
    print("%d pages followed, %d tests' files and %d scenes run" % (len(PAGES), len(tests), len(scenes)))


if __name__ == "__main__":
    main()
