#!/usr/bin/python3
"""docs/schema.json is what the program prints, `explain` knows every key of it, and `new` writes decks that pass --check.

start_test.py MORTISE
"""

import contextlib
import io
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
sys.path.insert(0, str(ROOT / "inputs" / "start"))
import explain  # noqa: E402
import new_deck  # noqa: E402



class Yaml12(yaml.SafeLoader):
    """Scalars as the program reads them: 1e-4 is a number, on and off are words."""


Yaml12.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in of if tag not in ("tag:yaml.org,2002:bool", "tag:yaml.org,2002:float")]
    for first, of in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
Yaml12.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("^(true|false)$"), list("tf"))
Yaml12.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"^[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?$"), list("-+.0123456789"))

PLATES = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 3 "end: left"
2 1 "plate"
2 2 "other one"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 1 0 0
6 2 0 0
7 2 1 0
8 1 1 0
$EndNodes
$Elements
3
1 1 2 3 3 1 4
2 3 2 1 1 1 2 3 4
3 3 2 2 2 5 6 7 8
$EndElements
"""


def run(*arguments):
    return subprocess.run([MORTISE, *map(str, arguments)], capture_output=True, text=True, check=False)


def paths(node, above=""):
    """All keys that the schema knows, as `explain` calls them."""
    for mapping in explain.mappings(node):
        for key, value in mapping["properties"].items():
            path = f"{above}.{key}" if above else key
            yield path, value
            if path.count(".") < 4:
                yield from paths(value, path)


class Schema(unittest.TestCase):
    def test_it_is_what_the_program_prints(self):
        self.assertEqual(
            json.loads(run("--schema").stdout),
            json.loads(explain.SCHEMA.read_text()),
            "renew it: build/release/app/mortise --schema > docs/schema.json",
        )

    def test_every_key_is_explained(self):
        schema = json.loads(explain.SCHEMA.read_text())
        every = {}
        for path, value in paths(schema):
            every.setdefault(path, value)  # of alternatives the first one
        self.assertGreater(len(every), 80)
        for path, value in every.items():
            text = explain.explain(schema, path, 100)
            self.assertTrue(text.startswith(f"{path}: "), text)
            self.assertIn(" ".join(value.get("description", "").split())[:40], " ".join(text.split()))

    def test_a_key_without_words_has_those_above(self):
        text = explain.explain(json.loads(explain.SCHEMA.read_text()), "supports.displacement.radial", 200)
        self.assertIn("One that is not named is free.", text)

    def test_no_mapping_is_one_of_several_by_trial(self):
        """Where it is, editors can only say that none fits, not which key is wrong."""

        def walk(node, path):
            for choice in node.get("anyOf", []) if isinstance(node, dict) else []:
                self.assertNotIn("properties", choice, path)
                self.assertNotIn("items", choice, path)
            for key, inner in node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else []:
                walk(inner, f"{path}.{key}")

        walk(json.loads(explain.SCHEMA.read_text()), "schema")

    def test_all_decks_fit_and_wrong_keys_of_contacts_are_found(self):
        schema = json.loads(explain.SCHEMA.read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        validator = jsonschema.Draft202012Validator(schema)
        decks = [d for folder in ("inputs", "regression") for d in sorted((ROOT / folder).rglob("*.yaml")) if "must_fail" not in d.parts]
        decks = [d for d in decks if d.name != "bonded_interference.yaml"]  # the program refuses it as well
        self.assertGreater(len(decks), 90)
        for deck in decks:
            self.assertEqual([(e.json_path, e.message) for e in validator.iter_errors(yaml.load(deck.read_text(), Yaml12))], [], deck)
        deck = yaml.load((ROOT / "regression" / "cases" / "stack.yaml").read_text(), Yaml12)
        pair = {"secondary": "a", "primary": "b"}
        for contacts, path, word in (
            ([pair, {**pair, "frictoin": {}}], "$.contacts[1]", "'frictoin'"),
            ([{"auto": True, "secondary": "a"}], "$.contacts[0]", "'secondary'"),
            ([{"primary": "b"}], "$.contacts[0]", "'secondary'"),
            ([{**pair, "friction": {"coulom": 1}}], "$.contacts[0].friction", "'coulom'"),
            ([{**pair, "search_distance": -1}], "$.contacts[0].search_distance", "minimum"),
            ([{**pair, "primary": {"sphere": {"center": [0, 0, 0], "radius": -1}}}], "$.contacts[0].primary.sphere.radius", "minimum"),
            ("aut", "$.contacts", "'auto'"),
        ):
            found = [(e.json_path, e.message) for e in validator.iter_errors({**deck, "contacts": contacts})]
            self.assertEqual([path], [at for at, _ in found], contacts)
            self.assertIn(word, found[0][1])

    def test_what_a_run_writes_fits(self):
        validator = jsonschema.Draft202012Validator(json.loads(explain.SCHEMA.read_text()))
        for name in ("stack", "coupling_bending"):
            with tempfile.TemporaryDirectory() as directory:
                subprocess.run([MORTISE, ROOT / "regression" / "cases" / f"{name}.yaml", "--output", directory], check=True, capture_output=True)
                written = yaml.load((pathlib.Path(directory) / "deck.yaml").read_text(), Yaml12)
            self.assertEqual([(e.json_path, e.message) for e in validator.iter_errors(written)], [], name)

    def test_a_wrong_key_names_the_nearest(self):
        with self.assertRaisesRegex(LookupError, 'did you mean "contacts"'):
            explain.find(json.loads(explain.SCHEMA.read_text()), "contact")


class New(unittest.TestCase):
    def written(self, file, content, *options):
        """(exit status, deck, its text) of a deck for a file of this content."""
        folder = tempfile.TemporaryDirectory(prefix="mortise_new_")
        self.addCleanup(folder.cleanup)
        mesh = pathlib.Path(folder.name) / file
        mesh.write_bytes(content)
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as said:
            status = new_deck.main([MORTISE, str(mesh), *options])
        target = mesh.with_suffix(".yaml")
        self.said = said.getvalue()
        if not target.exists():
            return status, None, ""
        checked = run(target, "--check")
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        with contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(new_deck.main([MORTISE, str(mesh)]), 1)  # it is there
        return status, yaml.safe_load(target.read_text()), target.read_text()

    def test_a_part(self):
        part = ROOT / "regression" / "cases" / "step_tube.step"
        status, deck, text = self.written("tube.step", part.read_bytes())
        self.assertEqual((status, list(deck["bodies"]), deck["dimension"]), (0, ["solid.1"], 3))
        for face in range(1, 7):
            self.assertRegex(text, rf"(?m)^#   solid\.1\.face\.{face}: area ")
        self.assertRegex(text, r"\A# yaml-language-server: \$schema=\S*docs/schema\.json\n")

    def test_a_plane_mesh(self):
        status, deck, text = self.written("plates.msh", PLATES.encode())
        self.assertEqual((status, deck["dimension"], deck["contacts"]), (0, "plane_strain", "auto"))
        self.assertEqual(list(deck["bodies"]), ["plate", "other one"])
        self.assertIn("#   end: left: area 1,", text)
        self.assertEqual(self.written("plates.msh", PLATES.encode(), "--dimension", "plane_stress")[1]["dimension"], "plane_stress")

    def test_a_file_that_is_no_mesh(self):
        status, deck, _ = self.written("part.msh", b"nothing")
        self.assertEqual((status, deck), (1, None))
        self.assertIn("part.msh", self.said)


if __name__ == "__main__":
    MORTISE = sys.argv.pop(1)
    unittest.main()
