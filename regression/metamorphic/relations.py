"""Changes of a model that must not change its answers, or change them in a known way: each returns (deck, {quantity: factor}, ranks). What a
change lets be different stands in APART."""
import copy

import numpy as np

UNITS = {"energy": 1e-3, "length": 1e-3, "stress": 1e6, "force": 1.0}  # from mm, N, MPa to m, N, Pa
SAME = {"energy": 1.0, "length": 1.0, "stress": 1.0, "force": 1.0}
ANGLE, AXIS = 37.0, [1.0, 2.0, 3.0]


def plane(deck):
    return deck["dimension"] != 3


def ranks2(random, deck):
    return deck, SAME, 2


def ranks3(random, deck):
    return deck, SAME, 3


def subdomains(random, deck):
    deck["decomposition"] = {"subdomains": random.randint(len(deck["bodies"]), 12)}
    return deck, SAME, 1


def small_subdomains(random, deck):
    deck["decomposition"] = {"unknowns_per_subdomain": random.choice([30, 60, 120])}
    return deck, SAME, random.choice([1, 2])


def clusters(random, deck):
    deck["decomposition"] = {"unknowns_per_subdomain": 60, "subdomains_per_cluster": random.choice([2, 4])}
    return deck, SAME, random.choice([1, 3])


def grid(random, deck):
    made = deck["mesh"].get("blocks")
    if not made:
        return None
    deck["decomposition"] = {"method": "grid", "counts": {name: [random.randint(1, n) for n in block["cells"]] for name, block in made.items()}}
    return deck, SAME, random.choice([1, 2])


def smalse(random, deck):
    deck["solver"]["algorithm"] = "smalse"
    return deck, SAME, 1


def direct(random, deck):
    """The dual operator as a matrix; `auto` solves these small models by products."""
    deck["solver"]["algorithm"] = "direct"
    return deck, SAME, random.choice([1, 2])


def face_newton(random, deck):
    deck["solver"]["algorithm"] = "face_newton"
    return deck, SAME, 1


def preconditioner(random, deck):
    deck["solver"]["preconditioner"] = random.choice(["none", "dirichlet"])
    return deck, SAME, 1


def order_of_bodies(random, deck):
    """Bodies are numbered by their names; entries of lists stand as they like."""
    made = deck["mesh"].get("blocks")
    if made:
        new = dict(zip(made, random.sample(["u", "v", "w", "m", "z", "k"], len(made))))
        change = lambda name: f"{new[name.split('.')[0]]}.{name.split('.')[1]}" if "." in name else new.get(name, name)
        deck["mesh"]["blocks"] = {new[name]: block for name, block in made.items()}
        deck["bodies"] = {new[name]: body for name, body in deck["bodies"].items()}
        for entry in deck["supports"] + deck["loads"] + deck["contacts"]:
            for key in ("boundary", "body", "secondary", "primary"):
                if key in entry:
                    entry[key] = change(entry[key])
    for section in ("supports", "loads"):
        random.shuffle(deck[section])
    return deck, SAME, 1


def order_of_contacts(random, deck):
    if len(deck["contacts"]) < 2:
        return None
    deck["contacts"].reverse()
    return deck, SAME, random.choice([1, 2])


def exchanged(random, deck):
    """The other side carries the multipliers, a turn to the next sector goes the other way: another discretization."""
    for contact in deck["contacts"]:
        contact["secondary"], contact["primary"] = contact["primary"], contact["secondary"]
        if "cyclic" in contact:
            contact["cyclic"] = {**contact["cyclic"], "axis": [-x for x in contact["cyclic"]["axis"]]}
    return (deck, SAME, 1) if deck["contacts"] else None


def units(random, deck):
    """Lengths in metres, stresses in pascals."""
    length, stress = UNITS["length"], UNITS["stress"]
    deck["mesh"]["scale"] = deck["mesh"].get("scale", 1.0) * length
    for steel in deck["materials"].values():
        steel["young_modulus"] *= stress
        steel["density"] *= stress / length  # the unit of accelerations stays
    for load in deck["loads"]:
        for key in ("pressure", "traction"):
            if key in load:
                load[key] = (np.array(load[key]) * stress).tolist()
    for contact in deck["contacts"]:
        if "interference" in contact:
            contact["interference"] *= length
        if "tresca" in contact.get("friction", {}):
            contact["friction"]["tresca"] *= stress
        if "shortening" in contact.get("preload", {}):
            contact["preload"]["shortening"] *= length
    return deck, {**UNITS, "energy": 1.0, "force": 1e3} if plane(deck) else UNITS, 1  # in planes a thickness


def rotation(deck):
    """The matrix of the turn: about the axis of 3D models, z of plane ones."""
    axis = np.array([0.0, 0.0, 1.0] if plane(deck) else AXIS)
    axis /= np.linalg.norm(axis)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    angle = np.radians(ANGLE)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross, axis


def turned(random, deck):
    """The whole model turned by an odd angle about an odd axis, each body as an instance of itself, and moved."""
    matrix, axis = rotation(deck)
    size = 2 if plane(deck) else 3
    center, shift = [0.3, -0.2, 0.7][:size], [5.0, -3.0, 2.0][:size]
    for body in deck["bodies"].values():
        body["instances"] = [{"rotate": {"axis": axis.tolist(), "angle": ANGLE, "center": center}, "translate": shift}]
    for load in deck["loads"]:
        for key in ("traction", "force", "acceleration"):
            if key in load:
                load[key] = (matrix[:size, :size] @ np.array(load[key])).tolist()
    for contact in deck["contacts"]:
        if "cyclic" in contact:
            about = np.array(center) + matrix @ (np.array([0.0, 0.0, 0.0]) - np.array(center)) + np.array(shift)
            contact["cyclic"] = {"axis": (matrix @ np.array(contact["cyclic"]["axis"])).tolist(), "angle": contact["cyclic"]["angle"], "center": about.tolist()}
    return deck, SAME, 1


RELATIONS = [ranks2, ranks3, subdomains, small_subdomains, clusters, grid, smalse, direct, face_newton, preconditioner, order_of_bodies,
             order_of_contacts, exchanged, units, turned]
# Relative, in place of the tolerances of all answers: these answers alone are compared.
APART = {exchanged: {"strain_energy": 1e-2}}


def change(relation, random, deck):
    """None where a relation is not for a model."""
    return relation(random, copy.deepcopy(deck))
