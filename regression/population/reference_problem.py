"""A deck of the population as matrices: bodies from its mesh, stiffness, loads, supports."""

import numpy as np
import scipy.sparse as sparse
import yaml

import elements
import meshes

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
