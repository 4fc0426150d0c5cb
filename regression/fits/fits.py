#!/usr/bin/env python3
"""Pins and balls of exactly their holes' radius, without a load: no stress, on meshes of every cell, with either side as secondary.

    fits.py MORTISE [--mpiexec MPIEXEC] [--only TEXT] [--quick]

--quick: of each cell one side alone, the holes' and the pins' in turn; of the cells prism6 alone on several ranks; discs of hex20 alone in space.

`clearance: 0` and what the geometry says give at most 1e-6 of Young's modulus. That the meshes alone would press is checked as well,
and that the program says so. `touch`: a disc that touches two plates inside an edge of its cells, which has no stress either."""

import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
YOUNG = 2.1e5

# Name: constants of pin.geo, dimension of the deck.
CELLS = {
    "tet4": ("kind: 0, order: 1", 3), "tet10": ("kind: 0, order: 2", 3),
    "prism6": ("kind: 1, order: 1", 3), "prism15": ("kind: 1, order: 2, incomplete: 1", 3),
    "hex8": ("kind: 2, order: 1", 3), "hex20": ("kind: 2, order: 2, incomplete: 1", 3), "hex27": ("kind: 2, order: 2", 3),
    "tri3": ("kind: 0, order: 1, plane: 1", "plane_strain"), "tri6": ("kind: 0, order: 2, plane: 1", "plane_stress"),
    "quad4": ("kind: 2, order: 1, plane: 1", "plane_strain"), "quad8": ("kind: 2, order: 2, incomplete: 1, plane: 1", "plane_strain"),
    "quad9": ("kind: 2, order: 2, plane: 1", "plane_strain"),
}


def deck(geometry, constants, dimension, bodies, contact):
    body = ", ".join(f"{name}: {{material: steel}}" for name in bodies)
    ends = ["bottom"] if "ball" in bodies else ["left", "end"] if dimension == 3 else ["left"]
    held = ", ".join(f"{{boundary: {end}, displacement: {{x: 0, y: 0{', z: 0' if dimension == 3 else ''}}}}}" for end in ends)
    return f"""dimension: {dimension}
mesh: {{file: {HERE / geometry}, constants: {{{constants}}}}}
materials: {{steel: {{young_modulus: {YOUNG}, poisson_ratio: 0.3}}}}
bodies: {{{body}}}
supports: [{held}]
contacts: [{contact}]
"""


def solve(arguments, text, ranks):
    """The summary and the terminal's text."""
    with tempfile.TemporaryDirectory() as scratch:
        file, output = pathlib.Path(scratch) / "fit.yaml", pathlib.Path(scratch) / "out"
        file.write_text(text)
        command = [arguments.mortise, str(file), "--output", str(output)]
        if ranks > 1:
            command = [arguments.mpiexec, "--oversubscribe", "-n", str(ranks)] + command
        environment = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=300)
        if done.returncode != 0:
            raise SystemExit(f"{text}\n{done.stdout}{done.stderr}\nexit status {done.returncode}")
        return json.loads((output / "summary.json").read_text()), done.stdout + done.stderr


def runs(quick):
    """Name, deck, whether it fits, ranks, text that must be shown."""
    geometry_says = "one surface in the geometry: gap 0"
    for number, (cell, (constants, dimension)) in enumerate(CELLS.items()):
        for side, (secondary, primary) in enumerate((("hole", "shank"), ("shank", "hole"))):
            if quick and side != number % 2:
                continue
            sides = f"secondary: {secondary}, primary: {primary}"
            ranks = 1 + number % 3 if not quick or cell == "prism6" else 1
            # The pin is a spline here: nothing but the deck says that the two fit.
            yield (f"{cell} {secondary} clearance", deck("pin.geo", constants + ", analytic: 0", dimension, ("plate", "pin"),
                   f"{{{sides}, clearance: 0}}"), True, ranks, "by `clearance`")
            if (secondary == "shank" or quick) and number % 4 != 1:
                continue
            yield (f"{cell} {secondary} geometry", deck("pin.geo", constants, dimension, ("plate", "pin"), f"{{{sides}}}"),
                   True, 1, geometry_says)
    for order in (1, 2):
        for side, (secondary, primary) in enumerate((("socket", "surface"), ("surface", "socket"))):
            if quick and side != order - 1:
                continue
            sides = f"secondary: {secondary}, primary: {primary}"
            yield (f"ball {order} {secondary}", deck("ball.geo", f"order: {order}", 3, ("ball", "block"), f"{{{sides}}}"), True, 1,
                   geometry_says)
    yield ("ball clearance", deck("ball.geo", "order: 2", 3, ("ball", "block"), "{secondary: socket, primary: surface, clearance: 0}"),
           True, 2, "by `clearance`")
    three_d = CELLS["tet4"][0]
    yield ("auto", deck("pin.geo", three_d, 3, ("plate", "pin"), "{auto: true}"), True, 2, geometry_says)
    for name, key in (("nodal", "discretization: node_to_segment"), ("adjust", "adjust: 0.5"), ("friction", "friction: {coulomb: 0.2}")):
        yield (name, deck("pin.geo", three_d, 3, ("plate", "pin"), f"{{secondary: hole, primary: shank, {key}}}"), True, 1, "initial gap 0 to 0")
    # Nothing but the fit presses: what rounding leaves of its forces is no load that does not balance.
    yield ("meshes alone in a plane", deck("pin.geo", *CELLS["tri6"], ("plate", "pin"), "{secondary: shank, primary: hole, adjust: 0}"), False, 1,
           "the two sides overlap by")


TOUCHING = {
    "tri3": "order: 1", "tri6": "order: 2", "quad8": "kind: 2, order: 2, incomplete: 1", "quad9": "kind: 2, order: 2",
    "tet10": "order: 2, plane: 0", "hex20": "kind: 2, order: 2, incomplete: 1, plane: 0", "hex27": "kind: 2, order: 2, plane: 0",
}


def touching(quick):
    """Name, deck."""
    for number, (cell, constants) in enumerate(TOUCHING.items()):
        for side, name in enumerate(("disc", "plates")):
            if quick and (side != number % 2 or cell in ("tet10", "hex27")):
                continue
            pairs = [("rim", plate) if name == "disc" else (plate, "rim") for plate in ("above_side", "below_side")]
            contacts = ", ".join(f"{{secondary: {a}, primary: {b}}}" for a, b in pairs)
            space = "plane: 0" in constants
            held = ", ".join(f"{{boundary: {end}, displacement: {{x: 0, y: 0{', z: 0' if space else ''}}}}}" for end in ("top", "bottom"))
            yield (f"touch {cell} {name}", f"""dimension: {3 if space else 'plane_strain'}
mesh: {{file: {HERE / 'touch.geo'}, constants: {{{constants}}}}}
materials: {{steel: {{young_modulus: {YOUNG}, poisson_ratio: 0.3}}}}
bodies: {{disc: {{material: steel}}, above: {{material: steel}}, below: {{material: steel}}}}
supports: [{held}]
contacts: [{contacts}]
""")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--mpiexec", default="mpirun")
    parser.add_argument("--only", default="", help="runs whose names have this text")
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    wrong = []
    for name, text, fits, ranks, shown in runs(arguments.quick):
        if arguments.only not in name:
            continue
        summary, output = solve(arguments, text, ranks)
        contact = summary["contacts"][0]
        stress = summary["max_von_mises"] / YOUNG
        good = stress <= 1e-6 if fits else stress > 1e-6
        overlap = contact["initial_gap"]["largest_overlap"]
        good = good and shown in output and (overlap == 0 if fits else overlap > 1e-5) and ("overlap by" in output) != fits
        whole = 2 * math.pi * 10 * (10 if "ball" in text else 12 if "dimension: 3" in text else 1)
        good = good and (not fits or 0.8 * whole < contact["initial_gap"]["touching_area"] < 1.01 * whole)
        print(f"{name:<28} von Mises / E {stress:8.1e}, overlap {overlap:8.1e}, {contact['initial_gap']['touching_area']:.5g} touches"
              f"{'' if good else '   WRONG'}", flush=True)
        if not good:
            wrong.append(f"{name}\n{output}")
    for name, text in touching(arguments.quick):
        if arguments.only not in name:
            continue
        summary, output = solve(arguments, text, 1)
        stress = summary["max_von_mises"] / YOUNG
        good = stress <= 1e-4 and ("overlap by" in output) == (stress > 0)
        print(f"{name:<28} von Mises / E {stress:8.1e}{'' if good else '   WRONG'}", flush=True)
        if not good:
            wrong.append(f"{name}\n{output}")
    print(*wrong, sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
