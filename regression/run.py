#!/usr/bin/env python3
"""Runs one regression deck and judges what it left behind.

    run.py MORTISE DECK --ranks N [--mpiexec MPIEXEC] [--set key=value ...]   compare with the stored results
    run.py MORTISE DECK --ranks N --update                                                 store the results of this run

Quantities are those of summary.json; interior.4.szz is that of the fifth row of interior.csv, and likewise of other tables:
probes/2/peak of probes.csv, probe.edge/3/sxx of probe.edge.csv (with / where names have dots).

A deck NAME.yaml has its expectations beside it in NAME.expected.json, or in the file that --expected names:

    {"quantities": {"strain_energy": {"value": 1.25, "relative": 1e-3}, "contacts.0.force.2": {"value": -50, "absolute": 1e-2},
                    "hessian_multiplications": {"most": 40}},                     a ceiling: what may be less
     "residuals": {"equilibrium": 1e-6},            limits that replace the default ones below
     "exit_status": 0, "output": ["text that the terminal must show"],
     "warnings": ["locking"],                            the kinds of all warnings of a run, sorted
     "summary": true,                                    a run that fails leaves that of the load steps before
     "address_space": 3000000000}                        bytes that the run may take

Every quantity has a tolerance of its own: without one there is no test. Whatever a deck stores, its KKT residuals are judged as well:
they hold whichever way the solver went.
"""
import argparse
import csv
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

# Limits of summary.json's residuals for a deck solved to 1e-6, a hundred times looser than what such decks reach.
RESIDUALS = {"projected_gradient": 1e-6, "equality": 1e-6, "equilibrium": 1e-8, "penetration": 1e-4, "complementarity": 1e-4,
             "supports": 1e-3, "interfaces": 1e-3}


def entry(text):
    try:
        return float(text)
    except ValueError:
        return text


def read_summary(directory):
    """summary.json, with the rows of interior.csv and of the probes' tables, and the names of all files."""
    summary = json.loads((directory / "summary.json").read_text())
    summary["files"] = sorted(path.name for path in directory.iterdir())
    for table in [directory / "interior.csv", *directory.glob("probe*.csv")]:
        if table.exists():
            with table.open(newline="") as lines:
                rows = [{key: entry(value) for key, value in row.items()} for row in csv.DictReader(lines)]
            summary["interior" if table.stem == "interior" else "/" + table.stem] = rows
    return summary


def look_up(summary, path):
    value = summary
    keys = path.split("/") if "/" in path else path.split(".")
    if "/" in path:
        keys[0] = "/" + keys[0]
    for key in keys:
        value = value[int(key)] if isinstance(value, list) else value[key]
    return value


def close(found, expected):
    if "most" in expected:
        return found is not None and found <= expected["most"]
    if isinstance(expected["value"], (bool, str)):
        return found == expected["value"]
    if "relative" not in expected and "absolute" not in expected:
        raise SystemExit("a quantity without a tolerance is no test")
    allowed = expected.get("absolute", 0) + expected.get("relative", 0) * abs(expected["value"])
    return found is not None and abs(found - expected["value"]) <= allowed


def run(arguments, directory, address_space):
    command = [arguments.mortise, str(arguments.deck), "--output", str(directory)]
    for value in arguments.set:
        command += ["--set", value]
    if arguments.ranks > 1:
        # Ranks end together; Open MPI would wait a second before it kills those that a failed one left.
        command = [arguments.mpiexec, "--oversubscribe", "--mca", "odls_base_sigkill_timeout", "0", "-n", str(arguments.ranks)] + command
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                       OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    limit = (lambda: resource.setrlimit(resource.RLIMIT_AS, (address_space, address_space))) if address_space else None
    return subprocess.run(command, capture_output=True, text=True, env=environment, timeout=600, preexec_fn=limit)


def compare(summary, expected):
    """The complaints about stored quantities."""
    complaints = []
    for path, quantity in expected.get("quantities", {}).items():
        try:
            found = look_up(summary, path)
        except (KeyError, IndexError):
            complaints.append(f"{path}: not in summary.json")
            continue
        if not close(found, quantity):
            complaints.append(f"{path}: {found!r}, expected {quantity}")
    return complaints


def judge(summary, expected):
    """The complaints about one run that is solved."""
    complaints = compare(summary, expected)
    for name, limit in {**RESIDUALS, **expected.get("residuals", {})}.items():
        found = summary["residuals"][name]
        if found is None or not found <= limit:
            complaints.append(f"residuals.{name}: {found!r}, limit {limit}")
    return complaints


def left_over(directory):
    """Temporary files that a run must not leave."""
    return [path.name for path in directory.rglob("*") if path.name.endswith((".tmp", ".part")) or path.name.startswith(".")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("deck", type=pathlib.Path)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--mpiexec", default="mpirun")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--expected", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()

    store = arguments.expected or arguments.deck.with_suffix(".expected.json")
    expected = json.loads(store.read_text())
    with tempfile.TemporaryDirectory() as scratch:
        directory = pathlib.Path(scratch) / "results"
        done = run(arguments, directory, expected.get("address_space"))
        text = done.stdout + done.stderr
        complaints = [f"the terminal does not show {wanted!r}" for wanted in expected.get("output", []) if wanted not in text]
        status = expected.get("exit_status", 0)
        if done.returncode != status:
            complaints.append(f"exit status {done.returncode}, expected {status}")
        summary_file = directory / "summary.json"
        if status in (0, 2) and summary_file.exists():
            summary = read_summary(directory)
            if arguments.update:
                for path, quantity in expected["quantities"].items():
                    if "most" in quantity:
                        continue
                    quantity["value"] = look_up(summary, path)
                store.write_text(json.dumps(expected, indent=1) + "\n")
                print(f"stored {store}")
                return 0
            complaints += (judge if status == 0 else compare)(summary, expected)
            kinds = sorted(warning["kind"] for warning in summary["warnings"])
            if kinds != expected.get("warnings", kinds):
                complaints.append(f"warnings {kinds}, expected {expected['warnings']}")
            complaints += [f"the last lines do not show the warning {warning['text']!r}" for warning in summary["warnings"]
                           if warning["text"] not in done.stdout[done.stdout.find("seconds on the ranks"):]]
        elif status in (0, 2):
            complaints.append("no summary.json")
        elif summary_file.exists() != expected.get("summary", False):
            complaints.append("summary.json of a run that failed, or none of its states before")
        history = directory / "history.csv"
        if history.exists() and any(word in history.read_text() for word in (",inf", ",-inf", ",nan", ",-nan")):
            complaints.append("history.csv has a number that is none")
        if directory.exists():
            complaints += [f"left behind: {name}" for name in left_over(directory)]
    if complaints:
        print(text)
        print(f"{arguments.deck.name} on {arguments.ranks} ranks:", *complaints, sep="\n  ")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
