"""Finite elements once more, for judging: integrals over the cells of a .vtu of what stresses differ from an exact field by.

Written from the definitions, not from lib/fem: shape functions by inverting a Vandermonde matrix at VTK's reference nodes, integration
by Gauss's rules (collapsed on triangles and tetrahedra). Formulations bbar (Hughes 1980) and incompatible (Wilson 1973, Taylor 1976) as
their papers have them.
"""

import itertools

import numpy as np

CORNERS = {
    "tri": [(0, 0), (1, 0), (0, 1)],
    "quad": [(-1, -1), (1, -1), (1, 1), (-1, 1)],
    "tet": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    "hex": [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)],
    "prism": [(0, 0, -1), (1, 0, -1), (0, 1, -1), (0, 0, 1), (1, 0, 1), (0, 1, 1)],
}
EDGES = {
    "tri": [(0, 1), (1, 2), (2, 0)],
    "quad": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "tet": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
    "hex": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
    "prism": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
}
FACES = {
    "quad": [(0, 1, 2, 3)],
    "hex": [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 1, 2, 3), (4, 5, 6, 7), tuple(range(8))],
    "prism": [(0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
}
# VTK's type: shape, edges' nodes, faces' nodes.
KINDS = {
    5: ("tri", 0, 0),
    22: ("tri", 1, 0),
    9: ("quad", 0, 0),
    23: ("quad", 1, 0),
    28: ("quad", 1, 1),
    10: ("tet", 0, 0),
    24: ("tet", 1, 0),
    12: ("hex", 0, 0),
    25: ("hex", 1, 0),
    29: ("hex", 1, 1),
    13: ("prism", 0, 0),
    26: ("prism", 1, 0),
    32: ("prism", 1, 1),
}


def exponents(shape, edges, faces):
    """Monomials that span the shape functions."""
    order = 2 if edges else 1
    d = len(CORNERS[shape][0])
    powers = list(itertools.product(range(order + 1), repeat=d))
    if shape in ("tri", "tet"):
        return [p for p in powers if sum(p) <= order]
    if shape == "prism":
        inside = [p for p in powers if p[0] + p[1] <= order]
        return (
            inside
            if faces or not edges
            else [p for p in inside if sum(p) <= 2 or (p[2] == 1 and p[0] + p[1] == 2) or (p[2] == 2 and p[0] + p[1] == 1)]
        )
    if not edges or faces:
        return powers
    return [p for p in powers if sum(e for e in p if e > 1) <= 2]  # serendipity: superlinear degree two at most


class Reference:
    def __init__(self, kind):
        self.shape, edges, faces = KINDS[kind]
        corners = np.array(CORNERS[self.shape], float)
        nodes = [*corners]
        if edges:
            nodes += [corners[list(e)].mean(axis=0) for e in EDGES[self.shape]]
        if faces:
            nodes += [corners[list(f)].mean(axis=0) for f in FACES.get(self.shape, [])]
        self.nodes, self.dimension = np.array(nodes), corners.shape[1]
        self.powers = np.array(exponents(self.shape, edges, faces))
        assert len(self.powers) == len(self.nodes), (kind, len(self.powers), len(self.nodes))
        self.coefficients = np.linalg.inv(np.prod(self.nodes[:, None, :] ** self.powers, axis=2))

    def values(self, at):
        return np.prod(at[:, None, :] ** self.powers, axis=2) @ self.coefficients

    def gradients(self, at):
        """points x nodes x dimension."""
        result = []
        for k in range(self.dimension):
            lowered = self.powers.copy()
            lowered[:, k] = np.maximum(lowered[:, k] - 1, 0)
            result.append((np.prod(at[:, None, :] ** lowered, axis=2) * self.powers[:, k]) @ self.coefficients)
        return np.stack(result, axis=2)

    def rule(self, points):
        return rule(self.shape, points)


def rule(shape, points):
    """Integration points and weights on a reference cell, `points` Gauss points an axis."""
    x, w = np.polynomial.legendre.leggauss(points)
    d = len(CORNERS[shape][0])
    grid = np.array(list(itertools.product(x, repeat=d)))
    weight = np.prod(list(itertools.product(w, repeat=d)), axis=1)
    if shape in ("quad", "hex"):
        return grid, weight
    unit = (grid + 1) / 2
    if shape == "tet":
        a, b, c = unit.T
        return np.stack([a, b * (1 - a), c * (1 - a) * (1 - b)], axis=1), weight / 8 * (1 - a) ** 2 * (1 - b)
    a, b = unit[:, 0], unit[:, 1]
    flat = np.stack([a, b * (1 - a)], axis=1)
    weight = weight / 4 * (1 - a)
    return (flat, weight) if shape == "tri" else (np.column_stack([flat, grid[:, 2]]), weight)


def geometry(reference, x, at):
    """Jacobians dx/dxi (cells x points x d x d), their determinants, gradients of the shape functions in space."""
    gradient = reference.gradients(at)
    jacobian = np.einsum("cna,qnk->cqak", x, gradient)
    return jacobian, np.linalg.det(jacobian), np.einsum("qnk,cqka->cqna", gradient, np.linalg.inv(jacobian))


def lame(material, kinematics):
    e, nu = material
    mu = e / (2 * (1 + nu))
    return (e * nu / (1 - nu * nu) if kinematics == "plane_stress" else e * nu / ((1 + nu) * (1 - 2 * nu))), mu


def mode_gradients(reference, x, at):
    """Of the incompatible modes 1 - xi_k^2, taken with the Jacobian of the centre: cells x points x d x d."""
    centre, _, _ = geometry(reference, x, np.zeros((1, reference.dimension)))
    _, determinant, _ = geometry(reference, x, at)
    ratio = np.linalg.det(centre[:, 0])[:, None] / determinant
    return -2 * np.einsum("qk,cq,cka->cqka", at, ratio, np.linalg.inv(centre[:, 0]))


def mode_amplitudes(reference, x, u, constants):
    """What each cell eliminates: cells x modes x d."""
    at, w = reference.rule(2)
    _, determinant, gradient = geometry(reference, x, at)
    modes, volume = mode_gradients(reference, x, at), np.abs(determinant) * w
    d, (lam, mu) = reference.dimension, constants
    both = lambda f, g: (
        lam * np.einsum("cq,cqia,cqjb->ciajb", volume, f, g)
        + mu * np.einsum("cq,cqib,cqja->ciajb", volume, f, g)
        + mu * np.einsum("cq,cqik,cqjk,ab->ciajb", volume, f, g, np.eye(d))
    )
    cells = len(x)
    right = np.einsum("ciajb,cjb->cia", both(modes, gradient), u).reshape(cells, -1, 1)
    return -np.linalg.solve(both(modes, modes).reshape(cells, d * d, d * d), right).reshape(cells, d, d)


def displacement_gradients(reference, x, u, at, formulation, constants):
    """cells x points x 3 x 3, as the formulation has them."""
    _, _, gradient = geometry(reference, x, at)
    d = reference.dimension
    h = np.zeros(gradient.shape[:2] + (3, 3))
    h[..., :d, :d] = np.einsum("cna,cqnb->cqab", u, gradient)
    if formulation == "bbar":
        own, w = reference.rule(2)
        _, determinant, inner = geometry(reference, x, own)
        volume = np.abs(determinant) * w
        mean = np.einsum("cq,cna,cqna->c", volume, u, inner) / volume.sum(axis=1)
        h[..., range(3), range(3)] += ((mean[:, None] - np.trace(h, axis1=2, axis2=3)) / 3)[..., None]
    elif formulation == "incompatible":
        h[..., :d, :d] += np.einsum("cka,cqkb->cqab", mode_amplitudes(reference, x, u, constants), mode_gradients(reference, x, at))
    return h


def stress_of(h, constants, kinematics):
    strain = (h + np.swapaxes(h, -1, -2)) / 2
    lam, mu = constants
    s = lam * np.trace(strain, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) + 2 * mu * strain
    if kinematics == "plane_stress":
        s[..., 2, 2] = 0
    return s


def complementary(s, material):
    """s : C^-1 : s."""
    e, nu = material
    return ((1 + nu) * np.einsum("...ab,...ab->...", s, s) - nu * np.trace(s, axis1=-2, axis2=-1) ** 2) / e


def squared_norms(grid, materials, kinematics, exact=None, formulation="standard", points=4):
    """The squared energy norm of the finite elements' stress, and of what it differs from exact(x, body) by (points x 3 x 3 for
    points x 3). materials: (E, nu) of each body; integrated over the cells as meshed."""
    norm = difference = 0.0
    for kind, numbers, nodes in grid.groups():
        reference = Reference(kind)
        d = reference.dimension
        at, weight = reference.rule(points)
        for body in np.unique(grid.cell_fields["body"][numbers]):
            cells = nodes[grid.cell_fields["body"][numbers] == body]
            x, u = grid.points[cells][..., :d], grid.fields["displacement"][cells][..., :d]
            constants = lame(materials[body], kinematics)
            _, determinant, _ = geometry(reference, x, at)
            volume = np.abs(determinant) * weight
            s = stress_of(displacement_gradients(reference, x, u, at, formulation, constants), constants, kinematics)
            norm += float((volume * complementary(s, materials[body])).sum())
            if exact is not None:
                place = np.einsum("qn,cna->cqa", reference.values(at), grid.points[cells])
                difference += float((volume * complementary(s - exact(place, body), materials[body])).sum())
    return norm, difference
