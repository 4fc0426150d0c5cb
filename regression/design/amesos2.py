#!/usr/bin/env python3
"""What Amesos2's interface takes of face Newton's time, by perf: the table of docs/design/amesos2.md.

    amesos2.py MORTISE [--write]

MORTISE is the program itself, mortise-solver. Needs linux-perf, and symbols in the program; half a minute.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE.parent))
import page_tables  # noqa: E402

HEAD = ["deck", "below `Amesos2::SolverCore::solve`, %", "of it below `SupernodalFactor::solve`, %", "the interface, %"]
DECKS = ("cantilever_3d", "roller_bearing")
# From the inside out.
FUNCTIONS = [re.compile(pattern) for pattern in (r"SupernodalFactor<.*>::solve", r"Amesos2::SolverCore<.*>::solve", r"qp::FaceNewton::solve")]


def samples(stacks):
    """How many samples lie below all of the functions, below the last two, and below the last one. A stack has the innermost function first."""
    counts = [0] * len(FUNCTIONS)
    for stack in stacks.split("\n\n"):
        lines = stack.splitlines()
        whole = next((k for k in range(len(lines) - 1, -1, -1) if FUNCTIONS[2].search(lines[k])), None)
        if whole is None:
            continue
        counts[2] += 1
        outer = next((k for k in range(whole, -1, -1) if FUNCTIONS[1].search(lines[k])), None)
        if outer is not None:
            counts[1] += 1
            counts[0] += any(FUNCTIONS[0].search(line) for line in lines[:outer])
    return counts


def row(mortise, deck):
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    with tempfile.TemporaryDirectory(prefix="mortise_perf_") as scratch:
        record = ["perf", "record", "-o", f"{scratch}/data", "--call-graph", "dwarf,16384", "-e", "cpu-clock", "-F", "1000"]
        run = [mortise, str(ROOT / f"inputs/{deck}/{deck}.yaml"), "--output", f"{scratch}/out", "--set", "solver.algorithm=face_newton"]
        subprocess.run(record + run, env=environment, check=True, capture_output=True)
        stacks = subprocess.run(["perf", "script", "-i", f"{scratch}/data", "--no-inline", "-F", "ip,sym"], check=True, capture_output=True, text=True).stdout
    inner, outer, whole = samples(stacks)
    if not inner:
        raise SystemExit(f"{deck}: perf sees {inner}, {outer} and {whole} samples")
    return [f"`inputs/{deck}`", *(f"{100 * part / whole:.1f}" for part in (outer, inner, outer - inner))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    for deck in DECKS:
        cells = row(arguments.mortise, deck)
        print(page_tables.line_of(cells), flush=True)
        if arguments.write:
            page_tables.write(ROOT / "docs/design/amesos2.md", "the interface", HEAD, [cells])


if __name__ == "__main__":
    main()
