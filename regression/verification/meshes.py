"""Meshes whose nodes lie exactly where a formula has them: structured grids, mapped, as .msh files (format 2.2)."""

import numpy as np

# Local grid places of gmsh's quadrilaterals with 4 and 9 nodes, and of its lines.
QUAD = {1: [(0, 0), (1, 0), (1, 1), (0, 1)], 2: [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]}
LINE = {1: [0, 1], 2: [0, 2, 1]}


class Writer:
    """Collects grids and writes them as one mesh."""

    def __init__(self):
        self.points, self.elements, self.names = [], [], {}

    def tag(self, name, dimension):
        return self.names.setdefault(name, (dimension, len(self.names) + 1))[1]

    def add(self, body, place, cells, order, boundaries):
        """A grid of cells[0] x cells[1] quadrilaterals; place(s, t) -> x, y with s, t from 0 to 1; boundaries: the names of the
        sides "s0", "s1", "t0", "t1"."""
        n, m = (order * k for k in cells)
        s, t = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, m + 1), indexing="ij")
        number = len(self.points) + 1 + np.arange((n + 1) * (m + 1)).reshape(n + 1, m + 1)
        self.points += list(zip(*(part.ravel() for part in place(s, t))))
        tag = self.tag(body, 2)
        for i in range(0, n, order):
            for j in range(0, m, order):
                self.elements.append(({1: 3, 2: 10}[order], tag, [number[i + a, j + b] for a, b in QUAD[order]]))
        for side, name in boundaries.items():
            nodes = {"s0": number[0], "s1": number[-1], "t0": number[:, 0], "t1": number[:, -1]}[side]
            for i in range(0, len(nodes) - 1, order):
                self.elements.append(({1: 1, 2: 8}[order], self.tag(name, 1), [nodes[i + a] for a in LINE[order]]))

    def write(self, path):
        with open(path, "w") as file:
            file.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(self.names)}\n")
            file.writelines(f'{dimension} {tag} "{name}"\n' for name, (dimension, tag) in self.names.items())
            file.write(f"$EndPhysicalNames\n$Nodes\n{len(self.points)}\n")
            file.writelines(f"{i + 1} {x:.16g} {y:.16g} 0\n" for i, (x, y) in enumerate(self.points))
            file.write(f"$EndNodes\n$Elements\n{len(self.elements)}\n")
            file.writelines(f"{i + 1} {kind} 2 {tag} {tag} {' '.join(map(str, nodes))}\n" for i, (kind, tag, nodes) in enumerate(self.elements))
            file.write("$EndElements\n")


def graded(t, ratio):
    """0 to 1, with steps that grow smoothly by `ratio` from one end to the other."""
    return np.expm1(np.log(ratio) * t) / (ratio - 1)


def wave(path, n, order, amplitude=1e-4, height=2):
    """Half a wave of length 1, y = amplitude (1 - cos 2 pi x), on a block with a flat surface and other cells; refined towards them."""
    writer = Writer()
    surface = lambda x: amplitude * (1 - np.cos(2 * np.pi * x))

    def wavy(s, t):
        y = height * graded(t, 12)
        return s / 2, y + surface(s / 2) * (1 - y / height)

    writer.add("wavy", wavy, (n, n), order, {"t0": "wavy_surface", "t1": "top", "s0": "sides", "s1": "sides"})
    flat = lambda s, t: (s / 2, -height * graded(1 - t, 12))
    writer.add("flat", flat, (5 * n // 4, n), order, {"t1": "flat_surface", "t0": "bottom", "s0": "sides", "s1": "sides"})
    writer.write(path)


def cut_square(path, n, order, curve):
    """Unit square cut by y = curve(x) into two bodies with n and n + 1 cells along the cut."""
    writer = Writer()
    sides = {"s0": "left", "s1": "right"}
    writer.add("lower", lambda s, t: (s, t * curve(s)), (n, n), order, {**sides, "t0": "bottom", "t1": "lower_top"})
    writer.add("upper", lambda s, t: (s, curve(s) + t * (1 - curve(s))), (n + 1, n), order, {**sides, "t1": "top", "t0": "upper_bottom"})
    writer.write(path)
