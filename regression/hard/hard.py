#!/usr/bin/env python3
"""Solves the hard cases with both algorithms, judges each run and prints one table.

    hard.py MORTISE [CASE ...] [--kind fast|study] [--algorithm face_newton|smalse] [--ranks N] [--mpiexec MPIEXEC] [--limit SECONDS] [--show] [--write]
    hard.py --list [--kind fast|study]

CASE is a name in decks/ (or NAME@VARIANT, or a pattern such as 'scale*'); all cases if absent. A deck NAME.yaml has its expectations beside it in
NAME.expected.json, with the keys of ../run.py ("quantities", "residuals", "exit_status", "output",
"address_space") and

    "group": heading of the case,  "expected": what is expected and why, in words
    "variants": {"name": {"set": ["key=value"], ...}}    runs of the deck with other settings; each may replace any key of the deck's own
    "equals": {"run": "NAME@VARIANT", "quantities": {"strain_energy": factor, ...}, "relative": 1e-9}
                                                         a quantity of this run is factor times that of the other run
    "most_products": 1.1                                 in "equals": a ceiling, times the products of the other run
    "ranks": 2                                           of this run; in "equals", of the other one
    "limit": 60                                          seconds after which a run counts as hanging
    "smalse": {...}                                      what replaces the deck's keys with the paper's algorithm; {"skip": "why"} leaves it out
    "fails": {"smalse": {"why": "...", "by": ["contacts.0.open:", ...], "output": ["..."]}}
                                                         what an algorithm is known not to give: how each complaint begins, and what the terminal
                                                         shows. A run that fails by anything else is a failure, and so is one that no longer does
    "study": true                                        not for the normal suite

--write puts the rows into results.md.

Always judged: the exit status, no signal, no NaN in summary.json (an unknown number is null: allowed in error_estimate alone), the KKT residuals,
no temporary file left behind, no end without a word.
"""
import argparse
import fnmatch
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
PAGE = HERE / "results.md"
sys.path.insert(0, str(HERE.parent))
import page_tables  # noqa: E402
import run as regression  # noqa: E402

ALGORITHMS = ("face_newton", "smalse")
LIMIT = 60  # seconds


def cases():
    """All runs by name: NAME or NAME@VARIANT, with the deck and the expectations."""
    found = {}
    for store in sorted((HERE / "decks").glob("*.expected.json")):
        name = store.name[: -len(".expected.json")]
        deck = json.loads(store.read_text())
        variants = deck.pop("variants", {"": {}})
        for variant, replaced in variants.items():
            entry = {**deck, **replaced, "deck": HERE / "decks" / f"{name}.yaml"}
            entry["quantities"] = {**deck.get("quantities", {}), **replaced.get("quantities", {})}
            found[f"{name}@{variant}" if variant else name] = entry
    return found


def for_algorithm(entry, algorithm):
    """The entry with the settings and what one algorithm replaces."""
    own = entry.get(algorithm, {})
    result = {**entry, **own, "quantities": {**entry["quantities"], **own.get("quantities", {})}}
    result["set"] = entry.get("set", []) + own.get("set", []) + [f"solver.algorithm={algorithm}"]
    return result


def execute(arguments, entry, ranks, directory):
    """Exit status (None after the time limit), text of the terminal and seconds of one run."""
    command = [arguments.mortise, str(entry["deck"]), "--output", str(directory)]
    for value in entry["set"]:
        command += ["--set", value]
    if ranks > 1:
        command = [arguments.mpiexec, "--oversubscribe", "-n", str(ranks)] + command
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                       OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")

    def confine():
        resource.setrlimit(resource.RLIMIT_AS, (entry["address_space"],) * 2)

    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment,
                               start_new_session=True, preexec_fn=confine if "address_space" in entry else None)
    try:
        text = process.communicate(timeout=arguments.limit or entry.get("limit", LIMIT))[0]
        status = process.returncode
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        text, status = process.communicate()[0], None
    return status, text, time.perf_counter() - start


def unknown_numbers(value, path=""):
    """Paths of nulls and NaNs."""
    if isinstance(value, dict):
        return [p for key, part in value.items() for p in unknown_numbers(part, f"{path}.{key}")]
    if isinstance(value, list):
        return [p for i, part in enumerate(value) for p in unknown_numbers(part, f"{path}.{i}")]
    return [path[1:]] if value is None or value != value else []


def worst_error(summary, quantities):
    """The largest error of the quantities over what is allowed, and that error: relative, or absolute where zero is expected."""
    worst = (-1.0, None)
    for path, quantity in quantities.items():
        value = quantity.get("value")
        if value is None or isinstance(value, (bool, str)):  # a ceiling has none
            continue
        try:
            error = abs(regression.look_up(summary, path) - value)
        except (KeyError, IndexError, TypeError):
            continue
        allowed = quantity.get("absolute", 0) + quantity.get("relative", 0) * abs(value)
        if error / max(allowed, 1e-300) > worst[0]:
            worst = (error / max(allowed, 1e-300), error / abs(value) if value else error)
    return worst[1]


def news(entry, algorithm, complaints, text):
    """Of the complaints about a run those that its "fails" does not name, and what that names but the run no longer does."""
    known = entry.get("fails", {}).get(algorithm, {})
    by = known.get("by", [])
    return ([c for c in complaints if not any(c.startswith(start) for start in by)] +
            [f"no longer fails by {start!r}" for start in by if not any(c.startswith(start) for c in complaints)] +
            [f"the terminal does not show {wanted!r}" for wanted in known.get("output", []) if wanted not in text])


class Runner:
    """Runs cases once each and keeps what they found, for those that are to equal others."""

    def __init__(self, arguments):
        self.arguments = arguments
        self.all = cases()
        self.done = {}

    def solve(self, name, algorithm, ranks):
        """Status, text, seconds, summary (None if there is none) and what was left behind."""
        key = (name, algorithm, ranks)
        if key in self.done:
            return self.done[key]
        entry = for_algorithm(self.all[name], algorithm)
        with tempfile.TemporaryDirectory(prefix="mortise_hard_", dir=self.arguments.scratch) as scratch:
            directory = pathlib.Path(scratch) / "results"
            status, text, seconds = execute(self.arguments, entry, ranks, directory)
            file = directory / "summary.json"
            summary = json.loads(file.read_text()) if file.exists() else None
            left = regression.left_over(directory) if directory.exists() else []
            if self.arguments.keep and directory.exists():
                shutil.copytree(directory, pathlib.Path(self.arguments.keep) / f"{name}.{algorithm}.{ranks}", dirs_exist_ok=True)
        self.done[key] = status, text, seconds, summary, left
        return self.done[key]

    def compare(self, equals, name, algorithm, ranks, summary):
        """Complaints about a run that is to equal another, and the largest difference."""
        complaints, worst = [], 0.0
        other_ranks = equals.get("ranks", ranks)
        other = self.solve(equals.get("run", name), equals.get("algorithm", algorithm), other_ranks)[3]
        if other is None:
            return [f"{equals['run']} has no results to compare with"], None
        for path, factor in equals["quantities"].items():
            found, expected = regression.look_up(summary, path), factor * regression.look_up(other, path)
            error = abs(found - expected) / abs(expected) if expected else abs(found)
            worst = max(worst, error)
            if not error <= equals.get("relative", 0) + (equals.get("absolute", 0) / abs(expected) if expected else 0):
                complaints.append(f"{path}: {found!r}, but {factor} times {equals.get('run', name)} is {expected!r}")
        if summary["hessian_multiplications"] > equals.get("most_products", float("inf")) * other["hessian_multiplications"]:
            complaints.append(f"{summary['hessian_multiplications']} products, but {equals.get('run', name)} took "
                              f"{other['hessian_multiplications']}")
        return complaints, worst

    def judge(self, name, algorithm, ranks):
        """Complaints, the error found and products of a run."""
        entry = for_algorithm(self.all[name], algorithm)
        status, text, seconds, summary, left = self.solve(name, algorithm, ranks)
        expected = entry.get("exit_status", 0)
        complaints, error = [f"left behind: {file}" for file in left], None
        if status is None:
            return ["hangs: stopped by the time limit"], None, None, seconds, text
        if status != expected:
            complaints.append(f"exit status {status}, expected {expected}")
        if not text.strip():
            complaints.append("ended without a word")
        complaints += [f"the terminal does not show {wanted!r}" for wanted in entry.get("output", []) if wanted not in text]
        complaints += [f"the terminal shows {bad!r}" for bad in entry.get("not_output", []) + [" nan", "-nan"] if bad in text]
        if status not in (0, 2) and summary:
            complaints.append("summary.json of a run that failed")
        if status in (0, 2) and not summary:
            complaints.append("no summary.json")
        if summary:
            complaints += [f"{path} is not a number" for path in unknown_numbers(summary) if not path.startswith("error_estimate.")]
        if summary and status == 0 and expected == 0:
            complaints += regression.judge(summary, entry)
            error = worst_error(summary, entry["quantities"])
            for equals in entry.get("equals", []):
                more, difference = self.compare(equals, name, algorithm, ranks, summary)
                complaints += more
                error = max(error or 0.0, difference or 0.0)
        return complaints, error, summary["hessian_multiplications"] if summary else None, seconds, text


HEAD = ["case", "error found", "face Newton: products", "s", "SMALSE: products", "s", "verdict"]


def in_order(every):
    """The names of all runs as they stand in the table: by group and deck."""
    return sorted(every, key=lambda name: (every[name]["group"], name))


def headings(name, every, before):
    """The rows that come before that of a run: of its group and of its deck, where `before`, the run before, has others."""
    entry, rows = every[name], []
    if before is None or entry["group"] != every[before]["group"]:
        rows.append(f"**{entry['group']}**")
    if before is None or name.split("@")[0] != before.split("@")[0]:
        rows.append(f"*{name.split('@')[0]}*: {entry['expected']}")
    return [[row] + [""] * (len(HEAD) - 1) for row in rows]


def known_keys():
    """Of the rows that the table of the page has."""
    every, before, keys = cases(), None, []
    for name in in_order(every):
        keys += [(row[0],) for row in headings(name, every, before)] + [(shown(name, every[name]),)]
        before = name
    return keys


def shown(name, entry):
    return name + (" (study)" if entry.get("study") else "")


def table_row(name, results):
    """A row of the table: results holds (complaints, error, products, seconds, text) by algorithm."""
    errors = [r[1] for r in results.values() if r and r[1] is not None]
    cells = [name, f"{max(errors):.0e}" if errors else ""]
    for algorithm in ALGORITHMS:
        result = results.get(algorithm)
        cells += [None, None] if algorithm not in results else ["", ""] if not result else [str(result[2]) if result[2] is not None else "-", f"{result[3]:.1f}"]
    failed = [f"{a}: {'; '.join(r[0])}" for a, r in results.items() if r and r[0]]
    return cells + ["**fails**: " + " / ".join(failed).replace("|", "/").replace("\n", " ") if failed else "passed"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise", nargs="?")
    parser.add_argument("cases", nargs="*")
    parser.add_argument("--algorithm", choices=ALGORITHMS, action="append")
    parser.add_argument("--ranks", type=int, default=None, help="instead of the stored number (1)")
    parser.add_argument("--mpiexec", default="mpirun")
    parser.add_argument("--limit", type=float, default=None, help="seconds for each run instead of the stored limits")
    parser.add_argument("--scratch", default=None)
    parser.add_argument("--keep", default=None, help="folder for the results")
    parser.add_argument("--write", action="store_true", help="of both algorithms: the table into results.md")
    parser.add_argument("--show", action="store_true", help="print the terminal of runs that fail")
    parser.add_argument("--kind", choices=("fast", "study"), help="of the cases, those for the normal suite, or the others")
    parser.add_argument("--list", action="store_true", help="print the names of the decks and stop")
    arguments = parser.parse_intermixed_args()
    runner = Runner(arguments)
    patterns = arguments.cases or ["*"]
    names = [n for n in runner.all if any(fnmatch.fnmatch(n, p) or n.split("@")[0] == p for p in patterns)]
    if arguments.kind:
        names = [n for n in names if runner.all[n].get("study", False) == (arguments.kind == "study")]
    if arguments.list:
        print("\n".join(dict.fromkeys(n.split("@")[0] for n in names)))
        return 0
    if not names:
        parser.error("no such case")
    if arguments.write and (arguments.algorithm or arguments.ranks):
        parser.error("--write is for both algorithms and the stored ranks")
    print(page_tables.line_of(HEAD), "|" + "---|" * len(HEAD), sep="\n")
    failures, before = 0, None
    for name in (n for n in in_order(runner.all) if n in names):
        entry, results = runner.all[name], {}
        rows = headings(name, runner.all, before)
        before = name
        for algorithm in arguments.algorithm or ALGORITHMS:
            results[algorithm] = None
            if "skip" not in entry.get(algorithm, {}):
                results[algorithm] = runner.judge(name, algorithm, arguments.ranks or entry.get("ranks", 1))
        rows.append(table_row(shown(name, entry), results))
        print(*(page_tables.line_of([cell or "" for cell in cells]) for cells in rows), sep="\n", flush=True)
        if arguments.write:
            page_tables.write(PAGE, "hard", HEAD, rows, known=known_keys())
        for algorithm, result in results.items():
            unknown = news(entry, algorithm, result[0], result[4]) if result else []
            failures += bool(unknown)
            if unknown and arguments.show:
                print(f"--- {name}, {algorithm}: {'; '.join(unknown)}\n{result[4]}")
            elif result and result[0] and not unknown:
                print(f"--- {name}, {algorithm}: known to fail: {entry['fails'][algorithm]['why']}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
