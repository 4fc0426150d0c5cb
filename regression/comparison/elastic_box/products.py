#!/usr/bin/env python3
"""Products with F on elastic_box.yaml, beside the iterations of ESPRESO in ../espresso_permon.md.

    products.py MORTISE [--write]
"""
import argparse
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[0]), str(HERE.parents[1])]
import page_tables  # noqa: E402
from products_of import products_of  # noqa: E402

HEAD = ["preconditioner", "ESPRESO: iterations", "Mortise: products"]
ROWS = ["none", "lumped", "dirichlet"]


def products(mortise, preconditioner):
    return products_of(mortise, HERE / "elastic_box.yaml", [f"solver.preconditioner={preconditioner}"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--write", action="store_true", help="the last column of the table in ../espresso_permon.md")
    arguments = parser.parse_args()
    for preconditioner in ROWS:
        row = [preconditioner, None, products(arguments.mortise, preconditioner)]
        print(f"{row[0]}: {row[2]}", flush=True)
        if arguments.write:
            page_tables.write(HERE.parent / "espresso_permon.md", "elastic box", HEAD, [row])


if __name__ == "__main__":
    main()
