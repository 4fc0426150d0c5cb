#!/usr/bin/env python3
"""Solves a deck with Mortise and with CalculiX on the same mesh, in turn, one thread each, and prints both.

    calculix.py MORTISE DECK [--constants n=19 n=24 ...] [--solver "ITERATIVE CHOLESKY" | SPOOLES] [--repeat N] [--set KEY=VALUE ...]

The deck is translated as far as CalculiX has the same: elastic materials, prescribed displacements, pressures, frictionless contact
(surface to surface, linear penalty of `--penalty` times the largest Young's modulus over the size of a cell at the contact). CPU seconds are of the whole run,
reading and writing included; of Mortise also the meshing by gmsh where the deck names a .geo, so it is given the .msh here. Needs
calculix-ccx, gmsh, python3-meshio, python3-yaml.
"""
import argparse
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

import meshio
import numpy as np
import yaml

ELEMENT = {"hexahedron": "C3D8", "tetra": "C3D4", "wedge": "C3D6"}
# Corners of the faces S1, S2, ... in CalculiX's order.
FACES = {"hexahedron": [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)],
         "tetra": [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)],
         "wedge": [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)]}


class Mesh:
    """Nodes, volumes by body and faces by boundary of a .msh file, numbered from 1."""

    def __init__(self, path):
        mesh = meshio.read(path)
        self.points = mesh.points
        name = {int(data[0]): key for key, data in mesh.field_data.items()}
        self.bodies, self.boundaries, self.faces = {}, {}, {}
        element = 0
        for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
            for tag in np.unique(tags):
                cells = block.data[tags == tag]
                if block.type in ELEMENT:
                    numbers = np.arange(element + 1, element + 1 + len(cells))
                    element += len(cells)
                    self.bodies.setdefault(name[tag], []).append((block.type, numbers, cells))
                    for side, corners in enumerate(FACES[block.type]):
                        for number, nodes in zip(numbers, np.sort(cells[:, corners], axis=1)):
                            self.faces[tuple(nodes)] = (number, side + 1)
                else:
                    self.boundaries.setdefault(name[tag], []).extend(cells)

    def nodes(self, boundary):
        return sorted({int(n) + 1 for face in self.boundaries[boundary] for n in face})

    def sides(self, boundary):
        return [self.faces[tuple(sorted(face))] for face in self.boundaries[boundary]]


def numbers(value):
    """PyYAML takes 210.0e3 for a string."""
    if isinstance(value, dict):
        return {key: numbers(part) for key, part in value.items()}
    if isinstance(value, list):
        return [numbers(part) for part in value]
    try:
        return float(value) if isinstance(value, str) else value
    except ValueError:
        return value


def lines(values, width=12):
    values = list(values)
    return [", ".join(map(str, values[i:i + width])) + "," for i in range(0, len(values), width)]


def input_file(deck, mesh, penalty, solver):
    """The deck in CalculiX's language, as far as it goes."""
    text = ["*NODE, NSET=ALL"] + [f"{i + 1}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(mesh.points)]
    for body, blocks in mesh.bodies.items():
        for kind, numbers, cells in blocks:
            text.append(f"*ELEMENT, TYPE={ELEMENT[kind]}, ELSET={body}")
            text += [", ".join(map(str, [number, *(cell + 1)])) for number, cell in zip(numbers, cells)]
    for name, material in deck["materials"].items():
        text += [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{material['young_modulus']}, {material['poisson_ratio']}"]
    for name, body in deck["bodies"].items():
        text.append(f"*SOLID SECTION, ELSET={name}, MATERIAL={body['material']}")
    for support in deck["supports"]:
        text += [f"*NSET, NSET=N{support['boundary']}"] + lines(mesh.nodes(support["boundary"]))
    for contact in deck["contacts"]:
        for side in (contact["secondary"], contact["primary"]):
            text += [f"*SURFACE, NAME=S{side}, TYPE=ELEMENT"] + [f"{e}, S{s}" for e, s in mesh.sides(side)]
        text += ["*SURFACE INTERACTION, NAME=touch", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{penalty:g}, 0.",
                 "*CONTACT PAIR, INTERACTION=touch, TYPE=SURFACE TO SURFACE", f"S{contact['secondary']}, S{contact['primary']}"]
    text += ["*STEP", f"*STATIC, SOLVER={solver}", "1., 1.", "*BOUNDARY"]
    for support in deck["supports"]:
        for component, value in support["displacement"].items():
            axis = "xyz".index(component) + 1
            text.append(f"N{support['boundary']}, {axis}, {axis}, {value}")
    for load in deck.get("loads", []):
        text.append("*DLOAD")
        text += [f"{e}, P{s}, {load['pressure']}" for e, s in mesh.sides(load["boundary"])]
    for support in deck["supports"]:
        text += [f"*NODE PRINT, NSET=N{support['boundary']}, TOTALS=ONLY", "RF"]
    text += ["*CONTACT PRINT", "CSTR", "*NODE FILE", "U", "*EL FILE", "S", "*CONTACT FILE", "CDIS, CSTR", "*END STEP"]
    return "\n".join(text) + "\n"


def measured(command, directory):
    """Runs it alone; CPU seconds, peak memory in MB, exit status."""
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    with open(directory / "log", "w") as log:
        process = subprocess.Popen(command, cwd=directory, stdout=log, stderr=subprocess.STDOUT, env=environment)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1e3, process.returncode


def of_calculix(directory):
    """Largest sum of reactions over the supports and the largest contact pressure, from job.dat."""
    text = (directory / "job.dat").read_text()
    totals = re.findall(r"total force \(fx,fy,fz\).*?\n\s*\n\s*(\S+)\s+(\S+)\s+(\S+)", text)
    force = max(abs(float(value)) for row in totals for value in row)
    pressure = 0.0
    for block in text.split("contact stress")[1:]:
        for row in block.split("\n")[2:]:
            fields = row.split()
            if len(fields) < 5 or not fields[0].isdigit():
                break
            pressure = max(pressure, float(fields[-3]))
    return force, pressure


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("deck", type=pathlib.Path)
    parser.add_argument("--constants", nargs="*", default=[""])
    parser.add_argument("--solver", default="ITERATIVE CHOLESKY")
    parser.add_argument("--penalty", type=float, default=50, help="stiffness a length, in Young's moduli")
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--set", action="append", default=[])
    arguments = parser.parse_args()
    mortise = os.path.abspath(arguments.mortise)
    deck = numbers(yaml.safe_load(arguments.deck.read_text()))
    stiffest = max(m["young_modulus"] for m in deck["materials"].values())
    print("constants | unknowns | CalculiX: CPU s | MB | force | pressure | Mortise: CPU s | MB | force | pressure | products | CPU ratio | memory ratio")
    for constants in arguments.constants:
        with tempfile.TemporaryDirectory(prefix="mortise_comparison_") as name:
            directory = pathlib.Path(name)
            geometry = (arguments.deck.parent / deck["mesh"]["file"]).resolve()
            command = ["gmsh", "-3", str(geometry), "-format", "msh2", "-o", str(directory / "mesh.msh")]
            for key, value in dict(deck["mesh"].get("constants", {}), **dict(c.split("=") for c in constants.split(",") if c)).items():
                command += ["-setnumber", key, str(value)]
            subprocess.run(command, check=True, capture_output=True)
            mesh = Mesh(directory / "mesh.msh")
            (directory / "job.inp").write_text(input_file(deck, mesh, arguments.penalty * stiffest, arguments.solver))
            own = dict(deck, mesh={"file": "mesh.msh"})
            (directory / "deck.yaml").write_text(yaml.safe_dump(own))
            theirs, ours = [], []
            for _ in range(arguments.repeat):
                theirs.append(measured(["ccx", "-i", "job"], directory))
                if theirs[-1][2] != 0:
                    print((directory / "log").read_text()[-1500:], file=sys.stderr)
                ours.append(measured([mortise, "deck.yaml", "--output", "out"] + [w for s in arguments.set for w in ("--set", s)], directory))
                if ours[-1][2] != 0:
                    raise SystemExit((directory / "log").read_text())
            force, pressure = of_calculix(directory)
            summary = json.loads((directory / "out/summary.json").read_text())
            contact = summary["contacts"][0]
            seconds = [statistics.median(run[0] for run in runs) for runs in (theirs, ours)]
            memory = [statistics.median(run[1] for run in runs) for runs in (theirs, ours)]
            print(f"{constants} | {3 * len(mesh.points)} | {seconds[0]:.1f} | {memory[0]:.0f} | {force:.6g} | {pressure:.6g} | "
                  f"{seconds[1]:.1f} | {memory[1]:.0f} | {np.abs(contact['force']).max():.6g} | {contact['max_recovered_pressure']:.6g} | "
                  f"{summary['hessian_multiplications']} | {seconds[0] / seconds[1]:.2f} | {memory[0] / memory[1]:.2f}", flush=True)


if __name__ == "__main__":
    main()
