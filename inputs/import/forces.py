"""Forces on nodes: uniform tractions of whole faces, or forces at points."""

import numpy as np

SAME_FORCES = 1e-3  # of the largest one: how far forces on nodes may be from those of a uniform traction
MOST_POINTS = 500  # with forces of their own that a deck lists


class Forces:
    def make_forces(self):
        groups = {}
        in_body = set().union(*(self.bodies.nodes_of_body(b) for b in range(len(self.bodies.bodies))))
        for (node, axis), (values, entry) in self.series("forces").items():
            if node in self.sections or node in self.couplings or not any(values):
                continue
            if node not in in_body:
                self.model.leave_out(entry.card, "a force on a node that belongs to no solid", entry.line)
                continue
            if axis > self.axes:
                self.model.leave_out(
                    entry.card,
                    f"degree of freedom {axis} of a solid's node has no force" if axis > 3 else "a force out of the plane",
                    entry.line,
                )
                continue
            direction = self.direction(node, axis - 1, entry)
            if direction is None:
                continue
            base = self.largest(values)
            course = tuple(round(v / base, 9) if v is not None else 0.0 for v in values)
            group = groups.setdefault((entry.hint, id(entry.card) if not entry.hint else 0, course), {})
            group.setdefault(node, (np.zeros(3), entry))[0][:] += base * direction
        merged = {}
        for (hint, card, course), forces in groups.items():
            if not self.try_force(hint, course, forces):
                merged.setdefault(course, []).append((hint, forces))
        for course, parts in merged.items():
            together = {}
            for hint, forces in parts:
                for n, (f, entry) in forces.items():
                    together.setdefault(n, (np.zeros(3), entry))[0][:] += f
            for nodes in self.patches(together):
                if self.try_force("", course, {n: together[n] for n in nodes}):
                    for n in nodes:
                        del together[n]
            for hint, forces in parts:
                left = {n: v for n, v in forces.items() if n in together}
                if left:
                    self.approximate_force(hint, course, left)

    def direction(self, node, axis, entry):
        """Of a force on a node, along its own axes; None if it is left out."""
        turned = self.transforms.get(node)
        if turned is None:
            return np.eye(3)[axis]
        rows = turned.at(self.model.points[node])
        if rows is None:
            self.model.leave_out(entry.card, "a force on the axis of *TRANSFORM, where radial means nothing", entry.line)
            return None
        return rows[axis]

    def patches(self, forces):
        """Loaded nodes that hang together by loaded faces."""
        groups = []
        for key in self.loaded_faces(forces):
            nodes = {n for n in self.bodies.nodes(key) if n in forces}
            for group in [g for g in groups if g & nodes]:
                groups.remove(group)
                nodes |= group
            groups.append(nodes)
        return groups

    def loaded_faces(self, forces):
        """Faces whose nodes with a share in a uniform traction are loaded: on triangles of second order the middle ones."""
        keys = {key for n in forces for key in self.bodies.faces_of_node.get(n, ())}
        result = []
        for key in sorted(keys):
            nodes = self.bodies.nodes(key)
            needed = nodes[3:] if self.bodies.shape(key) == "tri6" else nodes
            if set(needed) <= set(forces):
                result.append(key)
        return result

    def shares(self, keys):
        """Node -> its part of the area of faces; None where a face has no rule."""
        shares = {}
        for key in keys:
            own = self.bodies.areas(key)
            if own is None:
                return None
            for n, a in zip(*own):
                shares[n] = shares.get(n, 0.0) + a
        return shares

    def try_force(self, hint, course, forces):
        """Adds the forces if they are those of a uniform traction on whole faces."""
        keys = self.loaded_faces(forces)
        shares = self.shares(keys) if keys else None
        if not shares:
            return False
        total = sum(f for f, _ in forces.values())
        area = sum(shares.values())
        largest = max(np.abs(f).max() for f, _ in forces.values())
        for n in set(shares) | set(forces):
            own = forces[n][0] if n in forces else np.zeros(3)
            if np.abs(own - total * shares.get(n, 0.0) / area).max() > SAME_FORCES * largest:
                return False
        self.add_force(hint, course, keys, total)
        return True

    def add_force(self, hint, course, keys, total):
        boundary = self.add_boundary(hint or "loaded", keys)
        self.add_load({"boundary": boundary, "force": self.vector(total / self.thickness)}, f"force_{boundary}", course)

    def approximate_force(self, hint, course, forces):
        entry = next(iter(forces.values()))[1]
        total = sum(f for f, _ in forces.values())
        what = f"forces on {len(forces)} node{'s' * (len(forces) > 1)}{f' of {hint}' if hint else ''}, ({', '.join(f'{v:.6g}' for v in total)}) in all"
        if len(forces) <= MOST_POINTS and self.bodies.dimension != "axisymmetric" and set(forces) <= set(self.bodies.faces_of_node):
            self.add_point_forces(hint, course, forces)
            return
        keys = self.loaded_faces(forces)
        covered = {n for key in keys for n in self.bodies.nodes(key)}
        if keys and set(forces) <= covered and np.abs(total).max() > 0:
            self.add_force(hint, course, keys, total)
            self.model.leave_out(
                entry.card, f"{what}: not those of a uniform traction; the deck spreads their resultant evenly over the faces", entry.line
            )
        else:
            self.model.leave_out(entry.card, f"{what}: they span no whole outer faces, and are too many or not on a surface for forces on points", entry.line)

    def add_point_forces(self, hint, course, forces):
        """Forces on nodes as they are, those that are alike together."""
        body_of = {n: b for b in range(len(self.bodies.bodies)) for n in self.bodies.nodes_of_body(b)}
        groups = {}
        for n, (f, _) in sorted(forces.items()):
            groups.setdefault((body_of[n], tuple(self.vector(f))), []).append(n)
        for (body, f), nodes in groups.items():
            total = len(nodes) * np.array(f) / self.thickness
            item = {"points": self.places(nodes), "body": self.bodies.bodies[body].name, "force": self.vector(total)}
            self.add_load(item, f"force_{hint or 'points'}", course)

    def vector(self, v):
        return [float(f"{c:.12g}") + 0.0 for c in list(v)[: self.axes]]

    def add_load(self, item, name, course):
        name = self.name_of(name)
        self.loads.append((dict(item, name=name), name, course))
