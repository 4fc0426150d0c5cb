"""What acts at the end of each step: supports, forces, pressures, accelerations, temperatures."""

import dataclasses
import re

import numpy as np

from amplitudes import Amplitudes
from keywords import PROCEDURES, QUIET
from reader import is_number

FREE = {
    "ENCASTRE": (1, 2, 3),
    "PINNED": (1, 2, 3),
    "XSYMM": (1,),
    "YSYMM": (2,),
    "ZSYMM": (3,),
    "XASYMM": (2, 3),
    "YASYMM": (1, 3),
    "ZASYMM": (1, 2),
    "NOWARP": (),
    "NOOVAL": (),
    "NODEFORM": (),
}

NOT_READ = ("USER", "SUBMODEL", "SECTOR", "LOADCASE", "REGION", "TIMEDELAY", "FILE", "MASSFLOW", "BCASE", "FIXEDDOF")


@dataclasses.dataclass
class Entry:
    value: object
    hint: str  # name of the set or surface that it was given to; "" where numbers stand
    card: object
    line: int
    hints: tuple = ()  # of a support: all sets that say the same
    cards: tuple = ()  # that add up to the value, where there are several


@dataclasses.dataclass
class State:
    """Of one kept step. Keys: (node, axis), (element, face), (set, its elements), node."""

    name: str
    card: object
    supports: dict = dataclasses.field(default_factory=dict)
    forces: dict = dataclasses.field(default_factory=dict)
    pressures: dict = dataclasses.field(default_factory=dict)
    tractions: dict = dataclasses.field(default_factory=dict)
    accelerations: dict = dataclasses.field(default_factory=dict)
    turning: dict = dataclasses.field(default_factory=dict)  # (element, point, axis): speed squared
    temperatures: dict = dataclasses.field(default_factory=dict)
    locked: set = dataclasses.field(default_factory=set)  # nodes of *PRE-TENSION SECTION whose bolts keep their length

    TABLES = {
        "BOUNDARY": ("supports",),
        "CLOAD": ("forces",),
        "DLOAD": ("pressures", "tractions", "accelerations", "turning"),
        "DSLOAD": ("pressures", "tractions"),
        "TEMPERATURE": ("temperatures",),
    }


class History:
    """States of the static steps of a model; what else its steps hold goes to the model's findings."""

    def __init__(self, model, special):
        """special: nodes that are no part of the mesh (couplings, *PRE-TENSION SECTION)."""
        self.model, self.special = model, special
        self.amplitudes = Amplitudes([*model.cards, *(c for step in model.steps for c in step)])
        self.states, self.others = [], []
        self.initial = {}
        self.with_rotations = set()
        self.bent = []  # cards whose amplitude is no straight line
        self.followed = []  # cards whose amplitude goes on in the steps after theirs
        before = State("", None)
        for card in model.cards:
            if card.name == "BOUNDARY":
                for key in sorted({"AMPLITUDE", *NOT_READ} & card.parameters.keys()):
                    model.leave_out(card, f"{key} is not understood before the first step")
                self.read_supports(card, before, {}, 1.0)
        time, now = 0.0, before
        for number, cards in enumerate(model.steps, 1):
            now, time = self.step(number, cards, now, time)

    def step(self, number, cards, before, time):
        head = cards[0]
        procedure = next((c for c in cards if c.name in PROCEDURES), None)
        static = next((c for c in cards if c.name == "STATIC"), None)
        if procedure is not None or static is None or "PERTURBATION" in head.parameters:
            what = "a perturbation" if "PERTURBATION" in head.parameters else f"*{procedure.name}" if procedure else "without *STATIC"
            self.model.leave_out(head, f"step {number} is {what}: static equilibria alone are solved; all that the step holds is left out")
            return before, time
        if head.get("NLGEOM", "YES" if "NLGEOM" in head.parameters else "NO").upper() != "NO":
            self.model.leave_out(head, f"NLGEOM of step {number}: displacements and slip are taken as small", keyword="*STEP, NLGEOM")
        if "RIKS" in static.parameters:
            self.model.leave_out(static, "RIKS: loads reach their values")
        period = 1.0
        if static.rows() and len(static.rows()[0][1]) > 1:
            period = static.value(static.rows()[0][1][1], static.rows()[0][0], 1.0)
        now = State(
            head.get("NAME") or str(number),
            head,
            *(dict(getattr(before, t)) for t in ("supports", "forces", "pressures", "tractions", "accelerations", "turning", "temperatures")),
            set(before.locked),
        )
        first = {}
        for card in cards:
            if card.name in State.TABLES and first.setdefault(card.name, card) is card and card.get("OP").upper() == "NEW":
                self.clear(now, card)
        for card in cards:
            if card.get("OP").upper() == "NEW" and card.name in first and first[card.name].get("OP").upper() != "NEW":
                self.model.note(card, f"OP=NEW counts on the first *{card.spelt} of a step alone, as in CalculiX; Abaqus wants it on all of them")
        self.follow(now, time, time + period)
        touched = {}
        for card in cards:
            if card.name in State.TABLES:
                self.read(card, now, touched, time, time + period)
                if self.amplitudes.in_total_time(card):
                    self.followed.append(card)
            elif card.name not in QUIET:
                self.others.append(card)
        self.states.append(now)
        return now, time + period

    def follow(self, now, begin, end):
        """What steps before have loaded by an amplitude in total time goes on as that says."""
        for card in self.followed:
            later = State("", None)
            self.read(card, later, {}, begin, end)
            for table in State.TABLES[card.name]:
                own = getattr(now, table)
                for key, entry in getattr(later, table).items():
                    cards = own[key].cards or (own[key].card,) if key in own else ()
                    if cards == (card,):
                        own[key] = entry
                    elif card in cards:
                        self.model.leave_out(card, "adds to another load; its amplitude in total time is not followed in the steps after it")

    def clear(self, now, card):
        """Forgets loads or supports of the steps before. *DLOAD and *DSLOAD share tables, but each forgets its own."""
        for table in State.TABLES[card.name]:
            own = getattr(now, table)
            others = {c.spelt for e in own.values() for c in e.cards or (e.card,) if c.name != card.name}
            for key in [k for k, e in own.items() if e.card.name == card.name]:
                del own[key]
            if others:
                self.model.leave_out(
                    card, f"OP=NEW: loads of *{others.pop()} in steps before stay, as in Abaqus; CalculiX forgets them too, unless they are given again"
                )

    def read(self, card, now, touched, begin, end):
        factor = 1.0
        for key in NOT_READ:
            if key in card.parameters and not (key in ("LOADCASE", "SECTOR") and card.get(key) == "1"):
                self.model.leave_out(card, f"{key} is not understood")
                return
        if card.get("AMPLITUDE"):
            course = self.amplitudes.of(card, begin, end)
            if course is None:
                self.model.leave_out(card, f'the amplitude "{card.get("AMPLITUDE")}" is no table of factors (VALUE=ABSOLUTE is none)')
                return
            factor = course[1]
            if not course[2] or abs(course[0]) > 0:
                self.bent.append(card)
        if card.name == "BOUNDARY":
            self.read_supports(card, now, touched, factor)
        elif card.name == "CLOAD":
            self.read_forces(card, now, touched, factor)
        elif card.name == "TEMPERATURE":
            self.read_temperatures(card, now.temperatures, factor)
        elif card.name == "DLOAD":
            self.read_distributed(card, now, touched, factor)
        elif card.name == "DSLOAD":
            self.read_surface_loads(card, now, touched, factor)

    @staticmethod
    def add(table, touched, name, key, entry):
        """Within a step loads add, from step to step the new one replaces the old one."""
        if (name, key) in touched:
            old = table[key]
            value = old.value + entry.value if not isinstance(entry.value, tuple) else tuple(a + b for a, b in zip(old.value, entry.value))
            cards = (old.cards or (old.card,)) + (() if entry.card in (old.cards or (old.card,)) else (entry.card,))
            entry = Entry(value, old.hint, entry.card, entry.line, cards=cards)
        touched[name, key] = True
        table[key] = entry

    def read_supports(self, card, now, touched, factor):
        kind = card.get("TYPE", "DISPLACEMENT").upper()
        if kind != "DISPLACEMENT":
            self.model.leave_out(card, f"TYPE={kind}: displacements alone are prescribed")
            return
        fixed = "FIXED" in card.parameters
        for line, words in card.rows():
            nodes = self.model.nodes_of(card, line, words[0])
            hint = "" if is_number(words[0].split(".")[-1]) else words[0]
            word = words[1].upper() if len(words) > 1 else ""
            if not re.fullmatch(r"\d+", word):
                if word not in FREE:
                    raise card.error(f'expected a degree of freedom or one of {", ".join(FREE)}, found "{word}"', line)
                axes, value = FREE[word] + ((4, 5, 6) if word == "ENCASTRE" else ()), 0.0
                if not FREE[word]:
                    self.model.leave_out(card, f"{word} concerns pipes and shells", line)
            else:
                first = card.number(word, line)
                last = card.number(words[2], line) if len(words) > 2 and words[2] else first
                if first < 1:
                    raise card.error(f'expected a degree of freedom from 1 on, found "{word}"', line)
                axes = range(first, last + 1)
                value = factor * card.value(words[3] if len(words) > 3 else "", line, 0.0)
            for node in nodes:
                if node in self.special:
                    if fixed:
                        now.locked.add(node)
                        now.forces.pop((node, 1), None)
                        continue
                elif fixed:
                    self.model.leave_out(card, "FIXED: a node is held where it is, which the deck can do for tightened bolts alone", line)
                    break
                for axis in axes:
                    old = now.supports.get((node, axis))
                    before = old.hints if old is not None and old.value == value else ()
                    now.supports[node, axis] = Entry(value, hint, card, line, tuple(dict.fromkeys((*before, hint))))

    def read_forces(self, card, now, touched, factor):
        if "FOLLOWER" in card.parameters:
            self.model.leave_out(card, "FOLLOWER: forces keep their direction")
        for line, words in card.rows():
            if len(words) < 2:
                raise card.error("expected a node or a set, a direction and a value", line)
            hint = "" if is_number(words[0].split(".")[-1]) else words[0]
            axis = card.number(words[1], line)
            if axis < 1:
                raise card.error(f'expected a degree of freedom from 1 on, found "{words[1]}"', line)
            value = factor * card.value(words[2] if len(words) > 2 else "", line, 0.0)
            for node in self.model.often(card, line, words[0], self.model.nodes_of(card, line, words[0], repeated=True)):
                self.add(now.forces, touched, "force", (node, axis), Entry(value, hint, card, line))
                if node in self.special:
                    now.locked.discard(node)

    def read_temperatures(self, card, table, factor):
        for line, words in card.rows():
            if len(words) < 2:
                raise card.error("expected a node or a set and a temperature", line)
            if len(words) > 2:
                self.model.leave_out(card, "gradients over the thickness belong to shells and beams", line)
            for node in self.model.nodes_of(card, line, words[0]):
                table[node] = Entry(factor * card.value(words[1], line), words[0], card, line)

    def report_kept(self, card, line, touched, name, loaded, vector, hint):
        """GRAV that meets one of a step before with another direction or set: Abaqus replaces it, CalculiX keeps both."""
        for key, entry in loaded.items():
            aligned = np.dot(entry.value, vector) >= (1 - 1e-12) * np.linalg.norm(entry.value) * np.linalg.norm(vector)
            if (name, key) not in touched and any(entry.value) and not (aligned and entry.hint == hint):
                self.model.leave_out(
                    card,
                    "GRAV in another direction, or of another set, than in the step before: it replaces that one, as in Abaqus; CalculiX keeps both unless "
                    "OP=NEW stands here",
                    line,
                )
                return

    def read_distributed(self, card, now, touched, factor):
        axes_of = {}
        for key in now.turning:
            axes_of.setdefault(key[0], set()).add(key)
        for line, words in card.rows():
            if len(words) < 2:
                raise card.error("expected an element or a set, the label of a load and a value", line)
            label = words[1].upper()
            if label == "GRAV":
                numbers = [card.value(w, line, 0.0) for w in words[2:6]] + [0.0] * (6 - len(words))
                length = sum(g * g for g in numbers[1:]) ** 0.5
                if length == 0:
                    raise card.error("GRAV needs a direction", line)
                vector = tuple(factor * numbers[0] * g / length for g in numbers[1:])
                of = self.model.elements_of(card, line, words[0]) if words[0] else range(len(self.model.elements))
                self.report_kept(card, line, touched, "gravity", {e: now.accelerations[e] for e in of if e in now.accelerations}, vector, words[0])
                for e in of:
                    self.add(now.accelerations, touched, "gravity", e, Entry(vector, words[0], card, line))
            elif label == "CENTRIF":
                numbers = [card.value(w, line, 0.0) for w in words[2:9]] + [0.0] * (9 - len(words))
                length = sum(a * a for a in numbers[4:]) ** 0.5
                if length == 0:
                    raise card.error("CENTRIF needs a point of the axis and its direction", line)
                if factor * numbers[0] < 0:
                    raise card.error("CENTRIF takes the square of a speed, which is not negative", line)
                axis = (tuple(numbers[1:4]), tuple(a / length for a in numbers[4:]))
                of = self.model.elements_of(card, line, words[0]) if words[0] else range(len(self.model.elements))
                if any((e, *axis) != key for e in of for key in axes_of.get(e, ())):
                    self.model.leave_out(card, "CENTRIF about a second axis: it adds, from step to step as well; CalculiX takes the first one alone", line)
                for e in of:
                    axes_of.setdefault(e, set()).add((e, *axis))
                    self.add(now.turning, touched, "turning", (e, *axis), Entry(factor * numbers[0], words[0], card, line))
            elif re.fullmatch(r"P\d?", label):
                value = factor * card.value(words[2] if len(words) > 2 else "", line, 0.0)
                hint = "" if is_number(words[0].split(".")[-1]) else f"{words[0]}_{label}"
                for e in self.model.often(card, line, words[0], self.model.elements_of(card, line, words[0], repeated=True)):
                    if not self.model.elements[e].shape:
                        self.model.leave_out(card, f"element {self.model.elements[e].number} is no solid", line)
                        continue
                    if label == "P":
                        raise card.error("a pressure on a solid needs the number of its face: P1, P2, ...", line)
                    face = (e, self.model.face_number(card, line, e, label))
                    self.add(now.pressures, touched, "pressure", face, Entry(value, hint, card, line))
            else:
                self.model.leave_out(
                    card, f"{label}: the deck has pressures, tractions, uniform accelerations and turning", line, keyword=f"*DLOAD, {label}"
                )

    def read_surface_loads(self, card, now, touched, factor):
        for line, words in card.rows():
            label = words[1].upper() if len(words) > 1 else ""
            if label not in ("P", "TRVEC"):
                self.model.leave_out(
                    card, f"{label}: the deck has pressures and tractions along one vector", line, keyword=f"*DSLOAD, {label}"
                )
                continue
            surface = self.model.surface(card, line, words[0])
            value = factor * card.value(words[2] if len(words) > 2 else "", line, 0.0)
            if surface.nodal:
                raise card.error(f'the surface "{words[0]}" is one of nodes', line)
            if label == "TRVEC":
                direction = [card.value(w, line, 0.0) for w in words[3:6]] + [0.0] * (6 - len(words))
                length = sum(g * g for g in direction) ** 0.5
                if length == 0:
                    raise card.error("TRVEC needs a direction", line)
                value = tuple(value * g / length for g in direction)
                if card.get("FOLLOWER", "YES").upper() != "NO":
                    self.model.note(card, "the traction keeps its direction", line)
            table, name = (now.pressures, "pressure") if label == "P" else (now.tractions, "traction")
            for face in self.model.often(card, line, words[0], self.model.sides_of_surface(surface, repeated=True)):
                self.add(table, touched, name, face, Entry(value, words[0], card, line))
