"""A cantilever, length to height 10, against beam theory with shear: which cells lock. Poisson's ratio 0, so that the clamp disturbs least."""

import formulas
from cases.common import DECKS, Case, Mesh, Quantity

DEFLECTION = formulas.cantilever(0.01, 10, 1, 1, 1000, 0)


def evaluate(result, mesh):
    """Mean deflection of the end, through the work of the load, 2 U / P, and what the beam is too stiff by: locking makes the
    deflection w / (1 + c h^2), so that only w / found - 1 goes with h^2 on coarse meshes."""
    found = 2 * result.summary["strain_energy"] / 0.01
    return {"deflection": (found, DEFLECTION), "stiffness": (DEFLECTION / found, 1)}


def case(element, bound, order, three, formulation="standard"):
    """Cells twice as long as high. Beam theory leaves out what the clamp does to the shear: the floor."""
    meshes = []
    for n in (1, 2, 4, 8) if order == 1 or not three else (1, 2, 4):
        cells = [5 * n, n, max(1, n // 2)] if three else [5 * n, n]
        meshes.append(
            Mesh(
                f"{n} cells high",
                1 / n,
                [f"mesh.blocks.beam.cells={cells}", f"mesh.blocks.beam.element={element}", f"bodies.beam.formulation={formulation}"],
            )
        )
    name = element if formulation == "standard" else f"{element}_{formulation}"
    return Case(
        f"cantilever_{name}",
        f"Cantilever, {name}",
        "Timoshenko's beam with Cowper's shear coefficient, 5/6 at Poisson's ratio 0; mean deflection of the end",
        DECKS / ("cantilever.yaml" if three else "cantilever_2d.yaml"),
        meshes,
        [Quantity("deflection", bound), Quantity("stiffness", bound / (1 - bound), 2, floor=0.001)],
        evaluate,
    )


CASES = [
    case("quad4", 0.8, 1, False),
    case("quad4", 0.1, 1, False, "incompatible"),
    case("tri3", 0.95, 1, False),
    case("quad8", 0.05, 2, False),
    case("tri6", 0.1, 2, False),
    case("hex8", 0.8, 1, True),
    case("hex8", 0.1, 1, True, "incompatible"),
    case("hex8", 0.8, 1, True, "bbar"),
    case("prism6", 0.95, 1, True),
    case("tet4", 0.95, 1, True),
    case("hex20", 0.05, 2, True),
    case("hex27", 0.05, 2, True),
    case("tet10", 0.1, 2, True),
    case("prism15", 0.1, 2, True),
]
