#!/usr/bin/python3
"""Imports input files of Abaqus or CalculiX, solves them with Mortise and with CalculiX, and prints how far the displacements agree.

    abaqus_decks.py MORTISE FILE.inp ... [--points 400] [--timeout 120] [--quiet] [--write]

CalculiX solves a file without NLGEOM, so that both solve the linear problem, and once more with 10 times the penalty of its contacts and full
integration of cells of second order. Displacements are compared at nodes at the end of the last static step: the largest difference over the
largest displacement; FILE.dat.ref as well where it is there (calculix-ccx-test has them packed). The last column is the difference of the
largest contact force, with the stiffer penalty. What the import leaves out is printed below the table; --write puts the rows of files that both
solve into abaqus_decks.md. Needs calculix-ccx, python3-yaml, python3-numpy.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "regression" / "comparison" / "abaqus_decks.md"
sys.path[:0] = [str(ROOT / "inputs" / "import"), str(ROOT / "regression")]
import import_deck  # noqa: E402
import page_tables  # noqa: E402

HEAD = ["deck", "nodes", "left out", "largest displacement", "stored", "apart", "penalty x 10, full integration", "force of contact"]


def stiffer(text, factor):
    """Linear penalties times `factor`, and full integration of cells of second order."""

    def more(match):
        return f"{match[1]}{float(match[2].lower().replace('d', 'e')) * factor:.6g}"

    text = re.sub(r"(?im)^(\s*\*\s*surface\s*behavior.*=\s*(?:linear|tied).*\n\s*)([\d.eEdD+-]+)", more, text)
    text = re.sub(r"(?im)^(\s*\*\s*friction.*\n[^,\n]*,\s*)([\d.eEdD+-]+)", more, text)
    return re.sub(r"(?i)\b(C3D20|(?:CPS|CPE|CAX)8)R\b", r"\1", text)


STEP = re.compile(r"(?ims)^\s*\*\s*step\b.*?^\s*\*\s*end\s*step[^\n]*\n?")


def is_static(step):
    """Whether the import solves a step."""
    return bool(re.search(r"(?im)^\s*\*\s*static", step)) and not re.search(r"(?i)^[^\n]*perturbation", step.lstrip())


def calculix_input(path, target, factor):
    """The file without NLGEOM and steps that are not static; every step prints the displacements of all nodes."""
    text = STEP.sub(lambda step: step[0] if is_static(step[0]) else "", path.read_text(errors="replace"))
    text = re.sub(r"(?im)^(\s*\*\s*step.*?),\s*nlgeom(\s*=\s*\w+)?", r"\1", text)
    text = re.sub(r"(?im)^(\s*\*\s*step.*?),\s*nlgeom(\s*=\s*\w+)?", r"\1", text)
    text = stiffer(text, factor) if factor != 1 else text
    numbers, inside = [], False
    for line in text.splitlines():
        if line.startswith("**"):
            continue
        if line.lstrip().startswith("*"):
            inside = re.match(r"\s*\*\s*node\s*(,|$)", line, re.IGNORECASE) is not None
        elif inside and line.strip():
            numbers.append(line.split(",")[0].strip())
    every = "*NSET,NSET=ALLOFTHEM\n" + "".join(f"{n},\n" for n in numbers)
    at = re.search(r"(?im)^\s*\*\s*step", text)
    text = text[: at.start()] + every + text[at.start() :]
    wanted = "*NODE PRINT,NSET=ALLOFTHEM,FREQUENCY=100000,GLOBAL=YES\nU\n"
    for pair in re.finditer(r"(?im)^\s*\*\s*contact\s*pair.*surface\s*to\s*surface.*\n\s*([^,\s]+)\s*,\s*([^,\s]+)", text):
        wanted += f"*CONTACT PRINT,SLAVE={pair[1]},MASTER={pair[2]},FREQUENCY=100000\nCF\n"
    text = re.sub(r"(?im)^\s*\*\s*end\s*step", wanted + "*END STEP", text)
    target.write_text(text)
    return dict.fromkeys(int(n) for n in numbers)


def contact_forces(path):
    """The last force of each contact in a .dat file: lengths of vectors, by the names of the surfaces in capitals."""
    found, pair, expected = {}, None, False
    for line in path.read_text().splitlines():
        if match := re.search(r"slave set (\S+?), *master set (\S+?) and time", line):
            pair = (match[1].upper(), match[2].upper())
        elif "total surface force" in line:
            expected = True
        elif expected and pair and len(line.split()) >= 3:
            found[pair] = float(np.linalg.norm([number(w) for w in line.split()[:3]]))
            expected = False
    return found


def number(word):
    """Of Fortran, which leaves the E out where an exponent has three digits."""
    return float(re.sub(r"(?<=\d)([+-]\d{3})$", r"e\1", word))


def last_displacements(path, of="ALLOFTHEM"):
    """Node -> displacement, of the last block of displacements of a set in a .dat file; of="": any set."""
    blocks, current = [], None
    for line in path.read_text().splitlines():
        if line.strip().startswith("displacements"):
            current = {} if of in line else None
            if current is not None:
                blocks.append(current)
        elif current is not None:
            words = line.split()
            if len(words) == 4:
                current[int(words[0])] = [number(w) for w in words[1:]]
            elif words:
                current = None
    return blocks[-1] if blocks else {}


def run(command, directory, timeout):
    environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1")
    try:
        return subprocess.run(command, cwd=directory, timeout=timeout, capture_output=True, text=True, env=environment, check=False)
    except subprocess.TimeoutExpired:
        return None


def probes(result, most):
    """(node's number, index, body) of nodes of each body; those where a bolt is cut move apart."""
    number = {i: n for n, i in result.model.assembly.nodes.items() if i not in getattr(result.model, "copies", {})}
    chosen = []
    for b, body in enumerate(result.bodies.bodies):
        own = sorted(n for n in result.bodies.nodes_of_body(b) if n in number)
        chosen += [(number[n], n, body.name) for n in own[:: max(1, len(own) * len(result.bodies.bodies) // most)]]
    return chosen


def interior(path):
    """(place, body) -> displacement."""
    import csv

    found = {}
    with open(path, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            u = [float(row.get(k) or 0) for k in ("ux", "uy", "uz")]
            place = tuple(round(float(row.get(k) or 0), 7) for k in ("x", "y", "z"))
            found[place, row["body"]] = u
    return found


def compare(mortise, path, most, timeout, directory):
    """A row of the table: dict of texts."""
    row = {
        "file": path.name,
        "nodes": "",
        "left out": "",
        "of them NLGEOM": "",
        "status": "",
        "difference": "",
        "stiffer": "",
        "stored": "",
        "force": "",
        "largest": "",
        "findings": [],
    }
    target = directory / "deck.yaml"
    try:
        result = import_deck.import_file(path, target, json.loads(import_deck.SCHEMA.read_text()))
    except import_deck.InputError as error:
        return dict(row, status="refused", findings=[str(error)])
    lost = [f for f in result.model.findings if f.changes]
    small = [f for f in lost if "NLGEOM" in f.keyword]
    row.update(
        {
            "nodes": len(result.model.points),
            "left out": len(lost) - len(small),
            "of them NLGEOM": len(small),
            "findings": [f"{f.file.name}:{f.line}: {f.keyword}: {f.reason}" for f in lost if f not in small],
        }
    )
    if not result.history.states:
        return dict(row, status="no static step")
    chosen = probes(result, most)
    points = [[float(f"{c:.9g}") for c in result.model.points[n][: result.axes]] for _, n, _ in chosen]
    (directory / "points.csv").write_text("".join(" ".join(map(str, p)) + "\n" for p in points))
    ours = run(
        [mortise, "deck.yaml", "--output", "out", "--set", "output.interior.points=points.csv", "--set", "solver.tolerance=1e-8"],
        directory,
        timeout,
    )
    if ours is None:
        return dict(row, status="too long")
    row["status"] = str(ours.returncode)
    if ours.returncode not in (0, 2) or not (directory / "out/interior.csv").exists():
        text = [line for line in (ours.stdout + ours.stderr).splitlines() if line.strip()]
        row["findings"].append("Mortise: " + " ".join(text[-3:]))
        return row
    found = interior(directory / "out/interior.csv")
    steps = STEP.findall(path.read_text(errors="replace"))
    stored = pathlib.Path(f"{path.with_suffix('')}.dat.ref")
    if stored.exists() and all(map(is_static, steps)) and (values := last_displacements(stored, "")):
        row["stored"] = difference(row, values, result, chosen, points, found).replace("no common node", "")
    for key, factor in (("difference", 1), ("stiffer", 10)):
        values, row["force"] = solve(path, factor, timeout, directory, result)
        row[key] = values if isinstance(values, str) else difference(row, values, result, chosen, points, found)
    return row


def force_difference(theirs, result, summary):
    """Of the largest force of a contact of surfaces, as text."""
    own = {}
    for contact, item in zip(summary["contacts"], result.deck["contacts"]):
        own[item.get("secondary", "").upper(), item.get("primary", "").upper()] = float(np.linalg.norm(contact["force"]))
    common = {pair: (force, own[pair]) for pair, force in theirs.items() if pair in own}
    if not common:
        return ""
    wedge = 180 if result.bodies.dimension == "axisymmetric" else 1  # CalculiX turns two degrees
    force, ours = (f * s for f, s in zip(max(common.values()), (wedge, 1)))
    return f"{percent(abs(ours - force) / force)} of {f'{force:.4g}' if force < 1e4 else f'{force:,.0f}'}" if force > 0 else ""


def solve(path, factor, timeout, directory, result):
    """(displacements or what went wrong, how far the contact force of Mortise is off) of CalculiX."""
    for old in directory.glob("theirs.*"):
        old.unlink()
    calculix_input(path, directory / "theirs.inp", factor)
    theirs = run(["ccx", "theirs"], directory, timeout)
    if theirs is None:
        return "too long", ""
    values = last_displacements(directory / "theirs.dat") if (directory / "theirs.dat").exists() else {}
    if theirs.returncode != 0 or not values:
        return "no result", ""
    return values, force_difference(
        contact_forces(directory / "theirs.dat"), result, json.loads((directory / "out/summary.json").read_text())
    )


def difference(row, values, result, chosen, points, found):
    """The largest difference over the largest displacement, as text."""
    pairs = []
    for (label, _, body), p in zip(chosen, points):
        key = (tuple(round(c, 7) for c in (*p, 0.0)[:3]), body)
        if label in values and key in found:
            pairs.append((values[label][: result.axes], found[key][: result.axes]))
    if not pairs:
        return "no common node"
    a, b = (np.array(x) for x in zip(*pairs))
    largest = np.abs(a).max()
    row["largest"] = row["largest"] or f"{largest:.4g}"
    return percent(np.abs(a - b).max() / largest) if largest > 0 else "0"


def percent(part):
    return f"{100 * part:.3g} %" if part >= 1 else f"{100 * part:.2g} %" if part >= 1e-5 else "< 0.001 %"


def page_row(row):
    """In the table of the page."""
    left_out = f"{row['left out']}{', NLGEOM' if row['of them NLGEOM'] else ''}"
    return [row["file"].removesuffix(".inp"), row["nodes"], left_out, *(row[k] for k in ("largest", "stored", "difference", "stiffer", "force"))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise", type=pathlib.Path)
    parser.add_argument("files", type=pathlib.Path, nargs="+")
    parser.add_argument("--points", type=int, default=400)
    parser.add_argument("--timeout", type=float, default=120)
    parser.add_argument("--quiet", action="store_true", help="the table alone")
    parser.add_argument("--write", action="store_true", help="put the rows into abaqus_decks.md")
    given = parser.parse_args()
    print(
        "| file | nodes | left out | NLGEOM | exit status | largest displacement | stored result | difference | penalty x 10, full integration | contact force |\n|---|---|---|---|---|---|---|---|---|---|"
    )
    every = []
    for path in given.files:
        with tempfile.TemporaryDirectory(prefix="mortise_decks_") as name:
            row = compare(str(given.mortise.resolve()), path, given.points, given.timeout, pathlib.Path(name))
        every.append(row)
        if given.write and row["status"] == "0" and row["stiffer"].endswith("%"):
            page_tables.write(PAGE, "abaqus decks", HEAD, [page_row(row)])
        print(
            "| "
            + " | ".join(
                str(row[k])
                for k in ("file", "nodes", "left out", "of them NLGEOM", "status", "largest", "stored", "difference", "stiffer", "force")
            )
            + " |",
            flush=True,
        )
    if not given.quiet:
        for row in every:
            if row["findings"]:
                print(f"\n{row['file']}:", *row["findings"], sep="\n  ")


if __name__ == "__main__":
    main()
