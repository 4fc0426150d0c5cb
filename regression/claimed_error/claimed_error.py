#!/usr/bin/env python3
"""Measures whether errors are what runs claim: random models, each solved at `tolerance: auto` and again tightly.

    claimed_error.py MORTISE [--count 40] [--seed 1] [--family NAME ...] [--set key=value ...] [--keep DIRECTORY] [--limit SECONDS] [--write]
    claimed_error.py MORTISE --decks DIRECTORY [...]

With --decks the models are the decks in the folders of a directory, such as ../population/generate.py writes. A line a model: exit status, products (auto,
tight), the error that the run claims and the true one, of the solver, in the energy norm; what displacements, contact forces and largest pressures are off
by; and the ratio of true to claimed. The energy norm of the difference comes from the dual energies in history.csv where there is no Coulomb friction and
products ended both runs with the same algorithm (2 (E - E_tight) is no less than its square), else from the stresses at the nodes and each body's compliance.
What was solved directly is held against products, where these come to an end. A tight run that does not converge tells nothing, and the model does not count.
Fails if more than 5 % of the runs with exit status 0 are off by more than 1.5 times what they claim, or if a contact that sticks wherever it is closed is
shown slipped on more than 5 % of its area. Errors below 1e-3 count as claimed: they matter to nobody. --write puts a row into README.md.
"""
import argparse
import csv
import fnmatch
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import h5py
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
SHOWN = 0.05  # of the area in contact: what may be shown slipped where all of it sticks
HEAD = ["seed", "models", "judged", "off by more than 1.5 times", "median of true over claimed", "contact in another state", "sticks, shown slipped", "not solved"]


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


def compliances(deck, names):
    """(1 / E, Poisson's ratio) of each body; (1, 0) of all where one is not of one isotropic material."""
    found = []
    for name in names:
        bodies = [body for pattern, body in deck["bodies"].items() if fnmatch.fnmatchcase(name, pattern)]
        material = deck["materials"].get(bodies[0].get("material"), {}) if len(bodies) == 1 else {}
        values = [material.get(key) for key in ("young_modulus", "poisson_ratio")]
        if not all(isinstance(value, (int, float)) for value in values):
            return [(1.0, 0.0)] * len(names)
        found.append((1 / values[0], values[1]))
    return found


def stress_difference(one, other, compliance):
    """Relative, in the energy norm of the stresses at the nodes, each with the volume that is its and the compliance of its body."""
    read = [results.read_vtu(next(d.glob("solution*.vtu"))) for d in (one, other)]
    points, stress = read[0]["Points"], [r["PointData"]["stress"] for r in read]
    points = next(iter(points.values()))
    cells = read[0]["Cells"]
    weights = np.zeros((len(points), 2))  # volume (1 + nu) / E of s:s, volume nu / E of tr(s)^2
    start = 0
    for end, body in zip(cells["offsets"], read[0]["CellData"]["body"]):
        nodes = cells["connectivity"][start:end]
        size = np.ptp(points[nodes], axis=0)
        soft, poisson = compliance[int(body)]
        weights[nodes] += np.prod(size[size > 0]) / len(nodes) * soft * np.array([1 + poisson, poisson])
        start = end
    def square(s):
        return float(np.sum(weights[:, 0] * (s**2 @ np.array([1, 1, 1, 2, 2, 2])) - weights[:, 1] * s[:, :3].sum(axis=1) ** 2))
    return np.sqrt(square(stress[0] - stress[1]) / max(square(stress[1]), 1e-300))


OPEN, STICK, SLIP = 0, 1, 2


def states(directory):
    """(contact, node, area, status) of all contact points, columns, in this order."""
    with h5py.File(directory / "results.h5") as file:
        points = np.asarray(file["contact/points"]) if "contact/points" in file else np.zeros((0, 12))
    points = points[:, [0, 1, 2, 11]]
    return points[np.lexsort(points[:, 1::-1].T)]


def shown_otherwise(auto, tight):
    """Areas over that of each contact which is closed in the tight run, the largest of all contacts: of points in another state, of open or
    closed alone; and whether a contact that sticks where it is closed is shown slipped."""
    one, other = states(auto), states(tight)
    if one.shape != other.shape or not np.array_equal(one[:, :2], other[:, :2]):
        raise ValueError(f"other contact points: {auto}, {tight}")
    apart, opened, wrongly = 0.0, 0.0, False
    for contact in np.unique(other[:, 0]):
        of = other[:, 0] == contact
        area, found, exact = other[of, 2], one[of, 3].astype(int), other[of, 3].astype(int)
        closed = max(area[exact != OPEN].sum(), 1e-300)
        if not (exact != OPEN).any():
            continue
        apart = max(apart, area[found != exact].sum() / closed)
        opened = max(opened, area[(found == OPEN) != (exact == OPEN)].sum() / closed)
        wrongly |= not (exact == SLIP).any() and area[found == SLIP].sum() > SHOWN * closed
    return apart, opened, bool(wrongly)


def relative(a, b):
    return abs(a - b) / max(abs(b), 1e-300)


def compare(auto, tight, found, exact, deck):
    """Claimed and true errors of the run `auto`, against `tight`."""
    coulomb = any("coulomb" in contact.get("friction", {}) for contact in deck["contacts"])
    energy = exact["strain_energy"]
    gained = dual_energy(auto) - dual_energy(tight)
    comparable = found["algorithm"] == exact["algorithm"] and np.isfinite(gained)  # of the same subdomains
    true = np.sqrt(max(gained, 0) / energy) if comparable and not coulomb else stress_difference(auto, tight, compliances(deck, exact["body_names"]))
    force = max((np.linalg.norm(np.subtract(a["force"], b["force"])) / max(np.linalg.norm(b["force"]), 1e-300)
                 for a, b in zip(found["contacts"], exact["contacts"])), default=0)
    pressure = max((relative(a["max_recovered_pressure"], b["max_recovered_pressure"]) for a, b in zip(found["contacts"], exact["contacts"])), default=0)
    apart, opened, slipped = shown_otherwise(auto, tight)
    return {"states": apart, "opened": opened, "slipped": slipped, "claimed": found["error_estimate"]["algebraic"], "true": true, "energy": relative(found["strain_energy"], energy),
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
    row = compare(directory / "auto", directory / "tight", found, exact, deck)
    row["ratio"] = row["true"] / max(row["claimed"] or 0.0, FLOOR / FACTOR)
    print(line + f" {exact['hessian_multiplications']:6}  mesh {found['error_estimate']['discretization'] or 0:8.2e}  claimed {row['claimed'] or 0:8.2e}  true {row['true']:8.2e}"
          f"  ratio {row['ratio']:6.2f}  displacement {row['displacement']:8.1e}  force {row['force']:8.1e}  pressure {row['pressure']:8.1e}"
          f"  states {row['states']:8.1e} {row['opened']:8.1e}" + ("  ***" if row["ratio"] > FACTOR else "") + ("  SLIPPED" if row["slipped"] else ""), flush=True)
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
    slipped = [r for r in judged if r["slipped"]]
    other = max(judged, key=lambda r: r["states"], default={"states": 0.0, "family": "none"})
    print(f"{len(slipped)} contacts stick and are shown slipped; at most {100 * other['states']:.2g} % of a contact is in another state ({other['family']})")
    not_solved = [r for r in rows if r["status"] != 0]
    print(f"{len(not_solved)} not solved: {[(r['family'], r['status']) for r in not_solved]}")
    if arguments.write:
        row = [arguments.decks.name if arguments.decks else arguments.seed, len(rows), len(judged), counted(f"{r['family']}, {r['ratio']:.1f} times" for r in bad),
               f"{np.median([r['ratio'] for r in judged]):.2f}", f"{100 * other['states']:.2g} %" + (f" ({other['family']})" if other["states"] else ""),
               counted(r["family"] for r in slipped), counted(f"{r['family']}, exit {r['status']}" for r in not_solved)]
        page_tables.write(HERE / "README.md", "decks of the population" if arguments.decks else "random models", HEAD, [row])
    return 1 if slipped or len(bad) > PART * len(judged) or not judged else 0


if __name__ == "__main__":
    sys.exit(main())
