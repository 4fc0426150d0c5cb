"""The judge itself: what it must find, and what it must let pass."""
import json
import pathlib
import random
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import decks
import meshes
import oracle

SUMMARY = {"exit_status": 0, "converged": True, "strain_energy": 1.0, "contacts": [{"force": [0.0, 1.0]}],
           "residuals": {"equilibrium": 1e-12, "penetration": 1e-6}}


def ended(status, out="", err="", hung=False, resident=0):
    return oracle.Run(status, out, err, resident, hung)


class Judge(unittest.TestCase):
    def files(self, directory, history="a\n1\n", **changes):
        (directory / "summary.json").write_text(json.dumps({**SUMMARY, **changes}))
        (directory / "history.csv").write_text(history)

    def complaints(self, done, history="a\n1\n", **changes):
        with tempfile.TemporaryDirectory() as scratch:
            self.files(pathlib.Path(scratch), history, **changes)
            return oracle.judge(done, ["deck.yaml"], pathlib.Path(scratch))

    def test_how_it_ended(self):
        check = lambda *a, names=("deck.yaml",), **k: oracle.judge(ended(*a, **k), names)
        self.assertEqual(check(0), [])
        self.assertEqual(check(1, err='deck.yaml:3: seats: expected a number, found "nan"'), [])
        self.assertEqual(check(4, err="a.geo: gmsh: it took more memory than the machine has for it", resident=9e9, names=["a.geo"]), [])
        for bad in (check(-11), check(134), check(5), check(0, hung=True), check(0, resident=9e9), check(1), check(3), check(4), check(1, err="no"),
                    check(2), check(4, err="mortise: rank 0: std::bad_alloc"), check(1, err="deck.yaml:1: terminate called"), check(0, out="energy nan")):
            self.assertTrue(bad)

    def test_what_it_left(self):
        self.assertEqual(self.complaints(ended(0)), [])
        self.assertTrue(self.complaints(ended(2)))
        self.assertTrue(self.complaints(ended(0), strain_energy=None))
        self.assertTrue(self.complaints(ended(0), strain_energy=float("nan")))
        self.assertTrue(self.complaints(ended(0), contacts=[{"force": [float("inf")]}]))
        self.assertTrue(self.complaints(ended(0), residuals={"equilibrium": 1e-3}))
        self.assertTrue(self.complaints(ended(0), history="a,b\n1,-inf\n"))
        self.assertTrue(self.complaints(ended(0, out="balance of forces  difference 1e-3 of the largest force")))

    def test_cases_repeat(self):
        schema = {"type": "object", "properties": {"title": {"type": "string"}}}
        texts = [decks.mutant(random.Random(f"1 {i}"), schema)[0] for i in range(50)]
        self.assertEqual(texts, [decks.mutant(random.Random(f"1 {i}"), schema)[0] for i in range(50)])
        self.assertGreater(len(set(texts)), 45)
        seed = {"a.inp": (meshes.abaqus(1).encode(), ".inp", "")}
        files = [meshes.mutant(random.Random(f"1 {i}"), seed)[1] for i in range(50)]
        self.assertEqual(files, [meshes.mutant(random.Random(f"1 {i}"), seed)[1] for i in range(50)])
        self.assertGreater(len(set(files)), 35)


if __name__ == "__main__":
    unittest.main()
