#!/usr/bin/env python3
"""Boundary elements beside finite elements on the same surface mesh: error against unknowns and CPU seconds.

    methods.py MORTISE [--quick | --write] [CASE ...]

hertz    inputs/hertz_sphere against Hertz's largest pressure, sizes 0.2 to 0.05
punch    a punch on a nearly incompressible block (Poisson's ratio 0.49): the work of the force against hex20 of half the size
beam     a cantilever 4 : 1 : 1 under a shear at its end: the same against hex20

Prints a table for each case; --write puts them into results.md. Fails if an error of boundary elements exceeds the bound of its size, if they are worse than linear cells
of the same mesh, or if an estimated error is less than two thirds of the true one (cases with an energy to compare with). --quick: the
two coarsest sizes.
"""
import argparse
import json
import math
import os
import pathlib
import resource
import subprocess
import tempfile

import study

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERTZ = (6 * 4 * 830.77 * (210e3 / (2 * (1 - 0.3**2)))**2 / (math.pi**3 * 10**2))**(1 / 3)  # largest pressure [Johnson 1985, 4.24]

BLOCKS = {
    "punch": """
dimension: 3
mesh:
  blocks:
    base: {{origin: [0, 0, 0], size: [2, 2, 1], cells: [{a}, {a}, {b}], element: {cell}}}
    punch: {{origin: [0.5, 0.5, 1], size: [1, 1, 0.5], cells: [{b}, {b}, {c}], element: {cell}}}
materials:
  rubber: {{young_modulus: 10, poisson_ratio: 0.49}}
  steel: {{young_modulus: 1000, poisson_ratio: 0.3}}
bodies:
  base: {{material: rubber, method: {method}}}
  punch: {{material: steel, method: {method}}}
supports:
  - {{boundary: base.zmin, displacement: {{x: 0, y: 0, z: 0}}}}
  - {{boundary: punch.zmax, displacement: {{x: 0, y: 0}}}}
loads:
  - {{boundary: punch.zmax, pressure: 0.1}}
contacts:
  - {{name: foot, secondary: punch.zmin, primary: base.zmax, friction: {{bonded: true}}}}
solver: {{tolerance: 1.0e-7}}
""",
    "beam": """
dimension: 3
mesh:
  blocks:
    beam: {{origin: [0, 0, 0], size: [4, 1, 1], cells: [{a}, {c}, {c}], element: {cell}}}
materials:
  steel: {{young_modulus: 1000, poisson_ratio: 0.3}}
bodies:
  beam: {{material: steel, method: {method}}}
supports:
  - {{boundary: beam.xmin, displacement: {{x: 0, y: 0, z: 0}}}}
loads:
  - {{boundary: beam.xmax, traction: [0, 0, 1]}}
solver: {{tolerance: 1.0e-7}}
"""}
# Cells by size: a, b, c of the decks above; the last is that of the reference, hex20.
CELLS = {"punch": [(4, 2, 1), (8, 4, 2), (12, 6, 3)], "beam": [(8, 2, 2), (16, 4, 4), (24, 6, 6)]}
REFERENCE = {"punch": (24, 12, 6), "beam": (48, 12, 12)}
# Strain energies of two thirds of those cells, with which --quick compares: 17 s of CPU.
QUICK_REFERENCE = {"punch": 0.00018496128646128704, "beam": 0.13188446540560744}
# Relative errors that boundary elements may have on the coarsest mesh: of the pressure, or of the energy.
BOUND = {"hertz": 0.06, "punch": 0.15, "beam": 0.08}


def solve(mortise, deck, settings, directory):
    command = [mortise, str(deck), "--output", str(directory / "out")]
    for value in settings:
        command += ["--set", value]
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    finished = subprocess.run(command, capture_output=True, text=True, env=environment)
    if finished.returncode != 0:
        raise SystemExit(f"{deck}, {settings}: exit status {finished.returncode}\n{finished.stdout[-2000:]}{finished.stderr[-2000:]}")
    summary = json.loads((directory / "out" / "summary.json").read_text())
    return summary, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def block_deck(case, cells, cell, method, directory):
    deck = directory / "deck.yaml"
    deck.write_text(BLOCKS[case].format(a=cells[0], b=cells[1], c=cells[2], cell=cell, method=method))
    return deck


def runs(mortise, case, quick, directory):
    """(size, method) and summary, seconds of each run, and the energy of the reference or None."""
    rows, energy = [], None
    if case == "hertz":
        for h in (0.2, 0.14) if quick else (0.2, 0.14, 0.1, 0.07, 0.05):
            for method in ("finite_elements", "boundary_elements"):
                if method == "boundary_elements" and h < 0.07:
                    continue  # 7,000 panels: beyond what one matrix is for
                settings = [f"bodies.{b}.method={method}" for b in ("sphere", "block")] + [f"mesh.constants.h={h}"]
                rows.append((h, method, *solve(mortise, ROOT / "inputs/hertz_sphere/hertz_sphere.yaml", settings, directory)))
        return rows, energy
    for cells in CELLS[case][:2] if quick else CELLS[case]:
        for method in ("finite_elements", "boundary_elements"):
            rows.append((cells[0], method, *solve(mortise, block_deck(case, cells, "hex8", method, directory), [], directory)))
    if quick:
        return rows, QUICK_REFERENCE[case]
    reference = REFERENCE[case]
    energy = solve(mortise, block_deck(case, reference, "hex20", "finite_elements", directory), [], directory)[0]["strain_energy"]
    return rows, energy


def judge(case, rows, energy):
    """What is wrong with the runs of a case; its table: the heading and the rows."""
    found, failures = {}, []
    head = [case, "method", "unknowns", f"error of the {'pressure' if energy is None else 'energy'}",
            "error in the energy norm: estimated, true", "products", "CPU s"]
    table = []
    for size, method, summary, seconds in rows:
        claimed, true = summary["error_estimate"]["discretization"], None
        if energy is None:
            error = summary["contacts"][0]["max_pressure"] / HERTZ - 1
        else:
            error = summary["strain_energy"] / energy - 1
            true = math.sqrt(abs(error))
            if method == "boundary_elements" and true > 1.5 * claimed:
                failures.append(f"{case}, {size}: {method} claim {claimed:.3f}, and {true:.3f} is true")
        found[size, method] = abs(error)
        table.append([str(size), method.replace("_", " "), f"{summary['primal_unknowns']:,}", f"{100 * error:+.2f} %",
                      f"{100 * claimed:.1f} %{'' if true is None else f', {100 * true:.1f} %'}", str(summary["hessian_multiplications"]), f"{seconds:.1f}"])
    print(*(" | ".join(row) for row in [head, *table]), "", sep="\n", flush=True)
    sizes = [size for size, method, *_ in rows if method == "boundary_elements"]
    if found[sizes[0], "boundary_elements"] > BOUND[case]:
        failures.append(f"{case}: boundary elements are {100 * found[sizes[0], 'boundary_elements']:.1f} % off on the coarsest mesh")
    for size in sizes:
        if found[size, "boundary_elements"] > max(1.5 * found[size, "finite_elements"], 0.005):
            failures.append(f"{case}, {size}: boundary elements are farther off than finite elements")
    if found[sizes[-1], "boundary_elements"] > 0.7 * found[sizes[0], "boundary_elements"]:
        failures.append(f"{case}: boundary elements do not converge")
    return failures, head, table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("cases", nargs="*", metavar="CASE")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--write", action="store_true", help="the tables into results.md")
    arguments = parser.parse_args()
    failures = []
    for case in arguments.cases or BOUND:
        with tempfile.TemporaryDirectory(prefix="mortise_methods_") as directory:
            complaints, head, table = judge(case, *runs(arguments.mortise, case, arguments.quick, pathlib.Path(directory)))
        failures += complaints
        if arguments.write and not arguments.quick:
            study.page_tables.write(study.PAGE, f"methods: {case}", head, table, keys=2, known=[tuple(row[:2]) for row in table])
    if failures:
        raise SystemExit("\n".join(failures))


if __name__ == "__main__":
    main()
