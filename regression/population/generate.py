#!/usr/bin/env python3
"""Writes a population of random decks, the same ones for the same seed, or the decks of the table.

    generate.py --seed N --count M [--first K] [--directory D] [--tolerance 1e-6] [--small]
    generate.py --table [--directory D]

Each deck has a folder of its own, NAME/deck.yaml with its mesh, and NAME/expected.json: what it is, and the exit status that it must end with.
Every deck has an equilibrium by construction but for those that are marked with 3. --small keeps them below 3,000 unknowns.
"""
import argparse
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import deck_files  # noqa: E402
import families  # noqa: E402
import meshes  # noqa: E402
import model  # noqa: E402

LAWS = ["frictionless", "coulomb", "tresca", "coulomb", "frictionless", "coulomb"]
FIRST = {"tri6": "tri3", "quad8": "quad4", "quad9": "quad4", "tet10": "tet4", "hex20": "hex8", "hex27": "hex8", "prism15": "prism6"}
FAIL_EVERY = 33  # one deck in so many has no equilibrium
REFERENCE = 4000  # unknowns below which a deck is held against a reference, where there is one
POISSON = [0.0, 0.2, 0.3, 0.3, 0.3, 0.3, 0.4, 0.45, 0.49]


class Bag:
    """Draws each of its values once before any comes again."""

    def __init__(self, random, values):
        self.random, self.values, self.left = random, list(values), []

    def draw(self, allowed=None):
        for value in self.left:
            if allowed is None or value in allowed:
                self.left.remove(value)
                return value
        more = list(self.values)
        self.random.shuffle(more)
        self.left += more
        return self.draw(allowed)


def plans(seed, count, small=False):
    """What each deck of a population is to be; the first ones do not depend on how many there are."""
    r = random.Random(f"population {seed}")
    names, kinds = Bag(r, families.KINDS), {name: Bag(r, kinds) for name, kinds in families.KINDS.items()}
    elements, laws, preconditioners = {True: Bag(r, meshes.SOLID), False: Bag(r, meshes.PLANE)}, Bag(r, LAWS), Bag(r, ["lumped", "lumped", "dirichlet"])
    poisson, offset = Bag(r, POISSON), r.randrange(FAIL_EVERY)
    for number in range(count):
        fails = number % FAIL_EVERY == offset
        family = names.draw(families.FAILING if fails else None)
        kind = kinds[family].draw()
        tets = {"tet4", "tet10"} if family == "free_mesh" else None
        solid = kind == 3
        element = elements[solid].draw(tets if solid else None)
        yield {"name": f"{seed}_{number:04}_{family}", "seed": f"{seed} {number}", "family": family, "kind": kind, "element": element, "fails": fails,
               "other": other(r, element, solid), "law": laws.draw(["coulomb", "frictionless"] if family == "belt" else None),
               "mu": float(f"{10 ** r.uniform(math.log10(0.05), math.log10(1.5)):.3g}"), "bound": float(f"{r.uniform(0.05, 0.6):.3g}"),
               "poisson": poisson.draw(), "incompatible": r.random() < 0.3, "decades": r.choice([0.3, 1, 2, 4]),
               "unknowns": unknowns(r, small), "preconditioner": preconditioners.draw(), "spread": r.random(), "grid": r.random() < 0.6}


def unknowns(r, small):
    """Most below 20,000."""
    large, part = r.random() < 0.08, r.random()
    if small:
        return 10 ** (2.5 + 0.7 * part)
    return 10 ** (4.3 + 0.6 * part) if large else 10 ** (3 + 1.3 * part)


def other(r, element, solid):
    """The cell of the bodies beside: the same, or another one of the same order."""
    if r.random() < 0.6:
        return element
    same = [e for e in (meshes.SOLID if solid else meshes.PLANE) if (e in meshes.SECOND) == (element in meshes.SECOND)]
    return r.choice(same)


def build(plan):
    """The model of a plan, with about as many unknowns as it asks for."""
    make = getattr(families, plan["family"])
    scale = 1.0
    for _ in range(4):
        made = model.Model(random.Random(plan["seed"]), plan, scale)
        make(made)
        if made.mesh:
            return made
        ratio = plan["unknowns"] / made.unknowns()
        if abs(ratio - 1) < 0.2:
            break
        scale *= ratio ** (1 / (3 if made.solid else 2))
    return made


def random_decks(seed, count, directory, tolerance=1e-6, small=False, first=0, only=None):
    """Writes decks; yields their folders."""
    for number, plan in enumerate(plans(seed, first + count, small)):
        if number < first or not deck_files.chosen(plan["name"], only):
            continue
        made = build(plan)
        expected = {"exit_status": made.status, "family": plan["family"], "element": plan["element"], "law": plan["law"], "kind": plan["kind"],
                    "unknowns": made.unknowns() or None, "preconditioner": plan["preconditioner"],
                    "reference": made.status == 0 and 0 < made.unknowns() < REFERENCE}
        deck_files.write(directory / plan["name"], deck_files.deck_of(made, plan, tolerance), made.bodies, made.files, expected)
        yield directory / plan["name"]


def tolerance_of(text):
    return text if text == "auto" else float(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--directory", type=pathlib.Path, default=pathlib.Path("population"))
    parser.add_argument("--tolerance", type=tolerance_of, default=1e-6)
    arguments = parser.parse_args()
    if arguments.table:
        import table
        folders = table.decks(arguments.directory)
    else:
        folders = random_decks(arguments.seed, arguments.count, arguments.directory, arguments.tolerance, arguments.small, arguments.first)
    for folder in folders:
        print(folder)


if __name__ == "__main__":
    sys.exit(main())
