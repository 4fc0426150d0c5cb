#!/usr/bin/env python3
"""Stresses inside bodies against formulas: boundary elements beside finite elements of first and second order on the same surface mesh.

    inside.py MORTISE [--write] [--plot FILE.png] [CASE ...]

cavity   an octant of a cube with a spherical cavity, pulled: the stress along the pull over the plane across it [Goodier, J. Appl. Mech. 1
         (1933); Timoshenko and Goodier, Theory of elasticity, section 137]
sphere   a thick-walled sphere under inner pressure [Lame]
kirsch   a plate with a hole, pulled, plane strain [Kirsch; Timoshenko and Goodier, section 35]
line     inputs/hertz_cylinder under a sixteenth of its force, a = 0.03 R, below the contact [Johnson, Contact mechanics, 1985, section 4.2]
point    inputs/hertz_sphere, a = 0.06 R, below the middle of the contact [Johnson, section 3.4]

The error is the root of the mean square over the points, over the largest exact value; CPU seconds are those of the whole run with its
meshing. --write puts them into results.md. Fails if boundary elements do not converge, or if on some mesh they are farther off than first order.
"""
import argparse
import csv
import math
import pathlib
import tempfile

import study
from methods import ROOT, solve

DECKS = ROOT / "regression/verification/decks"

CAVITY = """
dimension: 3
mesh: {{file: {decks}/cavity.geo, constants: {{n: {size}, order: {order}}}}}
materials: {{elastic: {{young_modulus: 1000, poisson_ratio: 0.3}}}}
bodies: {{cube: {{material: elastic, method: {method}}}}}
supports:
  - {{boundary: symmetry_x, displacement: {{x: 0}}}}
  - {{boundary: symmetry_y, displacement: {{y: 0}}}}
  - {{boundary: symmetry_z, displacement: {{z: 0}}}}
loads: [{{boundary: pulled, traction: [0, 0, 1]}}]
"""
SPHERE = """
dimension: 3
mesh: {{file: {decks}/hollow_sphere.geo, constants: {{n: {size}, order: {order}}}}}
materials: {{elastic: {{young_modulus: 1000, poisson_ratio: 0.3}}}}
bodies: {{sphere: {{material: elastic, method: {method}}}}}
supports:
  - {{boundary: symmetry_x, displacement: {{x: 0}}}}
  - {{boundary: symmetry_y, displacement: {{y: 0}}}}
  - {{boundary: symmetry_z, displacement: {{z: 0}}}}
loads: [{{boundary: bore, pressure: 1}}]
"""
KIRSCH = """
dimension: plane_strain
mesh: {{file: {decks}/kirsch.geo, constants: {{n: {size}, order: {order}}}}}
materials: {{elastic: {{young_modulus: 1000, poisson_ratio: 0.3}}}}
bodies: {{plate: {{material: elastic, method: {method}}}}}
supports:
  - {{boundary: symmetry_x, displacement: {{x: 0}}}}
  - {{boundary: symmetry_y, displacement: {{y: 0}}}}
loads: [{{boundary: pulled, traction: [1, 0]}}]
"""


def cavity():
    """szz in the plane z = 0, midway between the planes of symmetry."""
    nu, result = 0.3, []
    for r in (1, 1.05, 1.1, 1.2, 1.4, 1.7, 2.2):
        exact = 1 + ((4 - 5 * nu) / r**3 + 9 / r**5) / (2 * (7 - 5 * nu))
        result.append(((r / math.sqrt(2), r / math.sqrt(2), 0), exact))
    return "szz", result


def sphere():
    result = []
    for direction in ((1, 1, 1), (1, 2, 3), (3, 1, 0.7)):
        length = math.sqrt(sum(x * x for x in direction))
        for r in (1.05, 1.2, 1.4, 1.6, 1.8, 1.95):
            result.append((tuple(r * x / length for x in direction), 8 / 7 * 1.5 / r**3))
    return "von_mises", result


def plane_von_mises(xx, yy, xy, nu=0.3):
    zz = nu * (xx + yy)
    return math.sqrt(((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) / 2 + 3 * xy**2)


def kirsch():
    result = []
    for angle in (0.2, 0.5, 0.8, 1.1, 1.4):
        for r in (1.02, 1.1, 1.25, 1.6, 2.2):
            q, c, s = 1 / r**2, math.cos(2 * angle), math.sin(2 * angle)
            radial = (1 - q) / 2 + (1 - 4 * q + 3 * q * q) / 2 * c
            hoop = (1 + q) / 2 - (1 + 3 * q * q) / 2 * c
            shear = -(1 + 2 * q - 3 * q * q) / 2 * s
            result.append(((r * math.cos(angle), r * math.sin(angle)), plane_von_mises(radial, hoop, shear)))
    return "von_mises", result


LINE_FORCE = 35e3 / 16  # of the whole cylinder


def line():
    stiffness = 1 / ((1 - 0.3**2) / 210e3 + (1 - 0.3**2) / 70e3)
    a = math.sqrt(4 * LINE_FORCE * 50 / (math.pi * stiffness))
    p0, result = 2 * LINE_FORCE / (math.pi * a), []
    for x in (0.1 * a, 0.5 * a):
        for z in (0.3 * a, 0.704 * a, 1.2 * a, 2 * a):
            root = math.hypot(a * a - x * x + z * z, 2 * x * z)
            m2, n2 = (root + a * a - x * x + z * z) / 2, (root - (a * a - x * x + z * z)) / 2
            m, n, share = math.sqrt(m2), math.sqrt(n2), (z * z + n2) / (m2 + n2)
            xx, yy, xy = m * (1 + share) - 2 * z, m * (1 - share), n * (m2 - z * z) / (m2 + n2)
            result.append(((x, -z), p0 / a * plane_von_mises(xx, yy, xy)))
    return "von_mises", result


def point():
    a, p0, result = 0.6, 4407.4, []
    for s in (0.25, 0.48, 0.75, 1, 1.5):
        axial = 1 / (1 + s * s)
        radial = 1.3 * (1 - s * math.atan(1 / s)) - axial / 2
        result.append(((0.01, 0.01, -s * a), p0 * (axial - radial)))
    return "von_mises", result


# Title; deck or file, with the bodies; formula; sizes of boundary elements and of finite elements of first and second order.
CASES = {
    "cavity": ("Spherical cavity, pulled", CAVITY, (), cavity, ((3, 5, 7, 9), (3, 5, 7, 9, 13), (3, 5, 7, 9))),
    "sphere": ("Thick-walled sphere", SPHERE, (), sphere, ((3, 4, 6, 8), (3, 4, 6, 8, 12, 16), (3, 4, 6, 8))),
    "kirsch": ("Plate with a hole", KIRSCH, (), kirsch, ((4, 8, 16, 32), (4, 8, 16, 32, 64), (4, 8, 16, 32))),
    "line": ("Hertz's line contact", ROOT / "inputs/hertz_cylinder/hertz_cylinder.yaml", ("cylinder", "block"), line,
             ((0.4, 0.2, 0.1, 0.05), (0.4, 0.2, 0.1, 0.05, 0.025), (0.4, 0.2, 0.1, 0.05))),
    "point": ("Hertz's point contact", ROOT / "inputs/hertz_sphere/hertz_sphere.yaml", ("sphere", "block"), point,
              ((0.2, 0.14, 0.1, 0.07), (0.2, 0.14, 0.1, 0.07, 0.05), (0.2, 0.14, 0.1, 0.07))),
}
METHODS = ("boundary elements", "first order", "second order")


def run(mortise, case, method, size, directory):
    """Unknowns, error and CPU seconds."""
    _, source, bodies, formula, _ = CASES[case]
    quantity, points = formula()
    of_bodies = "boundary_elements" if method == METHODS[0] else "finite_elements"
    order = 2 if method == METHODS[2] else 1
    settings = ["output.interior={points: [%s]}" % ", ".join(str(list(x)) for x, _ in points), "solver.tolerance=1e-6"]
    deck = source
    if bodies:
        extra = ", d: 3, W: 2000, H: 2000" if case == "line" else ""
        settings += [f"bodies.{b}.method={of_bodies}" for b in bodies] + [f"mesh.constants={{h: {size}, order: {order}{extra}}}"]
        if case == "line":
            settings += [f"loads=[{{boundary: cylinder_top, force: [0, {-LINE_FORCE / 2}]}}]"]
    else:
        deck = directory / "deck.yaml"
        deck.write_text(source.format(decks=DECKS, size=size, order=order, method=of_bodies))
    summary, seconds = solve(mortise, deck, settings, directory)
    with (directory / "out" / "interior.csv").open(newline="") as lines:
        rows = list(csv.DictReader(lines))
    if len(rows) != len(points):
        raise SystemExit(f"{case}: {len(rows)} rows of interior.csv for {len(points)} points")
    largest = max(abs(exact) for _, exact in points)
    square = sum((float(row[quantity]) - exact)**2 for row, (_, exact) in zip(rows, points)) / len(points)
    return summary["primal_unknowns"], math.sqrt(square) / largest, seconds


def judge(case, found):
    failures = []
    of_boundary = found[METHODS[0]]
    for size, (_, error, _) in of_boundary.items():
        if size in found[METHODS[1]] and error > max(found[METHODS[1]][size][1], 0.002):
            failures.append(f"{case}, {size}: boundary elements are farther off than first order")
    errors = [error for _, error, _ in of_boundary.values()]
    if errors[-1] > max(0.5 * errors[0], 0.002):
        failures.append(f"{case}: boundary elements do not converge")
    return failures


HEAD = ["case", "size"] + [f"{method}: unknowns, error, CPU s" for method in METHODS]


def table(found):
    lines = []
    for case, results in found.items():
        for size in dict.fromkeys(size for method in METHODS for size in results[method]):
            cells = []
            for method in METHODS:
                unknowns, error, seconds = results[method].get(size, (None, None, None))
                cells.append("-" if unknowns is None else f"{unknowns:,}: {100 * error:.2g} %, {seconds:.1f}")
            lines.append([f"`{case}`", str(size), *cells])
    return lines


def plot(found, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot
    figure, axes = pyplot.subplots(1, len(found), figsize=(2.8 * len(found), 3), squeeze=False, sharey=True)
    for axis, (case, results) in zip(axes[0], found.items()):
        for method, style in zip(METHODS, ("o-", "s--", "^:")):
            axis.loglog([r[2] for r in results[method].values()], [100 * r[1] for r in results[method].values()], style, label=method)
        axis.set_title(CASES[case][0], fontsize=10)
        axis.set_xlabel("CPU seconds")
        axis.set_xlim(0.3, 30)
        axis.set_xticks([0.5, 1, 2, 5, 10, 20], labels=["0.5", "1", "2", "5", "10", "20"])
        axis.minorticks_off()
        axis.grid(True, which="major", linewidth=0.3)
    axes[0][0].set_ylabel("error of the stress, %")
    axes[0][0].set_yticks([0.01, 0.1, 1, 10], labels=["0.01", "0.1", "1", "10"])
    axes[0][0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=70)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("cases", nargs="*", metavar="CASE")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--plot", type=pathlib.Path)
    arguments = parser.parse_args()
    found, failures = {}, []
    for case in arguments.cases or CASES:
        found[case] = {}
        for method, sizes in zip(METHODS, CASES[case][4]):
            found[case][method] = {}
            for size in sizes:
                with tempfile.TemporaryDirectory(prefix="mortise_inside_") as directory:
                    found[case][method][size] = run(arguments.mortise, case, method, size, pathlib.Path(directory))
        print(*(" | ".join(row) for row in [HEAD, *table({case: found[case]})]), "", sep="\n", flush=True)
        failures += judge(case, found[case])
    if arguments.write:
        sizes = [(f"`{case}`", str(size)) for case in CASES for size in dict.fromkeys(size for sizes in CASES[case][4] for size in sizes)]
        study.page_tables.write(study.PAGE, "inside", HEAD, table(found), keys=2, known=sizes)
    if arguments.plot:
        plot(found, arguments.plot)
    if failures:
        raise SystemExit("\n".join(failures))


if __name__ == "__main__":
    main()
