#!/usr/bin/python3
"""Tests ./mortise study: study_test.py MORTISE. The expected values are those of column.yaml's head."""

import csv
import math
import os
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


def study(*words, deck=HERE / "column.yaml", path=None):
    environment = dict(os.environ, PATH=f"{path}:{os.environ['PATH']}", PYTHONPATH=str(path)) if path else None
    command = [sys.executable, str(ROOT / "postproc" / "study.py"), MORTISE, str(deck), *words]
    return subprocess.run(command, capture_output=True, text=True, env=environment)


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

    def test_pressure_against_a_formula(self):
        # The weight of the upper block, 1, against 1.25 + x: the integral of (0.25 + x)^2 over that of (1.25 + x)^2.
        for formula, expected in (("1", 0.0), ("1.25 + x", math.sqrt(0.64583 / 3.14583))):
            _, rows = self.run_study("--refine", "0", "--tolerances", "1e-9", "--elements", "quad4", "quad9", "--pressure", formula)
            self.assertEqual(len(rows), 4)
            for row in rows:
                self.assertAlmostEqual(float(row["pressure (L2)"]), expected, delta=1e-3)

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


PRESSED = """
dimension: plane_strain
mesh: {file: FILE}
materials: {m: {young_modulus: 1000, poisson_ratio: 0}}
bodies: {plate: {material: m}}
supports: [{boundary: side, displacement: {x: 0, y: 0}}]
loads: [{boundary: base, pressure: 1}]
"""
SQUARE = """
DefineConstant[ h = 0.5 ];
Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h}; Point(3) = {1, 1, 0, h}; Point(4) = {0, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Surface("plate") = {1}; Physical Curve("side") = {3}; Physical Curve("base") = {1};
"""


class Scripts(unittest.TestCase):
    """A command `gmsh` that leaves a trace and makes nothing stands first in the path; plots, most of the time of such small studies, are left out."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        (self.folder / "bin").mkdir()
        (self.folder / "bin/gmsh").write_text(f"#!/bin/sh\ntouch {self.folder}/gmsh_was_called\nexit 1\n")
        (self.folder / "bin/gmsh").chmod(0o755)
        (self.folder / "bin/matplotlib.py").write_text("raise ImportError('left out')\n")

    def run_study(self, mesh, text, *words, path="bin"):
        (self.folder / mesh).write_text(text)
        (self.folder / "deck.yaml").write_text(PRESSED.replace("FILE", mesh))
        done = study("--output", str(self.folder / "results"), *words, deck=self.folder / "deck.yaml", path=path and self.folder / path)
        self.assertNotIn("Traceback", done.stderr)
        return done

    def made(self, name):
        return (self.folder / name).exists()

    def test_a_script_does_nothing_unless_it_is_trusted(self):
        script = SQUARE + f'SystemCall "touch {self.folder}/script_has_run";'
        done = self.run_study("square.geo", script, "--refine", "1")
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn("wants to start a program", done.stdout)
        self.assertIn("--allow-scripts", done.stdout)
        self.assertFalse(self.made("script_has_run") or self.made("gmsh_was_called"))
        done = self.run_study("square.geo", script, "--refine", "1", "--allow-scripts")
        self.assertTrue(self.made("gmsh_was_called"), done.stdout + done.stderr)
        (self.folder / "bin/gmsh").unlink()
        if refinement.have_gmsh():
            self.skipTest("the command gmsh is installed: no run meshes the file itself")
        done = self.run_study("square.geo", script, "--refine", "1", "--allow-scripts")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual([row["status"] for row in table(self.folder / "results")], ["0", "0"])
        self.assertTrue(self.made("script_has_run"))

    def test_a_harmless_one_is_meshed_by_the_runs(self):
        done = self.run_study("square.geo", SQUARE, "--refine", "1", "--exact", "strain_energy=0.0005")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertFalse(self.made("gmsh_was_called"))
        rows = table(self.folder / "results")
        self.assertGreater(int(rows[1]["unknowns"]), int(rows[0]["unknowns"]))
        self.assertLess(float(rows[1]["error of strain_energy"]), 1e-6)

    def test_scripts_in_disguise(self):
        for mesh in ("square.msh", "square.inp", "square.STEP"):
            done = self.run_study(mesh, SQUARE, "--refine", "1")
            self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
            self.assertIn(f"{mesh} cannot be refined", done.stderr)
            done = self.run_study(mesh, SQUARE, "--refine", "0")
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertFalse(self.made("gmsh_was_called"), mesh)


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
