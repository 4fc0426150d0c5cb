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

OPPOSITE = -0.3  # cosine


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


def nearest_of_faces(shape, nodes, points):
    """Of each face the point nearest to the point with the same number. Returns places and unit normals there (of the order of the nodes)."""
    r, places = solve(shape, nodes, points)
    tangents = FUNCTIONS[shape].derivatives(r) @ nodes
    if elements.family(shape) == "line":
        normals = np.column_stack((tangents[:, 0, 1], -tangents[:, 0, 0], np.zeros(len(r))))
    else:
        normals = np.cross(tangents[:, 0], tangents[:, 1])
        for edge in edges(shape):
            _, on_edge = solve(f"line{len(edge)}", nodes[:, edge], points)
            nearer = np.linalg.norm(points - on_edge, axis=1) < np.linalg.norm(points - places, axis=1)
            places = np.where(nearer[:, None], on_edge, places)
    return places, normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]


def edges(shape):
    """Places of the nodes of a face's edges: corners, then the middle."""
    of = elements.family(shape)
    second = elements.NODES[shape] != elements.CORNERS[of]
    return [[*pair, elements.CORNERS[of] + k] if second else list(pair) for k, pair in enumerate(elements.EDGES[of])]


def candidates(boxes, points, reach):
    """(face, point) where the point is within `reach` of the face's box. boxes: lowest and highest corners, (faces, 3) each."""
    low, high = boxes[0] - reach, boxes[1] + reach
    axis = int(np.argmax(np.ptp(points, axis=0)))
    order = np.argsort(points[:, axis], kind="stable")
    line = points[order, axis]
    found = []
    for face, (first, last) in enumerate(zip(np.searchsorted(line, low[:, axis]), np.searchsorted(line, high[:, axis], "right"))):
        near = order[first:last]
        near = near[np.all((points[near] >= low[face]) & (points[near] <= high[face]), axis=1)]
        found.append(np.column_stack((np.full(len(near), face), near)))
    return np.concatenate(found) if found else np.zeros((0, 2), int)


def nearest(faces, points, reach, looks=None):
    """The nearest places on faces within `reach` of points (n, 3). faces: (shape, places of the nodes, a point behind the face) of each;
    looks: directions of each point (n, any, 3), to one of which a face has to be opposite; zeros are none. Returns places (n, 3), outward unit normals there (n, 3) and distances (n), infinite where no face is that near."""
    places, normals, distances = np.zeros((len(points), 3)), np.zeros((len(points), 3)), np.full(len(points), np.inf)
    for shape in sorted({face[0] for face in faces}):
        nodes = np.array([face[1] for face in faces if face[0] == shape], dtype=float)
        behind = np.array([face[2] for face in faces if face[0] == shape], dtype=float)
        pairs = candidates((nodes.min(axis=1), nodes.max(axis=1)), points, reach)
        if not len(pairs):
            continue
        at, normal = nearest_of_faces(shape, nodes[pairs[:, 0]], points[pairs[:, 1]])
        inward = np.einsum("pc,pc->p", normal, nodes[pairs[:, 0]].mean(axis=1) - behind[pairs[:, 0]]) < 0
        normal[inward] *= -1
        distance = np.linalg.norm(at - points[pairs[:, 1]], axis=1)
        if looks is not None:
            distance[np.einsum("pkc,pc->pk", looks[pairs[:, 1]], normal).min(axis=1) > OPPOSITE] = np.inf
        for k in np.argsort(-distance, kind="stable"):  # the nearest one is the last
            point = pairs[k, 1]
            if distance[k] <= min(reach, distances[point]):
                places[point], normals[point], distances[point] = at[k], normal[k], distance[k]
    return places, normals, distances
