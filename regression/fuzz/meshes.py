"""Meshes: small valid ones of each format, most of them written by the gmsh library, and mutations of their bytes, numbers, lines and
sections."""
import contextlib
import ctypes
import ctypes.util
import math
import os
import pathlib
import re
import struct

GEO = {
    # Two boxes, one on the other, whose meshes do not match.
    "hexes": """DefineConstant[ size = 2 ];
body[] = {}; below[] = {}; above[] = {};
For b In {0:1}
  z = 0.5 * b; x = 0.1 * b; y = 1 - x; n = size + b; p = newp;
  Point(p) = {x, x, z}; Point(p + 1) = {y, x, z}; Point(p + 2) = {y, y, z}; Point(p + 3) = {x, y, z};
  l = newl; Line(l) = {p, p + 1}; Line(l + 1) = {p + 1, p + 2}; Line(l + 2) = {p + 2, p + 3}; Line(l + 3) = {p + 3, p};
  c = newll; Curve Loop(c) = {l, l + 1, l + 2, l + 3}; s = news; Plane Surface(s) = {c};
  Transfinite Curve{l, l + 1, l + 2, l + 3} = n + 1; Transfinite Surface{s}; Recombine Surface{s};
  out[] = Extrude {0, 0, 0.5} { Surface{s}; Layers{n}; Recombine; };
  body[] += out[1]; below[] += s; above[] += out[0];
EndFor
Physical Volume("lower") = {body[0]}; Physical Volume("upper") = {body[1]};
Physical Surface("ground") = {below[0]}; Physical Surface("lower_top") = {above[0]};
Physical Surface("upper_bottom") = {below[1]}; Physical Surface("pressed") = {above[1]};
""",
    "tets": """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 0.5}; Cylinder(2) = {0.5, 0.5, 0.5, 0, 0, 0.5, 0.4};
Physical Volume("lower") = {1}; Physical Volume("upper") = {2};
Physical Surface("ground") = {5}; Physical Surface("lower_top") = {6};
Physical Surface("upper_bottom") = {9}; Physical Surface("pressed") = {8};
MeshSize{:} = 0.5;
""",
    # The upper body by its surface alone.
    "skin": """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 0.5}; Cylinder(2) = {0.5, 0.5, 0.5, 0, 0, 0.5, 0.4};
Physical Volume("lower") = {1};
Physical Surface("ground") = {5}; Physical Surface("lower_top") = {6}; Physical Surface("lower_sides") = {1, 2, 3, 4};
Physical Surface("upper_bottom") = {9}; Physical Surface("pressed") = {8}; Physical Surface("upper_side") = {7};
MeshSize{:} = 0.5;
""",
    "plane": """Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};
Point(5) = {0, 1, 0}; Point(6) = {1, 1, 0}; Point(7) = {1, 2, 0}; Point(8) = {0, 2, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1}; Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
Transfinite Curve{:} = 3; Transfinite Surface{1, 2}; Recombine Surface{2};
Physical Surface("lower") = {1}; Physical Surface("upper") = {2};
Physical Curve("ground") = {1}; Physical Curve("lower_top") = {3}; Physical Curve("upper_bottom") = {5}; Physical Curve("pressed") = {7};
""",
}
# As "tets", for formats that keep no names; solids and their faces are then numbered.
PLAIN = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 0.5}; Box(2) = {0.2, 0.2, 0.5, 0.5, 0.5, 0.5};
MeshSize{:} = 0.5;
"""
NAMED = """mesh: {file: FILE}
materials: {steel: {young_modulus: 1000, poisson_ratio: 0.3}}
bodies: {lower: {material: steel}, upper: {material: steel}}
supports: [{boundary: ground, displacement: {x: 0, y: 0, z: 0}}]
loads: [{boundary: pressed, pressure: 1}]
contacts: [{secondary: upper_bottom, primary: lower_top, friction: {coulomb: 0.3}}]
"""
SKIN = NAMED.replace("upper: {material: steel}", "upper: {material: steel, method: boundary_elements, surfaces: [upper_bottom, pressed, upper_side]}")
SKINS = SKIN.replace("lower: {material: steel}", "lower: {material: steel, method: boundary_elements, surfaces: [ground, lower_top, lower_sides]}")
NUMBERED = """mesh: {file: FILE, size: {max: 0.5}}
materials: {steel: {young_modulus: 1000, poisson_ratio: 0.3}}
bodies: {solid.1: {material: steel}, solid.2: {material: steel}}
supports: [{boundary: solid.1.face.5, displacement: {x: 0, y: 0, z: 0}}]
loads: [{boundary: solid.2.face.6, pressure: 1}]
contacts: auto
"""
HEXES = [0, 1, 3, 2, 4, 5, 7, 6]  # of two a side, corners in order x, y, z


class Gmsh:
    """The few calls of libgmsh that are needed; Debian's Python module is a package of its own."""

    def __init__(self):
        self.library = ctypes.CDLL(ctypes.util.find_library("gmsh") or "libgmsh.so")
        self.call("gmshInitialize", 0, None, 0)
        self.option("General.Verbosity", 1)

    def call(self, name, *arguments):
        error = ctypes.c_int(0)
        getattr(self.library, name)(*arguments, ctypes.byref(error))
        if error.value:
            raise RuntimeError(f"{name} failed: {error.value}")

    def option(self, name, value):
        self.call("gmshOptionSetNumber", name.encode(), ctypes.c_double(value))

    def open(self, path):
        self.call("gmshClear")
        self.call("gmshOpen", str(path).encode())

    def mesh(self, dimension, order):
        self.option("Mesh.ElementOrder", order)
        self.call("gmshModelMeshGenerate", dimension)

    def write(self, path):
        self.call("gmshWrite", str(path).encode())


def abaqus(order):
    """Two stacked bricks of 2 x 2 x 1 cells, as Abaqus writes them."""
    lines, node, cell = ["*HEADING", "two bricks", "*NODE"], {}, []
    steps = 2 * order
    for part, z in enumerate((0, 1)):
        for k in range(order + 1):
            for j in range(steps + 1):
                for i in range(steps + 1):
                    if order == 2 and (i % 2) + (j % 2) + (k % 2) > 1:
                        continue
                    node[part, i, j, k] = len(node) + 1
                    lines.append(f"{len(node)}, {i / steps}, {j / steps}, {z + k / order}")
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    amid = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
    for part, name in enumerate(("lower", "upper")):
        lines.append(f"*ELEMENT, TYPE={'C3D8' if order == 1 else 'C3D20'}, ELSET={name}")
        for j in range(2):
            for i in range(2):
                at = [(order * (i + a), order * (j + b), order * c) for a, b, c in corners]
                if order == 2:
                    at += [tuple((at[p][d] + at[q][d]) // 2 for d in range(3)) for p, q in amid]
                cell.append(part)
                lines.append(f"{len(cell)}, " + ", ".join(str(node[(part, *x)]) for x in at))
    for name, part, face in (("ground", 0, "S1"), ("lower_top", 0, "S2"), ("upper_bottom", 1, "S1"), ("pressed", 1, "S2")):
        lines.append(f"*SURFACE, NAME={name}, TYPE=ELEMENT")
        lines += [f"{c + 1}, {face}" for c, p in enumerate(cell) if p == part]
    lines += ["*MATERIAL, NAME=steel", "*ELASTIC", "1000, 0.3"]
    lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL=steel" for name in ("lower", "upper")]
    return "\n".join(lines) + "\n"


@contextlib.contextmanager
def silence():
    """OpenCASCADE reports on the terminal whatever one asks of it."""
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


def seeds(directory):
    """Writes valid meshes: {name: (bytes, ending, deck)}."""
    directory = pathlib.Path(directory)
    result, gmsh = {}, Gmsh()
    plane = NAMED.replace("z: 0", "").replace("y: 0, ", "y: 0") + "dimension: plane_strain\n"
    for name, text in GEO.items():
        deck = {"plane": plane, "skin": SKIN}.get(name, NAMED)
        geometry = directory / f"{name}.geo"
        geometry.write_text(text)
        result[f"{name}.geo"] = (text.encode(), ".geo", deck)
        for order in (1, 2):
            gmsh.open(geometry)
            gmsh.mesh(2 if name == "plane" else 3, order)
            for version in (2.2, 4.1):
                for binary in (0, 1):
                    gmsh.option("Mesh.MshFileVersion", version)
                    gmsh.option("Mesh.Binary", binary)
                    path = directory / f"{name}_o{order}_v{version}_b{binary}.msh"
                    gmsh.write(path)
                    result[path.name] = (path.read_bytes(), ".msh", deck)
        if name == "skin":
            gmsh.open(geometry)
            gmsh.mesh(2, 1)
            gmsh.option("Mesh.StlOneSolidPerSurface", 2)
            for binary in (0, 1):
                gmsh.option("Mesh.Binary", binary)
                path = directory / f"{name}_b{binary}.stl"
                gmsh.write(path)
                result[path.name] = (path.read_bytes(), ".stl", SKINS)
    (directory / "plain.geo").write_text(PLAIN)
    for ending in (".step", ".brep"):
        gmsh.open(directory / "plain.geo")
        path = directory / f"plain{ending}"
        with silence():
            gmsh.write(path)
        result[path.name] = (path.read_bytes(), ending, NUMBERED)
    for order in (1, 2):
        result[f"abaqus_o{order}.inp"] = (abaqus(order).encode(), ".inp", NAMED)
    return result


NUMBER = re.compile(rb"(?<![\w.])[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?(?![\w.])")
WORDS = [b"0", b"-1", b"1", b"2", b"3", b"4", b"5", b"7", b"100", b"1000000", b"2147483647", b"2147483648", b"-2147483648", b"4294967295", b"9223372036854775807",
         b"99999999999999999999", b"0.5", b"nan", b"inf", b"-inf", b"1e308", b"-1e308", b"1e400", b"1e-320", b"1e155", b"1e30", b"1e-30", b"", b"x", b"0x10", b"1,5", b"1 2"]
PACKED = [struct.pack("<i", v) for v in (0, -1, 1, 2, 2**31 - 1, -2**31, 1000000, 17, 92)] + [struct.pack("<q", v) for v in (0, -1, 2**31, 2**62, 2**63 - 1)]
PACKED += [struct.pack("<d", v) for v in (float("nan"), float("inf"), 1e308, 1e-320, -1.0, 0.0)]


def sections(lines):
    """Where parts of a file begin: $Section of .msh, *CARD of .inp, numbered entities of .step, solids and facets of .stl."""
    return [i for i, line in enumerate(lines) if re.match(rb"\$(?!End)|\*(?!\*)|#\d+|Physical|Transfinite|Point|Line|Curve|Surface|Box", line)]


def mutate(random, data, others):
    """One change of a file's bytes. others: more files of its kind, to take pieces from."""
    if not data:
        return data
    place = random.randrange(len(data))
    kind = random.choice(["number"] * 6 + ["two numbers"] * 2 + ["line"] * 4 + ["section"] * 4 + ["flip", "delete", "insert", "truncate", "twice", "splice", "packed", "packed", "word"])
    if kind in ("number", "two numbers"):
        found = list(NUMBER.finditer(data)) if b"\0" not in data else list(NUMBER.finditer(data[:400]))
        if not found:
            return data
        one = random.choice(found)
        if kind == "two numbers":
            other = random.choice(found)
            return data[:one.start()] + other[0] + data[one.end():]
        whole = float(one[0]) if math.isfinite(float(one[0])) else 0  # 1e999 is a number, too
        value = random.choice(WORDS + [b"-" + one[0], one[0] + b"0", one[0] + b"1", str(int(whole) + random.choice([-1, 1])).encode()])
        return data[:one.start()] + value + data[one.end():]
    if kind in ("line", "section"):
        lines = data.split(b"\n")
        at, count = random.randrange(len(lines)), 1
        if kind == "section":
            starts = sections(lines)
            if not starts:
                return data
            at = random.choice(starts)
            count = next((s for s in starts if s > at), len(lines)) - at
        part = lines[at:at + count]
        what = random.choice(["delete", "twice", "move", "half", "rename"])
        if what == "twice":
            lines[at:at] = part
        elif what == "half":
            lines[at + count // 2:at + count] = []
        elif what == "rename":
            lines[at] = lines[at][:3] + random.choice([b"X", b"", b"s"]) + lines[at][3:]
        else:
            lines[at:at + count] = []
            if what == "move":
                to = random.randint(0, len(lines))
                lines[to:to] = part
        return b"\n".join(lines)
    if kind == "flip":
        return data[:place] + bytes([data[place] ^ (1 << random.randrange(8))]) + data[place + 1:]
    if kind == "delete":
        return data[:place] + data[place + random.choice([1, 2, 4, 8, 100]):]
    if kind == "insert":
        return data[:place] + random.choice([b"\0", b" ", b"\n", b"\xff", b"$", b"*", b"0", b"\0" * 100, b"9" * 100, b"(" * 100]) + data[place:]
    if kind == "truncate":
        return data[:place]
    if kind == "twice":
        return data[:place] + data[max(0, place - random.choice([1, 10, 100, 1000])):]
    if kind == "splice":
        other = random.choice(others)
        start = random.randrange(len(other))
        return data[:place] + other[start:start + random.choice([10, 100, 1000])] + data[place:]
    if kind == "packed":
        value = random.choice(PACKED)
        return data[:place] + value + data[place + len(value):]
    words = re.findall(rb"[A-Za-z_]{2,}", data)
    return data.replace(random.choice(words), random.choice(words), 1) if words else data


def mutant(random, seeds):
    """(name of the seed, bytes, ending, deck, whether it is as it was)."""
    name = random.choice(sorted(seeds))
    data, ending, deck = seeds[name]
    if random.random() < 0.02:
        return name, data, ending, deck, True
    others = [d for d, e, _ in seeds.values() if e == ending]
    for _ in range(1 + int(random.expovariate(0.9))):
        data = mutate(random, data, others)
    return name, data, ending, deck, False
