#!/usr/bin/env python3
"""A lobed shaft in a lobed hub, of few faces a lobe: a cyclic sector gives what the whole ring does, wherever it is cut and whichever side is secondary.

    lobes.py MORTISE [--fine]

Radii 1 + depth cos(lobes theta + phase), 0.003 more of the shaft, which is held at radius 0.5 and the hub at 2; planes of symmetry at both ends. The energy
of a sector is that of the whole ring over their number to 2 %, and that of a fine mesh to what the table below says; --fine solves that mesh anew."""

import argparse
import sys

import numpy as np
from on_meshes import meshes, solved

OVERLAP, HEIGHT = 0.003, 0.3
FINE = ("hex20", 35, 25)
# Sectors, lobes, depth, phase; faces a sector of the shaft and of the hub; cell; energy of a sector of the fine mesh, and how far that of this one may be from it.
MODELS = [
    (3, 3, 0.05, 0.8, "hex20", 7, 5, 2.938e-3, 0.06), (3, 3, 0.10, 2.4, "hex20", 7, 5, 2.885e-3, 0.25), (3, 6, 0.02, 1.57, "hex20", 7, 5, 2.949e-3, 0.25),
    (3, 6, 0.05, 0.0, "hex20", 7, 5, 2.924e-3, 0.5), (8, 8, 0.05, 2.4, "hex20", 7, 5, 1.09e-3, 0.15), (2, 4, 0.02, 0.5, "hex20", 7, 5, 4.422e-3, 0.1),
    (4, 4, 0.05, 0.3, "tet10", 7, 5, 2.198e-3, 0.05), (4, 4, 0.05, 1.1, "prism15", 7, 5, 2.198e-3, 0.1), (3, 3, 0.05, 1.57, "hex8", 14, 10, 2.938e-3, 0.03),
    (4, 4, 0.05, 2.0, "hex8", 9, 14, 2.198e-3, 0.2),
]


def ring(inner, outer, names, faces, angle, whole, cell):
    def place(s, t, z):
        radius = inner(t) + (outer(t) - inner(t)) * s
        return [radius * np.cos(t), radius * np.sin(t), z]

    cuts = {} if whole else {"ymin": names[0] + "_start", "ymax": names[0] + "_end"}
    knots = [meshes.even(0, 1, 2), meshes.even(0, angle, faces), meshes.even(0, HEIGHT, 1)]
    return meshes.Body([meshes.Patch(knots, place, {"xmin": names[1], "xmax": names[2], "zmin": "ends", "zmax": "ends", **cuts})], cell)


def energy_of_sector(mortise, model, cell, faces, whole, secondary):
    sectors, lobes, depth, phase = model
    many = sectors if whole else 1
    angle = 2 * np.pi / sectors * many
    curve = lambda t: 1 + depth * np.cos(lobes * t + phase)
    round_it = lambda radius: lambda t: radius + 0 * t
    shaft = ring(round_it(0.5), lambda t: curve(t) + OVERLAP, ("shaft", "core", "rim"), faces[0] * many, angle, whole, cell)
    hub = ring(curve, round_it(2), ("hub", "bore", "outside"), faces[1] * many, angle, whole, cell)
    cuts = "" if whole else "".join(
        f"  - {{secondary: {body}_end, primary: {body}_start, friction: {{bonded: true}}, cyclic: {{axis: [0, 0, 1], angle: 360/{sectors}}}}}\n" for body in ("shaft", "hub"))
    text = f"""dimension: 3
mesh: {{file: mesh.msh}}
materials: {{steel: {{young_modulus: 1000, poisson_ratio: 0.3}}}}
bodies: {{shaft: {{material: steel}}, hub: {{material: steel}}}}
supports:
  - {{boundary: ends, displacement: {{z: 0}}}}
  - {{boundary: core, displacement: {{x: 0, y: 0}}}}
  - {{boundary: outside, displacement: {{x: 0, y: 0}}}}
contacts:
  - {{name: fit, secondary: {secondary}, primary: {"rim" if secondary == "bore" else "bore"}}}
{cuts}solver: {{tolerance: 1.0e-8}}
"""
    return solved(mortise, text, {"shaft": shaft, "hub": hub})["strain_energy"] / many


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--fine", action="store_true")
    arguments = parser.parse_args()
    wrong = 0
    for *model, cell, shaft, hub, stored, most in MODELS:
        if arguments.fine:
            stored = energy_of_sector(arguments.mortise, model, FINE[0], FINE[1:], False, "bore")
        for secondary in ("bore", "rim"):
            sector, whole = (energy_of_sector(arguments.mortise, model, cell, (shaft, hub), is_whole, secondary) for is_whole in (False, True))
            fails = abs(sector / whole - 1) > 0.02 or abs(sector / stored - 1) > most
            wrong += fails
            print(f"{'WRONG ' if fails else ''}{model} {cell} {shaft}:{hub}, secondary {secondary}: energy {sector:.4g}, of the whole {whole:.4g}, "
                  f"of a fine mesh {stored:.4g}, {sector / stored - 1:+.3f}", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
