#!/usr/bin/python3
"""Tests ./mortise study: study_test.py MORTISE. The expected values are those of column.yaml's head."""

import csv
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "postproc"))
from studies import convergence, refinement  # noqa: E402

MORTISE = sys.argv.pop(1) if len(sys.argv) > 1 else None
ENERGY = 2**3 / (6 * 2000)


def study(*words, deck=HERE / "column.yaml"):
    return subprocess.run([sys.executable, str(ROOT / "postproc" / "study.py"), MORTISE, str(deck), *words], capture_output=True, text=True)


def table(directory):
    with open(pathlib.Path(directory) / "study.csv", newline="") as file:
        return list(csv.DictReader(file))


class Column(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.output = pathlib.Path(scratch.name) / "results"

    def run_study(self, *words):
        done = study("--output", str(self.output), "--quantity", "strain_energy", *words)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual([path.name for path in self.output.iterdir() if path.name.startswith(".") or path.name.endswith(".part")], [])
        return done, table(self.output)

    def test_error_and_order(self):
        _, rows = self.run_study("--refine", "2", "--tolerances", "1e-9", "--exact", f"strain_energy={ENERGY}")
        chain = [row for row in rows if row["tolerance"] == "1e-9"]
        self.assertEqual([int(row["unknowns"]) for row in chain], [4 * 9**2, 4 * 17**2, 4 * 33**2])
        for step, row in enumerate(chain):
            missing = 1 / (16 * (8 * 2**step) ** 2)
            self.assertAlmostEqual(1 - float(row["strain_energy"]) / ENERGY, missing, delta=1e-3 * missing)
            self.assertAlmostEqual(float(row["error of strain_energy"]), missing, delta=1e-3 * missing)
        # The error falls to a quarter; unknowns^(-1/2) falls to 17/33 only, since nodes are one more than cells.
        self.assertAlmostEqual(float(chain[2]["order of strain_energy"]), math.log(4) / math.log(33 / 17), delta=0.01)
        auto = [row for row in rows if row["tolerance"] == "auto"]
        self.assertEqual(len(auto), 3)
        self.assertTrue(all(float(row["change from the tightest of strain_energy"]) < 1e-3 for row in auto))

    def test_elements_exact_values_and_a_run_that_fails(self):
        self.output.mkdir()
        (self.output / "study.csv").write_text("of an earlier call")
        done, rows = self.run_study("--refine", "0", "--elements", "quad4", "quad8", "tri3:incompatible", "--exact", f"strain_energy={ENERGY}")
        self.assertEqual([row["status"] for row in rows], ["0", "0", "1"])
        self.assertAlmostEqual(float(rows[0]["error of strain_energy"]), 1 / 1024, delta=1e-3 / 1024)
        self.assertLess(float(rows[1]["error of strain_energy"]), 1e-6)
        self.assertIn("formulation", rows[2]["message"])
        self.assertIn("exit status 1: ", done.stdout)
        self.assertEqual(re.split("Written to|No plots:", done.stdout)[0].strip(), (self.output / "study.md").read_text().strip())


class BadInput(unittest.TestCase):
    def refuses(self, said, *words, deck=HERE / "column.yaml"):
        with tempfile.TemporaryDirectory() as directory:
            done = study("--output", directory + "/results", *words, deck=deck)
            self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
            self.assertIn(said, done.stderr)
            self.assertNotIn("Traceback", done.stderr)
            self.assertFalse((pathlib.Path(directory) / "results" / "study.csv").exists())

    def test_arguments(self):
        self.refuses("expected numbers between 0 and 1", "--tolerances", "2")
        self.refuses("expected QUANTITY=VALUE", "--exact", "strain_energy")
        self.refuses("the meshes are 0 to 1", "--refine", "1", "--tolerance-mesh", "2")
        self.refuses("constants of a .geo file; this deck has blocks", "--size", "h")
        self.refuses("No such file", deck=HERE / "nothing.yaml")
        self.refuses("KEY=VALUE", "--set", "solver")
        self.refuses("expected standard, bbar or incompatible", "--elements", "quad4:exact")
        self.refuses("summary.json has no such number", "--refine", "0", "--quantity", "strain_enrgy")

    def test_constants_of_a_geometry(self):
        press_fit = ROOT / "inputs/press_fit/press_fit.yaml"
        self.refuses("has no constant of that name; it has n, ", "--count", "m", deck=press_fit)
        self.refuses("name the one to divide with --size NAME", deck=ROOT / "regression/study/two_sizes.yaml")


class Parts(unittest.TestCase):
    def test_constants_that_set_the_size_of_cells(self):
        found = {}
        for name in ("press_fit", "hertz_sphere", "clamp_joint", "roller_bearing"):
            found[name] = refinement.evidence((ROOT / f"inputs/{name}/{name}.geo").read_text())
        self.assertEqual(found["press_fit"]["n"], "count")
        self.assertEqual(found["hertz_sphere"]["h"], "size")
        self.assertEqual(found["clamp_joint"], {"h": "size"})
        self.assertEqual(found["roller_bearing"], dict.fromkeys(("m", "nr", "nz", "na", "nl"), "count"))

    def test_richardson_on_a_power(self):
        sizes = [1.0, 0.6, 0.25]
        limit, order = convergence.richardson(sizes, [3 + 0.5 * h**1.7 for h in sizes])
        self.assertAlmostEqual(limit, 3, places=10)
        self.assertAlmostEqual(order, 1.7, places=8)
        self.assertIsNone(convergence.richardson(sizes, [3.0, 3.1, 3.05]))
        self.assertIsNone(convergence.richardson(sizes, [3.0, 3.1, 3.3]))

    def test_reference_and_orders_of_rows(self):
        rows = [
            {
                "program": "Mortise",
                "element": "hex8",
                "tolerance": "auto",
                "products": 9,
                "step": step,
                "mesh": str(step),
                "status": 0,
                "unknowns": 1000 * 8**step,
                "values": {"energy": 2 + 0.1 * 4.0**-step},
            }
            for step in range(3)
        ]
        references = convergence.measure(rows, ["energy"], {}, 3)
        self.assertAlmostEqual(references["energy"][0], 2, places=10)
        self.assertIn("order 2.0", references["energy"][1])
        self.assertAlmostEqual(rows[2]["orders"]["energy"], 2, places=6)
        rows[2]["status"] = 2  # two meshes are left: the finest of them is the reference, and has no error of its own
        references = convergence.measure(rows, ["energy"], {}, 3)
        self.assertEqual(references["energy"][0], 2.025)
        self.assertNotIn("energy", rows[1]["errors"])
        self.assertAlmostEqual(rows[0]["errors"]["energy"], 0.075 / 2.025)

    def test_counts_stay_whole_and_even(self):
        self.assertEqual(refinement.multiplied(16, 2**0.5), 22)
        self.assertEqual(refinement.multiplied(3, 2**0.5), 4)


if __name__ == "__main__":
    if MORTISE is None:
        sys.exit(__doc__)
    unittest.main()
