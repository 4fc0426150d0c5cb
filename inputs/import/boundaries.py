"""The boundaries of a deck: outer faces of bodies, by their names."""

from bodies import clean, unique


class Boundaries:
    def add_boundary(self, name, keys):
        """A name for these faces: that of a boundary that has them already, or a new one like `name`."""
        keys = tuple(sorted(set(keys)))
        for known, faces in self.boundaries.items():
            if faces == keys:
                return known
        name = unique(clean(name), self.names)
        self.boundaries[name] = keys
        return name

    def expand(self, sides):
        """Outer faces of sides; (element, None) are all of an element's."""
        result, lost = [], 0
        for side in sides:
            if side[1] is None:
                result += [key for key in self.element_faces(side[0]) if key in self.bodies.outer]
            elif side in self.bodies.outer:
                result.append(side)
            else:
                lost += 1
        return sorted(set(result)), lost

    def element_faces(self, e):
        return [(e, f) for f in range(6)]

    def surfaces(self):
        """Those of the file that are outer faces become boundaries, under their names."""
        inner = {id(s["card"]): s for s in self.sections.values()}
        cuts = {c["name"].upper() for c in inner.values()}
        for scope in (self.model.assembly, *self.model.instances.values()):
            for surface in scope.surfaces.values():
                if surface.name.upper() in cuts:
                    continue
                keys, lost = self.expand(self.model.sides_of_surface(surface))
                if keys and not lost:
                    self.add_boundary(f"{scope.name}.{surface.name}" if scope.name else surface.name, keys)

    def faces_of(self, card, line, name):
        """Boundary of a surface that a contact names, or None; node surfaces are the faces between their nodes."""
        surface = self.model.surface(card, line, name)
        if surface.nodal:
            nodes = self.with_copies(self.model.nodes_of_surface(surface))
            keys = self.bodies.faces_within(nodes)
            lost = set(nodes) - {n for key in keys for n in self.bodies.nodes(key)}
            if not keys:
                self.model.leave_out(card, f'the nodes of the surface "{name}" hold no whole face of a body', line)
                return None
            if lost:
                self.model.leave_out(
                    card, f'{len(lost)} of the {len(nodes)} nodes of the surface "{name}" belong to no face that it holds', line
                )
        else:
            keys, lost = self.expand(self.model.sides_of_surface(surface))
            if not keys:
                self.model.leave_out(card, f'the surface "{name}" has no outer face of a solid', line)
                return None
            if lost:
                self.model.leave_out(card, f'{lost} faces of the surface "{name}" are no outer faces of a solid', line)
        return self.add_boundary(name, keys)

    def with_copies(self, nodes):
        copies = getattr(self.model, "copies", {})
        return list(nodes) + [copies[n] for n in nodes if n in copies]
