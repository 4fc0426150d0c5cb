"""What holds the model: supports of boundaries and of points."""

from reader import InputError
from transforms import AXES


class Supports:
    def make_supports(self):
        in_body = set().union(*(self.bodies.nodes_of_body(b) for b in range(len(self.bodies.bodies))))
        groups, odd = {}, {}
        copies = getattr(self.model, "copies", {})
        for (node, axis), (values, entry) in self.series("supports").items():
            if node in self.sections or node in self.couplings:
                continue
            if node not in in_body:
                odd.setdefault((id(entry.card), entry.line, "nodes that belong to no solid: nothing is held there", False), entry)
                continue
            if axis > self.axes:
                if axis == 3 and any(values):
                    odd.setdefault((id(entry.card), entry.line, "a displacement out of the plane", True), entry)
                elif axis == 11:
                    odd.setdefault((id(entry.card), entry.line, "a temperature is no unknown here", False), entry)
                elif axis > 6:
                    odd.setdefault((id(entry.card), entry.line, f"degree of freedom {axis}", True), entry)
                elif axis > 3 and any(values):
                    odd.setdefault((id(entry.card), entry.line, "a rotation of a solid's node", True), entry)
                continue
            key = (tuple(values), axis - 1, self.transforms.get(node))
            group = groups.setdefault(key, {})
            for n in (node, copies[node]) if node in copies else (node,):
                for hint in entry.hints:
                    group.setdefault(hint, {})[n] = entry
        for (_, _, reason, changes), entry in odd.items():
            self.model.leave_out(entry.card, reason, entry.line, changes=changes)
        groups = self.along_any_axes(groups)
        found = {}  # (boundary, acting, axes) -> {axis: values}
        uncovered = {}
        for (values, axis, turned), by_hint in groups.items():
            every = {n: e for entries in by_hint.values() for n, e in entries.items()}
            covered = set()
            rest = set(self.bodies.faces_within(every))
            for hint, entries in by_hint.items():
                keys = self.bodies.faces_within(entries) if hint else []
                if keys:
                    self.hold(found, self.add_boundary(hint, keys), axis, values, turned)
                    rest -= set(keys)
                    covered |= {n for key in keys for n in self.bodies.nodes(key)}
            if rest:
                self.hold(found, self.add_boundary("held", sorted(rest)), axis, values, turned)
                covered |= {n for key in rest for n in self.bodies.nodes(key)}
            left = {n: e for n, e in every.items() if n not in covered}
            for n, e in left.items():
                uncovered.setdefault((n, axis, turned), (values, e))
        self.report_uncovered(uncovered, found)
        for (boundary, acting, turned), axes in found.items():
            displacement = {}
            for axis, values in sorted(axes.items()):
                base = self.largest(values)
                displacement.setdefault(tuple(self.factors(values, base)), {})[self.component(axis, turned)] = base + 0.0
            for course, components in displacement.items():
                name = self.name_of(boundary)
                item = {"boundary": boundary, **self.named_axes(turned), "displacement": components}
                if name != boundary:
                    item["name"] = name
                self.supports.append((item, name, course, acting))

    @staticmethod
    def factors(values, base):
        return [None if v is None else 1.0 if base == 0 else v / base for v in values]

    def named_axes(self, turned):
        """What a support says of its axes; they become an entry of the deck."""
        if turned is None:
            return {}
        self.deck.setdefault("axes", {})[turned.name] = turned.entry(self.plane)
        return {"axes": turned.name}

    @staticmethod
    def component(axis, turned):
        return AXES[axis] if turned is None else turned.component(axis)

    @staticmethod
    def hold(found, boundary, axis, values, turned):
        acting = tuple(v is not None for v in values)
        axes = found.setdefault((boundary, acting, turned), {})
        if axis in axes and axes[axis] != values:
            raise InputError(f'the boundary "{boundary}" has two displacements along {AXES[axis]}')
        axes[axis] = values

    def along_any_axes(self, groups):
        """Nodes that are held at 0 along all axes are so along those of the model."""
        held = {}
        for (values, axis, turned), by_hint in groups.items():
            for n in set().union(*by_hint.values()):
                if turned is not None and not any(values):
                    held.setdefault((n, values), set()).add(axis)
        result = {}
        for (values, axis, turned), by_hint in groups.items():
            for hint, entries in by_hint.items():
                for n, entry in entries.items():
                    fixed = len(held.get((n, values), ())) == self.axes
                    key = (values, axis, None if fixed else turned)
                    result.setdefault(key, {}).setdefault(hint, {})[n] = entry
        return result

    def report_uncovered(self, uncovered, found):
        """Nodes that are held but lie on no face that is: inside a body that is held all over they change nothing."""
        implied = {}
        for (boundary, acting, turned), axes in found.items():
            nodes = {n for key in self.boundaries[boundary] for n in self.bodies.nodes(key)}
            for axis, values in axes.items():
                for n in nodes:
                    implied.setdefault((n, axis, turned), set()).add(values)
        surface = set(self.bodies.faces_of_node)
        quiet = self.quiet_bodies(implied)
        body_of = {n: b for b in range(len(self.bodies.bodies)) for n in self.bodies.nodes_of_body(b)}
        told, alone = {}, {}
        for (n, axis, turned), (values, entry) in uncovered.items():
            if values in implied.get((n, axis, turned), ()) or n not in surface and body_of[n] in quiet and not any(values):
                continue
            if n in surface and (n, axis, turned) not in implied:
                alone.setdefault((n, turned), {})[axis] = values
                continue
            told.setdefault((id(entry.card), entry.line), (entry, {}))[1].setdefault(axis, set()).add(n)
        merged = {}
        for entry, axes in told.values():
            key = (id(entry.card), tuple(sorted(axes))) if not entry.hint else (id(entry.card), entry.line, entry.hint)
            old = merged.setdefault(key, (entry, {}))[1]
            for axis, nodes in axes.items():
                old.setdefault(axis, set()).update(nodes)
        self.hold_points(alone, body_of)
        for entry, axes in merged.values():
            nodes = set().union(*axes.values())
            x = self.model.points[min(nodes)]
            what = f'of "{entry.hint}" ' if entry.hint else ""
            self.model.leave_out(
                entry.card,
                f"{len(nodes)} node{'s' * (len(nodes) > 1)} {what}held along {', '.join(AXES[a] for a in sorted(axes))}, "
                f"as at ({x[0]:.6g}, {x[1]:.6g}, {x[2]:.6g}), lie inside a body, or are held otherwise by a boundary: the deck holds boundaries and "
                "nodes of surfaces",
                entry.line,
            )

    def hold_points(self, alone, body_of):
        """Nodes of surfaces that are held, but no face with them, as the 3-2-1 rule has it: supports on points."""
        groups = {}
        for (n, turned), axes in sorted(alone.items(), key=lambda item: item[0][0]):
            groups.setdefault((body_of[n], tuple(sorted(axes.items())), turned), []).append(n)
        for (body, axes, turned), nodes in groups.items():
            displacement = {}
            for axis, values in axes:
                base = self.largest(values)
                acting = tuple(v is not None for v in values)
                displacement.setdefault((tuple(self.factors(values, base)), acting), {})[self.component(axis, turned)] = base + 0.0
            for (course, acting), components in displacement.items():
                item = {"points": self.places(nodes), "body": self.bodies.bodies[body].name, **self.named_axes(turned), "displacement": components}
                name = self.name_of("points")
                self.supports.append((dict(item, name=name), name, list(course), acting))

    def places(self, nodes):
        return [self.vector(self.model.points[n]) for n in nodes]

    def quiet_bodies(self, implied):
        """Bodies that are held at 0 all over their surface, without weight and temperature: nothing moves inside."""
        if any(state.accelerations or state.turning or state.temperatures for state in self.history.states):
            return set()
        result = set()
        zero = {tuple(0.0 for _ in self.history.states)}
        for b in range(len(self.bodies.bodies)):
            nodes = {n for key, of in self.bodies.outer.items() if of == b for n in self.bodies.nodes(key)}
            if all(implied.get((n, a, None), set()) & zero for n in nodes for a in range(self.axes)):
                result.add(b)
        return result
