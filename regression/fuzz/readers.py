#!/usr/bin/env python3
"""Runs libFuzzer on the readers of this project (decks, formulas, Abaqus files, what is looked at in .msh and .geo files), one after another.

    cmake --preset fuzz && ninja -C build/fuzz fuzz_readers
    readers.py build/fuzz/regression/fuzz [--seconds 60] [--only deck] [--corpus DIR] [--finds DIR]

It begins with the decks of inputs/ and regression/, and with the meshes of meshes.py. A crash, a report of a sanitizer, an exception that is no Error, an
input that takes more than 20 s or 3 GB is a find: its file is kept in --finds, and the exit status is 1. --corpus keeps what was found worth trying.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import meshes

ROOT = pathlib.Path(__file__).resolve().parents[2]
READERS = ["deck", "formula", "abaqus", "msh"]
LONGEST = 8000  # bytes


def decks():
    for folder in ("inputs", "regression"):
        yield from (file.read_bytes() for file in sorted((ROOT / folder).rglob("*.yaml")))


def words_of_schema():
    """All keys and choices of decks."""
    return sorted(set(re.findall(r'"([a-z_]+)"', (ROOT / "docs/schema.json").read_text())))


def seeds(reader, of_meshes):
    if reader == "deck":
        return list(decks())
    if reader == "formula":
        return sorted({text.encode() for deck in decks() for text in re.findall(r'"([^"]*[-+*/(][^"]*)"', deck.decode())})
    endings = {"abaqus": [".inp"], "msh": [".msh", ".geo"]}[reader]
    return [data for data, ending, _ in of_meshes.values() if ending in endings]


def words(reader):
    """libFuzzer's dictionary."""
    known = {
        "deck": words_of_schema(),
        "formula": ["sin(", "cos(", "sqrt(", "exp(", "atan2(", "abs(", "min(", "max(", "sign(", "rint(", "theta", "_pi", "?", ":", "&&", "<=", "1e300", ","],
        "abaqus": ["*NODE", "*ELEMENT", "*NSET", "*ELSET", "*SURFACE", "*SOLID SECTION", "*STEP", "*HEADING", ", TYPE=C3D8", ", TYPE=C3D20R", ", TYPE=C3D10",
                   ", TYPE=CPS4", ", TYPE=CPE8", ", ELSET=", ", NSET=", ", GENERATE", ", NAME=", ", MATERIAL=", "S1", "S6"],
        "msh": ["$MeshFormat", "$EndMeshFormat", "2.2 0 8", "4.1 1 8", "$Elements", "$EndElements", "$Nodes", "$PhysicalNames", "Macro", "Return", "Call", "If (",
                "EndIf", "DefineConstant[", "DefineNumber", "size = 1;"],
    }[reader]
    return "".join(f'"{word}"\n' for word in known)


def run(program, reader, of_meshes, arguments, scratch):
    """Whether libFuzzer found nothing."""
    corpus = (arguments.corpus or scratch) / reader
    first = scratch / f"{reader}_first"
    for folder in (corpus, first, arguments.finds):
        folder.mkdir(parents=True, exist_ok=True)
    for number, data in enumerate(seeds(reader, of_meshes)):
        if len(data) <= LONGEST:
            (first / str(number)).write_bytes(data)
    dictionary = scratch / f"{reader}.words"
    dictionary.write_text(words(reader))
    environment = dict(os.environ, ASAN_OPTIONS="detect_leaks=0:alloc_dealloc_mismatch=0", TMPDIR=str(scratch))
    done = subprocess.run([program, corpus, first, f"-max_total_time={arguments.seconds}", "-timeout=20", "-rss_limit_mb=3000", f"-max_len={LONGEST}", f"-dict={dictionary}",
                           f"-artifact_prefix={arguments.finds}/{reader}_", "-print_final_stats=1", "-verbosity=0"], capture_output=True, env=environment, check=False)
    text = done.stderr.decode(errors="replace")
    runs = re.search(r"number_of_executed_units:\s*(\d+)", text)
    print(f"{reader}: {runs[1] if runs else '?'} inputs, {len(list(corpus.iterdir()))} of them kept, {'none is a find' if done.returncode == 0 else 'a find'}", flush=True)
    if done.returncode != 0:
        print(text[-4000:])
    return done.returncode == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, help="folder of fuzz_deck and the others")
    parser.add_argument("--seconds", type=int, default=60, help="of each reader")
    parser.add_argument("--only", choices=READERS)
    parser.add_argument("--corpus", type=pathlib.Path)
    parser.add_argument("--finds", type=pathlib.Path, default=pathlib.Path("finds"))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        (scratch / "meshes").mkdir()
        of_meshes = meshes.seeds(scratch / "meshes")
        chosen = [arguments.only] if arguments.only else READERS
        good = [run(arguments.programs / f"fuzz_{reader}", reader, of_meshes, arguments, scratch) for reader in chosen]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
