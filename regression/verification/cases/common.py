"""What several cases measure in the same way."""

import numpy as np

from elements import squared_norms
from study import HERE, INPUTS, Case, Mesh, Quantity  # noqa: F401, for the cases

DECKS = HERE / "decks"
CORNERS = {3: 2, 21: 2, 5: 3, 22: 3, 9: 4, 23: 4, 28: 4}


def node_areas(grid):
    """The share of the faces' areas (lines: lengths) of each node of a surface, equal parts to the nodes of a face."""
    areas = np.zeros(len(grid.points))
    for kind, _, nodes in grid.groups():
        x = grid.points[nodes[:, : CORNERS[kind]]]
        if CORNERS[kind] == 2:
            size = np.linalg.norm(x[:, 1] - x[:, 0], axis=1)
        else:
            last = x[:, 3] if CORNERS[kind] == 4 else x[:, 2]
            size = np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1) / 2
            if CORNERS[kind] == 4:
                size += np.linalg.norm(np.cross(x[:, 2] - x[:, 0], last - x[:, 0]), axis=1) / 2
        np.add.at(areas, nodes, (size / nodes.shape[1])[:, None])
    return areas


def difference(found, exact, weights):
    """Relative l2 norm of the difference."""
    return float(np.sqrt(np.sum(weights * (found - exact) ** 2) / np.sum(weights * exact**2)))


def by_x(result, field="contact_pressure"):
    """x, values, areas on a contact line, ordered by x."""
    grid = result.contact
    at = np.argsort(grid.points[:, 0], kind="stable")
    values = grid.fields[field]
    return grid.points[at, 0], values[at], node_areas(grid)[at]


def forces_at_points(result):
    """Pressure and tangential traction times area: forces at the nodes of the secondary side, and their places."""
    grid = result.contact
    areas = node_areas(grid)
    return grid.points, grid.fields["contact_pressure"] * areas, grid.fields["contact_traction"] * areas[:, None]


def constants(**values):
    return [f"mesh.constants.{key}={value}" for key, value in values.items()]


def exact_error(materials, kinematics, exact, formulation=lambda mesh: "standard"):
    """For Case.true_error: the energy norm of the stress's difference from exact(x, body)."""

    def error(result, mesh):
        return float(np.sqrt(squared_norms(result.solution, materials, kinematics, exact, formulation(mesh))[1]))

    return error


def plot_pressure(axes, runs, exact, limit, values=by_x, scale=1.0, label="pressure"):
    """Nodal pressures of the runs over x, beside the formula."""
    x = np.linspace(-limit if min(values(r)[0].min() for _, r in runs) < -1e-9 else 0, limit, 600)
    axes.plot(x, exact(x) / scale, "k-", linewidth=1, label="formula")
    for (mesh, result), mark in zip(runs, "o^sv"):
        at, found = values(result)[:2]
        inside = np.abs(at) <= limit
        axes.plot(at[inside], found[inside] / scale, mark, markersize=3, fillstyle="none", label=mesh.label)
    axes.set_xlabel("x")
    axes.set_ylabel(label)
    axes.legend(fontsize=7)
