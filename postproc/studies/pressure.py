"""The error of a contact pressure against a formula, the same for every program: relative, in the L2 norm over the secondary surface.

Nodal pressures are interpolated by the shape functions of the facets (of second order on facets that are), the formula is evaluated at the
points of a Gauss rule. Needs python3-numpy.
"""

import re

import numpy as np

from studies import vtu
from studies.refinement import BadInput

NAMES = {
    name: getattr(np, name) for name in ("sqrt", "maximum", "minimum", "where", "abs", "exp", "log", "sin", "cos", "tan", "arctan2", "hypot", "pi")
}


class Formula:
    """An expression in x, y, z and the run's own `force` (the integral of its pressure) with functions of numpy's."""

    def __init__(self, text):
        self.text = text
        try:
            self.code = compile(text, "--pressure", "eval")
            self(np.ones((1, 3)), 1.0)
        except Exception as problem:
            raise BadInput(f"--pressure: {text!r} is no formula in x, y, z, force: {problem} (functions: {', '.join(NAMES)})") from problem

    def __call__(self, points, force):
        with np.errstate(invalid="ignore", divide="ignore"):
            value = eval(self.code, {"__builtins__": {}}, dict(NAMES, force=force, x=points[:, 0], y=points[:, 1], z=points[:, 2]))
        return np.broadcast_to(np.asarray(value, dtype=float), len(points))


def line_rule(count=6):
    x, w = np.polynomial.legendre.leggauss(count)
    return 0.5 * (x + 1), 0.5 * w


def triangle_rule(count=6):
    """Gauss's rule of the square, collapsed."""
    x, w = line_rule(count)
    r, s = np.meshgrid(x, x, indexing="ij")
    return np.stack([r.ravel(), (s * (1 - r)).ravel()], axis=1), (np.outer(w, w) * (1 - r)).ravel()


def rule(corners):
    x, w = line_rule()
    if corners == 2:
        return x[:, None], w
    if corners == 3:
        return triangle_rule()
    r, s = np.meshgrid(x, x, indexing="ij")
    return np.stack([r.ravel(), s.ravel()], axis=1), np.outer(w, w).ravel()


def quadratic(t):
    """Corner, corner, middle, on 0 to 1."""
    return np.stack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)], axis=-1)


def functions(kind, at):
    """Shape functions of a facet at the points `at`, in VTK's order."""
    t = at[:, 0]
    if kind == "line":
        return np.stack([1 - t, t], axis=1)
    if kind == "line3":
        return quadratic(t)
    s = at[:, 1]
    u = 1 - t - s
    if kind == "triangle":
        return np.stack([u, t, s], axis=1)
    if kind == "triangle6":
        return np.stack([u * (2 * u - 1), t * (2 * t - 1), s * (2 * s - 1), 4 * u * t, 4 * t * s, 4 * s * u], axis=1)
    if kind == "quad":
        return np.stack([(1 - t) * (1 - s), t * (1 - s), t * s, (1 - t) * s], axis=1)
    if kind == "quad9":
        a, b = quadratic(t), quadratic(s)
        return np.stack([a[:, i] * b[:, j] for i, j in ((0, 0), (1, 0), (1, 1), (0, 1), (2, 0), (1, 2), (2, 1), (0, 2), (2, 2))], axis=1)
    if kind == "quad8":
        nine = functions("quad9", at)
        inside = nine[:, 8:]
        return nine[:, :8] + inside * np.array([-0.25] * 4 + [0.5] * 4)
    raise BadInput(f"facets of kind {kind} are not known to the error of the pressure")


def corner_count(kind):
    return {"line": 2, "triangle": 3, "quad": 4}[re.sub(r"\d+$", "", kind)]


def at_gauss_points(kind, points, values):
    """Places, weights (with the measure of the facet) and pressures at the points of the rule: points (facets, nodes, 3), values (facets, nodes)."""
    corners = corner_count(kind)
    at, weights = rule(corners)
    shape = functions(kind, at)
    step = 1e-6
    tangents = [
        np.einsum("qn,fnd->fqd", (functions(kind, at + step * e) - functions(kind, at - step * e)) / (2 * step), points) for e in np.eye(at.shape[1])
    ]
    size = np.linalg.norm(tangents[0], axis=2) if corners == 2 else np.linalg.norm(np.cross(tangents[0], tangents[1]), axis=2)
    return np.einsum("qn,fnd->fqd", shape, points).reshape(-1, 3), (size * weights).ravel(), np.einsum("qn,fn->fq", shape, values).ravel()


def relative_error(groups, formula):
    """||p - exact|| / ||exact|| of (kind, points, values) groups."""
    places, weights, found = (np.concatenate(parts) for parts in zip(*(at_gauss_points(*group) for group in groups)))
    exact = formula(places, float(weights @ found))
    whole = float(weights @ exact**2)
    if not whole > 0:
        raise BadInput(f"--pressure: {formula.text!r} is nowhere positive on the secondary surface")
    return float(np.sqrt(weights @ (found - exact) ** 2 / whole))


def of_mortise(directory, contact, field):
    groups = []
    last = re.findall(r'file="([^"]+)"', (directory / "contact.pvd").read_text())[-1]  # of all load steps
    for path in sorted(directory.glob(re.sub(r"(_0\.vtu|\.pvtu)$", "", last) + "_*.vtu")):
        mesh = vtu.read_vtu(path)
        offsets, types = mesh["Cells"]["offsets"], mesh["Cells"]["types"]
        for kind in np.unique(types[mesh["CellData"]["contact"] == contact]) if len(types) else []:
            mine = np.flatnonzero((types == kind) & (mesh["CellData"]["contact"] == contact))
            count = offsets[mine[0]] - (offsets[mine[0] - 1] if mine[0] else 0)
            cells = mesh["Cells"]["connectivity"][offsets[mine][:, None] - count + np.arange(count)]
            groups.append((vtu.NAMES[int(kind)], mesh["Points"]["Points"][cells], mesh["PointData"][field][cells]))
    if not groups:
        raise BadInput(f"{directory}: there is no contact {contact}")
    return groups


def of_calculix(mesh, boundary, by_node):
    """From nodal pressures {node: p} of a ccx.Mesh's boundary; nodes inside facets, which CalculiX's cells lack, are left out."""
    groups = {}
    for kind, facet in mesh.facets(boundary):
        kind, count = ("quad8", 8) if kind == "quad9" else (kind, len(facet))
        points, values = groups.setdefault(kind, ([], []))
        points.append(mesh.points[facet[:count]])
        values.append([by_node.get(int(n) + 1, 0.0) for n in facet[:count]])
    return [(kind, np.array(points), np.array(values)) for kind, (points, values) in groups.items()]
