#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The pages tell of this checkout: links and anchors lead somewhere, commands and options exist, what the code offers is described.

Run without arguments. Needs no ROS and no build.
"""
import csv
import glob
import os
import re
import shlex
import subprocess
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FOLDERS = "src|test|docs|config|include|scripts|launch|msg|cmake"
FENCE = re.compile(r"^```(?P<kind>\w*)[^\n]*\n(?P<text>.*?)^```$", re.M | re.S)
LINK = re.compile(r"\]\((?P<target>[^)\s]+)\)")
PATH = re.compile(r"(?<![\w/.~-])(?:%s)/[\w./*-]*[\w*/]" % FOLDERS)
# What a page may use that is not ours.
FOREIGN = {"cd", "cp", "source", "echo", "cmake", "catkin_make", "doxygen", "rostopic", "rosrun", "roslaunch", "rosparam", "roscore",
           "export", "python3", "rosbag", "rosdep", "blender"}

USAGE = {"curtain_batch": "src/batch/options.cpp", "curtain_fit": "src/fit/options.cpp", "curtain_export": "src/curtain_export.cpp"}  # where a program's options are listed


def read(path):
    """A file of the checkout."""
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def find(pattern):
    """Files of the checkout, relative."""
    return sorted(os.path.relpath(path, ROOT) for path in glob.glob(os.path.join(ROOT, pattern), recursive=True))


def pages():
    """README and the book."""
    return ["README.md"] + find("docs/**/*.md")


def new_files(page):
    """Paths that a page tells to create: blocks that name a file after the language. From any folder above."""
    paths = re.findall(r"^```\w+ (\S+)$", read(page), re.M)
    return {path[start:] for path in paths for start in [0] + [m.end() for m in re.finditer("/", path)]}


def anchors(path):
    """Of a page's headings, as they are made where pages are shown."""
    found, counts = set(), {}
    for title in re.findall(r"^#+ +(.*)$", FENCE.sub("", read(path)), re.M):
        title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title)
        slug = re.sub(r"[^\w\- ]", "", title.strip().lower()).replace(" ", "-")
        count = counts.get(slug, 0)
        counts[slug] = count + 1
        found.add(slug if count == 0 else "%s-%d" % (slug, count))
    return found


def all_ros():
    """The text of the ROS floor and the programs."""
    return "\n".join(read(path) for path in find("src/ros/**/*.cpp") + find("src/ros/**/*.h") + find("src/curtain_node*.cpp"))


def names_of_calls(text, functions):
    """First arguments of calls, where these are literals or constants."""
    names = set()
    for call in re.finditer(r"\b(?:%s)(?:<[^()]*?>)?\(\s*(?P<first>\"[^\"]*\"|k\w+)" % functions, text):
        first = call["first"]
        if first.startswith("k"):
            value = re.search(r"\b%s\b[^=;]*=\s*\"([^\"]*)\"" % first, text)
            first = value[0][value[0].index('"'):] if value else '"%s, whose value can not be told"' % first
        names.add(first.strip('"'))
    return names


def described(name, page):
    """A page has the name as code, with or without a sign for the private namespace or fields behind it."""
    return re.search(r"`~?/?%s(?:/…)?`" % re.escape(name), page) is not None


def agrees(test, program, *arguments):
    """What a program would write is there."""
    result = subprocess.run([sys.executable, program, *arguments, "--check"], stderr=subprocess.PIPE, text=True, cwd=ROOT)
    test.assertEqual(result.returncode, 0, result.stderr)


class Links(unittest.TestCase):
    """What pages point at."""

    def test_links_and_anchors_lead_somewhere(self):
        count = 0
        for page in pages():
            for link in LINK.finditer(FENCE.sub("", read(page))):
                target = link["target"]
                if re.match(r"\w+://", target):
                    continue
                count += 1
                path, _, anchor = target.partition("#")
                full = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
                with self.subTest(page=page, link=target):
                    self.assertTrue(os.path.exists(os.path.join(ROOT, full)), "there is no " + full)
                    if anchor:
                        self.assertIn(anchor, anchors(full))
        self.assertGreater(count, 100)

    def test_links_by_name_are_defined_and_used(self):
        count = 0
        for page in pages():
            text = re.sub(r"`[^`\n]*`", "", FENCE.sub("", read(page)))
            used = set(re.findall(r"\]\[([^\]\[]+)\]", text))
            count += len(used)
            with self.subTest(page=page):
                self.assertEqual(used, set(re.findall(r"^\[([^\]]+)\]: \w+://\S+$", text, re.M)))
        self.assertGreater(count, 50)

    def test_paths_in_the_text_exist(self):
        count = 0
        for page in pages():
            created = new_files(page)
            for path in PATH.findall(LINK.sub("", read(page))):
                count += 1
                with self.subTest(page=page, path=path):
                    self.assertTrue(path in created or find(path), "there is no " + path)
        self.assertGreater(count, 50)

    def test_functions_in_the_text_exist(self):
        code = "\n".join(map(read, find("src/**/*.h") + find("src/**/*.cpp") + find("include/**/*.h")))
        count = 0
        for page in pages():
            for owner, name in re.findall(r"`(?:(\w+)::)?(\w+)\(\)", FENCE.sub("", read(page))):
                count += 1
                with self.subTest(page=page, function=name):
                    self.assertTrue(re.search(r"\b%s\(" % name, code), "there is no %s()" % name)
                    self.assertTrue(re.search(r"\b%s\b" % owner, code), "there is no " + owner)
        self.assertGreater(count, 30)

    def test_the_index_names_every_page(self):
        index = read("docs/README.md")
        for page in find("docs/**/*.md"):
            name = os.path.relpath(page, "docs")
            if name != "README.md":
                self.assertIn("](%s)" % name, index)


class Figures(unittest.TestCase):
    """What pages tell of measurements is what the tables have."""

    def test_figures_in_the_text(self):
        agrees(self, "docs/make_figures.py")

    def test_every_table_says_of_which_commit_it_is(self):
        stamps = list(csv.DictReader(read("docs/bench/stamps.csv").splitlines()))
        self.assertEqual(len({stamp["sources"] for stamp in stamps}), 1, "studies of different sources")
        for path in find("docs/bench/*.csv"):
            name = os.path.basename(path)[:-4]
            stamped = any(name == stamp["study"] or name.startswith(stamp["study"] + "_") for stamp in stamps)
            with self.subTest(table=path):
                self.assertTrue(stamped or name == "stamps" or "commit" in read(path).splitlines()[0].split(","))

    def test_pages_of_tables(self):
        for program, folder in (("bench/page.py", "docs/bench"), ("test/stress/page.py", "docs/stress"), ("test/judge/page.py", "docs/stress")):
            with self.subTest(folder=folder):
                agrees(self, program, folder)


class Commands(unittest.TestCase):
    """What pages tell to type."""

    def commands(self, page):
        """Words of every command in a page's blocks, and of those in its text that call something of ours."""
        text = read(page)
        for block in FENCE.finditer(text):
            if block["kind"] not in ("", "sh", "bash"):
                continue
            lines = [re.sub(r"\s+#.*$", "", line) for line in block["text"].replace("\\\n", " ").splitlines()]
            commands = [part.split() for line in lines for part in re.split(r"&&|;(?![^'{]*})", line) if part.strip()]
            if any(self.is_command(words) for words in commands):
                yield from commands
        for code in re.findall(r"`([^`\n]+)`", FENCE.sub("", text)):
            words = code.split()
            ours = re.match(r"(scripts|test/\w+)/\w+$", words[0]) and len(words) > 1
            if ours or words[0] in ("roslaunch", "rosrun", "doxygen") or (words[0] == "curtain_batch" and len(words) > 1):
                yield words

    @staticmethod
    def is_command(words):
        return words[0] in FOREIGN or re.match(r"(scripts|test|build-engine)/", words[0]) is not None

    def test_commands_and_their_options_exist(self):
        count = 0
        for page in pages():
            for words in self.commands(page):
                while re.match(r"\w+=", words[0]):  # environment
                    words = words[1:]
                count += 1
                with self.subTest(page=page, command=" ".join(words)):
                    self.check(words, page)
        self.assertGreater(count, 25)

    def check(self, words, page):
        program, arguments = words[0], words[1:]
        if program == "rosrun" and arguments[:2] == ["curtain_sim", "curtain_export"]:
            program, arguments = "curtain_export", arguments[2:]
        if os.path.basename(program) in USAGE:
            self.check_batch(os.path.basename(program), arguments, page)
        elif program.startswith("build/"):
            self.assertTrue(new_files(page), "nothing on this page makes it")
        elif "/" in program:
            self.assertTrue(os.access(os.path.join(ROOT, program), os.X_OK), "can't be run")
            for option in [word for word in arguments if word.startswith("-")]:
                ctest = program == "scripts/test" and option in subprocess.check_output(["ctest", "--help"], text=True)
                self.assertTrue(ctest or option in read(program), "no option " + option)
            if program == "scripts/demo" and arguments and not arguments[0].startswith("-"):
                self.check_demo(arguments[0])
            if program == "test/sanitize/run":
                self.assertTrue(os.path.exists(os.path.join(ROOT, "test/sanitize", arguments[0] + ".bash")))
        elif program == "roslaunch":
            self.check_launch(arguments, page)
        elif program == "rosrun" and arguments[0] == "curtain_sim":
            built = re.search(r"add_executable\(%s " % arguments[1], "\n".join(map(read, ["CMakeLists.txt"] + find("cmake/*.cmake"))))
            self.assertTrue(built or os.path.exists(os.path.join(ROOT, "scripts", arguments[1])))
        elif program == "rostopic":
            self.check_topic(arguments)
        elif program == "cmake":
            options = "\n".join(map(read, ["CMakeLists.txt"] + find("cmake/*.cmake")))
            for option in re.findall(r"-D(CURTAIN_\w+)", " ".join(arguments)):
                self.assertRegex(options, r"(option|set)\(%s " % option)
        elif program == "doxygen":
            self.assertTrue(os.path.exists(os.path.join(ROOT, arguments[0])))
        else:
            self.assertIn(program, FOREIGN)

    def check_scene(self, name, page):
        path = "config/scenes/%s.yaml" % name
        self.assertTrue(os.path.exists(os.path.join(ROOT, path)) or path in new_files(page), "there is no " + path)

    def check_demo(self, name):
        self.assertTrue(os.path.exists(os.path.join(ROOT, "config/demos", name, "demo.yaml")), "there is no demo " + name)

    def check_batch(self, program, arguments, page):
        usage = read(USAGE[program])
        for word in arguments:
            if word.startswith("-"):
                self.assertIn("  %s " % word, usage.replace('"', " ") + "  --help ")
        if arguments and arguments[0].startswith("config/"):
            self.assertTrue(os.path.exists(os.path.join(ROOT, arguments[0])) or arguments[0] in new_files(page))

    def check_launch(self, arguments, page):
        arguments = shlex.split(" ".join(arguments))
        self.assertEqual(arguments[0], "curtain_sim")
        launch = read("launch/" + arguments[1])
        for word in arguments[2:]:
            name, sign, value = word.partition(":=")
            if not sign:
                self.assertEqual(word, "--ros-args")
                continue
            self.assertIn('<arg name="%s"' % name, launch)
            if name == "scene":
                self.check_demo(value) if arguments[1] == "demo.launch" else self.check_scene(value, page)

    def check_topic(self, arguments):
        words = [word for word in arguments[1:] if not re.match(r"-|\d+$", word)]
        topic = words[0].split("/")[-1] if arguments[0] == "pub" else words[0].split("/curtain_node/")[1].split("/")[0]
        if arguments[0] == "pub" and not words[1].startswith("curtain_sim/"):
            return  # to another node
        self.assertIn(topic, Described.topics())
        if arguments[0] != "pub":
            return
        message = read("msg/%s.msg" % words[1].split("/")[1])
        depth, value = 0, " ".join(words[2:]).strip("'")
        for token in re.findall(r"[{}]|\w+(?=:)", value):
            depth += {"{": 1, "}": -1}.get(token, 0)
            if depth == 1 and token not in "{}":
                self.assertRegex(message, r"(?m)^\S+ %s\b" % token)

    def test_options_in_the_text_exist(self):
        programs = list(USAGE.values()) + find("scripts/*") + find("test/*/run") + find("test/**/main.cpp")
        known = "\n".join(read(path) for path in programs if os.path.isfile(os.path.join(ROOT, path)))
        for page in pages():
            for option in re.findall(r"`(--[a-z][a-z-]*)", FENCE.sub("", read(page))):
                with self.subTest(page=page, option=option):
                    self.assertIn(option, known)


class Described(unittest.TestCase):
    """What the code offers is on a page."""

    @staticmethod
    def topics():
        text = all_ros()
        found = names_of_calls(text, "advertise|subscribe|resolveName|advertiseService|InteractiveMarkerServer|SimpleActionServer")
        found |= set(re.findall(r"\{\"(\w+)\", Mailbox<", text))
        found |= set(re.findall(r"return \"(\w+)/\" \+ frame", text))
        found = {name.rstrip("/") for name in found}  # what begins with it has a name of the scene behind it
        return found | {"handles/" + name for name in ("update", "update_full", "feedback") if "handles" in found}

    def all_described(self, names, page, least):
        self.assertGreaterEqual(len(names), least, "looked in the wrong place")
        text = read(page)
        missing = sorted(name for name in names if not described(name, text))
        self.assertEqual(missing, [], "not in %s" % page)

    def test_made_pages_are_up_to_date(self):
        agrees(self, "docs/make_pages.py")

    def test_scene_keys(self):
        keys = set(re.findall(r"\bv\.\w+\((?:required\()?\"(\w+)\"", read("src/scene/fields.h")))
        lists = set(re.findall(r"\bv\.list\(\"(\w+)\"", read("src/scene/fields.h")))
        text = read("docs/keys.md")
        self.assertGreater(len(keys), 60)
        for key in keys:
            self.assertRegex(text, r"(?m)^(\| `([\w\[\]]+\.)?%s` \||## `%s%s`$)" % (key, key, r"\[\]" if key in lists else ""))

    def test_parameters(self):
        text = all_ros()
        table = read("src/ros/parameters/parameters.h")
        robot = set(re.findall(r"\bv\.\w+\(\"(\w+)\"", read("src/ros/parameters/robot.h")))
        self.all_described({"robot/" + name for name in robot}, "docs/keys.md", 5)
        self.all_described({"robot/" + name for name in robot}, "docs/robot.md", 5)
        sensing = read("src/sensing/sensor_params.h")
        tables = {kind: set(re.findall(r"\bv\.\w+\(\"(\w+)\"", body)) for kind, body in
                  re.findall(r"struct Fields<(\w+)Params> \{(.*?)\n\};", sensing, re.S)}
        points = tables["Sensor"] | {"%s/%s" % (kind.lower(), name) for kind in ("Camera", "Lidar") for name in tables[kind]}
        self.all_described({"points/" + name for name in points}, "docs/keys.md", 25)
        self.all_described(points - {"camera", "lidar"}, "docs/sensors.md", 25)
        names = set(re.findall(r"\bv\.\w+\(\"(\w+)\"", table)) | names_of_calls(text, r"param|getParam|searchParam")
        self.all_described(names, "docs/node.md", 15)
        self.all_described(names, "docs/keys.md", 15)

    def test_topics_services_and_actions(self):
        self.all_described(self.topics() - {"handles"}, "docs/node.md", 8)

    def test_diagnostics(self):
        self.all_described(names_of_calls(read("src/ros/health/diagnostics.cpp"), "add"), "docs/node.md", 5)

    def test_warnings_of_the_log(self):
        """What is quoted between placeholders (… and capitals), colons and commas stands in the sources, string by string."""
        sources = "".join(read(path) for folder in ("ros", "scene") for path in find("src/%s/**/*.[ch]*" % folder))
        strings = re.sub(r"\"\s*\n\s*\"", "", sources)
        table = read("docs/troubleshooting.md").split("## What the log's warnings mean")[1].split("## ")[0]
        warnings = re.findall(r"^\| `([^`]+)` \|", table, re.M)
        self.assertGreater(len(warnings), 6)
        for warning in warnings:
            for part in re.split(r"…|\b[A-Z]\b|[:,] ", warning):
                self.assertTrue(part.strip() in strings, "%s: '%s' is said nowhere" % (warning, part.strip()))

    def test_messages_and_statistics(self):
        for path in find("msg/*.msg"):
            fields = re.findall(r"^[\w/\[\]]+ +(\w+)", read(path), re.M)
            self.all_described(fields, "docs/messages.md", 1)
        self.all_described(re.findall(r"^\w+ +(\w+)", read("msg/Statistics.msg"), re.M), "docs/messages.md", 30)

    def test_version_of_snapshots(self):
        version = re.search(r"kSnapshotVersion = (\d+)", read("src/simulator/snapshot_format.h")).group(1)
        self.assertIn("format version, %s |" % version, read("docs/snapshots.md"))

    def test_statistics_of_curtain_batch(self):
        text = read("src/simulator/api/export.cpp")
        keys = set(re.findall(r"json\[\"(\w+)\"\]", text)) | set(re.findall(r"\{\"(\w+)\", ", text))
        names = {count: set(re.findall(r"\"(\w+)\"", list)) for count, list in
                 re.findall(r"(\w+)> kNames = \{(.*?)\}", read("src/simulator/simulator.cpp"), re.S)}
        stages, qualities = names["kStageCount"], names["kFrameQualityCount"]
        self.assertEqual((len(stages), len(qualities)), (7, 5))
        self.all_described(keys | stages | qualities, "docs/batch.md", 40)
        table = read("docs/architecture.md")
        for stage in stages:
            self.assertRegex(table, r"(?m)^\| %s \|" % stage)

    def test_options_of_programs(self):
        for program, page, least in (("curtain_batch", "docs/batch.md", 10), ("curtain_fit", "docs/fit.md", 10), ("curtain_export", "docs/bags.md", 5)):
            options = set(re.findall(r"\"  (--[\w-]+)", read(USAGE[program])))
            text = read(page)
            self.assertGreater(len(options), least)
            for option in options:
                self.assertRegex(text, r"`%s[ `]" % option)

    def test_arguments_of_launch_files(self):
        for name, page in (("record", "docs/bags.md"), ("replay", "docs/bags.md"), ("many_curtains", "docs/many.md")):
            arguments = re.findall(r'^  <arg name="(\w+)"', read("launch/%s.launch" % name), re.M)
            self.assertGreater(len(arguments), 5)
            for argument in set(arguments) - {"output", "delay", "rviz_config"}:
                self.assertIn("`%s`" % argument, read(page), name)

    def test_methods(self):
        names = re.search(r"methodNames\(\) \{.*?\{(.*?)\}", read("src/scene/names.cpp"), re.S)[1]
        text = read("docs/method.md")
        for name in re.findall(r"\"(\w+)\"", names):
            self.assertRegex(text, r"(\*\*|`|### )%s\b" % name)

    def test_scenes_and_launch_arguments(self):
        start = read("docs/start.md")
        for path in find("config/scenes/*.yaml"):
            self.assertIn("| `%s` |" % os.path.splitext(os.path.basename(path))[0], start)
        for path in find("launch/*.launch"):
            for argument in re.findall(r"^  <arg\b.*?/>", read(path), re.M | re.S):
                self.assertRegex(argument, r'doc="[^"]{5,}"', path)

    def test_public_headers(self):
        text = read("docs/architecture.md")
        for path in find("include/curtain_sim/*.h"):
            self.assertIn("(../%s)" % path, text)


if __name__ == "__main__":
    unittest.main()
