"""Random models whose answers are compared: blocks, and what blocks lack. A model is a deck (a dict), with the meshes that it needs as
texts beside it: (deck, {file name: text})."""


def material(random):
    return {"young_modulus": random.choice([1.0, 1000.0, 2.1e5]), "poisson_ratio": random.choice([0.0, 0.3, 0.4]), "density": 1.0, "thermal_expansion": 1e-5}


def law(random, laws):
    found = random.choice(laws)
    return {"friction": dict(found)} if found else {}  # of its own: relations scale each contact for itself


def blocks(random):
    """A pile of blocks with meshes that do not match, held below and pressed from above, perhaps pushed; 3D or a plane."""
    plane = random.random() < 0.3
    top, bottom, axes = ("ymax", "ymin", "xy") if plane else ("zmax", "zmin", "xyz")
    elements = ["quad4", "tri3", "quad8", "tri6"] if plane else ["hex8", "tet4", "prism6", "hex20", "tet10"]
    names = ["a", "b", "c"][:random.randint(1, 3)]
    size = [random.uniform(0.8, 1.5) for _ in axes[1:]]
    origin, level, made = [0.0 for _ in axes[1:]], 0.0, {}
    for name in names:
        height = random.uniform(0.4, 0.8)
        made[name] = {"origin": origin + [level], "size": size + [height], "cells": [random.randint(2, 4) for _ in axes], "element": random.choice(elements)}
        level += height
        if random.random() < 0.5:
            origin = [o + 0.15 * s for o, s in zip(origin, size)]
            size = [0.7 * s for s in size]
    steel = material(random)
    pressure = 0.01 * steel["young_modulus"]
    deck = {"dimension": random.choice(["plane_strain", "plane_stress"]) if plane else 3, "mesh": {"blocks": made}, "materials": {"steel": steel},
            "bodies": {name: {"material": "steel"} for name in names},
            "supports": [{"boundary": f"{names[0]}.{bottom}", "displacement": {c: 0.0 for c in axes}}],
            "loads": [{"name": "press", "boundary": f"{names[-1]}.{top}", "pressure": pressure}], "contacts": []}
    sideways = [0.05 * pressure] + [0.0] * (len(axes) - 1)
    laws = [{"coulomb": 0.3}, {"bonded": True}, {"tresca": 0.2 * pressure}]
    for below, above in zip(names, names[1:]):
        deck["contacts"].append({"secondary": f"{above}.{bottom}", "primary": f"{below}.{top}", **law(random, laws)})
    if all("friction" in c and "tresca" not in c["friction"] for c in deck["contacts"]):
        deck["loads"].append({"name": "push", "boundary": f"{names[-1]}.{top}", "traction": sideways})
    if random.random() < 0.3:
        deck["loads"].append({"name": "weight", "body": names[0], "acceleration": [0.0] * (len(axes) - 1) + [-0.1 * pressure]})
    if random.random() < 0.2 and len(names) == 1:
        deck["loads"].append({"name": "warm", "body": names[0], "temperature_change": 10.0})
    return deck, {}


# Quarters of rings, one in the other, whose meshes do not match. The gap keeps gmsh from making one arc of two.
RINGS = """SetFactory("Built-in");
DefineConstant[ order = 1 ];
radius[] = {1, 1.5, 1.501, 2.2}; along[] = {ALONG}; across[] = {2, 2}; layers[] = {LAYERS};
body[] = {}; inner[] = {}; outer[] = {}; ends[] = {}; low[] = {}; high[] = {};
For b In {0:1}
  p = newp; r = radius[2 * b]; s = radius[2 * b + 1];
  Point(p) = {0, 0, 0}; Point(p + 1) = {r, 0, 0}; Point(p + 2) = {s, 0, 0}; Point(p + 3) = {0, s, 0}; Point(p + 4) = {0, r, 0};
  l = newl; Line(l) = {p + 1, p + 2}; Circle(l + 1) = {p + 2, p, p + 3}; Line(l + 2) = {p + 3, p + 4}; Circle(l + 3) = {p + 4, p, p + 1};
  c = newll; Curve Loop(c) = {l, l + 1, l + 2, l + 3}; f = news; Plane Surface(f) = {c};
  Transfinite Curve{l, l + 2} = across[b] + 1; Transfinite Curve{l + 1, l + 3} = along[b] + 1; Transfinite Surface{f}; RECOMBINE
  out[] = Extrude {0, 0, HEIGHT} { Surface{f}; Layers{layers[b]}; RECOMBINE };
  body[] += out[1]; low[] += f; high[] += out[0]; ends[] += out[2]; outer[] += out[3]; ends[] += out[4]; inner[] += out[5];
EndFor
Physical Volume("tube") = {body[0]}; Physical Volume("ring") = {body[1]};
Physical Surface("bore") = {inner[0]}; Physical Surface("tube_outer") = {outer[0]}; Physical Surface("ring_inner") = {inner[1]};
Physical Surface("mantle") = {outer[1]}; Physical Surface("cut_x") = {ends[0], ends[2]}; Physical Surface("cut_y") = {ends[1], ends[3]};
Physical Surface("low") = {low[]};
"""


def rings(random):
    """A ring shrunk on a tube, a quarter of both: curved surfaces, cells that do not match, planes of symmetry, interference."""
    text = RINGS.replace("ALONG", f"{random.randint(4, 6)}, {random.randint(5, 8)}").replace("LAYERS", f"{random.randint(1, 2)}, {random.randint(1, 3)}")
    text = text.replace("HEIGHT", "0.5").replace("RECOMBINE", random.choice(["Recombine Surface{f};", "Recombine Surface{f};", ""]), 1)
    text = text.replace("RECOMBINE", "Recombine;" if "Recombine Surface" in text else "")
    deck = {"dimension": 3, "mesh": {"file": "rings.geo", "order": random.choice([1, 2])}, "materials": {"steel": material(random)},
            "bodies": {"tube": {"material": "steel"}, "ring": {"material": "steel"}},
            "supports": [{"boundary": name, "displacement": {"normal": 0.0}} for name in ("cut_x", "cut_y", "low")],
            "loads": [{"name": "press", "boundary": "bore", "pressure": 0.001 * 1.0}],
            "contacts": [{"secondary": "ring_inner", "primary": "tube_outer", "interference": 0.003, **law(random, [None, {"coulomb": 0.2}])}]}
    deck["loads"][0]["pressure"] *= deck["materials"]["steel"]["young_modulus"]
    return deck, {"rings.geo": text}


def bolt(random):
    """Two plates between a bolt's head and its foot, all of blocks, with a cut through the shank that is tightened."""
    cells = lambda: random.randint(2, 3)
    made = {"foot": {"origin": [0.0, 0.0, 0.0], "size": [1.0, 1.0, 0.5], "cells": [cells(), cells(), 2]},
            "shank": {"origin": [0.0, 0.0, 0.5], "size": [1.0, 1.0, 0.8], "cells": [cells(), cells(), cells()]}}
    for block in made.values():
        block["element"] = random.choice(["hex8", "hex20", "tet10"])
    steel = material(random)
    deck = {"dimension": 3, "mesh": {"blocks": made}, "materials": {"steel": steel}, "bodies": {name: {"material": "steel"} for name in made},
            "supports": [{"boundary": "foot.zmin", "displacement": {"x": 0.0, "y": 0.0, "z": 0.0}},
                         {"boundary": "shank.zmax", "displacement": {"x": 0.0, "y": 0.0, "z": 0.0}}], "loads": [],
            "contacts": [{"name": "cut", "secondary": "shank.zmin", "primary": "foot.zmax", "friction": {"bonded": True},
                          "preload": random.choice([{"force": 0.01 * steel["young_modulus"]}, {"shortening": 0.01}])}]}
    return deck, {}


# A sector of a thick ring in two pieces, one round the other.
SECTOR = """SetFactory("Built-in");
radius[] = {1, 1.4, 2}; turn = ANGLE * Pi / 180; body[] = {}; start[] = {}; end[] = {}; inner[] = {}; outer[] = {}; low[] = {};
For b In {0:1}
  p = newp; r = radius[b]; s = radius[b + 1];
  Point(p) = {r, 0, 0.001 * b}; Point(p + 1) = {s, 0, 0.001 * b}; l = newl; Line(l) = {p, p + 1};
  Transfinite Curve{l} = 3;
  out[] = Extrude {0, 0, 0.5} { Curve{l}; Layers{CELLS + b}; Recombine; };
  sector[] = Extrude { {0, 0, 1}, {0, 0, 0}, turn } { Surface{out[1]}; Layers{ROUND + b}; Recombine; };
  body[] += sector[1]; start[] += out[1]; end[] += sector[0]; low[] += sector[2]; outer[] += sector[3]; inner[] += sector[5];
EndFor
Physical Volume("hub") = {body[0]}; Physical Volume("rim") = {body[1]};
Physical Surface("start_hub") = {start[0]}; Physical Surface("end_hub") = {end[0]}; Physical Surface("start_rim") = {start[1]}; Physical Surface("end_rim") = {end[1]};
Physical Surface("bore") = {inner[0]}; Physical Surface("hub_outer") = {outer[0]}; Physical Surface("rim_inner") = {inner[1]}; Physical Surface("mantle") = {outer[1]};
"""


def sector(random):
    """One of n sectors of a rim that is shrunk on a hub; the hub is held at its bore, the rim carries traction along the axis."""
    parts = random.randint(6, 12)
    text = SECTOR.replace("ANGLE", f"360 / {parts}").replace("CELLS", "2").replace("ROUND", str(random.randint(2, 3)))
    steel = material(random)
    tie = {"friction": {"bonded": True}, "cyclic": {"axis": [0.0, 0.0, 1.0], "angle": f"360/{parts}"}}
    deck = {"dimension": 3, "mesh": {"file": "sector.geo", "order": random.choice([1, 2])}, "materials": {"steel": steel},
            "bodies": {"hub": {"material": "steel"}, "rim": {"material": "steel"}},
            "supports": [{"boundary": "bore", "displacement": {"x": 0.0, "y": 0.0, "z": 0.0}}],
            "loads": [{"name": "pull", "boundary": "mantle", "traction": [0.0, 0.0, 0.00002 * steel["young_modulus"]]}],
            "contacts": [{"secondary": f"end_{name}", "primary": f"start_{name}", **tie} for name in ("hub", "rim")]
            + [{"secondary": "rim_inner", "primary": "hub_outer", "interference": 0.002, "friction": {"coulomb": 0.3}}]}
    return deck, {"sector.geo": text}


MODELS = {"blocks": blocks, "rings": rings, "bolt": bolt, "sector": sector}
