#!/usr/bin/env python3
"""The process that gmsh works in: it ends with its run however that ends, and needs no temporary file.

    mesher.py MORTISE [--mpiexec MPIEXEC]
"""
import argparse
import concurrent.futures
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

DECK = """mesh: {file: box.geo, constants: {size: %g}}
materials: {m: {young_modulus: 1, poisson_ratio: 0.3}}
bodies: {a: {material: m}}
supports:
  - {boundary: bottom, displacement: {x: 0, y: 0, z: 0}}
"""
GEOMETRY = """SetFactory("OpenCASCADE");
DefineConstant[ size = 1 ];
Box(1) = {0, 0, 0, 1, 1, 1};
Physical Volume("a") = {1};
Physical Surface("bottom") = {5};
Mesh.MeshSizeMax = size;
"""
SLOW, FAST = 0.008, 0.5  # minutes, and a moment


def processes(directory):
    """Processes at work on the deck in this directory: number -> (parent, command)."""
    found = {}
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0")
            status = (entry / "stat").read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        if status[0] != "Z" and any(str(directory).encode() in word for word in words):
            found[int(entry.name)] = (int(status[1]), words[0].decode())
    return found


def wait_for(condition, seconds):
    end = time.time() + seconds
    while time.time() < end:
        if condition():
            return True
        time.sleep(0.1)
    return False


def runs_and_meshers(directory):
    """Processes of the program that are no child of another one, and those that are."""
    programs = {p: parent for p, (parent, command) in processes(directory).items() if command.endswith("mortise")}
    return [p for p, parent in programs.items() if parent not in programs], [p for p, parent in programs.items() if parent in programs]


def run(arguments, directory, ranks, size, **keywords):
    (directory / "box.geo").write_text(GEOMETRY)
    (directory / "deck.yaml").write_text(DECK % size)
    command = [arguments.mortise, str(directory / "deck.yaml"), "--check"]
    if ranks > 1:
        command = [arguments.mpiexec, "--oversubscribe", "-n", str(ranks)] + command
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                       OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", **keywords)
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment, text=True)


def ends_with_its_run(arguments, directory, ranks, number):
    process = run(arguments, directory, ranks, SLOW)
    try:
        if not wait_for(lambda: runs_and_meshers(directory)[1], 60):
            return "gmsh does not work in a process of its own"
        parents, children = runs_and_meshers(directory)
        parent = processes(directory)[children[0]][0]
        os.kill(parent, number)
        process.wait(60)
        if not wait_for(lambda: not processes(directory), 20):
            return f"left at work: {processes(directory)}"
        return None if parent in parents else "the process of gmsh is not that of a rank"
    finally:
        for left in processes(directory):
            os.kill(left, signal.SIGKILL)
        process.stdout.close()


def needs_no_temporary_file(arguments, directory):
    aside = directory / "tmp"
    aside.mkdir()
    process = run(arguments, directory, 1, FAST, TMPDIR=str(aside), OMPI_MCA_orte_tmpdir_base=str(directory))
    text = process.communicate(timeout=60)[0]
    left = [p.name for p in aside.iterdir()]
    return text if process.returncode != 0 else f"left behind: {left}" if left else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--mpiexec", default="mpirun")
    arguments = parser.parse_args()
    checks = [(f"{ranks} ranks, {number.name}", lambda d, r=ranks, n=number: ends_with_its_run(arguments, d, r, n))
              for ranks in (1, 2) for number in (signal.SIGTERM, signal.SIGKILL)]
    checks.append(("no temporary file", lambda d: needs_no_temporary_file(arguments, d)))

    def judge(check):
        with tempfile.TemporaryDirectory(prefix="mortise_mesher_") as scratch:
            return check(pathlib.Path(scratch))

    # Much of each is waiting, so they run beside each other.
    with concurrent.futures.ThreadPoolExecutor(len(checks)) as pool:
        complaints = list(pool.map(judge, [check for _, check in checks]))
    for (name, _), complaint in zip(checks, complaints):
        print(f"{name}: {complaint or 'right'}")
    return 1 if any(complaints) else 0


if __name__ == "__main__":
    sys.exit(main())
