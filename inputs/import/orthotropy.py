"""Materials with constants of their own in three directions: *ELASTIC, *EXPANSION and *ORIENTATION."""

import numpy as np

ELASTIC = {"ENGINEERINGCONSTANTS", "ORTHO", "ORTHOTROPIC"}
EXPANSION = {"ORTHO", "ORTHOTROPIC"}
PAIRS = ((0, 1), (0, 2), (1, 2))


def kind_of(card):
    return card.get("TYPE", "ISO").upper().replace(" ", "")


def read(model, card, material):
    """Takes a card of one of the above types: fills material["orthotropic"], or its thermal expansion."""
    count = 3 if card.name == "EXPANSION" else 9
    rows = [[card.value(w, line, 0.0) for w in words] for line, words in card.rows()]
    values = sum(rows, [])
    if len(values) < count:
        raise card.error(f"expected {count} constants, found {len(values)}")
    if len(rows) > (count + 7) // 8:
        model.leave_out(card, f'material "{material["name"]}": values that depend on temperature; the first ones are taken')
    if card.name == "EXPANSION":
        material["expansions"] = values[:3]
        return
    elastic = engineering_constants(card, values) if kind_of(card) != "ENGINEERINGCONSTANTS" else (values[:3], values[3:6], values[6:9])
    material["orthotropic"] = dict(zip(("young_modulus", "poisson_ratio", "shear_modulus"), elastic))


def engineering_constants(card, values):
    """Of the stiffness D1111, D1122, D2222, D1133, D2233, D3333, D1212, D1313, D2323."""
    a, b, c, d, e, f = values[:6]
    try:
        flexible = np.linalg.inv(np.array([[a, b, d], [b, c, e], [d, e, f]]))
    except np.linalg.LinAlgError:
        raise card.error("the stiffness has no inverse") from None
    young = [round_off(1 / flexible[i, i]) for i in range(3)]
    return young, [round_off(-flexible[j, i] / flexible[i, i]) for i, j in PAIRS], values[6:9]


def round_off(value):
    return float(f"{value:.15g}")


def finish(model, material):
    """Expansions belong to the orthotropic constants; an isotropic material with three of them becomes one."""
    expansions = material.pop("expansions", None)
    if expansions is None:
        return
    if "orthotropic" not in material and "young_modulus" in material:
        young, poisson = material.pop("young_modulus"), material.pop("poisson_ratio")
        material["orthotropic"] = {
            "young_modulus": [young] * 3,
            "poisson_ratio": [poisson] * 3,
            "shear_modulus": [round_off(young / (2 + 2 * poisson))] * 3,
        }
    if "orthotropic" in material:
        material["orthotropic"]["thermal_expansion"] = expansions


def expands(material):
    return any(material.get("orthotropic", {}).get("thermal_expansion", ())) or bool(material.get("thermal_expansion"))


def orientation_of(model, name, section, scope):
    """The *ORIENTATION that a section names: that of its own instance, or of the assembly."""
    named = [c for c in model.cards if c.name == "ORIENTATION" and c.need("NAME").upper() == name.upper()]
    found = [c for c in named if c.scope is not None and c.scope is scope] or [c for c in named if c.scope is None]
    if not found:
        raise section.error(f'there is no *ORIENTATION "{name}"')
    if len(found) > 1:
        raise found[-1].error(f'the *ORIENTATION "{name}" is given twice')
    return found[0]


def axes_of(model, card):
    """The entry of the deck's `axes` for an *ORIENTATION; that of a part moves with its instance."""
    system = card.get("SYSTEM", "RECTANGULAR").upper()
    if system not in ("RECTANGULAR", "CYLINDRICAL") or card.get("DEFINITION", "COORDINATES").upper() != "COORDINATES":
        raise card.error("the directions of a material are translated for SYSTEM=RECTANGULAR and CYLINDRICAL with coordinates of points")
    rows = [[card.value(w, line, 0.0) for w in words] for line, words in card.rows()]
    if not rows or len(rows[0]) < 6:
        raise card.error("expected the coordinates of two points")
    a, b = np.array(rows[0][:3]), np.array(rows[0][3:6])
    number, angle = (int(rows[1][0]), np.radians(rows[1][1])) if len(rows) > 1 and len(rows[1]) > 1 else (3, 0.0)
    if system == "CYLINDRICAL":
        if angle:
            raise card.error("an additional rotation of cylindrical directions has no counterpart")
        if card.scope is not None:
            a, b = card.scope.placed_point(a), card.scope.placed_point(b)
        return {"axis": numbers(b - a), "point": numbers(a)}
    origin = np.array((rows[0] + [0.0] * 3)[6:9])
    if origin.any():
        model.note(card, "a third point, the origin of the two, as in Abaqus; CalculiX knows none")
    x, y = a - origin, b - origin
    if np.linalg.norm(np.cross(x, y)) < 1e-9 * np.linalg.norm(x) * np.linalg.norm(y) or not np.linalg.norm(x):
        raise card.error("the two points and the origin lie on one line")
    if angle:
        frame = [x / np.linalg.norm(x), np.cross(np.cross(x, y), x), np.cross(x, y)]
        frame = [v / np.linalg.norm(v) for v in frame]
        x, y = (turned(v, frame[number - 1], angle) for v in frame[:2])
    if card.scope is not None:
        x, y = card.scope.turned(x), card.scope.turned(y)
    return {"x": numbers(x), "y": numbers(y)}


def in_plane(axes, axisymmetric):
    """The same in a model of the plane, where the third direction is across it; None if they are not of that kind."""
    if "axis" in axes:
        along = np.abs(axes["axis"])
        return None if axisymmetric or max(along[:2]) > 1e-9 * along[2] else {"axis": [0.0, 0.0, 1.0], "point": axes["point"][:2]}
    x, y = np.array(axes["x"]), np.array(axes["y"])
    flat = max(abs(x[2]) / np.linalg.norm(x), abs(y[2]) / np.linalg.norm(y)) < 1e-9
    return {"x": axes["x"][:2]} if flat else None


def turned(v, axis, angle):
    return v * np.cos(angle) + np.cross(axis, v) * np.sin(angle) + axis * axis.dot(v) * (1 - np.cos(angle))


def numbers(vector):
    return [round_off(x) for x in vector]


def of_section(model, card, scope, materials, name):
    """The key of the material of a section: where that is orthotropic and has an orientation, a material of its own."""
    material, orientation = materials[name], card.get("ORIENTATION")
    if "orthotropic" not in material or not orientation:
        return name
    at = orientation_of(model, orientation, card, scope)
    if at.scope is None and scope is not None and scope.is_turned():
        raise at.error(f'the instance "{scope.name}" is turned, and these directions are not: they belong into its part')
    key = f"{name}@{orientation.upper()}" + (f"@{at.scope.name}" if at.scope is not None else "")
    if key not in materials:
        known = [k for k in materials if k.startswith(name + "@")]
        of = orientation if at.scope is None else f"{at.scope.name}.{orientation}"
        label = material["name"] if not known else f'{material["name"]}_{of}'
        materials[key] = {**material, "name": label, "axes": (of, axes_of(model, at))}
    return key
