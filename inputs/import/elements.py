"""Elements of Abaqus and CalculiX: their cells, faces and integration, and the order of nodes in gmsh's files."""

import dataclasses
import functools
import re

import numpy as np

CORNERS = {"tet": 4, "prism": 6, "hex": 8, "tri": 3, "quad": 4, "line": 2}
NODES = {
    "tet4": 4,
    "tet10": 10,
    "prism6": 6,
    "prism15": 15,
    "hex8": 8,
    "hex20": 20,
    "tri3": 3,
    "tri6": 6,
    "quad4": 4,
    "quad8": 8,
    "line2": 2,
    "line3": 3,
}
GMSH_TYPE = {
    "line2": 1,
    "tri3": 2,
    "quad4": 3,
    "tet4": 4,
    "hex8": 5,
    "prism6": 6,
    "line3": 8,
    "tri6": 9,
    "tet10": 11,
    "quad8": 16,
    "hex20": 17,
    "prism15": 18,
}
VTK_TYPE = {
    "tri3": 5,
    "quad4": 9,
    "tet4": 10,
    "hex8": 12,
    "prism6": 13,
    "tri6": 22,
    "quad8": 23,
    "tet10": 24,
    "hex20": 25,
    "prism15": 26,
}
# Corners of each node in the middle of an edge, in the order of Abaqus and in that of gmsh.
EDGES = {
    "line": [(0, 1)],
    "tri": [(0, 1), (1, 2), (2, 0)],
    "quad": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "tet": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
    "prism": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    "hex": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
}
GMSH_EDGES = {
    **EDGES,
    "tet": [(0, 1), (1, 2), (2, 0), (3, 0), (3, 2), (3, 1)],
    "prism": [(0, 1), (0, 2), (0, 3), (1, 2), (1, 4), (2, 5), (3, 4), (3, 5), (4, 5)],
    "hex": [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)],
}
# Corners of the faces S1, S2, ... (P1, P2, ...).
FACES = {
    "tet": [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)],
    "prism": [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
    "hex": [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)],
    "tri": [(0, 1), (1, 2), (2, 0)],
    "quad": [(0, 1), (1, 2), (2, 3), (3, 0)],
}
SOLIDS = {4: "tet4", 10: "tet10", 6: "prism6", 15: "prism15", 8: "hex8", 20: "hex20"}
FLAT = {3: "tri3", 6: "tri6", 4: "quad4", 8: "quad8"}
POINTS = {"prism6": 2, "prism15": 9}  # of integration, fewer than those of the program
FAMILIES = {"C3D": "3", "CPE": "plane_strain", "CPS": "plane_stress", "CAX": "axisymmetric"}


@dataclasses.dataclass(frozen=True)
class Kind:
    """What a type name means. `formulation` is that of the deck; `note` says what the deck has instead of something else."""

    shape: str
    dimension: str  # of the deck
    formulation: str = "standard"
    note: str = ""


def family(shape):
    return shape.rstrip("0123456789")


def kind(name):
    """The Kind of a type name, or None if the deck has no such element."""
    match = re.fullmatch(r"(C3D|CPE|CPS|CAX)(\d+)([A-Z]*)", name.upper())
    if not match:
        return None
    of, nodes, suffix = match[1], int(match[2]), match[3]
    shape = (SOLIDS if of == "C3D" else FLAT).get(nodes)
    if shape is None or not set(suffix) <= set("RIHMTS"):
        return None
    formulation, notes = "standard", []
    if shape in ("hex8", "quad4"):
        if of != "CAX" and ("I" in suffix or "R" in suffix):
            formulation = "incompatible"
    if "R" in suffix:
        notes.append("full integration instead of reduced" + (", with incompatible modes" if formulation == "incompatible" else ""))
    if shape in POINTS:
        notes.append(f"full integration, where Abaqus and CalculiX take {POINTS[shape]} points: coarse meshes are stiffer")
    if "H" in suffix:
        formulation = "bbar" if shape in ("hex8", "quad4", "prism6") else formulation
        notes.append("displacements alone instead of a hybrid element")
    if "I" in suffix and formulation != "incompatible":
        notes.append("without incompatible modes")
    if "M" in suffix:
        notes.append("the plain element instead of the modified one")
    if "T" in suffix:
        notes.append("displacements alone, without temperatures as unknowns")
    return Kind(shape, FAMILIES[of], formulation, "; ".join(notes))


def face_shape(shape, corners):
    second = NODES[shape] != CORNERS[family(shape)]
    return {2: ("line2", "line3"), 3: ("tri3", "tri6"), 4: ("quad4", "quad8")}[corners][second]


@functools.lru_cache(None)
def face_places(shape, face):
    """(shape, places of its nodes in the cell) of face number `face` (from 0), in Abaqus' order: corners, then middles."""
    of = family(shape)
    corners = FACES[of][face]
    result = list(corners)
    if NODES[shape] != CORNERS[of]:
        middle = {frozenset(pair): CORNERS[of] + i for i, pair in enumerate(EDGES[of])}
        ring = [corners] if len(corners) == 2 else [(corners[i], corners[(i + 1) % len(corners)]) for i in range(len(corners))]
        result += [middle[frozenset(pair)] for pair in ring]
    return face_shape(shape, len(corners)), tuple(result)


def face_nodes(shape, nodes, face):
    """(shape, nodes) of a face of the cell with these nodes."""
    own, places = face_places(shape, face)
    return own, [nodes[k] for k in places]


def to_gmsh(shape):
    """Indices that bring the nodes of a cell into gmsh's order."""
    of, corners = family(shape), CORNERS[family(shape)]
    if NODES[shape] == corners:
        return list(range(corners))
    place = {frozenset(pair): corners + i for i, pair in enumerate(EDGES[of])}
    return list(range(corners)) + [place[frozenset(pair)] for pair in GMSH_EDGES[of]]


def _rule(shape):
    """Points and weights on the reference face, exact for the faces below where they are plane."""
    if shape.startswith("tri"):
        a, b = 0.445948490915965, 0.091576213509771
        points = [(a, a), (1 - 2 * a, a), (a, 1 - 2 * a), (b, b), (1 - 2 * b, b), (b, 1 - 2 * b)]
        return np.array(points), np.array([0.223381589678011 / 2] * 3 + [0.109951743655322 / 2] * 3)
    x, w = np.polynomial.legendre.leggauss(3)
    if shape.startswith("line"):
        return x[:, None], w
    return np.array([(a, b) for a in x for b in x]), np.array([p * q for p in w for q in w])


def _functions(shape, p):
    """Shape functions and their derivatives at a reference point."""
    if shape.startswith("line"):
        r = p[0]
        if shape == "line2":
            return np.array([(1 - r) / 2, (1 + r) / 2]), np.array([[-0.5, 0.5]])
        return np.array([r * (r - 1) / 2, r * (r + 1) / 2, 1 - r * r]), np.array([[r - 0.5, r + 0.5, -2 * r]])
    if shape.startswith("tri"):
        r, s = p
        t = 1 - r - s
        if shape == "tri3":
            return np.array([t, r, s]), np.array([[-1, 1, 0], [-1, 0, 1]])
        n = np.array([t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * t * r, 4 * r * s, 4 * s * t])
        return n, np.array([[1 - 4 * t, 4 * r - 1, 0, 4 * (t - r), 4 * s, -4 * s], [1 - 4 * t, 0, 4 * s - 1, -4 * r, 4 * r, 4 * (t - s)]])
    r, s = p
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    if shape == "quad4":
        n = [(1 + a * r) * (1 + b * s) / 4 for a, b in corners]
        return np.array(n), np.array([[a * (1 + b * s) / 4 for a, b in corners], [b * (1 + a * r) / 4 for a, b in corners]])
    n = [(1 + a * r) * (1 + b * s) * (a * r + b * s - 1) / 4 for a, b in corners]
    n += [(1 - r * r) * (1 - s) / 2, (1 + r) * (1 - s * s) / 2, (1 - r * r) * (1 + s) / 2, (1 - r) * (1 - s * s) / 2]
    dr = [a * (1 + b * s) * (2 * a * r + b * s) / 4 for a, b in corners] + [-r * (1 - s), (1 - s * s) / 2, -r * (1 + s), -(1 - s * s) / 2]
    ds = [b * (1 + a * r) * (a * r + 2 * b * s) / 4 for a, b in corners] + [-(1 - r * r) / 2, -s * (1 + r), (1 - r * r) / 2, -s * (1 - r)]
    return np.array(n), np.array([dr, ds])


def nodal_areas(shape, points, axisymmetric=False):
    """The integrals of a face's shape functions over it: what a traction 1 gives to each node. Shape (nodes,)."""
    points = np.asarray(points, dtype=float)
    result = np.zeros(len(points))
    for p, weight in zip(*_rule(shape)):
        n, d = _functions(shape, p)
        tangents = d @ points
        area = np.linalg.norm(tangents[0] if len(tangents) == 1 else np.cross(*tangents))
        result += weight * area * n * (2 * np.pi * (n @ points[:, 0]) if axisymmetric else 1)
    return result
