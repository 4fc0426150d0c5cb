#!/usr/bin/env python3
"""Two arcs that meet at an angle, in a strip and in its counterpart: an edge between curved parts is an edge, inside a body, one face from
its end, at a seam and in a plane of symmetry.

    kinks.py MORTISE

Profile -x^2 / (2 R) - tan(angle / 2) |x| for -1 <= x <= 1, R = 3, or from -0.3, where one face ends; the strips reach 1.5 below and 1 above it, plane strain,
and press by an interference of 1e-3 all over. The energy is that of a fine mesh to 4 %, and the largest pressure that of flat strips to 15 %, or to 30 % where a
wall is near, which arcs meet at an angle, too; 6 % and 60 % by cells of first order. Whichever side is secondary."""

import argparse
import sys

import numpy as np
from on_meshes import meshes, solved

RADIUS, INTERFERENCE, DEPTH = 3, 1e-3, 0.25
YOUNG, POISSON = 210000, 0.3
FLAT = YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON)) * INTERFERENCE / 2.5
WHERE = {"inside": [(-1, 1)], "beside": [(-0.3, 1)], "seam": [(-1, 0), (0, 1)], "symmetry": [(0, 1)]}
FINE = ("quad8", 32, 24)
# Angle in degrees; cell; faces a unit of length of the lower and of the upper strip.
MODELS = [(3, "quad8", 4, 3), (8, "quad8", 4, 3), (8, "tri6", 3, 4), (15, "quad8", 3, 4), (30, "tri6", 4, 3), (8, "hex20", 4, 3), (8, "tet10", 3, 4), (15, "prism15", 4, 3),
          (15, "hex27", 3, 4), (8, "quad4", 3, 4), (20, "tri3", 6, 8), (15, "hex8", 3, 4), (26, "tet4", 6, 8), (15, "prism6", 8, 6)]
FIRST_ORDER = ("quad4", "tri3", "hex8", "tet4", "prism6")


def strips(angle, cell, lower, upper, where):
    solid = cell in meshes.SOLID
    profile = lambda x: -x * x / (2 * RADIUS) - np.tan(np.radians(angle / 2)) * np.abs(x)

    def patch(low, high, faces, bottom, height, names):
        place = lambda x, s: [x, (1 - s) * bottom(x) + s * height(x)]
        along = meshes.even(low, high, round(faces * (high - low)))
        if where == "beside":
            along = np.concatenate([meshes.even(low, 0, 1 if faces < FINE[2] else faces // 3)[:-1], meshes.even(0, high, faces)])
        knots = [along, meshes.even(0, 1, faces)]
        sides = {"ymin": names[0], "ymax": names[1], "xmin": "walls" if low < 0 or where == "symmetry" else names[2], "xmax": "walls" if high == 1 else names[3]}
        plane = meshes.Patch(knots, place, sides)
        return meshes.extruded(plane, meshes.even(0, DEPTH, 1), "front", "front") if solid else plane

    flat = lambda y: lambda x: y + 0 * x
    parts = WHERE[where]
    bodies = {}
    for k, (low, high) in enumerate(parts):
        bodies[f"lower{k}"] = meshes.Body([patch(low, high, lower, flat(-1.5), profile, ("base", "ridge", f"lower_seam{k}", f"lower_seam{k}"))], cell)
        bodies[f"upper{k}"] = meshes.Body([patch(low, high, upper, profile, flat(1), ("groove", "top", f"upper_seam{k}", f"upper_seam{k}"))], cell)
    return bodies


def solve(mortise, model, where, secondary):
    """Energy of both halves over the depth, and the largest pressure."""
    angle, cell, lower, upper = model
    solid = cell in meshes.SOLID
    bodies = strips(angle, cell, lower, upper, where)
    seams = "".join(f"  - {{secondary: {side}_seam0, primary: {side}_seam1, friction: {{bonded: true}}}}\n" for side in ("lower", "upper")) if where == "seam" else ""
    text = f"""dimension: {3 if solid else "plane_strain"}
mesh: {{file: mesh.msh}}
materials: {{steel: {{young_modulus: {YOUNG}, poisson_ratio: {POISSON}}}}}
bodies: {{{", ".join(f"{name}: {{material: steel}}" for name in bodies)}}}
supports:
  - {{boundary: base, displacement: {{x: 0, y: 0}}}}
  - {{boundary: top, displacement: {{x: 0, y: 0}}}}
  - {{boundary: walls, displacement: {{x: 0}}}}
{"  - {boundary: front, displacement: {z: 0}}" if solid else ""}
contacts:
  - {{name: edge, secondary: {secondary}, primary: {"ridge" if secondary == "groove" else "groove"}, interference: {INTERFERENCE}}}
{seams}solver: {{tolerance: 1.0e-8}}
"""
    summary = solved(mortise, text, bodies)
    energy = summary["strain_energy"] * (2 if where == "symmetry" else 1) / (DEPTH if solid else 1)
    return energy, max(c["max_recovered_pressure"] for c in summary["contacts"] if c["name"] == "edge")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    arguments = parser.parse_args()
    wrong = 0
    fine = {}
    for angle, cell, lower, upper in MODELS:
        for where in ("beside", "symmetry"):
            if (angle, where) not in fine:
                fine[angle, where], _ = solve(arguments.mortise, (angle, *FINE), where, "groove")
        for where in WHERE:
            for secondary in ("ridge", "groove"):
                energy, pressure = solve(arguments.mortise, (angle, cell, lower, upper), where, secondary)
                right, peak = (fine[angle, "beside"], 0.3) if where == "beside" else (fine[angle, "symmetry"], 0.15)
                energy_off, pressure_off = (0.06, 0.6) if cell in FIRST_ORDER else (0.04, peak)
                fails = abs(energy / right - 1) > energy_off or abs(pressure / FLAT - 1) > pressure_off
                wrong += fails
                print(f"{'WRONG ' if fails else ''}{angle} degrees {cell} {lower}:{upper}, {where}, secondary {secondary}: energy {energy:.4g} of {right:.4g}, "
                      f"pressure {pressure:.4g} of {FLAT:.4g}", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
