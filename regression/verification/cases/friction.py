"""Friction: Cattaneo and Mindlin in 2D and 3D, Spence's stick zone, blocks that slide.

In one step slip counts from the undeformed state. For equal bodies that is Cattaneo's problem, P first and Q after it: pressing alone
moves their surfaces by the same amounts sideways, so points that come into contact early or late are no different. What Q leaves behind
when it goes back (Mindlin and Deresiewicz) takes load steps.
"""

import numpy as np

import formulas
from cases.common import DECKS, INPUTS, Case, Mesh, Quantity, by_x, constants, difference, forces_at_points, node_areas, plot_pressure

STEEL = (210e3, 0.3)
MODULUS = formulas.pair_modulus(*STEEL, *STEEL)


def line_state(result):
    """P, Q, and a, c, p0 that follow from them."""
    force = result.summary["contacts"][0]["force"]
    p, q = abs(force[1]), abs(force[0])
    a, p0 = formulas.hertz_line(p, 50, MODULUS)
    return p, q, a, a * np.sqrt(1 - q / (0.3 * p)), p0


def cattaneo_line(result, mesh):
    """Cylinder and block are not the same half-plane: pressing alone moves their surfaces differently by some a/R, antisymmetric, and
    that shifts the stick zone sideways, which smears its ends: floors of 2 a/R for the shear."""
    p, q, a, c, p0 = line_state(result)
    x, traction, areas = by_x(result, "contact_traction")
    exact, found = formulas.cattaneo(x, a, c, 0.3 * p0), np.abs(traction[:, 0])
    points, _, forces = forces_at_points(result)
    moment = np.sum(np.abs(forces[:, 0]) * points[:, 0] ** 2)
    return {
        "pressure": difference(np.abs(traction[:, 1]), formulas.hertz_pressure(x, a, p0), areas),
        "shear": difference(found, exact, areas),
        "shear, even part": difference((found + np.interp(-x, x, found)) / 2, exact, areas),
        "c": ((a**2 * (a**2 - 4 * moment / (0.3 * p))) ** 0.25, c),
    }


def plot_shear(axes, runs):
    _, _, a, c, p0 = line_state(runs[-1][1])
    shear = lambda result: (lambda x, t, w: (x, np.abs(t[:, 0]), w))(*by_x(result, "contact_traction"))
    plot_pressure(axes, runs, lambda x: formulas.cattaneo(x, a, c, 0.3 * p0), 1.2 * a, shear, label="shear")


def reversed_state(result):
    """a, p0 and the ends of the stick zones of the way to Q* and of the way back to Q: q = q(Q*) - 2 q((Q* - Q) / 2)."""
    p, _, a, _, p0 = line_state(result)
    there, back = (step["contacts"][0]["force"][0] for step in result.summary["steps"][-2:])
    part = lambda q: a * np.sqrt(1 - abs(q) / (0.3 * p))
    return a, p0, part(there), part((there - back) / 2), np.sign(there)


def reversed_shear(x, a, p0, c, c_back):
    return formulas.cattaneo(x, a, c, 0.3 * p0) - 2 * formulas.cattaneo(x, a, c_back, 0.3 * p0)


def mindlin_deresiewicz(result, mesh):
    a, p0, c, c_back, sign = reversed_state(result)
    x, traction, areas = by_x(result, "contact_traction")
    exact, found = reversed_shear(x, a, p0, c, c_back), sign * traction[:, 0]
    return {
        "pressure": difference(np.abs(traction[:, 1]), formulas.hertz_pressure(x, a, p0), areas),
        "shear, even part": difference((found + np.interp(-x, x, found)) / 2, exact, areas),
    }


def plot_reversed(axes, runs):
    a, p0, c, c_back, sign = reversed_state(runs[-1][1])
    shear = lambda result: (lambda x, t, w: (x, sign * t[:, 0], w))(*by_x(result, "contact_traction"))
    plot_pressure(axes, runs, lambda x: reversed_shear(x, a, p0, c, c_back), 1.2 * a, shear, label="shear")


# The sphere; Poisson's ratio 0.

SPHERE_MODULUS = formulas.pair_modulus(210e3, 0, 210e3, 0)


def sphere_state(result):
    force = result.summary["contacts"][0]["force"]
    p, q = 2 * abs(force[2]), 2 * abs(force[0])
    a, p0, _ = formulas.hertz_point(p, 10, SPHERE_MODULUS)
    return p, q, a, a * (1 - q / (0.3 * p)) ** (1 / 3), p0


def sphere_shear(result):
    grid = result.contact
    r = np.linalg.norm(grid.points[:, :2], axis=1)
    at = np.argsort(r, kind="stable")
    return r[at], np.abs(grid.fields["contact_traction"][at, 0]), node_areas(grid)[at]


def cattaneo_point(result, mesh):
    p, q, a, c, p0 = sphere_state(result)
    r, found, areas = sphere_shear(result)
    grid = result.contact
    points, _, forces = forces_at_points(result)
    moment = 2 * np.sum(np.abs(forces[:, 0]) * (points[:, 0] ** 2 + points[:, 1] ** 2))
    radius = np.linalg.norm(points[:, :2], axis=1)
    all_areas = node_areas(grid)
    across = np.sqrt(np.sum(all_areas * grid.fields["contact_traction"][:, 1] ** 2) / np.sum(areas * found**2))
    return {
        "pressure": difference(grid.fields["contact_pressure"], formulas.hertz_pressure(radius, a, p0), all_areas),
        "shear": difference(found, formulas.cattaneo(r, a, c, 0.3 * p0), areas),
        "shear across": across,
        "c": ((a**3 * (a**2 - moment / (0.12 * p))) ** 0.2, c),
    }


def plot_sphere(axes, runs):
    _, _, a, c, p0 = sphere_state(runs[-1][1])
    plot_pressure(axes, runs, lambda x: formulas.cattaneo(x, a, c, 0.3 * p0), 1.2 * a, sphere_shear, label="shear")


# Spence's stick zone under a flat punch, and that of a cylinder at three loads.

COEFFICIENT = 0.2


def stick_fraction(result):
    """c / a from where |q| falls below coefficient * p, between nodes; beyond 0.97 a nothing is looked at."""
    x, traction, _ = by_x(result, "contact_traction")
    p, q = np.abs(traction[:, 1]), np.abs(traction[:, 0])
    a = x[p > 0].max()
    ratio = np.where(p > 0, q / (COEFFICIENT * np.where(p > 0, p, 1)), 1)
    first = np.flatnonzero(ratio >= 1 - 1e-6)
    first = first[first > 0][0]
    return (
        x[first - 1] + (x[first] - x[first - 1]) * (1 - ratio[first - 1]) / max(1 - ratio[first - 2], 1e-12)
        if first > 1 and ratio[first - 1] > ratio[first - 2]
        else x[first]
    ) / a


def punch(result, mesh):
    return {"c / a": (stick_fraction(result), formulas.spence_stick(COEFFICIENT, 0.3))}


def shear_share(result):
    """Integral of |q| over coefficient * P: a number that, unlike the stick zone's width, does not move in steps of the mesh."""
    _, traction, areas = by_x(result, "contact_traction")
    return np.sum(areas * np.abs(traction[:, 0])) / (COEFFICIENT * np.sum(areas * np.abs(traction[:, 1])))


def invariant_case():
    """A cylinder at loads 1/4, 1 and 4, its a = 3.1, 6.2 and 12.4 h: the mesh is scaled with a, so only the curvature's share differs."""
    reference = []

    def evaluate(result, mesh):
        reference.append(shear_share(result))
        return {"share of friction used": (reference[-1], reference[0])}

    meshes = [
        Mesh(
            f"a = R/{50 / a:g}",
            1,
            [
                f"mesh.constants={{h: {a / 20}, d: {2 * a}, W: {200 * a}, H: {200 * a}}}",
                f"loads[0].force=[0, {-906.2 / 2 * a * a}]",
                f"contacts[0].friction={{coulomb: {COEFFICIENT}}}",
                "contacts[0].secondary=block_top",
                "contacts[0].primary=cylinder_surface",
            ],
        )
        for a in (0.5, 1, 2)
    ]
    return Case(
        "self_similar",
        "A cylinder on a softer block with friction, at three loads: the stick fraction does not depend on the load",
        "Spence (1973): self-similar; compared with the smallest load; 0.02 allowed for a/R = 0.04",
        INPUTS / "hertz_cylinder/hertz_cylinder.yaml",
        meshes,
        [Quantity("share of friction used", 0.02)],
        evaluate,
        quick=(0, 1),
    )


# Blocks.


def sliding(shear, slip, normal):
    """Uniform stress -10 across, `shear` along x; the largest differences anywhere."""

    def evaluate(result, mesh):
        volume, contact = result.solution.fields, result.contact.fields
        exact = np.zeros(6)
        exact[normal], exact[{1: 3, 2: 5}[normal]] = -10, shear
        traction = np.zeros(3)
        traction[normal], traction[0] = 10, -shear
        found_slip = contact["slip"][:, 0]
        return {
            "stress": np.abs(volume["stress"] - exact).max() / 10,
            "traction": np.abs(contact["contact_traction"] - traction).max() / 10,
            "slip": np.abs(found_slip - slip).max() / 0.03,
            "energy": (result.summary["strain_energy"], (100 / 1000 + shear**2 / 500) / 2 * 2),
        }

    return evaluate


def sliding_case(name, deck, normal, stick):
    shear, slip, move = (2.5, 0.0, 0.01) if stick else (5.0, 0.03, 0.05)
    side = lambda sign: "[" + ", ".join(["0"] * normal + [str(sign * shear)]) + "]"
    settings = [f"supports[1].displacement.x={move}"] + [f"loads[{i}].traction={side(-1 if i % 2 == 0 else 1)}" for i in range(4)]
    kinds = (
        ("quad4", "tri3", "quad8", "quad9", "tri6") if normal == 1 else ("hex8", "tet4", "prism6", "hex20", "hex27", "tet10", "prism15", "prism18")
    )
    meshes = [Mesh(kind, 1, settings + [f"mesh.blocks.{body}.element={kind}" for body in ("lower", "upper")]) for kind in kinds]
    return Case(
        name,
        f"Blocks that {'stick' if stick else 'slide'} with Coulomb friction, uniform stress",
        "Exact: sigma = -E d / 2, tau = G D / 2 or 0.5 sigma, slip D - 2 tau / G",
        DECKS / deck,
        meshes,
        [Quantity(q, 1e-9) for q in ("stress", "traction", "slip", "energy")],
        sliding(shear, slip, normal),
    )


CASES = [
    Case(
        "cattaneo",
        "Cattaneo's line contact, pressed and sheared",
        "Johnson (1985), 7.2; P and Q are those found; c from the second moment of q",
        INPUTS / "hertz_cylinder/cattaneo_mindlin.yaml",
        [
            Mesh(
                f"h = {h}",
                h / 1.31,
                constants(h=h, growth=3 * h)
                + [f"mesh.file={DECKS / 'sheared_cylinder.geo'}", "contacts[0].secondary=block_top", "contacts[0].primary=cylinder_surface"],
            )
            for h in (0.2, 0.1, 0.05, 0.025)
        ],
        [
            Quantity("pressure", 0.1, 1),
            Quantity("shear", 0.15, 1, floor=2 * 1.31 / 50),
            Quantity("shear, even part", 0.1, 1, floor=2 * 1.31 / 50),
            Quantity("c", 0.05, 1, floor=0.002),
        ],
        cattaneo_line,
        plot_shear,
    ),
    Case(
        "reversed",
        "The same in load steps: pressed, sheared, and back to where it was",
        "Mindlin and Deresiewicz (1953); Johnson (1985), 7.3; P and both Q are those found",
        DECKS / "reversed_cylinder.yaml",
        [Mesh(f"h = {h}", h / 1.31, constants(h=h, growth=3 * h)) for h in (0.2, 0.1, 0.05, 0.025)],
        [Quantity("pressure", 0.1, 1), Quantity("shear, even part", 0.3, 1, floor=4 * 1.31 / 50)],
        mindlin_deresiewicz,
        plot_reversed,
    ),
    Case(
        "mindlin",
        "Mindlin's point contact, pressed and sheared, tet10, Poisson's ratio 0",
        "Johnson (1985), 7.2; c from the second moment of q",
        DECKS / "sheared_sphere.yaml",
        [Mesh(f"h = {h}", h / 0.3, constants(h=h, growth=7 * h)) for h in (0.1, 0.07, 0.05)],
        [Quantity("pressure", 0.2, 1), Quantity("shear", 0.3, 1), Quantity("shear across", 0.2, 1), Quantity("c", 0.1, 1, floor=0.01)],
        cattaneo_point,
        plot_sphere,
    ),
    Case(
        "spence",
        "Stick zone under a flat punch, friction 0.2",
        "Spence (1973), the pressure taken as frictionless: 5 % allowed",
        DECKS / "punch.yaml",
        [
            Mesh(
                f"h = {h}, P = {load}",
                h,
                constants(h=h) + [f"contacts[0].friction={{coulomb: {COEFFICIENT}}}", f"loads[0].force=[0, {-load}]", "friction_loop.tolerance=1e-6"],
            )
            for h, load in ((0.05, 1), (0.05, 100), (0.025, 1))
        ],
        [Quantity("c / a", 0.05)],
        punch,
    ),
    invariant_case(),
    sliding_case("stick_2d", "sliding.yaml", 1, True),
    sliding_case("slide_2d", "sliding.yaml", 1, False),
    sliding_case("stick_3d", "sliding_3d.yaml", 2, True),
    sliding_case("slide_3d", "sliding_3d.yaml", 2, False),
]
