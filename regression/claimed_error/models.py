"""A population of random contact models, small ones: each a deck as a dictionary, with the geometry that it needs beside it."""

import math

FAMILIES = ("blocks", "plates", "layer", "stack", "punch", "blocks_2d", "cylinder", "pin", "belt", "sphere")


def cells(random, low, high):
    return random.randint(low, high)


def steel(random, spread=1.0):
    return {"young_modulus": 10 ** random.uniform(3, 3 + spread), "poisson_ratio": round(random.uniform(0, 0.35), 2)}


def friction(random):
    return {"friction": {"coulomb": round(random.uniform(0.1, 0.5), 2)}} if random.random() < 0.4 else {}


def column(random, sizes, heights, counts, element, spread=1.0):
    """Blocks on each other, the lowest one held below, all held at xmin and ymin against sliding, pressed from above."""
    deck = {"dimension": 3, "mesh": {"blocks": {}}, "materials": {}, "bodies": {}, "supports": [], "loads": [], "contacts": []}
    z, names = 0.0, []
    for i, height in enumerate(heights):
        name = f"b{i}"
        deck["mesh"]["blocks"][name] = {"origin": [0, 0, z], "size": [*sizes[i], height], "cells": counts[i], "element": element}
        deck["materials"][name] = steel(random, spread)
        deck["bodies"][name] = {"material": name}
        deck["supports"] += [{"boundary": f"{name}.xmin", "displacement": {"x": 0}}, {"boundary": f"{name}.ymin", "displacement": {"y": 0}}]
        if names:
            deck["contacts"].append({"name": f"c{i}", "secondary": f"{name}.zmin", "primary": f"{names[-1]}.zmax", **friction(random)})
        names.append(name)
        z += height
    deck["supports"].append({"boundary": "b0.zmin", "displacement": {"z": 0}})
    deck["loads"].append({"boundary": f"{names[-1]}.zmax", "pressure": random.uniform(1, 10)})
    return deck


def solid(random):
    return random.choice(["hex8", "hex8", "hex20"])


def blocks(random):
    size = [[random.uniform(0.5, 2), random.uniform(0.5, 2)] for _ in range(2)]
    deck = column(random, size, [random.uniform(0.5, 2) for _ in range(2)], [[cells(random, 2, 6) for _ in range(3)] for _ in range(2)], solid(random))
    if random.random() < 0.5:  # bent and pulled aside
        deck["loads"].append({"boundary": "b1.xmax", "traction": [random.uniform(0, 1), 0, -random.uniform(0, 2)]})
    return deck


def plates(random):
    side, thickness = random.choice([30, 100, 300, 1000]), 1
    counts = [[cells(random, 2, 6), cells(random, 2, 6), cells(random, 1, 2)] for _ in range(2)]
    return column(random, [[side, side]] * 2, [thickness] * 2, counts, "hex8")


def layer(random):
    thin = 10 ** random.uniform(-3, -1)
    order = [thin, 1] if random.random() < 0.5 else [1, thin]
    deck = column(random, [[1, 1]] * 2, order, [[cells(random, 2, 4) for _ in range(3)] for _ in range(2)], solid(random))
    if random.random() < 0.5:
        deck["loads"].append({"boundary": "b1.xmax", "traction": [0, 0, -random.uniform(0, 2)]})
    return deck


def stack(random):
    count = random.randint(3, 5)
    heights = [10 ** random.uniform(-2, 0) for _ in range(count)]
    counts = [[cells(random, 1, 4), cells(random, 1, 4), cells(random, 1, 2)] for _ in range(count)]
    return column(random, [[1, 1]] * count, heights, counts, "hex8", 2.0)


def punch(random):
    small = random.uniform(0.3, 0.7)
    return column(random, [[2, 2], [small, small]], [1, random.uniform(0.3, 1)],
                  [[cells(random, 4, 8), cells(random, 4, 8), cells(random, 2, 4)], [cells(random, 2, 4), cells(random, 2, 4), cells(random, 1, 3)]], "hex8")


def blocks_2d(random):
    deck = column(random, [[random.uniform(0.5, 3), 1]] * 2, [random.uniform(0.02, 1) for _ in range(2)],
                  [[cells(random, 4, 24), 1, cells(random, 2, 8)] for _ in range(2)], random.choice(["quad4", "quad8"]))
    deck["dimension"] = "plane_strain"
    for block in deck["mesh"]["blocks"].values():
        for key in ("origin", "size", "cells"):
            block[key] = [block[key][0], block[key][2]]
    deck["supports"] = [s for s in deck["supports"] if "ymin" not in s["boundary"]]
    for entry in [*deck["supports"], *deck["loads"]]:
        entry["boundary"] = entry["boundary"].replace("zmin", "ymin").replace("zmax", "ymax")
        if "displacement" in entry and "z" in entry["displacement"]:
            entry["displacement"] = {"y": 0}
    for contact in deck["contacts"]:
        contact["secondary"] = contact["secondary"].replace("zmin", "ymin")
        contact["primary"] = contact["primary"].replace("zmax", "ymax")
    if random.random() < 0.5:
        deck["loads"].append({"boundary": "b1.xmax", "traction": [0, -random.uniform(0, 2)]})
    return deck


def cylinder(random, inputs):
    """Hertz's line contact, graded, pressed by a force, or by a platen that shears it as well."""
    sheared = random.random() < 0.5
    name = "cattaneo_mindlin" if sheared else "hertz_cylinder"
    deck = {"dimension": "plane_strain", "mesh": {"file": str(inputs / "hertz_cylinder" / f"{name}.geo"),
                                                   "constants": {"h": random.choice([0.2, 0.4] if sheared else [0.4, 0.8, 1.6]), "order": random.choice([1, 2])}},
            "materials": {"m": {"young_modulus": 210e3, "poisson_ratio": 0.3}}, "bodies": {"cylinder": {"material": "m"}, "block": {"material": "m"}},
            "contacts": [{"name": "c1", "secondary": "cylinder_surface", "primary": "block_top"}]}
    if sheared:
        deck["contacts"][0]["friction"] = {"coulomb": 0.3}
        deck["supports"] = [{"boundary": "block_bottom", "displacement": {"x": 0, "y": 0}},
                            {"boundary": "cylinder_top", "displacement": {"x": random.uniform(0, 0.02), "y": -random.uniform(0.02, 0.1)}}]
    else:
        deck["supports"] = [{"boundary": "symmetry", "displacement": {"x": 0}}, {"boundary": "block_bottom", "displacement": {"y": 0}}]
        deck["loads"] = [{"boundary": "cylinder_top", "force": [0, -10 ** random.uniform(3, 4.3)]}]
    return deck


PIN = """h = {h}; R = 10; c = {c}; W = {W};
SetFactory("OpenCASCADE");
Disk(1) = {{0, -c, 0, R - c}};
Rectangle(2) = {{-W, -W, 0, 2 * W, 2 * W}}; Disk(3) = {{0, 0, 0, R}};
BooleanDifference(4) = {{ Surface{{2}}; Delete; }}{{ Surface{{3}}; Delete; }};
bore() = Boundary{{ Surface{{4}}; }}; rim() = Boundary{{ Surface{{1}}; }};
base() = Curve In BoundingBox {{-W - 1, -W - 0.01, -1, W + 1, -W + 0.01, 1}};
hole[] = bore[]; hole[] -= Curve In BoundingBox {{-W - 1, -W - 0.01, -1, W + 1, -W + 0.01, 1}};
hole[] -= Curve In BoundingBox {{-W - 1, W - 0.01, -1, W + 1, W + 0.01, 1}};
hole[] -= Curve In BoundingBox {{-W - 0.01, -W - 1, -1, -W + 0.01, W + 1, 1}};
hole[] -= Curve In BoundingBox {{W - 0.01, -W - 1, -1, W + 0.01, W + 1, 1}};
Mesh.MeshSizeMax = h; Mesh.MeshSizeMin = h; Mesh.ElementOrder = {order};
Physical Surface("pin") = {{1}}; Physical Surface("plate") = {{4}};
Physical Curve("rim") = {{rim[]}}; Physical Curve("bore") = {{hole[]}}; Physical Curve("base") = {{base[]}};
"""


def pin(random):
    """A pin in a bore with some clearance, pulled down by its weight."""
    text = PIN.format(h=random.choice([1.5, 2.5]), c=10 ** random.uniform(-3, -1), W=random.uniform(15, 25), order=random.choice([1, 2]))
    return {"dimension": "plane_strain", "mesh": {"file": "pin.geo"}, "geometry": ("pin.geo", text),
            "materials": {"m": {"young_modulus": 210e3, "poisson_ratio": 0.3}}, "bodies": {"pin": {"material": "m"}, "plate": {"material": "m"}},
            "supports": [{"boundary": "base", "displacement": {"x": 0, "y": 0}}], "loads": [{"boundary": "rim", "force": [0, -10 ** random.uniform(2, 4)]}],
            "contacts": [{"name": "c1", "secondary": "rim", "primary": "bore", "friction": {"coulomb": 0.2}}]}


BELT = """R = 100; t = {t}; n = {n}; a = {angle} * Pi / 180;
Point(1) = {{0, 0, 0}}; Point(2) = {{R, 0, 0}}; Point(3) = {{R + t, 0, 0}};
Point(4) = {{R * Cos(a), R * Sin(a), 0}}; Point(5) = {{(R + t) * Cos(a), (R + t) * Sin(a), 0}};
Line(1) = {{2, 3}}; Circle(2) = {{3, 1, 5}}; Line(3) = {{5, 4}}; Circle(4) = {{4, 1, 2}};
Curve Loop(1) = {{1, 2, 3, 4}}; Plane Surface(1) = {{1}};
Transfinite Curve {{1, 3}} = 3; Transfinite Curve {{2, 4}} = n + 1; Transfinite Surface {{1}}; Recombine Surface {{1}};
Mesh.ElementOrder = 1;
Physical Surface("belt") = {{1}}; Physical Curve("inner") = {{4}}; Physical Curve("first") = {{1}}; Physical Curve("last") = {{3}};
"""


def belt(random):
    """A belt on a rigid drum, held at one end and pulled at the other with less than the limit."""
    angle, mu = random.choice([60, 90, 120]), random.choice([0.1, 0.2, 0.3])
    text = BELT.format(t=random.choice([2, 5]), n=random.choice([20, 40]), angle=angle)
    end = math.radians(angle)
    pull = random.uniform(0.5, 2)
    return {"dimension": "plane_strain", "mesh": {"file": "belt.geo"}, "geometry": ("belt.geo", text),
            "materials": {"m": {"young_modulus": 1000, "poisson_ratio": 0.0}}, "bodies": {"belt": {"material": "m", "formulation": "incompatible"}},
            "supports": [{"boundary": "first", "displacement": {"x": 0, "y": 0}}],
            "loads": [{"boundary": "last", "force": [-pull * math.sin(end), pull * math.cos(end)]}],
            "contacts": [{"name": "c1", "secondary": "inner", "primary": {"cylinder": {"point": [0, 0], "radius": 100.0}}, "friction": {"coulomb": mu}}]}


def sphere(random, inputs):
    return {"dimension": 3, "mesh": {"file": str(inputs / "hertz_sphere" / "hertz_sphere.geo"), "constants": {"h": random.choice([0.2, 0.3, 0.4]), "order": random.choice([1, 1, 2])}},
            "materials": {"m": {"young_modulus": 210e3, "poisson_ratio": 0.3}}, "bodies": {"sphere": {"material": "m"}, "block": {"material": "m"}},
            "supports": [{"boundary": "symmetry_x", "displacement": {"x": 0}}, {"boundary": "symmetry_y", "displacement": {"y": 0}}, {"boundary": "block_bottom", "displacement": {"z": 0}}],
            "loads": [{"boundary": "sphere_top", "force": [0, 0, -10 ** random.uniform(2, 3.3)]}],
            "contacts": [{"name": "c1", "secondary": "sphere_surface", "primary": "block_top", **friction(random)}]}


def model(family, random, inputs):
    make = globals()[family]
    deck = make(random, inputs) if family in ("cylinder", "sphere") else make(random)
    deck["decomposition"] = {"unknowns_per_subdomain": random.choice([40, 150, 500, 2000])}
    deck["output"] = {"fields": ["displacement", "von_mises", "stress"]}
    return deck
