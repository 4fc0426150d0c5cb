"""Writes the mesh as a .msh file of gmsh (4.1, text) and the deck as YAML."""

import itertools
import re

import elements


def of_one_order(by_shape):
    """Cells of first and of second order apart: gmsh reads those of one order alone from an entity."""
    first = {shape: cells for shape, cells in by_shape.items() if elements.NODES[shape] == elements.CORNERS[elements.family(shape)]}
    second = {shape: cells for shape, cells in by_shape.items() if shape not in first}
    return [part for part in (first, second) if part]


def write_mesh(path, model, bodies, boundaries):
    """Bodies (volumes) and boundaries become physical groups. Faces with the same names are one entity of gmsh."""
    top = 3 if bodies.dimension == "3" else 2
    physical, groups = [], []  # (dimension, tag, name); entities: (tag, cells of each shape)
    for body in bodies.bodies:
        for name, (_, cells) in body.volumes.items():
            physical.append((top, len(physical) + 1, name))
            by_shape = {}
            for i in cells:
                element = model.elements[i]
                order = elements.to_gmsh(element.shape)
                by_shape.setdefault(element.shape, []).append([element.nodes[k] for k in order])
            for part in of_one_order(by_shape):
                groups.append((top, len(groups) + 1, [len(physical)], part))
    names_of = {}
    for name, keys in boundaries.items():
        physical.append((top - 1, len(physical) + 1, name))
        for key in keys:
            names_of.setdefault(key, []).append(len(physical))
    entities = {}
    for key, tags in sorted(names_of.items()):
        entities.setdefault(tuple(tags), []).append(key)
    number = 0
    for tags, keys in entities.items():
        by_shape = {}
        for key in keys:
            shape, nodes = bodies.shape(key), bodies.nodes(key)
            if len(set(nodes)) < len(nodes):
                nodes = bodies.corners(key)
                shape = {2: "line2", 3: "tri3", 4: "quad4"}[len(nodes)]
            by_shape.setdefault(shape, []).append(nodes)
        for part in of_one_order(by_shape):
            number += 1
            groups.append((top - 1, number, list(tags), part))
    used = sorted({n for _, _, _, by_shape in groups for cells in by_shape.values() for cell in cells for n in cell})
    points = [model.points[n] for n in used]
    box = " ".join(f"{f(p[c] for p in points):.17g}" for f in (min, max) for c in range(3))
    with open(path, "w", encoding="utf-8") as out:
        print("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames", file=out)
        print(len(physical), *(f'{d} {tag} "{name}"' for d, tag, name in physical), "$EndPhysicalNames", "$Entities", sep="\n", file=out)
        print(0, *(sum(g[0] == d for g in groups) for d in (1, 2, 3)), file=out)
        for d, tag, tags, _ in sorted(groups, key=lambda g: g[0]):
            print(tag, box, len(tags), *tags, 0, file=out)
        print("$EndEntities\n$Nodes", file=out)
        print(1, len(used), 1, used[-1] + 1, file=out)
        print(top, 1, 0, len(used), file=out)
        for n in used:
            print(n + 1, file=out)
        for p in points:
            print(f"{p[0]:.17g} {p[1]:.17g} {p[2]:.17g}", file=out)
        print("$EndNodes\n$Elements", file=out)
        blocks = [(d, tag, shape, cells) for d, tag, _, by_shape in groups for shape, cells in by_shape.items()]
        count = sum(len(cells) for *_, cells in blocks)
        print(len(blocks), count, 1, count, file=out)
        number = 0
        for d, tag, shape, cells in blocks:
            print(d, tag, elements.GMSH_TYPE[shape], len(cells), file=out)
            for cell in cells:
                number += 1
                print(number, *(n + 1 for n in cell), file=out)
        print("$EndElements", file=out)


def write_fields(path, model, members, fields):
    """A .vtu of these elements with values at their nodes; VTK counts the nodes of a cell as CalculiX does."""
    cells = [model.elements[i] for i in members]
    used = sorted({n for cell in cells for n in cell.nodes})
    place = {n: k for k, n in enumerate(used)}
    offsets = list(itertools.accumulate(len(cell.nodes) for cell in cells))

    def array(kind, name, values, columns=1):
        text = " ".join(f"{v:.17g}" if kind == "Float64" else str(v) for v in values)
        return f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{columns}" format="ascii">{text}</DataArray>'

    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>',
        f'<Piece NumberOfPoints="{len(used)}" NumberOfCells="{len(cells)}">',
        "<PointData>",
        *(array("Float64", name, [values[n] for n in used]) for name, values in fields.items()),
        "</PointData>",
        f"<Points>{array('Float64', 'Points', [c for n in used for c in model.points[n]], 3)}</Points>",
        "<Cells>",
        array("Int64", "connectivity", [place[n] for cell in cells for n in cell.nodes]),
        array("Int64", "offsets", offsets),
        array("UInt8", "types", [elements.VTK_TYPE[cell.shape] for cell in cells]),
        "</Cells></Piece></UnstructuredGrid></VTKFile>",
    ]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


PLAIN = re.compile(r"[A-Za-z_][\w.+-]*( [\w.+-]+)*")
WORDS = {"true", "false", "null", "yes", "no", "on", "off"}


def scalar(value):
    """A number that every reader of YAML takes for one, or text with quotes where it needs them."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        text = f"{value:.12g}"
        if "e" in text:
            mantissa, exponent = text.split("e")
            return f"{mantissa if '.' in mantissa else mantissa + '.0'}e{exponent}"
        return text
    if isinstance(value, int):
        return str(value)
    if (PLAIN.fullmatch(value) or re.fullmatch(r"-?360/\d+", value)) and value.lower() not in WORDS:
        return value
    return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'


def flow(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{scalar(k)}: {flow(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(flow(v) for v in value) + "]"
    return scalar(value)


def deck_text(deck, findings, head):
    """The deck with a comment for what it has otherwise, or not at all."""
    result = [f"# {line}" for line in head]
    for key, value in deck.items():
        if value in ({}, []) and key not in ("materials", "bodies"):
            continue
        if isinstance(value, dict) and key != "mesh":
            result.append(f"{key}:")
            result += [f"  {scalar(k)}: {flow(v)}" for k, v in value.items()]
        elif isinstance(value, list):
            result.append(f"{key}:")
            result += [f"  - {flow(v)}" for v in value]
        else:
            result.append(f"{key}: {flow(value)}")
    for text, chosen in (("Left out, and the answer is another one for it:", True), ("Otherwise than in the file:", False)):
        lines = describe(findings, chosen)
        if lines:
            result += ["", f"# {text}", *(f"#   {line}" for line in lines)]
    return "\n".join(result) + "\n"


def describe(findings, changes):
    return [f"{f.file.name}:{f.line}: {f.keyword}: {f.reason}" for f in findings if f.changes == changes]
