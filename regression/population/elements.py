"""Stiffness and loads of all cells, written without a look at the program's: polynomials from nodes, Gauss points, loops in numpy.

Strains: xx yy zz xy yz zx; in planes zz is zero (plane strain) or eliminated (plane stress), in axisymmetry the hoop strain.
"""

import itertools

import numpy as np

import meshes

MONOMIALS = {
    "line2": [(0,), (1,)], "line3": [(0,), (1,), (2,)], "tri3": [(0, 0), (1, 0), (0, 1)],
    "tri6": [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)],
    "quad4": list(itertools.product(range(2), repeat=2)), "quad9": list(itertools.product(range(3), repeat=2)),
    "tet4": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    "tet10": [m for m in itertools.product(range(3), repeat=3) if sum(m) <= 2],
    "hex8": list(itertools.product(range(2), repeat=3)), "hex27": list(itertools.product(range(3), repeat=3)),
    "prism6": [(a, b, c) for a, b in ((0, 0), (1, 0), (0, 1)) for c in range(2)],
}
MONOMIALS["quad8"] = [m for m in MONOMIALS["quad9"] if sum(e for e in m if e > 1) <= 2]
MONOMIALS["hex20"] = [m for m in MONOMIALS["hex27"] if sum(e for e in m if e > 1) <= 2]
MONOMIALS["prism15"] = [(a, b, c) for a, b in MONOMIALS["tri6"] for c in range(2)] + [(0, 0, 2), (1, 0, 2), (0, 1, 2)]
CORNERS = {"line": [(-1,), (1,)], "tri": [(0, 0), (1, 0), (0, 1)], "quad": [(-1, -1), (1, -1), (1, 1), (-1, 1)],
           "tet": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
           "hex": [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)],
           "prism": [(0, 0, -1), (1, 0, -1), (0, 1, -1), (0, 0, 1), (1, 0, 1), (0, 1, 1)]}
SHAPE = {**meshes.SHAPE, "line2": "line", "line3": "line"}


def nodes(element):
    shape = SHAPE[element]
    corners = np.array(CORNERS[shape], float)
    if element in meshes.SECOND or element == "line3":
        groups = meshes.EDGES[shape] + (meshes.MIDDLES.get(shape, []) if element in meshes.FULL else [])
        corners = np.vstack([corners] + [corners[list(group)].mean(axis=0) for group in groups])
    return corners


def functions(element, points):
    """Values (points, nodes) and derivatives (points, nodes, axes) of the shape functions."""
    powers = np.array(MONOMIALS[element])
    value = lambda x, p: np.prod(x[:, None, :] ** p[None], axis=2)
    inverse = np.linalg.inv(value(nodes(element), powers))
    derivatives = []
    for axis in range(powers.shape[1]):
        lower = powers.copy()
        lower[:, axis] = np.maximum(lower[:, axis] - 1, 0)
        derivatives.append((value(points, lower) * powers[:, axis]) @ inverse)
    return value(points, powers) @ inverse, np.stack(derivatives, axis=2)


def rule(element):
    """Integration points and weights."""
    shape, second = SHAPE[element], element in meshes.SECOND or element == "line3"
    x, w = np.polynomial.legendre.leggauss(3 if second else 2)
    triangle = np.array([(1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3)]), np.full(3, 1 / 6)
    if second:  # six points, degree 4
        a, b, u, v = 0.445948490915965, 0.091576213509771, 0.223381589678011 / 2, 0.109951743655322 / 2
        triangle = np.array([(a, a), (1 - 2 * a, a), (a, 1 - 2 * a), (b, b), (1 - 2 * b, b), (b, 1 - 2 * b)]), np.array([u] * 3 + [v] * 3)
    if shape == "tri":
        return triangle
    if shape == "prism":
        return (np.array([(*p, z) for p in triangle[0] for z in x]), np.array([a * b for a in triangle[1] for b in w]))
    if element == "tet10":  # of degree 5, fourteen points [Walkington]: on curved edges no rule is exact, so the program's is taken
        places, sizes = [], []
        for a, weight in ((0.31088591926330060980, 0.11268792571801585080), (0.092735250310891226402, 0.073493043116361949544)):
            places += [(a, a, a), (1 - 3 * a, a, a), (a, 1 - 3 * a, a), (a, a, 1 - 3 * a)]
            sizes += [weight / 6] * 4
        a = 0.045503704125649649492
        places += [tuple(a if axis in pair else 0.5 - a for axis in range(3)) for pair in itertools.combinations(range(4), 2)]
        return np.array(places), np.array(sizes + [0.042546020777081466438 / 6] * 6)
    if shape == "tet":  # a cube's rule with three corners in one
        x, w = (x + 1) / 2, w / 2
        places = [(a * (1 - b) * (1 - c), b * (1 - c), c) for a, b, c in itertools.product(x, repeat=3)]
        sizes = [(1 - b) * (1 - c) ** 2 for _, b, c in itertools.product(x, repeat=3)]
        return np.array(places), np.array(sizes) * [u * v * s for u, v, s in itertools.product(w, repeat=3)]
    axes = {"line": 1, "quad": 2, "hex": 3}[shape]
    return np.array(list(itertools.product(x, repeat=axes))), np.array([np.prod(c) for c in itertools.product(w, repeat=axes)])


def elasticity(young, nu, kind):
    shear, lame = young / (2 * (1 + nu)), young * nu / ((1 + nu) * (1 - 2 * nu))
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = lame
    matrix[range(6), range(6)] += [2 * shear] * 3 + [shear] * 3
    if kind == "plane_stress":
        matrix -= np.outer(matrix[:, 2], matrix[2]) / matrix[2, 2]
    return matrix


def strains(gradient, axes, hoop=None):
    """B (cells, 6, unknowns) from gradients (cells, functions, axes); hoop: the functions over the radius."""
    cells, count, _ = gradient.shape
    b = np.zeros((cells, 6, count, axes))
    for i in range(axes):
        b[:, i, :, i] = gradient[:, :, i]
    for row, (i, j) in ((3, (0, 1)), (4, (1, 2)), (5, (2, 0))):
        if max(i, j) < axes:
            b[:, row, :, i], b[:, row, :, j] = gradient[:, :, j], gradient[:, :, i]
    if hoop is not None:
        b[:, 2, :, 0] = hoop
    return b.reshape(cells, 6, count * axes)


def cell_matrices(points, cells, element, kind, young, nu, formulation="standard"):
    """Stiffness of each cell (cells, unknowns, unknowns)."""
    x, axes = points[cells], points.shape[1]
    at, weights = rule(element)
    values, derivatives = functions(element, at)
    d = elasticity(young, nu, kind)
    parts, volumes = [], []
    for q in range(len(at)):
        jacobian = np.einsum("cni,na->cia", x, derivatives[q])
        radius = np.einsum("cn,n->c", x[:, :, 0], values[q]) if kind == "axisymmetric" else None
        hoop = values[q][None] / radius[:, None] if radius is not None else None
        volumes.append(weights[q] * np.linalg.det(jacobian) * (2 * np.pi * radius if radius is not None else 1))
        parts.append(strains(np.einsum("na,cai->cni", derivatives[q], np.linalg.inv(jacobian)), axes, hoop))
    if formulation == "bbar":
        parts = mean_dilatation(parts, volumes)
    stiffness = sum(np.einsum("csi,st,ctj,c->cij", b, d, b, v, optimize=True) for b, v in zip(parts, volumes))
    return condensed(stiffness, x, at, weights, parts, volumes, d, element) if formulation == "incompatible" else stiffness


def mean_dilatation(parts, volumes):
    trace = [b[:, :3].sum(axis=1) for b in parts]
    mean = sum(t * v[:, None] for t, v in zip(trace, volumes)) / sum(volumes)[:, None]
    changed = []
    for b, t in zip(parts, trace):
        new = b.copy()
        new[:, :3] += ((mean - t) / 3)[:, None]
        changed.append(new)
    return changed


def condensed(stiffness, x, at, weights, parts, volumes, d, element):
    """Without the incompatible modes 1 - xi^2 of Taylor, Beresford and Wilson."""
    axes = x.shape[2]
    middle = functions(element, np.zeros((1, axes)))[1][0]
    centre = np.einsum("cni,na->cia", x, middle)
    inverse, size = np.linalg.inv(centre), np.linalg.det(centre)
    cross = inner = 0
    for q, (b, v) in enumerate(zip(parts, volumes)):
        modes = np.diag(-2 * at[q])
        scale = size / (v / weights[q])
        g = strains(np.einsum("na,cai->cni", modes, inverse) * scale[:, None, None], axes)
        cross = cross + np.einsum("csi,st,ctj,c->cij", g, d, b, v, optimize=True)
        inner = inner + np.einsum("csi,st,ctj,c->cij", g, d, g, v, optimize=True)
    return stiffness - np.einsum("cki,ckj->cij", cross, np.linalg.solve(inner, cross))


def face_points(points, faces, element, kind):
    """At each integration point of faces: shape functions, normal times area (faces, axes), points outwards of nothing in particular."""
    x = points[faces]
    at, weights = rule(element)
    values, derivatives = functions(element, at)
    for q in range(len(at)):
        tangents = np.einsum("cni,na->cia", x, derivatives[q])
        normal = np.column_stack([tangents[:, 1, 0], -tangents[:, 0, 0]]) if points.shape[1] == 2 else np.cross(tangents[:, :, 0], tangents[:, :, 1])
        factor = weights[q] * (2 * np.pi * np.einsum("cn,n->c", x[:, :, 0], values[q]) if kind == "axisymmetric" else np.ones(len(x)))
        yield values[q], normal * factor[:, None]


def body_forces(points, cells, element, kind):
    """Integrals of the shape functions over cells, summed at the nodes."""
    at, weights = rule(element)
    values, derivatives = functions(element, at)
    total = np.zeros(len(points))
    for q in range(len(at)):
        volume = weights[q] * np.linalg.det(np.einsum("cni,na->cia", points[cells], derivatives[q]))
        if kind == "axisymmetric":
            volume = volume * 2 * np.pi * (points[cells][:, :, 0] @ values[q])
        np.add.at(total, cells, volume[:, None] * values[q][None])
    return total
