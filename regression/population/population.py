#!/usr/bin/env python3
"""Solves a population of random decks, or the decks of the table, and tabulates what they took.

    population.py MORTISE [--seed N ... --count M [--first K] [--small] | --table] [--tolerance 1e-6] [--jobs J] [--limit SECONDS] [--processor SECONDS]
                  [--reference] [--only PATTERN ...] [--set key=value ...] [--directory D] [--json FILE] [--markdown FILE] [--write NAME]

Several seeds take turns, deck by deck, so that a run that is stopped has seen all of them; what is done stands in the JSON file every ten decks.

A line a deck: exit status, products, seconds, residuals, warnings. Then percentiles of the products, the worst ten decks and how to run them again.
Decks stay in --directory, each with its results in `out`. --reference also solves the decks that have an independent reference, see reference.py.
--write puts the percentiles into the table "measured" of README.md, into the row of that name.
Exit status 1 if a deck that has an equilibrium ended other than with 0, one without it other than with 3, or if a reference differs.
"""
import argparse
import itertools
import json
import multiprocessing
import os
import pathlib
import resource
import shlex
import signal
import subprocess
import sys
import time

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
import generate  # noqa: E402
import page_tables  # noqa: E402

HEAD = ["decks", "solved", "products: median", "95 %", "worst", "no equilibrium", "held against the reference", "failed"]

ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", MORTISE_RANKS="1")
# What a row takes from summary.json.
KEYS = {"products": "hessian_multiplications", "primal_unknowns": "primal_unknowns", "multipliers": "dual_unknowns", "subdomains": "subdomains",
        "residuals": "residuals", "error_estimate": "error_estimate", "friction_steps": "friction_steps"}


def command(arguments, folder):
    words = [str(arguments.mortise), str(folder / "deck.yaml"), "--output", str(folder / "out")]
    for setting in arguments.set:
        words += ["--set", setting]
    return words


def run(arguments, folder):
    """Exit status ("time" beyond a limit), summary or None, seconds."""
    start = time.monotonic()
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (arguments.processor, arguments.processor))
    with (folder / "log.txt").open("w") as log:
        try:
            status = subprocess.run(command(arguments, folder), stdout=log, stderr=subprocess.STDOUT, env=ENVIRONMENT, timeout=arguments.limit,
                                    preexec_fn=limit if arguments.processor else None).returncode
            if arguments.processor and status in (-signal.SIGKILL, -signal.SIGXCPU):
                status = "time"
        except subprocess.TimeoutExpired:
            status = "time"
    seconds = time.monotonic() - start
    path = folder / "out" / "summary.json"
    summary = json.loads(path.read_text()) if status in (0, 2, 3) and path.exists() else None
    return status, summary, seconds


def work(task):
    """The row of one deck."""
    arguments, folder = task
    expected = json.loads((folder / "expected.json").read_text())
    (folder / "out" / "summary.json").unlink(missing_ok=True)
    status, summary, seconds = run(arguments, folder)
    row = {"name": folder.name, **expected, "expected": expected["exit_status"], "exit_status": status, "seconds": round(seconds, 2)}
    if summary:
        row.update({name: summary[key] for name, key in KEYS.items()})
        row["unknowns"] = row["unknowns"] or summary["primal_unknowns"]
        row["warnings"] = sorted(w["kind"] for w in summary["warnings"])
    row["complaints"] = [] if status == row["expected"] else [f"exit status {status}, expected {row['expected']}"]
    if arguments.reference and expected.get("reference") and status in (0, 2):  # 2: to see whether there is a solution
        import reference
        row["differences"], complaints = reference.compare(folder)
        row["complaints"] += complaints if status == 0 else []
    return row


def line(row):
    residuals = row.get("residuals", {})
    number = lambda value: "-" if value is None else f"{value:.0e}"
    shown = " ".join(number(residuals.get(key)) for key in ("projected_gradient", "equality", "equilibrium", "penetration", "complementarity"))
    text = (f"{row['name']:34} {row['element']:8} {row['law']:12} {row['kind']!s:12} {row['unknowns'] or '-'!s:>7} {row.get('subdomains', '-')!s:>4}"
            f"  exit {row['exit_status']}  products {row.get('products', '-')!s:>6}  {row['seconds']:7.1f} s  {shown}")
    if row.get("warnings"):
        text += "  " + ",".join(row["warnings"])
    if "differences" in row:
        text += "  reference: " + " ".join(f"{k} {v}" if isinstance(v, (str, int)) else f"{k} {v:.0e}" for k, v in row["differences"].items())
    return text + "".join(f"\n    FAILED: {c}" for c in row["complaints"])


def percentiles(rows):
    """{what: (decks, median, 95 %, worst)} of the products of what was solved, all and by family, element and law."""
    solved = [row for row in rows if row["expected"] == 0 and row.get("products") is not None]
    groups = {"all": solved}
    for key in ("family", "element", "law"):
        for value in sorted({row[key] for row in solved}):
            groups[f"{key} {value}"] = [row for row in solved if row[key] == value]
    result = {}
    for name, some in groups.items():
        if some:
            products = [row["products"] for row in some]
            result[name] = (len(some), *(float(np.percentile(products, p)) for p in (50, 95, 100)))
    return result


def markdown(rows, table):
    text = ["| deck | element | law | unknowns | subdomains | preconditioner | products | seconds | exit |", "|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        status = f"{row['exit_status']}" + (f" (**expected {row['expected']}**)" if row["exit_status"] != row["expected"] else "")
        text.append(f"| {row['name']} | {row['element']} | {row['law']} | {row['unknowns'] or ''} | {row.get('subdomains', '')} | {row.get('preconditioner', '')} | "
                    f"{row.get('products', '')} | {row['seconds']:.1f} | {status} |")
    text += ["", "| products of | decks | median | 95 % | worst |", "|---|---|---|---|---|"]
    text += [f"| {name} | {count} | {median:.0f} | {high:.0f} | {worst:.0f} |" for name, (count, median, high, worst) in table.items()]
    return "\n".join(text) + "\n"


def report(arguments, rows):
    """Percentiles, the worst ten, what failed; whether nothing did."""
    table = percentiles(rows)
    print("\nproducts                  decks  median    95 %   worst")
    for name, (count, median, high, worst) in table.items():
        print(f"{name:25} {count:5} {median:7.0f} {high:7.0f} {worst:7.0f}")
    ranked = sorted((row for row in rows if row.get("products") is not None and row["expected"] == 0), key=lambda row: -row["products"])
    print("\nThe worst ten:")
    for row in ranked[:10]:
        print(f"{row['products']:6}  {shlex.join(command(arguments, arguments.directory / row['name']))}")
    failed = [row for row in rows if row["complaints"]]
    print(f"\n{len(rows)} decks, {sum(row['exit_status'] == 0 for row in rows)} solved, {sum(row['exit_status'] == 3 for row in rows)} without an equilibrium, "
          f"{sum('displacement' in row.get('differences', {}) for row in rows)} held against a reference; {len(failed)} failed")
    for row in failed:
        print(f"{row['name']}: {'; '.join(row['complaints'])}\n    {shlex.join(command(arguments, arguments.directory / row['name']))}")
    if arguments.write and "all" in table:
        count, *products = table["all"]
        lost, held = (sum(row["exit_status"] == 3 for row in rows), sum("displacement" in row.get("differences", {}) for row in rows))
        page_tables.write(HERE / "README.md", "measured", HEAD, [[arguments.write, count, *(f"{p:.0f}" for p in products), lost, held, len(failed)]])
    if arguments.json:
        arguments.json.write_text(json.dumps({"rows": rows, "percentiles": table}, indent=1) + "\n")
    if arguments.markdown:
        arguments.markdown.write_text(markdown(rows, table))
    return not failed


def folders_of(arguments):
    if arguments.table:
        import table
        made = table.decks(arguments.directory, arguments.tolerance, arguments.only)
    else:
        each = [generate.random_decks(seed, arguments.count, arguments.directory, arguments.tolerance or 1e-6, arguments.small, arguments.first,
                                      arguments.only) for seed in arguments.seed]
        made = (folder for turn in itertools.zip_longest(*each) for folder in turn if folder)
    return ((arguments, folder) for folder in made)


def results_of(arguments, tasks):
    """The rows of all tasks, in their order. One job writes a deck when its turn comes, a pool all of them at once."""
    if arguments.jobs == 1:
        yield from map(work, tasks)
        return
    with multiprocessing.Pool(arguments.jobs) as pool:
        yield from pool.imap(work, tasks)


def wants_reference():
    """Refuses at once where the reference lacks its packages."""
    try:
        import reference  # noqa: F401
    except ImportError as error:
        print(f"--reference needs {error.name}:\n    /usr/bin/python3 -m venv --system-site-packages reference\n    reference/bin/pip install clarabel scipy\n"
              "    reference/bin/python population.py ... --reference\nskipped")
        sys.exit(77)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("--seed", type=int, nargs="+", default=[1])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--small", action="store_true", help="below some 3,000 unknowns")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--tolerance", type=generate.tolerance_of, help="auto or a number; 1e-6, or what the table says")
    parser.add_argument("--only", nargs="*", help="patterns of names")
    parser.add_argument("--set", action="append", default=[], help="passed to the program")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--limit", type=float, default=600, help="seconds of each run")
    parser.add_argument("--processor", type=int, help="seconds of processor of each run")
    parser.add_argument("--reference", action="store_true")
    parser.add_argument("--directory", type=lambda p: pathlib.Path(p).resolve(), default=pathlib.Path("population").resolve())
    parser.add_argument("--json", type=pathlib.Path, help="all rows; default: rows.json in the directory")
    parser.add_argument("--markdown", type=pathlib.Path, help="default: rows.md in the directory")
    parser.add_argument("--write", metavar="NAME", help="a row of the table in README.md")
    arguments = parser.parse_args()
    if arguments.reference:
        wants_reference()
    arguments.directory.mkdir(parents=True, exist_ok=True)
    arguments.json, arguments.markdown = arguments.json or arguments.directory / "rows.json", arguments.markdown or arguments.directory / "rows.md"
    rows = []
    for row in results_of(arguments, folders_of(arguments)):
        rows.append(row)
        print(line(row), flush=True)
        if len(rows) % 10 == 0:
            arguments.json.write_text(json.dumps({"rows": rows}, indent=1) + "\n")
    if not rows:
        parser.error("no such deck")
    return 0 if report(arguments, rows) else 1


if __name__ == "__main__":
    sys.exit(main())
