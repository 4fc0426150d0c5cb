"""From a model and its history to a deck: what the sections of the deck say, and the boundaries that they name.

Each subject has a file with a class of its own; they share the members that Translation.__init__ sets.
"""

import history
import interactions
import materials
import pretension
import springs
import transforms
from adjusting import Adjusting
from bodies import Bodies, unique
from boundaries import Boundaries
from contacts import Contacts
from couplings import Couplings
from forces import Forces
from loads import Loads
from rest import Rest
from sections import Sections
from softness import Softness
from supports import Supports


class Translation(Boundaries, Supports, Forces, Loads, Contacts, Adjusting, Softness, Couplings, Sections, Rest):
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
        self.adjust()
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
        elif self.thickness != 1:
            sections = [s for own in (self.model.assembly, *self.model.instances.values()) for s, _ in own.sections]
            self.model.note(
                sections[0],
                f"a thickness of {self.thickness:g}: the deck and its results have forces and energies of a thickness 1, which are 1/{self.thickness:g} "
                "of the file's; displacements and stresses are the same",
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
