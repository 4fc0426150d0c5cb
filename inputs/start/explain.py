#!/usr/bin/python3
"""Tells what may stand in a deck.

    ./mortise explain                      the sections
    ./mortise explain contacts             the keys of one of them
    ./mortise explain contacts.preload     of a key within it

Out of docs/schema.json, which is what `mortise --schema` prints. Exit status 1: there is no such key.
"""

import argparse
import difflib
import json
import pathlib
import re
import shutil
import signal
import sys
import textwrap

SCHEMA = pathlib.Path(__file__).resolve().parents[2] / "docs" / "schema.json"


def choices(node):
    """The alternatives of a value: of `anyOf`, or of a case (`if`, `then`, `else`)."""
    return node["anyOf"] if "anyOf" in node else [node["then"], node["else"]] if "if" in node else []


def mappings(node):
    """The mappings that a value may be, or hold: entries of lists, values by name and alternatives are looked through."""
    if "properties" in node:
        yield node
    for inner in (node.get("items"), node.get("additionalProperties")):
        if isinstance(inner, dict):
            yield from mappings(inner)
    for choice in choices(node):
        yield from mappings(choice)


def kind(node):
    """A value's type, for people."""
    if choices(node):
        return " or ".join(dict.fromkeys(kind(choice) for choice in choices(node)))
    if "const" in node:
        return json.dumps(node["const"]).strip('"')
    if "enum" in node:
        return " | ".join(dict.fromkeys(str(v) for v in node["enum"]))
    if node.get("type") == "array":
        low, high = node.get("minItems"), node.get("maxItems")
        count = f" of {low}" + (f" or {high}" if high != low else "") if low is not None and high is not None else " of"
        items = node.get("items", {})
        word, limits = re.fullmatch(r"(.*?)((?: [<>].*)?)", kind(items)).groups()
        return f"list{count} {word}{'' if 'enum' in items or word.endswith('s') else 's'}{limits}"
    if node.get("type") == "object":
        inner = node.get("additionalProperties")
        return f"NAME: {kind(inner)}" if isinstance(inner, dict) else "mapping"
    text = {"integer": "whole number", "string": "text", "boolean": "true or false"}.get(node.get("type"), node.get("type", "anything"))
    for word, key in ((">=", "minimum"), (">", "exclusiveMinimum"), ("<=", "maximum"), ("<", "exclusiveMaximum")):
        if key in node:
            text += f" {word} {node[key]:g}"
    return text


def find(schema, path):
    """The schema of a key, or LookupError with the names that there are."""
    node = schema
    for name in [p for p in path.split(".") if p]:
        known = {}
        for mapping in mappings(node):
            for key, value in mapping["properties"].items():
                known.setdefault(key, value)
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            hint = f'; did you mean "{near[0]}"?' if near else ""
            raise LookupError(f'there is no key "{name}"{hint} ({", ".join(known) or "none here"})')
        node = known[name]
    return node


def explain(schema, path, width):
    node = find(schema, path)
    result = []
    if path:
        above = find(schema, path.rpartition(".")[0])  # tells of keys that need no words of their own
        words = node.get("description", "") or above.get("description", "")
        result += [f"{path}: {kind(node)}", *textwrap.wrap(words, width, initial_indent="  ", subsequent_indent="  ")]
    for number, mapping in enumerate(mappings(node)):
        if path and mapping.get("description", "") != node.get("description", ""):
            result += ["", *textwrap.wrap(mapping.get("description", ""), width)]
        elif path or number:
            result.append("")
        for key, value in mapping["properties"].items():
            needed = ", needed" if key in mapping.get("required", []) else ""
            result += textwrap.wrap(f"{key}: {kind(value)}{needed}", width, subsequent_indent="      ")
            result += textwrap.wrap(value.get("description", ""), width, initial_indent="    ", subsequent_indent="    ")
    return "\n".join(result)


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="mortise explain", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("key", nargs="?", default="", help="such as loads, or contacts.preload")
    given = parser.parse_args(arguments)
    try:
        print(explain(json.loads(SCHEMA.read_text()), given.key, min(120, max(40, shutil.get_terminal_size().columns))))
    except LookupError as error:
        print(f"mortise: {error.args[0]}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # of a pager that was left
    sys.exit(main())
