#!/usr/bin/env python3
"""The tables of docs/design/: what decks take with one choice and with another.

    products.py MORTISE [TABLE ...] [--row PATTERN] [--large] [--list] [--write]

Products with F are those of `hessian_multiplications` in summary.json; "no end": not converged after as many as the row allows. Times are ratios
of runs one after the other. Needs python3-h5py and python3-numpy.
"""
import math
import pathlib
import re
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "population"), str(ROOT / "inputs/wind_bearing")]
import page_tables  # noqa: E402, F401: table_runs.py writes by it
import roller_forces  # noqa: E402
from table_runs import Deck, Row, Table, main  # noqa: E402


def page(name):
    return f"docs/design/{name}.md"


def inputs(name, *settings, **others):
    folder, _, file = name.partition("/")
    return Deck(f"inputs/{folder}/{file or folder}.yaml", settings, **others)


def case(name, *settings, **others):
    return Deck(f"regression/{name}", settings, **others)


def algorithm(name):
    return f"solver.algorithm={name}"


def at_most(count):
    return f"solver.max_multiplications={count}"


def products(run):
    """Or that there was no end."""
    return str(run.products) if run.status == 0 else "no end"


def unknowns(run):
    return f"{run.summary['primal_unknowns']:,}"


# docs/design/active_sets.md
def by_either(alone, auto):
    direct = ", direct" if auto.summary["algorithm"] == "direct" else ""
    return [unknowns(alone), products(alone), products(auto) + direct]


# docs/design/direct_solution.md
DIRECT = ["cases/stack.yaml", "cases/bent_strips.yaml", "hard/decks/leaf_spring.yaml", "cases/slipping_leaves.yaml", "cases/pushed_bricks.yaml",
          "cases/brick_wall.yaml", "cases/end_of_strip.yaml", "hard/decks/belt.yaml", "cases/thin_plates.yaml"]
DIRECT_ALGORITHMS = ("face_newton", "direct", "auto")


# docs/design/preconditioner.md
def preconditioned(*runs):
    return [products(run) for run in runs]


def clamp(preconditioner, decomposition):
    return inputs("yielding_clamp", "mesh.constants.size=0.6", algorithm("face_newton"), f"solver.preconditioner={preconditioner}",
                  f"decomposition={{{decomposition}}}", at_most(1000), may_fail=True)


# docs/design/clusters.md
RINGS = ("mesh.blocks.shaft.cells=[40, 20]", "mesh.blocks.hub.cells=[60, 30]")
CLUSTERS = [("`inputs/cantilever_3d`", lambda *s: inputs("cantilever_3d", *s, may_fail=True), (1, 8, 27, 54)),
            ("a press fit of 22 rings", lambda *s: case("verification/decks/press_fit_axisymmetric.yaml", *RINGS, "decomposition.unknowns_per_subdomain=250", *s,
                                                        may_fail=True), (1, 5, 11)),
            ("`inputs/wind_bearing/half.yaml`", lambda *s: inputs("wind_bearing/half", *s, at_most(400), may_fail=True), (1, 8)),
            ("`inputs/yielding_clamp`, size 0.6", lambda *s: inputs("yielding_clamp", "mesh.constants.size=0.6", "decomposition.unknowns_per_subdomain=250",
                                                                   "solver.preconditioner=lumped", *s, at_most(1000), may_fail=True), (1, 8))]


def clustered(run):
    return [run.summary["subdomains"], products(run)]


# docs/design/single_precision.md
def cubes(n, precision):
    return case("comparison/pressed_cubes/pressed_cubes.yaml", f"mesh.constants.n={n}", f"solver.factor_precision={precision}")


def in_single_precision(double, single):
    pair = [double, single]
    ratio = lambda of: f"{of(single) / of(double):.2f}"
    return [f"{double.unknowns:,}", ratio(lambda run: run.seconds), ratio(lambda run: run.summary["time"]["multiplication"] / run.products),
            " / ".join(f"{run.summary['peak_memory_bytes'] / 1e6:.0f}" for run in pair), " / ".join(products(run) for run in pair),
            f"{abs(single.summary['strain_energy'] / double.summary['strain_energy'] - 1):.0e}"]


# docs/design/moments.md
def torque(n):
    """Of a traction 0.1 along the rim, 4 n + 4 chords of a circle of radius 3 with two points of integration each."""
    count = 4 * n + 4
    length = 6 * math.sin(math.pi / count)
    return 0.1 * count * length * math.hypot(3 * math.cos(math.pi / count), length / 2 / math.sqrt(3))


def ring(n, *settings):
    return case("cases/ring_passes_torque.yaml", f"mesh.constants.n={n}", "solver.tolerance=1e-10", *settings)


def lost(n):
    return lambda *runs: [f"{abs(-run.summary['reactions'][0]['moment'][2] / torque(n) - 1):.0e}" for run in runs]


# docs/design/narrow_contacts.md
def ball(depth, cells, x):
    return case("cases/obstacle_between_nodes.yaml", "loads=[]", f"supports[0].displacement={{x: 0, y: 0, z: -{depth}}}",
                f"mesh.blocks.block={{size: [2, 2, 1.5], cells: {cells}, element: hex8}}",
                f"contacts[0].primary={{sphere: {{center: [{x}, {x}, -10], radius: 10}}}}")


DEPTHS = (0.001, 0.01, 0.02)
BEARING_CELLS = ((1, 8), (1, 5), (1, 2), (3, 1), (3, 3), (0.25, 0.25))
ON_ROLLERS = tuple(f"contacts[{i}].{side}={name}" for i, race in enumerate(("inner_race", "outer_race")) for side, name in (("secondary", "rolling"), ("primary", race)))


def normal_force(axis):
    return lambda *runs: [f"{abs(run.summary['contacts'][0]['force'][axis]):,.3g}" for run in runs]


def inner_race(*runs):
    return [f"{np.hypot(*run.summary['contacts'][0]['force'][:2]):,.0f}" for run in runs]


def coarse_bearing(cells, *settings):
    return case("cases/coarse_bearing.yaml", *(f"mesh.constants.{name}={size}" for name, size in zip(("roller", "ring"), cells)), *settings)


# docs/design/slender_bodies.md
OWN_PROGRAM = {0.03: 287.970, 0.01: 207.128}


def gasket(thickness):
    def cells(run):
        told = re.search(r"slender subdomains: .* by (\S+)", run.log)
        return [told[1] if told else "below 3e-8", f"{run.summary['strain_energy']:.3f}", f"{OWN_PROGRAM[thickness]:.3f}" if thickness in OWN_PROGRAM else "",
                products(run)]
    return cells


# docs/design/sparse_matrices.md
def random_deck(seed, number):
    def make(directory):
        import generate

        return next(iter(generate.random_decks(seed, 1, directory, first=number))) / "deck.yaml"
    return Deck("", (), make=make)


# docs/design/multipliers.md
def pressures(*runs):
    """The least and the largest pressure at a node, where 10 is right."""
    result = []
    for run in runs:
        points = run.points()
        axis = 2 if np.abs(points.forces[:, 2]).max() > 0 else 1
        pressure = np.abs(points.forces[:, axis]) / points.areas
        result.append("10" if np.abs(pressure - 10).max() < 1e-8 else f"{pressure.min():.2f} to {pressure.max():.2f}")
    return result


NODE_TO_SEGMENT = "contacts[0].discretization=node_to_segment"
QUADS = ("mesh.blocks.lower.element=quad4",)


# docs/design/contacts_without_names.md
def found(run):
    """Where contacts are named there are two of all rollers, else two a roller."""
    contacts = run.summary["contacts"]
    force = max(np.linalg.norm(contact["force"]) for contact in contacts) if len(contacts) > 2 else roller_forces.by_angle(run.directory, 16)[0].sum(axis=0).max()
    return [len(contacts), f"{force:,.0f}", products(run)]


TABLES = [
    Table(page("active_sets"), "face Newton and auto", ["deck", "unknowns", "face Newton", "`auto`"],
          [Row((f"`inputs/{name}`",), tuple(inputs(name, "solver.tolerance=1e-6", algorithm(a)) for a in ("face_newton", "auto")))
           for name in ("cantilever_2d", "hertz_cylinder", "press_fit", "roller_bearing", "hertz_sphere")], by_either),
    Table(page("direct_solution"), "direct", ["deck in `regression`", "unknowns", "face Newton", "`direct`", "`auto`"],
          [Row((f"`{name}`",), tuple(case(name, algorithm(a), at_most(1000), may_fail=True) for a in DIRECT_ALGORITHMS)) for name in DIRECT],
          lambda *runs: [unknowns(runs[1]), *map(products, runs)]),
    Table(page("preconditioner"), "lumped or Dirichlet", ["deck", "none", "lumped", "Dirichlet"],
          [Row((f"`{deck.path.replace('/' + deck.path.split('/')[1] + '.yaml', '')}`",),
               tuple(Deck(deck.path, (algorithm("face_newton"), f"solver.preconditioner={kind}", at_most(1000)), may_fail=True)
                     for kind in ("none", "lumped", "dirichlet")))
           for deck in (inputs("cantilever_2d"), inputs("hertz_cylinder"), inputs("press_fit"), inputs("roller_bearing"), case("cases/rubber_block.yaml"),
                        case("hard/decks/ratio_checkerboard.yaml"))], preconditioned),
    Table(page("preconditioner"), "size of subdomains", ["unknowns a subdomain", "lumped", "Dirichlet"],
          [Row((name,), (clamp("lumped", decomposition), clamp("dirichlet", decomposition)))
           for name, decomposition in (*((f"{n:,}", f"unknowns_per_subdomain: {n}") for n in (250, 500, 1000, 4000)), ("a subdomain for each body", "subdomains: 1"))],
          preconditioned),
    Table(page("clusters"), "clusters", ["deck", "subdomains in a cluster", "subdomains", "products"],
          [*(Row((name, str(size) if size > 1 else "1 (TFETI)"), (deck(algorithm("face_newton"), f"decomposition.subdomains_per_cluster={size}"),))
             for name, deck, sizes in CLUSTERS for size in sizes),
           Row(("the same press fit, a subdomain for each body", "1 (TFETI)"), (case("verification/decks/press_fit_axisymmetric.yaml", *RINGS, algorithm("face_newton")),))],
          clustered, keys=2),
    Table(page("single_precision"), "single precision", ["cubes", "unknowns", "CPU time, single over double", "time of a product", "MB, double / single",
                                                         "products", "change of the energy"],
          [Row((f"n = {n}",), (cubes(n, "double"), cubes(n, "single"))) for n in (28, 40)], in_single_precision),
    Table(page("moments"), "moments", ["n", "bonded", "Coulomb's law, sticking"],
          [Row((str(n),), (ring(n, "contacts[0].friction={bonded: true}", "contacts[0].interference=0"), ring(n)), cells=lost(n)) for n in (4, 6, 8)]),
    Table(page("narrow_contacts"), "a ball between nodes", ["force", *(f"u = {depth}" for depth in DEPTHS)],
          [Row((name,), tuple(ball(depth, cells, x) for depth in DEPTHS))
           for name, cells, x in (("40 x 40 x 16 cells", [40, 40, 16], 1), ("n = 5, in the middle", [5, 5, 4], 1), ("n = 5, beside it", [5, 5, 4], 1.1))],
          normal_force(2)),
    Table(page("narrow_contacts"), "a coarse bearing", ["multipliers on; size of cells", *(f"{a}, {b}" for a, b in BEARING_CELLS)],
          [Row(("races",), tuple(coarse_bearing(cells) for cells in BEARING_CELLS)), Row(("rollers",), tuple(coarse_bearing(cells, *ON_ROLLERS) for cells in BEARING_CELLS))],
          inner_race),
    Table(page("slender_bodies"), "a thin gasket", ["T", "difference", "energy", "own program", "products"],
          [Row((str(t),), (case("cases/thin_gasket.yaml", f"mesh.blocks.gasket.size=[9,{t}]", f"mesh.blocks.gasket.origin=[21,-{t}]"),), cells=gasket(t))
           for t in (0.2, 0.1, 0.05, 0.03, 0.01, 0.002)]),
    Table(page("sparse_matrices"), "plates", ["plates of `regression/population`, Coulomb's law", "unknowns", "products of `auto`"],
          [Row((f"{element}: seed 24141290, deck {number}",), (random_deck(24141290, number),)) for element, number in (("quad4", 91), ("hex20", 77))],
          lambda run: [unknowns(run), products(run)]),
    Table(page("multipliers"), "constant pressure", ["meshes that do not match", "mortar", "node to segment"],
          [Row((name,), (case(deck, *more), case(deck, *more, NODE_TO_SEGMENT)))
           for name, deck, more in (("hex8 on hex8", "cases/patch_hex.yaml", ()), ("hex20 on tet10", "cases/patch_hex20_tet10.yaml", ()),
                                    ("quad4 on quad4, plane strain", "cases/patch_plane_strain.yaml", QUADS))], pressures),
    Table(page("contacts_without_names"), "found", ["`inputs/roller_bearing`", "contacts", "most loaded roller, N", "products"],
          [Row(("named",), (inputs("roller_bearing", "solver.tolerance=1e-6"),)), Row(("found",), (inputs("roller_bearing", "solver.tolerance=1e-6", "contacts=auto"),))],
          found),
]

if __name__ == "__main__":
    sys.exit(main(TABLES, __doc__))
