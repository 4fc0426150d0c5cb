"""The arrangements of sides.py: partly covered contacts, each with its meshes and where its stresses are infinite."""

import dataclasses
from typing import Callable, Optional

import numpy as np

SHAPES = {"tet": 0, "tri": 0, "hex": 1, "quad": 1, "prism": 2}
SOLIDS = ["hex8", "hex20", "hex27", "tet4", "tet10", "prism6", "prism15"]
PLANE = ["tri3", "tri6", "quad4", "quad8", "quad9"]
SECOND = {"hex20", "hex27", "tet10", "prism15", "prism18", "tri6", "quad8", "quad9"}
INCOMPLETE = {"hex20", "prism15", "quad8"}
LAWS = {"frictionless": None, "coulomb": 0.15}


def gmsh_cell(cell):
    """The constants of the geometries that make this cell."""
    values = {"shape": SHAPES[cell.rstrip("0123456789")], "order": 2 if cell in SECOND else 1, "incomplete": int(cell in INCOMPLETE)}
    return [f"mesh.constants.{key}={value}" for key, value in values.items()]


def block_cell(cell):
    return [f"mesh.blocks.{body}.element={cell}" for body in ("lower", "upper")]


@dataclasses.dataclass(eq=False)
class Model:
    """One arrangement. sides: boundaries of each contact, the first of them secondary in the deck. away(x, y, z) -> distance from the
    lines where stress is infinite, in units of a distance that is about one cell of the first size. load: its component and size."""

    name: str
    title: str
    deck: str
    sides: list
    cells: list
    sizes: list  # settings, one list a size, from coarse to fine
    away: Callable
    load: tuple
    cell: Callable = gmsh_cell
    laws: tuple = ("frictionless", "coulomb")
    coefficient: float = 0.15
    extra: Optional[Callable] = None  # extra(result) -> {figure: (value, exact or None, tolerance)}
    reference: dict = dataclasses.field(default_factory=dict)  # law: {figure: value of a much finer mesh}
    force_tolerance: float = 1e-6
    quick: tuple = ()  # (cell, law) of the quick selection
    suite: tuple = ()  # of what the suite runs; the quick selection if nothing else is said
    last: tuple = ()  # of what the suite runs on the last mesh as well, to hold it against the reference
    coarse: Callable = lambda cell: 0  # number of sizes with too few faces in the contact for stresses: forces are judged, and that the run warns

    def __post_init__(self):
        self.suite = self.suite or self.quick


def h(*values):
    return [[f"mesh.constants.h={value}"] for value in values]


def named(references):
    """{law: (pressure, von Mises, energy)} as Model.reference has it."""
    return {law: dict(zip(("pressure", "von Mises", "energy"), values)) for law, values in references.items()}


def from_circle(radius, place, axis):
    """Distance from a circle about an axis."""

    def distance(*x):
        along = x[axis]
        across = np.sqrt(sum(x[i] ** 2 for i in range(len(x)) if i != axis))
        return np.hypot(across - radius, along - place)

    return distance


def pin_away(x, y, z):
    return np.minimum(from_circle(10, 5, 2)(x, y, z), 9 - z) / 3


def ball_away(x, y, z):
    return np.minimum(from_circle(4, -np.sqrt(84), 1)(x, y, z), from_circle(10 * np.sqrt(0.75), -5, 1)(x, y, z)) / 1.5


def roller_away(x, y, z):
    return np.where(np.hypot(x, y) < 3, np.abs(z - 5) / 1.0, 10)


def disc_away(x, y, z):
    edge = np.where(np.hypot(x, y) < 12.5, np.hypot(x - 4, z), 25)
    return np.minimum(edge, from_circle(10, 0, 2)(x, y, z)) / 2.5


def key_away(x, y, z):
    corners = [(np.cos(a), np.sin(a)) for a in (np.arange(6) + 0.5) * np.pi / 3]
    return np.min([np.hypot(x - 5.77 * a, y - 5.77 * b) for a, b in corners], axis=0)


def block_away(offset, axis):
    def away(*x):
        edges = np.minimum(np.hypot(x[0] - 1, x[axis] - 1), np.hypot(x[0] - offset, x[axis] - 1))
        return np.minimum(edges, np.hypot(np.abs(x[0]) - 1, x[axis])) / 0.25  # the base is clamped

    return away


def strip_figures(result):
    """Share of the load that acts as shear, and the width that sticks, both in the contact's tractions."""
    from cases.common import by_x

    x, traction, areas = by_x(result, "contact_traction")
    pressed = np.abs(traction[:, 1]) > 0
    share = np.sum(areas * np.abs(traction[:, 0])) / np.sum(areas * np.abs(traction[:, 1]))
    stuck = pressed & (result.contact.fields["contact_status"][np.argsort(result.contact.points[:, 0], kind="stable")] == 1)
    return {"shear share": (share, None, 0.1), "stick width": (float(np.sum(areas[stuck])), None, 0.1)}


def v_figures(result):
    forces = sorted((contact["force"] for contact in result.summary["contacts"]), key=lambda f: -abs(f[1]))[:2]  # the blocks touch, too
    return {
        "sideways": (max((abs(abs(f[0]) - 2) for f in forces)) + 2, 2, 1e-6),
        "upwards": (max((abs(abs(f[1]) - 2) for f in forces)) + 2, 2, 1e-6),
    }


def blocks(n, offset, dimension):
    """Cells of the two blocks, n times as many as at first; in space the width keeps its cells."""
    y = lambda width: [] if dimension == 2 else [width]
    words = lambda cells: f"[{', '.join(map(str, cells))}]"
    origin = [offset] + y(0) + [1]
    return [
        f"mesh.blocks.lower.cells={words([8 * n, *y(4), 4 * n])}",
        f"mesh.blocks.upper.cells={words([5 * n, *y(5), 4 * n])}",
        f"mesh.blocks.upper.origin={words(origin)}",
    ]


QUICK_BLOCKS = {  # in a plane, in space
    "tenth": ((("quad8", "frictionless"),), (("hex8", "coulomb"),)),
    "third": ((("tri3", "coulomb"),), (("tet10", "frictionless"),)),
    "two_thirds": ((("quad4", "frictionless"),), (("prism6", "frictionless"),)),
}


REFERENCE_BLOCKS = {  # quad9 with twelve times the cells
    "tenth": {"frictionless": (10.40, 10.84, 0.07792), "coulomb": (10.41, 10.96, 0.07780)},
    "third": {"frictionless": (11.18, 12.82, 0.08227), "coulomb": (11.13, 12.37, 0.08211)},
    "two_thirds": {"frictionless": (12.58, 16.50, 0.09138), "coulomb": (12.41, 15.32, 0.09089)},
}


SUITE_BLOCKS = {  # in space, beside the quick ones
    "tenth": ("hex20", "frictionless"),
    "third": ("prism15", "coulomb"),
    "two_thirds": ("hex27", "coulomb"),
}


def block_models():
    for name, part in (("tenth", 0.1), ("third", 1 / 3), ("two_thirds", 2 / 3)):
        offset = 0.2 * part
        for dimension, deck, cells, up in ((3, "block_over_edge", SOLIDS, "z"), (2, "block_over_edge_2d", PLANE, "y")):
            yield Model(
                f"block_{name}" + ("_2d" if dimension == 2 else ""),
                f"A block that hangs over an edge by {name.replace('_', ' ')} of a cell",
                f"{deck}.yaml",
                [(f"upper.{up}min", f"lower.{up}max")],
                cells,
                [blocks(n, offset, dimension) for n in (1, 2, 3)],
                block_away(offset, dimension - 1),
                (dimension - 1, 10),
                block_cell,
                reference=named(REFERENCE_BLOCKS[name]),
                quick=QUICK_BLOCKS[name][dimension - 2],
                suite=QUICK_BLOCKS[name][dimension - 2] + ((SUITE_BLOCKS[name],) if dimension == 3 else ()),
                last=() if dimension == 3 else (("quad8", "frictionless"),),
            )


REFERENCE_ROLLERS = {  # hex20 with cells of 0.1, with friction of 0.14
    "longer": {"frictionless": (2325, 1573, 92.21), "coulomb": (2304, 1518, 91.83)},
    "shorter": {"frictionless": (2322, 1545, 94.44), "coulomb": (2307, 1452, 93.58)},
}


def roller_models():
    for name, lengths in (("longer", (6, 5)), ("shorter", (5, 6))):
        sizes = [[*s, f"mesh.constants.roller={lengths[0]}", f"mesh.constants.track={lengths[1]}"] for s in h(0.3, 0.2, 0.14)]
        yield Model(
            f"roller_{name}",
            f"A roller {name} than its track",
            "roller_on_track.yaml",
            [("track_surface", "roller_surface")],
            SOLIDS,
            sizes,
            roller_away,
            (1, 5000),
            reference=named(REFERENCE_ROLLERS[name]),
            quick=(("hex20", "frictionless"),) if name == "longer" else (("tet10", "coulomb"),),
            suite=(("hex8", "frictionless"),) if name == "longer" else (("tet4", "coulomb"),),
            last=(("hex8", "frictionless"),),
        )


MODELS = [
    Model(
        "pin_in_lug",
        "A pin that sticks out of the hole of a plate, clearance 0.05",
        "pin_in_lug.yaml",
        [("hole", "pin_side")],
        SOLIDS,
        h(3, 2, 1.4),
        pin_away,
        (0, 2500),
        quick=(("tet10", "coulomb"), ("hex20", "frictionless")),
        suite=(("tet10", "coulomb"), ("hex8", "frictionless")),
        reference={
            "frictionless": {"pressure": 125.6, "von Mises": 119.5, "energy": 21.26},
            "coulomb": {"pressure": 118.7, "energy": 21.19},
        },
        last=(("hex8", "frictionless"),),
    ),
    Model(
        "ball_in_socket",
        "A ball in a part of a sphere, both rims of which cross its faces",
        "ball_in_socket.yaml",
        [("socket_surface", "ball_surface")],
        SOLIDS,
        h(1.5, 1, 0.7),
        ball_away,
        (1, 10e3),
        quick=(("prism15", "frictionless"),),
        suite=(("prism6", "frictionless"),),
        reference={
            "frictionless": {"pressure": 225.5, "von Mises": 478, "energy": 105.85},
            "coulomb": {"pressure": 193.3, "von Mises": 314.5, "energy": 85.2},
        },
    ),
    Model(
        "ball_in_socket_2d",
        "The same, axisymmetric",
        "ball_in_socket_2d.yaml",
        [("socket_surface", "ball_surface")],
        PLANE,
        h(1.5, 0.8, 0.4),
        lambda x, y, z: ball_away(x, y, 0 * z),
        (1, 40e3),
        quick=(("tri6", "frictionless"), ("quad4", "coulomb")),
        reference={
            "frictionless": {"pressure": 225.5, "von Mises": 478, "energy": 423.4},
            "coulomb": {"pressure": 193.3, "von Mises": 314.5, "energy": 340.9},
        },
    ),
    *roller_models(),
    Model(
        "disc_on_plate",
        "A disc on a plate over whose edge it hangs",
        "disc_on_plate.yaml",
        [("disc_bottom", "plate_top")],
        SOLIDS,
        h(2.5, 1.7, 1.2),
        disc_away,
        (2, 10e3),
        quick=(("hex8", "frictionless"), ("prism15", "coulomb")),
        suite=(("hex8", "frictionless"), ("prism6", "coulomb")),
        reference={
            "frictionless": {"pressure": 130.3, "von Mises": 232.3, "energy": 38.90},
            "coulomb": {"pressure": 122.7, "von Mises": 208.2, "energy": 35.72},
        },
        last=(("hex8", "frictionless"),),
    ),
    *block_models(),
    Model(
        "key_in_hole",
        "A hexagonal key that is pushed into an edge of its hole: concave edges, in which lines along normals pass the key's edges",
        "key_in_hole.yaml",
        [("hole", "flats")],
        PLANE,
        h(1, 0.6, 0.35),
        key_away,
        (0, 866.0254037844386),
        reference={
            "frictionless": {"pressure": 103.2, "energy": 2.372},
            "coulomb": {"pressure": 99.59, "energy": 2.281},
        },
        quick=(("tri6", "frictionless"),),
    ),
    Model(
        "cylinder_in_v",
        "A cylinder in a V without friction: half the load sideways at each face",
        "cylinder_in_v.yaml",
        [("rim_left", "face_left"), ("rim_right", "face_right")],
        PLANE,
        h(0.15, 0.04, 0.025),
        lambda x, y, z: 0 * x + 10,
        (1, 4),
        laws=("frictionless",),
        extra=v_figures,
        quick=(("tri3", "frictionless"), ("quad9", "frictionless")),
        coarse=lambda cell: 1,
    ),
    Model(
        "strip",
        "A cylinder on a block, a / R = 0.12, friction 0.1, pressed alone",
        "strip.yaml",
        [("block_top", "cylinder_surface")],
        PLANE,
        h(0.6, 0.4, 0.25),
        lambda x, y, z: np.where(np.hypot(x, y) < 12, 10, 0),
        (1, 65.25e3),
        laws=("coulomb",),
        coefficient=0.1,
        extra=strip_figures,
        reference={"coulomb": {"pressure": 6940, "von Mises": 4072, "energy": 34870}},
        quick=(("quad8", "coulomb"),),
    ),
]
