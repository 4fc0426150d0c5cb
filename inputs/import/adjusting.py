"""Slave nodes that ties and contact pairs move onto the master surface before the analysis, and those that a tie does not reach."""

import numpy as np

import projection
from softness import FAR

TOLERANCE = 0.05  # of the mean size of the master's faces: how far Abaqus ties where no POSITION TOLERANCE is given
CALCULIX = 0.005  # the same of CalculiX, about; it is counted from triangles
BESIDE = 0.025  # of that size: how far beside the master a node may lie to belong to it


class Adjusting:
    def adjust(self):
        for contact in self.interactions.contacts:
            if not (contact.get("tied") or "adjust" in contact or "adjusted" in contact):
                continue
            sides = self.sides_of(contact)
            if sides is None:
                continue
            if contact.get("tied"):
                self.adjust_tie(contact, sides)
            else:
                self.adjust_pair(contact, sides)

    def adjust_tie(self, contact, sides):
        """Nodes within the tolerance are tied, and moved unless ADJUST=NO; others are not tied."""
        card, line = contact["card"], contact["line"]
        size, reach = self.sizes(sides)
        tolerance = contact.get("tolerance", 0.0)
        given = tolerance > 1e-10  # what is less counts for none in CalculiX
        if not given:
            tolerance = TOLERANCE * size
        nodes, places, gaps, distances, near, facing = self.onto(sides, max(tolerance, reach))
        tied, far = near & (distances <= tolerance), near & facing & (distances > tolerance)
        limit = f"the tolerance, {tolerance:.3g}" + ("" if given else ", 5 % of the master's faces")
        if not tied.any():
            self.model.leave_out(card, f"no slave node is nearer than {limit}: nothing is tied", line)
            contact["dropped"] = True
            return
        if far.any():
            self.model.leave_out(
                card,
                f"{far.sum()} of {len(nodes)} slave nodes are farther away than {limit}, by up to {distances[far].max():.3g}: they are not tied; "
                "where others of their faces are, the deck bonds what is nearer than that",
                line,
            )
            contact["search_distance"] = tolerance
        elif distances[tied].max() > 0.5 * reach and not contact["moves"]:
            contact["search_distance"] = float(f"{2 * distances[tied].max():.3g}")
        if not given and distances[tied].max() > CALCULIX * size:
            self.model.note(
                card,
                f"without POSITION TOLERANCE: nodes up to {distances[tied].max():.3g} away are tied, as in Abaqus; CalculiX's own tolerance is about "
                f"{CALCULIX * size:.2g}, and leaves those beyond it loose",
                line,
            )
        if contact["moves"]:
            self.move(nodes, places, tied)

    def adjust_pair(self, contact, sides):
        """A value moves nodes that overlap or are nearer than it, a set its nodes: without strain, as in both programs."""
        size, reach = self.sizes(sides)
        value = contact.get("adjust", 0.0)
        nodes, places, gaps, _, near, facing = self.onto(sides, max(value, reach))
        moved = near & facing
        if "adjusted" in contact:
            chosen = np.isin(nodes, contact["adjusted"])
            lost = (chosen & ~moved).sum()
            if lost:
                self.model.leave_out(contact["card"], f"ADJUST: {lost} nodes of the set do not face the master, and stay where they are", contact["line"])
            if chosen.all():
                contact.setdefault("clearance", 0)
            moved &= chosen
        else:
            moved &= gaps <= value
            apart = (near & facing & (gaps > value)).sum()
            if "tied_pair" in contact and apart:
                self.model.leave_out(contact["card"], f"TIED: {apart} slave nodes are farther away than ADJUST={value:g}: they are not tied", contact["line"])
        if value == 0:
            self.set_adjust(contact, size, gaps, moved, near & facing & ~moved)
        self.move(nodes, places, moved)

    @staticmethod
    def set_adjust(contact, size, gaps, moved, others):
        """Rows between nodes that moved and others have gaps or overlaps of their own: they count for 0 as far as no other node's gap does."""
        contact.pop("adjust", None)
        moves = np.abs(gaps[moved]).max(initial=0.0)
        limit = min(moves, 0.99 * gaps[others & (gaps > 0)].min(initial=np.inf))
        if moves > 1e-9 * size:
            contact["adjust"] = float(f"{limit:.3g}")

    def report_pulled(self, contact, sides):
        """CalculiX's law TIED draws sides that are apart together, and pushes apart those that overlap; bonds of the deck leave gaps as they are."""
        size, reach = self.sizes(sides)
        nodes, _, gaps, _, near, facing = self.onto(sides, reach)
        gap = np.abs(gaps[near & facing]).max(initial=0.0)
        if gap > 1e-6 * size:
            self.model.leave_out(
                contact["card"],
                f"PRESSURE-OVERCLOSURE=TIED closes gaps and overlaps of up to {gap:.3g} by force; the deck bonds the sides as they are. ADJUST takes them away",
                contact["line"],
                changes=gap > FAR * size,
            )

    def onto(self, sides, reach):
        """Of the slave's nodes: the nearest places on the master, signed gaps, distances, whether the place is not beside the node but opposite,
        and whether a face of the node looks that way."""
        slave, master = (self.boundaries[side] for side in sides)
        nodes = np.array(sorted({n for key in slave for n in self.bodies.nodes(key)}))
        points = np.array([self.model.points[n] for n in nodes])
        places, normals, distances = projection.nearest([self.face(key) for key in master], points, reach)
        off = points - places
        gaps = np.einsum("nc,nc->n", off, normals)
        size, _ = self.sizes(sides)
        beside = np.linalg.norm(off - gaps[:, None] * normals, axis=1)
        near = np.isfinite(distances) & (beside <= BESIDE * size)
        facing, number = np.zeros(len(nodes), bool), {n: k for k, n in enumerate(nodes)}
        for key in slave:
            normal = self.normal(key)
            for n in self.bodies.nodes(key):
                facing[number[n]] |= normal @ normals[number[n]] < -0.3
        return nodes, places, gaps, distances, near, facing

    def move(self, nodes, places, which):
        for n, place in zip(nodes[which], places[which]):
            self.model.points[n] = place.tolist()

    def face(self, key):
        """(shape, places of the nodes, the middle of the cell behind it)."""
        shape, nodes = self.bodies.shape(key), self.bodies.nodes(key)
        middle = np.mean([self.model.points[n] for n in self.model.elements[key[0]].nodes], axis=0)
        return shape, [self.model.points[n] for n in nodes], middle

    def normal(self, key):
        """The outward unit normal at the middle of a face."""
        shape, nodes, behind = self.face(key)
        middle = np.mean(nodes, axis=0)
        _, normal = projection.nearest_of_faces(shape, np.array([nodes], dtype=float), middle[None])
        return normal[0] if normal[0] @ (middle - behind) > 0 else -normal[0]

    def sizes(self, sides):
        """(mean size of the master's faces, how far contact of the deck reaches by itself): tenth of the smaller side, or the longest face."""
        lengths, extents = [], []
        for side in sides:
            corners = [np.array([self.model.points[n] for n in self.bodies.corners(key)]) for key in self.boundaries[side]]
            lengths.append([np.linalg.norm(c[:, None] - c[None], axis=2).max() for c in corners])
            extents.append(np.linalg.norm(np.ptp(np.concatenate(corners), axis=0)))
        return float(np.mean(lengths[1])), max(0.1 * min(extents), *(max(own) for own in lengths))
