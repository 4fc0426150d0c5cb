#!/usr/bin/env python3
"""Solves decks of the population independently of the program: own stiffness (elements.py), own rows of contact, Clarabel's cone programming.

    reference.py FOLDER ...            folders with deck.yaml, expected.json and results in `out`

Rows are known beforehand on obstacles (nodes against a plane or a circle), on matching meshes (pairs of nodes) and between flat faces of
tensor grids (mortar integrals, direction by direction). Other contacts are not judged. Coulomb's law is a fixed point over slip bounds that
begins at the normal forces of the program's solution, for there may be several: it must stay there.

Needs scipy and clarabel: /usr/bin/python3 -m venv --system-site-packages V; V/bin/pip install clarabel scipy.
"""
import pathlib
import sys

import clarabel
import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg
import scipy.spatial
import yaml

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.path.append(str(HERE.parent / "verification"))  # behind: it has modules of the same names
import elements  # noqa: E402
import meshes  # noqa: E402
import results  # noqa: E402

# Relative differences that are allowed to a run at 1e-6. The program stops by a residual of the dual problem; displacements and forces are
# off by that times a condition number, for which 1e3 is granted. The energy is off by the square of it, but for what gaps and bounds do.
ALLOWED = {"displacement": 1e-3, "energy": 1e-3, "force": 1e-3, "pressure": 5e-3}
KINDS = {tag: kind for kind, tag in meshes.GMSH.items()}


class Skip(Exception):
    """This deck has no reference, and why."""


class Part:
    """A body: its nodes lie from `first` on among those of the model."""

    def __init__(self, points, element, cells):
        self.points, self.element, self.cells, self.first = points, element, cells, 0


def read_msh(path, axes):
    """{body: Part}, {boundary: {element: faces}} in the nodes of the model. Nodes are not shared by bodies."""
    lines = iter(path.read_text().splitlines())
    names, points, groups = {}, None, {}
    for line in lines:
        if line == "$PhysicalNames":
            for _ in range(int(next(lines))):
                dimension, tag, name = next(lines).split(maxsplit=2)
                names[int(dimension), int(tag)] = name.strip('"')
        elif line == "$Nodes":
            points = np.array([[float(x) for x in next(lines).split()[1:]] for _ in range(int(next(lines)))])[:, :axes]
        elif line == "$Elements":
            for _ in range(int(next(lines))):
                words = [int(w) for w in next(lines).split()]
                groups.setdefault((words[3], KINDS[words[1]]), []).append(words[3 + words[2]:])
    bodies, faces = {}, {}
    for (tag, kind), cells in groups.items():
        cells = np.array(cells) - 1
        if len(elements.nodes(kind)[0]) == axes:
            part = Part(None, kind, cells)
            part.first, last = cells.min(), cells.max()
            part.points, part.cells = points[part.first : last + 1], cells - part.first
            bodies[names[axes, tag]] = part
        else:
            faces.setdefault(names[axes - 1, tag], {})[kind] = cells
    return bodies, faces


def read_blocks(blocks):
    """The same for structured boxes of quadrilaterals and bricks."""
    bodies, faces, first = {}, {}, 0
    for name, block in blocks.items():
        if meshes.SHAPE[block["element"]] not in ("quad", "hex"):
            raise Skip("blocks of triangles")
        axes = len(block["cells"])
        sides = {f"{axis}{end}": f"{name}.{axis}{end}" for axis in "xyz"[:axes] for end in ("min", "max")}
        patch = meshes.Patch([meshes.even(0, 1, c) for c in block["cells"]], meshes.box(block["origin"], block["size"]), sides)
        body = meshes.Body([patch], block["element"])
        bodies[name] = Part(body.points, body.element, body.cells)
        bodies[name].first = first
        for side, kinds in body.faces.items():
            faces[side] = {kind: f + first for kind, f in kinds.items()}
        first += len(body.points)
    return bodies, faces


class Problem:
    """Stiffness, loads and supports of a deck."""

    def __init__(self, folder):
        self.deck = yaml.safe_load((folder / "deck.yaml").read_text())
        self.kind = self.deck["dimension"]
        self.axes = 3 if self.kind == 3 else 2
        mesh = self.deck["mesh"]
        if "file" in mesh and not mesh["file"].endswith(".msh"):
            raise Skip("meshed by gmsh")
        self.bodies, self.faces = read_msh(folder / mesh["file"], self.axes) if "file" in mesh else read_blocks(mesh["blocks"])
        self.points = np.zeros((sum(len(b.points) for b in self.bodies.values()), self.axes))
        for body in self.bodies.values():
            self.points[body.first : body.first + len(body.points)] = body.points
        self.count = self.points.size
        self.stiffness, self.force = self.assemble(), self.loads()
        self.held = self.supports()

    def material(self, name):
        return self.deck["materials"][self.deck["bodies"][name]["material"]]

    def assemble(self):
        rows, columns, values = [], [], []
        for name, body in self.bodies.items():
            m = self.material(name)
            formulation = self.deck["bodies"][name].get("formulation", "standard")
            k = elements.cell_matrices(body.points, body.cells, body.element, self.kind, m["young_modulus"], m["poisson_ratio"], formulation)
            unknowns = (((body.cells + body.first) * self.axes)[:, :, None] + np.arange(self.axes)).reshape(len(body.cells), -1)
            rows.append(np.repeat(unknowns, unknowns.shape[1], axis=1).ravel())
            columns.append(np.tile(unknowns, (1, unknowns.shape[1])).ravel())
            values.append(k.reshape(len(k), -1).ravel())
        return sparse.csc_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(self.count, self.count))

    def loads(self):
        force = np.zeros((len(self.points), self.axes))
        for load in self.deck.get("loads", []):
            if "acceleration" in load:
                body = self.bodies[load["body"]]
                weight = elements.body_forces(body.points, body.cells, body.element, self.kind) * self.material(load["body"])["density"]
                force[body.first : body.first + len(body.points)] += weight[:, None] * np.array(load["acceleration"])
                continue
            for kind, faces in self.faces[load["boundary"]].items():
                for values, normal in elements.face_points(self.points, faces, kind, self.kind):
                    if "pressure" in load:
                        traction = -load["pressure"] * normal
                    else:
                        traction = np.linalg.norm(normal, axis=1)[:, None] * np.array(load["traction"])
                    np.add.at(force, faces, values[None, :, None] * traction[:, None, :])
        return force.ravel()

    def supports(self):
        """{unknown: displacement}."""
        held = {}
        for support in self.deck["supports"]:
            for node in np.unique(np.concatenate([f.ravel() for f in self.faces[support["boundary"]].values()])):
                for axis, value in support["displacement"].items():
                    held[node * self.axes + "xyz".index(axis)] = value
        return held


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
    """The nodes of a boundary, the matrix to control values, the area that each carries, its faces."""

    def __init__(self, problem, name):
        self.name, self.kinds = name, problem.faces[name]
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


def obstacle_rows(problem, contact, side):
    """Nodes against a plane or a circle; the direction points from the obstacle to the body."""
    (shape, keys), = contact["primary"].items()
    if shape == "plane":
        normal = np.array(keys["normal"]) / np.linalg.norm(keys["normal"])
        normals, gap = np.tile(normal, (len(side.nodes), 1)), (side.points - keys["point"]) @ normal
    else:
        across = side.points - np.array(keys["point"])
        across[:, 2:] = 0
        distance = np.linalg.norm(across, axis=1)
        normals, gap = across / distance[:, None], distance - keys["radius"]
    return make_rows(problem, contact, side, normals, gap, [(side.control, side.nodes)])


def make_rows(problem, contact, side, normals, gap, terms):
    """gap is nodal; terms: (matrix, nodes) that add up to the relative displacement."""
    friction, held = contact.get("friction", {}), held_along(problem, side, normals)
    if held.any() and "tresca" in friction:
        raise Skip("a contact that supports hold along its normal")
    see = lambda d: sum(vector_rows(problem, matrix, nodes, d) for matrix, nodes in terms).tocsr()
    normal = see(normals)
    free = np.ones(problem.count)
    free[list(problem.held)] = 0
    kept = (abs(normal) @ free > 1e-12) & ~(held & (len(terms) == 1))
    # Where a support holds the secondary node along a tangent alone there is no friction along it, whatever lies opposite.
    across = [see(d * (held | ~held_along(problem, side, d))[:, None])[kept] for d in tangents(normals)]
    return Rows(normal[kept], across, normals[kept], (side.control @ gap)[kept], side.area[kept], friction)


def held_along(problem, side, normals):
    """Which nodes of a side supports hold along the given directions. Held along their normals they have rows that the primary side alone
    feels, and none over an obstacle."""
    held = np.array([[node * problem.axes + axis in problem.held for axis in range(problem.axes)] for node in side.nodes])
    return np.any(held & (np.abs(normals) > 1e-6), axis=1)


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
    if paired is not None:
        return make_rows(problem, contact, side, normals, gap, [(side.control, side.nodes), (-side.control, paired)])
    if np.ptp(normals, axis=0).max() > 1e-9:
        raise Skip("curved meshes that do not match")
    return make_rows(problem, contact, side, normals, gap, [(side.control, side.nodes), (-mortar(side, other, problem.kind), other.nodes)])


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


class Condensed:
    """The problem in the unknowns that contacts see, scaled by a stiffness and a displacement."""

    def __init__(self, problem, rows, size):
        self.problem, self.rows, self.size = problem, rows, size
        self.normal = sparse.vstack([r.normal for r in rows]).tocsr()
        self.tangent = [sparse.vstack([r.tangents[i] for r in rows]).tocsr() for i in range(problem.axes - 1)]
        self.gap, self.area = np.concatenate([r.gap for r in rows]), np.concatenate([r.area for r in rows])
        fixed = np.array(sorted(problem.held), int)
        self.given = np.zeros(problem.count)
        self.given[fixed] = [problem.held[i] for i in fixed]
        free = np.ones(problem.count, bool)
        free[fixed] = False
        seen = np.zeros(problem.count, bool)
        for matrix in [self.normal, *self.tangent]:
            seen[matrix.tocoo().col] = True
        self.c, self.i = np.flatnonzero(free & seen), np.flatnonzero(free & ~seen)
        k = problem.stiffness
        load = problem.force - k @ self.given
        self.solve = scipy.sparse.linalg.splu(k[self.i][:, self.i].tocsc()).solve
        self.coupling = k[self.i][:, self.c]
        inner = self.solve(self.coupling.toarray())
        s = k[self.c][:, self.c].toarray() - self.coupling.T @ inner
        self.schur = (s + s.T) / 2
        self.inner_load = load[self.i]
        self.load = load[self.c] - self.coupling.T @ self.solve(self.inner_load)
        self.unit = np.abs(self.schur).max()

    def full(self, c):
        u = self.given.copy()
        u[self.c] = c
        u[self.i] = self.solve(self.inner_load - self.coupling @ c)
        return u

    def tresca(self, bounds):
        """Displacements and normal forces for given slip bounds (forces; None: frictionless)."""
        count, points, force = len(self.c), len(self.gap), self.unit * self.size
        loose = bounds is not None
        extra = points if loose else 0
        p = sparse.block_diag([sparse.csc_matrix(np.triu(self.schur / self.unit)), sparse.csc_matrix((extra, extra))], format="csc")
        q = np.concatenate([-self.load / force, bounds / force if loose else []])
        n, at = self.normal[:, self.c], self.normal @ self.given + self.gap
        blocks, right, cones = [sparse.hstack([-n, sparse.csr_matrix((points, extra))])], [at / self.size], [clarabel.NonnegativeConeT(points)]
        if loose:
            width = 1 + len(self.tangent)
            slips = [t[:, self.c] for t in self.tangent]
            stacked = sparse.vstack([sparse.hstack([sparse.csr_matrix((points, count)), -sparse.eye(points)])]
                                    + [sparse.hstack([-t, sparse.csr_matrix((points, points))]) for t in slips]).tocsr()
            offset = np.concatenate([np.zeros(points)] + [t @ self.given / self.size for t in self.tangent])
            order = (np.arange(points)[:, None] + points * np.arange(width)).ravel()
            blocks.append(stacked[order])
            right.append(offset[order])
            cones += [clarabel.SecondOrderConeT(width)] * points
        settings = clarabel.DefaultSettings()
        settings.verbose, settings.tol_gap_abs, settings.tol_gap_rel, settings.tol_feas, settings.max_iter = False, 1e-13, 1e-11, 1e-11, 200
        found = clarabel.DefaultSolver(p, q, sparse.vstack(blocks, format="csc"), np.concatenate(right), cones, settings).solve()
        if "Solved" not in str(found.status):
            raise Skip(f"Clarabel: {found.status}")
        return np.array(found.x[:count]) * self.size, np.array(found.z[:points]) * force

    def forces(self, u):
        """Normal forces of the rows that balance a given displacement."""
        residual = (self.problem.stiffness @ u - self.problem.force)[self.c]
        rows = sparse.vstack([self.normal, *self.tangent])[:, self.c]
        return scipy.sparse.linalg.lsqr(rows.T.tocsr(), residual, atol=1e-14, btol=1e-14, iter_lim=20 * len(self.c))[0][: len(self.gap)]

    def bounds(self, forces):
        parts, start = [], 0
        for r in self.rows:
            points = slice(start, start + len(r.gap))
            parts.append(r.friction.get("coulomb", 0) * np.maximum(forces[points], 0) + r.friction.get("tresca", 0) * r.area)
            start = points.stop
        return np.concatenate(parts)

    def solution(self, first):
        """Displacement, normal forces, steps of the fixed point."""
        laws = {key for r in self.rows for key in r.friction}
        if "bonded" in laws:
            raise Skip("bonded")
        if not laws:
            c, forces = self.tresca(None)
            return self.full(c), forces, 1
        bounds = self.bounds(first)
        for step in range(1, 101):
            c, forces = self.tresca(bounds)
            new = self.bounds(forces)
            change = np.linalg.norm(new - bounds) / max(np.linalg.norm(new), 1e-300)
            if "coulomb" not in laws or change < 1e-7:
                return self.full(c), forces, step
            bounds = (bounds + new) / 2 if step > 5 else new
        raise Skip(f"the fixed point did not settle, last change {change:.1e}")


def displacement_of(problem, result):
    """The program's displacements at our nodes, body by body; bodies are told by their nodes."""
    grid = result.solution
    u = np.full((len(problem.points), problem.axes), np.nan)
    near = 1e-7 * np.ptp(problem.points, axis=0).max()
    for number in np.unique(grid.cell_fields["body"]):
        theirs = result.nodes_of(number)
        tree = scipy.spatial.cKDTree(grid.points[theirs][:, : problem.axes])
        for body in problem.bodies.values():
            distance, nearest = tree.query(body.points)
            back = scipy.spatial.cKDTree(body.points).query(tree.data)[0]
            if max(distance.max(), back.max()) < near:
                u[body.first : body.first + len(body.points)] = grid.fields["displacement"][theirs[nearest]][:, : problem.axes]
    if not np.isfinite(u).all():
        raise RuntimeError("the results lack nodes")
    return u.ravel()


def compare(folder):
    """({what: relative difference}, complaints) of a deck that was solved; ({}, []) where there is no reference."""
    folder = pathlib.Path(folder)
    result = results.Result(folder / "out", 0)
    try:
        problem = Problem(folder)
        rows = [obstacle_rows(problem, c, Side(problem, c["secondary"])) if isinstance(c["primary"], dict) else pair_rows(problem, c)
                for c in problem.deck["contacts"]]
        u = displacement_of(problem, result)
        condensed = Condensed(problem, rows, max(np.abs(u).max(), 1e-300))
        if len(condensed.c) > 3000:
            raise Skip("too large")
        exact, forces, steps = condensed.solution(condensed.forces(u))
    except Skip as reason:
        return {"skipped": str(reason)}, []
    differences = {"displacement": distance(problem.stiffness, u, exact), **figures(problem, rows, result.summary, exact, forces)}
    if shared(problem):  # forces that two contacts share at a node are anybody's guess
        differences = {name: differences[name] for name in ("displacement", "energy")}
    differences = {name: float(value) for name, value in differences.items()}
    tolerance = problem.deck["solver"]["tolerance"]
    factor = 1.0 if tolerance == "auto" else max(1.0, tolerance / 1e-6)
    if tolerance == "auto":
        return {**differences, "steps": steps}, []
    complaints = [f"{name} differs from the reference by {value:.1e}, allowed {ALLOWED[name] * factor:.0e}"
                  for name, value in differences.items() if not value <= ALLOWED[name] * factor]
    return {**differences, "steps": steps}, complaints


def shared(problem):
    """Whether a node is on the secondary sides of two contacts with friction."""
    sides = [np.unique(np.concatenate([f.ravel() for f in problem.faces[c["secondary"]].values()])) for c in problem.deck["contacts"] if c.get("friction")]
    return sum(map(len, sides)) > len(set().union(*map(set, sides)))


def distance(stiffness, u, exact):
    """In the energy norm, relative to the larger one."""
    energy = lambda v: float(v @ (stiffness @ v))
    return np.sqrt(max(energy(u - exact), 0) / max(energy(u), energy(exact), 1e-300))


def figures(problem, rows, summary, exact, forces):
    """Relative differences of the summary's figures; forces to the largest force of any contact."""
    energy = float(exact @ (problem.stiffness @ exact)) / 2
    found = {"energy": abs(summary["strain_energy"] - energy) / max(energy, 1e-300)}
    start, pairs, pressures = 0, [], []
    for r, contact in zip(rows, summary["contacts"]):
        mine = forces[start : start + len(r.gap)]
        start += len(r.gap)
        pressures.append((np.max(mine / r.area, initial=0), contact["max_pressure"]))
        total, theirs = mine @ r.normals, np.array(contact["force"])[: problem.axes]
        if np.ptp(r.normals, axis=0).max() < 1e-9:  # flat: the normal part
            pairs.append((abs(total @ r.normals[0]), abs(theirs @ r.normals[0])))
        elif not r.friction:
            pairs.append((np.linalg.norm(total), np.linalg.norm(theirs)))
    largest = max([a for a, _ in pairs] + [1e-300])
    found["force"] = max((abs(a - b) for a, b in pairs), default=0.0) / largest
    top = max(max(p for p, _ in pressures), 1e-6 * summary["max_von_mises"])  # nothing where bodies do not meet
    found["pressure"] = max(abs(a - b) for a, b in pressures) / top
    return found


if __name__ == "__main__":
    for name in sys.argv[1:]:
        print(name, *compare(name))
