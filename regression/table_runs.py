"""Tables of pages whose rows are decks with settings: what inputs/figures.py, design/products.py and others have in common.

A `Table` stands in a page under a name (page_tables.py). Each of its `Row`s has the cells that are its key and the runs that it needs; `cells`
makes the other cells out of what these left behind. A cell that is None stays as it is in the page.
"""
import argparse
import collections
import dataclasses
import fnmatch
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import typing
from typing import Callable

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "regression"))
import page_tables  # noqa: E402


@dataclasses.dataclass(frozen=True)
class Deck:
    """What is solved: a deck of the tree, settings as of --set, whether the run may end without a solution, and after how many seconds it is given up."""

    path: str
    settings: tuple = ()
    may_fail: bool = False
    limit: float = 900
    make: Callable = None  # in place of the path: writes a deck into a directory, and returns where


@dataclasses.dataclass
class Row:
    key: tuple
    decks: tuple
    large: bool = False  # more than 2 GB or three minutes: with --large alone
    cells: Callable = None  # in place of the table's


@dataclasses.dataclass
class Table:
    page: str
    name: str
    head: list
    rows: list
    cells: Callable = None  # of the runs of a row, one argument each
    keys: int = 1


class Points(typing.NamedTuple):
    """Contact nodes: coordinates and forces on the secondary side (n x 3 each), areas, and 0 open, 1 stick or 2 slip."""

    places: object
    forces: object
    areas: object
    status: object


@dataclasses.dataclass
class Run:
    """What is left of a solved deck."""

    summary: dict
    status: int
    seconds: float  # of the processor, user and system
    directory: pathlib.Path
    log: str

    @property
    def products(self):
        return self.summary["hessian_multiplications"]

    @property
    def unknowns(self):
        """Those of the mesh, by the log: a node counts once for all subdomains."""
        return int(re.search(r"\bnodes, \d+ cells, (\d+) unknowns\b", self.log)[1])

    def points(self, contact=0):
        """Contact nodes of the last state."""
        import h5py

        with h5py.File(self.directory / "results.h5") as results:
            rows = results["contact/points"][:]
            rows = rows[rows[:, 0] == contact]
            return Points(results["nodes/points"][:][rows[:, 1].astype(int)], rows[:, 4:7], rows[:, 2], rows[:, 11].astype(int))


def solve(mortise, deck, directory):
    """The run of a deck. Ends the script where it fails and may not."""
    path = ROOT / deck.path if deck.make is None else deck.make(directory.with_suffix(".deck"))
    command = [mortise, str(path), "--output", str(directory)]
    for setting in deck.settings:
        command += ["--set", setting]
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    used = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    before = used()
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=deck.limit)
    seconds = used() - before
    if done.returncode != 0 and not deck.may_fail:
        raise SystemExit(f"{' '.join(command)}: exit status {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    summary = directory / "summary.json"
    return Run(json.loads(summary.read_text()) if summary.exists() else {}, done.returncode, seconds, directory, done.stdout)


def fill(mortise, table, rows):
    """Rows of cells, one after the other. What several rows of a table need is solved once."""
    with tempfile.TemporaryDirectory(prefix="mortise_table_") as scratch:
        runs = {}
        for row in rows:
            for deck in row.decks:
                if deck not in runs:
                    runs[deck] = solve(mortise, deck, pathlib.Path(scratch) / str(len(runs)))
            yield [*row.key, *(row.cells or table.cells)(*(runs[deck] for deck in row.decks))]


def main(tables, doc):
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("tables", nargs="*", metavar="TABLE", help="names of tables, or patterns of them; all if there is none")
    parser.add_argument("--row", help="rows alone whose first cell fits this pattern")
    parser.add_argument("--large", action="store_true", help="rows as well that take more than 2 GB or three minutes")
    parser.add_argument("--list", action="store_true", help="the names of the tables, and no runs")
    parser.add_argument("--write", action="store_true", help="put each row into its page")
    arguments = parser.parse_args()
    doubled = [name for name, count in collections.Counter(table.name for table in tables).items() if count > 1]
    assert not doubled, doubled
    for table in tables:
        if arguments.tables and not any(fnmatch.fnmatch(table.name, pattern) for pattern in arguments.tables):
            continue
        print(f"{table.page}, {table.name}", *([] if arguments.list else ["", page_tables.line_of(table.head)]), sep="\n", flush=True)
        fits = lambda row: row.large <= arguments.large and (not arguments.row or fnmatch.fnmatch(row.key[0], arguments.row))
        for cells in fill(arguments.mortise, table, [] if arguments.list else filter(fits, table.rows)):
            print(page_tables.line_of(["" if cell is None else str(cell) for cell in cells]), flush=True)
            if arguments.write:
                page_tables.write(ROOT / table.page, table.name, table.head, [cells], keys=table.keys, known=[tuple(row.key) for row in table.rows])
    return 0
