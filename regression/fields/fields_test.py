#!/usr/bin/env python3
"""The fields of solution.pvd that a deck asks for: contact pressure on both sides, components along local axes; the tables of results.h5.

    fields_test.py MORTISE --mpiexec MPIEXEC
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "fuzz"))
import oracle  # noqa: E402: runs the program, reads .vtu files

MORTISE = MPIEXEC = None


def solution(ranks, *arguments):
    """The nodes of all pieces of a run, and their fields by name."""
    with tempfile.TemporaryDirectory() as directory:
        out = pathlib.Path(directory) / "out"
        done = oracle.run(MORTISE, HERE / "both_sides.yaml", ["--output", str(out), *arguments], ranks, MPIEXEC)
        assert done.status == 0, done.err
        pieces = [dict(oracle.arrays(path)) for path in sorted(out.glob("solution_*.vtu"))]
    widths = {"Points": 3, "displacement": 3, "displacement_local": 3, "stress": 6, "stress_local": 6, "contact_pressure": 1}
    return {name: np.vstack([piece[name].reshape(-1, width) for piece in pieces]) for name, width in widths.items()}


class Fields(unittest.TestCase):
    def judge(self, fields):
        x, pressure = fields["Points"], fields["contact_pressure"][:, 0]
        at = np.abs(x[:, 2] - 1) < 1e-9
        self.assertTrue((pressure[~at] == 0).all())
        base = at & (np.abs(x[:, :2] * 2.5 - np.round(x[:, :2] * 2.5)) < 1e-6).all(axis=1)  # its grid of 0.4
        below = base & (np.abs(x[:, :2] - 1) < 0.5).all(axis=1)
        self.assertTrue((pressure[base & ~below] == 0).all())  # beside the punch
        punch = at & ~base
        self.assertGreater(pressure[punch].min(), 0)
        self.assertGreater(pressure[below].min(), pressure[punch].min())
        self.assertLess(pressure[below].max(), pressure[punch].max())
        radial = x[:, :2] - 1
        length = np.linalg.norm(radial, axis=1)
        off = length > 1e-6
        unit = radial[off] / length[off, None]
        u, local = fields["displacement"][off], fields["displacement_local"][off]
        scale = np.abs(u).max()
        np.testing.assert_allclose(local[:, 0], (u[:, :2] * unit).sum(axis=1), atol=1e-12 * scale)
        np.testing.assert_allclose(local[:, 1], u[:, 1] * unit[:, 0] - u[:, 0] * unit[:, 1], atol=1e-12 * scale)
        np.testing.assert_allclose(local[:, 2], u[:, 2], atol=1e-12 * scale)
        s, turned = fields["stress"], fields["stress_local"]
        np.testing.assert_allclose(turned[:, :3].sum(axis=1), s[:, :3].sum(axis=1), atol=1e-10)
        np.testing.assert_allclose(turned[:, 2], s[:, 2], atol=1e-10)
        x_axis = off & (np.abs(x[:, 1] - 1) < 1e-9) & (x[:, 0] > 1)
        np.testing.assert_allclose(turned[x_axis], s[x_axis], atol=1e-10)

    def test_on_one_rank(self):
        self.judge(solution(1))

    def test_on_three_ranks(self):
        self.judge(solution(3))

    def test_with_the_sides_swapped(self):
        fields = solution(1, "--set", "contacts[0].secondary=base.zmax", "--set", "contacts[0].primary=punch.zmin")
        x, pressure = fields["Points"], fields["contact_pressure"][:, 0]
        middle = (np.abs(x - [1, 1, 1]) < [0.2, 0.2, 1e-9]).all(axis=1)
        self.assertTrue((pressure[middle] > 1).all() and (pressure[middle] < 3).all() and middle.any())

    def test_contact_shows_what_is_near(self):
        """Of the base's upper side the faces about the punch; beside it gaps are those of the faces that reach below it."""
        for ranks in (1, 3):
            with tempfile.TemporaryDirectory() as directory:
                out = pathlib.Path(directory) / "out"
                swapped = ["--set", "contacts[0].secondary=base.zmax", "--set", "contacts[0].primary=punch.zmin"]
                swapped += ["--set", "mesh.blocks.base.cells=[20, 20, 2]"]
                done = oracle.run(MORTISE, HERE / "both_sides.yaml", ["--output", str(out), *swapped], ranks, MPIEXEC)
                assert done.status == 0, done.err
                grid = oracle.results.Grid(sorted(out.glob("contact_*.vtu")))
                text = "".join(path.read_text() for path in out.glob("contact_*.vtu"))
            self.assertEqual(len(grid.cells), 144)  # of 400: 10 x 10 below the punch, and those that have a node with them
            middles = np.array([grid.points[nodes].mean(axis=0) for nodes in grid.cells])
            self.assertLess(np.abs(middles[:, :2] - 1).max(), 0.6)
            beside = np.abs(grid.points[:, :2] - 1).max(axis=1) > 0.501
            gap = grid.fields["gap"]
            self.assertTrue((grid.fields["contact_pressure"][beside] == 0).all() and beside.any())
            self.assertTrue(np.isfinite(gap).all() and (gap[beside] <= gap[~beside].max()).all())
            for words in ("contact_status: words", "contact: names"):
                self.assertIn(words, text)

    def test_results_file_is_read_without_the_program(self):
        """The example of docs/running.md in the output folder, and the cells of results.h5 beside those of the .vtu."""
        import h5py

        page = (HERE.parents[1] / "docs/running.md").read_text()
        example = re.search(r"```python\n(.*?)```", page, re.S)[1]
        tables = []
        for ranks in (1, 3):
            with tempfile.TemporaryDirectory() as directory:
                out = pathlib.Path(directory) / "out"
                done = oracle.run(MORTISE, HERE / "both_sides.yaml", ["--output", str(out)], ranks, MPIEXEC)
                assert done.status == 0, done.err
                said = subprocess.run([sys.executable, "-c", example], cwd=out, capture_output=True, text=True)
                self.assertEqual(said.returncode, 0, said.stderr)
                grid = oracle.results.Grid(sorted(out.glob("solution_*.vtu")))
                with h5py.File(out / "results.h5") as file:
                    tables.append({f"{group}/{name}": file[group][name][:] for group in ("nodes", "cells") for name in file[group]})
                for name in tables[-1]:
                    self.assertIn(name, page.replace("`", ""))
                    self.assertIn(name, said.stdout)
            moved = [float(line.split()[-1]) for line in said.stdout.splitlines() if line.startswith("body")]
            self.assertEqual(len(moved), 2)
            highest = np.linalg.norm(grid.fields["displacement"], axis=1).max()
            self.assertAlmostEqual(max(moved), highest, delta=1e-12 * highest)
            self.assertEqual(cells_of_tables(tables[-1]), cells_of_grid(grid))
        for name, table in tables[0].items():
            self.assertEqual(table.shape, tables[1][name].shape)
        np.testing.assert_array_equal(tables[0]["cells/nodes"], tables[1]["cells/nodes"])


def cell(kind, body, corners):
    return int(kind), int(body), tuple(np.round(corners, 9).ravel() + 0.0)


def cells_of_tables(tables):
    """Shape, body and places of the nodes of each cell."""
    rows = zip(tables["cells/type"][:, 0], tables["cells/body"][:, 0], tables["cells/nodes"].astype(int))
    return sorted(cell(kind, body, tables["nodes/points"][nodes[nodes >= 0]]) for kind, body, nodes in rows)


def cells_of_grid(grid):
    return sorted(cell(kind, body, grid.points[nodes]) for kind, body, nodes in zip(grid.types, grid.cell_fields["body"], grid.cells))


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("mortise")
    parser.add_argument("--mpiexec", default="mpirun")
    arguments, rest = parser.parse_known_args()
    MORTISE, MPIEXEC = pathlib.Path(arguments.mortise).resolve(), arguments.mpiexec
    unittest.main(argv=[sys.argv[0], *rest])
