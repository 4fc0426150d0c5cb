#!/usr/bin/env python3
"""Throws mutated decks and meshes at the program and judges what it does (oracle.py).

    fuzz.py MORTISE --what decks --count 1000 --seed 1 --jobs 2 --finds DIRECTORY
    fuzz.py MORTISE --what meshes --count 1000 --seed 1

Case i of a seed is the same whatever the count and the jobs. A find is shortened line by line and written to a folder of its own with
`run.sh`, which shows it again. Finds that look alike are kept three times. Exit status 1 if there was any.
"""
import argparse
import collections
import hashlib
import json
import multiprocessing
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import decks
import meshes
import oracle

SOLVED = 0.25  # part of the cases that are solved, the others are but checked
SHORTENING = 40  # runs at most to make a find shorter
CONTEXT = None  # of a worker


def case_of(arguments, seeds, schema, number):
    """The files of a case, {name: bytes}, the first the deck; what stands for them if nothing was changed; whether it is to be solved."""
    source = random.Random(f"{arguments.seed} {arguments.what} {number}")
    solve = source.random() < (SOLVED if arguments.what == "decks" else SOLVED / 2)
    if arguments.what == "decks":
        text, untouched = decks.mutant(source, schema)
        return {"deck.yaml": text.encode("utf-8", errors="surrogateescape" if "\udc80" <= max(text, default="") <= "\udcff" else "surrogatepass")}, untouched, solve
    name, data, ending, deck, untouched = meshes.mutant(source, seeds)
    return {"deck.yaml": deck.replace("FILE", "mesh" + ending).encode(), "mesh" + ending: data}, untouched, solve


def attempt(mortise, files, solve, directory):
    """Complaints about one case."""
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    for name, data in files.items():
        (directory / name).write_bytes(data)
    results = directory / "results"
    done = oracle.run(mortise, directory / "deck.yaml", ["--output", str(results)] if solve else ["--check"])
    return done, oracle.judge(done, [f"{directory}/{name}" for name in files] + list(files), results if solve else None)


def signature(complaints):
    return re.sub(r"[\d.]+(e[-+]\d+)?", "#", complaints[0])


def shorten(mortise, files, solve, directory, complaints):
    """The same complaint from fewer lines, as far as a few runs go."""
    wanted, left = signature(complaints), SHORTENING
    if wanted.startswith("hang"):
        return files
    for name in files:
        lines, size = files[name].split(b"\n"), max(1, files[name].count(b"\n") // 2)
        while size >= 1 and left > 0:
            at = 0
            while at < len(lines) and left > 0:
                fewer = lines[:at] + lines[at + size:]
                left -= 1
                _, found = attempt(mortise, {**files, name: b"\n".join(fewer)}, solve, directory)
                if found and signature(found) == wanted:
                    lines = fewer
                else:
                    at += size
            size //= 2
        files = {**files, name: b"\n".join(lines)}
    return files


def keep(finds, mortise, files, solve, done, complaints, number, seed):
    """Writes a find to a folder of its own."""
    mark = hashlib.sha1(signature(complaints).encode()).hexdigest()[:8]
    earlier = list(finds.glob(f"{mark}_*")) if finds.exists() else []
    if len(earlier) >= 3:
        return
    folder = finds / f"{mark}_{seed}_{number}"
    folder.mkdir(parents=True, exist_ok=True)
    for name, data in files.items():
        (folder / name).write_bytes(data)
    options = "--output results" if solve else "--check"
    (folder / "run.sh").write_text(f'cd "$(dirname "$0")" && ${{MORTISE:-{mortise}}} deck.yaml {options}\n')
    (folder / "found.txt").write_text("\n".join(complaints) + f"\n\nexit status {done.status}\n--- stdout\n{done.out[-3000:]}\n--- stderr\n{done.err[-3000:]}\n")


def start(arguments, seeds, schema):
    global CONTEXT
    CONTEXT = arguments, seeds, schema, pathlib.Path(tempfile.mkdtemp(prefix="mortise_fuzz_"))


def work(number):
    arguments, seeds, schema, scratch = CONTEXT
    files, untouched, solve = case_of(arguments, seeds, schema, number)
    directory = scratch / "case"
    done, complaints = attempt(arguments.mortise, files, solve, directory)
    if untouched and arguments.what == "meshes" and done.status != 0:
        complaints.append(f"a valid mesh is refused: exit status {done.status}")
    if untouched and arguments.what == "decks" and solve and done.status == 0 and not complaints and (applied := decks.applied(untouched)):
        complaints += oracle.unbalanced(applied, directory / "results")
    if complaints:
        if complaints[0].startswith(("supports carry", "a valid mesh")):
            keep(arguments.finds, arguments.mortise, files, solve, done, complaints, number, arguments.seed)
            return number, done.status, bool(untouched), solve, complaints
        _, complaints_again = attempt(arguments.mortise, files, solve, directory)  # what a full machine caused is no find
        if complaints_again:
            short = shorten(arguments.mortise, files, solve, directory, complaints_again)
            done, complaints = attempt(arguments.mortise, short, solve, directory)
            keep(arguments.finds, arguments.mortise, short, solve, done, complaints or complaints_again, number, arguments.seed)
            complaints = complaints or complaints_again
        else:
            complaints = []
    shutil.rmtree(directory, ignore_errors=True)
    return number, done.status, bool(untouched), solve, complaints


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise", type=pathlib.Path)
    parser.add_argument("--what", choices=["decks", "meshes"], default="decks")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--finds", type=pathlib.Path, default=pathlib.Path("fuzz_finds"))
    parser.add_argument("--least-solved", type=int, default=0, help="valid cases that must be solved with exit status 0: a fuzzer of refusals alone shows nothing")
    arguments = parser.parse_args()
    arguments.mortise, arguments.finds = arguments.mortise.resolve(), arguments.finds.resolve()

    schema = json.loads(subprocess.run([arguments.mortise, "--schema"], capture_output=True, check=True).stdout)
    seeds = {}
    if arguments.what == "meshes":
        with tempfile.TemporaryDirectory() as scratch:
            seeds = meshes.seeds(scratch)
    statuses, kinds, solved, begin = collections.Counter(), collections.Counter(), 0, time.time()
    try:
        with multiprocessing.get_context("fork").Pool(arguments.jobs, start, (arguments, seeds, schema)) as pool:
            for number, status, untouched, solve, complaints in pool.imap_unordered(work, range(arguments.first, arguments.first + arguments.count)):
                statuses["changed " * (not untouched) + ("solve " if solve else "check ") + str(status)] += 1
                solved += untouched and solve and status == 0
                if complaints:
                    kinds[signature(complaints)] += 1
                    print(f"case {number}: " + "; ".join(complaints), flush=True)
                if (done := sum(statuses.values())) % 500 == 0:
                    print(f"{done} cases, {time.time() - begin:.0f} s", flush=True)
    except KeyboardInterrupt:
        pass  # what there is so far
    print(f"{sum(statuses.values())} {arguments.what}, seed {arguments.seed}, {time.time() - begin:.0f} s: {sum(kinds.values())} finds")
    for name, count in sorted(statuses.items()):
        print(f"  {name}: {count}")
    for kind, count in kinds.most_common():
        print(f"  {count} x {kind}")
    if solved < arguments.least_solved:
        print(f"only {solved} valid cases were solved, expected at least {arguments.least_solved}")
    return 1 if kinds or solved < arguments.least_solved else 0


if __name__ == "__main__":
    sys.exit(main())
