#!/usr/bin/env python3
"""Five models as they stand, with no key of the solver set: what a user gets who sets none.

    defaults.py MORTISE [model ...] [--write]

Each is solved at all defaults and again by products to 1e-9 (friction to 1e-8). The largest displacement, the largest pressure and the state of the contact's
points are held against that run within LIMITS, and where a formula is known, what it tells against it within its own tolerance: the mesh's error is in there.
Exit status 1 if anything is beyond its limit. --write puts the table into README.md.
"""
import argparse
import math
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import claimed_error  # noqa: E402
from claimed_error import page_tables, relative  # noqa: E402

TIGHT = ["solver.tolerance=1e-9", "friction_loop.tolerance=1e-8", "friction_loop.max_steps=150", "solver.algorithm=face_newton", "solver.max_multiplications=15000"]
LIMITS = {"displacement": 1e-3, "pressure": 5e-3, "states": 0.02}
HEAD = ["model", "unknowns", "products", "error claimed of the mesh", "of the solver", "displacement off by", "pressure off by", "contact in another state", "by a formula"]


def weight(found, again):
    """The contact carries half of the pin: density 1, acceleration 6, a polygon for a circle."""
    return "weight", found["contacts"][0]["force"][1], 6 * math.pi * 9.98**2 / 2, 0.01


def capstan(found, again):
    """Euler and Eytelwein, with the tension in the middle of the belt and friction at the drum: dT (R + t / 2) = mu T R."""
    held = math.hypot(*found["reactions"][0]["force"])
    return "tension left", held, 5 * math.exp(-0.3 * math.pi / 2 * 100 / 101), 0.01


def hertz(found, again):
    """Equal cylinders, crossed: a sphere of their radius on a plane; all of the force."""
    force, radius, modulus = 1000, 10, 210e3 / (2 * (1 - 0.3**2))
    a = (3 * force * radius / (4 * modulus)) ** (1 / 3)
    return "largest pressure", found["contacts"][0]["max_recovered_pressure"], 3 * force / (2 * math.pi * a**2), 0.06


def twice(found, again):
    """A receding contact is as wide under twice the load, and presses twice as much."""
    double = again(['loads[0].pressure="x < 0.4 ? 200 : 0"'])["contacts"][0]
    return "pressure under twice the load", double["max_recovered_pressure"], 2 * found["contacts"][0]["max_recovered_pressure"], 1e-3


MODELS = {"pin_slice": weight, "belt_on_drum": capstan, "crossed_cylinders": hertz, "conformal_pin": None, "receding_layer": twice}


def measure(mortise, name, formula, scratch):
    """A row of the table, and what is beyond its limit."""
    deck = HERE / "decks" / f"{name}.yaml"
    solved = lambda where, settings: claimed_error.solve(mortise, deck, scratch / where, settings, 300)
    (status, found), (tight_status, exact) = solved("defaults", []), solved("tight", TIGHT)
    if status != 0 or tight_status != 0:
        return None, [f"exit status {status}, to 1e-9 {tight_status}"]
    pressures = [run["contacts"][0]["max_recovered_pressure"] for run in (found, exact)]
    states, _, slipped = claimed_error.shown_otherwise(scratch / "defaults", scratch / "tight")
    off = {"displacement": relative(found["max_displacement"], exact["max_displacement"]), "pressure": relative(*pressures), "states": states}
    complaints = [f"{key} off by {off[key]:.2g}, limit {limit:g}" for key, limit in LIMITS.items() if not off[key] <= limit]
    complaints += ["it sticks, and is shown slipped"] * slipped
    told = ""
    if formula:
        what, value, expected, tolerance = formula(found, lambda settings: solved("again", settings)[1])
        told = f"{what} {value:.4g}, expected {expected:.4g}: {100 * (value / expected - 1):+.2g} %"
        if not abs(value - expected) <= tolerance * abs(expected):
            complaints.append(f"{told}, tolerance {tolerance:g}")
    errors = found["error_estimate"]
    return [f"`{name}`", f"{found['primal_unknowns']:,}", found["hessian_multiplications"], f"{100 * errors['discretization']:.2g} %", f"{100 * errors['algebraic']:.1g} %",
            f"{off['displacement']:.1e}", f"{off['pressure']:.1e}", f"{100 * states:.2g} %", told], complaints


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise", type=lambda p: str(pathlib.Path(p).resolve()))
    parser.add_argument("models", nargs="*")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    if unknown := set(arguments.models) - MODELS.keys():
        parser.error(f"no such model: {', '.join(sorted(unknown))}; there are {', '.join(MODELS)}")
    rows, failed = [], 0
    for name, formula in MODELS.items():
        if arguments.models and name not in arguments.models:
            continue
        with tempfile.TemporaryDirectory() as scratch:
            row, complaints = measure(arguments.mortise, name, formula, pathlib.Path(scratch))
        rows += [row] if row else []
        failed += bool(complaints)
        print(*(row or [name]), *(f"  FAILED: {complaint}" for complaint in complaints), sep="  ", flush=True)
    if arguments.write:
        page_tables.write(HERE / "README.md", "all defaults", HEAD, rows, known=[(f"`{name}`",) for name in MODELS])
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
