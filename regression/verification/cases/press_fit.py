"""Lame's press fit: plane stress, plane strain, in space (ends free: plane stress is exact; both held: plane strain) and axisymmetric."""

import functools

import numpy as np

import formulas
from cases.common import DECKS, INPUTS, Case, Mesh, Quantity, by_x, constants
from elements import squared_norms

A, B, C, INTERFERENCE, E, NU = 25, 50, 100, 0.05, 210e3, 0.3


def exact(plane):
    p = formulas.press_fit_pressure(INTERFERENCE, A, B, C, E, NU, plane)
    return p, formulas.ring_constants(A, B, 0, p), formulas.ring_constants(B, C, p, 0)


def stress(plane, x, body):
    return formulas.ring_stress(x, exact(plane)[1 + body], NU, plane)


def evaluate(plane, thickness, result, mesh):
    """Mean pressure from the force on the quarter, p b; radial displacements; energy of the interference, p dl b pi/4 over a quarter."""
    p, shaft, hub = exact(plane)
    pressure = result.contact.fields["contact_pressure"]
    return {
        "mean p": (np.abs(result.summary["contacts"][0]["force"][0]) / (B * thickness), p),
        "p anywhere": np.abs(pressure - p).max() / p,
        "u at the bore": (result.displacement_at((A, 0, 0), 0)[0], formulas.ring_displacement(A, shaft, E, NU, plane)),
        "u outside": (result.displacement_at((C, 0, 0), 1)[0], formulas.ring_displacement(C, hub, E, NU, plane)),
        "energy": (result.summary["strain_energy"], p * INTERFERENCE * B * np.pi / 4 * thickness),
    }


def true_error(plane, kinematics, result, mesh):
    materials = {0: (E, NU), 1: (E, NU)}
    return float(np.sqrt(squared_norms(result.solution, materials, kinematics, functools.partial(stress, plane))[1]))


def quantities(order, bound):
    """The pressure at single nodes scatters between meshes that do not match: order 1. Displacements and energy: twice the order of
    the stress; but with curved cells of second order the gap between the two surfaces, each through its own nodes, is the larger error."""
    return [
        Quantity("mean p", bound, 2, floor=2e-4),
        Quantity("p anywhere", 5 * bound, 1, floor=2e-3),
        Quantity("u at the bore", bound, 2, floor=2e-4),
        Quantity("u outside", bound, 2, floor=2e-4),
        Quantity("energy", bound, 2, floor=2e-4),
    ]


def plane_case(name, plane, order, sizes):
    """The hub has 3n/2 cells across. With the n + 2 of the input its cells do not shrink as 1/n: an error of h^2 then falls by 9, not by 16,
    from n = 4 to 16, and seems of order 1.6."""
    size = lambda n: constants(n=n, order=order, across=3 * n // 2)
    meshes = [Mesh(f"n = {n}", 1 / n, size(n) + [f"dimension={plane}", "solver.tolerance=1e-8"]) for n in sizes]
    return Case(
        name,
        f"Press fit, {plane.replace('_', ' ')}, {'quad4' if order == 1 else 'quad9'}",
        "Lame; Timoshenko and Goodier (1951), 28",
        INPUTS / "press_fit/press_fit.yaml",
        meshes,
        quantities(order, 0.02),
        functools.partial(evaluate, plane, 1),
        plot_hoop(plane),
        functools.partial(true_error, plane, plane),
    )


def plot_hoop(plane):
    """Hoop stress along the x axis."""

    def plot(axes, runs):
        r = np.linspace(A, C, 400)
        _, shaft, hub = exact(plane)
        hoop = np.where(r < B, shaft[0] + shaft[1] / r**2, hub[0] + hub[1] / r**2)
        axes.plot(r, hoop, "k-", linewidth=1, label="formula")
        for (mesh, result), mark in zip(runs, "o^sv"):
            nodes = result.nodes_where(lambda x, y, z: (np.abs(y) < 1e-9) & (np.abs(z) < 1e-9))
            axes.plot(
                result.solution.points[nodes, 0], result.solution.fields["stress"][nodes, 1], mark, markersize=3, fillstyle="none", label=mesh.label
            )
        axes.set_xlabel("r")
        axes.set_ylabel("hoop stress")
        axes.legend(fontsize=7)

    return plot


def space_case(name, plane, order, sizes, layers=2, quick=(0,)):
    ends = ["lower_end"] if plane == "plane_stress" else ["lower_end", "upper_end"]
    supports = [("symmetry_x", "x"), ("symmetry_y", "y")] + [(end, "z") for end in ends]
    held = "supports=[" + ", ".join(f"{{boundary: {name}, displacement: {{{axis}: 0}}}}" for name, axis in supports) + "]"
    meshes = [Mesh(f"n = {n}", 1 / n, constants(n=n, order=order, layers=layers) + [held]) for n in sizes]
    return Case(
        name,
        f"Press fit in space, ends {'free' if plane == 'plane_stress' else 'held'}, {'hex8' if order == 1 else 'hex27'}, shaft of {layers} layers",
        f"Lame; Timoshenko and Goodier (1951), 28, {plane.replace('_', ' ')}",
        DECKS / "press_fit_3d.yaml",
        meshes,
        quantities(order, 0.02),
        functools.partial(evaluate, plane, 10),
        true_error=functools.partial(true_error, plane, "3"),
        quick=quick,
    )


def axisymmetric(result, mesh):
    """Everything of a ring; resultants round the whole circle."""
    p, shaft, hub = exact("plane_stress")
    return {
        "p anywhere": np.abs(result.contact.fields["contact_pressure"] - p).max() / p,
        "u at the bore": (result.displacement_at((A, 0, 0))[0], formulas.ring_displacement(A, shaft, E, NU, "plane_stress")),
        "u outside": (result.displacement_at((C, 0, 0))[0], formulas.ring_displacement(C, hub, E, NU, "plane_stress")),
        "energy": (result.summary["strain_energy"], p * INTERFERENCE * B * np.pi * 10),
    }


def axisymmetric_mesh(n):
    return Mesh(f"n = {n}", 1 / n, [f"mesh.blocks.shaft.cells=[{n}, {n // 2}]", f"mesh.blocks.hub.cells=[{3 * n // 2}, {3 * n // 4}]"])


CASES = [
    plane_case("press_fit_stress", "plane_stress", 1, (4, 8, 16, 32)),
    plane_case("press_fit_strain", "plane_strain", 1, (4, 8, 16, 32)),
    plane_case("press_fit_strain_2", "plane_strain", 2, (4, 8, 16)),
    space_case("press_fit_space_free", "plane_stress", 1, (4, 8, 16)),
    space_case("press_fit_space_held", "plane_strain", 1, (4, 8, 16)),
    space_case("press_fit_space_2", "plane_stress", 2, (4, 6, 8)),
    # A surface one cell wide has nodes on its border only: their normals must be right all the same.
    space_case("press_fit_one_layer", "plane_stress", 1, (4, 8, 16), layers=1, quick=()),
    Case(
        "press_fit_axisymmetric",
        "Press fit, axisymmetric, quad4, ends free",
        "Lame; Timoshenko and Goodier (1951), 28, plane stress; energy of the whole ring",
        DECKS / "press_fit_axisymmetric.yaml",
        [axisymmetric_mesh(n) for n in (4, 8, 16)],
        [Quantity("p anywhere", 0.05, 1), Quantity("u at the bore", 0.02, 2), Quantity("u outside", 0.02, 2), Quantity("energy", 0.02, 2)],
        axisymmetric,
        needs="axisymmetric",
    ),
]
