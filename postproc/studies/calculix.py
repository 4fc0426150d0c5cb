"""A deck and its mesh in the language of CalculiX, and what CalculiX found.

Translated: elastic materials, solids of first and second order, plane strain and plane stress, prescribed displacements, pressures,
tractions, forces and accelerations, contact surface to surface (linear penalty) without friction or with Coulomb's, interference, bolts whose
two parts share the nodes of the cut, steps of one increment. A bolt is parted there and its two sides are joined by equations: by a *PRE-TENSION
SECTION through tetrahedra heads carried a fifth of the force, probably as those that have an edge or a corner alone on the cut are not parted.
CalculiX has no cells with nodes inside faces: quad9, hex27 and prism18 become quad8, hex20 and prism15 on the same corners and edges.
Needs python3-meshio.
"""

import contextlib
import re

import meshio
import numpy as np

from studies import measure, pressure
from studies.refinement import BadInput

SOLVERS = {"SPOOLES": "SPOOLES", "ITERATIVE CHOLESKY": "iterative"}
SOLID = {
    "hexahedron": "C3D8",
    "tetra": "C3D4",
    "wedge": "C3D6",
    "hexahedron20": "C3D20",
    "hexahedron27": "C3D20",
    "tetra10": "C3D10",
    "wedge15": "C3D15",
    "wedge18": "C3D15",
}
PLANE = {"triangle": "3", "quad": "4", "triangle6": "6", "quad8": "8", "quad9": "8"}
INCOMPATIBLE = {"C3D8": "C3D8I", "C3D8I": "C3D8I"}
# Corners of the faces S1, S2, ... in CalculiX's order, by the number of corners of the cell.
FACES = {
    (3, 8): [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)],
    (3, 4): [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)],
    (3, 6): [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
    (2, 3): [(0, 1), (1, 2), (2, 0)],
    (2, 4): [(0, 1), (1, 2), (2, 3), (3, 0)],
}
CORNERS = {"hexahedron": 8, "tetra": 4, "wedge": 6, "triangle": 3, "quad": 4, "line": 2}
# Share of each node in a load spread evenly over a straight facet: corners, then middles.
SHARES = {
    2: [1 / 2] * 2,
    3: [1 / 6, 1 / 6, 2 / 3],
    (3, 3): [1 / 3] * 3,
    (3, 6): [0] * 3 + [1 / 3] * 3,
    (4, 4): [1 / 4] * 4,
    (4, 8): [-1 / 12] * 4 + [1 / 3] * 4,
}


def corners(kind):
    return CORNERS[re.sub(r"\d+$", "", kind)]


class Mesh:
    """Nodes, cells by body and facets by boundary of a .msh file with physical names, numbered from 1 in CalculiX's files."""

    def __init__(self, path, dimension, scale=1.0):
        with contextlib.redirect_stdout(None):  # its reader prints an empty line
            mesh = meshio.read(path)
        self.dimension = dimension
        self.points = scale * np.array(mesh.points)
        name = {(int(data[1]), int(data[0])): key for key, data in mesh.field_data.items()}
        self.bodies, self.boundaries, self.sides_of, self.parted = {}, {}, {}, {}
        element = 0
        for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
            for tag in np.unique(tags):
                key = name.get((block.dim, int(tag)))
                cells = block.data[tags == tag]
                if key is None:
                    continue
                if block.dim == dimension:
                    numbers = np.arange(element + 1, element + 1 + len(cells))
                    element += len(cells)
                    self.bodies.setdefault(key, []).append((block.type, numbers, cells))
                    self.note_sides(block.type, numbers, cells)
                elif block.dim == dimension - 1:
                    self.boundaries.setdefault(key, []).extend((block.type, cell) for cell in cells)

    def note_sides(self, kind, numbers, cells):
        for side, of_face in enumerate(FACES[self.dimension, corners(kind)]):
            for number, nodes in zip(numbers, np.sort(cells[:, of_face], axis=1)):
                self.sides_of[tuple(nodes)] = (number, side + 1)

    def unknowns(self):
        return self.dimension * len({int(n) for blocks in self.bodies.values() for _, _, cells in blocks for n in cells.ravel()})

    def facets(self, boundary):
        if boundary not in self.boundaries:
            raise BadInput(f"the mesh has no boundary {boundary} (boundaries narrowed to a body are translated in the cuts of bolts alone)")
        return self.boundaries[boundary]

    def nodes(self, boundary):
        """Without the nodes inside facets, which CalculiX's cells lack."""
        return sorted({int(n) + 1 for kind, facet in self.facets(boundary) for n in facet[: serendipity(kind)]})

    def sides(self, boundary):
        return [self.sides_of[tuple(sorted(facet[: corners(kind)]))] for kind, facet in self.facets(boundary)]

    def part(self, boundary, body):
        """Gives a body nodes of its own on a boundary that it shares with another one: [(the old node, the new one)], and its mean normal there."""
        if boundary not in self.parted:
            old = np.unique([facet for _, facet in self.facets(boundary)])
            copy = {int(n): len(self.points) + i for i, n in enumerate(old)}
            self.points = np.vstack([self.points, self.points[old]])
            near = []
            for kind, _, cells in self.bodies[body]:
                on = np.isin(cells, old)
                near.append(self.points[cells[on.any(axis=1)][:, : corners(kind)]].mean(axis=(0, 1)))
                cells[on] = [copy[int(n)] for n in cells[on]]
            normal = np.zeros(3)
            for kind, facet in self.facets(boundary):
                x = self.points[facet[: corners(kind)]]
                own = np.cross(x[1] - x[0], x[2] - x[0])
                normal += own * np.sign(own @ (x[0] - np.mean(near, axis=0)))
            self.parted[boundary] = [(a + 1, b + 1) for a, b in copy.items()], normal / np.linalg.norm(normal)
        return self.parted[boundary]

    def shares(self, boundary):
        """Measure of the boundary that falls to each node when a traction is spread over it."""
        result = {}
        for kind, facet in self.facets(boundary):
            n = corners(kind)
            x = self.points[facet[:n]]
            if n == 2:
                size = np.linalg.norm(x[1] - x[0])
            else:
                size = 0.5 * np.linalg.norm(np.cross(x[2] - x[0], x[-1] - x[1] if n == 4 else x[1] - x[0]))
            count = serendipity(kind)
            for node, share in zip(facet, SHARES[count if n == 2 else (n, count)]):
                result[int(node) + 1] = result.get(int(node) + 1, 0) + share * size
        return result


def serendipity(kind):
    """Nodes of a cell without those inside it or inside its faces."""
    return {
        "hexahedron27": 20,
        "wedge18": 15,
        "quad9": 8,
        "hexahedron20": 20,
        "wedge15": 15,
        "quad8": 8,
        "tetra10": 10,
        "triangle6": 6,
        "line3": 3,
    }.get(kind, corners(kind))


def element_type(kind, dimension, formulation):
    if dimension == 3:
        name = SOLID[kind]
        return INCOMPATIBLE.get(name, name) if formulation == "incompatible" else name
    return {"plane_strain": "CPE", "plane_stress": "CPS"}[dimension] + PLANE[kind]


def lines(values, width=12):
    values = list(values)
    return [", ".join(map(str, values[i : i + width])) + "," for i in range(0, len(values), width)]


def model(deck, mesh):
    """Nodes, elements, materials, sets and contact pairs."""
    dimension = deck.get("dimension", 3)
    # CalculiX reads 20 characters of a number.
    text = ["*NODE, NSET=ALL"] + [f"{i + 1}, {x:.12g}, {y:.12g}, {z:.12g}" for i, (x, y, z) in enumerate(mesh.points)]
    for body, blocks in mesh.bodies.items():
        for kind, numbers, cells in blocks:
            text.append(f"*ELEMENT, TYPE={element_type(kind, dimension, deck['bodies'][body].get('formulation'))}, ELSET={body}")
            for number, cell in zip(numbers, cells):
                words = [str(number), *map(str, cell[: serendipity(kind)] + 1)]
                text += [", ".join(words[:16]) + ("," if len(words) > 16 else "")] + ([", ".join(words[16:])] if len(words) > 16 else [])
    for name, material in deck["materials"].items():
        text += [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{material['young_modulus']}, {material['poisson_ratio']}"]
        if "density" in material:
            text += ["*DENSITY", f"{material['density']}"]
    for name, body in deck["bodies"].items():
        text += [f"*SOLID SECTION, ELSET={name}, MATERIAL={body['material']}"] + (["1."] if dimension != 3 else [])
    for support in deck.get("supports", []):
        text += [f"*NSET, NSET=N{support['boundary']}"] + lines(mesh.nodes(support["boundary"]))
    return text


def contact(deck, mesh, penalty):
    text = []
    for number, pair in enumerate(deck.get("contacts", [])):
        friction = pair.get("friction", {})
        if "preload" in pair:
            pairs, normal = mesh.part(*cut_of(pair))
            node = len(mesh.points) + 1 + number
            text += [f"*NODE, NSET=bolt{number}", f"{node}, 0., 0., 0.", "*EQUATION"]
            for fixed, own in pairs:
                for k, n in enumerate(normal, 1):
                    terms = [f"{own}, {k}, 1.", f"{fixed}, {k}, -1."] + ([f"{node}, 1, {-n:.12g}"] if abs(n) > 1e-9 else [])
                    text += [f"{len(terms)}", ", ".join(terms)]
            continue
        if not set(friction) <= {"coulomb"} or isinstance(pair["primary"], dict):
            raise BadInput(f"contact {pair.get('name', number)}: only contact without friction or with Coulomb's is translated")
        for role in ("secondary", "primary"):
            text += [f"*SURFACE, NAME={role[0]}{number}, TYPE=ELEMENT"] + [f"{e}, S{s}" for e, s in mesh.sides(pair[role])]
        text += [f"*SURFACE INTERACTION, NAME=touch{number}", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{penalty:g}, 0."]
        if friction:
            text += ["*FRICTION", f"{friction['coulomb']}, {penalty / 10:g}"]
        text += [f"*CONTACT PAIR, INTERACTION=touch{number}, TYPE=SURFACE TO SURFACE", f"s{number}, p{number}"]
        if pair.get("interference"):
            text += [f"*CLEARANCE, SLAVE=s{number}, MASTER=p{number}, VALUE={-pair['interference']:g}"]
    return text


def cut_of(pair):
    """The boundary that both parts of a bolt have in common, and the body on the secondary side."""
    (body, cut), (_, other) = (pair[role].split(":") for role in ("secondary", "primary"))
    if cut != other or "force" not in pair["preload"]:
        raise BadInput(f"contact {pair.get('name')}: only bolts tightened to a force are translated whose two parts share the nodes of one cut")
    return cut, body


def step(deck, mesh, scale, first):
    """What acts in a step, by the factors that it reaches. Supports stay; bolts keep their length from the second step on."""
    text = []
    for support in deck.get("supports", []) if first else []:
        text.append("*BOUNDARY")
        for component, value in support["displacement"].items():
            axis = "xyz".index(component) + 1
            text.append(f"N{support['boundary']}, {axis}, {axis}, {value}")
    for number, pair in enumerate(deck.get("contacts", [])):
        if "preload" in pair:
            text += ["*CLOAD", f"bolt{number}, 1, {pair['preload']['force']}"] if first else ["*BOUNDARY, FIXED", f"bolt{number}, 1, 1"]
    scaled = []
    for load in deck.get("loads", []):
        factor = scale.get(load.get("name"), 1)
        scaled.append(load if factor == 1 else {k: times(factor, v) if k in ("pressure", "acceleration", "force", "traction") else v for k, v in load.items()})
    return text + loads(dict(deck, loads=scaled), mesh)


def times(factor, value):
    return [factor * v for v in value] if isinstance(value, list) else factor * value


def loads(deck, mesh):
    text = []
    for load in deck.get("loads", []):
        if "pressure" in load:
            text += ["*DLOAD"] + [f"{e}, P{s}, {load['pressure']}" for e, s in mesh.sides(load["boundary"])]
        elif "acceleration" in load:
            vector = np.array(list(load["acceleration"]) + [0] * (3 - len(load["acceleration"])), dtype=float)
            size = np.linalg.norm(vector)
            text += ["*DLOAD", f"{load['body']}, GRAV, {size}, " + ", ".join(f"{v:.12g}" for v in vector / size)]
        else:
            shares = mesh.shares(load["boundary"])
            whole = sum(shares.values()) if "force" in load else 1.0
            text.append("*CLOAD")
            for axis, value in enumerate(load["force"] if "force" in load else load["traction"]):
                text += [f"{node}, {axis + 1}, {value * share / whole:.12g}" for node, share in shares.items() if share]  # 0 as well: steps
    return text


def input_file(deck, mesh, penalty, solver):
    """The deck in CalculiX's language; `penalty` is a pressure a length."""
    for pair in deck.get("contacts", []):
        if "preload" in pair:
            mesh.part(*cut_of(pair))
    text = model(deck, mesh) + contact(deck, mesh, penalty)
    steps = deck.get("steps") or [{}]
    known = {load["name"] for load in deck.get("loads", []) if "name" in load}
    for number, one in enumerate(steps):
        if not set(one) <= {"name", "scale"} or not set(one.get("scale", {})) <= known:
            raise BadInput("only steps of one increment that scale loads are translated")
        scale = {key: factor for before in steps[: number + 1] for key, factor in before.get("scale", {}).items()}
        text += ["*STEP", f"*STATIC, SOLVER={solver}", "1., 1."] + step(deck, mesh, scale, number == 0)
        for support in deck.get("supports", []):
            text += [f"*NODE PRINT, NSET=N{support['boundary']}, TOTALS=ONLY", "RF"]
        for body in deck["bodies"]:
            text += [f"*EL PRINT, ELSET={body}, TOTALS=ONLY", "ELSE"]
        for pair, of in enumerate(deck.get("contacts", [])):
            if "preload" not in of:
                text += [f"*CONTACT PRINT, SLAVE=s{pair}, MASTER=p{pair}", "CF"]
        text += ["*CONTACT PRINT", "CSTR", "*NODE FILE", "U, RF", "*EL FILE", "S", "*CONTACT FILE", "CDIS, CSTR", "*END STEP"]
    return "\n".join(text) + "\n"


def solve(deck, mesh, penalty, solver, directory, limit=None):
    """Runs CalculiX in `directory`; `penalty` in Young's moduli of the stiffest material a length."""
    stiffest = max(material["young_modulus"] for material in deck["materials"].values())
    (directory / "job.inp").write_text(input_file(deck, mesh, penalty * stiffest, solver))
    return measure.run(["ccx", "-i", "job"], directory, limit)


def results(directory, deck, mesh, formula, contact):
    """By the names of summary.json, as far as CalculiX tells them: peaks are those of nodes, pressures of the first contact."""
    _, displacements = nodal_field(directory, "DISP")
    if not len(displacements):
        return {}
    found = {
        "strain_energy": strain_energy(directory, len(deck["bodies"])),
        "max_displacement": float(np.linalg.norm(displacements[:, :3], axis=1).max()),
    }
    force = contact_force(directory, deck, mesh, deck["contacts"][contact]["secondary"]) if len(deck["contacts"]) == 1 else None
    if force is not None:
        found["contacts.0.force"] = float(np.linalg.norm(force))
    numbers, states = nodal_field(directory, "CONTACT")
    if len(numbers):
        on_surface = dict(zip(numbers, states[:, 3]))
        found[f"contacts.{contact}.max_recovered_pressure"] = max(on_surface.get(n, 0.0) for n in mesh.nodes(deck["contacts"][contact]["secondary"]))
        if formula:
            found["pressure (L2)"] = pressure.relative_error(pressure.of_calculix(mesh, deck["contacts"][contact]["secondary"], on_surface), formula)
    return found


def contact_force(directory, deck, mesh, secondary):
    """On the secondary's body, from its supports; None where there are loads, or where a support holds nodes of the contact, whose
    contact forces CalculiX counts in."""
    if deck.get("loads"):
        return None
    body = next(name for name, blocks in mesh.bodies.items() if any(mesh.nodes(secondary)[0] - 1 in cells for _, _, cells in blocks))
    own = {int(n) + 1 for _, _, cells in mesh.bodies[body] for n in cells.ravel()}
    held = own & {n for support in deck["supports"] for n in mesh.nodes(support["boundary"])}
    if held & set(mesh.nodes(secondary)):
        return None
    numbers, forces = nodal_field(directory, "FORC")
    return -sum(force[:3] for number, force in zip(numbers, forces) if number in held)


def reactions(directory, supports):
    """Total force of each of so many supports, in the deck's order, at the end of the step."""
    text = (directory / "job.dat").read_text()
    rows = re.findall(r"total force \(fx,fy,fz\).*?\n\s*\n\s*(\S+)\s+(\S+)\s+(\S+)", text)
    return [[float(value) for value in row] for row in rows[-supports:]]


def strain_energy(directory, bodies):
    """Of all bodies at the end of the step."""
    text = (directory / "job.dat").read_text()
    return sum(float(value) for value in re.findall(r"total internal energy.*?\n\s*\n\s*(\S+)", text)[-bodies:])


def largest_pressure(directory):
    """Of all points of contact, from job.dat."""
    result = 0.0
    for block in (directory / "job.dat").read_text().split("contact stress")[1:]:
        for row in block.split("\n")[2:]:
            fields = row.split()
            if len(fields) < 5 or not fields[0].isdigit():
                break
            result = max(result, float(fields[-3]))
    return result


def nodal_field(directory, name):
    """The last field `name` of job.frd: numbers of its nodes, and a row of components for each; empty where it has none."""
    values, reading = {}, False
    if not (directory / "job.frd").exists():
        return np.array([]), np.array([])
    with open(directory / "job.frd") as file:
        for line in file:
            if line.startswith(" -4"):
                reading = line.split()[1] == name
                if reading:
                    values = {}
            elif line.startswith(" -3"):
                reading = False
            elif reading and line.startswith(" -1"):
                values[int(line[3:13])] = [float(line[i : i + 12]) for i in range(13, len(line.rstrip()) - 11, 12)]
    return np.array(list(values)), np.array(list(values.values()))
