#!/usr/bin/env python3
"""Whether the side that carries the multipliers matters: partly covered contacts, each solved with either side as the secondary one
and with contacts that are found.

    sides.py MORTISE [pattern ...] [--quick] [--cells hex20 tet10 ...] [--laws ...] [--sizes 0 1 2] [--table FILE] [--markdown FILE]
             [--ranks N] [--mpiexec MPIEXEC] [--list]

A model is named by itself. Its figures: the largest recovered pressure and the largest von Mises stress, both at least `away` from the lines
where the exact ones are infinite (edges that are pressed into a surface), the work done, forces. Required: either side's within 10 % of the
other's on every mesh, 1 % in energy, forces to 1e-6. Exit status 1 if a case fails. Needs numpy.
"""

import argparse
import collections
import dataclasses
import fnmatch
import pathlib
import sys
from typing import Callable, Optional

import numpy as np

import study
from results import Result

DECKS = study.HERE / "decks" / "sides"
SHAPES = {"tet": 0, "tri": 0, "hex": 1, "quad": 1, "prism": 2}
SOLIDS = ["hex8", "hex20", "hex27", "tet4", "tet10", "prism6", "prism15"]
PLANE = ["tri3", "tri6", "quad4", "quad8", "quad9"]
SECOND = {"hex20", "hex27", "tet10", "prism15", "prism18", "tri6", "quad8", "quad9"}
INCOMPLETE = {"hex20", "prism15", "quad8"}
LAWS = {"frictionless": None, "coulomb": 0.15}


def gmsh_cell(cell):
    """The constants of the geometries that make this cell."""
    values = {"shape": SHAPES[cell.rstrip("0123456789")], "order": 2 if cell in SECOND else 1, "incomplete": int(cell in INCOMPLETE)}
    return [f"mesh.constants.{key}={value}" for key, value in values.items()]


def block_cell(cell):
    return [f"mesh.blocks.{body}.element={cell}" for body in ("lower", "upper")]


@dataclasses.dataclass
class Model:
    """One arrangement. sides: boundaries of each contact, the first of them secondary in the deck. away(x, y, z) -> distance from the
    lines where stress is infinite, in units of a distance that is about one cell of the first size. load: its component and size."""

    name: str
    title: str
    deck: str
    sides: list
    cells: list
    sizes: list  # settings, one list a size, from coarse to fine
    away: Callable
    load: tuple
    cell: Callable = gmsh_cell
    laws: tuple = ("frictionless", "coulomb")
    coefficient: float = 0.15
    extra: Optional[Callable] = None  # extra(result) -> {figure: (value, exact or None, tolerance)}
    search: float = 0  # search_distance of the contacts that are found


def h(*values):
    return [[f"mesh.constants.h={value}"] for value in values]


def from_circle(radius, place, axis):
    """Distance from a circle about an axis."""

    def distance(*x):
        along = x[axis]
        across = np.sqrt(sum(x[i] ** 2 for i in range(len(x)) if i != axis))
        return np.hypot(across - radius, along - place)

    return distance


def pin_away(x, y, z):
    return np.minimum(from_circle(10, 5, 2)(x, y, z), 9 - z) / 3


def ball_away(x, y, z):
    return np.minimum(from_circle(4, -np.sqrt(84), 1)(x, y, z), from_circle(10 * np.sqrt(0.75), -5, 1)(x, y, z)) / 1.5


def roller_away(x, y, z):
    return np.where(np.hypot(x, y) < 3, np.abs(z - 5) / 1.0, 10)


def disc_away(x, y, z):
    edge = np.where(np.hypot(x, y) < 12.5, np.hypot(x - 4, z), 25)
    return np.minimum(edge, from_circle(10, 0, 2)(x, y, z)) / 2.5


def block_away(offset, axis):
    def away(*x):
        return np.minimum(np.hypot(x[0] - 1, x[axis] - 1), np.hypot(x[0] - offset, x[axis] - 1)) / 0.25

    return away


def strip_figures(result):
    """Share of the load that acts as shear, and the width that sticks, both in the contact's tractions."""
    from cases.common import by_x

    x, traction, areas = by_x(result, "contact_traction")
    pressed = np.abs(traction[:, 1]) > 0
    share = np.sum(areas * np.abs(traction[:, 0])) / np.sum(areas * np.abs(traction[:, 1]))
    stuck = pressed & (result.contact.fields["contact_status"][np.argsort(result.contact.points[:, 0], kind="stable")] == 1)
    return {"shear share": (share, None, 0.1), "stick width": (float(np.sum(areas[stuck])), None, 0.1)}


def v_figures(result):
    forces = sorted((contact["force"] for contact in result.summary["contacts"]), key=lambda f: -abs(f[1]))[:2]  # the blocks touch, too
    return {
        "sideways": (max((abs(abs(f[0]) - 2) for f in forces)) + 2, 2, 0.01),
        "upwards": (max((abs(abs(f[1]) - 2) for f in forces)) + 2, 2, 0.01),
    }


def blocks(n, offset, dimension):
    """Cells of the two blocks, n times as many as at first; in space the width keeps its cells."""
    y = lambda width: [] if dimension == 2 else [width]
    words = lambda cells: f"[{', '.join(map(str, cells))}]"
    origin = [offset] + y(0) + [1]
    return [
        f"mesh.blocks.lower.cells={words([8 * n, *y(4), 4 * n])}",
        f"mesh.blocks.upper.cells={words([5 * n, *y(5), 4 * n])}",
        f"mesh.blocks.upper.origin={words(origin)}",
    ]


def block_models():
    for name, part in (("tenth", 0.1), ("third", 1 / 3), ("two_thirds", 2 / 3)):
        offset = 0.2 * part
        for dimension, deck, cells, up in ((3, "block_over_edge", SOLIDS, "z"), (2, "block_over_edge_2d", PLANE, "y")):
            yield Model(
                f"block_{name}" + ("_2d" if dimension == 2 else ""),
                f"A block that hangs over an edge by {name.replace('_', ' ')} of a cell",
                f"{deck}.yaml",
                [(f"upper.{up}min", f"lower.{up}max")],
                cells,
                [blocks(n, offset, dimension) for n in (1, 2, 3)],
                block_away(offset, dimension - 1),
                (dimension - 1, 10),
                block_cell,
            )


def roller_models():
    for name, lengths in (("longer", (6, 5)), ("shorter", (5, 6))):
        sizes = [[*s, f"mesh.constants.roller={lengths[0]}", f"mesh.constants.track={lengths[1]}"] for s in h(0.3, 0.2, 0.14)]
        yield Model(
            f"roller_{name}",
            f"A roller {name} than its track",
            "roller_on_track.yaml",
            [("track_surface", "roller_surface")],
            SOLIDS,
            sizes,
            roller_away,
            (1, 5000),
        )


MODELS = [
    Model(
        "pin_in_lug",
        "A pin that sticks out of the hole of a plate, clearance 0.05",
        "pin_in_lug.yaml",
        [("hole", "pin")],
        SOLIDS,
        h(3, 2, 1.4),
        pin_away,
        (0, 2500),
    ),
    Model(
        "ball_in_socket",
        "A ball in a part of a sphere, both rims of which cross its faces",
        "ball_in_socket.yaml",
        [("socket_surface", "ball_surface")],
        SOLIDS,
        h(1.5, 1, 0.7),
        ball_away,
        (1, 10e3),
    ),
    Model(
        "ball_in_socket_2d",
        "The same, axisymmetric",
        "ball_in_socket_2d.yaml",
        [("socket_surface", "ball_surface")],
        PLANE,
        h(1.5, 0.8, 0.4),
        lambda x, y, z: ball_away(x, y, 0 * z),
        (1, 40e3),
    ),
    *roller_models(),
    Model(
        "disc_on_plate",
        "A disc on a plate over whose edge it hangs",
        "disc_on_plate.yaml",
        [("disc_bottom", "plate_top")],
        SOLIDS,
        h(2.5, 1.7, 1.2),
        disc_away,
        (2, 10e3),
    ),
    *block_models(),
    Model(
        "cylinder_in_v",
        "A cylinder in a V without friction: half the load sideways at each face",
        "cylinder_in_v.yaml",
        [("rim_left", "face_left"), ("rim_right", "face_right")],
        PLANE,
        h(0.15, 0.1, 0.05),
        lambda x, y, z: 0 * x + 10,
        (1, 4),
        laws=("frictionless",),
        extra=v_figures,
    ),
    Model(
        "strip",
        "A cylinder on a block, a / R = 0.12, friction 0.1, pressed alone",
        "strip.yaml",
        [("block_top", "cylinder_surface")],
        PLANE,
        h(0.6, 0.4, 0.25),
        lambda x, y, z: np.where(np.hypot(x, y) < 12, 10, 0),
        (1, 65.25e3),
        laws=("coulomb",),
        coefficient=0.1,
        extra=strip_figures,
    ),
]


@dataclasses.dataclass
class Run:
    model: Model
    cell: str
    size: int
    law: str
    side: str
    status: int
    text: str = ""
    figures: dict = dataclasses.field(default_factory=dict)
    peaks: dict = dataclasses.field(default_factory=dict)
    exact: dict = dataclasses.field(default_factory=dict)  # figure: (expected, tolerance)
    products: int = 0
    unknowns: int = 0
    seconds: float = 0.0

    def key(self):
        return self.model.name, self.cell, self.size, self.law


def settings(model, cell, size, law, side):
    """side: "auto", or the number of the side that is secondary."""
    words = [*model.cell(cell), *model.sizes[size]]
    friction = f", friction: {{coulomb: {model.coefficient}}}" if law == "coulomb" else ""
    if side == "auto":
        search = f", search_distance: {model.search}" if model.search else ""
        return words + [f"contacts=[{{auto: true{friction}{search}}}]"]
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
    run.exact["force"] = (load, 1e-6)
    if run.model.extra:
        for name, (value, expected, tolerance) in run.model.extra(result).items():
            run.figures[name] = value
            run.exact[name] = (expected, tolerance)
    run.products, run.unknowns = summary["hessian_multiplications"], summary["primal_unknowns"]


def solve(program, model, cell, size, law, side):
    words = settings(model, cell, size, law, side)
    status, text, directory, seconds = program.attempt(DECKS / model.deck, words)
    name = side if side == "auto" else model.sides[0][side]
    run = Run(model, cell, size, law, name, status, text, seconds=seconds)
    if status in (0, 2):
        evaluate(run, Result(directory, seconds))
    return run


LIMITS = {"pressure": 0.1, "von Mises": 0.1, "energy": 0.02, "shear share": 0.1, "stick width": 0.1}


def judge(runs):
    """What is wrong with the runs of one case, size and law."""
    complaints = [f"{run.side}: exit status {run.status}" for run in runs if run.status != 0]
    solved = [run for run in runs if run.status == 0]
    for run in solved:
        for name, (expected, tolerance) in run.exact.items():
            if expected is not None and not abs(run.figures[name] - expected) <= tolerance * expected:
                complaints.append(f"{name} of {run.side}: {run.figures[name]:.8g}, expected {expected:g} to {tolerance:g}")
    for name, limit in LIMITS.items():
        values = [run.figures[name] for run in solved if name in run.figures]
        if values and not max(values) <= (1 + limit) * min(values):
            shown = ", ".join(f"{run.side} {run.figures[name]:.4g}" for run in solved)
            complaints.append(f"{name}: {shown}")
    return complaints


HEAD = f"{'model':20} {'cell':8} {'size':4} {'law':12} {'secondary':16} {'pressure':>10} {'(peak)':>10} {'v. Mises':>10} {'(peak)':>10} {'energy':>11} {'force':>16} {'products':>8} {'exit':>4}  other"


def line(run):
    f, p = run.figures, run.peaks
    number = lambda values, name, form: format(values[name], form) if name in values else "-"
    other = " ".join(f"{name.replace(' ', '_')}={f[name]:.5g}" for name in f if name not in ("pressure", "von Mises", "energy", "force"))
    return (
        f"{run.model.name:20} {run.cell:8} {run.size:<4} {run.law:12} {run.side:16} {number(f, 'pressure', '.5g'):>10} {number(p, 'pressure', '.5g'):>10} "
        f"{number(f, 'von Mises', '.5g'):>10} {number(p, 'von Mises', '.5g'):>10} {number(f, 'energy', '.6g'):>11} {number(f, 'force', '.10g'):>16} {run.products:>8} {run.status:>4}  {other}"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("pattern", nargs="*")
    parser.add_argument("--cells", nargs="*")
    parser.add_argument("--laws", nargs="*")
    parser.add_argument("--sizes", nargs="*", type=int)
    parser.add_argument("--table", type=pathlib.Path)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--mpiexec", default="mpirun")
    arguments = parser.parse_intermixed_args()
    program = study.Program(arguments.mortise, arguments.ranks, arguments.mpiexec)
    groups, failed = collections.OrderedDict(), 0
    print(HEAD)
    for model in MODELS:
        if arguments.pattern and not any(fnmatch.fnmatch(model.name, p) for p in arguments.pattern):
            continue
        for cell in model.cells:
            if arguments.cells and cell not in arguments.cells:
                continue
            for law in model.laws:
                if arguments.laws and law not in arguments.laws:
                    continue
                for size in range(len(model.sizes)):
                    if arguments.sizes and size not in arguments.sizes:
                        continue
                    runs = [solve(program, model, cell, size, law, side) for side in (0, 1, "auto")]
                    print(*map(line, runs), sep="\n", flush=True)
                    complaints = judge(runs)
                    print(*(f"    FAILED {complaint}" for complaint in complaints), sep="\n", flush=True)
                    failed += bool(complaints)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
