#!/usr/bin/env python3
"""What a run sends and holds on 1, 2, 4, ... ranks: strong scaling of a deck, weak scaling of two beams cut into cubes.

    scaling.py MORTISE [--ranks 1 2 4 8 16] [--deck inputs/wind_bearing/half.yaml | --weak] [--mpiexec MPIEXEC] [--set KEY=VALUE ...] [--write]

It counts, and so may put many ranks on few cores; its seconds would mean nothing there and are not printed. Strong: the same deck on
all ranks. Weak: the beams of inputs/cantilever_3d with 16 subdomains of 6^3 cells a rank; ranks are powers of two. Printed of
the rank that sends most: bytes and messages of a product with F; collective calls of the whole solution and their bytes, over
products; bytes of all kinds in set-up. Memory is the mean over the ranks. --write puts the table into README.md.
Exit status 1 if, of the same deck, the numbers of products differ by more than 5 %.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = pathlib.Path(__file__).resolve().parent / "README.md"
sys.path.insert(0, str(ROOT / "regression"))
import page_tables  # noqa: E402

CELLS = 6  # along the edge of a cube
ROUNDING = 0.05  # sums in another order move bodies that touch without force, and that some faces


def weak_settings(ranks):
    """Beams of 8 cubes a rank each, for ranks that are a power of two: 2 x 2 x 2, 4 x 2 x 2, 4 x 4 x 2, ..."""
    shape, axis = [2, 2, 2], 0
    while shape[0] * shape[1] * shape[2] < 8 * ranks:
        shape[axis] *= 2
        axis = (axis + 1) % 3
    cells = [CELLS * k for k in shape]
    return [f"mesh.blocks.{beam}.cells={cells}" for beam in ("lower", "upper")] + [
        f"decomposition.counts={{lower: {shape}, upper: {shape}}}"]


def run(arguments, deck, settings, ranks):
    """summary.json of one run."""
    with tempfile.TemporaryDirectory(prefix="mortise_scaling_") as directory:
        command = [arguments.mpiexec, "--oversubscribe", "--bind-to", "none", "-n", str(ranks), arguments.mortise, str(deck),
                   "--output", directory]
        for value in settings + arguments.set:
            command += ["--set", value]
        environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                           OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_mpi_yield_when_idle="1")
        finished = subprocess.run(command, capture_output=True, text=True, env=environment)
        if finished.returncode != 0:
            sys.exit(f"{ranks} ranks: exit status {finished.returncode}\n{finished.stdout[-2000:]}{finished.stderr[-2000:]}")
        return json.loads((pathlib.Path(directory) / "summary.json").read_text())


HEAD = ["ranks", "subdomains", "products", "kB a product", "messages a product",
        "collective calls a product", "their kB", "MB in set-up", "MB of memory a rank"]


def row(summary):
    """The figures of one run, as text."""
    if "communication" not in summary:
        sys.exit("this build does not count what it sends: cmake --preset counted && cmake --build --preset counted")
    products = summary["hessian_multiplications"]
    sent = {stage: figures["largest"] for stage, figures in summary["communication"].items()}
    product, solve, set_up = sent["multiplication"], sent["solve"], sent["set_up"]
    ranks = summary["ranks"]
    return [str(ranks), f"{summary['subdomains']:,}",
            str(products), f"{product['bytes'] / products / 1e3:.1f}", f"{product['messages'] / products:.0f}",
            f"{solve['collectives'] / products:.0f}", f"{solve['collective_bytes'] / products / 1e3:.0f}",
            f"{(set_up['bytes'] + set_up['collective_bytes']) / 1e6:.2f}", f"{summary['peak_memory_bytes'] / ranks / 1e6:.0f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2, 4, 8, 16])
    parser.add_argument("--deck", default=str(ROOT / "inputs/wind_bearing/half.yaml"))
    parser.add_argument("--weak", action="store_true")
    parser.add_argument("--mpiexec", default="mpirun")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    deck = ROOT / "inputs/cantilever_3d/cantilever_3d.yaml" if arguments.weak else arguments.deck
    print(page_tables.line_of(HEAD))
    products = set()
    for ranks in arguments.ranks:
        summary = run(arguments, deck, weak_settings(ranks) if arguments.weak else [], ranks)
        products.add(summary["hessian_multiplications"])
        print(page_tables.line_of(row(summary)), flush=True)
        if arguments.write:
            page_tables.write(PAGE, "two beams" if arguments.weak else pathlib.Path(arguments.deck).stem, HEAD, [row(summary)])
    if not arguments.weak and max(products) > (1 + ROUNDING) * min(products):
        sys.exit(f"the number of products depends on the ranks: {sorted(products)}")


if __name__ == "__main__":
    main()
