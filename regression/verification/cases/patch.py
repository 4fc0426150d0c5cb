"""Patch tests of contact: all pairs of faces, both sides secondary, flat, inclined and curved interfaces."""

import functools

import numpy as np

import meshes
from cases.common import DECKS, Case, Mesh, Quantity

PLANE = ("tri3", "quad4", "tri6", "quad8", "quad9")
SOLID = ("hex8", "tet4", "prism6", "hex20", "hex27", "tet10", "prism15", "prism18")


def uniform(stress, energy, result, mesh):
    """Largest difference of the stress, of the pressure anywhere, and the energy."""
    return {
        "stress": np.abs(result.solution.fields["stress"] - stress).max() / 10,
        "pressure": np.abs(result.contact.fields["contact_pressure"] - 10).max() / 10,
        "energy": (result.summary["strain_energy"], energy),
    }


def exact(order=None, bounds=(1e-9, 1e-9, 1e-9)):
    return [Quantity(name, bound, order) for name, bound in zip(("stress", "pressure", "energy"), bounds)]


def pairs(name, kinds, deck, axis, stress, energy, quick):
    found = []
    for lower in kinds:
        for upper in kinds:
            for secondary, primary in ((f"lower.{axis}max", f"upper.{axis}min"), (f"upper.{axis}min", f"lower.{axis}max")):
                found.append(
                    Mesh(
                        f"{lower} under {upper}, {secondary.split('.')[0]} secondary",
                        1,
                        [
                            f"mesh.blocks.lower.element={lower}",
                            f"mesh.blocks.upper.element={upper}",
                            f"contacts[0].secondary={secondary}",
                            f"contacts[0].primary={primary}",
                        ],
                    )
                )
    return Case(
        name,
        f"Patch test, {len(kinds)} x {len(kinds)} pairs of cells, both sides secondary",
        "Taylor and Papadopoulos (1991): uniform stress is exact",
        DECKS / deck,
        found,
        exact(),
        functools.partial(uniform, stress, energy),
        quick=quick,
    )


HYDROSTATIC = np.array([-10, -10, -6, 0, 0, 0])
HYDROSTATIC_ENERGY = 100 * (1 + 0.3) * (1 - 2 * 0.3) / 1000  # plane strain: (1 + nu) (1 - 2 nu) p^2 / E an area


def mapped(name, title, curve, order_of_error, bounds, sizes):
    found = []
    for element in (1, 2):
        for sides in (("lower_top", "upper_bottom"), ("upper_bottom", "lower_top")):
            for n in sizes:
                found.append(
                    Mesh(
                        f"{'quad4' if element == 1 else 'quad9'}, {sides[0]} secondary, n = {n}",
                        1 / n,
                        [f"contacts[0].secondary={sides[0]}", f"contacts[0].primary={sides[1]}"],
                        generate=functools.partial(meshes.cut_square, n=n, order=element, curve=curve),
                    )
                )
    return Case(
        name,
        f"Patch test, {title}",
        "Exact: pressure 10 all round",
        DECKS / "patch_mapped.yaml",
        found,
        exact(order_of_error, bounds),
        functools.partial(uniform, HYDROSTATIC, HYDROSTATIC_ENERGY),
    )


def curved(element, secondary):
    """Nodes exactly on the curve, but facets that cut through it: the error is that of the geometry."""
    sides = ("lower_top", "upper_bottom") if secondary == "lower" else ("upper_bottom", "lower_top")
    order = 1 if element == "quad4" else 2
    found = [
        Mesh(
            f"n = {n}",
            1 / n,
            [f"contacts[0].secondary={sides[0]}", f"contacts[0].primary={sides[1]}"],
            generate=functools.partial(meshes.cut_square, n=n, order=order, curve=lambda x: 0.4 + 0.15 * np.sin(np.pi * x)),
        )
        for n in (4, 8, 16, 32)
    ]
    return Case(
        f"patch_curved_{element}_{secondary}",
        f"Patch test, curved interface, {element}, {secondary} side secondary",
        "Exact: pressure 10 all round",
        DECKS / "patch_mapped.yaml",
        found,
        exact(2, (0.8, 0.5, 0.06) if element == "quad4" else (0.2, 0.15, 0.002)),
        functools.partial(uniform, HYDROSTATIC, HYDROSTATIC_ENERGY),
    )


CASES = [
    pairs("patch_2d", PLANE, "patch_2d.yaml", "y", np.array([0, -10, -3, 0, 0, 0]), 100 * (1 - 0.09) / 1000 / 2, tuple(range(0, 50, 7))),
    pairs("patch_3d", SOLID, "patch_3d.yaml", "z", np.array([0, 0, -10, 0, 0, 0]), 100 / 1000 / 2, tuple(range(0, 128, 15))),
    mapped("patch_inclined", "inclined interface", lambda x: 0.4 + 0.2 * x, None, (1e-9, 1e-9, 1e-9), (3,)),
    *[curved(element, side) for element in ("quad4", "quad9") for side in ("lower", "upper")],
]
