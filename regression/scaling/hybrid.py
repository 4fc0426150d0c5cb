#!/usr/bin/env python3
"""TFETI and hybrid TFETI where there are many subdomains: two beams in contact cut into small cubes.

    hybrid.py MORTISE [--edges 4 8 12 16] [--clusters 1 64] [--cells 2] [--ranks 1] [--set KEY=VALUE ...] [--write]

The beams of inputs/cantilever_3d, 2n x n x n subdomains each of 2^3 cells, for each n of --edges; --clusters are the values of
decomposition.subdomains_per_cluster, 1 for TFETI. All subdomains are copies of one, so that what is seen is the dual space and the coarse problem.
Seconds are CPU seconds of all ranks; of them `joints` factorizes clusters (and the one subdomain), `solution` holds all from G on; both are
the clock's, of the slowest rank. --write puts kernels, products, CPU seconds and memory into docs/design/clusters.md.
Exit status 1 if, at the same n, the strain energies differ by more than 1e-5.
"""
import argparse
import resource
import sys

from scaling import ROOT, page_tables, run

HEAD = ["subdomains", "primal unknowns", "TFETI: kernels", "products", "CPU s", "GB", "clusters of 64: kernels", "products", "CPU s", "GB"]
COLUMN = {1: 2, 64: 6}  # where the figures of a size of clusters begin
TOLERANCE = 1e-5  # of the energy, at the deck's tolerance of 1e-4 for forces


def settings(edge, cells, size):
    counts = [2 * edge, edge, edge]
    return [f"mesh.blocks.{beam}.cells={[cells * k for k in counts]}" for beam in ("lower", "upper")] + [
        f"decomposition.counts={{lower: {counts}, upper: {counts}}}", f"decomposition.subdomains_per_cluster={size}",
        "output.fields=[]"]


def cpu_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--edges", type=int, nargs="+", default=[4, 8, 12, 16])
    parser.add_argument("--clusters", type=int, nargs="+", default=[1, 64])
    parser.add_argument("--cells", type=int, default=2)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--mpiexec", default="mpirun")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--write", action="store_true", help="of TFETI and clusters of 64")
    arguments = parser.parse_args()
    deck = ROOT / "inputs/cantilever_3d/cantilever_3d.yaml"
    print("subdomains | clusters | kernels | primal | dual | products | joints s | solution s | CPU s | GB")
    for edge in arguments.edges:
        energies = []
        for size in arguments.clusters:
            before = cpu_seconds()
            summary = run(arguments, deck, settings(edge, arguments.cells, size), arguments.ranks)
            spent = cpu_seconds() - before
            energies.append(summary["strain_energy"])
            figures = [summary[key] for key in ("subdomains", "clusters", "kernel_dimension", "primal_unknowns", "dual_unknowns",
                                                "hessian_multiplications")]
            figures += [f"{summary['time'][key]:.1f}" for key in ("factorization", "solve")]
            figures += [f"{spent:.1f}", f"{summary['peak_memory_bytes'] / 1e9:.2f}"]
            print(" | ".join(str(x) for x in figures), flush=True)
            if arguments.write and size in COLUMN:
                row = [f"{summary['subdomains']:,}", f"{summary['primal_unknowns']:,}"] + [None] * 8
                row[COLUMN[size]:COLUMN[size] + 4] = [f"{figures[2]:,}", str(figures[5]), *figures[8:]]
                page_tables.write(ROOT / "docs/design/clusters.md", "TFETI and clusters", HEAD, [row])
        if max(energies) - min(energies) > TOLERANCE * max(energies):
            sys.exit(f"n = {edge}: strain energies {energies}")


if __name__ == "__main__":
    main()
