"""Decks: valid ones on small blocks, with what the program's schema offers, and mutations of them as trees and as text."""
import copy
import math

import yaml

SOLID = ["hex8", "tet4", "prism6", "hex20", "hex27", "tet10", "prism15", "prism18"]
PLANE = ["quad4", "tri3", "quad8", "quad9", "tri6"]
HOSTILE = [None, "", 0, -1, 1, 2, 0.5, -0.0, 1e-300, 1e-60, 1e-40, 1e40, 1e60, 1e300, 2**31 - 1, 2**31, -2**31, 2**63, 10**30, float("nan"),
           float("inf"), -float("inf"), "1e400", "-1e400", "0x7f", "1_000", "1,5", "true", True, False, "auto", "*", "**", "a", "x" * 300, "a.b", "a:b",
           ":", ".", "..", "../x", "/", "[", "{", "~", "null", "ä", "\u2028", "%s%n", "${HOME}", "`ls`", [], {}, [[]], [0, 0, 0], [1, 1], [1, 2, 3, 4],
           ["a"], {"x": 1}, {"a": {"b": {"c": 1}}}, [float("nan")] * 3, [1e200, 0, 0], [1e-200] * 3, "360/0", "360/1e-300", "1/3", "1/2/3", "2026-01-01"]
NOT_TO_GROW = {"cells", "count", "increments"}  # what makes a model large, not wrong: 1000 of them is a model that takes its time
LARGE = [0, -1, 1, 2, 3, 4, 5, 10**9, 2**31 - 1, 2**31, 10**30, 1.5, "many", float("nan")]


def number(random):
    return random.choice([1, 0.5, 2, random.uniform(0.1, 5), random.uniform(-2, 2)])


def block_sizes(random, plane, bodies):
    """A pile of blocks along the last axis, each narrower than or as wide as the one below."""
    axis = 1 if plane else 2
    size = [random.uniform(0.5, 2) for _ in range(axis)]
    origin, level, blocks = [0.0] * axis, random.choice([0.0, 0.0, 1.0]), []
    for _ in range(bodies):
        height = random.uniform(0.3, 1)
        blocks.append((origin + [level], size + [height]))
        level += height
        if random.random() < 0.5:
            origin = [o + 0.1 * s for o, s in zip(origin, size)]
            size = [0.7 * s for s in size]
    return blocks


def valid(random):
    """A deck that should read, and mostly solve."""
    plane = random.random() < 0.35
    kinematics = random.choice(["plane_strain", "plane_stress", "axisymmetric"]) if plane else 3
    names = random.sample(["a", "b", "lower", "upper", "part_1", "Deckel", "c.d"], random.randint(1, 3))
    blocks, elements = {}, random.sample(PLANE if plane else SOLID, 2)
    for name, (origin, size) in zip(names, block_sizes(random, plane, len(names))):
        if kinematics == "axisymmetric":
            origin[0] += random.choice([0, 1])
        most = 4 if plane else 3
        blocks[name] = {"origin": origin, "size": size, "cells": [random.randint(1, most) for _ in size], "element": random.choice(elements)}
    top, bottom = ("ymax", "ymin") if plane else ("zmax", "zmin")
    deck = {"title": "fuzz", "dimension": kinematics, "mesh": {"blocks": blocks},
            "materials": {"steel": {"young_modulus": random.choice([1, 1000, 2.1e5]), "poisson_ratio": random.choice([0, 0.3, 0.45]), "density": 1, "thermal_expansion": 1e-5}},
            "bodies": {name: {"material": "steel"} for name in names}}
    held = {"normal": 0} if random.random() < 0.2 and len(names) == 1 else {c: 0 for c in ("xy" if plane else "xyz")}
    deck["supports"] = [{"boundary": f"{names[0]}.{bottom}", "displacement": held}]
    if kinematics == "axisymmetric":
        deck["supports"][0]["displacement"] = {"x": 0, "y": 0}
    deck["loads"] = [{"boundary": f"{names[-1]}.{top}", "pressure": random.choice([1, 0.01])}]
    friction = [None, None, {"coulomb": 0.3}, {"tresca": 0.1}, {"bonded": True}, {"bonded": True}]
    if len(names) > 1:
        deck["contacts"] = []
        for below, above in zip(names, names[1:]):
            contact = {"secondary": f"{above}.{bottom}", "primary": f"{below}.{top}"}
            law = random.choice(friction)
            if law:
                contact["friction"] = law
            deck["contacts"].append(contact)
    spice(random, deck, plane, names, top, bottom)
    return deck


def spice(random, deck, plane, names, top, bottom):
    """Some of the keys that decks may have."""
    chance = lambda p: random.random() < p
    axisymmetric = deck["dimension"] == "axisymmetric"
    if chance(0.2):
        deck["loads"].append({"name": "push", "boundary": f"{names[-1]}.xmax", "traction": [0.001, 0] if plane else [0.001, 0, 0]})
    if chance(0.15):
        deck["loads"].append({"body": names[-1], "acceleration": [0, -1] if plane else [0, 0, -1]})
    if chance(0.15):
        deck["loads"].append({"body": random.choice(names), "temperature_change": 10})
    if chance(0.15) and deck.get("contacts"):
        deck["contacts"] = "auto" if chance(0.5) else [{"auto": True, "friction": {"coulomb": 0.2}}]
    if chance(0.15):
        face = {"point": [0, 0, 0], "normal": [0, 1, 0] if plane else [0, 0, 1]}
        contact = {"name": "floor", "secondary": f"{names[0]}.{bottom}", "primary": {"plane": face}}
        if isinstance(deck.setdefault("contacts", []), list):
            deck["contacts"].append(contact)
    if isinstance(deck.get("contacts"), list) and chance(0.15):
        for contact in deck["contacts"]:
            if contact.get("friction") == {"bonded": True} and "secondary" in contact:
                contact["preload"] = random.choice([{"force": 0.1}, {"shortening": 1e-3}])
    if chance(0.2):
        loads = {load.get("name", load.get("boundary", load.get("body"))): random.choice([0, 0.5, 1, -1]) for load in deck["loads"]}
        deck["steps"] = [{"name": "first"}, {"scale": loads, "increments": random.randint(1, 3)}]
        if chance(0.3):
            deck["steps"].append({"off": [random.choice(list(loads))]})
    if chance(0.2):
        deck["bodies"][names[-1]]["formulation"] = random.choice(["standard", "bbar", "incompatible"])
    if chance(0.15) and len(names) == 1:
        shift = [0, 3] if plane else [3, 0, 0]
        deck["bodies"][names[0]]["instances"] = [{"count": random.randint(1, 4), "translate": shift}]
        if chance(0.4) and not axisymmetric:
            deck["bodies"][names[0]]["instances"][0]["rotate"] = {"angle": random.choice([30, "360/7"]), "axis": [0, 0, 1]}
        if chance(0.3):
            deck["bodies"][names[0]]["instances"] = [{"count": 2, "translate": [0, 9] if plane else [0, 9, 0], "of": deck["bodies"][names[0]]["instances"]}]
    if chance(0.4):
        deck["decomposition"] = random.choice([{"subdomains": random.randint(1, 9)}, {"unknowns_per_subdomain": random.choice([10, 50, 300])},
                                               {"method": "grid", "counts": {name: [1] * (2 if plane else 3) for name in names}},
                                               {"unknowns_per_subdomain": 30, "subdomains_per_cluster": random.choice([2, 8])}])
    if chance(0.4):
        deck["solver"] = {"tolerance": random.choice(["auto", 1e-4, 1e-8])}
        if chance(0.3):
            deck["solver"]["algorithm"] = random.choice(["face_newton", "smalse"])
        if chance(0.3):
            deck["solver"]["preconditioner"] = random.choice(["none", "lumped", "dirichlet"])
        if chance(0.1):
            deck["solver"]["max_multiplications"] = random.choice([1, 5, 50])
    if chance(0.1):
        deck["mesh"]["scale"] = random.choice([0.001, 1000])
    if chance(0.1):
        deck["output"] = {"fields": random.choice([[], ["displacement"], ["stress", "von_mises"]])}


def applied(deck):
    """The sum of the loads of a valid deck, by what its blocks measure; None where more must be known."""
    plane = deck["dimension"] != 3
    if deck["dimension"] == "axisymmetric" or "steps" in deck or "scale" in deck["mesh"] or any("instances" in body for body in deck["bodies"].values()):
        return None
    total = [0.0] * (2 if plane else 3)
    for load in deck["loads"]:
        block = deck["mesh"]["blocks"][load.get("body") or load["boundary"].rsplit(".", 1)[0]]
        axis = "xyz".index(load["boundary"][-4]) if "boundary" in load else None
        measure = math.prod(size for i, size in enumerate(block["size"]) if i != axis)
        force = load.get("traction") or load.get("acceleration") or [0.0] * len(total)
        force = [measure * component for component in force]
        if "pressure" in load:
            force[axis] -= measure * load["pressure"] * (1 if load["boundary"].endswith("max") else -1)
        total = [t + f for t, f in zip(total, force)]
    return total


def choices(schema):
    """The alternatives of a value: of `anyOf`, or of a case (`if`, `then`, `else`)."""
    return schema["anyOf"] if "anyOf" in schema else [schema["then"], schema["else"]] if "if" in schema else []


def of_schema(random, schema, depth=0):
    """A value that a schema allows, near its limits where it has some."""
    if choices(schema):
        return of_schema(random, random.choice(choices(schema)), depth)
    if "const" in schema:
        return schema["const"]
    if "enum" in schema:
        return random.choice(schema["enum"])
    kind = schema.get("type")
    if kind == "object":
        keys = schema.get("properties", {})
        required = schema.get("required", [])
        result = {key: of_schema(random, value, depth + 1) for key, value in keys.items() if key in required or random.random() < 0.5 / (1 + depth)}
        if isinstance(schema.get("additionalProperties"), dict):
            for name in random.sample(["a", "steel", "a.zmax", "n"], random.randint(0, 2)):
                result[name] = of_schema(random, schema["additionalProperties"], depth + 1)
        return result
    if kind == "array":
        return [of_schema(random, schema.get("items", {}), depth + 1) for _ in range(random.randint(schema.get("minItems", 0), schema.get("maxItems", 3)))]
    if kind in ("number", "integer"):
        low = schema.get("minimum", schema.get("exclusiveMinimum"))
        high = schema.get("maximum", schema.get("exclusiveMaximum"))
        values = [0, 1, 2, 3] if kind == "integer" else [0, 1, number(random), -number(random), 1e-12, 1e12]
        for edge in (low, high):
            if edge is not None and abs(edge) < 1e5:
                values += [int(edge), int(edge) + 1, int(edge) - 1] if kind == "integer" else [edge, math.nextafter(edge, 1e9), math.nextafter(edge, -1e9)]
        return random.choice(values)
    if kind == "boolean":
        return random.choice([True, False])
    return random.choice(["a", "a.zmax", "b.zmin", "steel", "360/7", "x"])


def places(tree, path=()):
    """All (path, container, key) of a tree."""
    entries = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in list(entries):
        yield path + (key,), tree, key
        yield from places(value, path + (key,))


def subschema(schema, path):
    """The part of the schema that a path of a deck stands for; None where there is none."""
    for key in path:
        options = choices(schema) or [schema]
        if isinstance(key, int):
            found = [o["items"] for o in options if "items" in o]
        else:
            found = [o["properties"][key] for o in options if key in o.get("properties", {})]
            found = found or [o["additionalProperties"] for o in options if isinstance(o.get("additionalProperties"), dict)]
        if not found:
            return None
        schema = found[0] if len(found) == 1 else {"anyOf": found}
    return schema


def grows(path):
    return any(key in NOT_TO_GROW for key in path)


def mutate_tree(random, deck, schema):
    """One change of the deck as a tree, in place."""
    path, container, key = random.choice(list(places(deck)))
    value = container[key]
    kind = random.choice(["hostile"] * 4 + ["schema"] * 3 + ["delete", "rename", "copy", "swap", "add", "add", "number", "number", "name", "name", "wrap"])
    if kind == "hostile":
        container[key] = random.choice(LARGE if grows(path) else HOSTILE)
    elif kind == "schema":
        part = subschema(schema, path)
        if part and not grows(path):
            container[key] = of_schema(random, part)
    elif kind == "delete":
        del container[key]
    elif kind == "rename" and isinstance(container, dict):
        other = random.choice([str(key)[:-1], str(key) + "s", str(key).upper(), "", "*", str(key)[::-1], "x" * 250, 0, None, True])
        container[other] = container.pop(key)
    elif kind == "copy" and isinstance(container, list):
        container.insert(random.randint(0, len(container)), copy.deepcopy(value))
    elif kind == "swap":
        _, other, at = random.choice(list(places(deck)))
        if not grows(path) and at not in NOT_TO_GROW:
            container[key], other[at] = copy.deepcopy(other[at]), copy.deepcopy(value)
    elif kind == "add":
        spot = random.choice([deck] + [c[k] for _, c, k in places(deck) if isinstance(c[k], dict)])
        where = next((p for p, c, k in places(deck) if c[k] is spot), ())
        part = subschema(schema, where) or {}
        keys = {k: v for o in choices(part) or [part] for k, v in o.get("properties", {}).items()}
        if keys:
            name = random.choice(list(keys))
            if name not in NOT_TO_GROW:
                spot[name] = of_schema(random, keys[name])
    elif kind == "number" and isinstance(value, (int, float)) and not isinstance(value, bool):
        container[key] = random.choice(LARGE) if grows(path) else random.choice([-value, value * 10 ** random.randint(-30, 30), value + 1e-9, round(value), value / 3, str(value)])
    elif kind == "name" and isinstance(value, str):
        words = [c[k] for _, c, k in places(deck) if isinstance(c[k], str)]
        container[key] = random.choice([random.choice(words), value + "x", value[:-1], "*", value.replace(".", ".*", 1), "a.1:" + value, value.split(".")[0], value + ":", ":" + value, value.upper()])
    elif kind == "wrap":
        container[key] = random.choice([[value], {"a": value}, [value, value]])


def dump(random, deck):
    return yaml.safe_dump(deck, sort_keys=False, allow_unicode=True, default_flow_style=random.choice([None, False, False, True]), width=random.choice([80, 10000]))


def mutate_text(random, text):
    """One change of the deck as a text."""
    lines = text.split("\n")
    at = random.randrange(len(lines))
    place = random.randint(0, len(text))
    kind = random.choice(["line twice", "no line", "swap", "indent", "character", "truncate", "insert", "insert", "anchor", "alias", "word"])
    if kind == "line twice":
        lines.insert(at, lines[at])
    elif kind == "no line":
        del lines[at]
    elif kind == "swap":
        other = random.randrange(len(lines))
        lines[at], lines[other] = lines[other], lines[at]
    elif kind == "indent":
        lines[at] = random.choice([" ", "  ", "\t", "- ", "? ", ": ", "# ", "%"]) + lines[at]
    elif kind == "anchor" and ":" in lines[at]:
        lines[at] = lines[at].replace(":", ": " + random.choice(["&x", "&x ", "!!str", "!!binary", "!<tag:x>", "|", ">", "*x", "<<: *x"]), 1)
    elif kind == "alias" and ": " in lines[at] and at > 0:
        head, tail = lines[at].split(": ", 1)
        lines[at] = f"{head}: &y {tail}"
        other = random.randrange(len(lines))
        lines[other] = lines[other].split(": ", 1)[0] + ": *y"
    elif kind == "character" and text:
        return text[:place] + random.choice(["", "\0", "\x04", "\x1b", "\ud800", "\ufeff", "{", "}", "[", "]", "'", '"', "&", "*", "!", "%", "@", "`", "\r", "\t"]) + text[place + 1:]
    elif kind == "truncate":
        return text[:place]
    elif kind == "insert":
        junk = ["---\n", "...\n", "\n- a\n", "\n<<: *x\n", "&x ", "*x", "\ufeff", "[" * 1000, "{a: " * 1000, "- " * 1000, "\n" * 1000, " " * 1000, "x" * 5000, "\xff\xfe", "!!python/object:x ", "? ", "0" * 500,
                "%YAML 9.9\n---\n", "\nx0: &x0 [*x0]\n", "#", "\u0085", "\\", '"\\u0000"', '"\\x04"', "'", "|2\n", ": "]
        return text[:place] + random.choice(junk) + text[place:]
    elif kind == "word":
        words = [w for w in text.replace(",", " ").split() if len(w) > 1]
        return text.replace(random.choice(words), random.choice(words), 1) if words else text
    return "\n".join(lines)


def mutant(random, schema):
    """(text, the deck itself if it is a valid one)."""
    deck = valid(random)
    if random.random() < 0.12:
        return dump(random, deck), deck
    for _ in range(1 + int(random.expovariate(0.8))):
        try:
            mutate_tree(random, deck, schema)
        except (IndexError, KeyError, TypeError, ValueError, OverflowError):
            pass  # nothing left to change, or no such change of this value
    try:
        text = dump(random, deck)
    except (yaml.YAMLError, RecursionError, ValueError):
        return mutant(random, schema)
    while random.random() < 0.25:
        text = mutate_text(random, text)
    return text, None
