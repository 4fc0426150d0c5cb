#!/usr/bin/python3
"""Turns an input file of Abaqus or CalculiX into a deck: MODEL.yaml and its mesh, MODEL.msh.

    ./mortise import MODEL.inp [-o DECK.yaml] [--partial] [--force]

What the deck has no counterpart for is listed by line, on the terminal and at the end of the deck. Exit status: 0 the deck is the file's model;
1 something that changes the answer was left out (0 with --partial), or the file cannot be read.
"""

import argparse
import json
import pathlib
import sys

import model
import parameters
import translate
import writers
from reader import InputError, read_cards

SCHEMA = pathlib.Path(__file__).resolve().parents[2] / "docs" / "schema.json"


def import_file(path, target, schema):
    """Writes the deck `target` and its mesh beside it. Returns the Translation."""
    cards = read_cards(path)
    heading = next((c for c in cards if c.name == "HEADING"), None)
    title = first_line(path, heading) or path.stem
    result = translate.Translation(model.build(cards), schema, title, target.stem)
    parameters.report(cards, result.model, [state.card for state in result.history.states])
    mesh = target.with_suffix(".msh")
    deck = {"title": title, "dimension": result.deck["dimension"], "mesh": {"file": mesh.name}, **result.deck}
    writers.write_mesh(mesh, result.model, result.bodies, result.boundaries)
    for body, (number, fields) in result.temperatures.items():
        file = target.with_name(result.file_of_temperatures(body))
        writers.write_fields(file, result.model, result.bodies.bodies[number].elements, fields)
    target.write_text(writers.deck_text(deck, result.model.findings, [f"From {path.name}, by ./mortise import."]), encoding="utf-8")
    return result


def first_line(path, heading):
    """The text below *HEADING."""
    if heading is None or heading.file != path.resolve():
        return ""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()[heading.line :]
    text = next((line.strip() for line in lines if line.strip() and not line.startswith("**")), "*")
    return "" if text.startswith("*") else "".join(c for c in text if c.isprintable())


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="mortise import", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", type=pathlib.Path, metavar="MODEL.inp")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="DECK.yaml", help="default: MODEL.yaml beside the file")
    parser.add_argument("--partial", action="store_true", help="exit status 0 also where something that changes the answer is left out")
    parser.add_argument("--force", action="store_true", help="replace a deck and a mesh that are there")
    given = parser.parse_args(arguments)
    target = given.output or given.model.with_suffix(".yaml")
    if target.suffix not in (".yaml", ".yml"):
        print(f"mortise: {target}: a deck ends with .yaml", file=sys.stderr)
        return 1
    there = [p for p in (target, target.with_suffix(".msh")) if p.exists()]
    if there and not given.force:
        print(f"mortise: {there[0]} is there already; --force replaces it", file=sys.stderr)
        return 1
    try:
        result = import_file(given.model, target, json.loads(SCHEMA.read_text()))
    except (InputError, OSError) as error:
        print(f"mortise: {error}", file=sys.stderr)
        return 1
    lost, noted = (writers.describe(result.model.findings, changes) for changes in (True, False))
    if noted:
        print("Otherwise than in the file:", *noted, sep="\n  ")
    if lost:
        print("Left out, and the answer is another one for it:", *lost, sep="\n  ")
    print(
        f"{target}: {len(result.bodies.bodies)} bodies, {len(result.boundaries)} boundaries, {len(result.supports)} supports, "
        f"{len(result.loads)} loads, {len(result.contacts)} contacts, {len(result.history.states)} steps"
    )
    return 1 if lost and not given.partial else 0


if __name__ == "__main__":
    sys.exit(main())
