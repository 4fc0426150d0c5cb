"""What the command line gives a deck, and decks that no file of the tree should hold: command_line_test.py MORTISE"""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import oracle

MORTISE = pathlib.Path(sys.argv.pop(1)).resolve()
DECK = """mesh: {blocks: {a: {size: [1, 1, 1], cells: [2, 2, 2]}}}
materials: {m: {young_modulus: 1, poisson_ratio: 0.3}}
bodies: {a: {material: m}}
supports: [{boundary: a.zmin, displacement: {x: 0, y: 0, z: 0}}]
"""


class CommandLine(unittest.TestCase):
    def refused(self, text, *arguments, file=None, deck=DECK):
        """That a run is refused with exit status 1 and `text`, in no time and no memory."""
        with tempfile.TemporaryDirectory() as scratch:
            path = pathlib.Path(scratch) / "deck.yaml"
            path.write_bytes(deck if isinstance(deck, bytes) else deck.encode())
            done = oracle.run(MORTISE, file or path, [*arguments, "--check"])
            self.assertEqual((done.status, done.hung), (1, False), done.err)
            self.assertIn(text, done.err)
            self.assertLess(done.resident, 1e9)

    def test_settings(self):
        self.refused("--set .: a key of this path is empty", "--set", ".=1")
        self.refused("--set materials..m: a key of this path is empty", "--set", "materials..m=1")
        self.refused("--set [0]: expected a key and an index", "--set", "[0]=1")
        self.refused("the alias stands within what it refers to", "--set", "bodies.a.instances=&x [{of: *x}]")
        self.refused("makes 100000000 copies; at most 10000 are possible", "--set",
                     "bodies.a.instances=[{count: 10000, translate: [2, 0, 0], of: [{count: 10000, translate: [0, 2, 0]}]}]")
        self.refused("steps[0].increments: expected a whole number", "--set", "steps=[{increments: 1000000000}]")
        self.refused("materials.m.poisson_ratio: expected a number", "--set", "materials.m.poisson_ratio=nan")

    def test_decks(self):
        self.refused("is longer than 50 MB", file="/dev/zero")
        self.refused("deck.yaml:5: this line is not UTF-8", deck=DECK.encode() + b"title: \xff\n")
        self.refused("deck.yaml:5: character 8 of this line is no text (code 0x04)", deck=DECK + "title: \x04\nsupports: 3\n")
        self.refused("deck.yaml:1: the deck is empty", deck="")
        self.refused("deck.yaml:1: a deck is a mapping of sections", deck="- a\n")
        self.refused("deck.yaml:5: title", deck=DECK + "title: " + "[" * 100000 + "\n")


if __name__ == "__main__":
    unittest.main()
