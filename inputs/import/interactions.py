"""Contact: surface interactions, contact pairs, ties, cyclic symmetry."""

import numpy as np

from reader import InputError

CARDS = {
    "CONTACTPAIR",
    "SURFACEINTERACTION",
    "SURFACEBEHAVIOR",
    "FRICTION",
    "CLEARANCE",
    "TIE",
    "CYCLICSYMMETRYMODEL",
    "CONTACT",
    "CONTACTINCLUSIONS",
    "CONTACTPROPERTYASSIGNMENT",
    "GAPCONDUCTANCE",
    "GAPHEATGENERATION",
    "CONTACTDAMPING",
}


class Interactions:
    def __init__(self, model):
        self.model = model
        self.laws, self.contacts = {}, []
        self.clearances, self.cyclic = {}, {}
        current = None
        for card in model.cards:
            if card.name == "SURFACEINTERACTION":
                if card.need("NAME").upper() in self.laws:
                    raise card.error(f'the *SURFACE INTERACTION "{card.get("NAME")}" is given twice')
                current = self.laws.setdefault(card.get("NAME").upper(), {})
            elif card.name in ("SURFACEBEHAVIOR", "FRICTION", "GAPCONDUCTANCE", "GAPHEATGENERATION", "CONTACTDAMPING"):
                if current is None:
                    model.leave_out(card, "stands outside of a *SURFACE INTERACTION")
                else:
                    self.read_law(card, current)
            elif card.name == "CLEARANCE":
                self.read_clearance(card)
            elif card.name == "CYCLICSYMMETRYMODEL":
                self.read_cyclic(card)
        used = []  # cyclic models
        for card in model.cards:
            if card.name == "CONTACTPAIR":
                self.read_pair(card)
            elif card.name == "TIE":
                self.read_tie(card, used)
        for card in [c for c in model.cards if c.name == "CYCLICSYMMETRYMODEL"]:
            if self.cyclic[card.get("TIE").upper()] not in used:
                model.leave_out(card, "belongs to no *TIE, CYCLIC SYMMETRY")
        self.read_general()

    def read_law(self, card, law):
        if card.name in ("GAPCONDUCTANCE", "GAPHEATGENERATION", "CONTACTDAMPING"):
            self.model.note(card, "without influence on a static equilibrium at given temperatures")
            return
        if card.name == "FRICTION":
            self.read_friction(card, law)
            return
        kind = card.get("PRESSURE-OVERCLOSURE", "HARD").upper()
        if kind == "TIED":
            law["bonded"] = True
        if "NOSEPARATION" in card.parameters:
            self.model.leave_out(card, "NO SEPARATION: the sides may part in the deck")
        values = [card.value(w, line, 0.0) for line, words in card.rows()[:1] for w in words]
        if kind in ("LINEAR", "TIED") and values:
            law["stiffness"] = (values[0], card)
            if kind == "LINEAR" and len(values) > 1 and values[1] > 0:
                law["tension"] = (values[1], card)
        elif kind == "EXPONENTIAL" and len(values) > 1:
            law["clearance"] = (values[0], card)
        elif kind == "HARD" and {"PENALTY", "AUGMENTEDLAGRANGE"} & card.parameters.keys() and values and values[0] > 0:
            law["stiffness"] = (values[0], card)  # of Abaqus, then the clearance at which it begins
            if len(values) > 1 and values[1] > 0:
                law["clearance"] = (values[1], card)
        if kind == "TABULAR":
            self.model.leave_out(card, "PRESSURE-OVERCLOSURE=TABULAR: sides in contact do not overlap, whatever the table says")
        elif kind in ("LINEAR", "EXPONENTIAL", "TIED"):
            self.model.note(card, f"PRESSURE-OVERCLOSURE={kind}: sides in contact do not overlap at all, instead of by a penalty")
        elif kind != "HARD":
            self.model.leave_out(card, f"PRESSURE-OVERCLOSURE={kind}: sides in contact do not overlap")

    def read_friction(self, card, law):
        """The second number of a line is CalculiX's stick slope, and a rate of slip, without influence alone, for Abaqus where it has parameters."""
        rows = card.rows()
        if "ROUGH" in card.parameters:
            self.model.leave_out(card, "ROUGH: the deck has Coulomb's law; what never slips is bonded there")
            return
        if card.get("TAUMAX") or "ANISOTROPIC" in card.parameters or "USER" in card.parameters:
            self.model.leave_out(card, "TAUMAX, ANISOTROPIC and USER: the deck has Coulomb's law with one coefficient")
        if not rows or not rows[0][1]:
            return
        law["friction"] = card.value(rows[0][1][0], rows[0][0])
        if len(rows) > 1:
            self.model.leave_out(card, "a coefficient that depends on pressure, rate or temperature; the first line is taken")
        if "EXPONENTIALDECAY" in card.parameters:
            self.model.leave_out(card, "EXPONENTIAL DECAY: the static coefficient is taken")
        for key, relative in (("SLIPTOLERANCE", True), ("ELASTICSLIP", False)):
            if card.get(key):
                law["slip"] = (card.value(card.get(key), card.line), relative, card)
        slope = card.value(rows[0][1][1], rows[0][0], 0.0) if len(rows[0][1]) > 1 else 0.0
        if slope > 0 and not card.parameters:
            law["stick"] = (slope, card)
            self.model.note(card, f"a stick slope of {slope:g}: what sticks does not slide at all, instead of by a penalty")

    def read_clearance(self, card):
        key = (card.get("SLAVE").upper(), card.get("MASTER").upper())
        if not card.get("VALUE") or not all(key):
            self.model.leave_out(card, "expected SLAVE=, MASTER= and VALUE=")
            return
        value = card.value(card.get("VALUE"), card.line)
        if value < 0:
            self.model.leave_out(card, "a negative clearance: say it by `interference` of the contact")
        else:
            self.clearances[key] = (value, card)

    def read_cyclic(self, card):
        rows = card.rows()
        numbers = [card.value(w, line, 0.0) for line, words in rows[:1] for w in words]
        if len(numbers) != 6:
            raise card.error("expected two points on the axis")
        start, end = np.array(numbers[:3]), np.array(numbers[3:])
        n = card.number(card.need("N"), card.line)
        self.cyclic[card.get("TIE").upper()] = {"axis": (end - start).tolist(), "angle": f"360/{n}", "center": start.tolist()}

    def pair(self, card, line, words):
        if len(words) < 2:
            if len(words) == 1:
                self.model.leave_out(card, "a surface in contact with itself", line)
                return None
            raise card.error("expected the slave and the master surface", line)
        return {"card": card, "line": line, "secondary": words[0], "primary": words[1]}

    def read_pair(self, card):
        name = card.need("INTERACTION").upper()
        if name not in self.laws:
            raise card.error(f'there is no *SURFACE INTERACTION "{card.get("INTERACTION")}"')
        law = self.laws[name]
        for line, words in card.rows():
            contact = self.pair(card, line, words)
            if contact is None:
                continue
            contact["nodal"] = card.get("TYPE").upper().replace(" ", "") in ("", "NODETOSURFACE")
            adjust = card.get("ADJUST")
            if adjust:
                try:
                    value = card.value(adjust, card.line)
                except InputError:
                    contact["adjusted"] = self.model.nodes_of(card, card.line, adjust)
                else:
                    contact["adjust"] = value
            clearance = self.clearances.pop((words[0].upper(), words[1].upper()), None)
            if clearance:
                contact["clearance"] = clearance[0]
            self.give_law(contact, law)
            if "TIED" in card.parameters:
                contact["friction"], contact["tied_pair"] = {"bonded": True}, True
            self.contacts.append(contact)

    def read_tie(self, card, used):
        cyclic = "CYCLICSYMMETRY" in card.parameters
        if "MULTISTAGE" in card.parameters or "FLUIDPERIODIC" in card.parameters:
            self.model.leave_out(card, "MULTISTAGE and FLUID PERIODIC")
            return
        for line, words in card.rows():
            contact = self.pair(card, line, words)
            if contact is None:
                continue
            contact["name"], contact["friction"] = card.get("NAME"), {"bonded": True}
            if cyclic:
                found = self.cyclic.get(card.get("NAME").upper()) or self.cyclic.get("")
                if found is None:
                    self.model.leave_out(card, "has no *CYCLIC SYMMETRY MODEL", line)
                    continue
                contact["cyclic"] = found
                used.append(found)
            else:
                contact["tied"], contact["moves"] = True, card.get("ADJUST", "YES").upper() != "NO"
                if card.get("POSITIONTOLERANCE"):
                    contact["tolerance"] = card.value(card.get("POSITIONTOLERANCE"), card.line)
            self.contacts.append(contact)

    def read_general(self):
        """*CONTACT: with all exterior faces the entry that finds contacts, else pairs; each has the last property that is meant for it."""
        assigned = []  # (names of two surfaces, or none for all; name of the interaction; card; line)
        for card in [c for c in self.model.cards if c.name == "CONTACTPROPERTYASSIGNMENT"]:
            for line, words in card.rows():
                if len(words) != 3 or words[2].upper() not in self.laws:
                    raise card.error("expected two surfaces, or none, and a *SURFACE INTERACTION", line)
                assigned.append(({w.upper() for w in words[:2] if w}, words[2].upper(), card, line))
        used = set()
        for card in [c for c in self.model.cards if c.name == "CONTACTINCLUSIONS"]:
            if "ALLEXTERIOR" in card.parameters:
                contacts = [{"card": card, "line": card.line, "auto": True}]
            else:
                contacts = [pair for line, words in card.rows() if (pair := self.pair_of_inclusions(card, line, words))]
            for contact in contacts:
                contact["general"] = True
                names = {contact[side].upper() for side in ("secondary", "primary") if side in contact}
                for k, (of, name, _, _) in enumerate(assigned):
                    if not of or of == names:
                        used.add(k)
                        self.give_law(contact, self.laws[name])
            self.contacts += contacts
        general = [c for c in self.model.cards if c.name == "CONTACT"]
        if general and not any("ALLEXTERIOR" in c.parameters or c.rows() for c in self.model.cards if c.name == "CONTACTINCLUSIONS"):
            self.model.leave_out(general[0], "names no surfaces by *CONTACT INCLUSIONS: no contact is made of it")
        for k, (_, name, card, line) in enumerate(assigned):
            if k not in used:
                self.model.leave_out(card, f'"{name}" is meant for no contact that the deck has', line)

    def pair_of_inclusions(self, card, line, words):
        if len(words) == 2 and not all(words):
            self.model.leave_out(card, "a surface against all others; say ALL EXTERIOR, or both surfaces", line)
            return None
        return self.pair(card, line, words)

    @staticmethod
    def give_law(contact, law):
        contact.pop("friction", None)
        if law.get("bonded"):
            contact["friction"] = {"bonded": True}
        elif law.get("friction"):
            contact["friction"] = {"coulomb": law["friction"]}
        contact["law"] = law
