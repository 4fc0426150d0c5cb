"""What a run of Mortise left behind: summary.json and the .vtu files of solution.pvd and contact.pvd, without a library for VTK."""

import json
import pathlib
import re
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "postproc"))
from studies.vtu import read_vtu  # noqa: E402


class Grid:
    """Points, cells by their VTK type, point fields and cell fields, of all ranks' pieces one behind the other."""

    def __init__(self, files):
        pieces = [read_vtu(file) for file in files]
        self.points = np.vstack([piece["Points"]["Points"] for piece in pieces])
        stack = lambda arrays: np.vstack(arrays) if arrays[0].ndim > 1 else np.concatenate(arrays)
        self.fields = {name: stack([piece["PointData"][name] for piece in pieces]) for name in pieces[0].get("PointData", {})}
        self.cell_fields = {name: stack([piece["CellData"][name] for piece in pieces]) for name in pieces[0].get("CellData", {})}
        cells, types, base = [], [], 0
        for piece in pieces:
            offsets = piece["Cells"]["offsets"]
            cells += [part + base for part in np.split(piece["Cells"]["connectivity"], offsets[:-1])] if len(offsets) else []
            types.append(piece["Cells"]["types"])
            base += len(piece["Points"]["Points"])
        self.types = np.concatenate(types)
        self.cells = cells

    def groups(self):
        """(VTK type, numbers of the cells, their nodes) for each type of cell."""
        for kind in np.unique(self.types):
            numbers = np.flatnonzero(self.types == kind)
            yield int(kind), numbers, np.array([self.cells[i] for i in numbers])


class Result:
    """One run: summary, solution (volumes), contact (the secondary sides), seconds of CPU."""

    def __init__(self, directory, seconds):
        self.directory = pathlib.Path(directory)
        self.summary = json.loads((self.directory / "summary.json").read_text())
        self.seconds = seconds
        self._grids = {}

    def grid(self, name):
        if name not in self._grids:
            last = re.findall(r'file="([^"]+)"', (self.directory / f"{name}.pvd").read_text())[-1]  # of all load steps
            stem = re.sub(r"(_0\.vtu|\.pvtu)$", "", last)
            self._grids[name] = Grid(sorted(self.directory.glob(f"{stem}_*.vtu")))
        return self._grids[name]

    @property
    def solution(self):
        return self.grid("solution")

    @property
    def contact(self):
        return self.grid("contact")

    def displacement_at(self, point, body=None, tolerance=1e-6):
        """Displacement of the node nearest to a point, of one body if two have a node there; the node must be there."""
        grid = self.solution
        candidates = np.arange(len(grid.points)) if body is None else self.nodes_of(body)
        distance = np.linalg.norm(grid.points[candidates] - np.asarray(point, float), axis=1)
        nearest = np.argmin(distance)
        if distance[nearest] > tolerance * max(1.0, np.abs(grid.points).max()):
            raise LookupError(f"no node at {point}: the nearest is {distance[nearest]:g} away")
        return grid.fields["displacement"][candidates[nearest]]

    def nodes_of(self, body):
        grid = self.solution
        return np.unique(np.concatenate([grid.cells[i] for i in np.flatnonzero(grid.cell_fields["body"] == body)]))

    def nodes_where(self, condition, body=None):
        """Numbers of the nodes whose coordinates satisfy condition(x, y, z)."""
        nodes = np.arange(len(self.solution.points)) if body is None else self.nodes_of(body)
        return nodes[condition(*self.solution.points[nodes].T)]
