"""What a file has beside: cards that the deck has no counterpart for, each with the reason."""

import interactions
import keywords
import materials

MODEL_CARDS = {"SOLIDSECTION", "AMPLITUDE", "BOUNDARY", "INITIALCONDITIONS", "PRE-TENSIONSECTION", "ORIENTATION", "SURFACE"}
COUPLINGS = {"COUPLING", "DISTRIBUTING", "KINEMATIC", "DISTRIBUTINGCOUPLING", "RIGIDBODY"}
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


class Rest:
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

    def report_hinges(self):
        for (a, b), nodes in self.bodies.shared_nodes().items():
            first, second = self.bodies.bodies[a], self.bodies.bodies[b]
            element = self.model.elements[second.elements[0]]
            self.model.leave_out(
                element.card,
                f'"{first.name}" and "{second.name}" share {len(nodes)} nodes but no face: in the deck they are apart',
                element.line,
            )

    def report_rest(self, done):
        known = keywords.QUIET | interactions.CARDS | MODEL_CARDS | {"TRANSFORM"}
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

    def leave_out(self, card):
        if card.name == "DASHPOT":
            self.model.note(card, "without influence on a static equilibrium")
            return
        if card.name in materials.OTHER_SECTIONS:
            self.model.leave_out(card, "the deck has solids alone")
        elif card.name in ("CFLUX", "DFLUX", "FILM", "RADIATE", "VIEWFACTOR", "COUPLEDHEAT"):
            self.model.note(card, "without influence on a static equilibrium at given temperatures")
        elif card.name == "NONSTRUCTURALMASS" and any(s.accelerations or s.turning for s in self.history.states):
            self.model.leave_out(card, "mass beside that of materials, which has weight and is turned")
        elif card.name in keywords.HARMLESS:
            self.model.note(card, "without influence on a static equilibrium")
        else:
            self.model.leave_out(card, REASONS.get(card.name, "the deck has nothing like it, or this program does not know it"))
