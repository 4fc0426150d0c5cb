#!/usr/bin/env python3
"""Whether the side that carries the multipliers matters: partly covered contacts, each solved with either side as the secondary one
and with contacts that are found.

    sides.py MORTISE [model ...] [--quick | --suite] [--cells hex20 tet10 ...] [--laws frictionless coulomb] [--sizes 0 1 2] [--commands]
             [--write] [--ranks N] [--mpiexec MPIEXEC] [--list]

A model may be a pattern. --quick solves a selection on the first meshes; --suite the same with cheaper cells for pin, rollers, ball and
disc, and without `auto` for tipping blocks in space, and a cheap cell of the last mesh for what is held against a reference. Figures: the
largest recovered pressure and the largest von Mises stress, both farther than `away` from the lines where the exact ones are infinite
(edges pressed into a surface, clamped borders); the strain energy; forces. Required: the three solutions within 10 % of each other in
stress (20 % on meshes between the first and the last) and 2 % in energy, forces to 1e-6; the last mesh near the reference, which is a
much finer mesh's. Blocks loaded a fiftieth of a cell inside or beyond the edge they would tip about must stand or end with exit 3. Exit status 1 if a case fails. --commands
prints how to run what failed; --quick --write puts the selection into results.md, --sizes 0 --write and --sizes 2 --write a line for each
model into sides.md: how far its solutions are apart, and from the reference. Needs numpy.
"""

import argparse
import dataclasses
import fnmatch
import sys

import numpy as np

import study
from results import Result
from sides_models import MODELS, PLANE, SECOND, SOLIDS, Model, block_cell

DECKS = study.HERE / "decks" / "sides"


@dataclasses.dataclass
class Run:
    model: Model
    cell: str
    size: int
    law: str
    side: str
    status: int
    words: tuple = ()  # of the command line
    figures: dict = dataclasses.field(default_factory=dict)
    peaks: dict = dataclasses.field(default_factory=dict)
    exact: dict = dataclasses.field(default_factory=dict)  # figure: (expected, tolerance)
    products: int = 0
    unknowns: int = 0
    seconds: float = 0.0
    warnings: tuple = ()  # kinds

    @property
    def coarse(self):
        """Whether the mesh has too few faces in the contact for stresses."""
        return self.size < self.model.coarse(self.cell)


def settings(model, cell, size, law, side):
    """side: "auto", or the number of the side that is secondary."""
    words = [*model.cell(cell), *model.sizes[size]]
    friction = f", friction: {{coulomb: {model.coefficient}}}" if law == "coulomb" else ""
    if side == "auto":
        return words + [f"contacts=[{{auto: true{friction}}}]"]
    entries = [f"{{name: contact{i}, secondary: {s[side]}, primary: {s[1 - side]}{friction}}}" for i, s in enumerate(model.sides)]
    return words + [f"contacts=[{', '.join(entries)}]"]


# Pieces of the edges of faces and lines, by their VTK type.
EDGES = {
    3: [(0, 1)],
    21: [(0, 2), (2, 1)],
    5: [(0, 1), (1, 2), (2, 0)],
    22: [(0, 3), (3, 1), (1, 4), (4, 2), (2, 5), (5, 0)],
    9: [(0, 1), (1, 2), (2, 3), (3, 0)],
    23: [(0, 4), (4, 1), (1, 5), (5, 2), (2, 6), (6, 3), (3, 7), (7, 0)],
}
EDGES[28] = EDGES[23] + [(4, 8), (8, 6), (5, 8), (8, 7)]


def largest(points, values, away):
    """The largest value farther than one unit from the lines, and the largest of all."""
    far = away(*points.T) >= 1
    return float(values[far].max(initial=0)), float(values.max(initial=0))


def largest_on_edges(grid, values, away):
    """The same between the nodes, along edges: either side's nodes lie at other distances from the lines, near which pressure is steep."""
    edges = np.vstack([nodes[:, pair] for kind, _, nodes in grid.groups() for pair in EDGES[kind]])
    t = np.linspace(0, 1, 11)[:, None]
    along = lambda field: np.concatenate([(1 - s) * field[edges[:, 0]] + s * field[edges[:, 1]] for s in t])
    return largest(along(grid.points), along(values), away)


def evaluate(run, result):
    summary = result.summary
    component, load = run.model.load
    grid, contact = result.solution, result.contact
    run.figures["von Mises"], run.peaks["von Mises"] = largest(grid.points, grid.fields["von_mises"], run.model.away)
    run.figures["pressure"], run.peaks["pressure"] = largest_on_edges(contact, contact.fields["contact_pressure_recovered"], run.model.away)
    run.figures["energy"] = summary["strain_energy"]
    run.figures["force"] = sum(abs(c["force"][component]) for c in summary["contacts"])
    run.exact["force"] = (load, run.model.force_tolerance)
    if run.model.extra:
        for name, (value, expected, tolerance) in run.model.extra(result).items():
            run.figures[name] = value
            run.exact[name] = (expected, tolerance)
    run.warnings = tuple(sorted({warning["kind"] for warning in summary["warnings"]}))
    run.products, run.unknowns = summary["hessian_multiplications"], summary["primal_unknowns"]


def solve(program, model, cell, size, law, side):
    words = settings(model, cell, size, law, side)
    status, text, directory, seconds = program.attempt(DECKS / model.deck, words)
    name = side if side == "auto" else model.sides[0][side]
    run = Run(model, cell, size, law, name, status, tuple(words), seconds=seconds)
    if status in (0, 2):
        evaluate(run, Result(directory, seconds))
    return run


# How far the solutions may be apart on the first and the last meshes; on those between, the first points beside lines where stresses are
# infinite are where they may be. And how far from the reference on the last mesh (cells of triangles of first order, others of first order, second order).
LIMITS = {"pressure": 0.1, "von Mises": 0.1, "energy": 0.02, "shear share": 0.1, "stick width": 0.1}
STRESSES_BETWEEN = 0.2
FROM_REFERENCE = {"pressure": (0.25, 0.25, 0.15), "von Mises": (0.3, 0.25, 0.15), "energy": (0.1, 0.1, 0.03)}


def judge(runs):
    """What is wrong with the runs of one case, size and law."""
    complaints = [f"{run.side}: exit status {run.status}" for run in runs if run.status != 0]
    solved = [run for run in runs if run.status == 0]
    for run in solved:
        for name, (expected, tolerance) in run.exact.items():
            if expected is not None and not abs(run.figures[name] - expected) <= tolerance * expected:
                complaints.append(f"{name} of {run.side}: {run.figures[name]:.8g}, expected {expected:g} to {tolerance:g}")
    if runs[0].coarse:
        return complaints + [f"{run.side}: no warning of the mesh" for run in solved if not warned(run)]
    for name, limit in LIMITS.items():
        values = [run.figures[name] for run in solved if name in run.figures]
        if name in ("pressure", "von Mises") and 0 < runs[0].size < len(runs[0].model.sizes) - 1:
            limit = STRESSES_BETWEEN
        if values and not max(values) <= (1 + limit) * min(values):
            shown = ", ".join(f"{run.side} {run.figures[name]:.4g}" for run in solved)
            complaints.append(f"{name}: {shown}")
    return complaints + [word for run in solved for word in far_from_reference(run)]


def warned(run):
    """The kinds that tell of a mesh which cannot have the pressure."""
    return [kind for kind in ("narrow_contact", "coarse_mesh") if kind in run.warnings]


def verdict(runs, complaints):
    """What is judged, and how."""
    if complaints:
        return "**fails**"
    if not runs[0].coarse:
        return "passed"
    kinds = sorted({kind for run in runs for kind in warned(run)}, reverse=True)
    return f"forces passed; too coarse for stresses, not judged: {' or '.join(f'`{kind}`' for kind in kinds)} says so in every run"


def far_from_reference(run):
    if run.size + 1 < len(run.model.sizes):
        return []
    complaints = []
    for name, expected in run.model.reference.get(run.law, {}).items():
        limit = FROM_REFERENCE[name][0 if run.cell in ("tri3", "tet4", "prism6") else 1 + (run.cell in SECOND)]
        if not abs(run.figures[name] - expected) <= limit * expected:
            complaints.append(f"{name} of {run.side}: {run.figures[name]:.4g}, reference {expected:.4g} to {limit:g}")
    return complaints


# Blocks that stand or tip. The edge a block tips about crosses cells of the upper block that hangs over it (`edge`), or of the lower block
# on which the upper one stands (`foot`); a `pad` stands inside one of the lower block's cells. The load's resultant is `offset` cells of the side
# that is partly covered beyond the edge.
TIPPING_QUICK = ["quad8", "tet10"]
TIPPING = [(kind, across, offset) for kind in ("edge", "foot") for across in (6, 5) for offset in (-0.02, 0.02)] + [("pad", 3, -0.02), ("pad", 3, 0.02)]


def tipping_settings(cell, kind, across, offset, side):
    plane = cell in PLANE
    up, middle = ("y", "") if plane else ("z", "0.2, ")
    words = block_cell(cell) + [f"mesh.blocks.upper.cells=[{across}, {'3' if plane else '4, 3'}]"]
    if kind == "edge":
        words.append(f"mesh.blocks.upper.origin=[{0.5 + offset / across}, {middle}0.5]")
    else:
        half, cell_below = (0.5, 2 / 9) if kind == "foot" else (0.15, 2 / 3)
        couple = 6 * (half + offset * cell_below) / (2 * half * 0.4 * (1 if plane else 0.6 if kind == "foot" else 0.3))
        vector = lambda size: f"[0, {size}]" if plane else f"[0, 0, {size}]"
        if kind == "foot":
            words.append(f"mesh.blocks.upper.origin=[{-0.55 if across == 6 else -0.4}, {middle}0.5]")
        else:
            words.append(f"mesh.blocks.upper.origin=[-0.1, {middle}0.5]")
            words += [f"mesh.blocks.upper.size=[0.3, {'' if plane else '0.3, '}0.4]", f"mesh.blocks.lower.cells=[3, {'' if plane else '1, '}2]"]
        words += [f"loads[1].traction={vector(couple)}", f"loads[2].traction={vector(-couple)}"]
    friction = "friction: {coulomb: 0.5}"
    sides = [f"upper.{up}min", f"lower.{up}max"]
    entry = f"auto: true, {friction}" if side == "auto" else f"name: contact, secondary: {sides[side]}, primary: {sides[1 - side]}, {friction}"
    return words + [f"contacts=[{{{entry}}}]"]


def tips(program, cell, sides, commands=False):
    """Runs all of a cell's blocks with these sides secondary; what is wrong."""
    complaints = []
    plane = cell in PLANE
    deck = DECKS / ("tipping_2d.yaml" if plane else "tipping.yaml")
    for kind, across, offset in TIPPING:
        for side in sides:
            words = tipping_settings(cell, kind, across, offset, side)
            status, text, directory, _ = program.attempt(deck, words)
            expected, wrong = 3 if offset > 0 else 0, None
            if status != expected:
                wrong = f"exit status {status}, expected {expected}"
            elif status == 3 and 'body "upper" rotates' not in text:
                wrong = "not said that the upper block rotates"
            elif status == 0:
                force = abs(Result(directory, 0).summary["contacts"][0]["force"][1 if plane else 2])
                wrong = None if abs(force - 6) <= 6e-6 else f"force {force:.8g}, expected 6"
            if wrong:
                name = f"{kind}, {across} cells, {'auto' if side == 'auto' else ('upper', 'lower')[side] + ' secondary'}, {offset:+g} cells"
                complaints.append(f"{name}: {wrong}" + ("\n" + command(deck, words) if commands else ""))
    return complaints


HEAD = (
    f"{'model':20} {'cell':8} {'size':4} {'law':12} {'secondary':15} {'pressure':>9} {'(peak)':>9} {'v. Mises':>9} {'(peak)':>9} {'energy':>11} "
    f"{'force':>14} {'products':>8} {'exit':>4}  other"
)


def line(run):
    f, p = run.figures, run.peaks
    number = lambda values, name, form: format(values[name], form) if name in values else "-"
    other = " ".join(f"{name.replace(' ', '_')}={f[name]:.5g}" for name in f if name not in ("pressure", "von Mises", "energy", "force"))
    return (
        f"{run.model.name:20} {run.cell:8} {run.size:<4} {run.law:12} {run.side:15} {number(f, 'pressure', '.5g'):>9} {number(p, 'pressure', '.5g'):>9} "
        f"{number(f, 'von Mises', '.5g'):>9} {number(p, 'von Mises', '.5g'):>9} {number(f, 'energy', '.6g'):>11} {number(f, 'force', '.9g'):>14} "
        f"{run.products:>8} {run.status:>4}  {other}"
    ).rstrip()


def command(deck, words):
    return f"    mortise {deck} " + " ".join(f"--set '{word}'" for word in words)


def cases(arguments):
    """(model, cell, law, size) that were asked for."""
    wanted = lambda value, values: not values or value in values
    for model in MODELS:
        if arguments.model and not any(fnmatch.fnmatch(model.name, pattern) for pattern in arguments.model):
            continue
        for cell in model.cells:
            for law in model.laws:
                for size in range(len(model.sizes)):
                    quick = not arguments.quick or (size == 0 and (cell, law) in (model.suite if arguments.suite else model.quick))
                    quick = quick or (arguments.suite and size + 1 == len(model.sizes) and (cell, law) in model.last)
                    if quick and wanted(cell, arguments.cells) and wanted(law, arguments.laws) and wanted(size, arguments.sizes):
                        yield model, cell, law, size


def tipping_cells(arguments):
    if arguments.model and not any(fnmatch.fnmatch("tipping", pattern) for pattern in arguments.model):
        return []
    cells = TIPPING_QUICK if arguments.quick else PLANE + SOLIDS
    return [cell for cell in cells if not arguments.cells or cell in arguments.cells]


TABLE = ["model, law", "cell", "unknowns", "pressure", "von Mises", "energy", "other", "verdict"]


def known_keys():
    """Of the rows that the table of the page has, those of the quick selection."""
    selection = [(f"`{model.name}`, {law}", cell) for model in MODELS for cell in model.cells for law in model.laws if (cell, law) in model.quick]
    return selection + [("`tipping`", cell) for cell in TIPPING_QUICK]


def table_rows(groups, tipped):
    """A row a model, law and cell: the secondary sides and `auto` in turn."""
    of = lambda runs, name: " / ".join(f"{run.figures[name]:.4g}" if name in run.figures else f"exit {run.status}" for run in runs)
    rows = []
    for (model, cell, law, _), (runs, complaints) in groups.items():
        other = "; ".join(f"{name} {of(runs, name)}" for name in runs[0].figures if name not in ("pressure", "von Mises", "energy", "force"))
        figures = [of(runs, name) for name in ("pressure", "von Mises", "energy")]
        rows.append([f"`{model.name}`, {law}", cell, f"{runs[0].unknowns:,}", *figures, other, verdict(runs, complaints)])
    for cell, complaints in tipped.items():
        told = f"**{len(complaints)} of {3 * len(TIPPING)} fail**" if complaints else "passed"
        rows.append(["`tipping`", cell, "", "", "", "", "stands inside the edge, tips beyond it", told])
    return rows


APART = ["model", "meshes", "cells", "runs", *(f"{name} apart" for name in list(LIMITS)[:3]), *(f"{name} from the reference" for name in FROM_REFERENCE),
         "not judged", "failed"]


def largest_of(found, form="{:.1f} %"):
    """The largest of {(cell, law): part}, and where it is."""
    if not found:
        return "-"
    where = max(found, key=found.get)
    return f"{form.format(100 * found[where])} ({', '.join(where)})"


def apart_rows(groups, size):
    """A row a model, over its cells and laws: the largest differences between the solutions, as parts of the least, and from the reference."""
    rows = []
    for model in dict.fromkeys(key[0] for key in groups):
        of_model = {(cell, law): case for (m, cell, law, _), case in groups.items() if m is model}
        judged = {key: [run for run in runs if run.status == 0] for key, (runs, _) in of_model.items() if not runs[0].coarse}
        values = lambda runs, name: [run.figures[name] for run in runs]
        apart = [largest_of({key: max(values(runs, name)) / min(values(runs, name)) - 1 for key, runs in judged.items() if runs}) for name in list(LIMITS)[:3]]
        off = ["-"] * len(FROM_REFERENCE)
        if size + 1 == len(model.sizes):
            off = [largest_of({key: max(abs(value / model.reference[key[1]][name] - 1) for value in values(runs, name))
                               for key, runs in judged.items() if runs and name in model.reference.get(key[1], {})}) for name in FROM_REFERENCE]
        cells = len({key[0] for key in of_model})
        runs = sum(len(runs) for runs, _ in of_model.values())
        coarse = sum(len(runs) for runs, _ in of_model.values() if runs[0].coarse)
        failed = "; ".join(f"**{cell}, {law}: {complaint}**" for (cell, law), (_, complaints) in of_model.items() for complaint in complaints)
        rows.append([f"`{model.name}`", "first" if size == 0 else "last", cells, runs, *apart, *off, coarse, failed or 0])
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise", nargs="?")
    parser.add_argument("model", nargs="*")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--suite", action="store_true")
    parser.add_argument("--cells", nargs="*")
    parser.add_argument("--laws", nargs="*")
    parser.add_argument("--sizes", nargs="*", type=int)
    parser.add_argument("--commands", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--mpiexec", default="mpirun")
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_intermixed_args()
    if arguments.list or arguments.mortise is None:
        print(*(model.name for model in MODELS), "tipping", sep="\n")
        return 0
    if arguments.write and (arguments.suite or not (arguments.quick or arguments.sizes in ([0], [2]) and not arguments.cells and not arguments.laws)):
        parser.error("--write is for the quick selection, and for all cells of the first or the last meshes")
    arguments.quick = arguments.quick or arguments.suite
    program = study.Program(arguments.mortise, arguments.ranks, arguments.mpiexec)
    groups, tipped, seconds = {}, {}, 0.0
    print(HEAD)
    for model, cell, law, size in cases(arguments):
        # `auto` takes one of the sides: quick runs see which on cheap models alone.
        sides = (0, 1) if arguments.quick and cell in SOLIDS and not model.name.startswith("block") else (0, 1, "auto")
        runs = [solve(program, model, cell, size, law, side) for side in sides]
        complaints = judge(runs)
        print(*map(line, runs), *(f"  FAILED: {complaint}" for complaint in complaints), sep="\n", flush=True)
        if complaints and arguments.commands:
            print(*(command(DECKS / model.deck, run.words) for run in runs), sep="\n", flush=True)
        groups[model, cell, law, size] = runs, complaints
        seconds += sum(run.seconds for run in runs)
    for cell in tipping_cells(arguments):
        sides = (0, 1) if arguments.suite and cell in SOLIDS else (0, 1, "auto")
        tipped[cell] = tips(program, cell, sides, commands=arguments.commands)
        print(f"tipping, {cell}: {'FAILED' if tipped[cell] else 'passed'}", *(f"  FAILED: {c}" for c in tipped[cell]), sep="\n", flush=True)
    failed = sum(bool(complaints) for _, complaints in groups.values()) + sum(map(bool, tipped.values()))
    print(f"{failed} of {len(groups) + len(tipped)} cases failed; {seconds:.0f} s of CPU in the program, without the tipping blocks")
    if not groups and not tipped:
        parser.error("no such case")
    if arguments.write and not arguments.quick:
        known = [(f"`{model.name}`", mesh) for model in MODELS for mesh in ("first", "last")]
        study.page_tables.write(study.HERE / "sides.md", "apart", APART, apart_rows(groups, arguments.sizes[0]), keys=2, known=known)
    elif arguments.write:
        study.page_tables.write(study.PAGE, "sides", TABLE, table_rows(groups, tipped), keys=2, known=known_keys())
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
