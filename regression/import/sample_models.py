"""Pieces of input files that the tests of the reader put together, and what they do with them."""

import json
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "inputs" / "import"))
import import_deck  # noqa: E402
from reader import InputError  # noqa: E402

CUBE = """*NODE, NSET=ALL
1,0,0,0
2,1,0,0
3,1,1,0
4,0,1,0
5,0,0,1
6,1,0,1
7,1,1,1
8,0,1,1
*ELEMENT, TYPE=C3D8, ELSET=CUBE
1,1,2,3,4,5,6,7,8
"""
SECOND = """*NODE
11,0,0,1
12,1,0,1
13,1,1,1
14,0,1,1
15,0,0,2
16,1,0,2
17,1,1,2
18,0,1,2
*ELEMENT, TYPE=C3D8, ELSET=UPPER
2,11,12,13,14,15,16,17,18
*SOLID SECTION, ELSET=UPPER, MATERIAL=STEEL
*SURFACE, NAME=CUBE_TOP
CUBE, S2
*SURFACE, NAME=UPPER_BOTTOM
UPPER, S1
"""
STEEL = """*MATERIAL, NAME=STEEL
*ELASTIC
210000., .3
*DENSITY
2.
*EXPANSION
1.E-5
*SOLID SECTION, ELSET=CUBE, MATERIAL=STEEL
"""
HELD = "*NSET, NSET=BOTTOM, GENERATE\n1, 4\n*NSET, NSET=TOP\n5, 6, 7, 8\n*BOUNDARY\nBOTTOM, ENCASTRE\n"
MODEL = CUBE + STEEL + HELD


def step(text, head="*STEP"):
    return f"{head}\n*STATIC\n{text}*END STEP\n"


class Import(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="mortise_import_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.schema = json.loads(import_deck.SCHEMA.read_text())

    def translate(self, text, **files):
        for name, content in files.items():
            (self.folder / f"{name}.txt").write_text(content)
        (self.folder / "model.inp").write_text(text)
        return import_deck.import_file(self.folder / "model.inp", self.folder / "deck.yaml", self.schema)

    def deck(self, text, **files):
        """The deck of a file of which nothing is left out."""
        result = self.translate(text, **files)
        self.assertEqual([f.reason for f in result.model.findings if f.changes], [])
        return result.deck

    def left_out(self, text):
        return [(f.line, f.keyword, f.reason) for f in self.translate(text).model.findings if f.changes]

    def refused(self, text):
        with self.assertRaises(InputError) as caught:
            self.translate(text)
        return str(caught.exception)
