#!/usr/bin/python3
"""Input files become decks whose solution is CalculiX's.

    decks_test.py MORTISE

NAME.expected.json holds displacements of CalculiX 2.20 with ten times the penalty of the contacts in NAME.inp (abaqus_decks.py in
regression/comparison); what is left of the penalty is the tolerance. Exit status 1 if a displacement is farther off.
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
IMPORT = HERE.parents[1] / "inputs" / "import" / "import_deck.py"
TOLERANCE = {"pressed_block": 0.004, "two_plates": 0.008, "bolt": 0.002, "springs": 1e-5, "wood": 1e-5, "transforms": 1e-5, "warm": 2e-4, "ties": 1e-5}


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{command[-1]}: exit status {done.returncode}\n{done.stdout}{done.stderr}")


def worst(mortise, name, directory):
    """The largest difference of a displacement, over the largest displacement."""
    expected = json.loads((HERE / f"{name}.expected.json").read_text())
    points = [n["point"] for n in expected["nodes"]]
    run(sys.executable, IMPORT, HERE / f"{name}.inp", "-o", directory / f"{name}.yaml")
    run(mortise, directory / f"{name}.yaml", "--set", f"output.interior.points={points}", "--set", "solver.tolerance=1e-7")
    rows = list(csv.DictReader((directory / f"{name}.out" / "interior.csv").read_text().splitlines()))
    off = 0.0
    for node in expected["nodes"]:
        at = [r for r in rows if r["body"] == node["body"] and all(abs(float(r[k]) - x) < 1e-7 for k, x in zip("xyz", node["point"]))]
        if not at:  # several where there are several steps, or a point was asked for once for each body
            raise SystemExit(f"{name}: node {node['node']} of {node['body']} is not in interior.csv")
        off = max(off, *(abs(float(at[-1][k]) - u) for k, u in zip(("ux", "uy", "uz"), node["displacement"])))
    return off / expected["largest"]


def main():
    failed = False
    for name, tolerance in TOLERANCE.items():
        with tempfile.TemporaryDirectory(prefix="mortise_import_") as directory:
            off = worst(sys.argv[1], name, pathlib.Path(directory))
        print(f"{name}: {100 * off:.2f} % of the largest displacement, at most {100 * tolerance:.2g} %")
        failed |= not off <= tolerance
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
