"""The bodies of a model, elements that hang together by faces, and their outer faces."""

import dataclasses

import numpy as np

import elements
from reader import InputError


@dataclasses.dataclass
class Body:
    name: str
    elements: list
    volumes: dict  # name of a physical volume -> (material, its elements)
    formulation: str = "standard"


class Bodies:
    """`outer` maps (element, face) of every outer face to its body; `face_at` finds the outer faces by their nodes."""

    def __init__(self, model, materials_of):
        """materials_of: element -> (material, name of its section's set)."""
        self.model = model
        self.solid = [i for i, e in enumerate(model.elements) if e.shape and i in materials_of]
        self.dimension = self._dimension()
        self.outer, self.body_of = {}, {}
        self._connect()
        self._name(materials_of)
        self.faces_of_node = {}
        for key in self.outer:
            for n in self.nodes(key):
                self.faces_of_node.setdefault(n, []).append(key)

    def _dimension(self):
        kinds = {elements.kind(self.model.elements[i].type).dimension for i in self.solid}
        if not kinds:
            raise InputError("the file has no solid elements with a *SOLID SECTION")
        if len(kinds) > 1:
            raise InputError(f"the file mixes elements of different kinds of models: {', '.join(sorted(kinds))}")
        return kinds.pop()

    def shape(self, key):
        return elements.face_nodes(self.model.elements[key[0]].shape, self.model.elements[key[0]].nodes, key[1])[0]

    def nodes(self, key):
        element = self.model.elements[key[0]]
        return elements.face_nodes(element.shape, element.nodes, key[1])[1]

    def corners(self, key):
        """Of a face, each once; in order."""
        element = self.model.elements[key[0]]
        own = elements.FACES[elements.family(element.shape)][key[1]]
        return list(dict.fromkeys(element.nodes[c] for c in own))

    def _connect(self):
        """Union of elements that share a face; faces that one element alone has are outer ones."""
        parent = {i: i for i in self.solid}

        def root(i):
            while parent[i] != i:
                parent[i] = parent[parent[i]]
                i = parent[i]
            return i

        least = 3 if self.dimension == "3" else 2
        seen = {}
        for i in self.solid:
            shape = self.model.elements[i].shape
            for f in range(len(elements.FACES[elements.family(shape)])):
                corners = self.corners((i, f))
                if len(corners) < least:
                    continue
                key = tuple(sorted(corners))
                other = seen.pop(key, None)
                if other is None:
                    seen[key] = (i, f)
                else:
                    parent[root(i)] = root(other[0])
        groups = {}
        for i in self.solid:
            groups.setdefault(root(i), []).append(i)
        self.groups = sorted(groups.values(), key=lambda group: group[0])
        for b, group in enumerate(self.groups):
            for i in group:
                self.body_of[i] = b
        self.outer = {key: self.body_of[key[0]] for key in seen.values()}

    def _name(self, materials_of):
        sets = {}
        for scope in (self.model.assembly, *self.model.instances.values()):
            for definition in scope.element_sets.values():
                members = self.model.elements_of(definition.items[-1][0], None, definition.name, scope) if definition.items else []
                sets.setdefault(frozenset(members), definition.name)
        self.bodies, taken = [], set()
        count = {}
        for group in self.groups:
            section = materials_of[group[0]][1]
            count[section] = count.get(section, 0) + 1
        numbers = {}
        for group in self.groups:
            section = materials_of[group[0]][1]
            numbers[section] = numbers.get(section, 0) + 1
            scopes = {self.model.elements[i].scope.name for i in group}
            instance = scopes.pop() if len(scopes) == 1 else ""
            of_instance = instance and sum({self.model.elements[i].scope.name for i in g} == {instance} for g in self.groups) == 1
            name = sets.get(frozenset(group)) if not instance else instance if of_instance else None
            if name is None:
                name = clean(section) if count[section] == 1 else f"{clean(section)}_{numbers[section]}"
            name = unique(clean(name), taken)
            volumes = {}
            for i in group:
                material, of = materials_of[i]
                volumes.setdefault((material, of), []).append(i)
            if len(volumes) == 1:
                own = {name: (materials_of[group[0]][0], group)}
            else:
                own = {unique(f"{name}_{clean(of)}", taken): (material, cells) for (material, of), cells in volumes.items()}
            self.bodies.append(Body(name, group, own))

    def shared_nodes(self):
        """Nodes of more than one body, which meet there without a common face."""
        owner, shared = {}, {}
        for b, body in enumerate(self.bodies):
            for i in body.elements:
                for n in self.model.elements[i].nodes:
                    first = owner.setdefault(n, b)
                    if first != b:
                        shared.setdefault((first, b), set()).add(n)
        return shared

    def nodes_of_body(self, b):
        return {n for i in self.bodies[b].elements for n in self.model.elements[i].nodes}

    def faces_within(self, nodes, bodies=None):
        """The outer faces all of whose nodes are among these, in the order of the elements."""
        nodes = set(nodes)
        keys = {key for n in nodes for key in self.faces_of_node.get(n, ())}
        found = [key for key in keys if set(self.nodes(key)) <= nodes and (bodies is None or self.outer[key] in bodies)]
        return sorted(found)

    def areas(self, key):
        """What a traction 1 on a face gives to each of its nodes: (nodes, values)."""
        nodes = self.nodes(key)
        shape = self.shape(key)
        if len(set(nodes)) < len(nodes):  # a brick that is a wedge: a quadrilateral that is a triangle
            corners = self.corners(key)
            if len(corners) != 3 or len(nodes) > 4:
                return None
            shape, nodes = "tri3", corners
        points = np.array([self.model.points[n] for n in nodes])
        return nodes, elements.nodal_areas(shape, points, self.dimension == "axisymmetric")


def clean(name):
    """A name without what the deck's patterns and gmsh's files give a meaning to."""
    return "".join("_" if c in ":*\"'\\" or c.isspace() else c for c in name)


def unique(name, taken):
    result, k = name, 2
    while result in taken:
        result, k = f"{name}_{k}", k + 1
    taken.add(result)
    return result
