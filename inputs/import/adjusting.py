"""Slave nodes that ties and contact pairs move onto the master surface before the analysis, and those that a tie does not reach."""

import numpy as np

import projection
from softness import FAR

TOLERANCE = 0.05  # of the mean size of the master's faces: how far Abaqus ties where no POSITION TOLERANCE is given
CALCULIX = 0.005  # the same of CalculiX, about; it is counted from triangles
MUCH = 0.2  # of that size: overlaps of general contact that are no errors of a mesh
BESIDE = 0.025  # of that size: how far beside the master a node may lie to belong to it


class Adjusting:
    def adjust(self):
        for contact in self.interactions.contacts:
            if contact.get("auto"):
                self.adjust_all(contact)
            if contact.get("auto") or not (contact.get("tied") or {"adjust", "adjusted", "general"} & contact.keys()):
                continue
            sides = self.sides_of(contact)
            if sides is None:
                continue
            keys = [self.boundaries[side] for side in sides]
            if contact.get("tied"):
                self.adjust_tie(contact, *keys)
            elif "general" in contact:
                self.part(contact, *keys)
            else:
                self.adjust_pair(contact, *keys)

    def adjust_tie(self, contact, slave, master):
        """Nodes within the tolerance are tied, and moved unless ADJUST=NO; others are not tied."""
        card, line = contact["card"], contact["line"]
        size, reach = self.sizes(slave, master)
        tolerance = contact.get("tolerance", 0.0)
        given = tolerance > 1e-10  # what is less counts for none in CalculiX
        if not given:
            tolerance = TOLERANCE * size
        nodes, places, gaps, distances, near = self.onto(slave, master, max(tolerance, reach))
        tied, far = near & (distances <= tolerance), near & (distances > tolerance)
        limit = f"the tolerance, {tolerance:.3g}" + ("" if given else ", 5 % of the master's faces")
        if not tied.any():
            self.model.leave_out(card, f"no slave node lies opposite the master and nearer than {limit}: nothing is tied", line)
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
        self.report_cut_faces(contact, slave, set(nodes[tied].tolist()), set(nodes[far].tolist()))
        if not given and distances[tied].max() > CALCULIX * size:
            self.model.note(
                card,
                f"without POSITION TOLERANCE: nodes up to {distances[tied].max():.3g} away are tied, as in Abaqus; CalculiX's own tolerance is about "
                f"{CALCULIX * size:.2g}, and leaves those beyond it loose",
                line,
            )
        if contact["moves"]:
            self.move(nodes, places, tied)

    def report_cut_faces(self, contact, slave, tied, far):
        """Faces of which some nodes are tied and others lie beside the master."""
        beside = {n for key in slave if tied & set(self.bodies.nodes(key)) for n in self.bodies.nodes(key)} - tied - far
        if beside:
            self.model.note(
                contact["card"],
                f"{len(beside)} slave nodes lie beside the master, on faces of which others are tied: the deck bonds the parts of those faces that lie "
                "opposite, where nodes alone are tied in the file",
                contact["line"],
            )

    def adjust_pair(self, contact, slave, master):
        """A value moves nodes that overlap or are nearer than it, a set its nodes: without strain, as in both programs."""
        size, reach = self.sizes(slave, master)
        value = contact.get("adjust", 0.0)
        nodes, places, gaps, _, near = self.onto(slave, master, max(value, reach))
        moved = near.copy()
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
            apart = (near & (gaps > value)).sum()
            if "tied_pair" in contact and apart:
                self.model.leave_out(contact["card"], f"TIED: {apart} slave nodes are farther away than ADJUST={value:g}: they are not tied", contact["line"])
        if value == 0:
            self.set_adjust(contact, size, gaps, moved, near & ~moved)
        self.move(nodes, places, moved)

    def adjust_all(self, contact):
        """General contact of all bodies: each is parted from those before it."""
        faces = {}
        for key, b in sorted(self.bodies.outer.items()):
            faces.setdefault(b, []).append(key)
        before = list(faces.get(0, ()))
        for b in range(1, len(self.bodies.bodies)):
            self.part(contact, faces[b], before)
            before += faces[b]

    def part(self, contact, slave, master):
        """General contact of Abaqus: small overlaps are taken away without strain, and sides that overlap by more do not meet at all."""
        size, _ = self.sizes(slave, master)
        nodes, places, gaps, _, near = self.onto(slave, master, size)
        over = near & (gaps < -1e-9 * size)
        deep = -gaps[over].min(initial=0.0)
        if deep > MUCH * size:
            self.model.leave_out(
                contact["card"],
                f"sides overlap by up to {deep:.3g}: Abaqus takes small overlaps away, and lets sides that overlap by more pass each other; the deck has "
                "them as they are",
                contact["line"],
            )
        elif over.any():
            self.move(nodes, places, over)

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
        slave, master = (self.boundaries[side] for side in sides)
        size, reach = self.sizes(slave, master)
        nodes, _, gaps, _, near = self.onto(slave, master, reach)
        gap = np.abs(gaps[near]).max(initial=0.0)
        if gap > 1e-6 * size:
            self.model.leave_out(
                contact["card"],
                f"PRESSURE-OVERCLOSURE=TIED closes gaps and overlaps of up to {gap:.3g} by force; the deck bonds the sides as they are. ADJUST takes them away",
                contact["line"],
                changes=gap > FAR * size,
            )

    def onto(self, slave, master, reach):
        """Of the slave's nodes: the nearest places on faces of the master that lie opposite, signed gaps, distances, and whether there is such a
        place not beside the master."""
        looks = {}
        for key, normal in zip(slave, projection.middle_normals([self.face(key) for key in slave])):
            for n in self.bodies.nodes(key):
                looks.setdefault(n, []).append(normal)
        nodes = np.array(sorted(looks))
        directions = np.zeros((len(nodes), max(map(len, looks.values())), 3))
        for k, n in enumerate(nodes):
            directions[k, : len(looks[n])] = looks[n]
        points = np.array([self.model.points[n] for n in nodes])
        places, normals, distances = projection.nearest([self.face(key) for key in master], points, reach, directions)
        off = points - places
        gaps = np.einsum("nc,nc->n", off, normals)
        size, _ = self.sizes(slave, master)
        beside = np.linalg.norm(off - gaps[:, None] * normals, axis=1)
        return nodes, places, gaps, distances, np.isfinite(distances) & (beside <= BESIDE * size)

    def move(self, nodes, places, which):
        for n, place in zip(nodes[which], places[which]):
            self.model.points[n] = place.tolist()

    def face(self, key):
        """(shape, places of the nodes, the middle of the cell behind it)."""
        shape, nodes = self.bodies.shape(key), self.bodies.nodes(key)
        middle = np.mean([self.model.points[n] for n in self.model.elements[key[0]].nodes], axis=0)
        return shape, [self.model.points[n] for n in nodes], middle

    def sizes(self, slave, master):
        """(mean size of the master's faces, how far contact of the deck reaches by itself): tenth of the smaller side, or the longest face."""
        lengths, extents = [], []
        for side in (slave, master):
            corners = [np.array([self.model.points[n] for n in self.bodies.corners(key)]) for key in side]
            lengths.append([np.linalg.norm(c[:, None] - c[None], axis=2).max() for c in corners])
            extents.append(np.linalg.norm(np.ptp(np.concatenate(corners), axis=0)))
        return float(np.mean(lengths[1])), max(0.1 * min(extents), *(max(own) for own in lengths))
