"""The nearest point of faces of the mesh to points: of all shapes of faces, plane or not, for many points at once."""

import numpy as np

import elements

CORNERS = {
    "line": [(-1,), (1,)],
    "tri": [(0, 0), (1, 0), (0, 1)],
    "quad": [(-1, -1), (1, -1), (1, 1), (-1, 1)],
}
EXPONENTS = {
    "line2": [(0,), (1,)],
    "line3": [(0,), (1,), (2,)],
    "tri3": [(0, 0), (1, 0), (0, 1)],
    "tri6": [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)],
    "quad4": [(0, 0), (1, 0), (0, 1), (1, 1)],
    "quad8": [(0, 0), (1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (2, 1), (1, 2)],
}
STEPS, CLOSE = 30, 1e-12  # of Gauss and Newton; the last step in reference coordinates

OPPOSITE = -0.3  # cosine of directions that lie opposite
BULGE, AT_ONCE = 1.1, 500  # how far faces reach beyond their nodes; points that are looked for together


class Functions:
    """Shape functions of a face and their derivatives at many reference points, as polynomials."""

    def __init__(self, shape):
        corners = np.array(CORNERS[elements.family(shape)], dtype=float)
        middles = [(corners[a] + corners[b]) / 2 for a, b in elements.EDGES[elements.family(shape)]]
        nodes = np.array([*corners, *middles])[: elements.NODES[shape]]
        self.exponents = np.array(EXPONENTS[shape])
        self.coefficients = np.linalg.inv(self.monomials(nodes, self.exponents))

    @staticmethod
    def monomials(r, exponents):
        return np.prod(r[:, None, :] ** np.maximum(exponents, 0), axis=2)

    def values(self, r):
        """Shape (points, nodes)."""
        return self.monomials(r, self.exponents) @ self.coefficients

    def derivatives(self, r):
        """Shape (points, directions, nodes)."""
        parts = []
        for d in range(r.shape[1]):
            lower = self.exponents.copy()
            lower[:, d] -= 1
            parts.append((self.exponents[:, d] * self.monomials(r, lower)) @ self.coefficients)
        return np.stack(parts, axis=1)


FUNCTIONS = {shape: Functions(shape) for shape in EXPONENTS}


def limited(of, r):
    """Reference points, those outside of the face brought to its border."""
    if of == "tri":
        r = np.maximum(r, 0)
        return r / np.maximum(1, r.sum(axis=1))[:, None]
    return np.clip(r, -1, 1)


def solve(shape, nodes, points):
    """Points of faces, one of each, nearest to `points`, inside or on the way out. Arguments: nodes (n, nodes, 3), points (n, 3).
    Returns reference points and places, which are the nearest ones of lines, and of faces where they are inside and orthogonal."""
    functions, of = FUNCTIONS[shape], elements.family(shape)
    r = np.tile(np.mean(CORNERS[of], axis=0), (len(points), 1))
    for _ in range(STEPS):
        tangents = functions.derivatives(r) @ nodes
        off = points - np.einsum("pn,pnc->pc", functions.values(r), nodes)
        matrix = tangents @ tangents.transpose(0, 2, 1)
        matrix += 1e-14 * np.trace(matrix, axis1=1, axis2=2)[:, None, None] * np.eye(matrix.shape[1])
        ahead = limited(of, r + np.linalg.solve(matrix, np.einsum("pdc,pc->pd", tangents, off)[:, :, None])[:, :, 0])
        step, r = np.abs(ahead - r).max(), ahead
        if step < CLOSE:
            break
    return r, np.einsum("pn,pnc->pc", functions.values(r), nodes)


def normals_at(shape, nodes, r):
    """Unit normals of faces at reference points, one of each, as the order of the nodes has them."""
    tangents = FUNCTIONS[shape].derivatives(r) @ nodes
    if elements.family(shape) == "line":
        normals = np.column_stack((tangents[:, 0, 1], -tangents[:, 0, 0], np.zeros(len(r))))
    else:
        normals = np.cross(tangents[:, 0], tangents[:, 1])
    return normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]


def outward(normals, nodes, behind):
    """The same normals, those that point to the places behind their faces the other way round."""
    return normals * np.where(np.einsum("pc,pc->p", normals, nodes.mean(axis=1) - behind) < 0, -1, 1)[:, None]


def by_shape(faces):
    """(shape, nodes, places behind them) of the faces of each shape, in order."""
    for shape in sorted({face[0] for face in faces}):
        yield shape, *(np.array([face[i] for face in faces if face[0] == shape], dtype=float) for i in (1, 2))


def middle_normals(faces):
    """Outward unit normals at the middles of faces as nearest() has them. Shape (faces, 3)."""
    of = {shape: iter(Group(shape, *rest).normals) for shape, *rest in by_shape(faces)}
    return np.array([next(of[face[0]]) for face in faces])


def nearest_of_faces(shape, nodes, points):
    """Of each face the point nearest to the point with the same number. Returns places and unit normals there (of the order of the nodes)."""
    r, places = solve(shape, nodes, points)
    if elements.family(shape) != "line":
        for edge in edges(shape):
            _, on_edge = solve(f"line{len(edge)}", nodes[:, edge], points)
            nearer = np.linalg.norm(points - on_edge, axis=1) < np.linalg.norm(points - places, axis=1)
            places = np.where(nearer[:, None], on_edge, places)
    return places, normals_at(shape, nodes, r)


def edges(shape):
    """Places of the nodes of a face's edges: corners, then the middle."""
    of = elements.family(shape)
    second = elements.NODES[shape] != elements.CORNERS[of]
    return [[*pair, elements.CORNERS[of] + k] if second else list(pair) for k, pair in enumerate(elements.EDGES[of])]


class Group:
    """Faces of one shape, with what finds those that may be nearest to a point."""

    def __init__(self, shape, nodes, behind):
        self.shape, self.nodes, self.behind = shape, nodes, behind
        self.centers = nodes.mean(axis=1)
        self.radii = BULGE * np.linalg.norm(nodes - self.centers[:, None], axis=2).max(axis=1)
        r = np.tile(np.mean(CORNERS[elements.family(shape)], axis=0), (len(nodes), 1))
        self.normals = outward(normals_at(shape, nodes, r), nodes, behind)

    def candidates(self, points, looks, reach):
        """(face, point) of all faces that may be the nearest one within `reach` of a point."""
        around = np.linalg.norm(np.maximum(points.min(axis=0) - self.centers, self.centers - points.max(axis=0)).clip(0), axis=1)
        faces = np.flatnonzero(around <= self.radii + reach)
        if not len(faces):
            return np.zeros((0, 2), int)
        axis = int(np.argmax(np.ptp(points, axis=0)))
        order = np.argsort(points[:, axis], kind="stable")
        line, far = points[order, axis], self.radii[faces] + reach
        first, last = (np.searchsorted(line, self.centers[faces, axis] + sign * far, side) for sign, side in ((-1, "left"), (1, "right")))
        pairs = np.column_stack((np.repeat(faces, last - first), order[np.concatenate([np.arange(a, b) for a, b in zip(first, last)])]))
        off = np.linalg.norm(points[pairs[:, 1]] - self.centers[pairs[:, 0]], axis=1)
        radii = self.radii[pairs[:, 0]]
        kept = sure = off <= radii + reach
        if looks is not None:  # on both sides of the limit, for faces are curved
            cosine = np.einsum("pkc,pc->pk", looks[pairs[:, 1]], self.normals[pairs[:, 0]]).min(axis=1)
            kept, sure = kept & (cosine <= OPPOSITE + 0.3), sure & (cosine <= OPPOSITE - 0.3)
        most = np.full(len(points), np.inf)
        np.minimum.at(most, pairs[sure, 1], (off + radii)[sure])
        return pairs[kept & (off - radii <= most[pairs[:, 1]])]

    def nearest(self, points, looks, reach):
        """(numbers of points, places, normals, distances) of the nearest places within `reach`, one for each point that has any."""
        pairs = self.candidates(points, looks, reach)
        own, place = self.nodes[pairs[:, 0]], points[pairs[:, 1]]
        at, normal = nearest_of_faces(self.shape, own, place) if len(pairs) else (place, place)
        normal = outward(normal, own, self.behind[pairs[:, 0]])
        distance = np.linalg.norm(at - place, axis=1)
        kept = distance <= reach
        if looks is not None:
            kept &= np.einsum("pkc,pc->pk", looks[pairs[:, 1]], normal).min(axis=1) <= OPPOSITE
        order = np.flatnonzero(kept)[np.lexsort((distance[kept], pairs[kept, 1]))]
        found, first = np.unique(pairs[order, 1], return_index=True)
        return found, at[order[first]], normal[order[first]], distance[order[first]]


def nearest(faces, points, reach, looks=None):
    """The nearest places on faces within `reach` of points (n, 3). faces: (shape, places of the nodes, a point behind the face) of each;
    looks: directions of each point (n, any, 3), to one of which a face has to be opposite; zeros are none.
    Returns places (n, 3), outward unit normals there (n, 3) and distances (n), infinite where no face is that near."""
    places, normals, distances = np.zeros((len(points), 3)), np.zeros((len(points), 3)), np.full(len(points), np.inf)
    groups = [Group(*group) for group in by_shape(faces)]
    radius = min(reach, min((group.radii.mean() for group in groups), default=reach))
    left = np.argsort(points[:, int(np.argmax(np.ptp(points, axis=0)))], kind="stable")
    while True:
        for some in np.array_split(left, 1 + len(left) // AT_ONCE):
            for group in groups:
                found, at, normal, distance = group.nearest(points[some], None if looks is None else looks[some], radius)
                better = distance < distances[some[found]]
                own = some[found[better]]
                places[own], normals[own], distances[own] = at[better], normal[better], distance[better]
        left = left[np.isinf(distances[left])]
        if radius >= reach or not len(left):
            return places, normals, distances
        radius = min(reach, 4 * radius)
