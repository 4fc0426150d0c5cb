#!/usr/bin/env python3
"""The fields of solution.pvd that a deck asks for: contact pressure on both sides, components along local axes.

    fields_test.py MORTISE --mpiexec MPIEXEC
"""
import argparse
import pathlib
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


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("mortise")
    parser.add_argument("--mpiexec", default="mpirun")
    arguments, rest = parser.parse_known_args()
    MORTISE, MPIEXEC = pathlib.Path(arguments.mortise).resolve(), arguments.mpiexec
    unittest.main(argv=[sys.argv[0], *rest])
