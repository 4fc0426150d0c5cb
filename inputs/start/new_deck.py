#!/usr/bin/python3
"""Writes a deck to start from, with the bodies and boundaries of a mesh or a CAD file.

    ./mortise new PART.step [-o DECK.yaml] [--dimension 3 | plane_strain | plane_stress | axisymmetric] [--force]

The program itself says what the file holds (`--check`). Exit status: 0 the deck is written; 1 the file cannot be read, or the deck is there.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "import"))
from writers import scalar  # noqa: E402

SCHEMA = HERE.parents[1] / "docs" / "schema.json"
CAD = (".step", ".stp", ".brep", ".geo")
DIMENSIONS = ("3", "plane_strain", "plane_stress", "axisymmetric")


def listing(mortise, mesh, dimension):
    """({body: text}, {boundary: text}, what the program said) of a mesh."""
    with tempfile.TemporaryDirectory(prefix="mortise_new_") as folder:
        probe = pathlib.Path(folder) / "probe.yaml"
        probe.write_text(
            f"dimension: {dimension}\nmesh: {{file: {scalar(str(mesh.resolve()))}}}\nmaterials: {{any: {{young_modulus: 1, poisson_ratio: 0}}}}\n"
            "bodies: {body that no mesh has: {material: any}}\n"
        )
        done = subprocess.run([str(mortise), str(probe), "--check"], capture_output=True, text=True, check=False)
    found = {"body": {}, "boundary": {}}
    for line in done.stdout.splitlines():
        match = re.fullmatch(r"  (body|boundary) (.*?): ((?:[\d.e+]+ (?:cells|panels), from|area |empty).*)", line)
        if match:
            found[match[1]][match[2]] = match[3]
    said = re.sub(r"(?m)^\S*probe\.yaml:\d+: ", "", done.stderr).strip()
    return found["body"], found["boundary"], said


def deck_text(mesh, folder, dimension, bodies, boundaries):
    """A deck that passes --check as it stands; what is to be filled in stands in comments."""
    file = os.path.relpath(mesh.resolve(), folder.resolve())
    components = "x: 0, y: 0, z: 0" if dimension == "3" else "x: 0, y: 0"
    first, last = (list(boundaries) or ["NAME"])[0], (list(boundaries) or ["NAME"])[-1]
    lines = [
        f"# yaml-language-server: $schema={os.path.relpath(SCHEMA, folder.resolve())}",
        f"title: {scalar(mesh.stem)}",
        f"dimension: {dimension}{' ' * max(1, 34 - 11 - len(dimension))}# {' | '.join(DIMENSIONS)}",
        f"mesh: {{file: {scalar(file)}}}",
    ]
    if mesh.suffix.lower() in CAD:
        lines.append(
            "# mesh: {file: ..., size: {max: 2, curvature: 24}, order: 2}    # finer, round curves, and of second order; scale: 0.001 multiplies coordinates"
        )
    lines += [
        "",
        "# In any consistent set of units: mm, N, MPa here. density for weight, thermal_expansion for warmth.",
        "materials:",
        "  steel: {young_modulus: 2.1e5, poisson_ratio: 0.3}",
        "",
        "bodies:",
    ]
    width = max(len(scalar(b)) for b in bodies)
    lines += [f"  {scalar(name)}: {{material: steel}}{' ' * (width - len(scalar(name)))}   # {text}" for name, text in bodies.items()]
    lines += ["", "# Boundaries:" if boundaries else "# The file names no boundaries."]
    lines += [f"#   {name}: {text}" for name, text in boundaries.items()]
    lines += [
        "",
        "# Components that are not named are free; `normal` is along the boundary's own.",
        "# supports:",
        f"#   - {{boundary: {scalar(first)}, displacement: {{{components}}}}}",
        "",
        "# pressure (into the body), traction or force of a boundary; acceleration or temperature_change of a body.",
        "# loads:",
        f"#   - {{boundary: {scalar(last)}, pressure: 1.0}}",
        "",
    ]
    if len(bodies) > 1:
        lines += [
            "# All bodies that face each other; or pairs: - {secondary: ..., primary: ..., friction: {coulomb: 0.2}}",
            "contacts: auto",
            "",
        ]
    return "\n".join(lines + ["# ./mortise explain contacts tells what else there is.", ""])


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="mortise new", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("mesh", type=pathlib.Path, metavar="PART.step|MESH.msh")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="DECK.yaml", help="default: beside the file, under its name")
    parser.add_argument("--dimension", choices=DIMENSIONS, help="default: 3, and plane_strain for a mesh without volumes")
    parser.add_argument("--force", action="store_true", help="replace a deck that is there")
    given = parser.parse_args(arguments)
    target = given.output or given.mesh.with_suffix(".yaml")
    if target.exists() and not given.force:
        print(f"mortise: {target} is there already; --force replaces it", file=sys.stderr)
        return 1
    if not target.parent.is_dir():
        print(f"mortise: there is no folder {target.parent}", file=sys.stderr)
        return 1
    said = ""
    for dimension in [given.dimension] if given.dimension else ["3", "plane_strain"]:
        bodies, boundaries, text = listing(given.program, given.mesh, dimension)
        said = said or text
        if bodies:
            target.write_text(deck_text(given.mesh, target.parent, dimension, bodies, boundaries), encoding="utf-8")
            print(f"{target}: {len(bodies)} bodies, {len(boundaries)} boundaries, dimension {dimension}")
            return 0
    print(f"mortise: {said}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
