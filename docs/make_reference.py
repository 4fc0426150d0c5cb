#!/usr/bin/python3
"""Writes docs/reference.md, the deck's keys, out of docs/schema.json.

    docs/make_reference.py            writes the page
    docs/make_reference.py --check    exit status 1 if the page is not what it would write
"""

import json
import pathlib
import sys
import textwrap

DOCS = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(DOCS.parent / "inputs" / "start"))
from explain import kind, mappings  # noqa: E402

HEAD = """# The deck: all keys

Written by `docs/make_reference.py` out of [schema.json](schema.json), which is what the program prints with `--schema`. [deck.md](deck.md) shows what to
write for what.
"""


def cell(text):
    return str(text).replace("|", "\\|").replace("\n", " ")


def default(value):
    if "default" not in value:
        return ""
    return cell(f"`{json.dumps(value['default'])}`".replace('"', ""))


def rows(mapping):
    """A table of the keys of one mapping."""
    lines = ["", "| key | value | default | meaning |", "|---|---|---|---|"]
    for name, value in mapping["properties"].items():
        needed = "needed" if name in mapping.get("required", []) else default(value)
        lines.append(f"| `{name}` | {cell(kind(value))} | {needed} | {cell(value.get('description', ''))} |")
    return lines


def section(path, node, level, seen):
    """The keys of a value and of what it holds, each mapping once."""
    lines = []
    for mapping in mappings(node):
        mark = json.dumps(mapping, sort_keys=True)
        if mark in seen:
            continue
        seen.add(mark)
        lines += ["", f"{'#' * min(level, 4)} {path}"]
        if text := mapping.get("description") or node.get("description"):
            lines += ["", *textwrap.wrap(text, 158)]
        lines += rows(mapping)
        for name, value in mapping["properties"].items():
            lines += section(f"{path}.{name}", value, level + 1, seen)
    return lines


def page():
    schema = json.loads((DOCS / "schema.json").read_text())
    lines = [HEAD.rstrip(), "", schema["description"], *rows(schema)]
    seen = set()
    for name, value in schema["properties"].items():
        lines += section(name, value, 2, seen)
    return "\n".join(lines) + "\n"


def main():
    target = DOCS / "reference.md"
    if sys.argv[1:] == ["--check"]:
        if not target.exists() or target.read_text() != page():
            print("docs/reference.md is not what docs/make_reference.py writes", file=sys.stderr)
            return 1
        return 0
    target.write_text(page())
    return 0


if __name__ == "__main__":
    sys.exit(main())
