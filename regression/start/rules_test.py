#!/usr/bin/python3
"""The schema and the program agree on which keys go together: of each entry every few keys, one deck for many of them.

rules_test.py MORTISE [--four]

Up to three keys together, with --four up to four.
"""

import itertools
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import jsonschema
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]

BASE = {
    "mesh": {"blocks": {"b": {"size": [1, 1, 1], "cells": [1, 1, 1]}, "c": {"origin": [0, 0, 1], "size": [1, 1, 1], "cells": [1, 1, 1]}}},
    "materials": {"steel": {"young_modulus": 1000, "poisson_ratio": 0.3, "density": 1, "thermal_expansion": 1e-5}},
    "bodies": {"b": {"material": "steel"}, "c": {"material": "steel"}},
    "axes": {"turned": {"x": [1, 0, 0], "y": [0, 1, 0]}},
    "couplings": {"grip": {"boundary": "b.zmax", "point": [0, 0, 2]}},
}
TOP = [0, 0, 1]
# Of each section all keys, with values that are right where the key may stand.
KEYS = {
    "loads": {
        "boundary": "b.zmax", "body": "b", "coupling": "grip", "points": [TOP], "axes": "turned", "pressure": 1, "traction": TOP,
        "force": TOP, "moment": TOP, "acceleration": TOP, "centrifugal": {"axis": TOP, "speed": 1}, "temperature_change": 1,
    },
    "supports": {
        "boundary": "b.zmax", "coupling": "grip", "points": [TOP], "body": "b", "axes": "turned", "displacement": {"x": 0},
        "stiffness": {"x": 1}, "rotation": {"x": 0},
    },
    "contacts": {
        "secondary": "c.zmin", "primary": "b.zmax", "friction": {"bonded": True}, "interference": 0.1, "adjust": 0.1, "clearance": 0.1,
        "preload": {"force": 1}, "cyclic": {"axis": TOP, "angle": 90}, "auto": True,
    },
    "materials": {
        "young_modulus": 1, "poisson_ratio": 0.3, "density": 1, "thermal_expansion": 1,
        "orthotropic": {"young_modulus": [1, 1, 1], "poisson_ratio": [0, 0, 0], "shear_modulus": [1, 1, 1]},
    },
    "bodies": {
        "material": "steel", "volumes": {"x": "steel"}, "method": "boundary_elements", "surfaces": ["s"], "formulation": "bbar",
        "instances": [{"translate": TOP}],
    },
    "probes": {
        "largest": "ux", "smallest": "von_mises", "of": "b", "point": TOP, "from": [0, 0, 0], "to": TOP, "axes": "turned", "count": 3,
    },
}  # fmt: skip
LISTS = ("loads", "supports", "contacts")
OF_OTHERS = ("prescribes a component of the motion", "blocks ")  # two entries of which each is right; what the mesh here lacks
MOST_KEYS = 3
AT_ONCE = 48  # the program tells a hundred errors; where there are more, each half is asked by itself


def deck_of(section, entries):
    deck = json.loads(json.dumps(BASE))
    if section in LISTS:
        deck[section] = entries
        return deck
    named = {f"n{i}": entry for i, entry in enumerate(entries)}
    if section == "probes":
        deck["output"] = {"probes": named}
    else:
        deck[section] = {**deck.get(section, {}), **named}
    return deck


class Rules(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        schema = json.loads((ROOT / "docs" / "schema.json").read_text())
        cls.validator = jsonschema.Draft202012Validator(schema)
        folder = tempfile.TemporaryDirectory(prefix="mortise_rules_")
        cls.addClassCleanup(folder.cleanup)
        cls.file = pathlib.Path(folder.name) / "deck.yaml"

    def refused_by_program(self, section, deck):
        self.file.write_text(yaml.safe_dump(deck, sort_keys=False))
        run = subprocess.run([MORTISE, str(self.file), "--check"], capture_output=True, text=True, check=False)
        if run.stderr.endswith(" more\n"):
            return None
        told = "\n".join(line for line in run.stderr.splitlines() if not any(words in line for words in OF_OTHERS))
        found = re.findall(rf"\b{section}(?:\[(\d+)\]|\.n(\d+)\b)", told)
        self.assertTrue(run.returncode == 1 or not found, run.stderr)
        return {int(a or b) for a, b in found}

    def refused_by_schema(self, section, deck):
        refused = set()
        for error in self.validator.iter_errors(deck):
            path = list(error.absolute_path)
            entry = path[path.index(section) + 1]
            refused.add(entry if isinstance(entry, int) else int(entry[1:]))
        return refused

    def compare(self, section, part):
        """The number of entries that are accepted."""
        deck = deck_of(section, part)
        program, schema = self.refused_by_program(section, deck), self.refused_by_schema(section, deck)
        if program is None:
            half = len(part) // 2
            return self.compare(section, part[:half]) + self.compare(section, part[half:])
        for i, entry in enumerate(part):
            with self.subTest(section=section, keys=list(entry)):
                self.assertEqual(i in schema, i in program)
        return len(part) - len(program)

    def test_the_schema_refuses_what_the_program_refuses(self):
        for section, keys in KEYS.items():
            entries = [{key: keys[key] for key in chosen} for n in range(MOST_KEYS + 1) for chosen in itertools.combinations(keys, n)]
            if section == "contacts":  # of two entries of one name the second is refused
                entries = [{"name": f"n{i}", **entry} for i, entry in enumerate(entries) if "auto" not in entry]
            own = {"volumes": lambda i: {f"x{i}": "steel"}, "surfaces": lambda i: [f"s{i}"]}  # of no other body
            entries = [{k: own[k](i) if k in own else v for k, v in entry.items()} for i, entry in enumerate(entries)]
            accepted = sum(self.compare(section, entries[begin : begin + AT_ONCE]) for begin in range(0, len(entries), AT_ONCE))
            self.assertGreater(accepted, 4, section)

    def test_smaller_entries(self):
        """What lies deeper: (where, value, whether it is right)."""
        load, pair = {"boundary": "b.zmax"}, {"secondary": "c.zmin", "primary": "b.zmax"}
        bonded = {**pair, "friction": {"bonded": True}}
        support = {"boundary": "b.zmin"}
        for section, entry, right in (
            ("loads", {**load, "pressure": "x"}, True),
            ("loads", {**load, "pressure": [1]}, False),
            ("loads", {"coupling": "grip", "axes": "turned", "moment": TOP}, True),
            ("supports", {**support, "displacement": {"normal": 0, "x": 0}}, True),
            ("supports", {**support, "displacement": {"radial": 0, "x": 0}}, False),
            ("supports", {"points": [TOP], "displacement": {"normal": 0}}, False),
            ("supports", {"coupling": "grip", "displacement": {"normal": 0}}, False),
            ("supports", {**support, "stiffness": {"tangential": 1}}, False),
            ("supports", {**support, "stiffness": {"normal": 1, "x": 1}}, False),
            ("supports", {**support, "stiffness": {"normal": 1, "tangential": 1}}, True),
            ("contacts", {**bonded, "preload": {"force": 1}}, True),
            ("contacts", {**bonded, "preload": {"force": 1, "shortening": 1}}, False),
            ("contacts", {**bonded, "preload": {}}, False),
            ("contacts", {**bonded, "interference": 0.1}, False),
            ("contacts", {**pair, "friction": {"bonded": False}, "interference": 0.1}, True),
            ("contacts", {**pair, "friction": {"coulomb": 0.1}, "preload": {"force": 1}}, False),
            ("contacts", {**pair, "clearance": -1}, False),
            ("contacts", {**pair, "primary": {"plane": {"point": TOP, "normal": TOP}}}, True),
            ("contacts", {**pair, "primary": {"plane": {"point": TOP, "normal": TOP}}, "cyclic": {"axis": TOP, "angle": 90}}, False),
            ("contacts", {"auto": True, "friction": {"bonded": True}, "adjust": 0.1}, False),
            ("contacts", {"auto": True, "friction": {"coulomb": 0.1}, "adjust": 0.1}, True),
        ):
            with self.subTest(section=section, entry=entry):
                deck = deck_of(section, [entry])
                self.assertEqual(not self.refused_by_program(section, deck), right)
                self.assertEqual(not self.refused_by_schema(section, deck), right)

    def test_the_key_that_is_wrong_is_marked(self):
        load, pair = {"boundary": "b.zmax"}, {"secondary": "c.zmin", "primary": "b.zmax"}
        for section, entry, path, word in (
            ("loads", {**load, "pressure": 1, "force": TOP}, "$.loads[0]", "each of"),
            ("loads", load, "$.loads[0]", "any of"),
            ("loads", {"coupling": "grip", "pressure": 1, "force": TOP}, "$.loads[0].pressure", "not allow"),
            ("loads", {"body": "b", "pressure": 1}, "$.loads[0].body", "not allow"),
            ("contacts", {**pair, "adjust": 1, "clearance": 1}, "$.contacts[0].adjust", "not allow"),
            ("contacts", {**pair, "preload": {"force": 1}}, "$.contacts[0]", "'friction'"),
        ):
            with self.subTest(entry=entry):
                found = [(e.json_path, e.message) for e in self.validator.iter_errors(deck_of(section, [entry]))]
                self.assertTrue(any(at == path and word in message for at, message in found), found)


if __name__ == "__main__":
    MORTISE = sys.argv.pop(1)
    if "--four" in sys.argv:
        sys.argv.remove("--four")
        MOST_KEYS = 4
    unittest.main()
