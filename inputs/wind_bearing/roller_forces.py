#!/usr/bin/env python3
"""Forces on the rollers of the bearing, from the contact surfaces of a run.

    roller_forces.py OUTPUT_DIRECTORY [--rollers 35] [--load 350e3]

Prints, from the most loaded position upwards, the radial force of the inner and of the outer raceway on each roller, and what the classical theory
expects: Q(psi) = Q_max (1 - (1 - cos psi) / (2 eps))^(10/9), eps = 1/2 without clearance. The tractions of contact.pvd are integrated over the nodes'
shares of the facets. Needs numpy and meshio.
"""
import argparse
import math
import pathlib
import sys

import meshio
import numpy as np


def shares(points, facets):
    """Area of each node: a quarter of each facet's."""
    x = points[facets]
    area = 0.5 * np.linalg.norm(np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]), axis=1)
    result = np.zeros(len(points))
    for corner in range(4):
        np.add.at(result, facets[:, corner], area / 4)
    return result


def surfaces(directory):
    """Points, facets, number of the contact of each facet, and traction of each point, of all ranks' files."""
    paths = sorted(directory.glob("contact_*.vtu"))
    if not paths:
        sys.exit(f"{directory}: no contact_*.vtu; is it the output directory of a finished run?")
    for path in paths:
        with path.open("rb") as file:
            if b'NumberOfCells="0"' in file.read(1000):  # a rank without contact surfaces, which meshio cannot read
                continue
        mesh = meshio.read(path)
        for block, contact in zip(mesh.cells, mesh.cell_data["contact"]):
            if block.type == "quad":
                yield mesh.points, block.data, contact, mesh.point_data["contact_traction"]


def forces(directory, contact, rollers):
    """Radial forces (positive: towards the axis) on the rollers, a row of the bearing each, that above z = 0 first."""
    result = np.zeros((2, rollers))
    for points, facets, numbers, traction in surfaces(directory):
        mine = facets[numbers == contact]
        force = shares(points, mine)[:, None] * traction
        angle = np.arctan2(points[:, 0], -points[:, 1])
        nearest = np.round(angle * rollers / (2 * math.pi)).astype(int)
        psi = nearest * 2 * math.pi / rollers
        radial = -(force[:, 0] * np.sin(psi) - force[:, 1] * np.cos(psi))
        np.add.at(result, (np.where(points[:, 2] > 0, 0, 1), nearest % rollers), radial)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--rollers", type=int, default=35)
    parser.add_argument("--load", type=float, default=350e3)
    arguments = parser.parse_args()

    inner = -forces(arguments.directory, 0, arguments.rollers)
    outer = forces(arguments.directory, 1, arguments.rollers)
    rows = 2 if inner[1].any() else 1
    psi = 2 * math.pi / arguments.rollers * np.arange(arguments.rollers)
    largest = inner.max()
    mean = arguments.load / (2 * arguments.rollers)
    print(f"{'angle':>7} {'inner, by row':>20} {'outer, by row':>20} {'Q/(F/Z)':>8} {'cos^(10/9)':>10}")
    for i in range(arguments.rollers // 2 + 1):
        values = [0.5 * (side[row, i] + side[row, -i % arguments.rollers]) for side in (inner, outer) for row in range(rows)]
        expected = max(math.cos(psi[i]), 0.0) ** (10 / 9) * largest
        columns = " ".join(f"{v:9.1f}" for v in values[:rows]), " ".join(f"{v:9.1f}" for v in values[rows:])
        print(f"{math.degrees(psi[i]):7.2f} {columns[0]:>20} {columns[1]:>20} {values[0] / mean:8.3f} {expected:10.1f}")
    for name, side in (("inner", inner), ("outer", outer)):
        print(f"{name}: sum of vertical parts {np.sum(side * np.cos(psi)):.2f} N, of horizontal parts {np.sum(side * np.sin(psi)):.2f} N, largest {side.max():.1f} N")
    print(f"largest |inner - outer| of a roller: {np.abs(inner - outer)[:rows].max() / largest:.2e} of the largest force")


if __name__ == "__main__":
    main()
