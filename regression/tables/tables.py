#!/usr/bin/env python3
"""Solves the rows of the two scalability tables of Dostal et al. (DD20) and prints them beside the paper's.

    tables.py MORTISE [--dimension 2|3] [--method finite_elements|boundary_elements] [--rows N ...] [--ranks R] [--mpiexec MPIEXEC] [--scratch DIR] [--set KEY=VALUE ...] [--write [--counts]]

Two beams 2:1(:1), each cut into 2n x n (x n) squares or cubes; the decks are those of inputs/cantilever_2d and cantilever_3d with other
numbers. "product/limit" is the time of a product with F over the time its floating point operations take at the rate of a
matrix-matrix product of the same machine, measured at the start. With boundary elements (the paper's TBETI, in space) a subdomain is a dense
matrix of its surface. The results of a row are deleted once it is judged, unless
--keep is given. --write puts the rows into README.md; with --counts seconds stay as they are there, for machines that are busy.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = pathlib.Path(__file__).resolve().parent / "README.md"
sys.path.insert(0, str(ROOT / "regression"))
import page_tables  # noqa: E402

HEAD = ["row", "preconditioner", "primal unknowns", "paper: outer / products / s", "outer / products", "wall s (solve, products)", "product / limit", "GB"]
CELLS = {2: 50, 3: 10}  # along the edge of a subdomain
# n: subdomains, primal, dual, kernel; outer iterations / products / seconds of the paper on 48 cores.
PAPER = {
    2: {22: (1936, 10071072, 384473, 5808, "8 / 119 / 839"),
        32: (4096, 21307392, 817793, 12288, "8 / 134 / 1,665"),
        44: (7744, 40284288, 1551089, 23232, "8 / 180 / 7,825")},
    3: {3: (108, 431244, 88601, 648, "3 / 78 / 60"),
        5: (500, 1996500, 444927, 3000, "4 / 97 / 374"),
        7: (1372, 5478396, 1261493, 8232, "4 / 93 / 1,663"),
        9: (2916, 11643588, 2728955, 17496, "4 / 119 / 7,745")}}
# The same by boundary elements: outer iterations / products / seconds. The paper's primal unknowns are these, but for 3, 2 and 4 of them.
PAPER_BOUNDARY = {3: "7 / 160 / 46", 5: "8 / 161 / 301", 7: "9 / 160 / 2,211", 9: "9 / 260 / 7,949"}
SURFACE_UNKNOWNS = 3 * (11**3 - 9**3)  # of a cube of 10 x 10 x 10 cells
# Entries of the factor of one subdomain, from its analysis by CHOLMOD; two solves cost four operations an entry.
FACTOR_ENTRIES = {2: 0.31e6, 3: 0.9e6}


def settings(dimension, n, method):
    """The --set arguments that make the input's deck a row of the table."""
    shape = [2 * n, n] if dimension == 2 else [2 * n, n, n]
    cells = [CELLS[dimension] * k for k in shape]
    result = [f"bodies.{beam}.method={method}" for beam in ("lower", "upper")]
    result += [f"mesh.blocks.{beam}.cells={cells}" for beam in ("lower", "upper")]
    return result + [f"decomposition.counts={{lower: {shape}, upper: {shape}}}"]


def dgemm_rate():
    """Operations a second of one core in a large matrix-matrix product."""
    import numpy
    a = numpy.ones((1500, 1500))
    best = 0.0
    for _ in range(5):
        start = time.perf_counter()
        a @ a
        best = max(best, 2 * 1500**3 / (time.perf_counter() - start))
    return best


def solve(arguments, dimension, n, directory):
    deck = ROOT / f"inputs/cantilever_{dimension}d/cantilever_{dimension}d.yaml"
    command = [arguments.mortise, str(deck), "--output", str(directory)]
    for value in settings(dimension, n, arguments.method) + arguments.set:
        command += ["--set", value]
    if arguments.ranks > 1:
        command = [arguments.mpiexec, "--oversubscribe", "--bind-to", "none", "-n", str(arguments.ranks)] + command
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                       OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    start = time.perf_counter()
    finished = subprocess.run(command, capture_output=True, text=True, env=environment)
    wall = time.perf_counter() - start
    if finished.returncode != 0:
        raise SystemExit(f"{dimension}D, n = {n}: exit status {finished.returncode}\n{finished.stdout[-2000:]}{finished.stderr[-2000:]}")
    return json.loads((directory / "summary.json").read_text()), wall


def page_row(n, directory, summary, paper, wall, ratio, counts):
    """The row in the table of the page; of counts alone without seconds."""
    seconds, deck = summary["time"], (directory / "deck.yaml").read_text()
    kind = "SMALSE" if re.search(r"algorithm: smalse", deck) else re.search(r"preconditioner: (\w+)", deck)[1]
    timed = [None, None] if counts else [f"{wall:.3g} ({seconds['solve']:.2g}, {seconds['multiplication']:.2g})", f"{ratio:.1f}"]
    return [f"n = {n}", kind, f"{summary['primal_unknowns']:,}", paper, f"{summary['outer_iterations']} / {summary['hessian_multiplications']}",
            *timed, f"{summary['peak_memory_bytes'] / 1e9:.2g}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--dimension", type=int, choices=(2, 3), action="append")
    parser.add_argument("--method", choices=("finite_elements", "boundary_elements"), default="finite_elements")
    parser.add_argument("--rows", type=int, nargs="*", help="values of n; all rows if absent")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--mpiexec", default="mpirun")
    parser.add_argument("--scratch", default=None)
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--counts", action="store_true", help="with --write: leave the seconds of the page as they are")
    arguments = parser.parse_args()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    rate = dgemm_rate() * min(arguments.ranks, os.cpu_count() or 1)
    failures = []
    boundary = arguments.method == "boundary_elements"
    for dimension in arguments.dimension or ((3,) if boundary else (2, 3)):
        print(f"{dimension}D | subdomains | primal | dual | kernel | paper: outer / products / s | outer / products | wall s | "
              "mesh+partition | contact | factors | solve | products | output | product/limit | GB")
        for n, (subdomains, primal, dual, kernel, paper) in PAPER[dimension].items():
            if arguments.rows and n not in arguments.rows:
                continue
            operations = 4 * FACTOR_ENTRIES[dimension]
            if boundary:
                primal, paper, operations = SURFACE_UNKNOWNS * subdomains, PAPER_BOUNDARY[n], 2 * SURFACE_UNKNOWNS**2
            directory = pathlib.Path(tempfile.mkdtemp(prefix="mortise_table_", dir=arguments.scratch))
            summary, wall = solve(arguments, dimension, n, directory)
            found = tuple(summary[k] for k in ("subdomains", "primal_unknowns", "dual_unknowns", "kernel_dimension"))
            if found != (subdomains, primal, dual, kernel):
                failures.append(f"{dimension}D, n = {n}: dimensions {found}, the paper has {(subdomains, primal, dual, kernel)}")
            seconds = summary["time"]
            products = summary["hessian_multiplications"]
            limit = operations * subdomains / rate
            print(f"{n} | {found[0]} | {found[1]} | {found[2]} | {found[3]} | {paper} | {summary['outer_iterations']} / {products} | "
                  f"{wall:.1f} | {seconds['mesh'] + seconds['partition']:.1f} | {seconds['contact']:.1f} | "
                  f"{seconds['assembly'] + seconds['factorization']:.1f} | {seconds['solve']:.1f} | {seconds['multiplication']:.1f} | "
                  f"{seconds['output']:.1f} | {seconds['multiplication'] / products / limit:.1f} | "
                  f"{summary['peak_memory_bytes'] / 1e9:.2f}", flush=True)
            if arguments.write:
                page_tables.write(PAGE, "boundary elements" if boundary else f"{dimension}D", HEAD,
                                  [page_row(n, directory, summary, paper, wall, seconds["multiplication"] / products / limit,
                                           arguments.counts)], keys=2)
            if arguments.keep:
                print(f"  results in {directory}")
            else:
                shutil.rmtree(directory)
    if failures:
        raise SystemExit("\n".join(failures))


if __name__ == "__main__":
    main()
