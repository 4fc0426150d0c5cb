"""From a model and its history to a deck: what the sections of the deck say, and the boundaries that they name."""

import numpy as np

import history
import interactions
import materials
import orthotropy
import pretension
import springs
import transforms
from bodies import Bodies, clean, unique
from model import rotated
from reader import InputError

AXES = ("x", "y", "z")
MODEL_CARDS = {"SOLIDSECTION", "AMPLITUDE", "BOUNDARY", "INITIALCONDITIONS", "PRE-TENSIONSECTION", "ORIENTATION", "SURFACE"}
COUPLINGS = {"COUPLING", "DISTRIBUTING", "KINEMATIC", "DISTRIBUTINGCOUPLING", "RIGIDBODY"}
SAME_FORCES = 1e-3  # of the largest one: how far forces on nodes may be from those of a uniform traction
SOFT, VISIBLE = 0.3, 0.02  # how far a law of contact gives way, in parts of what the bodies do: no penalty any more; worth a word
FAR = 1e-4  # of that size: clearances at which exponential contact begins to press
MOST_POINTS = 500  # with forces of their own that a deck lists


class Translation:
    def __init__(self, model, schema, title, stem):
        """stem: what names of files beside the deck begin with."""
        self.model, self.schema, self.stem = model, schema, stem
        self.temperatures = {}  # body -> (its number, field -> node -> change), for files
        self.boundaries, self.names = {}, set()
        self.deck = {"title": title}
        self.materials, done = materials.read_materials(model)
        of, thickness, used = materials.read_sections(model, self.materials)
        self.without_section(of)
        solid = [i for i, e in enumerate(model.elements) if e.shape and i in of]
        self.sections = pretension.apply(model, solid)
        self.bodies = Bodies(model, of)
        self.springs, of_springs, of_cards = springs.read(model, self.bodies)
        done |= of_cards
        for i, e in enumerate(model.elements):
            if not e.shape and i not in of_springs and not e.type.upper().startswith("DASHPOT"):
                model.leave_out(e.card, f"elements of type {e.type}: the deck has solids alone")
        self.drop_repeated()
        self.plane = self.bodies.dimension != "3"
        self.axes = 2 if self.plane else 3
        self.set_thickness(of, thickness)
        self.report_hinges()
        self.couplings = self.find_couplings()
        special = set(self.sections) | set(self.couplings)
        self.history = history.History(model, special)
        self.interactions = interactions.Interactions(model)
        self.transforms = self.read_transforms()
        self.used = used
        self.surfaces()
        self.supports, self.loads, self.contacts = [], [], []
        self.make_supports()
        self.make_forces()
        self.make_face_loads("pressures", "pressure")
        self.make_face_loads("tractions", "traction")
        self.make_accelerations()
        self.make_turning()
        self.make_temperatures()
        self.make_contacts()
        self.make_preloads()
        self.make_coupled()
        self.report_rest(done)
        self.assemble()

    # What the file holds beside the mesh.
    def drop_repeated(self):
        """One finding for each card, not for each element."""
        seen, kept = set(), []
        for f in self.model.findings:
            key = (f.file, f.line, f.reason)
            if key not in seen:
                seen.add(key)
                kept.append(f)
        self.model.findings[:] = kept

    def without_section(self, of):
        lost = {}
        for i, e in enumerate(self.model.elements):
            if e.shape and i not in of:
                lost.setdefault(id(e.card), (e.card, []))[1].append(e.number)
        for card, numbers in lost.values():
            self.model.leave_out(card, f"{len(numbers)} elements, the first of which is {numbers[0]}, have no *SOLID SECTION")

    def set_thickness(self, of, thickness):
        self.thickness = 1.0
        if self.bodies.dimension not in ("plane_strain", "plane_stress"):
            return
        values = {thickness[i] for i in self.bodies.solid}
        self.thickness = max(values)
        if len(values) > 1:
            card = self.model.elements[self.bodies.solid[0]].card
            self.model.leave_out(
                card, f"sections of different thickness ({', '.join(f'{v:g}' for v in sorted(values))}): the deck has one, 1"
            )

    def report_hinges(self):
        for (a, b), nodes in self.bodies.shared_nodes().items():
            first, second = self.bodies.bodies[a], self.bodies.bodies[b]
            element = self.model.elements[second.elements[0]]
            self.model.leave_out(
                element.card,
                f'"{first.name}" and "{second.name}" share {len(nodes)} nodes but no face: in the deck they are apart',
                element.line,
            )

    def read_transforms(self):
        """Node -> its axes, of those that a model of this kind has; the others are left out."""
        result, used = {}, set()
        for n, axes in transforms.read(self.model).items():
            if axes.fits(self.plane, self.bodies.dimension == "axisymmetric"):
                result[n] = axes
            elif axes.name not in used:
                self.model.leave_out(axes.card, "axes out of the plane of the model")
            used.add(axes.name)
        return result

    def report_rest(self, done):
        known = history.QUIET | interactions.CARDS | MODEL_CARDS | {"TRANSFORM"}
        for card in self.model.cards:
            if id(card) in done or card.name in known or card.name in COUPLINGS and id(card) in self.coupling_cards:
                continue
            self.leave_out(card)
        for card in self.history.others:
            self.leave_out(card)
        for value, card in self.interactions.clearances.values():
            self.model.leave_out(card, "there is no *CONTACT PAIR of these surfaces")
        if not self.model.steps:
            self.model.leave_out(
                self.model.cards[-1] if self.model.cards else self.model.elements[0].card,
                "the file has no *STEP: the deck has no loads",
                keyword="end of the file",
            )
        elif not self.history.states:
            self.model.leave_out(self.model.steps[0][0], "no step of the file is *STATIC: the deck has no loads")
        if self.history.bent and any("coulomb" in c.get("friction", {}) for c in self.contacts):
            for card in self.history.bent:
                self.model.leave_out(
                    card, "AMPLITUDE: with friction the way matters; the deck goes straight to the value at the end of the step"
                )
        for e in self.used:
            material = self.materials[e]
            shapes = {self.model.elements[i].shape for i in self.bodies.solid}
            if material.get("poisson_ratio", 0) >= 0.45 and shapes & {"hex8", "quad4", "prism6"}:
                self.model.note(
                    material["card"],
                    f'nearly incompressible: Abaqus averages volumes in such cells; `formulation: bbar` of the bodies of "{material["name"]}" does so',
                )

    REASONS = {
        "EQUATION": "the deck has no equations between displacements",
        "MPC": "the deck has no equations between displacements",
        "COUPLING": "the deck has no couplings to a point",
        "KINEMATIC": "the deck has no couplings to a point",
        "DISTRIBUTING": "the deck has no couplings to a point",
        "DISTRIBUTINGCOUPLING": "weights of nodes; couplings of the deck weigh by area: *COUPLING with *DISTRIBUTING",
        "RIGIDBODY": "the deck has no rigid bodies but obstacles of contacts",
        "EMBEDDEDELEMENT": "the deck has no embedded elements",
        "MODELCHANGE": "contacts and elements of the deck are there in every step",
        "CHANGEFRICTION": "the deck has one law a contact for all steps",
        "FRICTION": "belongs to *CHANGE FRICTION",
        "SURFACEBEHAVIOR": "belongs to *CHANGE SURFACE BEHAVIOR",
        "CHANGESURFACEBEHAVIOR": "the deck has one law a contact for all steps",
        "CHANGEMATERIAL": "materials do not change",
        "CONTACTINTERFERENCE": "overlaps act in every step; say it by `interference` of the contact and its factors in `steps`",
        "PRE-TENSIONSECTION": "",
        "CFLUX": "there is no flow of heat",
        "DFLUX": "there is no flow of heat",
        "FILM": "there is no flow of heat",
        "RADIATE": "there is no flow of heat",
        "GAP": "the deck has contact of surfaces alone",
    }

    def leave_out(self, card):
        if card.name == "DASHPOT":
            self.model.note(card, "without influence on a static equilibrium")
            return
        if card.name in materials.OTHER_SECTIONS:
            self.model.leave_out(card, "the deck has solids alone")
        elif card.name in ("CFLUX", "DFLUX", "FILM", "RADIATE", "VIEWFACTOR", "COUPLEDHEAT"):
            self.model.note(card, "without influence on a static equilibrium at given temperatures")
        elif card.name in history.HARMLESS:
            self.model.note(card, "without influence on a static equilibrium")
        else:
            self.model.leave_out(card, self.REASONS.get(card.name, "the deck has nothing like it, or this program does not know it"))

    # Boundaries.
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

    # Items of the deck with their values over the steps.
    def series(self, table):
        """key -> (values over the states or None where it does not act, the entry that says most)."""
        result = {}
        states = self.history.states
        for s, state in enumerate(states):
            for key, entry in getattr(state, table).items():
                values, _ = result.setdefault(key, ([None] * len(states), entry))
                values[s] = entry.value
                result[key] = (values, entry)
        return result

    @staticmethod
    def largest(values):
        return max((v for v in values if v is not None), key=abs)

    def name_of(self, wanted):
        self.item_names = getattr(self, "item_names", set())
        return unique(wanted, self.item_names)

    # Supports.
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

    # Forces on nodes.
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

    # Loads on faces and bodies.
    def make_face_loads(self, table, key):
        groups = {}
        for (e, face), (values, entry) in self.series(table).items():
            if not any(np.any(v) for v in values if v is not None):
                continue
            course = tuple(values)
            groups.setdefault((course, entry.hint), ([], entry))[0].append((e, face))
        for (course, hint), (sides, entry) in groups.items():
            keys, lost = self.expand(sides)
            if lost:
                self.model.leave_out(entry.card, f"{lost} loaded faces are no outer faces of a solid", entry.line)
            if not keys:
                continue
            boundary = self.add_boundary(hint or "loaded", keys)
            if key == "pressure":
                base = self.largest(course)
                factors = tuple(0.0 if v is None else v / base for v in course)
                self.add_load({"boundary": boundary, key: base}, f"pressure_{boundary}", factors)
            else:
                self.add_vector({"boundary": boundary}, key, f"traction_{boundary}", course, entry)

    def add_vector(self, item, key, name, course, entry):
        base = max((v for v in course if v is not None), key=lambda v: np.linalg.norm(v))
        factors = []
        for v in course:
            factor = 0.0 if v is None else float(np.dot(v, base) / np.dot(base, base))
            if v is not None and np.linalg.norm(np.array(v) - factor * np.array(base)) > 1e-9 * np.linalg.norm(base):
                for s, own in enumerate(course):  # the direction changes: one load for each step
                    if own is not None and np.any(own):
                        self.add_load(dict(item, **{key: self.vector(own)}), name, tuple(float(s == k) for k in range(len(course))))
                return
            factors.append(factor)
        if self.plane and abs(base[2]) > 1e-12 * np.linalg.norm(base):
            self.model.leave_out(entry.card, "a load out of the plane", entry.line)
        self.add_load(dict(item, **{key: self.vector(base)}), name, tuple(factors))

    def whole_bodies(self, series, values_of, what):
        """(body, values, entry) of bodies all of whose members have the same; others are left out."""
        told = set()
        for b, body in enumerate(self.bodies.bodies):
            members = values_of(b)
            own = {m: series[m] for m in members if m in series}
            acting = {m: v for m, v in own.items() if any(np.any(x) for x in v[0] if x is not None)}
            if not acting:
                continue
            entry = next(iter(acting.values()))[1]
            courses = {tuple(v[0]) for v in own.values()}
            if len(own) == len(members) and len(courses) == 1:
                yield body, courses.pop(), entry
            elif (id(entry.card), entry.line, body.name) not in told:
                told.add((id(entry.card), entry.line, body.name))
                self.model.leave_out(entry.card, f'{what} is not the same all over the body "{body.name}"', entry.line)

    def make_accelerations(self):
        series = self.series("accelerations")
        for body, course, entry in self.whole_bodies(series, lambda b: self.bodies.bodies[b].elements, "the acceleration"):
            if any("density" not in self.materials[m] for m, _ in body.volumes.values()):
                self.model.leave_out(entry.card, f'the material of "{body.name}" has no *DENSITY: no weight', entry.line, changes=False)
                continue
            self.add_vector({"body": body.name}, "acceleration", f"weight_{body.name}", course, entry)

    def make_turning(self):
        series = self.series("turning")
        for axis in sorted({key[1:] for key in series}):
            own = {key[0]: value for key, value in series.items() if key[1:] == axis}
            (x, _, z), direction = axis
            across = direction[0], direction[2 if self.bodies.dimension == "axisymmetric" else 1]
            for body, course, entry in self.whole_bodies(own, lambda b: self.bodies.bodies[b].elements, "the speed"):
                if any("density" not in self.materials[m] for m, _ in body.volumes.values()):
                    self.model.leave_out(entry.card, f'the material of "{body.name}" has no *DENSITY: no centrifugal force', entry.line, changes=False)
                    continue
                if self.plane and (any(across) or (self.bodies.dimension == "axisymmetric" and (x or z))):
                    self.model.leave_out(entry.card, "the axis of CENTRIF is not the one that a model of this kind turns about", entry.line)
                    continue
                base = self.largest(course)
                turning = {"axis": list(direction), "point": list(axis[0]), "speed": float(f"{base**0.5:.12g}")}
                self.add_load({"body": body.name, "centrifugal": turning}, f"turning_{body.name}", tuple((v or 0.0) / base for v in course))

    def make_temperatures(self):
        initial = {}
        for card in [c for c in self.model.cards if c.name == "INITIALCONDITIONS"]:
            kind = card.get("TYPE").upper()
            if kind != "TEMPERATURE":
                self.model.leave_out(card, f"TYPE={kind}", changes=kind not in ("VELOCITY", "FLUIDVELOCITY", "TOTALPRESSURE"))
                continue
            for line, words in card.rows():
                value = card.value(words[1] if len(words) > 1 else "", line, 0.0)
                for n in self.model.nodes_of(card, line, words[0]):
                    initial[n] = value
        changes = {}
        states = self.history.states
        for n, (values, entry) in self.series("temperatures").items():
            base = initial.get(n, 0.0)
            changes[n] = ([0.0 if v is None else v - base for v in values], entry)
        if any(any(values) for values, _ in changes.values()):
            for material in [self.materials[m] for m in self.used if not orthotropy.expands(self.materials[m])]:
                self.model.note(material["card"], f'"{material["name"]}" has no *EXPANSION: its temperature changes nothing')
        for n, copy in getattr(self.model, "copies", {}).items():
            if n in changes:
                changes[copy] = changes[n]
        expanding = {
            b
            for b, body in enumerate(self.bodies.bodies)
            if any(orthotropy.expands(self.materials[m]) for m, _ in body.volumes.values())
        }
        of_body = {b: [n for n in self.bodies.nodes_of_body(b)] for b in expanding}
        for n in list(changes):
            if not any(changes[n][0]):
                changes[n] = ([0.0] * len(states), changes[n][1])
        for n in set().union(*of_body.values()) if of_body else ():
            if n not in changes and changes:
                changes[n] = ([0.0] * len(states), next(iter(changes.values()))[1])
        for b, nodes in of_body.items():
            name = self.bodies.bodies[b].name
            courses = {tuple(changes[n][0]) for n in nodes if n in changes}
            if not any(any(course) for course in courses):
                continue
            if len(courses) == 1:
                (course,) = courses
                base = self.largest(course)
                self.add_load({"body": name, "temperature_change": base}, f"warmth_{name}", tuple(v / base for v in course))
            else:
                self.add_temperatures(name, b, {n: np.array(changes[n][0]) for n in nodes})

    def add_temperatures(self, name, b, values):
        """Of a body whose nodes are not alike: a file of their changes, for each state one field, or one for all that it is a multiple of."""
        table = np.array(list(values.values()))
        base = table[:, np.argmax(np.abs(table).max(axis=0))]
        factors = base @ table / (base @ base)
        if np.abs(table - np.outer(base, factors)).max() <= 1e-12 * np.abs(table).max():
            fields, courses = [base], [tuple(factors)]
        else:
            states = [s for s in range(table.shape[1]) if table[:, s].any()]
            fields, courses = [table[:, s] for s in states], [tuple(float(s == k) for k in range(table.shape[1])) for s in states]
        names = [f"warmth_{k + 1}" for k in range(len(fields))]
        self.temperatures[name] = (b, {field: dict(zip(values, own)) for field, own in zip(names, fields)})
        for field, course in zip(names, courses):
            file = {"file": self.file_of_temperatures(name), "field": field}
            self.add_load({"body": name, "temperature_change": file}, f"warmth_{name}", course)

    def file_of_temperatures(self, body):
        return f"{self.stem}.{clean(body)}.vtu"

    # Contacts.
    def make_contacts(self):
        for contact in self.interactions.contacts:
            card, line = contact["card"], contact["line"]
            item = {}
            if contact.get("auto"):
                item["auto"] = True
                sides = None
            else:
                sides = [self.faces_of(card, line, contact[side]) for side in ("secondary", "primary")]
                if None in sides:
                    continue
                item["secondary"], item["primary"] = sides
            own = [{self.bodies.outer[key] for key in self.boundaries[s]} for s in sides] if sides else [set(), set()]
            if own[0] & own[1] and "cyclic" not in contact:
                names = ", ".join(self.bodies.bodies[b].name for b in sorted(own[0] & own[1]))
                self.model.leave_out(card, f"both sides belong to one body ({names}): bodies of the deck do not touch themselves", line)
                continue
            if "law" in contact:
                self.report_soft(contact["law"], own)
            if contact.get("name"):
                item["name"] = self.name_of(clean(contact["name"]))
            if contact.get("adjust") == 0:
                self.model.note(card, "ADJUST=0: Abaqus removes initial overlaps, the deck takes them as they are", line)
                del contact["adjust"]
            if "adjusted" in contact:
                self.adjust_nodes(contact, sides[0])
            for key in ("friction", "cyclic", "adjust", "clearance"):
                if key in contact:
                    item[key] = contact[key]
            if contact.get("tied"):
                if contact.get("tolerance"):
                    item["search_distance"] = contact["tolerance"]
            elif "cyclic" in contact:
                item["cyclic"] = self.turned_right(contact["cyclic"], sides)
            elif sides:
                distance = self.far_apart(sides)
                if distance:
                    item["search_distance"] = distance
            self.contacts.append(item)

    def adjust_nodes(self, contact, secondary):
        """ADJUST with a set moves its nodes onto the other side: of a whole side that is a contact without gaps."""
        nodes = {n for key in self.boundaries[secondary] for n in self.bodies.nodes(key)}
        if nodes <= set(contact["adjusted"]):
            contact.setdefault("clearance", 0)
            self.model.note(contact["card"], "ADJUST: nodes stay where they are; the contact takes its gaps for 0")
        else:
            self.model.leave_out(contact["card"], "ADJUST with a set of some of the slave's nodes: nodes are not moved")

    def report_soft(self, law, sides):
        """Laws of contact that give way, beside the bodies that they press on: not a penalty but a spring."""
        size = min(
            max(np.ptp([self.model.points[n] for n in self.bodies.nodes_of_body(b)], axis=0).max() for b in side) for side in sides
        )
        young = min(
            self.stiffness_of(m) for side in sides for b in side for m, _ in self.bodies.bodies[b].volumes.values()
        )
        if "stiffness" in law:
            value, card = law["stiffness"]
            part = young / (value * size) if value > 0 else 1.0
            if part > VISIBLE:
                text = f"{value:g} an area and length gives way by some {100 * part:.2g} % of what a body of {size:.3g} and Young's modulus {young:.3g} does"
                self.model.leave_out(card, text + ": contact of the deck gives way by nothing", changes=part > SOFT)
        if "clearance" in law and law["clearance"][0] > FAR * size:
            value, card = law["clearance"]
            self.model.leave_out(card, f"pressure from a clearance of {value:g} on, beside bodies of {size:.3g}: contact of the deck begins at 0")

    def stiffness_of(self, m):
        material = self.materials[m]
        return material["young_modulus"] if "young_modulus" in material else min(material["orthotropic"]["young_modulus"])

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

    # Bolts.
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

    # Couplings to points.
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
                open_one = {
                    "name": card.get("CONSTRAINTNAME") or "coupling",
                    "surface": surface,
                    "kind": "rigid",
                    "card": card,
                    "node": node,
                }
                result[node] = open_one
                self.coupling_cards.add(id(card))
            elif card.name in ("KINEMATIC", "DISTRIBUTING") and open_one:
                self.coupling_cards.add(id(card))
                open_one["kind"] = "rigid" if card.name == "KINEMATIC" else "distributing"
                axes = {a for line, words in card.rows() for a in range(card.number(words[0], line), card.number(words[-1], line) + 1)}
                if axes and not {1, 2, 3} <= axes:
                    self.model.leave_out(card, "a coupling of some directions alone: all are coupled")
            elif card.name == "RIGIDBODY" and card.get("REFNODE") and (card.get("NSET") or card.get("ELSET")):
                node = self.model.nodes_of(card, card.line, card.get("REFNODE"))[0]
                if card.get("NSET"):
                    nodes = self.model.nodes_of(card, card.line, card.get("NSET"))
                else:
                    nodes = [n for e in self.model.elements_of(card, card.line, card.get("ELSET")) for n in self.model.elements[e].nodes]
                result[node] = {"name": card.get("NSET") or card.get("ELSET"), "nodes": nodes, "kind": "rigid", "card": card, "node": node}
                if card.get("ROTNODE"):
                    turn = self.model.nodes_of(card, card.line, card.get("ROTNODE"))[0]
                    result[turn] = {"rotation_of": node, "card": card}
                self.coupling_cards.add(id(card))
            else:
                open_one = None
        return result

    def make_coupled(self):
        self.deck_couplings = {}
        names = {}
        for node, coupling in self.couplings.items():
            if "rotation_of" in coupling:
                continue
            card = coupling["card"]
            if "surface" in coupling:
                boundary = self.faces_of(card, card.line, coupling["surface"].name)
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
            name = unique(clean(coupling["name"]), self.names)
            names[node] = name
            self.deck_couplings[name] = {"boundary": boundary, "point": self.vector(self.model.points[node]), "kind": coupling["kind"]}
        turns = {n: c["rotation_of"] for n, c in self.couplings.items() if "rotation_of" in c}
        self.coupled_loads(names, turns)
        self.coupled_supports(names, turns)

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
            if owner in names and any(values):
                kind, a = ("moment", axis - 1 if node in turns else axis - 4) if node in turns or axis > 3 else ("force", axis - 1)
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
            if owner not in names:
                continue
            rotation = node in turns or axis > 3
            a = axis - 1 if node in turns or axis <= 3 else axis - 4
            if self.plane and ((a == 2) != rotation):
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

    # The deck.
    def steps(self):
        states = self.history.states
        result = []
        names = set()
        for s, state in enumerate(states):
            step, scale, on, off = {"name": unique(clean(state.name), names)}, {}, [], []
            for _, name, course in self.loads:
                before = course[s - 1] if s else 1.0
                if course[s] != before:
                    scale[name] = course[s]
            for _, name, course, acting in self.supports:
                known = [c for c in course[:s] if c is not None]
                before = known[-1] if known else 1.0
                if course[s] is not None and course[s] != before:
                    scale[name] = course[s]
                if acting[s] != (acting[s - 1] if s else True):
                    (on if acting[s] else off).append(name)
            for item in self.contacts:
                course = item.get("course")
                if course and course[s] is not None and (s or course[s] != 1.0):
                    scale[item["name"]] = course[s]
            for key, value in (("scale", scale), ("off", off), ("on", on)):
                if value:
                    step[key] = value
            result.append(step)
        return result

    def assemble(self):
        deck = self.deck
        deck["dimension"] = self.bodies.dimension if self.plane else 3
        used = [m for m in self.materials if m in self.used]
        deck["materials"] = {}
        label = {}
        for m in used:
            label[m] = clean(self.materials[m]["name"])
            material = deck["materials"][label[m]] = {
                k: self.materials[m][k]
                for k in ("young_modulus", "poisson_ratio", "density", "thermal_expansion")
                if k in self.materials[m]
            }
            if "orthotropic" in self.materials[m]:
                material["orthotropic"] = dict(self.materials[m]["orthotropic"])
            if "axes" in self.materials[m]:
                name, axes = self.materials[m]["axes"]
                if self.plane:
                    axes = orthotropy.in_plane(axes, self.bodies.dimension == "axisymmetric")
                    if axes is None:
                        self.model.leave_out(self.materials[m]["card"], f'"{name}": directions out of the plane of the model')
                        continue
                deck.setdefault("axes", {})[clean(name)] = axes
                material["orthotropic"]["axes"] = clean(name)
        deck["bodies"] = {}
        for body in self.bodies.bodies:
            if len(body.volumes) == 1:
                entry = {"material": label[next(iter(body.volumes.values()))[0]]}
            else:
                entry = {"volumes": {name: label[m] for name, (m, _) in body.volumes.items()}}
            formulation = self.formulation(body)
            if formulation != "standard":
                entry["formulation"] = formulation
            deck["bodies"][body.name] = entry
        if self.deck_couplings:
            deck["couplings"] = self.deck_couplings
        steps = self.steps() if len(self.history.states) > 1 else []
        if not steps and self.history.states:
            single = self.steps()[0]
            scale = single.get("scale", {})
            if any(value != 1.0 for value in scale.values()) or "off" in single:
                steps = [single]
        deck["springs"] = {
            clean(name): {
                **spring,
                "points": [self.vector(self.model.points[n]) for n in spring["points"]],
                "stiffness": spring["stiffness"] / self.thickness,
            }
            for name, spring in self.springs.items()
        }
        deck["supports"] = [item for item, *_ in self.supports]
        deck["loads"] = [item if steps else {k: v for k, v in item.items() if k != "name"} for item, *_ in self.loads]
        deck["contacts"] = [{k: v for k, v in item.items() if k != "course"} for item in self.contacts]
        deck["steps"] = steps
        self.drop_repeated()
        self.model.findings.sort(key=lambda f: (str(f.file), f.line))

    def formulation(self, body):
        found = {}
        shapes = {self.model.elements[i].shape for i in body.elements}
        for i in body.elements:
            found.setdefault(self.model.elements[i].formulation, i)
        wanted = [f for f in found if f != "standard"]
        if not wanted:
            return "standard"
        if wanted[0] == "bbar" and any("orthotropic" in self.materials[m] for m, _ in body.volumes.values()):
            self.model.note(self.model.elements[found["bbar"]].card, f'the orthotropic body "{body.name}" has full integration')
            return "standard"
        fits = {"incompatible": {"hex8", "quad4"}, "bbar": {"hex8", "quad4", "prism6"}}[wanted[0]]
        if len(found) > 1 and not shapes <= fits or not shapes <= fits:
            self.model.note(
                self.model.elements[found[wanted[0]]].card, f'the body "{body.name}" has other cells as well: full integration of all'
            )
            return "standard"
        if len(found) > 1:
            self.model.note(self.model.elements[found[wanted[0]]].card, f'the body "{body.name}" has one formulation: {wanted[0]}')
        return wanted[0]
