"""The deck of a model of the population, and the files of a folder that hold it."""

import fnmatch
import json
import math

import yaml

import meshes


def decomposition(plan, made):
    """1 to 200 subdomains of at least some 60 unknowns."""
    most = max(len(made.entries), min(200, int((made.unknowns() or plan["unknowns"]) / 60)))
    wanted = max(len(made.entries), round(math.exp(plan["spread"] * math.log(most))))
    if made.boxes and made.blocks and plan["grid"]:
        counts = {}
        for name, block in made.blocks.items():
            share, axes = wanted / len(made.blocks), len(block["cells"])
            counts[name] = [max(1, min(c, round(share ** (1 / axes)))) for c in block["cells"]]
        return {"method": "grid", "counts": counts}
    return {"subdomains": wanted}


def blocks_of(deck, made):
    """Even boxes as blocks of the deck, whose boundaries are called NAME.xmin and so on."""
    deck["mesh"] = {"blocks": made.blocks}
    sides = {"left": "xmin", "right": "xmax", "bottom": "ymin", "top": "ymax", "front": "zmin", "back": "zmax"}
    new = {f"{body}_{side}": f"{body}.{name}" for body in made.blocks for side, name in sides.items()}
    for entry in deck["supports"] + deck["loads"] + deck["contacts"]:
        for key in ("boundary", "secondary", "primary"):
            if isinstance(entry.get(key), str):
                entry[key] = new.get(entry[key], entry[key])


def merged(supports):
    """One entry a boundary: a component that is given twice stays as it was first."""
    found = {}
    for entry in supports:
        found.setdefault(entry["boundary"], {}).update({k: v for k, v in entry["displacement"].items() if k not in found.get(entry["boundary"], {})})
    return [{"boundary": name, "displacement": {k: float(v) for k, v in components.items()}} for name, components in found.items()]


def deck_of(made, plan, tolerance):
    deck = {"title": f"{plan['family']}, {plan['element']}, {plan['law']}", "dimension": plan["kind"], "mesh": made.mesh or {"file": "deck.msh"},
            "materials": made.materials, "bodies": made.entries, "supports": merged(made.supports), "loads": made.loads, "contacts": made.contacts,
            "decomposition": decomposition(plan, made), "solver": {"tolerance": tolerance, "preconditioner": plan["preconditioner"]}}
    if made.boxes and made.blocks and not made.mesh and plan["grid"]:
        blocks_of(deck, made)
    if not deck["loads"]:
        del deck["loads"]
    return deck


def plain(value):
    """Without numpy's numbers."""
    if isinstance(value, dict):
        return {k: plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    return value.item() if hasattr(value, "item") else value


def write(directory, deck, bodies, files, expected):
    directory.mkdir(parents=True, exist_ok=True)
    if deck["mesh"].get("file", "").endswith(".msh"):
        meshes.write(directory / deck["mesh"]["file"], bodies)
    for name, text in files.items():
        (directory / name).write_text(text)
    (directory / "deck.yaml").write_text(yaml.safe_dump(plain(deck), sort_keys=False))
    (directory / "expected.json").write_text(json.dumps(plain(expected), indent=1) + "\n")


def chosen(name, patterns):
    return not patterns or any(fnmatch.fnmatch(name, pattern) for pattern in patterns)
