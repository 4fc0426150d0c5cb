"""Runs the program and judges what it did by what it promises: an exit status of 0 to 4, no signal, no endless run, bounded memory,
a message with a cause where it fails, and numbers that are numbers and balance where it does not."""
import dataclasses
import json
import math
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "verification"))
import results  # noqa: E402

CPU_SECONDS, WALL_SECONDS, RESIDENT = 20, 180, 3e9  # of one run on one rank; more is a find
ADDRESS_SPACE = 8 << 30  # protects the machine

# What a user should never read: names of our types, of libraries' exceptions, of signals.
FOREIGN = re.compile(r"std::|what\(\)|basic_string|vector::|map::at|bad_alloc|terminate called|[Aa]ssertion|[Ss]egmentation|stack trace|"
                     r"YAML::|bad conversion|invalid node|json\.exception|Teuchos|Tpetra|H5[A-Z]|\*\*\* |mortise: rank|yaml-cpp|regex_error|MPI_ABORT")
NOT_A_NUMBER = re.compile(r"(?<![\w.\"-])-?(nan|inf)(?![\w.\"])", re.IGNORECASE)
BALANCE_FAR_AWAY = 1e-3  # the program's own limit
# Limits of residuals and of the balance of forces for a run that says solved.
RESIDUALS = {"equilibrium": 1e-6, "equality": 1e-2, "projected_gradient": 0.3, "penetration": 5e-2, "complementarity": 5e-2,
             "supports": 5e-2, "interfaces": 5e-2}


@dataclasses.dataclass
class Run:
    status: int  # negative: ended by a signal
    out: str
    err: str
    resident: float  # of this run, if it is the largest of all runs so far; else 0
    hung: bool


def run(mortise, deck, arguments=(), ranks=1, mpiexec="mpirun"):
    command = [str(mortise), str(deck), *arguments]
    if ranks > 1:
        command = [mpiexec, "--oversubscribe", "-n", str(ranks)] + command
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                       OMPI_MCA_btl_vader_single_copy_mechanism="none")
    if ranks == 1:
        environment["OMPI_MCA_ess_singleton_isolated"] = "1"  # no daemon of Open MPI beside it: a third of the time
        environment["OMPI_MCA_orte_tmpdir_base"] = str(pathlib.Path(deck).parent)  # where such runs would be in one another's way

    def limit():
        os.setsid()
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS + 5))
        resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment,
                               preexec_fn=limit, cwd=pathlib.Path(deck).parent)
    hung = False
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024
    try:
        out, err = process.communicate(timeout=WALL_SECONDS)
    except subprocess.TimeoutExpired:
        hung = True
        os.killpg(process.pid, signal.SIGKILL)
        out, err = process.communicate()
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024
    status = process.returncode
    if status in (-signal.SIGXCPU, 128 + signal.SIGXCPU):
        hung = True
    return Run(status, out.decode(errors="replace"), err.decode(errors="replace"), peak if peak > before else 0, hung)


def arrays(path):
    """The arrays of numbers of a .vtu file by name."""
    for fields in results.read_vtu(path).values():
        yield from ((name, values) for name, values in fields.items() if values.dtype.kind == "f")


def not_finite(value, path=""):
    """Where a JSON value is no finite number."""
    if isinstance(value, dict):
        # A contact without points has no smallest gap.
        absent = value.get("smallest", 0) is None and value.get("touching_area") == 0
        return [text for key, entry in value.items() if not (absent and key == "smallest") for text in not_finite(entry, f"{path}.{key}")]
    if isinstance(value, list):
        return [text for i, entry in enumerate(value) for text in not_finite(entry, f"{path}.{i}")]
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return [f"summary.json{path} is {value}"]
    return []


def judge_files(directory, status, at_rest):
    """Complaints about what a run left behind. at_rest: nothing acts at its end, so that residuals are those of rounding."""
    complaints = [f"left behind: {path.name}" for path in directory.rglob("*") if path.name.endswith((".tmp", ".part")) or path.name.startswith(".")]
    file = directory / "summary.json"
    if not file.exists():
        return complaints + (["no summary.json"] if status in (0, 2) else [])
    try:
        summary = json.loads(file.read_text())
    except ValueError as error:
        return complaints + [f"summary.json is no JSON: {error}"]
    if summary["exit_status"] != status or summary["converged"] != (status == 0):
        complaints.append(f"summary.json says exit_status {summary['exit_status']}, converged {summary['converged']}")
    if status != 0:
        return complaints
    complaints += not_finite(summary)
    for name, most in RESIDUALS.items():
        value = summary["residuals"].get(name)
        if value is not None and not value <= most and not at_rest:
            complaints.append(f"residuals.{name} is {value:.2g} in a run that says solved, more than {most:g}")
    history = (directory / "history.csv").read_text()
    if NOT_A_NUMBER.search(history.replace(",", " ")):
        complaints.append("history.csv has a nan or inf")
    for path in sorted(directory.rglob("*.vtu")):
        for name, values in arrays(path):
            if not np.isfinite(values).all():
                complaints.append(f"{path.name}: {name} has a nan or inf")
    return complaints


def unbalanced(applied, directory):
    """Whether what supports and obstacles carry is not minus `applied`."""
    summary = json.loads((directory / "summary.json").read_text())
    carried = [entry["force"] for entry in summary["reactions"]] + [entry["force"] for entry in summary["contacts"] if entry["name"] == "floor"]
    sums = [sum(force[i] for force in carried) for i in range(len(applied))]
    size = max([abs(x) for x in applied] + [abs(x) for force in carried for x in force])
    wrong = [i for i, (a, b) in enumerate(zip(applied, sums)) if not abs(a + b) <= 1e-4 * size]
    return [f"supports carry {sums} of {applied}"] if wrong else []


def judge(done, names, directory=None):
    """The complaints about one run. names: texts of which a message of failure must hold one: the deck's, the mesh's. directory: of the
    results; None for a run with --check."""
    if done.hung:
        return [f"hang: more than {CPU_SECONDS} s of CPU or {WALL_SECONDS} s"]
    if done.status not in range(5):
        return [f"exit status {done.status}"]
    complaints = []
    told = done.status == 4 and "gmsh: it took more memory than the machine has" in done.err  # in a process of its own
    if done.resident > RESIDENT and not told:
        complaints.append(f"memory: {done.resident / 1e9:.1f} GB")
    if found := FOREIGN.search(re.sub(r"gmsh crashed \([^)]*\)", "", done.err)):  # in a process of its own
        complaints.append(f"message: it holds {found[0]!r}")
    if found := NOT_A_NUMBER.search(re.sub(r"\"[^\"\n]*\"|'[^'\n]*'|file version \S+", "", done.out + done.err)):
        complaints.append(f"message: it holds {found[0]!r}")
    lines = [line for line in done.err.splitlines() if line.strip()]
    if done.status == 1:
        if not lines:
            complaints.append("message: exit status 1 without one")
        elif not any(name in done.err for name in names) and "--set" not in done.err and '"' not in done.err:
            complaints.append("message: names no file, key or body")
    if done.status in (3, 4) and not lines:
        complaints.append(f"message: exit status {done.status} without one")
    if done.status == 3 and "body" not in done.err and "bod" not in done.err and "contact" not in done.err and "support" not in done.err:
        complaints.append("message: names no body, contact or support")
    at_rest = re.search(r"applied \((-?(0|[\d.]+e-(09|[1-9]\d))(, )?)+\)", done.out) is not None
    if directory is not None:
        if done.status == 0:
            balance = re.search(r"difference (\S+) of the largest force", done.out)
            moved = re.search(r"largest displacement (\S+),", done.out)
            # Bodies of about 1 that are moved by more than 1e5 keep fewer digits.
            limit = 1e-6 if moved is None or float(moved[1]) < 1e5 else BALANCE_FAR_AWAY
            if balance and not at_rest and not float(balance[1]) <= limit:
                complaints.append(f"balance of forces: {balance[1]}")
        if directory.exists():
            complaints += judge_files(directory, done.status, at_rest)
        elif done.status in (0, 2):
            complaints.append("no results")
    elif done.status == 2:
        complaints.append(f"exit status {done.status} of --check")
    return complaints
