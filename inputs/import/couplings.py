"""Couplings of boundaries to points, and rigid bodies."""

import numpy as np

from bodies import clean, unique
from transforms import AXES


class Couplings:
    def find_couplings(self):
        """Reference node -> {name, nodes, kind, card}; empty if the deck has no couplings. Sets coupling_cards."""
        self.coupling_cards = set()
        if "couplings" not in self.schema.get("properties", {}):
            return {}
        result, open_one = {}, None
        for card in self.model.cards:
            if card.name == "COUPLING":
                node = self.model.nodes_of(card, card.line, card.need("REFNODE"))[0]
                surface = self.model.surface(card, card.line, card.need("SURFACE"))
                open_one = {"name": card.get("CONSTRAINTNAME") or "coupling", "surfaces": [surface], "kind": "rigid", "card": card, "node": node}
                result.setdefault(node, []).append(open_one)
                self.coupling_cards.add(id(card))
            elif card.name in ("KINEMATIC", "DISTRIBUTING") and open_one:
                self.coupling_cards.add(id(card))
                open_one["kind"] = "rigid" if card.name == "KINEMATIC" else "distributing"
                axes = {a for line, words in card.rows() for a in range(card.number(words[0], line), card.number(words[-1], line) + 1)}
                if axes and not {1, 2, 3} <= axes:
                    self.model.leave_out(card, "a coupling of some directions alone: all are coupled")
                if card.name == "DISTRIBUTING":
                    open_one["turns"] = axes
            elif card.name == "RIGIDBODY" and card.get("REFNODE") and (card.get("NSET") or card.get("ELSET")):
                node = self.model.nodes_of(card, card.line, card.get("REFNODE"))[0]
                if card.get("NSET"):
                    nodes = self.model.nodes_of(card, card.line, card.get("NSET"))
                else:
                    nodes = [n for e in self.model.elements_of(card, card.line, card.get("ELSET")) for n in self.model.elements[e].nodes]
                body = {"name": card.get("NSET") or card.get("ELSET"), "nodes": nodes, "kind": "rigid", "card": card, "node": node}
                result.setdefault(node, []).append(body)
                if card.get("POSITION", "INPUT").upper() != "INPUT":
                    self.model.leave_out(card, f'POSITION={card.get("POSITION")}: the reference node stays where it is')
                if card.get("ROTNODE"):
                    turn = self.model.nodes_of(card, card.line, card.get("ROTNODE"))[0]
                    result[turn] = [{"rotation_of": node, "card": card}]
                self.coupling_cards.add(id(card))
            else:
                open_one = None
        return {node: self.joined(found) for node, found in result.items()}

    def joined(self, found):
        """One coupling of those that share a reference node: rigid ones of surfaces are one."""
        first = found[0]
        for other in found[1:]:
            if "surfaces" in first and "surfaces" in other and first["kind"] == other["kind"] == "rigid":
                first["surfaces"] += other["surfaces"]
            else:
                self.model.leave_out(other["card"], "its reference node has a coupling already")
        return first

    def make_coupled(self):
        self.deck_couplings = {}
        names = {}
        in_body = set().union(*(self.bodies.nodes_of_body(b) for b in range(len(self.bodies.bodies))))
        for node, coupling in self.couplings.items():
            if "rotation_of" in coupling:
                continue
            card = coupling["card"]
            if "surfaces" in coupling:
                boundary = self.boundary_of_all(card, coupling)
            else:
                nodes = [n for n in dict.fromkeys(coupling["nodes"]) if n != node]
                keys = self.bodies.faces_within(nodes)
                lost = {n for n in nodes if n in self.bodies.faces_of_node} - {n for key in keys for n in self.bodies.nodes(key)}
                boundary = self.add_boundary(coupling["name"], keys) if keys else None
                if not keys or lost:
                    self.model.leave_out(card, f"{len(lost) or 'the'} nodes of the rigid body span no whole outer face")
                self.report_rigid_inside(card, set(nodes), {n for key in keys for n in self.bodies.nodes(key)})
            if boundary is None:
                continue
            on = {n for key in self.boundaries[boundary] for n in self.bodies.nodes(key)}
            if node in in_body and not (coupling["kind"] == "rigid" and node in on):
                self.model.leave_out(card, "its reference node belongs to a solid, which does not follow it in the deck")
            name = unique(clean(coupling["name"]), self.names)
            names[node] = name
            self.deck_couplings[name] = {"boundary": boundary, "point": self.vector(self.model.points[node]), "kind": coupling["kind"]}
        turns = {n: c["rotation_of"] for n, c in self.couplings.items() if "rotation_of" in c}
        self.coupled_loads(names, turns)
        self.coupled_supports(names, turns)

    def boundary_of_all(self, card, coupling):
        """The faces of all surfaces of a coupling, as one boundary."""
        boundaries = [self.faces_of(card, card.line, surface.name) for surface in coupling["surfaces"]]
        if len(boundaries) == 1 or None in boundaries:
            return next((b for b in boundaries if b is not None), None)
        return self.add_boundary(coupling["surfaces"][0].name, [key for b in boundaries for key in self.boundaries[b]])

    def transmits(self, node, axis, entry):
        """Whether a coupling passes on what acts along this degree of freedom: distributing ones pass on moments that they name."""
        turns = self.couplings[node].get("turns")
        if turns is None or axis <= 3 or axis in turns:
            return True
        if turns:
            reason = f"degree of freedom {axis} is none of those that *DISTRIBUTING names: nothing is passed on"
            self.model.leave_out(entry.card, reason, entry.line, changes=entry.card.name == "CLOAD")
            return False
        reason = "*DISTRIBUTING names no degrees of freedom: Abaqus and the deck couple all, CalculiX moves the first three alone"
        self.model.leave_out(entry.card, reason, entry.line)
        return True

    def report_rigid_inside(self, card, rigid, held):
        """Rigid nodes inside of bodies follow the faces where the whole body is rigid, and not where a part of it is."""
        for b, body in enumerate(self.bodies.bodies):
            own = self.bodies.nodes_of_body(b)
            inside = (rigid & own) - held - set(self.bodies.faces_of_node)
            if inside and not own <= rigid:
                self.model.leave_out(
                    card, f'{len(inside)} rigid nodes lie inside of "{body.name}", of which other parts are elastic: the deck holds outer faces alone'
                )

    def coupled_loads(self, names, turns):
        groups = {}
        for (node, axis), (values, entry) in self.series("forces").items():
            owner = turns.get(node, node)
            if owner in names and any(values) and self.transmits(node, axis, entry):
                kind, a = ("moment", axis - 1 if node in turns else axis - 4) if node in turns or axis > 3 else ("force", axis - 1)
                if a > 2 or self.plane and (a == 2) != (kind == "moment"):
                    self.model.leave_out(entry.card, f"degree of freedom {axis} of a reference node", entry.line)
                    continue
                direction = self.direction(node, a, entry)
                if direction is None:
                    continue
                base = self.largest(values)
                course = tuple((v or 0.0) / base for v in values)
                groups.setdefault((owner, course), {}).setdefault(kind, np.zeros(3))[:] += base * direction
        for (owner, course), parts in groups.items():
            item = {"coupling": names[owner]}
            for kind, vector in parts.items():
                vector = vector / self.thickness
                item[kind] = self.vector(vector) if kind == "force" or not self.plane else [0.0, 0.0, float(vector[2])]
            self.add_load(item, f"load_{names[owner]}", course)

    def coupled_supports(self, names, turns):
        groups = {}
        for (node, axis), (values, entry) in self.along_model_axes(self.series("supports"), turns).items():
            owner = turns.get(node, node)
            if owner not in names or not self.transmits(node, axis, entry):
                continue
            rotation = node in turns or axis > 3
            a = axis - 1 if node in turns or axis <= 3 else axis - 4
            if a > 2 or self.plane and ((a == 2) != rotation):
                if any(values):
                    self.model.leave_out(entry.card, f"degree of freedom {axis} of a reference node", entry.line)
                continue
            base = self.largest(values)
            course = tuple(self.factors(values, base))
            key = (owner, course, tuple(v is not None for v in values))
            groups.setdefault(key, {}).setdefault("rotation" if rotation else "displacement", {})[AXES[a]] = base + 0.0
        for (owner, course, acting), parts in groups.items():
            name = self.name_of(f"held_{names[owner]}")
            self.supports.append(({"coupling": names[owner], **parts, "name": name}, name, course, acting))

    def along_model_axes(self, series, turns):
        """Motions of coupled points with axes of their own, where all three components are given; others are left out."""
        result, turned = {}, {}
        for (node, axis), found in series.items():
            if node not in self.transforms or turns.get(node, node) not in self.couplings:
                result[node, axis] = found
            else:
                turned.setdefault((node, (axis - 1) // 3), {})[(axis - 1) % 3] = found
        for (node, kind), parts in turned.items():
            rows = self.transforms[node].at(self.model.points[node])
            entry = next(iter(parts.values()))[1]
            needed = range(3) if not self.plane else (2,) if kind else range(2)
            acting = {tuple(v is not None for v in values) for values, _ in parts.values()}
            if rows is None or not set(needed) <= set(parts) or len(acting) > 1:
                self.model.leave_out(entry.card, "the point of a coupling is held along some of the axes of *TRANSFORM alone", entry.line)
                continue
            local = np.array([[np.nan if v is None else v for v in parts[a][0]] if a in parts else [0.0] * len(parts[needed[0]][0]) for a in range(3)])
            for a, values in enumerate(rows.T @ local):
                result[node, 3 * kind + a + 1] = ([None if np.isnan(v) else float(v) for v in values], entry)
        return result
