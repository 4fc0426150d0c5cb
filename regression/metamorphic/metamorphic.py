#!/usr/bin/env python3
"""Solves random models, each again after changes that must leave the answers as they were: other ranks, subdomains, clusters,
algorithms, preconditioners, units, sides, order and place of bodies and contacts (relations.py). Of steps that have no equilibrium both runs must say so.

    metamorphic.py MORTISE --count 20 --seed 1 --models blocks rings bolt sector [--write]

Exit status 1 if any answer differs by more than its tolerance; the model and both decks are then kept below --finds. --write puts a row for
each kind of model into README.md.
"""
import argparse
import collections
import json
import math
import multiprocessing
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import models
import relations

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import page_tables  # noqa: E402

# Relative to the largest of its kind; all models are solved to 1e-9 (friction to 1e-8).
TOLERANCE = {"strain_energy": 1e-6, "max_displacement": 1e-6, "max_von_mises": 1e-5, "reaction": 1e-6, "contact": 1e-6, "area": 1e-6}
MESH = 0.05
HEAD = ["model", "seed", "models", "with an equilibrium", "comparisons", "energies with sides exchanged", "models with differences"]


def solve(arguments, deck, files, ranks, directory):
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    for name, text in files.items():
        (directory / name).write_text(text)
    (directory / "deck.yaml").write_text(yaml.safe_dump(deck, sort_keys=False))
    command = [str(arguments.mortise), str(directory / "deck.yaml"), "--output", str(directory / "results")]
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    if ranks > 1:
        command = [arguments.mpiexec, "--oversubscribe", "-n", str(ranks)] + command
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=600)
    (directory / "log.txt").write_text(done.stdout + done.stderr)
    summary = json.loads((directory / "results" / "summary.json").read_text()) if done.returncode == 0 else None
    return done.returncode, summary


def answers(summary):
    """{name: (kind of unit, value, scale to which its tolerance relates)}; vectors by their lengths, which turns leave alone."""
    length = lambda v: math.sqrt(sum(x * x for x in v))
    force = max([length(r["force"]) for r in summary["reactions"]] + [length(c["force"]) for c in summary["contacts"]] + [0])
    result = {"strain_energy": ("energy", summary["strain_energy"], abs(summary["strain_energy"])),
              "max_displacement": ("length", summary["max_displacement"], summary["max_displacement"]),
              "max_von_mises": ("stress", summary["max_von_mises"], summary["max_von_mises"])}
    for i, value in enumerate(sorted(length(r["force"]) for r in summary["reactions"])):
        result[f"reaction.{i}"] = ("force", value, force)
    for i, contact in enumerate(sorted(summary["contacts"], key=lambda c: c["name"])):
        result[f"contact.{i}"] = ("force", length(contact["force"]), force)
        result[f"max_pressure.{i}"] = ("stress", contact["max_pressure"], summary["max_von_mises"])
    return result


def compare(one, other, factors, apart=None):
    """apart: {answer: tolerance} of those that are compared alone; the square of the error claimed of the mesh where that is more, up to MESH."""
    mesh = max(summary["error_estimate"]["discretization"] or 0 for summary in (one, other)) ** 2
    complaints = []
    a, b = answers(one), answers(other)
    if a.keys() != b.keys():
        return [f"other answers: {sorted(a)} and {sorted(b)}"]
    for name, (unit, value, scale) in a.items():
        if apart and name not in apart:
            continue
        tolerance = max(apart[name], min(mesh, MESH)) if apart else TOLERANCE.get(name.split(".")[0], 1e-4)
        found = b[name][1] / factors[unit]
        if not abs(found - value) <= tolerance * scale + 1e-300:
            complaints.append(f"{name}: {value:.9g} and {found:.9g}, {abs(found - value) / scale:.1e} apart")
    return complaints


def tight(deck):
    deck["solver"] = {"tolerance": 1e-9}
    deck["friction_loop"] = {"tolerance": 1e-8}
    for i, contact in enumerate(deck["contacts"]):
        contact.setdefault("name", f"contact{i}")  # of its own, whatever its sides and its place
    return deck


def work(task):
    """(kind of the model, its number, how it ended, relations tried, by how much energies are apart with sides exchanged, complaints)."""
    arguments, kind, number = task
    source = random.Random(f"{arguments.seed} {kind} {number}")
    deck, files = models.MODELS[kind](source)
    tight(deck)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        status, reference = solve(arguments, deck, files, 1, scratch / "reference")
        complaints, tried, apart = [], [], 0.0
        if status not in (0, 3):
            complaints.append((None, f"exit status {status}"))
        chosen = relations.RELATIONS if arguments.relations <= 0 else source.sample(relations.RELATIONS, arguments.relations)
        for relation in chosen if status in (0, 3) else []:
            changed = relations.change(relation, source, deck)
            if changed is None:
                continue
            tried.append(relation.__name__)
            other_deck, factors, ranks = changed
            other_status, other = solve(arguments, other_deck, files, ranks, scratch / relation.__name__)
            found = [f"exit status {status} and {other_status}"] * (status != other_status)
            if status == other_status == 0:
                found = compare(reference, other, factors, relations.APART.get(relation))
                if relation is relations.exchanged:
                    apart = abs(other["strain_energy"] / reference["strain_energy"] - 1)
            complaints += [(relation.__name__, text) for text in found]
        if complaints:
            kept = arguments.finds / f"{kind}_{arguments.seed}_{number}"
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(scratch, kept, ignore=lambda folder, names: [n for n in names if n == "results" or (pathlib.Path(folder) == scratch and n != "reference" and n not in {c[0] for c in complaints})])
    return kind, number, status, tried, apart, complaints


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise", type=pathlib.Path)
    parser.add_argument("--models", nargs="+", choices=list(models.MODELS), default=list(models.MODELS))
    parser.add_argument("--count", type=int, default=10, help="models of each kind")
    parser.add_argument("--relations", type=int, default=0, help="so many for each model, picked at random; 0: all")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--mpiexec", default="mpirun")
    parser.add_argument("--finds", type=pathlib.Path, default=pathlib.Path("metamorphic_finds"))
    arguments = parser.parse_args()
    arguments.mortise, arguments.finds = arguments.mortise.resolve(), arguments.finds.resolve()

    tasks = [(arguments, kind, number) for number in range(arguments.first, arguments.first + arguments.count) for kind in arguments.models]
    found = {kind: collections.Counter() for kind in arguments.models}
    apart = dict.fromkeys(arguments.models, 0.0)
    with multiprocessing.Pool(arguments.jobs) as pool:
        for kind, number, status, tried, energy, complaints in pool.imap_unordered(work, tasks):
            found[kind] += collections.Counter(models=1, solved=status == 0, comparisons=len(tried), bad=bool(complaints))
            apart[kind] = max(apart[kind], energy)
            for relation, text in complaints:
                print(f"{kind} {number}, {relation or 'as it is'}: {text}", flush=True)
    total = sum(found.values(), collections.Counter())
    print(f"{total['models']} models, {total['solved']} with an equilibrium, {total['comparisons']} comparisons; {total['bad']} models with differences")
    if arguments.write:
        rows = [[kind, arguments.seed, n["models"], n["solved"], n["comparisons"], f"{100 * apart[kind]:.2g} %", n["bad"]] for kind, n in found.items()]
        page_tables.write(pathlib.Path(__file__).parent / "README.md", "relations", HEAD, rows, keys=2)
    return 1 if total["bad"] or total["solved"] < 0.7 * len(tasks) else 0


if __name__ == "__main__":
    sys.exit(main())
