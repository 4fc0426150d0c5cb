#!/usr/bin/env python3
"""The tables of results.md, out of the study.csv files that `run` has left.

    choose.py OUTPUT [--write]

"speed": runs of CalculiX beside Mortise at the same error, by its better element, of all studies of the same problem. Of runs on one mesh, with
other solvers or penalties, that with the least ratio counts, and none that a coarser mesh matches: there the penalty is the error. "blocks": both
on the same mesh. "tolerance": the error of the pressure over solver.tolerance. Rows of studies that are not in OUTPUT stay as they are.
"""
import argparse
import csv
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parents[1] / "postproc")]
import page_tables  # noqa: E402
from studies import convergence, tables  # noqa: E402

PAGE = HERE / "results.md"
SPEED = ["study, element", "unknowns", "CalculiX", "its error", "its CPU s", "Mortise at that error: CPU s", "ratio"]
BLOCKS = ["unknowns", "Mortise: CPU s, strain energy", "CalculiX iterative", "SPOOLES", "ratio to the better"]
TOLERANCES = ["1e-1", "1e-2", "1e-3", "1e-4", "1e-6", "auto"]
TOLERANCE = ["study, element, mesh", "unknowns", *TOLERANCES, "products at 1e-6, auto"]
# Studies of one problem: Mortise's runs of all of them count.
PROBLEMS = [("cylinder",), ("press_fit_matching",), ("sphere", "sphere_stiff", "sphere_direct", "sphere_second_order"), ("friction_cylinder",)]


def rows_of(folder, quantity):
    """The runs of a study that were solved."""
    path = folder / "study.csv"
    if not path.exists():
        return []
    with path.open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["status"] == "0"]
    for row in rows:
        row.update(study=folder.name, cpu=float(row["cpu"]), errors={quantity: float(row[quantity])} if row.get(quantity) else {})
    return rows


def speed(output):
    quantity = convergence.L2
    for studies in PROBLEMS:
        rows = [row for study in studies for row in rows_of(output / study, quantity)]
        chains = {}
        for row in rows:
            if row["program"] == "Mortise" and row["tolerance"] == "auto":
                chains.setdefault(row["element"], []).append(row)
        best = {}
        for row in rows:
            if row["program"] == "Mortise" or not row["errors"]:
                continue
            wanted = row["errors"][quantity]
            row["ours"] = min(filter(None, (tables.seconds_of(chain, quantity, wanted) for chain in chains.values())), default=None)
            row["ratio"] = row["cpu"] / row["ours"] if row["ours"] else float("inf")
            key = row["element"], int(row["unknowns"])
            best[key] = min(best.get(key, row), row, key=lambda row: row["ratio"])
        for (element, unknowns), row in sorted(best.items()):
            wanted = row["errors"][quantity]
            if any(other["errors"][quantity] <= wanted for (e, u), other in best.items() if e == element and u < unknowns):
                continue
            yield [", ".join(filter(None, [f"`{row['study']}`", element])), f"{unknowns:,}", row["program"].removeprefix("CalculiX "),
                   f"{100 * wanted:.2g} %", f"{row['cpu']:.2f}", f"{row['ours']:.2f}" if row["ours"] else "-", f"{row['ratio']:.1f}" if row["ours"] else "-"]


def blocks(output):
    rows = rows_of(output / "friction_blocks", "strain_energy")
    for unknowns in dict.fromkeys(row["unknowns"] for row in rows):
        mine = {row["program"].split(" ")[-3] if row["program"] != "Mortise" else "Mortise": row for row in rows if row["unknowns"] == unknowns}
        ours, *theirs = (mine.get(name) for name in ("Mortise", "iterative", "SPOOLES"))
        said = [f"{row['cpu']:.2f}, {float(row['strain_energy']):.5f}" if row else "-" for row in (ours, *theirs)]
        better = min((row["cpu"] for row in theirs if row), default=None)
        yield [f"{int(unknowns):,}", *said, f"{better / ours['cpu']:.1f}" if better else "-"]


def tolerance(output):
    for study in ("tolerance_cylinder", "tolerance_press_fit"):
        rows = rows_of(output / study, convergence.L2)
        for element, mesh in dict.fromkeys((row["element"], row["mesh"]) for row in rows):
            mine = {row["tolerance"]: row for row in rows if (row["element"], row["mesh"]) == (element, mesh)}
            errors = [f"{100 * mine[t]['errors'][convergence.L2]:.2g} %" if t in mine else "-" for t in TOLERANCES]
            products = ", ".join(mine[t]["products"] if t in mine else "-" for t in ("1e-6", "auto"))
            yield [f"`{study.removeprefix('tolerance_')}`, {element}, {mesh}", f"{int(next(iter(mine.values()))['unknowns']):,}", *errors, products]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    for name, head, rows, keys in (("speed", SPEED, speed, 3), ("blocks", BLOCKS, blocks, 1), ("tolerance", TOLERANCE, tolerance, 1)):
        found = list(rows(arguments.output))
        print(f"{name}", "", page_tables.line_of(head), *map(page_tables.line_of, found), "", sep="\n")
        if arguments.write and found:
            study = lambda cells: cells[0].split(",")[0].strip("`") if name != "blocks" else "friction_blocks"
            done = {path.name.removeprefix("tolerance_" if name == "tolerance" else "") for path in arguments.output.iterdir()}
            kept = [row for row in page_tables.read(PAGE, name)[1] if study(row) not in done]
            page_tables.write(PAGE, name, head, found, keys=keys, known=[tuple(row[:keys]) for row in [*kept, *found]])


if __name__ == "__main__":
    main()
