"""*PRE-TENSION SECTION: the mesh is cut there, and the two sides become boundaries."""

import numpy as np

import elements


def adjacent(model, cells):
    """Face (sorted corners) -> the (element, face) that have it."""
    found = {}
    for i in cells:
        element = model.elements[i]
        for f, own in enumerate(elements.FACES[elements.family(element.shape)]):
            found.setdefault(tuple(sorted({element.nodes[c] for c in own})), []).append((i, f))
    return found


def cut(model, cells, sides):
    """Gives the elements behind the faces `sides` nodes of their own. Returns the faces behind, or None if some side has none."""
    faces = adjacent(model, cells)

    def key(side):
        element = model.elements[side[0]]
        return tuple(sorted({element.nodes[c] for c in elements.FACES[elements.family(element.shape)][side[1]]}))

    keys = {key(side) for side in sides}
    behind = []
    for side in sides:
        other = [s for s in faces.get(key(side), []) if s[0] != side[0]]
        if len(other) != 1:
            return None
        behind.append(other[0])
    on_cut = {n for side in sides for n in elements.face_nodes(model.elements[side[0]].shape, model.elements[side[0]].nodes, side[1])[1]}
    near = {i for i in cells if on_cut & set(model.elements[i].nodes)}
    # Elements that are joined to those behind by a face with a node of the cut, other than the cut itself.
    reached, front = set(), [s[0] for s in behind]
    kept = {s[0] for s in sides}
    while front:
        i = front.pop()
        if i in reached:
            continue
        reached.add(i)
        element = model.elements[i]
        for own in elements.FACES[elements.family(element.shape)]:
            face = tuple(sorted({element.nodes[c] for c in own}))
            if face not in keys and on_cut & set(face):
                front += [j for j, _ in faces[face] if j in near and j not in reached]
    if reached & kept:
        return None
    copies = {}
    for i in reached:
        for k, n in enumerate(model.elements[i].nodes):
            if n in on_cut:
                if n not in copies:
                    copies[n] = len(model.points)
                    model.points.append(list(model.points[n]))
                model.elements[i].nodes[k] = copies[n]
    model.copies = {**getattr(model, "copies", {}), **copies}
    return behind


def side_of(model, card, sides):
    """1 if the direction on the data line is that out of the elements of `sides`, or if there is none; -1 if it is the other one; 0: oblique."""
    rows = card.rows()
    given = np.array([card.value(w, rows[0][0], 0.0) for w in rows[0][1][:3]] if rows else [])
    if len(given) < 2 or not np.any(given):
        return 1
    given = np.append(given, np.zeros(3 - len(given)))
    normal = np.zeros(3)
    for i, f in sides:
        element = model.elements[i]
        on = np.array([model.points[element.nodes[c]] for c in elements.FACES[elements.family(element.shape)][f]])
        middle = np.mean([model.points[n] for n in element.nodes], axis=0)
        if len(on) == 2:
            along = on[1] - on[0]
            own = np.array([along[1], -along[0], 0.0])
        else:
            own = sum(np.cross(on[k] - on[0], on[k + 1] - on[0]) for k in range(1, len(on) - 1))
        normal += own if own @ (on.mean(axis=0) - middle) > 0 else -own
    cosine = normal @ given / (np.linalg.norm(normal) * np.linalg.norm(given))
    return 0 if abs(cosine) < 0.999 else 1 if cosine > 0 else -1


def apply(model, cells):
    """Cuts all sections. Returns, by the section's node, {name, secondary, primary, card}: lists of faces."""
    result = {}
    for card in [c for c in model.cards if c.name == "PRE-TENSIONSECTION"]:
        if not card.get("SURFACE") or not card.get("NODE"):
            model.leave_out(card, "expected SURFACE= and NODE=: the section of a beam has no counterpart")
            continue
        node = model.nodes_of(card, card.line, card.get("NODE"))[0]
        surface = model.surface(card, card.line, card.get("SURFACE"))
        sides = [] if surface.nodal else model.sides_of_surface(surface)
        if not sides or any(f is None for _, f in sides):
            model.leave_out(card, "the surface has no faces that are named: the bolt cannot be cut there")
            continue
        sign = side_of(model, card, sides)
        if sign == 0:
            model.leave_out(card, "its direction is not the normal of the surface: a bolt of the deck is tightened across the cut")
            continue
        behind = cut(model, cells, sides)
        if behind is None:
            model.leave_out(card, "the surface does not cut a bolt in two: give the faces of one side, all across it")
            continue
        result[node] = {"name": surface.name, "secondary": sides, "primary": behind, "card": card, "sign": sign}
    return result
