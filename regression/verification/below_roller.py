#!/usr/bin/env python3
"""Stress below the line contact of one roller of inputs/bearing_boundary: boundary elements beside finite elements.

    below_roller.py MORTISE [--write] [--plot FILE.png]

The lowest roller, pressed with its share of the load, 3278 N over 14 mm, on a half-plane; plane strain. Largest pressure and the depth of
the largest von Mises stress against Hertz's [Johnson, Contact mechanics, 1985, section 4.2]: both within 1 % is what each kind of mesh
is asked for. CPU seconds are those of the whole run with its meshing. --write puts the table into results.md; --plot draws the von Mises
stress of the cheapest meshes that do, beside the formula. Fails if boundary elements do not come within 1 %.
"""
import argparse
import csv
import math
import pathlib
import tempfile

import numpy as np

import study
from methods import ROOT, solve

RADIUS, FORCE, E, NU = 7.0, 3278 / 14, 210e3, 0.3
A = math.sqrt(4 * FORCE * RADIUS * (2 * (1 - NU**2) / E) / math.pi)  # half width
P0 = 2 * FORCE / (math.pi * A)
DECK = """
dimension: plane_strain
mesh: {{file: {root}/inputs/hertz_cylinder/hertz_cylinder.geo, constants: {{h: {h}, order: {order}, R: {radius}, d: {d}, W: 280, H: 280}}}}
materials: {{steel: {{young_modulus: {E}, poisson_ratio: {nu}}}}}
bodies: {{"*": {{material: steel, method: {method}}}}}
supports:
  - {{boundary: symmetry, displacement: {{x: 0}}}}
  - {{boundary: block_bottom, displacement: {{y: 0}}}}
loads: [{{boundary: cylinder_top, force: [0, {force}]}}]
contacts: [{{name: contact, secondary: cylinder_surface, primary: block_top}}]
solver: {{tolerance: 1.0e-6}}
output: {{interior: {{points: points.csv}}}}
"""
# Title; method of the bodies, order of the cells, cells in half of the contact.
METHODS = {"boundary elements": ("boundary_elements", 1, (3, 6, 12, 24)),
           "quad4": ("finite_elements", 1, (3, 6, 12, 24, 48, 96)),
           "quad9": ("finite_elements", 2, (3, 6, 12, 24, 48))}
DEPTHS = np.linspace(0.3, 1.5, 121)  # in half widths, below the middle
GRID = np.meshgrid(np.linspace(0.02, 2, 50), np.linspace(0.02, 2.5, 63))


def von_mises(x, z):
    """Hertz's, over p0; x and z in half widths."""
    root = np.hypot(1 - x * x + z * z, 2 * x * z)
    m2, n2 = (root + 1 - x * x + z * z) / 2, (root - (1 - x * x + z * z)) / 2
    m, n, share = np.sqrt(m2), np.sqrt(np.maximum(n2, 0)), (z * z + n2) / (m2 + n2)
    xx, yy, xy = m * (1 + share) - 2 * z, m * (1 - share), n * (m2 - z * z) / (m2 + n2)
    zz = NU * (xx + yy)
    return np.sqrt(((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) / 2 + 3 * xy**2)


def deepest(values):
    """Depth of the largest value of the polynomial of degree 5 that fits all best: the maximum is flat, and stresses have kinks in cells."""
    fine = np.linspace(0.5, 1, 5001)
    return fine[np.argmax(np.polynomial.Polynomial.fit(DEPTHS, values, 5)(fine))]


def run(mortise, method, cells, directory, field=False):
    """Unknowns, errors of the pressure and of the depth, CPU seconds; the field over p0 on the grid, if wanted, with other seconds."""
    of_bodies, order, _ = METHODS[method]
    deck = directory / "deck.yaml"
    deck.write_text(DECK.format(root=ROOT, h=A / cells, order=order, radius=RADIUS, d=3 * A, E=E, nu=NU, method=of_bodies, force=-FORCE / 2))
    x, z = (GRID[0].ravel(), GRID[1].ravel()) if field else (np.zeros_like(DEPTHS), DEPTHS)
    (directory / "points.csv").write_text("".join(f"{A * a},{-A * b}\n" for a, b in zip(x, z)))
    summary, seconds = solve(mortise, deck, [], directory)
    with (directory / "out" / "interior.csv").open(newline="") as lines:
        values = np.array([float(row["von_mises"]) for row in csv.DictReader(lines)]) / P0
    if len(values) != len(x):
        raise SystemExit(f"{method}: {len(values)} rows of interior.csv for {len(x)} points")
    if field:
        return values.reshape(GRID[0].shape)
    depth = deepest(von_mises(np.zeros_like(DEPTHS), DEPTHS))
    return summary["primal_unknowns"], summary["contacts"][0]["max_pressure"] / P0 - 1, deepest(values) / depth - 1, seconds


def good(row):
    return abs(row[1]) <= 0.01 and abs(row[2]) <= 0.01


def plot(mortise, chosen, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot
    figure, axes = pyplot.subplots(1, len(chosen) + 1, figsize=(3 * (len(chosen) + 1), 3.6), sharey=True, layout="constrained")
    fields = [("Hertz", von_mises(*GRID))]
    for method, cells in chosen.items():
        with tempfile.TemporaryDirectory(prefix="mortise_roller_") as directory:
            fields.append((f"{method}, a / {cells}", run(mortise, method, cells, pathlib.Path(directory), field=True)))
    for axis, (title, values) in zip(axes, fields):
        drawn = axis.contourf(GRID[0], -GRID[1], values, levels=np.arange(0, 0.61, 0.04), cmap="viridis")
        axis.contour(GRID[0], -GRID[1], values, levels=np.arange(0.04, 0.6, 0.04), colors="white", linewidths=0.4)
        axis.plot([0, 1], [0, 0], color="red", linewidth=3, clip_on=False)
        axis.set_title(title, fontsize=10)
        axis.set_xlabel("x / a")
        axis.set_aspect("equal")
    axes[0].set_ylabel("z / a")
    figure.colorbar(drawn, ax=axes, label="von Mises stress / p0", shrink=0.9)
    figure.savefig(path, dpi=80)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--plot", type=pathlib.Path)
    arguments = parser.parse_args()
    head = ["method", "cells in half of the contact", "unknowns", "error of p0", "error of the depth", "CPU s"]
    table, chosen = [], {}
    for method, (_, _, meshes) in METHODS.items():
        for cells in meshes:
            with tempfile.TemporaryDirectory(prefix="mortise_roller_") as directory:
                row = run(arguments.mortise, method, cells, pathlib.Path(directory))
            if good(row):
                chosen.setdefault(method, cells)
            else:
                chosen.pop(method, None)
            table.append([method, str(cells), f"{row[0]:,}", f"{100 * row[1]:+.2f} %", f"{100 * row[2]:+.2f} %", f"{row[3]:.2f}"])
            print(*table[-1], sep=" | ", flush=True)
    if arguments.write:
        known = [(method, str(cells)) for method, (_, _, meshes) in METHODS.items() for cells in meshes]
        study.page_tables.write(study.PAGE, "below a roller", head, table, keys=2, known=known)
    if arguments.plot:
        plot(arguments.mortise, chosen, arguments.plot)
    if "boundary elements" not in chosen:
        raise SystemExit("boundary elements do not come within 1 %")


if __name__ == "__main__":
    main()
