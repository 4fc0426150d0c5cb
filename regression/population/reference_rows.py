"""Rows of contact: gaps and directions of the nodes of secondary sides, opposite obstacles, matching meshes and flat grids."""

import numpy as np
import scipy.sparse as sparse

import elements
import meshes
from reference_problem import Skip


def control(kind):
    """Control values of a face from nodal ones: those of Bernstein's polynomials."""
    shape = elements.SHAPE[kind]
    matrix = np.eye(len(elements.nodes(kind)))
    if kind in meshes.SECOND or kind == "line3":
        corner = len(elements.CORNERS[shape])
        for i, (a, b) in enumerate(meshes.EDGES[shape]):
            matrix[corner + i, [a, b]] = -0.5
            matrix[corner + i, corner + i] = 2
        if kind == "quad9":
            matrix[8, :4], matrix[8, 4:8], matrix[8, 8] = 0.25, -1, 4
    return matrix


class Side:
    """The nodes of a boundary, the matrix to control values, the area that each carries, its faces; `counts`: which of these."""

    def __init__(self, problem, name, counts=None):
        self.name, self.kinds = name, problem.faces[name]
        if counts is not None:
            self.kinds = {kind: faces[counts(faces)] for kind, faces in self.kinds.items()}
        self.nodes = np.unique(np.concatenate([f.ravel() for f in self.kinds.values()]))
        self.points = problem.points[self.nodes]
        local = {node: i for i, node in enumerate(self.nodes)}
        self.control = sparse.lil_matrix((len(self.nodes), len(self.nodes)))
        self.area, self.outward = np.zeros(len(self.nodes)), np.zeros(self.points.shape)
        for kind, faces in self.kinds.items():
            matrix, inverse = control(kind), np.linalg.inv(control(kind))
            numbers = np.array([[local[n] for n in face] for face in faces])
            for face in numbers:
                self.control[face[:, None], face] = matrix
            for values, normal in elements.face_points(problem.points, faces, kind, problem.kind):
                share = np.linalg.norm(normal, axis=1)[:, None] * (values @ inverse)[None]
                np.add.at(self.area, numbers, share)
                np.add.at(self.outward, numbers, np.abs(values)[None, :, None] * normal[:, None])
        self.control = self.control.tocsr()


class Rows:
    """Of one contact: normal and tangential rows (points, unknowns), directions, gaps, areas, law."""

    def __init__(self, normal, tangents, normals, gap, area, friction):
        self.normal, self.tangents, self.normals = normal, tangents, normals
        self.gap, self.area, self.friction = gap, area, friction


def vector_rows(problem, matrix, nodes, directions):
    """Rows that see sum_j matrix_ij u_j along direction_i."""
    matrix = matrix.tocoo()
    rows, columns, values = [], [], []
    for axis in range(problem.axes):
        rows.append(matrix.row)
        columns.append(nodes[matrix.col] * problem.axes + axis)
        values.append(matrix.data * directions[matrix.row, axis])
    return sparse.csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(matrix.shape[0], problem.count))


def tangents(normals):
    """One or two directions across each normal."""
    if normals.shape[1] == 2:
        return [np.column_stack([-normals[:, 1], normals[:, 0]])]
    other = np.where(np.abs(normals[:, [2]]) < 0.5, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    first = np.cross(normals, other)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return [first, np.cross(normals, first)]


def search_distance(contact, side, problem):
    """Farther than this from each other sides never meet, and Tresca's bound, which holds across gaps, ends."""
    longest = max(np.linalg.norm(problem.points[a] - problem.points[b], axis=1).max() for faces in side.kinds.values()
                  for a in faces.T for b in faces.T)
    return contact.get("search_distance", 0) or max(0.1 * np.linalg.norm(np.ptp(side.points, axis=0)), longest)


def obstacle_rows(problem, contact, side):
    """Nodes against a plane or a circle; the direction points from the obstacle to the body. Faces count if all their nodes are near."""
    normals, gap = obstacle_directions(contact, side)
    near = np.zeros(len(problem.points), bool)
    near[side.nodes] = np.abs(gap) <= search_distance(contact, side, problem)
    if not any(near[faces].all(axis=1).any() for faces in side.kinds.values()):
        raise Skip("an obstacle out of reach")
    if not near[side.nodes].all():
        side = Side(problem, side.name, lambda faces: near[faces].all(axis=1))
        normals, gap = obstacle_directions(contact, side)
    return make_rows(problem, contact, side, normals, gap, [(side.control, side.nodes)])


def obstacle_directions(contact, side):
    (shape, keys), = contact["primary"].items()
    if shape == "plane":
        normal = np.array(keys["normal"]) / np.linalg.norm(keys["normal"])
        normals, gap = np.tile(normal, (len(side.nodes), 1)), (side.points - keys["point"]) @ normal
    else:
        across = side.points - np.array(keys["point"])
        across[:, 2:] = 0
        distance = np.linalg.norm(across, axis=1)
        normals, gap = across / distance[:, None], distance - keys["radius"]
    return normals, gap


def make_rows(problem, contact, side, normals, gap, terms, fixed=None):
    """gap is nodal; terms: (matrix, nodes) that add up to the relative displacement; fixed(directions): where supports hold what lies
    opposite, everywhere if it is not given."""
    friction, held = contact.get("friction", {}), held_along(problem, side, normals)
    if held.any() and "tresca" in friction:
        raise Skip("a contact that supports hold along its normal")
    see = lambda d: sum(vector_rows(problem, matrix, nodes, d) for matrix, nodes in terms).tocsr()
    normal = see(normals)
    free = np.ones(problem.count)
    free[list(problem.held)] = 0
    kept = (abs(normal) @ free > 1e-12) & ~(held & (len(terms) == 1))
    # Where supports hold the secondary node along a tangent, the other side feels the friction all the same if it moves.
    moves = lambda d: ~held_along(problem, side, d) | (~fixed(d) if fixed else False)
    across = [see(d * (held | moves(d))[:, None])[kept] for d in tangents(normals)]
    return Rows(normal[kept], across, normals[kept], (side.control @ gap)[kept], side.area[kept], friction)


def held_along(problem, side, normals):
    """Which nodes of a side supports hold along the given directions. Held along their normals they have rows that the primary side alone
    feels, and none over an obstacle."""
    held = np.array([[node * problem.axes + axis in problem.held for axis in range(problem.axes)] for node in side.nodes])
    return np.any(held & (np.abs(normals) > 1e-6), axis=1)


def opposite_held(problem, side, other, paired, directions):
    """Where supports hold the other side along the directions: the partners of matching nodes, else all nodes of its flat face at the same
    place along them."""
    if paired is not None:
        held = np.array([[node * problem.axes + axis in problem.held for axis in range(problem.axes)] for node in paired])
        return np.any(held & (np.abs(directions) > 1e-6), axis=1)
    size = np.ptp(problem.points, axis=0).max()
    result = np.zeros(len(side.nodes), bool)
    for i, direction in enumerate(directions):
        axis = np.abs(direction).argmax()
        same = other.nodes[np.abs(other.points[:, axis] - side.points[i, axis]) < 1e-9 * size]
        result[i] = len(same) > 0 and all(node * problem.axes + axis in problem.held for node in same)
    return result


def partners(problem, side, other):
    """The node of the other side at the place of each of this one, or None unless the faces match."""
    size = np.ptp(problem.points, axis=0).max()
    distance = np.linalg.norm(side.points[:, None] - other.points[None], axis=2)
    nearest = distance.argmin(axis=1)
    if distance[np.arange(len(nearest)), nearest].max() > 1e-9 * size:
        return None
    if any(n * problem.axes + 1 in problem.held for n in other.nodes) and np.ptp(side.points[:, 1]) < 1e-9:
        raise Skip("a contact whose primary side is held along its normal")
    found = dict(zip(side.nodes, other.nodes[nearest]))
    theirs = {frozenset(face) for faces in other.kinds.values() for face in faces.tolist()}
    for faces in side.kinds.values():
        if any(frozenset(found[n] for n in face) not in theirs for face in faces.tolist()):
            return None
    return other.nodes[nearest]


def pair_rows(problem, contact):
    """Between two bodies: their relative displacement along the primary side's outward normal."""
    side, other = Side(problem, contact["secondary"]), Side(problem, contact["primary"])
    if any(key in contact for key in ("adjust", "discretization", "cyclic", "preload")):
        raise Skip("a contact with other keys")
    paired = partners(problem, side, other)
    normals, gap = directions(side, other, contact)
    fixed = lambda d: opposite_held(problem, side, other, paired, d)
    if paired is not None:
        return make_rows(problem, contact, side, normals, gap, [(side.control, side.nodes), (-side.control, paired)], fixed)
    if np.ptp(normals, axis=0).max() > 1e-9:
        raise Skip("curved meshes that do not match")
    return make_rows(problem, contact, side, normals, gap, [(side.control, side.nodes), (-mortar(side, other, problem.kind), other.nodes)], fixed)


def directions(side, other, contact):
    """Out of the primary side, at the secondary nodes, and gaps; flat faces across x or y, and circles about the origin that fit."""
    radius = np.hypot(side.points[:, 0], side.points[:, 1])
    if np.ptp(side.points[:, 1]) < 1e-9:
        normals = np.tile([0.0, 1.0, 0.0][: side.points.shape[1]], (len(side.nodes), 1))
    elif np.ptp(side.points[:, 0]) < 1e-9:
        normals = np.tile([1.0, 0.0, 0.0][: side.points.shape[1]], (len(side.nodes), 1))
    elif np.ptp(radius) < 1e-9:
        normals = side.points / radius[:, None]
        normals[:, 2:] = 0
    else:
        raise Skip("neither flat nor round")
    normals = -np.sign(np.sum(normals * side.outward, axis=1))[:, None] * normals
    flat = np.ptp(normals, axis=0).max() < 1e-9
    if flat and np.ptp(other.points @ normals[0]) > 1e-9 or not flat and np.ptp(np.hypot(other.points[:, 0], other.points[:, 1])) > 1e-9:
        raise Skip("a flat side on another one that is not, or a round one")
    between = (side.points[0] - other.points[0]) @ normals[0] if flat else (radius[0] - np.hypot(*other.points[0, :2])) * np.sign(normals[0] @ side.points[0])
    gap = contact.get("clearance", between) - contact.get("interference", 0.0)
    return normals, np.full(len(side.nodes), gap)


def mortar(side, other, kind):
    """What secondary points see of the other side's nodes: tensor products of integrals along each axis of two flat faces."""
    across = 0 if abs(side.outward[0, 0]) > abs(side.outward[0, 1]) else 1
    axes = [a for a in range(side.points.shape[1]) if a != across]
    if len(axes) == 2 and not set(side.kinds) | set(other.kinds) <= {"quad4", "quad9"}:
        raise Skip("meshes that do not match, no tensor grids")
    matrices, places = [], []
    for axis in axes:
        lines = [grid_line(s, axis) for s in (side, other)]
        for (x, _), s in zip(lines, (side, other)):
            if len(np.unique(np.round(s.points[:, axes], 9), axis=0)) != np.prod([len(grid_line(s, a)[0]) for a in axes]):
                raise Skip("no tensor grid")
        matrices.append(line_mortar(*lines[0], *lines[1], kind == "axisymmetric" and axis == 0))
        places.append([np.abs(s.points[:, [axis]] - x[None]).argmin(axis=1) for (x, _), s in zip(lines, (side, other))])
    result = np.ones((len(side.nodes), len(other.nodes)))
    for matrix, (mine, theirs) in zip(matrices, places):
        result *= matrix[mine][:, theirs]
    return sparse.csr_matrix(result)


def grid_line(side, axis):
    """Coordinates of the nodes along an axis, and the order of the cells."""
    x = np.sort(side.points[:, axis])
    x = x[np.concatenate([[True], np.diff(x) > 1e-9 * np.ptp(x)])]
    return x, 2 if set(side.kinds) & {"line3", "quad9"} else 1


def line_mortar(x, order, y, other_order, radial):
    """Integrals of the dual functions of one line times the shape functions of another, over those of the dual functions. radial: x is the
    radius, and lines stand for rings."""
    if abs(x[0] - y[0]) > 1e-9 and x[0] < y[0] or x[-1] > y[-1] + 1e-9:
        raise Skip("a face that hangs over")
    at, weights = np.polynomial.legendre.leggauss(4)
    names = {1: "line2", 2: "line3"}
    local = {1: [0, 1], 2: [0, 2, 1]}  # the middle node comes last
    integrals, areas = np.zeros((len(x), len(y))), np.zeros(len(x))
    for i in range(0, len(x) - 1, order):
        a, b = x[i], x[i + order]
        base = np.linalg.inv(control(names[order]))
        values = elements.functions(names[order], at[:, None])[0] @ base
        weight = weights * (b - a) / 2 * ((a + b) / 2 + at * (b - a) / 2 if radial else 1)
        dual = np.diag(weight @ values) @ np.linalg.inv((values * weight[:, None]).T @ values)
        mine = i + np.arange(order + 1)[local[order]]
        areas[mine] += weight @ values
        for j in range(0, len(y) - 1, other_order):
            low, high = max(a, y[j]), min(b, y[j + other_order])
            if high <= low:
                continue
            s = (low + high) / 2 + at * (high - low) / 2
            reference = lambda c, d: (2 * s - c - d)[:, None] / (d - c)
            psi = (elements.functions(names[order], reference(a, b))[0] @ base) @ dual.T
            shape = elements.functions(names[other_order], reference(y[j], y[j + other_order]))[0]
            theirs = j + np.arange(other_order + 1)[local[other_order]]
            weight = weights * (high - low) / 2 * (s if radial else 1)
            integrals[mine[:, None], theirs] += (psi * weight[:, None]).T @ shape
    return integrals / areas[:, None]
