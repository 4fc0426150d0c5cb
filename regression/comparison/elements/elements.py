#!/usr/bin/env python3
"""What each element costs and how far it is off, on bent_plate.yaml: the table of docs/elements.md.

    elements.py MORTISE [--row PATTERN] [--large] [--write]

Cells of the plate are 8 k x 2 k x k, those of the block 4 k x 2 k x k. The deflection is held against that of hex27 with k = 7 (--large solves it
again); times are over that of the first row. Needs python3-h5py.
"""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))
import page_tables  # noqa: E402, F401: table_runs.py writes by it
from table_runs import Deck, Row, Table, main  # noqa: E402

DEFLECTION = 0.0876
HEAD = ["element, formulation", "k", "unknowns", "error of the deflection", "CPU time, of the first row's"]
ROWS = [("hex8", 4), ("hex8", 8), ("hex8, `incompatible`", 2), ("hex8, `incompatible`", 4), ("hex20", 2), ("hex27", 2), ("tet10", 2), ("prism15", 2),
        ("prism6", 8), ("tet4", 8), ("boundary elements of hex8's faces", 2), ("boundary elements of hex8's faces", 3), ("hex27", 7)]


def deck(name, k):
    element, _, formulation = name.partition(", ")
    boundary = name.startswith("boundary")
    settings = [f"mesh.blocks.{block}.cells=[{a * k}, {2 * k}, {k}]" for block, a in (("plate", 8), ("base", 4))]
    settings += [f"mesh.blocks.{block}.element={'hex8' if boundary else element}" for block in ("plate", "base")]
    settings += [f"bodies.{body}.method=boundary_elements" for body in ("plate", "base") if boundary]
    settings += [f"bodies.{body}.formulation={formulation.strip('`')}" for body in ("plate", "base") if formulation]
    return Deck("regression/comparison/elements/bent_plate.yaml", tuple(settings))


def cells(run, first):
    summary = run.summary
    count = f"{run.unknowns:,}"
    return [count, f"{100 * abs(summary['max_displacement'] / DEFLECTION - 1):.2g} %", f"{run.seconds / first.seconds:.1f}"]


if __name__ == "__main__":
    rows = [Row((name, str(k)), (deck(name, k), deck(*ROWS[0])), large=k > 4 and name == "hex27") for name, k in ROWS]
    sys.exit(main([Table("docs/elements.md", "elements", HEAD, rows, cells, keys=2)], __doc__))
