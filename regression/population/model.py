"""What families build their decks with: bodies of plane patches (extruded in 3D), materials, laws, supports, loads and contacts."""

import math

import numpy as np

import meshes
from meshes import Patch

BENDING = {"quad4", "hex8"}  # cells with the formulation `incompatible`
BBAR = {"quad4", "hex8", "prism6"}
HELD_BY_FRICTION = ("blocks", "chain", "punch", "wedge")  # families that may do without supports along z


class Model:
    """A deck that grows. plan: what the generator decided (family, kind, element, law, ...); scale: factor of all counts of cells."""

    def __init__(self, random, plan, scale):
        self.r, self.plan, self.scale = random, plan, scale
        self.kind, self.solid = plan["kind"], plan["kind"] == 3
        self.bodies, self.materials, self.entries = {}, {}, {}
        self.supports, self.loads, self.contacts = [], [], []
        self.blocks, self.boxes = {}, True
        self.files = {}
        self.mesh = None
        self.modulus = 10 ** random.uniform(3, 5.4)
        self.depth, self.layers = 1.0, 3
        self.both_faces = random.random() < 0.5
        self.sideways_free = random.random() < 0.4
        self.status = 0

    def n(self, base, low=1):
        return max(low, round(base * self.scale))

    @property
    def law(self):
        return self.plan["law"]

    @property
    def mu(self):
        return self.plan["mu"]

    @property
    def held(self):
        """Whether bodies must be held against sliding: without friction."""
        return self.law == "frictionless"

    def material(self, name, ratio=1.0, element=None, bend=False):
        """Young's modulus is `ratio` times that of the model, Poisson's ratio is the plan's where the cell can take it."""
        element, nu = element or self.plan["element"], self.plan["poisson"]
        entry = {"material": name}
        if nu > 0.42 and element not in meshes.SECOND and self.kind != "plane_stress":
            if element in BBAR:
                entry["formulation"] = "bbar"
            else:
                nu = 0.35
        elif element in BENDING and self.kind != "axisymmetric" and (bend or self.plan["incompatible"]):
            entry["formulation"] = "incompatible"
        self.materials[name] = {"young_modulus": float(f"{self.modulus * ratio:.6g}"), "poisson_ratio": nu}
        self.entries[name] = entry

    def add(self, name, patches, ratio=1.0, element=None, bend=False):
        """A body of plane patches, extruded along z in 3D, or of solid ones. In 3D its front, and its back if the model has both held, do not
        move along z, unless friction holds the body there."""
        element = element or self.plan["element"]
        self.boxes = False
        made = []
        for patch in patches:
            if self.solid and len(patch.knots) == 2:
                patch = meshes.extruded(patch, meshes.even(0, self.depth, self.n(self.layers)), f"{name}_front", f"{name}_back")
            made.append(patch)
        self.bodies[name] = meshes.Body(made, element)
        self.material(name, ratio, element, bend)
        free = self.sideways_free and not self.held and self.plan["family"] in HELD_BY_FRICTION
        for face in [f"{name}_front"] + [f"{name}_back"] * self.both_faces:
            if self.solid and face in self.bodies[name].faces and not free:
                self.hold(face, z=0)

    def block(self, name, origin, size, cells, ratio=1.0, element=None, bend=False, knots=None, sides=None):
        """A rectangle or box with boundaries NAME_left, _right, _bottom, _top (and _front, _back). Even ones may become blocks of the deck."""
        plain = knots is None and sides is None
        knots = knots or [meshes.even(0, 1, c) for c in cells]
        sides = {"xmin": f"{name}_left", "xmax": f"{name}_right", "ymin": f"{name}_bottom", "ymax": f"{name}_top", **(sides or {})}
        boxes = self.boxes
        self.add(name, [Patch(knots, meshes.box(origin, size), sides)], ratio, element, bend)
        self.boxes = boxes and plain
        third = ([0.0], [self.depth], [self.n(self.layers)]) if self.solid else ([], [], [])
        self.blocks[name] = {"origin": [float(x) for x in origin] + third[0], "size": [float(x) for x in size] + third[1], "cells": list(cells) + third[2],
                             "element": element or self.plan["element"]}

    def hold(self, boundary, **components):
        self.supports.append({"boundary": boundary, "displacement": components})

    def clamp(self, boundary, **components):
        """All components, zero where none is given."""
        self.hold(boundary, **{c: components.get(c, 0) for c in ("xyz" if self.solid else "xy")})

    def vector(self, x, y):
        return [x, y, 0.0] if self.solid else [x, y]

    def load(self, boundary, **what):
        self.loads.append({"boundary": boundary, **what})

    def pressed(self, secondary, primary, pressure, law=None, **more):
        """A contact under the plan's law; given slip bounds are a part of a pressure."""
        law = law or self.law
        if law == "tresca":
            more["friction"] = {"tresca": float(f"{self.plan['bound'] * pressure:.6g}")}
        elif law == "coulomb":
            more["friction"] = {"coulomb": self.mu}
        self.contacts.append({"name": f"contact_{len(self.contacts) + 1}", "secondary": secondary, "primary": primary, **more})

    def shear_limit(self, pressure):
        """Traction along a surface that the law allows beside this pressure."""
        return {"frictionless": 0.0, "tresca": self.plan["bound"] * pressure, "coulomb": self.mu * pressure}[self.law]

    def plane_obstacle(self, point, normal):
        return {"plane": {"point": [float(x) for x in point] + [0.0] * self.solid, "normal": [float(x) for x in normal] + [0.0] * self.solid}}

    def cylinder_obstacle(self, radius):
        return {"cylinder": {"point": [0.0] * (3 if self.solid else 2), **({"axis": [0.0, 0.0, 1.0]} if self.solid else {}), "radius": radius}}

    def unknowns(self):
        return sum(body.points.size for body in self.bodies.values())


def spread(random, decades):
    """A ratio of moduli, most of them moderate."""
    return 10 ** (random.choice([-1, 1]) * decades * random.random() ** 2)


def disc(radius, centre, cells, names, half=True, core=0.5):
    """Patches of a half disc (x >= 0), or a whole one: a square core and pieces round it. cells: along an eighth, along the radius."""
    eighth, along = cells
    c, (cx, cy) = core * radius / math.sqrt(2), centre
    low = 0.0 if half else -1.0
    wide = eighth if half else 2 * eighth
    square = Patch([meshes.even(low, 1, wide), meshes.even(-1, 1, 2 * eighth)], lambda s, t: [cx + c * s, cy + c * t],
                   {"xmin": names.get("cut")} if half else {})

    def piece(first, last, count, inner, sides):
        """From the core's edge to the arc between two angles."""
        def place(s, t):
            a = (first + (last - first) * s) * math.pi / 180
            x0, y0 = inner(s)
            return [cx + (1 - t) * x0 + t * radius * np.cos(a), cy + (1 - t) * y0 + t * radius * np.sin(a)]
        return Patch([meshes.even(0, 1, count), meshes.even(0, 1, along)], place, {"ymax": names.get("rim"), **sides})

    cut = names.get("cut")
    if half:
        return [square, piece(-90, -45, eighth, lambda s: (c * s, -c + 0 * s), {"xmin": cut}),
                piece(-45, 45, 2 * eighth, lambda s: (c + 0 * s, c * (2 * s - 1)), {}),
                piece(45, 90, eighth, lambda s: (c * (1 - s), c + 0 * s), {"xmax": cut})]
    return [square, piece(-135, -45, 2 * eighth, lambda s: (c * (2 * s - 1), -c + 0 * s), {}),
            piece(-45, 45, 2 * eighth, lambda s: (c + 0 * s, c * (2 * s - 1)), {}),
            piece(45, 135, 2 * eighth, lambda s: (c * (1 - 2 * s), c + 0 * s), {}),
            piece(135, 225, 2 * eighth, lambda s: (-c + 0 * s, c * (1 - 2 * s)), {})]


def sector(inner, outer, first, last, knots, sides, centre=(0.0, 0.0)):
    """A piece of a ring: the angle in degrees along x, the radius along y of the patch; knots from 0 to 1."""
    def place(s, t):
        a, r = (first + (last - first) * s) * math.pi / 180, inner + (outer - inner) * t
        return [centre[0] + r * np.cos(a), centre[1] + r * np.sin(a)]
    return Patch(knots, place, sides)


def bored(radius, half_side, cells, names):
    """Half (x >= 0) of a square plate with a bore at the origin. cells: along an eighth, along the radius."""
    eighth, along = cells
    w = half_side

    def piece(first, last, count, outer, sides):
        def place(s, t):
            a = (first + (last - first) * s) * math.pi / 180
            x1, y1 = outer(s)
            return [(1 - t) * radius * np.cos(a) + t * x1, (1 - t) * radius * np.sin(a) + t * y1]
        return Patch([meshes.even(0, 1, count), meshes.graded(0, 1, along, 4)], place, {"ymin": names["bore"], **sides})

    return [piece(-90, -45, eighth, lambda s: (w * s, -w + 0 * s), {"xmin": names["cut"], "ymax": names["bottom"]}),
            piece(-45, 45, 2 * eighth, lambda s: (w + 0 * s, w * (2 * s - 1)), {"ymax": names["right"]}),
            piece(45, 90, eighth, lambda s: (w * (1 - s), w + 0 * s), {"xmax": names["cut"], "ymax": names["top"]})]


def cap(radius, low, high, height, sign, knots, sides):
    """A block from x = low to high whose face at y = 0 is an arc that bulges towards -sign; the flat face is at y = sign * height."""
    def place(s, t):
        x = low + (high - low) * s
        surface = radius - np.sqrt(radius**2 - x**2)
        return [x, sign * (surface + t * (height - surface))]
    return Patch(knots, place, sides)


def solid_cap(radius, spans, height, sign, knots, sides, bulge=(True, True)):
    """The same in 3D, over x and z: a sphere's cap, or a cylinder's that is curved along one of them."""
    (x0, x1), (z0, z1) = spans

    def place(s, t, q):
        x, z = x0 + (x1 - x0) * s, z0 + (z1 - z0) * q
        surface = radius - np.sqrt(radius**2 - bulge[0] * x**2 - bulge[1] * z**2)
        return [x, sign * (surface + t * (height - surface)), z]
    return Patch(knots, place, sides)
