#!/usr/bin/python3
"""Solves bolted_flange.yaml with Mortise and with CalculiX on the same meshes, one thread each, and prints both.

    bolted_flange.py MORTISE [--sizes 10 6 4] [--solvers SPOOLES "ITERATIVE CHOLESKY"] [--limit SECONDS] [--penalty 50] [--write]

Contact as in ../calculix.py, CPU seconds of whole runs, reading and writing included. What both should agree on at the end of the second step: how
much the load adds to the bolts' forces, the friction force that the joint carries along x, how far the end of the pipe rises and the joint opens
below it. --write puts rows into ../README.md, CalculiX / Mortise where both agree, and leaves cells of solvers that did not run as they are. Needs
calculix-ccx, gmsh, python3-meshio, python3-yaml.
"""

import argparse
import json
import pathlib
import re
import sys
import tempfile

import numpy as np
import yaml

HERE = pathlib.Path(__file__).resolve().parent
for folder in (HERE.parent, HERE.parents[1], HERE.parents[2] / "postproc"):
    sys.path.insert(0, str(folder))
import calculix as cases  # noqa: E402
import page_tables  # noqa: E402
from studies import calculix, measure  # noqa: E402
from studies.deck import read_deck  # noqa: E402

DECK = HERE / "bolted_flange.yaml"
SOLVERS = {"SPOOLES": "SPOOLES: CPU s / MB", "ITERATIVE CHOLESKY": "iterative: CPU s / MB"}
AGREEMENT = ["added to the bolts, N", "joint, N", "rise, mm", "opening, mm"]
HEAD = ["unknowns", *SOLVERS.values(), "Mortise: CPU s / MB", "products", "CPU ratio", *AGREEMENT]
FORMATS = ["{:.0f}", "{:.0f}", "{:.5f}", "{:.5f}"]


def preloads(deck):
    return [contact["preload"]["force"] for contact in deck["contacts"] if "preload" in contact]


def quantities(added, friction, end, upper, lower):
    return [added, friction, end[2], upper[2] - lower[2]]


def of_mortise(directory, deck):
    last = json.loads((directory / "out/summary.json").read_text())["steps"][-1]
    contacts = {contact["name"]: contact for contact in last["contacts"]}
    at = {(probe["name"], probe["place"]["body"]): probe["displacement"] for probe in last["probes"]}
    added = sum(contact["preload"]["force"] for contact in contacts.values() if "preload" in contact) - sum(preloads(deck))
    return quantities(added, abs(contacts["joint"]["force"][0]), at["end", "upper"], at["heel", "upper"], at["heel", "lower"])


def of_calculix(directory, deck, mesh):
    rows = re.findall(r"total surface force.*?\n\s*\n\s*(\S+)\s+(\S+)\s+(\S+)", (directory / "job.dat").read_text())
    joint, *heads = np.array(rows[-1 - len(preloads(deck)):], dtype=float)  # the deck's order
    displacements = dict(zip(*calculix.nodal_field(directory, "DISP")))

    def at(place, body):
        own = np.unique([cells for _, _, cells in mesh.bodies[body]])
        return displacements[1 + own[np.linalg.norm(mesh.points[own] - place, axis=1).argmin()]]

    probes = deck["output"]["probes"]
    end, heel = probes["end"]["point"], probes["heel"]["point"]
    added = sum(head[2] for head in heads) - sum(preloads(deck))
    return quantities(added, abs(joint[0]), at(end, "upper"), at(heel, "upper"), at(heel, "lower"))


def iterations(directory):
    """Of all steps that CalculiX has solved or begun."""
    return len(re.findall(r"(?m)^( +\d+){4} ", (directory / "job.cvg").read_text()))


def as_cell(run):
    return f"{run.cpu:,.1f} / {run.memory:,.0f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise", type=pathlib.Path)
    parser.add_argument("--sizes", nargs="*", default=["10", "6", "4"], help="h of bolted_flange.geo")
    parser.add_argument("--solvers", nargs="*", default=list(SOLVERS), choices=SOLVERS)
    parser.add_argument("--limit", type=float, default=3600, help="seconds that a run may take")
    parser.add_argument("--penalty", type=float, default=50, help="stiffness a length, in Young's moduli")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    deck = read_deck(DECK, [])
    page = HERE.parent / "README.md"
    for h in arguments.sizes:
        with tempfile.TemporaryDirectory(prefix="mortise_flange_") as name:
            directory = pathlib.Path(name)
            cases.write_mesh(deck, DECK, f"h={h}", directory / "mesh.msh", 3)
            (directory / "deck.yaml").write_text(yaml.safe_dump(dict(deck, mesh={"file": "mesh.msh"})))
            ours = measure.run([str(arguments.mortise.resolve()), "deck.yaml", "--output", "out"], directory)
            if ours.status != 0:
                raise SystemExit(ours.text)
            own = of_mortise(directory, deck)
            products = json.loads((directory / "out/summary.json").read_text())["hessian_multiplications"]
            unknowns = f"{calculix.Mesh(directory / 'mesh.msh', 3).unknowns():,}"
            print(f"{unknowns} unknowns\n  Mortise: {as_cell(ours)}, {products} products", *map(str.format, FORMATS, own), sep=", ", flush=True)
            row = dict.fromkeys(HEAD)
            row.update({HEAD[0]: unknowns, HEAD[3]: as_cell(ours), HEAD[4]: products})
            for solver in arguments.solvers:
                mesh = calculix.Mesh(directory / "mesh.msh", 3)
                run = calculix.solve(deck, mesh, arguments.penalty, solver, directory, arguments.limit)
                cell, found = as_cell(run), None
                if run.status == 0:
                    found = of_calculix(directory, deck, mesh)
                elif run.status == -9:
                    cell = f"not within {run.cpu:,.0f} / {run.memory:,.0f}"
                elif "too many cutbacks" in run.text or "divergence" in run.text:
                    cell = "does not converge"
                else:
                    raise SystemExit(run.text[-1500:])
                print(f"  {solver}: {cell}, {iterations(directory)} Newton iterations", *map(str.format, FORMATS, found or []), sep=", ", flush=True)
                row[SOLVERS[solver]] = cell
                if solver == "SPOOLES":
                    row[HEAD[5]] = f"{run.cpu / ours.cpu:.0f}" if found else f"more than {run.cpu / ours.cpu:.0f}"
                if found and (solver == "SPOOLES" or row[HEAD[-1]] is None):
                    row.update({key: f"{form.format(a)} / {form.format(b)}" for key, form, a, b in zip(AGREEMENT, FORMATS, found, own)})
            if arguments.write:
                page_tables.write(page, "flange", HEAD, [list(row.values())])


if __name__ == "__main__":
    main()
