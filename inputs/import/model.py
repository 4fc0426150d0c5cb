"""The mesh of an input file: nodes, elements, sets and surfaces, parts and their instances in one assembly."""

import dataclasses
import math

import numpy as np

import elements
from reader import InputError, is_number

REFUSED = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "SUBMODEL", "PARAMETER", "IMPORT"}


@dataclasses.dataclass
class Finding:
    """A keyword that the deck has otherwise, or not at all. changes: whether that changes the answer."""

    file: object
    line: int
    keyword: str
    reason: str
    changes: bool


@dataclasses.dataclass
class SetDefinition:
    name: str
    items: list = dataclasses.field(default_factory=list)  # (card, line, scope or None, fields, generate)
    members: list | None = None
    all: list = dataclasses.field(default_factory=list)  # members, and those that are given more than once as often
    open: bool = False

    def orders(self):
        """The first and the last card that gives members."""
        return (self.items[0][0].order, self.items[-1][0].order) if self.items else (0, 0)


@dataclasses.dataclass
class Surface:
    name: str
    card: object
    scope: object
    nodal: bool
    items: list = dataclasses.field(default_factory=list)  # (card, line, fields)


@dataclasses.dataclass
class Element:
    number: int
    type: str
    nodes: list  # indices of Model.points
    card: object
    line: int
    scope: object
    shape: str = ""
    formulation: str = ""


class Scope:
    """Names and numbers of the assembly, of one part or of one of its instances."""

    def __init__(self, name=""):
        self.name = name
        self.nodes, self.elements = {}, {}
        self.node_sets, self.element_sets = {}, {}
        self.surfaces, self.node_surfaces = {}, {}  # one name may stand for one of each
        self.sections = []  # (card, scope)
        self.moves = []  # of an instance, one after the other: translations, and lines of `rotated`

    def placed(self, points):
        """Points of a part (n x 3) where this instance of it has them."""
        for move in self.moves:
            points = rotated(points, move) if len(move) == 7 else points + np.array((*move, 0, 0, 0)[:3])
        return points

    def placed_point(self, point):
        return self.placed(np.array([point], dtype=float))[0]

    def is_turned(self):
        return any(len(move) == 7 for move in self.moves)

    def turned(self, vector):
        """A direction of the part, likewise."""
        return self.placed_point(vector) - self.placed_point(np.zeros(3)) if self.is_turned() else vector

    def set_of(self, sets, name):
        return sets.setdefault(name.upper(), SetDefinition(name))


class Part:
    def __init__(self, name):
        self.name, self.cards = name, []


class Model:
    """`assembly` holds what stands outside of parts; `cards` are those that are no mesh, `steps` lists of cards."""

    def __init__(self):
        self.assembly = Scope()
        self.instances = {}
        self.points, self.elements = [], []
        self.cards, self.steps, self.findings = [], [], []
        self.plane_nodes = 0

    # Findings.
    def leave_out(self, card, reason, line=None, changes=True, keyword=None):
        self.findings.append(Finding(card.file, line or card.line, keyword or "*" + card.spelt, reason, changes))

    def note(self, card, reason, line=None):
        self.leave_out(card, reason, line, changes=False)

    # Nodes and elements by what a line calls them.
    def _scope(self, card, scope, word):
        """The scope and the rest of a word such as `Part-1-1.Set-1`."""
        if "." in word:
            instance, _, rest = word.partition(".")
            if instance.upper() in self.instances:
                return self.instances[instance.upper()], rest
        return scope, word

    def nodes_of(self, card, line, word, scope=None, repeated=False):
        """Indices of a node's number or of a set; repeated: as often as the set holds them."""
        scope, word = self._scope(card, scope or card.scope or self.assembly, word)
        if is_number(word):
            if int(word) not in scope.nodes:
                raise card.error(f"there is no node {word}", line)
            return [scope.nodes[int(word)]]
        return self._members(card, line, scope, scope.node_sets, word, self.nodes_of, "nodes", repeated)

    def elements_of(self, card, line, word, scope=None, repeated=False):
        scope, word = self._scope(card, scope or card.scope or self.assembly, word)
        if is_number(word):
            if int(word) not in scope.elements:
                raise card.error(f"there is no element {word}", line)
            return [scope.elements[int(word)]]
        return self._members(card, line, scope, scope.element_sets, word, self.elements_of, "elements", repeated)

    def _members(self, card, line, scope, sets, word, look_up, what, repeated):
        found = sets.get(word.upper())
        if found is None:
            if what == "nodes" and word.upper() in scope.node_surfaces:
                return self.nodes_of_surface(scope.node_surfaces[word.upper()])
            raise card.error(f'there is no set of {what} "{word}"', line)
        orders = found.orders()
        if orders[0] < card.order < orders[1]:
            self.leave_out(card, f'the set "{found.name}" has more members in lines below: all are taken; CalculiX takes those that it knows here', line)
        if found.members is None:
            if found.open:
                raise card.error(f'the set "{found.name}" holds itself', line)
            found.open, members = True, []
            for of_card, of_line, of_scope, words, generate in found.items:
                of_scope = of_scope or scope
                if words is None:  # one number, of *NODE or *ELEMENT
                    members.append(generate)
                elif generate:
                    members += self._generated(of_card, of_line, of_scope, words, what)
                else:
                    for w in words:
                        if not w:
                            continue
                        if what == "nodes" and of_card.get("ELSET") and of_card.name == "NSET":
                            members += dict.fromkeys(n for e in self.elements_of(of_card, of_line, w, of_scope) for n in self.elements[e].nodes)
                        else:
                            members += look_up(of_card, of_line, w, of_scope, repeated=True)
            found.members, found.all, found.open = list(dict.fromkeys(members)), members, False
        return found.all if repeated else found.members

    def often(self, card, line, name, members):
        """Members of a set or surface that are loaded as often as it holds them, as CalculiX does; it is listed, for Abaqus drops repeated ones."""
        more = len(members) - len(set(members))
        if more:
            self.leave_out(
                card,
                f'"{name}" holds {more} of its members more than once: they are loaded as often, as in CalculiX; Abaqus drops what is repeated. '
                "Give each once",
                line,
            )
        return members

    @staticmethod
    def _generated(card, line, scope, words, what):
        numbers = [card.number(w, line) for w in words]
        if len(numbers) < 2 or len(numbers) > 3 or numbers[1] < numbers[0] or numbers[2:] and numbers[2] < 1:
            raise card.error("expected first, last and step", line)
        known = scope.nodes if what == "nodes" else scope.elements
        first, last, step = (*numbers, 1)[:3]
        if last - first > 50 * step * max(1, len(known)):  # few of so many exist: no long loop over the others
            return [i for n, i in sorted(known.items()) if first <= n <= last and (n - first) % step == 0]
        return [known[n] for n in range(first, last + 1, step) if n in known]

    def surface(self, card, line, name, scope=None):
        scope, word = self._scope(card, scope or card.scope or self.assembly, name)
        for surfaces in (scope.surfaces, scope.node_surfaces):
            if word.upper() in surfaces:
                return surfaces[word.upper()]
        raise card.error(f'there is no surface "{name}"', line)

    def nodes_of_surface(self, surface):
        result = []
        for card, line, words in surface.items:
            result += self.nodes_of(card, line, words[0], surface.scope)
        return list(dict.fromkeys(result))

    def sides_of_surface(self, surface, repeated=False):
        """(element, face from 0, or None for all free ones) of a surface of element faces; repeated: as often as it holds them."""
        result = []
        for card, line, words in surface.items:
            label = words[1].upper() if len(words) > 1 else ""
            for e in self.elements_of(card, line, words[0], surface.scope, repeated):
                if self.elements[e].shape:
                    result.append((e, self.face_number(card, line, e, label)))
                else:
                    reason = f'the surface "{surface.name}" has faces of elements of type {self.elements[e].type}'
                    if not any(f.line == line and f.reason == reason for f in self.findings):
                        self.leave_out(card, reason, line)
        return result if repeated else list(dict.fromkeys(result))

    def face_number(self, card, line, e, label):
        if label == "":
            return None
        element = self.elements[e]
        of = elements.FACES.get(elements.family(element.shape), [])
        if len(label) != 2 or label[0] not in "SP" or not label[1].isdigit() or not 1 <= int(label[1]) <= len(of):
            raise card.error(f'element {element.number} ({element.type}) has no face "{label}"', line)
        return int(label[1]) - 1


def rotated(points, line):
    """Points turned about the axis through a and b by an angle in degrees; line: ax, ay, az, bx, by, bz, angle."""
    a, b, angle = np.array(line[:3]), np.array(line[3:6]), math.radians(line[6])
    axis = (b - a) / np.linalg.norm(b - a)
    x = points - a
    return a + x * math.cos(angle) + np.cross(axis, x) * math.sin(angle) + np.outer(x @ axis, axis) * (1 - math.cos(angle))


class Builder:
    """Reads the mesh cards into a Model."""

    MESH = ("NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "SOLIDSECTION")

    def __init__(self):
        self.model = Model()
        self.parts = {}
        self.deferred = []  # elements, whose nodes may be given later

    def build(self, cards):
        part = instance = step = None
        for card in cards:
            if card.name in REFUSED:
                raise card.error(f"*{card.name} is not understood: write all nodes and elements into the file")
            if card.name == "STEP":
                step = []
                self.model.steps.append(step)
            if step is not None:
                step.append(card)
                if card.name in ("NSET", "ELSET", "SURFACE"):
                    self.mesh_card(card, self.model.assembly, None)
                if card.name == "ENDSTEP":
                    step = None
            elif card.name == "PART":
                part = Part(card.need("NAME"))
                self.parts[part.name.upper()] = part
            elif card.name == "ENDPART":
                part = None
            elif part is not None:
                part.cards.append(card)
            elif card.name == "INSTANCE":
                instance = (card, [])
            elif card.name == "ENDINSTANCE":
                if instance is None:
                    raise card.error("there is no *INSTANCE before it")
                self.place(*instance)
                instance = None
            elif instance is not None:
                instance[1].append(card)
            elif card.name in ("ASSEMBLY", "ENDASSEMBLY"):
                pass
            elif card.name in self.MESH:
                self.mesh_card(card, self.model.assembly, None)
            else:
                self.model.cards.append(card)
        if instance is not None:
            raise instance[0].error("*INSTANCE has no *END INSTANCE")
        if self.parts and not self.model.instances:
            raise InputError("the parts of the file have no *INSTANCE")
        self.resolve_elements()
        return self.model

    def place(self, card, cards):
        name, part = card.need("NAME"), self.parts.get(card.need("PART").upper())
        if part is None:
            raise card.error(f'there is no *PART "{card.get("PART")}"')
        if name.upper() in self.model.instances:
            raise card.error(f'the instance "{name}" is given twice')
        scope = Scope(name)
        self.model.instances[name.upper()] = scope
        first = len(self.model.points)
        for own in (*part.cards, *cards):
            if own.name in self.MESH:
                self.mesh_card(own, scope, None)
            else:
                self.model.cards.append(dataclasses.replace(own, scope=scope))
        moves = [[card.value(w, line, 0.0) for w in words] for line, words in card.rows()]
        if any(len(m) not in (0, 1, 2, 3, 7) for m in moves) or len(moves) > 2:
            raise card.error("expected a line with a translation and one with a rotation (two points and an angle)")
        if any(len(m) == 7 and m[:3] == m[3:6] for m in moves):
            raise card.error("the two points of the axis of the rotation are the same")
        scope.moves = moves
        points = np.array(self.model.points[first:], dtype=float).reshape(-1, 3)
        self.model.points[first:] = scope.placed(points).tolist()

    def mesh_card(self, card, scope, _):
        if card.get("INSTANCE") and scope is self.model.assembly:
            of = self.model.instances.get(card.get("INSTANCE").upper())
            if of is None:
                raise card.error(f'there is no instance "{card.get("INSTANCE")}"')
        else:
            of = None
        if card.name == "NODE":
            self.read_nodes(card, scope)
        elif card.name == "ELEMENT":
            self.read_elements(card, scope)
        elif card.name in ("NSET", "ELSET"):
            sets = scope.node_sets if card.name == "NSET" else scope.element_sets
            definition = scope.set_of(sets, card.need(card.name))
            definition.members = None
            generate = "GENERATE" in card.parameters
            for line, words in card.rows():
                definition.items.append((card, line, of, words, generate))
            if card.name == "NSET" and card.get("ELSET") and not card.rows():
                definition.items.append((card, card.line, of, [card.get("ELSET")], False))
        elif card.name == "SURFACE":
            self.read_surface(card, scope)
        elif card.name == "SOLIDSECTION":
            scope.sections.append((card, scope))
            self.model.cards.append(card)

    def read_nodes(self, card, scope):
        system = card.get("SYSTEM", "R").upper()
        if system not in ("R", "C"):
            raise card.error(f"*NODE, SYSTEM={system} is not understood; expected R or C")
        definition = scope.set_of(scope.node_sets, card.get("NSET")) if card.get("NSET") else None
        points = self.model.points
        for line, words in card.rows():
            number = card.number(words[0], line)
            if number < 1 or len(words) > 7:
                raise card.error("expected the number of a node and its coordinates", line)
            x = [card.value(w, line, 0.0) for w in words[1:4]] + [0.0] * (4 - len(words))
            if system == "C":
                angle = math.radians(x[1])
                x = [x[0] * math.cos(angle), x[0] * math.sin(angle), x[2]]
            if number in scope.nodes:
                points[scope.nodes[number]] = x  # as both programs do, the last one counts
            else:
                scope.nodes[number] = len(points)
                points.append(x)
            if definition:
                definition.items.append((card, line, None, None, scope.nodes[number]))

    def read_elements(self, card, scope):
        name = card.need("TYPE").upper()
        kind = elements.kind(name)
        definition = scope.set_of(scope.element_sets, card.get("ELSET")) if card.get("ELSET") else None
        count, pending, begun = elements.NODES[kind.shape] if kind else None, [], 0
        if kind and kind.note:
            self.model.note(card, f"{name}: {kind.note}")
        for line, words in card.rows():
            numbers = [w for w in words if w]
            begun = begun if pending else line
            pending += [card.number(w, line) for w in numbers]
            if count and len(pending) <= count:
                continue
            if count and len(pending) > count + 1:
                raise card.error(f"element {pending[0]} has {len(pending) - 1} nodes, its type {name} needs {count}", begun)
            if pending[0] in scope.elements:
                raise card.error(f"element {pending[0]} is given twice", begun)
            element = Element(
                pending[0], name, pending[1:], card, begun, scope, kind.shape if kind else "", kind.formulation if kind else ""
            )
            scope.elements[pending[0]] = len(self.model.elements)
            self.model.elements.append(element)
            if definition:
                definition.items.append((card, line, None, None, scope.elements[pending[0]]))
            pending = []
        if pending:
            raise card.error(f"element {pending[0]} has {len(pending) - 1} nodes, its type {name} needs {count}", begun)

    def read_surface(self, card, scope):
        name, kind = card.need("NAME"), card.get("TYPE", "ELEMENT").upper()
        if kind not in ("ELEMENT", "NODE") or "COMBINE" in card.parameters:
            self.model.leave_out(card, f'the surface "{name}" ({card.get("COMBINE") or kind}) is not made of faces or nodes that are named')
            return
        surfaces = scope.node_surfaces if kind == "NODE" else scope.surfaces
        surface = surfaces.setdefault(name.upper(), Surface(name, card, scope, kind == "NODE"))
        surface.items += [(card, line, words) for line, words in card.rows() if words]

    def resolve_elements(self):
        """Numbers of nodes become indices."""
        for element in self.model.elements:
            known = element.scope.nodes
            for n in element.nodes:
                if n not in known and n != 0 and element.shape:
                    raise element.card.error(f"element {element.number} has the node {n}, which does not exist", element.line)
            element.nodes = [known.get(n, -1) for n in element.nodes]


def build(cards):
    return Builder().build(cards)
