#!/usr/bin/env python3
"""Faults of the machine: what a run does when the disk is full, memory is short, somebody ends it, or the directory is in use.

    faults.py MORTISE CASE [--mpiexec MPIEXEC] [--full-disk LIBRARY] [--times N] [--seed N] [--short] [--write]

CASE is the name of one of the functions below or in directories.py; each says what it expects. Common to all: a run ends within LIMIT seconds on all ranks, with
an exit status from 0 to 4 and a cause, and what it leaves under a final name is whole. --short leaves out of `interrupted`, `interrupted_direct`
and `resumed` what differs from another of their runs by the number of ranks alone. --write puts what `kills` gave into README.md.
"""
import argparse
import collections
import contextlib
import os
import pathlib
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time

import h5py

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import page_tables
from directories import disk_full, unwritable, stale, own_files, two_runs
from runs import HERE, SHORT, SLOW, PLATES, LIMIT, MACHINE, INTERRUPTED, failures, expect, Run, judge_files, summary, identity, claims_success, judge_failure


def interrupted(options, scratch):
    """Told to end: exit status 130, the states before are there and marked. Killed: what is on the disk says that it is not finished."""
    more = [] if options.short else [(1, signal.SIGTERM), (2, signal.SIGTERM)]
    for ranks, number in [(1, signal.SIGINT), (1, signal.SIGKILL), (3, signal.SIGTERM)] + more:
        who = f"{number.name} on {ranks} ranks"
        run = Run(options, SLOW, scratch / who, ranks, prepare=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        expect(run.has("results.2.h5"), f"{who}: too late for the test")
        while run.process.poll() is None and len((summary(run.directory) or {}).get("steps", [])) < 2:
            time.sleep(0.002)
        os.kill(run.rank_pids()[-1], number)
        status = run.wait()
        expect(status == (-signal.SIGKILL if number == signal.SIGKILL else INTERRUPTED), f"{who}: exit status {status}\n{run.said}")
        found = summary(run.directory)
        expect(found["converged"] is False and found["exit_status"] == (None if number == signal.SIGKILL else INTERRUPTED),
               f"{who}: {found['converged']}, {found['exit_status']}")
        expect(2 <= len(found["steps"]) < 6 and all(step["converged"] for step in found["steps"]), f"{who}: {len(found['steps'])} steps")
        if number != signal.SIGKILL:
            expect(number.name in run.said, f"{who}: {run.said}")
        judge_files(run.directory, who)
    # Before anything is solved, in a stage that does not look: it ends soon all the same.
    run = Run(options, SLOW, scratch / "early", arguments=["--set", "mesh.blocks.lower.cells=[40, 40, 40]"])
    expect(run.has("mortise.lock"), "early: no lock")
    os.kill(run.process.pid, signal.SIGTERM)
    start = time.monotonic()
    expect(run.wait() == INTERRUPTED and time.monotonic() - start < 60 and summary(run.directory) is None, f"early: {run.said}")
    # While gmsh meshes, in a process of its own: a terminal tells both, a batch system the run alone.
    fine = 'SetFactory("OpenCASCADE");\nSphere(1) = {0, 0, 0, 1};\nPhysical Volume("ball") = {1};\nMesh.MeshSizeMax = 0.02;\n'
    (scratch / "fine.geo").write_text(fine)
    (scratch / "fine.yaml").write_text("mesh: {file: fine.geo}\nmaterials: {m: {young_modulus: 1, poisson_ratio: 0}}\nbodies: {ball: {material: m}}\n")
    for number, tell in ((signal.SIGUSR1, os.killpg), (signal.SIGTERM, os.kill)):
        run = Run(options, scratch / "fine.yaml", scratch / f"meshing {number.name}", prepare=os.setsid)
        expect(run.has("mortise.lock"), f"meshing {number.name}: no lock")
        time.sleep(0.5)
        start = time.monotonic()
        tell(run.process.pid, number)
        expect(run.wait() == INTERRUPTED and time.monotonic() - start < 8 and number.name in run.said, f"meshing {number.name}: {run.said}")
        expect(not (run.directory / "mortise.lock").exists(), f"meshing {number.name}: the lock stays")


def resumed(options, scratch):
    """Ended between two states, by a signal or by SIGKILL, and resumed: what an uninterrupted run gives, friction's memory included."""
    exact = ["--set", "solver.tolerance=1e-10", "--set", "friction_loop.tolerance=1e-10"]
    one_rank = [] if options.short else [(1, signal.SIGTERM, [])]
    for ranks, number, more in one_rank + [(2, signal.SIGTERM, []), (1, signal.SIGKILL, ["--set", "solver.algorithm=direct"])]:
        who = f"{number.name} on {ranks} ranks"
        whole = Run(options, SLOW, scratch / f"whole {who}", ranks, exact + more)
        expect(whole.wait() == 0, f"{who}: {whole.said}")
        out = scratch / f"ended {who}"
        ended = Run(options, SLOW, out, ranks, exact + more)
        expect(ended.has("restart.2.h5"), f"{who}: too late for the test")
        os.kill(ended.rank_pids()[-1], number)
        ended.wait()
        done = len(summary(out)["steps"])
        expect(1 <= done < 6 and not claims_success(out), f"{who}: {done} steps")
        run = Run(options, SLOW, out, ranks, exact + more + ["--resume"])
        expect(run.wait() == 0, f"{who}, resumed: {run.said}")
        found, expected = summary(out), summary(whole.directory)
        expect(len(found["steps"]) == 6, f"{who}: {len(found['steps'])} steps")
        for a, b in zip(found["steps"], expected["steps"]):
            close = abs(a["strain_energy"] - b["strain_energy"]) <= 1e-8 * b["strain_energy"]
            close = close and all(abs(x - y) <= 1e-8 * abs(b["contacts"][0]["force"][2])
                                  for x, y in zip(a["contacts"][0]["force"], b["contacts"][0]["force"]))
            states = [[step["contacts"][0][key] for key in ("open", "stick", "slip")] for step in (a, b)]
            expect(close and states[0] == states[1], f"{who}, time {b['time']}: {a['strain_energy']!r} for {b['strain_energy']!r}, {states}")
        files = [sorted(path.name for path in place.iterdir() if "old" not in path.name) for place in (out, whole.directory)]
        expect(files[0] == files[1], f"{who}: files {files}")
        rows = [(place / "history.csv").read_text().splitlines() for place in (out, whole.directory)]
        times = [{line.split(",")[11] for line in lines[1:]} for lines in rows]
        expect(times[0] == times[1], f"{who}: history.csv has the times {times}")
        judge_files(out, who)
    run = Run(options, SLOW, out, arguments=exact + more + ["--resume"])
    expect(run.wait() == 1 and "nothing to go on from" in run.said, f"after the end: {run.said}")
    ended = Run(options, SLOW, scratch / "other", 1, exact)
    expect(ended.has("restart.1.h5"), "other: too late for the test")
    os.kill(ended.process.pid, signal.SIGTERM)
    ended.wait()
    for ranks, words, why in ((1, ["--set", "solver.tolerance=1e-9"], "another deck"), (2, exact, "had 1 ranks, not 2")):
        run = Run(options, SLOW, scratch / "other", ranks, words + ["--resume"])
        expect(run.wait() == 1 and why in run.said, f"{why}: {run.said}")
    with h5py.File(scratch / "other" / "restart.1.h5", "r+") as file:  # as earlier versions left it: without the number of the format
        numbers = file["restart/run"][1:]
        del file["restart/run"]
        file["restart/run"] = numbers
    run = Run(options, SLOW, scratch / "other", 1, exact + ["--resume"])
    expect(run.wait() == 1 and "in another format" in run.said, f"another format: {run.said}")
    heated = scratch / "heated.yaml"
    heated.write_text(SLOW.read_text().replace("loads:\n", "loads:\n  - {body: upper, temperature_change: {file: heat.csv, field: T}}\n")
                      .replace("poisson_ratio: 0.3", "poisson_ratio: 0.3, thermal_expansion: 1e-5"))
    heat = lambda by: (scratch / "heat.csv").write_text("x,y,z,T\n" + "".join(
        f"{x},{y},{z},{by * (10 + z)}\n" for x in (0, 0.5, 1) for y in (0, 0.5, 1) for z in (1, 1.5, 2)))
    heat(1)
    ended = Run(options, heated, scratch / "hot", 1, exact)
    expect(ended.has("restart.2.h5"), "hot: too late for the test")
    os.kill(ended.process.pid, signal.SIGTERM)
    ended.wait()
    for by, status, why in ((1.001, 1, "was changed since"), (1, 0, "Solved.")):
        heat(by)
        run = Run(options, heated, scratch / "hot", 1, exact + ["--resume"])
        expect(run.wait() == status and why in run.said, f"{why}: {run.said}")


def interrupted_direct(options, scratch):
    """Told to end within the dense algebra of a direct solution, which takes half a minute: heard between two pieces of it."""
    cells = ["mesh.blocks.lower.cells=[46, 46, 1]", "mesh.blocks.upper.cells=[45, 45, 1]", "solver.algorithm=direct"]
    for ranks in (2,) if options.short else (1, 2):
        words = scratch / f"words {ranks}"
        with open(words, "wb") as sink:
            run = Run(options, PLATES, scratch / "out", ranks, [word for cell in cells for word in ("--set", cell)], stdout=sink)
            end = time.monotonic() + LIMIT
            while b"dual problem:" not in words.read_bytes() and time.monotonic() < end and run.process.poll() is None:
                time.sleep(0.01)
            time.sleep(2)
            expect(run.process.poll() is None, f"{ranks} ranks: too late for the test: {words.read_text()}")
            os.kill(min(run.rank_pids()), signal.SIGTERM)  # rank 0, which has the matrices
            start = time.monotonic()
            status = run.wait()
        taken = time.monotonic() - start
        print(f"{ranks} ranks: heard after {taken:.1f} s", flush=True)
        expect(status == INTERRUPTED and "told to end (SIGTERM)" in run.said, f"{ranks} ranks, after {taken:.1f} s: exit status {status}\n{run.said}")
        found = summary(scratch / "out")
        expect(found and found["interrupted"] and found["exit_status"] == INTERRUPTED and not found["converged"], f"{ranks} ranks: {found}")
        expect(not (scratch / "out/mortise.lock").exists(), f"{ranks} ranks: leaves a lock")


def no_room_for_direct(options, scratch):
    """A direct solution that `auto` tries and has no room for, on whichever rank: back to products, on all ranks."""
    expected = None
    for ranks, victim in ((1, None), (2, 1)):
        who = f"{ranks} ranks" if victim is None else f"short of memory on rank {victim} of {ranks}"
        environment = {} if victim is None else {"LD_PRELOAD": options.short_memory, "SHORT_MEMORY": "4000000", "SHORT_MEMORY_RANK": str(victim)}
        run = Run(options, PLATES, scratch / who, ranks, environment=environment)
        status, found = run.wait(), summary(scratch / who)
        expect(status == 0 and found is not None, f"{who}: exit status {status}\n{run.said}")
        if status != 0:
            continue
        expect(found["algorithm"] == ("direct" if victim is None else "face_newton"), f"{who}: {found['algorithm']}\n{run.said}")
        expect(("finds no room in memory: back to products" in run.said) == (victim is not None), f"{who}: does not say it\n{run.said}")
        expected = expected or found["strain_energy"]
        expect(abs(found["strain_energy"] - expected) < 1e-2 * expected, f"{who}: energy {found['strain_energy']}, expected {expected}")
        judge_files(scratch / who, who)
    environment["SHORT_MEMORY_RANK"] = "0"
    run = Run(options, PLATES, scratch / "asked for", 2, ["--set", "solver.algorithm=direct"], environment=environment)
    judge_failure(run, run.wait(), "asked for", "memory")


def kills(options, scratch):
    """A rank is killed or signalled at a random time, on 2 and 3 ranks: the others end, and nothing half is under a final name."""
    choose = random.Random(options.seed)
    start = time.monotonic()
    Run(options, SLOW, scratch / "whole", 2).wait()
    length = time.monotonic() - start
    statuses = collections.Counter()
    for i in range(options.times):
        for ranks in (2, 3):
            number = choose.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGSEGV, signal.SIGINT, signal.SIGABRT])
            delay, who = choose.uniform(0, 1.2 * length), f"seed {options.seed}, time {i}: {number.name} on {ranks} ranks"
            before = identity(scratch / "out" / "summary.json")
            run = Run(options, SLOW, scratch / "out", ranks, prepare=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
            time.sleep(delay)
            victims = run.rank_pids()
            if victims:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(choose.choice(victims), number)
            status = run.wait()
            print(f"{who} after {delay:.2f} s: exit status {status}", flush=True)
            statuses[ranks, number.name if victims else "none", status] += 1
            expect(status is not None, f"{who} after {delay:.2f} s: hangs")
            if before and identity(run.directory / "summary.json") == before:  # of the run before: this one had not begun
                expect(status != 0 and "Mortise" not in run.said, f"{who} after {delay:.2f} s: leaves an earlier summary.json\n{run.said}")
            elif status == 0 or not claims_success(run.directory):
                expect(status != 0 or claims_success(run.directory), f"{who} after {delay:.2f} s: exit status 0, summary.json says else")
            else:  # killed when all was written, on its way out
                expect(len(summary(run.directory)["steps"]) == 6, f"{who} after {delay:.2f} s: exit status {status}, summary.json claims success")
            if run.directory.exists():
                judge_files(run.directory, who)
    if options.write:
        hung = sum(count for (_, _, status), count in statuses.items() if status is None)
        ended = {name: sorted({str(status) for (_, other, status) in statuses if other == name}) for name in sorted({key[1] for key in statuses})}
        told = "; ".join(f"{sum(n for key, n in statuses.items() if key[1] == name)} {name}: {', '.join(ended[name])}" for name in ended)
        page_tables.write(HERE / "README.md", "kills", ["seed", "runs", "signals, and exit statuses of `mpirun`", "hang", "failures"],
                          [[options.seed, sum(statuses.values()), told, hung, len(failures)]])


def memory(options, scratch):
    """Whatever the address space: solved, or exit status 4 with a word; never a signal, never for ever."""
    statuses = []
    for megabytes in (150, 200, 240, 255, 270, 300, 350, 380, 400, 420, 440, 470, 1500):
        size = megabytes * 1000 * 1000
        run = Run(options, SHORT, scratch / "out", prepare=lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size)))
        status = run.wait()
        statuses.append(status)
        expect(status in (0, MACHINE), f"{megabytes} MB: exit status {status}\n{run.said}")
        expect(status == 0 or "memory" in run.said, f"{megabytes} MB: no cause:\n{run.said}")
        expect((status == 0) == claims_success(scratch / "out"), f"{megabytes} MB: exit status {status}, summary.json says else")
    expect(statuses[0] == MACHINE and statuses[-1] == 0, f"too much or too little to try: {statuses}")
    size = 520 * 1000 * 1000  # MPI itself takes some 400
    run = Run(options, SHORT, scratch / "out", 2, ["--set", "mesh.blocks.lower.cells=[30, 30, 30]"],
              prepare=lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size)))
    status = run.wait()
    expect(status == MACHINE and "memory" in run.said, f"2 ranks: exit status {status}\n{run.said}")


def output_closed(options, scratch):
    """Nobody who reads: the run goes on, and what it prints lands in no file of its own. What was only to be printed is an error."""
    expected = None
    for how in ("open", "closed", "full", "broken"):
        reader, writer = os.pipe()
        os.close(reader)
        full = os.open("/dev/full", os.O_WRONLY)
        prepare = {"closed": lambda: [os.close(number) for number in (0, 1, 2)]}.get(how)
        run = Run(options, SHORT, scratch / how, stdout={"full": full, "broken": writer}.get(how), prepare=prepare)
        status = run.wait()
        expect(status == 0 and claims_success(scratch / how), f"output {how}: exit status {status}\n{run.said}")
        judge_files(scratch / how, f"output {how}")
        numbers = (scratch / how / "results.h5").read_bytes()
        expect(numbers == (expected or numbers), f"output {how}: results.h5 differs")
        expected = expected or numbers
        for words in (["--check", str(SHORT)], ["--schema"]):
            done = subprocess.run([options.mortise, *words], stdout={"full": full}.get(how, subprocess.DEVNULL), stderr=subprocess.PIPE, timeout=LIMIT)
            expect(done.returncode == (MACHINE if how == "full" else 0), f"{words[0]}, output {how}: exit status {done.returncode}")
        os.close(full), os.close(writer)


def few_subdomains(options, scratch):
    """More ranks than subdomains: the same result."""
    energies = []
    for ranks in (1, 3):
        run = Run(options, SHORT, scratch / "out", ranks, ["--set", "decomposition.subdomains=2", "--set", "decomposition.method=metis"])
        expect(run.wait() == 0, f"{ranks} ranks: {run.said}")
        energies.append(summary(scratch / "out")["strain_energy"])
    expect(abs(energies[0] - energies[1]) < 1e-6 * energies[0], f"energies {energies}")


CASES = {case.__name__: case for case in (disk_full, unwritable, interrupted, resumed, interrupted_direct, no_room_for_direct, kills, stale, own_files, two_runs, memory, output_closed, few_subdomains)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("case", choices=CASES)
    parser.add_argument("--mpiexec", default="mpirun")
    parser.add_argument("--full-disk", default="", help="the library of full_disk.c")
    parser.add_argument("--short-memory", default="", help="the library of short_memory.c")
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with tempfile.TemporaryDirectory() as scratch:
        CASES[options.case](options, pathlib.Path(scratch))
    print(f"{options.case}: {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
