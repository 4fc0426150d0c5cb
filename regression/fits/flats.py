#!/usr/bin/env python3
"""Two blocks upon each other along flats that meet at angles, pressed from above, with walls beside: a uniform strain, whatever faces the flats have.

    flats.py MORTISE

A face beside an edge that is taken for a curve stands back, or out. Friction of 2 sticks: then the energy is that of the uniform strain to 1e-3, and the largest
recovered pressure, that of a level flat, is right to 15 %, whichever side is secondary."""

import argparse
import sys

import numpy as np
from on_meshes import meshes, solved

YOUNG, POISSON, PRESSURE, LENGTH, HEIGHT, DEPTH = 1e5, 0.3, 5, 6, 6, 1
OEDOMETER = YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON))
BEND = [(0, 0), (3, 0), (6, 3)]
ROOF = [(0, 0), (2, 2), (4, 0), (6, 0)]
# The flats, at slopes of one; lengths of the lower faces on each flat, of the upper ones; degrees and cells.
MODELS = [(BEND, ([1, 2], [1, 1]), ([1] * 7, [1] * 8), (2, 10, 25), ("quad4", "hex8", "prism6", "quad8", "tet10")),
          (BEND, ([1, 3, 8], [8, 3, 1]), ([1] * 7, [1] * 8), (5, 30), ("quad4", "tri3", "quad8")),
          (BEND, ([1, 2, 3], [1]), ([1] * 7, [1] * 2), (5, 20), ("quad4", "hex8", "quad8")),
          (ROOF, ([1, 1], [8, 1], [1, 8]), ([1] * 3, [1] * 3, [1] * 5), (1, 15), ("quad4", "tet4", "hex20"))]


def blocks(flats, lower, upper, degrees, cell):
    corners, heights = np.transpose(flats)
    profile = lambda x: 3 + np.tan(np.radians(degrees)) * np.interp(x, corners, heights)

    def body(name, lengths, bottom, top):
        parts = [low + (high - low) * np.cumsum([0, *faces]) / sum(faces) for low, high, faces in zip(corners, corners[1:], lengths)]
        knots = [np.unique(np.concatenate(parts).round(12)), meshes.even(0, 1, 3)]
        place = lambda x, s: [x, (1 - s) * bottom(x) + s * top(x)]
        plane = meshes.Patch(knots, place, {"ymin": f"{name}_bottom", "ymax": f"{name}_top", "xmin": "walls", "xmax": "walls"})
        return meshes.Body([meshes.extruded(plane, meshes.even(0, DEPTH, 2), "faces", "faces") if cell in meshes.SOLID else plane], cell)

    level = lambda y: lambda x: y + 0 * x
    return {"lower": body("lower", lower, level(0), profile), "upper": body("upper", upper, profile, level(HEIGHT))}


def solve(mortise, model, secondary):
    """Strain energy and the largest recovered pressure."""
    bodies = blocks(*model)
    solid = model[-1] in meshes.SOLID
    summary = solved(mortise, f"""dimension: {3 if solid else "plane_strain"}
mesh: {{file: mesh.msh}}
materials: {{steel: {{young_modulus: {YOUNG}, poisson_ratio: {POISSON}}}}}
bodies: {{lower: {{material: steel}}, upper: {{material: steel}}}}
supports:
  - {{boundary: lower_bottom, displacement: {{y: 0}}}}
  - {{boundary: walls, displacement: {{x: 0}}}}
{"  - {boundary: faces, displacement: {z: 0}}" if solid else ""}
loads: [{{boundary: upper_top, pressure: {PRESSURE}}}]
contacts: [{{secondary: {secondary}, primary: {"lower_top" if secondary == "upper_bottom" else "upper_bottom"}, friction: {{coulomb: 2}}}}]
solver: {{tolerance: 1.0e-8}}
""", bodies)
    return summary["strain_energy"], summary["contacts"][0]["max_recovered_pressure"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    arguments = parser.parse_args()
    right = PRESSURE**2 / OEDOMETER / 2 * LENGTH * HEIGHT
    wrong = 0
    for flats, lower, upper, angles, cells in MODELS:
        for degrees in angles:
            for cell in cells:
                for secondary in ("lower_top", "upper_bottom"):
                    energy, pressure = solve(arguments.mortise, (flats, lower, upper, degrees, cell), secondary)
                    fails = abs(energy / right - 1) > 1e-3 or abs(pressure / PRESSURE - 1) > 0.15
                    wrong += fails
                    print(f"{'WRONG ' if fails else ''}{len(flats) - 1} flats, {degrees} degrees, {cell}, {lower} on {upper}, secondary {secondary}: "
                          f"energy {energy:.6g} of {right:.6g}, pressure {pressure:.4g} of {PRESSURE}", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
