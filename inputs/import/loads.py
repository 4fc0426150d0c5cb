"""Loads on faces and bodies: pressures, tractions, accelerations, turning, temperatures."""

import numpy as np

import orthotropy
from bodies import clean


class Loads:
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
