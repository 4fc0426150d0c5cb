#!/usr/bin/env python3
"""Forces on the rollers of the bearing, from the contact nodes of a run.

    roller_forces.py OUTPUT_DIRECTORY [--rollers 35] [--load 350e3]

Prints, from the most loaded position upwards, the radial force of the inner and of the outer raceway on each roller, and what the classical theory
expects: Q(psi) = Q_max (1 - (1 - cos psi) / (2 eps))^(10/9), eps = 1/2 without clearance. The forces on the contact nodes of results.h5 are
summed. Needs numpy and h5py.
"""
import argparse
import math
import pathlib
import sys

import h5py
import numpy as np


def forces(directory, contact, rollers):
    """Radial forces (positive: towards the axis) on the rollers, a row of the bearing each, that above z = 0 first."""
    path = directory / "results.h5"
    if not path.exists():
        sys.exit(f"{directory}: no results.h5; is it the output directory of a finished run?")
    with h5py.File(path) as file:
        points = file["contact/points"][:]
        points = points[points[:, 0] == contact]
        places, force = file["nodes/points"][:][points[:, 1].astype(int)], points[:, 4:7]
    nearest = np.round(np.arctan2(places[:, 0], -places[:, 1]) * rollers / (2 * math.pi)).astype(int)
    psi = nearest * 2 * math.pi / rollers
    radial = -(force[:, 0] * np.sin(psi) - force[:, 1] * np.cos(psi))
    result = np.zeros((2, rollers))
    np.add.at(result, (np.where(places[:, 2] > 0, 0, 1), nearest % rollers), radial)
    return result


def by_angle(directory, rollers):
    """Forces of the inner and of the outer raceway, both positive: (rows, rollers) each."""
    return -forces(directory, 0, rollers), forces(directory, 1, rollers)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--rollers", type=int, default=35)
    parser.add_argument("--load", type=float, default=350e3)
    arguments = parser.parse_args()

    inner, outer = by_angle(arguments.directory, arguments.rollers)
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
