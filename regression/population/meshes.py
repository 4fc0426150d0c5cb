"""Structured meshes of bodies made of patches, with every cell of both orders, and .msh files (2.2) of them.

A patch is a grid in reference coordinates, whose knots may be graded, and a map to space. Its lattice has a point at each knot and one between
two: all nodes of cells of second order are among them. Patches of a body are joined where their points coincide. Cells of 3D patches are
split along their third axis, so that prisms and tetrahedra of neighbouring patches fit if that axis is common to them.
"""

import numpy as np

GMSH = {"line2": 1, "tri3": 2, "quad4": 3, "tet4": 4, "hex8": 5, "prism6": 6, "line3": 8, "tri6": 9, "quad9": 10, "tet10": 11, "hex27": 12,
        "prism18": 13, "quad8": 16, "hex20": 17, "prism15": 18}
SHAPE = {"tri3": "tri", "tri6": "tri", "quad4": "quad", "quad8": "quad", "quad9": "quad", "tet4": "tet", "tet10": "tet", "hex8": "hex",
         "hex20": "hex", "hex27": "hex", "prism6": "prism", "prism15": "prism", "prism18": "prism"}
PLANE = ["tri3", "quad4", "tri6", "quad8", "quad9"]
SOLID = ["tet4", "hex8", "prism6", "tet10", "hex20", "hex27", "prism15"]
SECOND = {"tri6", "quad8", "quad9", "tet10", "hex20", "hex27", "prism15", "prism18"}
FULL = {"quad9", "hex27", "prism18"}  # with nodes amid faces
CORNERS = {"tri": 3, "quad": 4, "tet": 4, "hex": 8, "prism": 6, "line": 2}
# Edges and faces in gmsh's order of the nodes that lie amid them.
EDGES = {"line": [(0, 1)], "tri": [(0, 1), (1, 2), (2, 0)], "quad": [(0, 1), (1, 2), (2, 3), (3, 0)],
         "tet": [(0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3)],
         "hex": [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)],
         "prism": [(0, 1), (0, 2), (0, 3), (1, 2), (1, 4), (2, 5), (3, 4), (3, 5), (4, 5)]}
MIDDLES = {"quad": [(0, 1, 2, 3)], "prism": [(0, 1, 4, 3), (0, 2, 5, 3), (1, 2, 5, 4)],
           "hex": [(0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7), (0, 1, 2, 3, 4, 5, 6, 7)]}
FACES = {"tri": [(0, 1), (1, 2), (2, 0)], "quad": [(0, 1), (1, 2), (2, 3), (3, 0)], "tet": [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)],
         "hex": [(0, 3, 2, 1), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)],
         "prism": [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]}
MIRROR = {"tri": [0, 2, 1], "quad": [0, 3, 2, 1], "tet": [0, 2, 1, 3], "hex": [0, 3, 2, 1, 4, 7, 6, 5], "prism": [0, 2, 1, 3, 5, 4]}
# The cells of one square or cube of the lattice, by corners in units of its half edges.
SQUARE = {"quad": [[(0, 0), (2, 0), (2, 2), (0, 2)]], "tri": [[(0, 0), (2, 0), (2, 2)], [(0, 0), (2, 2), (0, 2)]]}
LATER = {0: [0, 1, 2, 3, 4, 5], 1: [1, 2, 0, 4, 5, 3], 2: [2, 0, 1, 5, 3, 4], 3: [3, 5, 4, 0, 2, 1], 4: [4, 3, 5, 1, 0, 2], 5: [5, 4, 3, 2, 1, 0]}


class Patch:
    """knots: reference coordinates along each axis; place(*coordinates): points, one array a component; sides: {side: name}, or a function
    of the reference coordinates of a face's centre that gives a name or None. Sides are called xmin to zmax by their reference axis."""

    def __init__(self, knots, place, sides=None):
        self.knots = [np.asarray(k, float) for k in knots]
        self.place = place
        self.sides = sides or {}


def even(low, high, count):
    return np.linspace(low, high, count + 1)


def graded(low, high, count, ratio):
    """Cells that grow by a constant factor, the last one `ratio` times as long as the first."""
    if count < 2 or abs(ratio - 1) < 1e-9:
        return even(low, high, count)
    steps = ratio ** (np.arange(count) / (count - 1))
    return low + (high - low) * np.concatenate([[0], np.cumsum(steps)]) / steps.sum()


def graded_both(low, high, count, ratio):
    """Fine in the middle, `ratio` times as long at both ends."""
    half = graded(0, 1, max(1, count // 2), ratio)
    both = np.concatenate([-half[::-1], half[1:]])
    return low + (high - low) * (both + 1) / 2


def box(origin, size):
    return lambda *x: [o + s * c for o, s, c in zip(origin, size, x)]


def corners(points):
    """Bilinear between four points, anticlockwise."""
    p = np.asarray(points, float)
    return lambda s, t: [(1 - s) * (1 - t) * p[0, c] + s * (1 - t) * p[1, c] + s * t * p[2, c] + (1 - s) * t * p[3, c] for c in (0, 1)]


def extruded(patch, knots, front=None, back=None):
    """A plane patch along z."""
    place = lambda s, t, z: [*patch.place(s, t), z]
    sides = {side: (lambda s, t, z, name=name: name(s, t)) if callable(name) else name for side, name in patch.sides.items()}
    return Patch([*patch.knots, knots], place, {**sides, "zmin": front, "zmax": back})


def lattice(patch):
    """Reference coordinates (n, axes) and points (n, axes) of all lattice points, the last axis running fastest, and the counts."""
    axes = []
    for knots in patch.knots:
        line = np.empty(2 * len(knots) - 1)
        line[::2], line[1::2] = knots, (knots[1:] + knots[:-1]) / 2
        axes.append(line)
    grid = [g.ravel() for g in np.meshgrid(*axes, indexing="ij")]
    points = np.column_stack([np.broadcast_to(c, grid[0].shape) for c in patch.place(*grid)])
    return np.column_stack(grid), points, [len(a) for a in axes]


def joined(points):
    """A number for each point, the same for those that coincide."""
    size = np.ptp(points, axis=0).max()
    labels = []
    for values in points.T:
        order = np.argsort(values, kind="stable")
        new = np.concatenate([[0], np.cumsum(np.diff(values[order]) > 1e-8 * size)])
        label = np.empty(len(values), int)
        label[order] = new
        labels.append(label)
    key = labels[0]
    for label in labels[1:]:
        key = key * (label.max() + 1) + label
    return np.unique(key, return_inverse=True)[1]


def squares(counts, shape):
    """Corners of all plane cells in lattice indices (cells, corners, 2)."""
    i, j = [g.ravel() for g in np.meshgrid(*[np.arange(0, n - 1, 2) for n in counts], indexing="ij")]
    base = np.column_stack([i, j])
    parts = np.array(SQUARE[shape])
    return (base[:, None, None, :] + parts[None]).reshape(-1, parts.shape[1], 2)


def cubes(counts, shape, number):
    """Corners of all solid cells in lattice indices; number(indices) tells joined points, by which prisms are split."""
    plane = squares(counts[:2], "quad" if shape == "hex" else "tri")
    layers = []
    for k in range(0, counts[2] - 1, 2):
        low = np.concatenate([plane, np.full((*plane.shape[:2], 1), k)], axis=2)
        layers.append(np.concatenate([low, low + [0, 0, 2]], axis=1))
    cells = np.concatenate(layers)
    return tetrahedra(cells, number) if shape == "tet" else cells


def tetrahedra(prisms, number):
    """Three of each prism; the diagonal of a face begins at its lowest number, so that neighbours fit."""
    numbers = number(prisms)
    turn = np.array([LATER[i] for i in range(6)])[np.argmin(numbers, axis=1)]
    prisms = np.take_along_axis(prisms, turn[:, :, None], axis=1)
    numbers = np.take_along_axis(numbers, turn, axis=1)
    first = np.minimum(numbers[:, 1], numbers[:, 5]) < np.minimum(numbers[:, 2], numbers[:, 4])
    one, other = [[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3]], [[0, 1, 2, 4], [0, 4, 2, 5], [0, 4, 5, 3]]
    return np.concatenate([prisms[first][:, one].reshape(-1, 4, 3), prisms[~first][:, other].reshape(-1, 4, 3)])


def oriented(cells, shape, place):
    """Cells with a positive volume: mirrored where the map turns them over."""
    x = place(cells)
    a = x[:, 1] - x[:, 0]
    b = x[:, {"quad": 3, "hex": 3}.get(shape, 2)] - x[:, 0]
    if cells.shape[2] == 2:
        volume = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    else:
        c = x[:, {"hex": 4}.get(shape, 3)] - x[:, 0]
        volume = np.einsum("ij,ij->i", np.cross(a, b), c)
    wrong = volume < 0
    cells[wrong] = cells[wrong][:, MIRROR[shape]]
    return cells


def with_middles(cells, shape, element):
    """All nodes of cells in lattice indices, in gmsh's order."""
    if element not in SECOND:
        return cells
    groups = EDGES[shape] + (MIDDLES.get(shape, []) if element in FULL else [])
    return np.concatenate([cells] + [cells[:, list(group)].sum(axis=1, keepdims=True) // len(group) for group in groups], axis=1)


def face_element(element, corner_count):
    if corner_count == 2:
        return "line3" if element in SECOND else "line2"
    if element not in SECOND:
        return "tri3" if corner_count == 3 else "quad4"
    return "tri6" if corner_count == 3 else "quad9" if element in FULL else "quad8"


def side_faces(patch, cells, shape, element, counts, reference, flat):
    """{name: {element: faces in lattice indices}} of a patch."""
    found = {}
    for side, name in patch.sides.items():
        if name is None:
            continue
        axis, end = "xyz".index(side[0]), 0 if side.endswith("min") else counts["xyz".index(side[0])] - 1
        for face in FACES[shape]:
            chosen = cells[np.all(cells[:, face, axis] == end, axis=1)][:, face]
            if not len(chosen):
                continue
            centres = reference[flat(chosen)].mean(axis=1)
            names = np.array([name(*c) if callable(name) else name for c in centres], dtype=object)
            kind = face_element(element, len(face))
            for one in {n for n in names if n is not None}:
                faces = with_middles(chosen[names == one], {2: "line", 3: "tri", 4: "quad"}[len(face)], kind if kind != "line3" else "quad8")
                found.setdefault(one, {}).setdefault(kind, []).append(faces)
    return found


class Body:
    """points, {element: cells}, {boundary: {element: faces}}; nodes of cells only."""

    def __init__(self, patches, element):
        parts = [lattice(patch) for patch in patches]
        joint = joined(np.concatenate([points for _, points, _ in parts]))
        points = np.empty((joint.max() + 1, parts[0][1].shape[1]))
        points[joint] = np.concatenate([p for _, p, _ in parts])
        cells, faces, start, shape = [], {}, 0, SHAPE[element]
        for patch, (reference, _, counts) in zip(patches, parts):
            flat = lambda index, counts=counts: np.ravel_multi_index(np.moveaxis(index, -1, 0), counts)
            number = lambda index, flat=flat, start=start: joint[start + flat(index)]
            corner = squares(counts, shape) if len(counts) == 2 else cubes(counts, shape, number)
            corner = oriented(corner, shape, lambda index: points[number(index)])
            cells.append(number(with_middles(corner, shape, element)))
            for name, kinds in side_faces(patch, corner, shape, element, counts, reference, flat).items():
                for kind, some in kinds.items():
                    faces.setdefault(name, {}).setdefault(kind, []).extend(number(f) for f in some)
            start += len(reference)
        cells = np.concatenate(cells)
        used, cells_flat = np.unique(cells, return_inverse=True)
        new = np.full(len(points), -1)
        new[used] = np.arange(len(used))
        self.points, self.element, self.cells = points[used], element, cells_flat.reshape(cells.shape)
        self.faces = {name: {kind: new[np.concatenate(some)] for kind, some in kinds.items()} for name, kinds in faces.items()}


def write(path, bodies):
    """A .msh file of bodies by name; boundaries with one name in several bodies are one."""
    dimension = next(iter(bodies.values())).points.shape[1]
    names = {(dimension, name): i + 1 for i, name in enumerate(bodies)}
    for body in bodies.values():
        for name in body.faces:
            names.setdefault((dimension - 1, name), len(names) + 1)
    lines, nodes, elements, shift = [], [], [], 0
    for i, (name, body) in enumerate(bodies.items()):
        points = np.zeros((len(body.points), 3))
        points[:, :dimension] = body.points
        nodes += [f"{shift + n + 1} {x:.17g} {y:.17g} {z:.17g}" for n, (x, y, z) in enumerate(points)]
        groups = [((dimension - 1, boundary), kind, faces) for boundary, kinds in body.faces.items() for kind, faces in kinds.items()]
        for key, kind, cells in groups + [((dimension, name), body.element, body.cells)]:
            head = f"{GMSH[kind]} 2 {names[key]} {names[key] if key[0] < dimension else i + 1}"
            elements += [f"{head} " + " ".join(map(str, cell)) for cell in (cells + shift + 1).tolist()]
        shift += len(points)
    lines += ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
    lines += [f'{d} {tag} "{name}"' for (d, name), tag in names.items()]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(nodes)), *nodes, "$EndNodes", "$Elements", str(len(elements))]
    lines += [f"{i + 1} {text}" for i, text in enumerate(elements)] + ["$EndElements", ""]
    path.write_text("\n".join(lines))
