#!/usr/bin/env python3
"""Products with F on rigid_wall.yaml, beside those of other programs in ../espresso_permon.md.

    products.py MORTISE [--write]
"""
import argparse
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[0]), str(HERE.parents[1])]
import page_tables  # noqa: E402
from products_of import products_of  # noqa: E402

HEAD = ["subdomains, cells an edge of each", "ESPRESO", "PERMON, default", "Mortise"]
ROWS = [(2, 5), (2, 8), (3, 5), (4, 8), (6, 5)]  # subdomains along an edge of the cube, cells along one of theirs


def products(mortise, subdomains, cells):
    settings = [f"mesh.blocks.cube.cells={[subdomains * cells] * 3}", f"decomposition.counts={{cube: {[subdomains] * 3}, wall: [1, 1, 1]}}"]
    return products_of(mortise, HERE / "rigid_wall.yaml", settings)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--write", action="store_true", help="the last column of the table in ../espresso_permon.md")
    arguments = parser.parse_args()
    for subdomains, cells in ROWS:
        row = [f"{subdomains**3}, {cells}", None, None, products(arguments.mortise, subdomains, cells)]
        print(f"{row[0]}: {row[3]}", flush=True)
        if arguments.write:
            page_tables.write(HERE.parent / "espresso_permon.md", "rigid wall", HEAD, [row])


if __name__ == "__main__":
    main()
