#!/usr/bin/env python3
"""Products with F on elastic_box.yaml, beside the iterations of ESPRESO in ../README.md.

    products.py MORTISE [--write]
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))
import page_tables  # noqa: E402

HEAD = ["preconditioner", "ESPRESO: iterations", "Mortise: products"]
ROWS = ["none", "lumped", "dirichlet"]


def products(mortise, preconditioner):
    with tempfile.TemporaryDirectory(prefix="mortise_elastic_box_") as directory:
        command = [mortise, str(HERE / "elastic_box.yaml"), "--output", directory, "--set", f"solver.preconditioner={preconditioner}"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(done.stdout + done.stderr)
        return json.loads((pathlib.Path(directory) / "summary.json").read_text())["hessian_multiplications"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--write", action="store_true", help="the last column of the table in ../README.md")
    arguments = parser.parse_args()
    for preconditioner in ROWS:
        row = [preconditioner, None, products(arguments.mortise, preconditioner)]
        print(f"{row[0]}: {row[2]}", flush=True)
        if arguments.write:
            page_tables.write(HERE.parent / "README.md", "elastic box", HEAD, [row])


if __name__ == "__main__":
    main()
