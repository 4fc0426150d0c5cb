#!/usr/bin/python3
"""Solves a deck with Mortise and with CalculiX on the same mesh, in turn, one thread each, and prints both.

    calculix.py MORTISE DECK [--constants n=19 n=24 ...] [--solver "ITERATIVE CHOLESKY" | SPOOLES] [--repeat N] [--set KEY=VALUE ...]
                 [--write CASE --exact force=108.2 | pressure=468.8*force**(1/3)]

The deck is translated by postproc/studies/calculix.py, as far as CalculiX has the same; contact is surface to surface with a linear penalty of
`--penalty` times the largest Young's modulus a length. CPU seconds are of the whole run, reading and writing included; a .geo is meshed
beforehand for both. --write puts rows into README.md, with the error of the force or of the largest pressure against --exact, which may
know the run's own force. `./mortise study --calculix` measures errors over the surface. Needs calculix-ccx, gmsh, python3-meshio, python3-yaml.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

import numpy as np
import yaml

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "postproc"))
sys.path.insert(0, str(HERE.parent))
import page_tables  # noqa: E402
from studies import calculix, measure  # noqa: E402
from studies.deck import read_deck  # noqa: E402


def write_mesh(deck, path, constants, target, dimension):
    command = ["gmsh", f"-{dimension}", str((path.parent / deck["mesh"]["file"]).resolve()), "-format", "msh2", "-o", str(target)]
    for key, value in dict(deck["mesh"].get("constants", {}), **dict(c.split("=") for c in constants.split(",") if c)).items():
        command += ["-setnumber", key, str(value)]
    subprocess.run(command, check=True, capture_output=True)


HEAD = ["case", "unknowns", "CalculiX: CPU s / MB", "error", "Mortise: CPU s / MB", "error", "products", "CPU ratio"]


def error(exact, force, pressure):
    """Relative, of the force or the pressure, as text. `exact`: NAME=EXPRESSION."""
    name, expression = exact.split("=", 1)
    expected = eval(expression, {"__builtins__": {}}, {"force": force})  # of our own command line
    return f"{100 * ({'force': force, 'pressure': pressure}[name] / expected - 1):+.1f} %"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise", type=pathlib.Path)
    parser.add_argument("deck", type=pathlib.Path)
    parser.add_argument("--constants", nargs="*", default=[""])
    parser.add_argument("--solver", default="ITERATIVE CHOLESKY")
    parser.add_argument("--penalty", type=float, default=50, help="stiffness a length, in Young's moduli")
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--write", metavar="CASE", help="a row for each of the constants; needs --exact")
    parser.add_argument("--exact", metavar="NAME=EXPRESSION")
    arguments = parser.parse_args()
    if arguments.write and not arguments.exact:
        parser.error("--write needs --exact")
    mortise = str(arguments.mortise.resolve())
    deck = read_deck(arguments.deck, [])
    dimension = 3 if deck.get("dimension", 3) == 3 else 2
    print(
        "constants | unknowns | CalculiX: CPU s | MB | force | pressure | "
        "Mortise: CPU s | MB | force | pressure | products | CPU ratio | memory ratio"
    )
    for constants in arguments.constants:
        with tempfile.TemporaryDirectory(prefix="mortise_comparison_") as name:
            directory = pathlib.Path(name)
            write_mesh(deck, arguments.deck, constants, directory / "mesh.msh", dimension)
            mesh = calculix.Mesh(directory / "mesh.msh", dimension)
            (directory / "deck.yaml").write_text(yaml.safe_dump(dict(deck, mesh={"file": "mesh.msh"})))
            theirs, ours = [], []
            for _ in range(arguments.repeat):
                theirs.append(calculix.solve(deck, mesh, arguments.penalty, arguments.solver, directory))
                if theirs[-1].status != 0:
                    raise SystemExit(theirs[-1].text[-1500:])
                ours.append(measure.run([mortise, "deck.yaml", "--output", "out"] + [w for s in arguments.set for w in ("--set", s)], directory))
                if ours[-1].status != 0:
                    raise SystemExit(ours[-1].text)
            force = np.abs(calculix.reactions(directory, len(deck["supports"]))).max()
            pressure = calculix.largest_pressure(directory)
            summary = json.loads((directory / "out/summary.json").read_text())
            contact = summary["contacts"][0]
            seconds = [statistics.median(run.cpu for run in runs) for runs in (theirs, ours)]
            memory = [statistics.median(run.memory for run in runs) for runs in (theirs, ours)]
            own_force, own_pressure = np.abs(contact["force"]).max(), contact["max_recovered_pressure"]
            print(
                f"{constants} | {mesh.unknowns()} | {seconds[0]:.1f} | {memory[0]:.0f} | {force:.6g} | {pressure:.6g} | "
                f"{seconds[1]:.1f} | {memory[1]:.0f} | {own_force:.6g} | {own_pressure:.6g} | "
                f"{summary['hessian_multiplications']} | {seconds[0] / seconds[1]:.2f} | {memory[0] / memory[1]:.2f}",
                flush=True,
            )
            if arguments.write:
                row = [arguments.write, f"{mesh.unknowns():,}", f"{seconds[0]:.1f} / {memory[0]:,.0f}", error(arguments.exact, force, pressure),
                       f"{seconds[1]:.1f} / {memory[1]:,.0f}", error(arguments.exact, own_force, own_pressure),
                       summary["hessian_multiplications"], f"{seconds[0] / seconds[1]:.1f}"]
                page_tables.write(HERE / "README.md", "CalculiX", HEAD, [row], keys=2)


if __name__ == "__main__":
    main()
