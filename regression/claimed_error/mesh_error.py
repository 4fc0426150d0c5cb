#!/usr/bin/env python3
"""Measures whether the mesh's error is what runs claim: random coarse models, each against itself on a fine mesh of second order.

    mesh_error.py MORTISE [--count 40] [--seed 1] [--layers N] [--limit SECONDS] [--write]

Columns of one to three blocks, upright or lying, bonded or in frictionless contact without gaps, clamped at one end or both, under pressures, tractions and
accelerations: then the strain energy grows with the space of displacements, and 1 - E_coarse / E_fine is the square of the true error in the energy norm, or no
less where contact opens. --layers: cells across the thickness of every block (1, 2 or 3; else at random). A model whose fine solution claims an error of more
than half of the true one does not count. A line a model, then the table's row: fails if more than 5 % are off by more than 1.5 times what they claim. Errors
below 1 % count as claimed. --write puts the row into README.md.
"""
import argparse
import math
import pathlib
import random
import sys
import tempfile

import yaml

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.path.insert(0, str(HERE.parent))
from claimed_error import FACTOR, PART, solve  # noqa: E402
import page_tables  # noqa: E402

PLANE = ["quad4", "quad4 incompatible", "tri3", "tri6", "quad8", "quad9"]
SPACE = ["hex8", "hex8 incompatible", "prism6", "tet4", "hex20", "hex27", "prism15", "tet10"]
HEAD = ["seed", "load", "layers", "models", "judged", "off by more than 1.5 times", "median of true over claimed", "a tenth is above", "a tenth is below"]
FLOOR = 0.01


def blocks(generator, space, layers):
    """Sizes and cells of blocks, one on the other along the last axis."""
    width, depth = generator.choice([1, 2, 4, 8]), generator.choice([0.5, 1, 2])
    result, height = {}, 0.0
    for b in range(generator.choice([1, 1, 2, 3])):
        across = layers or generator.choice([1, 2, 3])
        thickness = generator.choice([0.5, 1])
        along = max(2, round(across * width / thickness * generator.choice([0.3, 0.5, 1])))
        size = [width, depth, thickness] if space else [width, thickness]
        cells = [along, max(1, round(across * depth / thickness * 0.7)), across] if space else [along, across]
        result[f"b{b}"] = {"origin": [0, 0, height] if space else [0, height], "size": size, "cells": cells}
        height += thickness
    return result


def twist(generator, deck):
    """Makes of the first block a bar, clamped at one end and twisted at the other."""
    bar = deck["mesh"]["blocks"]["b0"]
    deck["mesh"]["blocks"] = {"b0": bar}
    deck["bodies"] = {"b0": deck["bodies"]["b0"]}
    deck.pop("contacts", None)
    width, height = bar["size"][1:]
    bar["size"][0] = 4 * max(width, height) * generator.choice([1, 2])
    bar["cells"][0] = max(4, bar["cells"][0], round(bar["size"][0] / (2 * width) * generator.choice([1, 2])))
    deck["supports"] = [{"boundary": "b0.xmin", "displacement": {"x": 0, "y": 0, "z": 0}}]
    deck["loads"] = [{"boundary": "b0.xmax", "traction": [0, f"-(z - {height / 2})", f"y - {width / 2}"]}]


def model(generator, layers, twisted=False):
    """A deck, and its fine one."""
    space = generator.random() < 0.4 or twisted
    kind = generator.choice(SPACE if space else PLANE)
    element, _, formulation = kind.partition(" ")
    up = "z" if space else "y"
    fixed = {"x": 0, "y": 0, "z": 0} if space else {"x": 0, "y": 0}
    deck = {"dimension": 3 if space else generator.choice(["plane_strain", "plane_stress"]), "mesh": {"blocks": blocks(generator, space, layers)}}
    deck["materials"] = {"m": {"young_modulus": 1000, "poisson_ratio": generator.choice([0, 0.2, 0.3, 0.3, 0.4])}}
    deck["bodies"] = {name: {"material": "m"} for name in deck["mesh"]["blocks"]}
    top = f"b{len(deck['bodies']) - 1}.{up}max"
    lying = generator.random() < 0.6
    if lying:
        ends = ["xmin"] if generator.random() < 0.6 else ["xmin", "xmax"]
        deck["supports"] = [{"boundary": f"{name}.{end}", "displacement": dict(fixed)} for name in deck["bodies"] for end in ends]
    else:
        deck["supports"] = [{"boundary": f"b0.{up}min", "displacement": dict(fixed)}]
    bonded = not lying or generator.random() < 0.5
    if len(deck["bodies"]) > 1:
        law = {"bonded": True} if bonded else {"coulomb": 0}
        deck["contacts"] = [{"secondary": f"b{b}.{up}max", "primary": f"b{b + 1}.{up}min", **({"friction": law} if bonded else {})}
                            for b in range(len(deck["bodies"]) - 1)]
    down = [0, 0, -1] if space else [0, -1]
    across = [0.5, 0, -0.5] if space else [0.5, -0.5]
    deck["loads"] = [generator.choice([{"boundary": top, "pressure": 1}, {"boundary": top, "pressure": "1 + x"}, {"boundary": top, "traction": across if bonded else down}])]
    if len(deck["bodies"]) == 1 and not lying and generator.random() < 0.5:
        deck["loads"] = [{"boundary": "b0.xmax", "pressure": 1}]
    if twisted:
        twist(generator, deck)
    deck["solver"] = {"tolerance": 1e-9}
    fine = yaml.safe_load(yaml.safe_dump(deck))
    for block, refined in zip(deck["mesh"]["blocks"].values(), fine["mesh"]["blocks"].values()):
        block["element"] = element
        refined["element"] = "hex20" if space else "quad9"
        most = 12 if space else 40
        refined["cells"] = [min(max(4 * c, 4), max(most, 2 * c)) for c in block["cells"]]
    if formulation:
        for body in deck["bodies"].values():
            body["formulation"] = formulation
    return kind, deck, fine


def judge(mortise, decks, directory, limit):
    """The true and the claimed error; nothing if the model tells neither."""
    found = []
    for name, deck in zip(["coarse", "fine"], decks):
        path = directory / f"{name}.yaml"
        path.write_text(yaml.safe_dump(deck, sort_keys=False))
        status, summary = solve(mortise, path, directory / f"{name}.out", [], limit)
        if status != 0:
            return None
        found.append((summary["strain_energy"], summary["error_estimate"]["discretization"]))
    (coarse, claimed), (fine, of_fine) = found
    true = math.sqrt(abs(1 - coarse / fine)) if fine > 0 else 0
    return (true, claimed) if of_fine < 0.5 * max(true, FLOOR) else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--layers", type=int, choices=[1, 2, 3])
    parser.add_argument("--twisted", action="store_true", help="bars, twisted")
    parser.add_argument("--limit", type=float, default=120, help="seconds a run")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    generator = random.Random(f"{arguments.seed} {arguments.layers}{' twisted' if arguments.twisted else ''}")
    ratios, low = [], []
    for number in range(arguments.count):
        kind, *decks = model(generator, arguments.layers, arguments.twisted)
        with tempfile.TemporaryDirectory() as directory:
            judged = judge(arguments.mortise, decks, pathlib.Path(directory), arguments.limit)
        if judged is None:
            print(f"{number:3d} {kind}: not judged", flush=True)
            continue
        true, claimed = judged
        ratios.append(true / max(claimed, 1e-12))
        off = true > max(FACTOR * claimed, FLOOR)
        if off:
            low.append((ratios[-1], f"{number} {kind}, {f'{ratios[-1]:.1f} times' if ratios[-1] < 1000 else 'nothing claimed'}"))
        cells = [block["cells"] for block in decks[0]["mesh"]["blocks"].values()]
        print(f"{number:3d} {kind} {cells}: true {true:.3f}, claimed {claimed:.3f}{'  LOW' if off else ''}", flush=True)
    ratios.sort()
    at = [ratios[min(len(ratios) - 1, int(part * len(ratios)))] for part in (0.5, 0.9, 0.1)] if ratios else [math.nan] * 3
    low.sort(reverse=True)
    worst = "; ".join(text for _, text in low[:3]) + ("; .." if len(low) > 3 else "")
    row = [str(arguments.seed), "twist" if arguments.twisted else "any", str(arguments.layers or "1 to 3"), str(arguments.count), str(len(ratios)),
           f"{len(low)}{f' ({worst})' if low else ''}", *(f"{ratio:.2f}" for ratio in at)]
    print(page_tables.line_of(row))
    if arguments.write:
        page_tables.write(HERE / "README.md", "the mesh's error", HEAD, [row], keys=3)
    return 1 if len(low) > PART * max(len(ratios), 1) else 0


if __name__ == "__main__":
    sys.exit(main())
