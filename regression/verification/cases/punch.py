"""Punches a million times stiffer than the block: flat, and flat with rounded edges."""

import numpy as np

import formulas
from cases.common import DECKS, Case, Mesh, Quantity, by_x, constants, difference, plot_pressure

MODULUS = formulas.pair_modulus(1e9, 0.3, 1e3, 0.3)
LOAD = 2.0  # of the whole punch

# Rounded: flat to b, radius R; a from the load.
FLAT, RADIUS = 0.5, 20
ROUNDED_A = 0.8
ROUNDED_LOAD = formulas.rounded_punch_force(ROUNDED_A, FLAT, RADIUS, MODULUS)


def inner(x, p, exact, areas, limit):
    inside = x < limit
    return difference(p[inside], exact[inside], areas[inside])


def flat(result, mesh):
    x, p, areas = by_x(result)
    exact = formulas.flat_punch(np.minimum(x, 0.999), 1, LOAD)
    return {
        "pressure, x < 0.9 a": inner(x, p, exact, areas, 0.9),
        "p in the middle": (p[0], LOAD / np.pi),
        "force": (result.summary["contacts"][0]["force"][1], -LOAD / 2),
    }


def rounded(result, mesh):
    x, p, areas = by_x(result)
    exact = formulas.rounded_punch_pressure(x, ROUNDED_A, FLAT, RADIUS, MODULUS)
    places = np.linspace(0, ROUNDED_A, 20001)
    pressure = formulas.rounded_punch_pressure(places, ROUNDED_A, FLAT, RADIUS, MODULUS)
    mean = np.trapz(places**2 * pressure, places) / np.trapz(pressure, places)
    return {
        "pressure": difference(p, exact, areas),
        "p in the middle": (p[0], formulas.rounded_punch_pressure(0, ROUNDED_A, FLAT, RADIUS, MODULUS)),
        "mean of x^2": (np.sum(areas * p * x**2) / np.sum(areas * p), mean),
        "force": (result.summary["contacts"][0]["force"][1], -ROUNDED_LOAD / 2),
    }


SIZES = (0.1, 0.05, 0.025, 0.0125)
CASES = [
    Case(
        "flat_punch",
        "Rigid flat punch on a half-plane",
        "Johnson (1985), (2.64)",
        DECKS / "punch.yaml",
        [Mesh(f"h = {h}", h, constants(h=h) + [f"loads[0].force=[0, {-LOAD / 2}]"]) for h in SIZES],
        [Quantity("pressure, x < 0.9 a", 0.18, 1, floor=0.003), Quantity("p in the middle", 0.07, 1, floor=0.003), Quantity("force", 1e-7)],
        flat,
        lambda axes, runs: plot_pressure(axes, runs, lambda x: formulas.flat_punch(np.minimum(x, 0.995), 1, LOAD), 1.0),
    ),
    Case(
        "rounded_punch",
        "Rigid punch with rounded edges on a half-plane",
        "Ciavarella, Hills and Monno (1998)",
        DECKS / "punch.yaml",
        [Mesh(f"h = {h}", h, constants(h=h, R=RADIUS, b=FLAT) + [f"loads[0].force=[0, {-ROUNDED_LOAD / 2}]"]) for h in SIZES],
        [
            Quantity("pressure", 0.15, 1),
            Quantity("p in the middle", 0.05, 1, floor=0.003),
            Quantity("mean of x^2", 0.05, 1, floor=0.003),
            Quantity("force", 1e-7),
        ],
        rounded,
        lambda axes, runs: plot_pressure(axes, runs, lambda x: formulas.rounded_punch_pressure(x, ROUNDED_A, FLAT, RADIUS, MODULUS), 1.0),
    ),
]
