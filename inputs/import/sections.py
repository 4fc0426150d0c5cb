"""The sections of the deck, from what the other files have found."""

import orthotropy
from bodies import clean, unique


class Sections:
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
        label, taken = {}, set()
        for m in used:
            label[m] = unique(clean(self.materials[m]["name"]), taken)
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
