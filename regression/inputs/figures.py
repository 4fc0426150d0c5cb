#!/usr/bin/env python3
"""The tables of figures in the pages of inputs/: which deck, with which settings, has which results.

    figures.py MORTISE [TABLE ...] [--row PATTERN] [--large] [--list] [--write]

Columns "formula" are computed here. Needs python3-h5py and python3-numpy. With --large also what takes more than 2 GB or three minutes; these
rows stay as they are otherwise. All others together take some three minutes of a processor.
"""
import math
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(HERE.parent), str(ROOT / "inputs/wind_bearing")]
import page_tables  # noqa: E402, F401: table_runs.py writes by it
import roller_forces  # noqa: E402
from table_runs import Deck, Row, Table, main  # noqa: E402

STEEL, ALUMINIUM, NU = 210e3, 70e3, 0.3


def page(name):
    return f"inputs/{name}/README.md"


def deck(name, *settings, **others):
    """Of inputs: "hertz_sphere" or "hertz_sphere/hertz_sphere_axisymmetric"."""
    folder, _, file = name.partition("/")
    return Deck(f"inputs/{folder}/{file or folder}.yaml", settings, **others)


def constants(**values):
    return [f"mesh.constants.{name}={value}" for name, value in values.items()]


def percent(found, exact):
    return f"{100 * (found / exact - 1):+.2f} %"


def effective(*moduli):
    """E* of two bodies of Poisson's ratio 0.3 [Johnson 1985, 4.21]."""
    return 1 / sum((1 - NU**2) / modulus for modulus in moduli)


# Hertz's line contact.
FORCE, R = 35e3, 50.0  # N/mm of the whole cylinder
LINE_A = math.sqrt(4 * FORCE * R / (math.pi * effective(STEEL, ALUMINIUM)))  # [4.43]
LINE_P0 = 2 * FORCE / (math.pi * LINE_A)


def line(run):
    points, contact = run.points(), run.summary["contacts"][0]
    force = points.forces[:, 1]
    a = 2 * math.sqrt(force @ points.places[:, 0] ** 2 / force.sum())  # of p0 sqrt(1 - x^2 / a^2)
    p0 = contact["max_recovered_pressure"]
    return [f"{run.unknowns:,}", f"{p0:.1f}", percent(p0, LINE_P0), f"{a:.3f}", percent(a, LINE_A)]


def cattaneo(run):
    """Half the summed length of the points that touch, and of those that stick, beside a and c = a sqrt(1 - Q / (mu P))."""
    points = run.points()
    p, q = abs(points.forces[:, 1].sum()), abs(points.forces[:, 0].sum())
    a = math.sqrt(4 * p * R / (math.pi * effective(STEEL, STEEL)))
    found = [points.areas[points.status > 0].sum() / 2, points.areas[points.status == 1].sum() / 2]
    exact = [a, a * math.sqrt(1 - q / (0.3 * p))]
    return [f"{p:.1f}", f"{q / (0.3 * p):.3f}", *(f"{e:.3f}, {f:.3f}" for e, f in zip(exact, found)), run.products]


# Hertz's point contact.
SPHERE = 3323.0
POINT_A = (3 * SPHERE * 10 / (4 * effective(STEEL, STEEL))) ** (1 / 3)  # [4.22]
POINT_P0 = 3 * SPHERE / (2 * math.pi * POINT_A**2)


def point(run):
    points, contact = run.points(), run.summary["contacts"][0]
    force = np.abs(points.forces[:, 2])
    a = math.sqrt(2.5 * (force @ (points.places[:, :2] ** 2).sum(axis=1)) / force.sum())
    p0 = [contact[key] for key in ("max_recovered_pressure", "max_pressure")]
    return [f"{run.unknowns:,}", *(f"{p:.0f}, {percent(p, POINT_P0)}" for p in p0), f"{a:.3f}, {percent(a, POINT_A)}"]


def revolution(run):
    contact = run.summary["contacts"][0]
    p0 = [contact[key] for key in ("max_recovered_pressure", "max_pressure")]
    return [f"{run.unknowns:,}", *(f"{p:.0f}, {percent(p, POINT_P0)}" for p in p0), run.products]


def lame(modulus, nu):
    """Pressure of an interference of 0.05 on the radius b between rings of radii a, b and b, c."""
    a, b, c = 25.0, 50.0, 100.0
    return 0.05 / b * modulus / ((c**2 + b**2) / (c**2 - b**2) + nu + (b**2 + a**2) / (b**2 - a**2) - nu)


PLANE_STRAIN, PLANE_STRESS = lame(STEEL / (1 - NU**2), NU / (1 - NU)), lame(STEEL, NU)


def fit(run):
    contact = run.summary["contacts"][0]
    p = [contact[key] for key in ("max_recovered_pressure", "max_pressure")]
    return [*(f"{value:.2f}, {percent(value, PLANE_STRAIN)}" for value in p), run.products]


def rings(run, exact):
    p = run.summary["contacts"][0]["max_recovered_pressure"]
    return [f"{exact:.2f}", f"{p:.2f}, {percent(p, exact)}"]


RINGS = "press_fit/press_fit_axisymmetric"
QUAD9 = ("mesh.blocks.shaft.element=quad9", "mesh.blocks.hub.element=quad9")
BOTH_ENDS = "supports=[" + ", ".join(f"{{boundary: {b}.{e}, displacement: {{y: 0}}}}" for b in ("shaft", "hub") for e in ("ymin", "ymax")) + "]"


# The fan wheel: one sector, and all nine of them bonded to each other.
def bonds():
    for i in range(1, 10):
        for body in ("wheel", "shaft"):
            yield f"{{secondary: {body}.{i}.cut_2, primary: {body}.{i % 9 + 1}.cut_1, friction: {{bonded: true}}}}"


WHOLE = [f"bodies.{body}.instances=[{{count: 9, rotate: {{axis: [0, 0, 1], angle: 40}}}}]" for body in ("shaft", "wheel")] + [
    "contacts=[{name: fit, secondary: wheel.*.bore, primary: shaft.*.seat, interference: 0.01, friction: {coulomb: 0.15}}, "
    + ", ".join(bonds()) + "]"]


def wheel(sectors):
    def cells(run, one):
        contact = run.summary["contacts"][0]
        return [f"{run.unknowns:,}", f"{run.seconds / one.seconds:.1f}", f"{run.summary['strain_energy'] / sectors:.3f}",
                f"{run.summary['max_displacement']:.4f}", f"{contact['max_recovered_pressure']:.1f}"]
    return cells


ONE_SECTOR = deck("fan_wheel")


def spread(values):
    """The least and the largest of forces that ought to be one."""
    low, high = (f"{round(value):,}" for value in (min(values), max(values)))
    return low if low == high else f"{low}-{high}"


def rollers(count):
    """Forces from the lowest roller up to that at 90 degrees, of both raceways and both sides, and the largest above."""
    def cells(run):
        sides = [side.sum(axis=0) for side in roller_forces.by_angle(run.directory, count)]
        quarter = count // 4
        return [*(spread([side[i] for side in sides] + [side[-i] for side in sides]) for i in range(quarter + 1)),
                f"at most {max(math.ceil(side[i]) for side in sides for i in range(quarter + 1, count - quarter)):.0f}"]
    return cells


ANGLES = ["angle", "0", "22.5", "45", "67.5", "90", "above"]


def wind(run):
    inner, outer = (side[0] for side in roller_forces.by_angle(run.directory, 35))
    assert np.abs(inner - outer).max() < 1e-6 * inner.max()
    return inner


def wind_forces(run):
    force = wind(run)
    mean = [0.5 * (force[i] + force[-i % 35]) for i in range(18)]
    return [*(f"{value:,.0f}" for value in mean[:9]), f"{mean[9]:,.0f}, then {max(map(abs, mean[10:])):,.0f}"]


def rigid_rings(run):
    """Q_max cos^(10/9) [Harris and Kotzalas 2006]."""
    return [*(f"{wind(run).max() * math.cos(2 * math.pi * i / 35) ** (10 / 9):,.0f}" for i in range(9)), "0"]


SLICE_FORCE, ROLLER, RACEWAYS = 20e3 / 32, 13.0, (170.0, -196.0)  # N/mm; radii


def slice_hertz():
    """(p0, a) of the roller on the inner raceway and in the outer one."""
    for raceway in RACEWAYS:
        a = math.sqrt(4 * SLICE_FORCE / (math.pi * effective(STEEL, STEEL) * (1 / ROLLER + 1 / raceway)))
        yield 2 * SLICE_FORCE / (math.pi * a), a


def slice_cells(run):
    contacts = run.summary["contacts"]
    return [", ".join(f"{contact['max_recovered_pressure']:.0f}" for contact in contacts), ", ".join(f"{contact['area']:.2f}" for contact in contacts)]


def slice_formula():
    hertz = list(slice_hertz())
    return [", ".join(f"{p0:.0f}" for p0, _ in hertz), ", ".join(f"{a:.3f}" for _, a in hertz)]


def sizes(run):
    s = run.summary
    return [s["subdomains"], f"{s['primal_unknowns']:,}", f"{s['dual_unknowns']:,}", run.products, f"{s['peak_memory_bytes'] / 1e9:.1f}"]


PAPERS_BEARING = constants(m=14, nri=8, nro=6, nz=12, nf=6, nh=4, na=12, nl=3, mp=10, mb=3, nc=4)

# The bolted bracket.
BRACKET = (deck("bolted_bracket"),)
PULL, ARM, TO_THE_EDGE, BOLT = 2e3, 60.0, 35.0, 20e3


def newtons(value):
    return f"{value:,.0f} N"


def bracket(what):
    joint, head, bolt = range(3)
    first = lambda run, contact: run.summary["steps"][0]["contacts"][contact]
    last = lambda run, contact: run.summary["contacts"][contact]
    return {
        "tightened": lambda run: [f"{newtons(first(run, joint)['force'][2])} and {newtons(first(run, head)['force'][2])}"],
        "friction": lambda run: [f"{newtons(last(run, joint)['force'][0])} in the joint, {newtons(-last(run, head)['force'][0])} through the head"],
        "tips": lambda run: [f"it stays; the area that touches falls from {first(run, joint)['area']:.0f} to {last(run, joint)['area']:.0f} mm2"],
        "bolt": lambda run: [newtons(last(run, bolt)["preload"]["force"])],
        "support": lambda run: [f"{newtons(run.summary['reactions'][0]['force'][0])}, {run.summary['reactions'][0]['moment'][1] / 1e3:,.0f} N m"],
        "stress": lambda run: [f"{run.summary['max_von_mises']:.0f} MPa, at the edge under the head; it has no radius, so that this grows with a finer mesh"],
    }[what]


# The arch supports.
def clamp(index):
    return lambda run: [f"{abs(run.summary['contacts'][index]['force'][1]) / 1e3:.1f}", f"{abs(run.summary['contacts'][index]['force'][2]) / 1e3:.2f}",
                        run.products if index == 0 else ""]


def yielding(run):
    s = run.summary
    return [s["subdomains"], f"{run.unknowns:,}", *(step["hessian_multiplications"] for step in s["steps"]), f"{s['peak_memory_bytes'] / 1e9:.1f}"]


def yielding_forces(run):
    ears = [step["contacts"][0] for step in run.summary["steps"]]
    bolts = [contact["preload"] for contact in run.summary["contacts"][5:]]
    return [*(f"{abs(state['force'][1]) / 1e3:.1f}" for state in ears), f"{abs(ears[1]['force'][2]) / 1e3:.1f}",
            spread([bolt["force"] for bolt in bolts]), f"{np.mean([bolt['shortening'] for bolt in bolts]):.3f}"]


CLAMP_BONDED = tuple(f"contacts[{i}].friction={{bonded: true}}" for i in range(5))

TABLES = [
    Table(page("hertz_cylinder"), "line contact", ["h at the contact", "unknowns", "p0, recovered", "error", "a, from the second moment of the forces", "error"],
          [Row((str(h),), (deck("hertz_cylinder", *constants(h=h)),)) for h in (0.8, 0.4, 0.2, 0.1)], line),
    Table(page("hertz_cylinder"), "Cattaneo and Mindlin", ["h at the contact", "P, N/mm", "Q/(0.3 P)", "a: formula, found", "c: formula, found", "products"],
          [Row((str(h),), (deck("hertz_cylinder/cattaneo_mindlin", *constants(h=h)),)) for h in (0.2, 0.1, 0.05)], cattaneo),
    Table(page("hertz_sphere"), "point contact", ["h at the contact", "unknowns", "p0, recovered", "p0 at a node", "a, from the second moment of the forces"],
          [Row((str(h),), (deck("hertz_sphere", *constants(h=h)),)) for h in (0.2, 0.1, 0.05)], point),
    Table(page("hertz_sphere"), "body of revolution", ["order of the cells", "h at the contact", "unknowns", "p0, recovered", "p0 at a node", "products"],
          [Row((str(order), str(h)), (deck("hertz_sphere/hertz_sphere_axisymmetric", *constants(h=h, order=order)),))
           for order, h in ((1, 0.1), (1, 0.05), (1, 0.025), (1, 0.0125), (2, 0.1), (2, 0.05))], revolution, keys=2),
    Table(page("press_fit"), "press fit", ["order of the cells", "cells across a ring", "largest pressure, recovered, MPa", "at a node", "products"],
          [Row((str(order), str(n)), (deck("press_fit", *constants(n=n, order=order)),))
           for order, n in ((1, 8), (1, 16), (1, 32), (2, 4), (2, 8), (2, 16))], fit, keys=2),
    Table(page("press_fit"), "rings", ["ends", "cells", "formula, MPa", "largest pressure, recovered"],
          [Row(("free", "quad4"), (deck(RINGS),), cells=lambda run: rings(run, PLANE_STRESS)),
           Row(("free", "quad9"), (deck(RINGS, *QUAD9),), cells=lambda run: rings(run, PLANE_STRESS)),
           Row(("both held", "quad4"), (deck(RINGS, BOTH_ENDS),), cells=lambda run: rings(run, PLANE_STRAIN))], keys=2),
    Table(page("fan_wheel"), "fan wheel", ["model", "unknowns", "CPU time, of the first row's", "strain energy of a sector, N mm", "largest displacement, mm",
                                           "pressure in the joint, recovered, MPa"],
          [Row(("one sector",), (ONE_SECTOR, ONE_SECTOR), cells=wheel(1)),
           Row(("nine sectors, bonded to each other",), (deck("fan_wheel", *WHOLE), ONE_SECTOR), cells=wheel(9)),
           Row(("one sector, tolerance 1e-6",), (deck("fan_wheel", "solver.tolerance=1e-6"), ONE_SECTOR), cells=wheel(1)),
           Row(("one sector, h = 2.5",), (deck("fan_wheel", *constants(h=2.5)), ONE_SECTOR), cells=wheel(1))]),
    Table(page("roller_bearing"), "rollers", ANGLES, [Row(("force, N",), (deck("roller_bearing"),))], rollers(16)),
    Table(page("bearing_boundary"), "rollers of boundary elements", ANGLES, [Row(("force, N",), (deck("bearing_boundary"),))], rollers(16)),
    Table(page("bolted_bracket"), "bracket", ["by hand", "what comes out"],
          [Row((f"joint and head carry the bolt's force of {BOLT:,.0f} N",), BRACKET, cells=bracket("tightened")),
           Row((f"the pull leaves the joint by friction, of {0.2 * BOLT:,.0f} N at most",), BRACKET, cells=bracket("friction")),
           Row((f"its moment, 2 kN x {ARM:.0f} mm, tips the bracket about its edge, {TO_THE_EDGE:.0f} mm from the bolt, only below a preload of "
                f"{PULL * ARM / TO_THE_EDGE:,.0f} N",), BRACKET, cells=bracket("tips")),
           Row(("a preloaded bolt feels little of a load across it",), BRACKET, cells=bracket("bolt")),
           Row((f"the plate's support: {PULL:,.0f} N, and 2 kN x 80 mm = {PULL * 80 / 1e3:.0f} N m about the y axis",), BRACKET, cells=bracket("support")),
           Row(("largest von Mises stress",), BRACKET, cells=bracket("stress"))]),
    Table(page("cantilever_2d"), "cantilevers", ["solver", "products at 1e-4", "sum of the contact forces in y"],
          [Row((f"`{name}`",), (deck("cantilever_2d", f"solver.algorithm={name}"),),
               cells=lambda run: [run.products, f"{run.summary['contacts'][0]['force'][1]:.3f}"]) for name in ("auto", "face_newton", "smalse")]),
    Table(page("clamp_joint"), "clamp joint", ["contact", "presses with, kN", "along the axis, kN", "products at 1e-4"],
          [Row((name,), (deck("clamp_joint"),), cells=clamp(i)) for i, name in enumerate(("ears", "bars", "yokes under the ears", "yokes over the bars"))]),
    Table(page("yielding_clamp"), "yielding clamp", ["pull, kN; size", "ears press with, kN: tightened", "pulled", "they hand over, kN", "bolts, N", "shortening, mm"],
          [Row((f"{pull}; {size}",), (deck("yielding_clamp", *constants(size=size), f"loads[0].force=[0, 0, {pull}e3]"),))
           for pull, size in ((100, 1), (200, 0.6), (340, 0.6))], yielding_forces),
    Table(page("yielding_clamp"), "sizes of the clamp", ["size", "unknowns a subdomain", "subdomains", "unknowns", "products: first step", "second step", "GB"],
          [Row(("1", "500"), (deck("yielding_clamp"),)),
           Row(("1, all bonded", "500"), (deck("yielding_clamp", *CLAMP_BONDED),)),
           *(Row(("0.6", f"{n:,}"), (deck("yielding_clamp", *constants(size=0.6), f"decomposition.unknowns_per_subdomain={n}"),)) for n in (250, 500, 1000, 2000)),
           Row(("2", "500"), (deck("yielding_clamp", *constants(size=2), limit=3600),), large=True)], yielding, keys=2),
    Table(page("wind_bearing"), "forces on the rollers", ["angle from the bottom", *(f"{360 / 35 * i:.1f}" if i else "0" for i in range(9)), "above"],
          [Row(("force, N",), (deck("wind_bearing/half"),), cells=wind_forces), Row(("rigid rings",), (deck("wind_bearing/half"),), cells=rigid_rings)]),
    Table(page("wind_bearing"), "slice", ["h at the contacts", "p0 inner, outer, MPa", "half width inner, outer, mm"],
          [*(Row((str(h),), (deck("wind_bearing/slice", *constants(h=h)),), cells=slice_cells) for h in (0.04, 0.02)),
           Row(("Hertz, 20 kN on 32 mm",), (), cells=slice_formula)]),
    Table(page("wind_bearing"), "sizes of the bearing", ["deck", "subdomains", "primal unknowns", "dual unknowns", "products with F", "GB"],
          [Row(("`half.yaml`",), (deck("wind_bearing/half"),)), Row(("`wind_bearing.yaml`",), (deck("wind_bearing"),)),
           *(Row((f"the paper's size, `unknowns_per_subdomain={n}`",),
                 (deck("wind_bearing", *PAPERS_BEARING, f"decomposition.unknowns_per_subdomain={n}", limit=7200),), large=True) for n in (12500, 3040))], sizes),
]

if __name__ == "__main__":
    sys.exit(main(TABLES, __doc__))
