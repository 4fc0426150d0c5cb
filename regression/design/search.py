#!/usr/bin/env python3
"""What the search for contacts costs on 1, 2 and 3 ranks: the table of docs/design/search.md.

    search.py SEARCH_BENCHMARK [--mpiexec MPIEXEC] [--write]

Seconds of a processor and memory of the busiest rank, as lib/contact/test/search_benchmark.cpp prints them. Its sum over the bits of all rows must not
depend on the ranks.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE.parent))
import page_tables  # noqa: E402

RANKS = (1, 2, 3)
HEAD = ["surfaces", *(f"{ranks} rank{'s' if ranks > 1 else ''}" for ranks in RANKS)]
ROWS = {"flat, 316 x 316 faces on 323 x 311, with friction": ("flat", "316"), "curved, the same": ("curved", "316"),
        "flat, 150 x 150 on 157 x 145": ("flat", "150"), "curved, 150 x 150 on 157 x 145": ("curved", "150"), "ring of 240 x 40 faces, 4 rollers": ("ring", "60", "4")}
SAID = re.compile(r"\((\S+) s of the processor\) on \d+ ranks, peak (\d+) MB a rank.* rows (\w+)")


def run(arguments, words, ranks):
    """Seconds, megabytes and the sum over the rows."""
    command = [arguments.benchmark, *words]
    if ranks > 1:
        command = [arguments.mpiexec, "--oversubscribe", "-n", str(ranks), *command]
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    seconds, megabytes, rows = SAID.search(subprocess.run(command, capture_output=True, text=True, env=environment, check=True).stdout).groups()
    return float(seconds), float(megabytes), rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("benchmark")
    parser.add_argument("--mpiexec", default="mpirun")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    for name, words in ROWS.items():
        found = [run(arguments, words, ranks) for ranks in RANKS]
        if len({rows for _, _, rows in found}) > 1:
            raise SystemExit(f"{name}: the rows depend on the ranks")
        cells = [name, *(f"{seconds:.2f} s, {megabytes / 1e3:.2f} GB" for seconds, megabytes, _ in found)]
        print(page_tables.line_of(cells), flush=True)
        if arguments.write:
            page_tables.write(ROOT / "docs/design/search.md", "search", HEAD, [cells], known=[(key,) for key in ROWS])


if __name__ == "__main__":
    main()
