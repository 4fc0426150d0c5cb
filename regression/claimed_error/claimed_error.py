#!/usr/bin/env python3
"""Measures whether errors are what runs claim: random models, each solved at `tolerance: auto` and again tightly.

    claimed_error.py MORTISE [--count 40] [--seed 1] [--family NAME ...] [--set key=value ...] [--keep DIRECTORY] [--limit SECONDS] [--write]
    claimed_error.py MORTISE --decks DIRECTORY [...]

With --decks the models are the decks in the folders of a directory, such as ../population/generate.py writes. A line a model: exit status, products (auto,
tight), the error that the run claims and the true one, of the solver, in the energy norm; what displacements, contact forces and largest pressures are off by;
and the ratio of true to claimed. The energy norm of the difference comes from the dual energies in history.csv where there is no Coulomb friction and products
ended both runs with the same algorithm (2 (E - E_tight) is no less than its square), else from the stresses at the nodes. What was solved directly is held
against products, where these come to an end. A tight run that does not converge tells nothing, and the model does not count. Fails if more than 5 % of the runs
with exit status 0 are off by more than 1.5 times what they claim. Errors below 1e-3 count as claimed: they matter to nobody. --write puts a row into README.md.
"""
import argparse
import csv
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import numpy as np
import yaml

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.path.insert(0, str(HERE.parent / "verification"))
import models  # noqa: E402
import results  # noqa: E402

sys.path.insert(0, str(HERE.parent))
import page_tables  # noqa: E402

INPUTS = HERE.parent.parent / "inputs"
TIGHT = ["solver.tolerance=1e-10", "solver.preconditioner=dirichlet", "friction_loop.tolerance=1e-8"]
PRODUCTS = ["solver.algorithm=face_newton", "solver.max_multiplications=2000"]
FACTOR, PART, FLOOR = 1.5, 0.05, 1e-3
HEAD = ["seed", "models", "judged", "off by more than 1.5 times", "median of true over claimed", "not solved"]


def solve(mortise, deck, directory, settings, limit):
    """Exit status and summary (None without one)."""
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    command = [mortise, str(deck), "--output", str(directory)]
    for value in settings:
        command += ["--set", value]
    try:
        done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=limit)
    except subprocess.TimeoutExpired:
        return "time", None
    path = directory / "summary.json"
    if done.returncode not in (0, 2, 3) or not path.exists():
        return done.returncode, None
    return done.returncode, json.loads(path.read_text())


def dual_energy(directory):
    """Not a number where a direct solution or SMALSE came last."""
    *_, last = csv.DictReader((directory / "history.csv").open())
    return float(last["dual_energy"] or "nan")


def stress_difference(one, other):
    """Relative, in the energy norm of the stresses at the nodes, each with the volume that is its."""
    read = [results.read_vtu(next(d.glob("solution*.vtu"))) for d in (one, other)]
    points, stress = read[0]["Points"], [r["PointData"]["stress"] for r in read]
    points = next(iter(points.values()))
    cells = read[0]["Cells"]
    volume = np.zeros(len(points))
    start = 0
    for end in cells["offsets"]:
        nodes = cells["connectivity"][start:end]
        size = np.ptp(points[nodes], axis=0)
        volume[nodes] += np.prod(size[size > 0]) / len(nodes)
        start = end
    def square(s):
        return float(np.sum(volume[:, None] * s**2 * np.array([1, 1, 1, 2, 2, 2])))
    return np.sqrt(square(stress[0] - stress[1]) / max(square(stress[1]), 1e-300))


def relative(a, b):
    return abs(a - b) / max(abs(b), 1e-300)


def compare(auto, tight, found, exact, coulomb):
    """Claimed and true errors of the run `auto`, against `tight`."""
    energy = exact["strain_energy"]
    gained = dual_energy(auto) - dual_energy(tight)
    comparable = found["algorithm"] == exact["algorithm"] and np.isfinite(gained)  # of the same subdomains
    true = np.sqrt(max(gained, 0) / energy) if comparable and not coulomb else stress_difference(auto, tight)
    force = max((np.linalg.norm(np.subtract(a["force"], b["force"])) / max(np.linalg.norm(b["force"]), 1e-300)
                 for a, b in zip(found["contacts"], exact["contacts"])), default=0)
    pressure = max((relative(a["max_recovered_pressure"], b["max_recovered_pressure"]) for a, b in zip(found["contacts"], exact["contacts"])), default=0)
    return {"claimed": found["error_estimate"]["algebraic"], "true": true, "energy": relative(found["strain_energy"], energy),
            "displacement": relative(found["max_displacement"], exact["max_displacement"]), "force": force, "pressure": pressure}


def random_models(arguments, scratch):
    """(family, name, deck's file) of each."""
    for i in range(arguments.count):
        family = arguments.family[i % len(arguments.family)]
        directory = (arguments.keep or scratch) / f"{family}_{i}"
        directory.mkdir(parents=True, exist_ok=True)
        deck = models.model(family, random.Random(f"{arguments.seed} {family} {i}"), INPUTS)
        if geometry := deck.pop("geometry", None):
            (directory / geometry[0]).write_text(geometry[1])
        path = directory / "deck.yaml"
        path.write_text(yaml.safe_dump(deck, sort_keys=False))
        yield family, f"{family:10} {i:4}", path


def given_models(directory):
    """The same of the decks in the folders of a directory that have an equilibrium."""
    for path in sorted(directory.glob("*/deck.yaml")):
        expected = path.parent / "expected.json"
        if not expected.exists() or json.loads(expected.read_text())["exit_status"] == 0:
            yield path.parent.name, f"{path.parent.name:34}", path


def measure(arguments, family, name, path):
    directory = path.parent
    deck = yaml.safe_load(path.read_text())
    status, found = solve(arguments.mortise, path, directory / "auto", ["solver.tolerance=auto"] + arguments.set, arguments.limit)
    other = {"direct": PRODUCTS}.get(found["algorithm"], [f"solver.algorithm={found['algorithm']}"]) if found else []
    for settings in (TIGHT + other, TIGHT, TIGHT + ["solver.tolerance=1e-8"]):
        exact_status, exact = solve(arguments.mortise, path, directory / "tight", settings, arguments.limit)
        if exact_status == 0:
            break
    line = f"{name}  exit {status} {exact_status}"
    if found:
        line += f"  products {found['hessian_multiplications']:5}"
    if not found or not exact or status != 0 or exact_status != 0:
        print(line, flush=True)
        return {"family": family, "status": status, "judged": False}
    coulomb = any("coulomb" in contact.get("friction", {}) for contact in deck["contacts"])
    row = compare(directory / "auto", directory / "tight", found, exact, coulomb)
    row["ratio"] = row["true"] / max(row["claimed"] or 0.0, FLOOR / FACTOR)
    print(line + f" {exact['hessian_multiplications']:6}  mesh {found['error_estimate']['discretization'] or 0:8.2e}  claimed {row['claimed'] or 0:8.2e}  true {row['true']:8.2e}"
          f"  ratio {row['ratio']:6.2f}  displacement {row['displacement']:8.1e}  force {row['force']:8.1e}  pressure {row['pressure']:8.1e}"
          + ("  ***" if row["ratio"] > FACTOR else ""), flush=True)
    return {"family": family, "status": status, "judged": True, **row}


def counted(words):
    """How many there are, and which."""
    words = list(words)
    return f"{len(words)} ({'; '.join(words)})" if words else "0"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise", type=lambda p: str(pathlib.Path(p).resolve()))
    parser.add_argument("--count", type=int, default=40, help="models, dealt out to the families in turn")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--family", nargs="*", default=models.FAMILIES, choices=models.FAMILIES)
    parser.add_argument("--decks", type=pathlib.Path, help="folders with decks, in place of random models")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--keep", type=pathlib.Path, help="where decks and results stay")
    parser.add_argument("--limit", type=float, default=120, help="seconds of each run")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        given = given_models(arguments.decks) if arguments.decks else random_models(arguments, pathlib.Path(scratch))
        for family, name, path in given:
            rows.append(measure(arguments, family, name, path))
    judged = [r for r in rows if r["judged"]]
    bad = [r for r in judged if r["ratio"] > FACTOR]
    print(f"{len(rows)} models, {len(judged)} judged; {len(bad)} are off by more than {FACTOR} times what they claim; median ratio "
          f"{np.median([r['ratio'] for r in judged]) if judged else float('nan'):.2f}")
    not_solved = [r for r in rows if r["status"] != 0]
    print(f"{len(not_solved)} not solved: {[(r['family'], r['status']) for r in not_solved]}")
    if arguments.write:
        row = [arguments.decks.name if arguments.decks else arguments.seed, len(rows), len(judged), counted(f"{r['family']}, {r['ratio']:.1f} times" for r in bad),
               f"{np.median([r['ratio'] for r in judged]):.2f}", counted(f"{r['family']}, exit {r['status']}" for r in not_solved)]
        page_tables.write(HERE / "README.md", "decks of the population" if arguments.decks else "random models", HEAD, [row])
    return 1 if len(bad) > PART * len(judged) or not judged else 0


if __name__ == "__main__":
    sys.exit(main())
