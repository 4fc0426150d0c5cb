"""The estimate of the discretization error beside the true one, on problems known in closed form: smooth ones, and a corner.

The true error is the energy norm of the stress's difference from the formula, integrated over the cells by elements.py. Effectivity is
the estimated error (error_estimate.discretization, made absolute with the strain energy) over the true one.
"""

import functools

import numpy as np

import formulas
from cases.common import DECKS, Case, Mesh, Quantity, constants
from elements import complementary, squared_norms

MATERIAL = (1000, 0.3)
RING = formulas.ring_constants(1, 2, 10, 0)


def evaluate(kinematics, exact, formulation, displacement, order, result, mesh):
    """Energy norm of the error over that of the solution; displacement at the bore; and whether elements.py finds the program's own
    energy when it integrates by as many Gauss points."""
    if mesh.h is None:  # unstructured: what the mesher made of the size asked for
        mesh.h = result.summary["primal_unknowns"] ** (-1 / 3)
    norm, error = squared_norms(result.solution, {0: MATERIAL}, kinematics, exact, formulation, order + 2)
    result.true_error = float(np.sqrt(error))
    same, _ = squared_norms(result.solution, {0: MATERIAL}, kinematics, None, formulation, order + 1)
    return {
        "energy norm": np.sqrt(error / norm),
        "displacement": (result.displacement_at((1, 0, 0))[0], displacement),
        "own energy": (same / 2, result.summary["strain_energy"]),
    }


def case(name, element, deck, kinematics, order, meshes, exact, displacement, formulation="standard", bound=0.4):
    plane = kinematics or "3"
    return Case(
        name,
        f"Error estimate, {element}",
        "Timoshenko and Goodier (1951), 28 and 142; error integrated over the cells",
        DECKS / deck,
        meshes,
        [Quantity("energy norm", bound, order), Quantity("displacement", bound / 2, order + 1, floor=1e-5), Quantity("own energy", 1e-5)],
        functools.partial(evaluate, plane, exact, formulation, displacement, order),
        true_error=lambda result, mesh: result.true_error,  # evaluate() comes first
        effectivity=(0.7, 1.5 if order == 1 else 2),  # averages of second order are no better than the cells, which the claim counts
    )


def tube(element, three, order, sizes, formulation="standard", **shape):
    meshes = [
        Mesh(
            f"n = {n}",
            1 / n,
            constants(n=n, order=order, three=three, **shape) + ([f"bodies.tube.formulation={formulation}"] if formulation != "standard" else []),
        )
        for n in sizes
    ]
    return case(
        f"tube_{element}",
        f"{element} in a thick tube",
        "tube_3d.yaml" if three else "tube.yaml",
        "3" if three else "plane_strain",
        order,
        meshes,
        lambda x, body: formulas.ring_stress(x, RING, 0.3, "plane_strain"),
        formulas.ring_displacement(1, RING, *MATERIAL, "plane_strain"),
        formulation,
    )


def sphere(element, order, sizes):
    return case(
        f"sphere_{element}",
        f"{element} in a hollow sphere",
        "hollow_sphere.yaml",
        "3",
        order,
        [Mesh(f"n = {n}", None, constants(n=n, order=order)) for n in sizes],
        lambda x, body: formulas.sphere_stress(x, 1, 2, 10),
        formulas.sphere_displacement(1, 1, 2, 10, *MATERIAL),
    )


@functools.cache
def corner_energy():
    """Twice the strain energy of the three squares of corner.geo: the integral over theta of that at r = 1 times R^(2 e) / (2 e), where R
    is how far the outer edge is."""
    exponent, stress = formulas.reentrant_corner()
    at, weight = np.polynomial.legendre.leggauss(40)
    eighth = (at + 1) * np.pi / 8  # from a corner of a square, or from the middle of its side, to the other
    total = 0.0
    for start in np.arange(-3, 3) * np.pi / 4:
        theta = start + eighth
        turned = np.mod(theta + np.pi / 4, np.pi / 2) - np.pi / 4  # from the diagonal of its square
        edge = 1 / np.cos(np.pi / 4 - np.abs(turned))
        density = complementary(stress(1.0, theta, MATERIAL[1]), MATERIAL)
        total += np.sum(weight * np.pi / 8 * density * edge ** (2 * exponent)) / (2 * exponent)
    return float(total)


def corner(element, order, least=1 / 1.5, **shape):
    """The error follows from the energy: the work of the loads is that of the displacements, and the finite elements' is less."""

    def squared(result):
        return corner_energy() - 2 * result.summary["strain_energy"]

    return Case(
        f"corner_{element}",
        f"Error estimate, {element} at a reentrant corner",
        "Williams (1952); Szabo and Babuska (1991), 10.2; error from the energy",
        DECKS / "corner.yaml",
        [Mesh(f"n = {n}", 1 / n, constants(n=n, order=order, **shape)) for n in (2, 4, 8)],
        [Quantity("energy norm", 0.4, formulas.reentrant_corner()[0])],
        lambda result, mesh: {"energy norm": np.sqrt(squared(result) / corner_energy())},
        true_error=lambda result, mesh: np.sqrt(squared(result)),
        effectivity=(least, 1.5),
    )


PLANE, SOLID, FINE = (4, 8, 16, 32), (2, 4, 8, 16), (4, 8, 12)
CASES = [
    tube("tri3", 0, 1, PLANE, quads=0),
    tube("quad4", 0, 1, PLANE),
    tube("quad4_bbar", 0, 1, PLANE, "bbar"),
    tube("quad4_incompatible", 0, 1, PLANE, "incompatible"),
    tube("tri6", 0, 2, PLANE[:3], quads=0),
    tube("quad8", 0, 2, PLANE[:3], incomplete=1),
    tube("quad9", 0, 2, PLANE[:3]),
    tube("tet4", 2, 1, SOLID, quads=0),
    tube("prism6", 1, 1, SOLID, quads=0),
    tube("hex8", 1, 1, SOLID),
    tube("prism6_bbar", 1, 1, SOLID, "bbar", quads=0),
    tube("hex8_bbar", 1, 1, SOLID, "bbar"),
    tube("hex8_incompatible", 1, 1, SOLID, "incompatible"),
    tube("tet10", 2, 2, FINE, quads=0),
    tube("prism15", 1, 2, FINE, quads=0, incomplete=1),
    tube("prism18", 1, 2, FINE, quads=0),
    tube("hex20", 1, 2, FINE, incomplete=1),
    tube("hex27", 1, 2, FINE),
    sphere("tet4", 1, (4, 8, 12)),
    sphere("tet10", 2, (3, 5, 8)),
    corner("tri3", 1, 0.6, quads=0),  # 0.63 on eight triangles a square
    corner("quad4", 1),
    corner("tri6", 2, quads=0),
    corner("quad8", 2, incomplete=1),
    corner("quad9", 2),
]
