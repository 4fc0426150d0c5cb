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

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.path.append(str(HERE.parent / "verification"))  # behind: it has modules of the same names
import results  # noqa: E402
from reference_problem import Problem, Skip  # noqa: E402
from reference_rows import Side, obstacle_rows, pair_rows  # noqa: E402

# Relative differences that are allowed to a run at 1e-6. The program stops by a residual of the dual problem; displacements and forces are
# off by that times a condition number, for which 1e3 is granted. The energy is off by the square of it, but for what gaps and bounds do.
ALLOWED = {"displacement": 1e-3, "energy": 1e-3, "force": 1e-3, "pressure": 5e-3}
# A point that fulfils all conditions of a solution, with our own matrices, to this is one, whatever an interior point method says: where
# moduli are a million apart its gaps stay open by as much as bodies slip. Most solutions of the direct method have 1e-11 and less.
PROVEN = 1e-8


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

    def all_forces(self, u):
        """Forces of the rows that balance a given displacement, a column a direction, the normal first; what is left of the residual."""
        residual = (self.problem.stiffness @ u - self.problem.force)[self.c]
        rows = sparse.vstack([self.normal, *self.tangent])[:, self.c].T.tocsr()
        forces = scipy.sparse.linalg.lsqr(rows, residual, atol=1e-14, btol=1e-14, iter_lim=20 * len(self.c))[0]
        return forces.reshape(-1, len(self.gap)).T, residual - rows @ forces

    def forces(self, u):
        """Normal forces of the rows that balance a given displacement."""
        return self.all_forces(u)[0][:, 0]

    def unsolved(self, u):
        """By how much the conditions of a solution are missed: lengths over the largest displacement, forces over the largest of a row.
        Forces on nodes are sums of much larger ones where a stiff body lies on soft ones; their rounding is left out."""
        forces, left = self.all_forces(u)
        k = self.problem.stiffness
        rounding = 16 * np.finfo(float).eps * (abs(k) @ abs(u))
        over = lambda values, at: np.maximum(np.abs(values) - rounding[at], 0)
        left, inner = over(left, self.c), over((k @ u - self.problem.force)[self.i], self.i)
        largest = max(np.abs(forces).max(), 1e-300)
        normal, across, gap = forces[:, 0], forces[:, 1:], self.normal @ u + self.gap
        slip = np.column_stack([t @ u for t in self.tangent])
        bound, size, speed = self.bounds(normal), np.linalg.norm(across, axis=1), np.linalg.norm(slip, axis=1)
        turned = np.sqrt(np.maximum(bound * speed + np.sum(across * slip, axis=1), 0) / (largest * self.size))  # friction opposes slip
        return max(np.concatenate([left, inner]).max() / largest, np.max(-gap) / self.size, np.max(-normal) / largest,
                   np.max(np.minimum(np.abs(gap) / self.size, np.abs(normal) / largest)), np.max(size - bound) / largest, np.max(turned) ** 2)

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
        if any(w["kind"] == "narrow_contact" and w["value"] == 0 for w in result.summary["warnings"]):
            raise Skip("a contact narrower than a face, which has rows between nodes")
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
    differences["unsolved"] = float(condensed.unsolved(u))
    tolerance = problem.deck["solver"]["tolerance"]
    factor = 1.0 if tolerance == "auto" else max(1.0, tolerance / 1e-6)
    if tolerance == "auto":
        return {**differences, "steps": steps}, []
    complaints = [f"{name} differs from the reference by {value:.1e}, allowed {ALLOWED[name] * factor:.0e}"
                  for name, value in differences.items() if name in ALLOWED and not value <= ALLOWED[name] * factor]
    return {**differences, "steps": steps}, [] if differences["unsolved"] < PROVEN else complaints


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
    least = 1e-6 * summary["max_von_mises"]  # nothing where bodies do not meet
    largest = max([a for a, _ in pairs] + [least * sum(r.area.sum() for r in rows), 1e-300])
    found["force"] = max((abs(a - b) for a, b in pairs), default=0.0) / largest
    top = max(max(p for p, _ in pressures), least)
    found["pressure"] = max(abs(a - b) for a, b in pressures) / top
    return found


if __name__ == "__main__":
    for name in sys.argv[1:]:
        print(name, *compare(name))
