#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes docs/keys.md from config/curtain.yaml and docs/messages.md from msg/*.msg, action/*.action and srv/*.srv:
docs/make_pages.py.
With --check it only says whether the pages are up to date.

A line of the template is a row of the page: key, value, and the comment behind it; so is a line of a message. A line that is
a comment as a whole belongs to the line above it where it stands below that one's comment, else to what follows.
"""
import glob
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TEMPLATE = os.path.join(ROOT, "config", "curtain.yaml")

KEY = re.compile(r"^(?P<indent> *)(?P<off># +)?(?P<item>- )?(?P<name>[a-z_]+):(?P<value>[^#]*?)(?: +# (?P<text>.*))?$")
FIELD = re.compile(r"^(?P<type>[\w/\[\]]+) +(?P<name>\w+)(?:=(?P<value>\w+))?(?: +# (?P<text>.*))?$")
COMMENT = re.compile(r"^(?P<indent> *)# ?(?P<text>.*)$")

KEYS_HEAD = """# Every key

Made by `docs/make_pages.py` from [config/curtain.yaml](../config/curtain.yaml); do not edit. A test fails when it is out of date.

The node reads its own parameters from its private namespace and the scene from `~scene`. A scene file for `curtain_batch` has at its
top level what the node has under `~scene`. Units are SI: m, kg, s, N, Pa, rad. Where a number is expected, text counts as a number if
all of it is one decimal number: `1e-6`, which YAML 1.1 reads as text, and `"0.5"`. In a scene "> 0" means 1e-9 to 1e9 and ">= 0"
means 0 to 1e9. Lengths that must fit each other may be rounded: a difference of less than 1e-4 of the length is accepted. Unknown
keys, wrong types and values out of range are errors; all of them are reported at once. A key that is *live* can be changed while the
node runs ([live tuning](node.md#live-tuning)); one that is *startup only* is read once, at start.

The column *value* has what the template shows. It is the default, unless the meaning says *required*, *no default* or another default.
[units.md](units.md) explains how numbers scale with the size of a scene.
"""

MESSAGES_HEAD = """# Messages

Made by `docs/make_pages.py` from [msg](../msg), [action](../action) and [srv](../srv); do not edit. A test fails when it is out of date.
[node.md](node.md) says which topic, action or service uses which type.
"""


class Section:
    """A table of the page: the keys of one map, or of the entries of one list."""

    def __init__(self, name, text=""):
        self.name, self.text, self.rows = name, text, []


def indent_of(match):
    """Depth of a key, as if its comment sign were not there."""
    return len(match["indent"]) + (len(match["off"]) - 2 if match["off"] else 0)


def read_sections(lines):
    """The node's parameters, then the scene's sections, in the template's order."""
    scene = Section("The scene")
    sections = [Section("The node"), scene]
    path, pending, comment_column, last = [], [], 0, None
    for line in lines:
        key = KEY.match(line)
        if key and key["off"] and key["text"] is None:
            key = None  # prose with a colon
        comment = COMMENT.match(line)
        if not key:
            if comment and last is not None and len(comment["indent"]) == comment_column:
                last[-1] += " " + comment["text"]
            elif comment and not comment["text"].startswith("--"):
                pending.append(comment["text"])
            else:
                pending, last = [], None
            continue
        depth = indent_of(key)
        while path and path[-1][0] >= depth + (2 if key["item"] else 0):
            path.pop()
        value, text = key["value"].strip(), key["text"] or ""
        comment_column = line.find("# ", line.find(":")) if text else -1
        parents = [name for _, name in path]
        path.append((depth + (2 if key["item"] else 0), key["name"]))
        if parents[:1] != ["scene"]:
            if key["name"] != "scene":
                sections[0].rows.append(["~" + "/".join(parents + [key["name"]]), value, text])
                last = sections[0].rows[-1]
            pending = []
        elif value in ("", "[]") and len(parents) == 1:
            sections.append(Section(key["name"] + ("[]" if value == "[]" else ""), " ".join(pending + [text])))
            last, pending = None, []
            if text:  # what continues the section's own comment
                last = _SectionText(sections[-1])
        else:
            top = len(parents) == 1
            target = scene if top else sections[-1]
            name = key["name"] if top else ".".join(parents[2:] + [key["name"]])
            target.rows.append([re.sub(r"^(motion|path|patches)\.", r"\1[].", name), value, text])
            last, pending = target.rows[-1], []
    return sections


class _SectionText:
    """Lets a comment that goes on be added to a section's text as to a row's."""

    def __init__(self, section):
        self.section = section

    def __getitem__(self, _):
        return self.section.text

    def __setitem__(self, _, text):
        self.section.text = text


def cell(text):
    """Text for a cell of a table."""
    return text.strip().replace("|", "\\|")


def read(path):
    """A file's text."""
    with open(path, encoding="utf-8") as file:
        return file.read()


def keys_page():
    """docs/keys.md."""
    text = KEYS_HEAD
    for section in read_sections(read(TEMPLATE).splitlines()):
        title = section.name if section.name.startswith("The ") else "`%s`" % section.name
        text += "\n## %s\n\n" % title
        if section.text.strip():
            says = section.text.strip().rstrip(".")
            text += says[0].upper() + says[1:] + ".\n\n"
        text += "| key | value | meaning |\n|---|---|---|\n"
        for name, value, meaning in section.rows:
            text += "| `%s` | %s | %s |\n" % (name, "`%s`" % cell(value) if value else "", cell(meaning))
    return text


def group(lines):
    """A message's parts: comments of their own lines, and the fields that follow them with theirs."""
    parts = [([], [])]
    for line in lines:
        field = FIELD.match(line)
        if field:
            kind = field["type"] + (" = " + field["value"] if field["value"] else "")
            parts[-1][1].append([field["name"], kind, field["text"] or ""])
        elif line.startswith("#"):
            if parts[-1][1]:
                parts.append(([], []))
            parts[-1][0].append(line[1:].strip())
        elif line.strip():
            parts[-1][1][-1][2] += " " + line.strip().lstrip("# ")
        elif parts[-1][0] and not parts[-1][1]:
            parts[-1][0].append("")
    return parts


def messages_page():
    """docs/messages.md."""
    text = MESSAGES_HEAD
    for path in sorted(glob.glob(os.path.join(ROOT, "msg", "*.msg"))):
        name = os.path.splitext(os.path.basename(path))[0]
        text += "\n## %s\n\n[msg/%s.msg](../msg/%s.msg)\n" % (name, name, name)
        text += fields_text(read(path))
    for path in sorted(glob.glob(os.path.join(ROOT, "action", "*.action"))):
        name = os.path.splitext(os.path.basename(path))[0]
        text += "\n## %s (action)\n\n[action/%s.action](../action/%s.action)\n" % (name, name, name)
        for part, fields in zip(("Goal", "Result", "Feedback"), read(path).split("---\n")):
            text += "\n**%s**\n" % part + fields_text(fields)
    for path in sorted(glob.glob(os.path.join(ROOT, "srv", "*.srv"))):
        name = os.path.splitext(os.path.basename(path))[0]
        text += "\n## %s (service)\n\n[srv/%s.srv](../srv/%s.srv)\n" % (name, name, name)
        for part, fields in zip(("Request", "Response"), read(path).split("---\n")):
            text += "\n**%s**\n" % part + fields_text(fields)
    return text


def fields_text(message):
    """Comments and fields of a message."""
    text = ""
    for comments, fields in group(message.splitlines()):
        if comments:
            says = "\n".join(comments).strip()
            says = re.sub(r"^(header\.\w+) +", r"- `\1`: ", says, flags=re.M)
            text += "\n" + says[0].upper() + says[1:] + "\n"
        if fields:
            text += "\n| field | type | meaning |\n|---|---|---|\n"
            text += "".join("| `%s` | `%s` | %s |\n" % (field, kind, cell(says)) for field, kind, says in fields)
    return text


PAGES = {"keys.md": keys_page, "messages.md": messages_page}


def main():
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(__doc__)
    for name, make in PAGES.items():
        path, text = os.path.join(ROOT, "docs", name), make()
        if not sys.argv[1:]:
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        elif not os.path.exists(path) or read(path) != text:
            sys.exit("docs/%s is not what config/curtain.yaml, msg, action or srv say: run docs/make_pages.py" % name)


if __name__ == "__main__":
    main()
