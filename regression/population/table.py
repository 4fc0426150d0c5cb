"""The decks of the table: fixed ones whose products are followed in time. Each has its own tolerance, 1e-6 if nothing is said."""

import math
import random

import numpy as np

import deck_files
import model
from meshes import even, graded
from model import bored, disc, sector, solid_cap

STEEL = 2.1e5


def start(kind, element, law="frictionless", mu=0.3, poisson=0.3, **more):
    """An empty model with nothing left to chance."""
    plan = {"family": "table", "kind": kind, "element": element, "other": element, "law": law, "mu": mu, "bound": 0.3, "poisson": poisson,
            "incompatible": False, "decades": 0, "fails": False, **more}
    made = model.Model(random.Random(0), plan, 1.0)
    made.modulus, made.sideways_free, made.both_faces = STEEL, False, False
    return made


def layer(element, along, layers, below):
    """A layer of thickness 1 on a half plane of the same material, pressed on |x| < 0.1: Keer, Dundurs and Tsai's receding contact."""
    m = start("plane_strain", element)
    strip, length, deep = 0.1, 20.0, 30.0
    line = np.concatenate([even(0, strip, 4), graded(strip, length, along - 4, 30)[1:]]) / length
    below_line = graded(0, 1, along, 60)
    sides = {"ymax": lambda s, t: "strip" if s < strip / length else None}
    m.block("layer", [0.0, 0.0], [length, 1.0], [1, 1], knots=[line, even(0, 1, layers)], sides=sides)
    m.block("base", [0.0, -deep], [1.5 * length, deep], [1, 1], knots=[below_line, graded(0, 1, below, 1 / 100)])
    m.hold("layer_left", x=0)
    m.hold("base_left", x=0)
    m.clamp("base_bottom")
    m.load("strip", pressure=100.0)
    m.pressed("layer_bottom", "base_top", 1.0)
    return m


def pushed(element, cells, mu, driven):
    """A block one cell thick on a rigid plane, half of it, pressed from above; pushed at its free side towards the plane of symmetry, or away
    from this one, which moves."""
    m = start(3, element, "coulomb", mu)
    m.both_faces, m.layers, m.depth = True, 1, 1.0 / cells
    m.block("block", [0.0, 0.0], [1.0, 1.0], [cells, cells])
    m.load("block_top", pressure=0.001 * STEEL)
    if driven:
        m.hold("block_left", x=0.0005)
    else:
        m.hold("block_left", x=0)
        m.load("block_right", pressure=0.002 * STEEL)
    m.pressed("block_bottom", m.plane_obstacle([0, 0], [0, 1]), 1.0)
    return m


def pin(element, eighth, along, layers):
    """Half a pin in a bore that is larger by 1e-4 of its radius, pulled down by its weight; the plate hangs from its upper edge."""
    m = start(3, element, "coulomb", 0.4)
    m.depth, m.layers = 0.5, layers
    gap = 1e-4
    m.add("pin", disc(1.0 - gap, (0.0, -gap), (eighth, along), {"cut": "pin_cut", "rim": "pin_face"}))
    m.materials["pin"]["density"] = 1.0
    m.loads.append({"body": "pin", "acceleration": [0.0, -1e-3 * STEEL, 0.0]})
    plate = eighth + 1
    m.add("plate", bored(1.0, 2.5, (plate, along + 4), {"bore": "bore", "cut": "plate_cut", "bottom": None, "right": None, "top": "lid"}))
    m.hold("pin_cut", x=0)
    m.hold("plate_cut", x=0)
    m.clamp("lid")
    m.pressed("pin_face", "bore", 1.0)
    return m


def crossed(element, across, high):
    """A quarter of two cylinders that cross at a right angle, pressed together by a motion."""
    m = start(3, element)
    wide = 0.4
    knots = lambda n: [graded(0, 1, n, 8), graded(0, 1, high, 8), graded(0, 1, n, 8)]
    sides = lambda name: {"xmin": f"{name}_left", "zmin": f"{name}_front", "ymin": f"{name}_face", "ymax": f"{name}_far"}
    m.add("upper", [solid_cap(1.0, ((0.0, wide), (0.0, wide)), 0.5, 1, knots(across), sides("upper"), (True, False))])
    m.add("lower", [solid_cap(1.0, ((0.0, wide), (0.0, wide)), 0.5, -1, knots(across - 2), sides("lower"), (False, True))])
    m.clamp("lower_far")
    for name in ("upper", "lower"):
        m.hold(f"{name}_left", x=0)
    m.hold("upper_far", y=-0.004)
    m.pressed("upper_face", "lower_face", 1.0)
    return m


def beam(element, cells):
    """A beam 20 times as long as high on a rigid plane, pressed down evenly and lifted at one end: half of it should stay down."""
    m = start("plane_strain", element)
    length, rise = 20.0, 0.2
    m.block("beam", [0.0, 0.0], [length, 1.0], [cells, 2], bend=True)
    m.boxes = False
    m.hold("beam_left", x=0)
    m.hold("beam_right", y=rise)
    m.load("beam_top", pressure=24 * STEEL / 0.91 / 12 * rise / (length / 2) ** 4)
    m.pressed("beam_bottom", m.plane_obstacle([0, 0], [0, 1]), 1.0)
    return m


def belt(element, cells, ends):
    """A belt round half a rigid drum, held at one end and drawn by a motion at the other; `ends`: whether the first and the last cell,
    which are held, may touch the drum."""
    m = start("plane_strain", element, "coulomb", 0.3, 0.0)
    knots = [even(0, 1, cells), even(0, 1, 2)]
    face = lambda s, t: "belt_face" if ends or 1 < s * cells < cells - 1 else None
    m.add("belt", [sector(1.0, 1.02, 0, 180, knots, {"xmin": "first", "xmax": "last", "ymin": face})], bend=True)
    m.clamp("first")
    m.clamp("last", y=-0.001 * math.pi)
    m.pressed("belt_face", m.cylinder_obstacle(1.0), 1.0)
    return m


def boxes(deck, tolerance, blocks, pressure, subdomains=None):
    """Two blocks on each other by the deck's own `blocks`, held at xmin and ymin and pressed from above."""
    names = list(blocks)
    deck.update({"title": "pressed blocks", "dimension": 3, "mesh": {"blocks": blocks}, "materials": {"steel": {"young_modulus": STEEL, "poisson_ratio": 0.3}},
                 "bodies": {name: {"material": "steel"} for name in names},
                 "supports": [{"boundary": f"{n}.{side}", "displacement": {axis: 0.0}} for n in names for side, axis in (("xmin", "x"), ("ymin", "y"))]
                 + [{"boundary": f"{names[0]}.zmin", "displacement": {"z": 0.0}}],
                 "loads": [{"boundary": f"{names[1]}.zmax", "pressure": pressure}],
                 "contacts": [{"name": "contact_1", "secondary": f"{names[1]}.zmin", "primary": f"{names[0]}.zmax"}],
                 "solver": {"tolerance": tolerance}})
    if subdomains:
        deck["decomposition"] = {"subdomains": subdomains}
    return deck


def plates(tolerance):
    block = lambda z, n: {"origin": [0.0, 0.0, z], "size": [400.0, 400.0, 1.0], "cells": [n, n, 2], "element": "hex8"}
    return boxes({}, tolerance, {"lower": block(0.0, 40), "upper": block(1.0, 32)}, 10.0)


def cubes():
    block = lambda z, n: {"origin": [0.0, 0.0, z], "size": [1.0, 1.0, 1.0], "cells": [n, n, n], "element": "hex8"}
    return boxes({}, 1e-4, {"lower": block(0.0, 29), "upper": block(1.0, 27)}, 10.0, 36)


def rows():
    """(name, function that makes a model or a deck, subdomains or None, preconditioner)."""
    for subdomains, preconditioner in ((2, "lumped"), (9, "lumped"), (9, "dirichlet"), (37, "lumped"), (124, "lumped")):
        yield f"layer_quad9_{subdomains}_{preconditioner}", lambda: layer("quad9", 160, 10, 18), subdomains, preconditioner
    for subdomains in (2, 9):
        yield f"layer_quad8_{subdomains}", lambda: layer("quad8", 119, 6, 13), subdomains, "lumped"
    for element, cells in (("hex20", 18), ("hex27", 14)):
        for mu in (0.1, 0.6):
            for driven in (False, True):
                name = f"pushed_{element}_mu{mu}_{'driven' if driven else 'side'}"
                yield name, lambda e=element, c=cells, mu=mu, d=driven: pushed(e, c, mu, d), None, "lumped"
    yield "pin_prism6", lambda: pin("prism6", 9, 8, 5), 4, "lumped"
    yield "pin_hex20", lambda: pin("hex20", 5, 5, 3), 4, "lumped"
    yield "crossed_hex8_35k", lambda: crossed("hex8", 20, 13), 14, "lumped"
    yield "crossed_hex8_128k", lambda: crossed("hex8", 31, 21), 14, "lumped"
    yield "crossed_hex20", lambda: crossed("hex20", 13, 8), 14, "lumped"
    for element, cells in (("quad4", (80, 966)), ("quad8", (30, 360)), ("quad9", (24, 290))):
        for n in cells:
            yield f"beam_{element}_{n}", lambda e=element, n=n: beam(e, n), None, "lumped"
    for element, cells in (("quad4", (116, 780)), ("quad8", (44, 292)), ("quad9", (35, 234))):
        for n in cells:
            yield f"belt_{element}_{n}", lambda e=element, n=n: belt(e, n, True), None, "lumped"
            yield f"belt_off_{element}_{n}", lambda e=element, n=n: belt(e, n, False), None, "lumped"
    yield "cubes_146k", cubes, None, None
    yield "plates_auto", lambda: plates("auto"), None, None
    yield "plates_1e-6", lambda: plates(1e-6), None, None


def from_model(made, subdomains, preconditioner, tolerance, name):
    plan = {**made.plan, "family": name, "preconditioner": preconditioner, "spread": 0.0, "grid": False}
    deck = deck_files.deck_of(made, plan, tolerance)
    deck.pop("decomposition")
    if subdomains:
        deck["decomposition"] = {"subdomains": subdomains}
    return deck


def decks(directory, tolerance=None, only=None):
    """Writes the decks of the table; yields their folders. A tolerance replaces their own."""
    for name, make, subdomains, preconditioner in rows():
        if not deck_files.chosen(name, only):
            continue
        made = make()
        expected = {"exit_status": 0, "family": name.split("_")[0], "preconditioner": preconditioner or "lumped"}
        if isinstance(made, dict):
            deck, bodies = made, {}
            blocks = deck["mesh"]["blocks"].values()
            expected.update({"element": "hex8", "law": "frictionless", "kind": 3,
                             "unknowns": sum(3 * math.prod(c + 1 for c in b["cells"]) for b in blocks), "reference": False})
            if tolerance is not None:
                deck["solver"]["tolerance"] = tolerance
        else:
            deck, bodies = from_model(made, subdomains, preconditioner, tolerance or 1e-6, name), made.bodies
            expected.update({"element": made.plan["element"], "law": made.law, "kind": made.kind, "unknowns": made.unknowns(), "reference": False})
        deck_files.write(directory / name, deck, bodies, {}, expected)
        yield directory / name
