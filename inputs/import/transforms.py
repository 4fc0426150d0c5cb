"""*TRANSFORM: nodes whose supports and forces are along axes of their own, which become the deck's `axes`."""

import numpy as np

AXES = ("x", "y", "z")
NAMES = {False: AXES, True: ("radial", "tangential", "axial")}


class Axes:
    """Of one card: an entry of the deck's `axes`, and its directions at a place."""

    def __init__(self, card, number):
        rows = card.rows()
        values = [card.value(w, line, 0.0) for line, words in rows for w in words]
        values += [0.0] * (6 - len(values))
        a, b = np.array(values[:3]), np.array(values[3:6])
        kind = card.get("TYPE", "R").upper()
        if kind not in ("R", "C"):
            raise card.error(f"TYPE={kind}: expected R or C")
        self.card, self.name = card, f"transform_{number}"
        self.cylindrical = kind == "C"
        if card.scope is not None:
            place = card.scope.placed_point if self.cylindrical else card.scope.turned
            a, b = place(a), place(b)
        self.point = a
        if self.cylindrical:
            self.rows = np.array([np.zeros(3), np.zeros(3), unit(card, b - a)])
            return
        first = unit(card, a)
        second = unit(card, b - first * (first @ b))
        self.rows = np.array([first, second, np.cross(first, second)])

    def entry(self, plane):
        """What stands in the deck's section `axes`."""
        count = 2 if plane else 3
        if self.cylindrical:
            return {"axis": [0.0, 0.0, 1.0] if plane else numbers(self.rows[2]), "point": numbers(self.point[:count])}
        return {"x": numbers(self.rows[0][:count])} if plane else {"x": numbers(self.rows[0]), "y": numbers(self.rows[1])}

    def fits(self, plane, axisymmetric):
        """Whether a model of this kind has such axes: those of plane models turn about z, right-handed."""
        return not plane or self.rows[2][2] > 1 - 1e-9 and not (axisymmetric and self.cylindrical)

    def at(self, place):
        """Rows: the three directions there; None on the axis of cylindrical ones."""
        if not self.cylindrical:
            return self.rows
        along = self.rows[2]
        radius = place - self.point
        radius = radius - along * (along @ radius)
        length = np.linalg.norm(radius)
        if length <= 1e-9 * (np.linalg.norm(place - self.point) + 1e-300):
            return None
        return np.array([radius / length, np.cross(along, radius / length), along])

    def component(self, axis):
        return NAMES[self.cylindrical][axis]


def unit(card, v):
    length = np.linalg.norm(v)
    if length == 0:
        raise card.error("these points give no direction")
    return v / length


def numbers(v):
    return [float(f"{c:.12g}") + 0.0 for c in v]


def read(model):
    """Node -> Axes; of several cards for a node the last one."""
    result = {}
    for number, card in enumerate([c for c in model.cards if c.name == "TRANSFORM"], 1):
        axes = Axes(card, number)
        for n in model.nodes_of(card, card.line, card.need("NSET")):
            result[n] = axes
    return result
