"""Contacts, and bolts that are tightened."""

import numpy as np

from bodies import clean
from model import rotated
from reader import InputError


class Contacts:
    def make_contacts(self):
        for contact in self.interactions.contacts:
            card, line = contact["card"], contact["line"]
            item, sides = {}, None
            if contact.get("auto"):
                item["auto"] = True
            else:
                sides = self.sides_of(contact)
                if sides is None or contact.get("dropped"):
                    continue
                item["secondary"], item["primary"] = sides
            if "law" in contact:
                self.report_soft(contact["law"], sides, contact.get("nodal", False))
                if contact["law"].get("bonded") and sides:
                    self.report_pulled(contact, sides)
            if "clearance" in contact:
                contact.pop("adjust", None)  # the gap is given, wherever the nodes are
            if contact.get("name"):
                item["name"] = self.name_of(clean(contact["name"]))
            for key in ("friction", "cyclic", "adjust", "clearance", "search_distance"):
                if key in contact:
                    item[key] = contact[key]
            if "cyclic" in contact:
                item["cyclic"] = self.turned_right(contact["cyclic"], sides)
            elif sides and not contact.get("tied"):
                distance = self.far_apart(sides)
                if distance:
                    item["search_distance"] = distance
            self.contacts.append(item)

    def sides_of(self, contact):
        """The boundaries of both sides, or None where the deck cannot have the contact, which is listed once."""
        if "sides" not in contact:
            contact["sides"] = self.find_sides(contact, contact["card"], contact["line"])
        return contact["sides"]

    def find_sides(self, contact, card, line):
        sides = [self.faces_of(card, line, contact[side]) for side in ("secondary", "primary")]
        if None in sides:
            return None
        own = self.bodies_of(sides)
        if own[0] & own[1] and "cyclic" not in contact:
            names = ", ".join(self.bodies.bodies[b].name for b in sorted(own[0] & own[1]))
            self.model.leave_out(card, f"both sides belong to one body ({names}): bodies of the deck do not touch themselves", line)
            return None
        return sides

    def bodies_of(self, sides):
        return [{self.bodies.outer[key] for key in self.boundaries[s]} for s in sides]

    def turned_right(self, cyclic, sides):
        """The turn brings the primary side to the secondary one."""
        secondary, primary = (
            np.mean([self.model.points[n] for key in self.boundaries[s] for n in self.bodies.nodes(key)], axis=0) for s in sides
        )
        angle = 360 / int(cyclic["angle"].split("/")[1])
        line = [*cyclic["center"], *np.add(cyclic["center"], cyclic["axis"])]
        off = [np.linalg.norm(rotated(primary[None], [*line, sign * angle])[0] - secondary) for sign in (1, -1)]
        result = dict(cyclic, angle=cyclic["angle"] if off[0] <= off[1] else "-" + cyclic["angle"])
        if self.plane:
            if abs(cyclic["axis"][2]) < 0.99 * np.linalg.norm(cyclic["axis"]):
                raise InputError("a cyclic plane model turns about z")
            result["center"] = cyclic["center"][:2]
        return result

    def far_apart(self, sides):
        """Twice the gap of two sides that are farther apart than the deck's own search distance, else None."""
        a, b = (np.array([self.model.points[n] for n in {n for key in self.boundaries[s] for n in self.bodies.nodes(key)}]) for s in sides)
        reach = 0.1 * min(np.ptp(a, axis=0).max(), np.ptp(b, axis=0).max())
        box = max(np.maximum(b.min(axis=0) - a.max(axis=0), a.min(axis=0) - b.max(axis=0)).max(), 0.0)
        return float(f"{2 * box:.3g}") if box > 0.5 * reach else None

    def make_preloads(self):
        states = self.history.states
        for node, section in self.sections.items():
            card = section["card"]
            sides = []
            for side, tail in (("secondary", "cut_1"), ("primary", "cut_2")):
                keys, lost = self.expand(section[side])
                if lost:
                    raise card.error("the cut is not whole")
                sides.append(self.add_boundary(f"{section['name']}_{tail}", keys))
            own = [{self.bodies.outer[key] for key in self.boundaries[s]} for s in sides]
            item = {"name": self.name_of(clean(section["name"])), "secondary": sides[0], "primary": sides[1], "friction": {"bonded": True}}
            forces = [s.forces[node, 1].value if (node, 1) in s.forces else None for s in states]
            lengths = [s.supports[node, 1].value if (node, 1) in s.supports else None for s in states]
            if section["sign"] < 0:
                forces, lengths = ([None if v is None else -v for v in values] for values in (forces, lengths))
            if own[0] & own[1]:
                self.model.leave_out(card, "the surface does not cut a bolt in two bodies: a bolt of the deck is two bodies")
                self.contacts.append(item)
                continue
            for s in states:
                for n, axis in [*s.forces, *s.supports]:
                    if n == node and axis != 1:
                        self.model.leave_out(card, "a shear of the section", changes=False)
            if any(forces):
                base = self.largest(forces)
                if base < 0:
                    self.model.leave_out(card, "a compression: the deck's preload is a tension")
                    self.contacts.append(item)
                    continue
                item["preload"] = {"force": base / self.thickness}
                item["course"] = [
                    None if k > 0 and (f is None or node in states[k].locked) else (f or 0.0) / base for k, f in enumerate(forces)
                ]
                for k, value in enumerate(lengths):
                    if value is not None and forces[k] is None:
                        self.model.leave_out(
                            states[k].supports[node, 1].card,
                            "a bolt that is tightened by a force first, then by a length: it keeps its length",
                            states[k].supports[node, 1].line,
                            changes=value != 0,
                        )
            elif any(lengths):
                base = self.largest(lengths)
                item["preload"] = {"shortening": base}
                item["course"] = [None if v is None else v / base for v in lengths]
            else:
                self.model.note(card, "is not tightened: the two sides are bonded")
            self.contacts.append(item)
