"""Families of round bodies: cylinders, spheres, rings, pins, fits, belts, rollers, and meshes of gmsh round a curved face."""

import math

import meshes
from meshes import even, graded, graded_both
from model import bored, cap, disc, sector, solid_cap, spread


def drive(m, top, soft, depth, half, width):
    """Presses a round body by a motion that may have a part along the surface, or by a load where it is held sideways."""
    if half and m.r.random() < 0.6:
        m.load(top, pressure=m.modulus * soft * depth / width)
        return
    if half:
        m.hold(top, y=-depth)
    else:
        m.clamp(top, y=-depth, x=depth * m.r.uniform(0, 1.5))


def cylinder(m):
    """A cylinder's segment on a block, a rigid plane, another segment or in a hollow of larger radius."""
    r = m.r
    m.depth = r.uniform(0.3, 1.0)
    radius, height = 1.0, r.uniform(0.5, 0.8)
    half = m.held or r.random() < 0.3
    wide, ratio = r.uniform(0.3, 0.6), r.choice([3, 10, 30, 100])
    low = 0.0 if half else -wide
    counts = [m.n(r.randint(10, 20)) * (1 if half else 2), m.n(r.randint(6, 12))]

    def knots(count):
        return [graded(0, 1, count[0], ratio) if half else graded_both(0, 1, count[0], ratio), graded(0, 1, count[1], ratio / 2)]
    m.add("upper", [cap(radius, low, wide, height, 1, knots(counts), {"xmin": "upper_left", "ymin": "upper_face", "ymax": "upper_top"})])
    stiff = spread(r, m.plan["decades"])
    base = r.choice(["block", "plane", "segment", "hollow"])
    primary, soft = "lower_face", min(1.0, stiff)
    if base == "plane":
        primary, soft = m.plane_obstacle([0, 0], [0, 1]), 1.0
    else:
        other = [max(2, round(c * r.uniform(0.6, 1.3))) for c in counts]
        sign, curve = (-1, r.uniform(0.8, 3)) if base == "segment" else (-1, 1e4) if base == "block" else (1, r.uniform(1.1, 1.6))
        sides = {"xmin": "lower_left", "ymin": "lower_face", "ymax": "lower_bottom"}
        if base == "hollow":
            lower = cap(curve, low * 1.1, wide * 1.1, -height, 1, knots(other), sides)
        else:
            lower = cap(curve, low * 1.1, wide * 1.1, height, sign, knots(other), sides)
        m.add("lower", [lower], stiff, m.plan["other"])
        m.clamp("lower_bottom")
        if half:
            m.hold("lower_left", x=0)
    if half:
        m.hold("upper_left", x=0)
    m.pressed("upper_face", primary, m.modulus * soft * 0.02)
    drive(m, "upper_top", soft, 10 ** r.uniform(-3.2, -2.3), half, wide if half else 2 * wide)


def sphere(m):
    """A sphere's cap on a block, a rigid plane or another cap: axisymmetric, or a quarter or half of it in 3D."""
    r = m.r
    if not m.solid:
        return axisymmetric_sphere(m)
    half = not m.held and r.random() < 0.5
    quarter_caps(m, (True, True), half)


def axisymmetric_sphere(m):
    r = m.r
    wide, height, ratio = r.uniform(0.3, 0.6), r.uniform(0.5, 0.8), r.choice([3, 10, 30, 100])
    counts = [m.n(r.randint(14, 24)), m.n(r.randint(8, 14))]
    knots = lambda c: [graded(0, 1, c[0], ratio), graded(0, 1, c[1], ratio / 2)]
    m.add("upper", [cap(1.0, 0.0, wide, height, 1, knots(counts), {"xmin": "upper_axis", "ymin": "upper_face", "ymax": "upper_top"})])
    m.hold("upper_axis", x=0)
    stiff, primary, soft = spread(r, m.plan["decades"]), "lower_face", 1.0
    base = r.choice(["block", "plane", "cap"])
    if base == "plane":
        primary = m.plane_obstacle([0, 0], [0, 1])
    else:
        other = [max(3, round(c * r.uniform(0.6, 1.3))) for c in counts]
        m.add("lower", [cap(1e4 if base == "block" else r.uniform(0.7, 3), 0.0, wide * 1.1, height, -1, knots(other),
                            {"xmin": "lower_axis", "ymin": "lower_face", "ymax": "lower_bottom"})], stiff, m.plan["other"])
        m.hold("lower_axis", x=0)
        m.clamp("lower_bottom")
        soft = min(1.0, stiff)
    m.pressed("upper_face", primary, m.modulus * soft * 0.02)
    drive(m, "upper_top", soft, 10 ** r.uniform(-3.2, -2.3), True, wide)


def quarter_caps(m, bulge, half, below=None):
    """Caps over a square, a quarter of them or half: spheres, or cylinders of which the lower one may be turned by 90 degrees."""
    r = m.r
    wide, height, ratio = r.uniform(0.3, 0.55), r.uniform(0.4, 0.7), r.choice([3, 10, 30])
    counts = [m.n(r.randint(5, 8)) * (2 if half else 1), m.n(r.randint(4, 6)), m.n(r.randint(5, 8))]
    along = lambda c: graded_both(0, 1, c, ratio) if half else graded(0, 1, c, ratio)
    knots = lambda c: [along(c[0]), graded(0, 1, c[1], ratio / 2), graded(0, 1, c[2], ratio)]
    sides = lambda name: {"xmin": f"{name}_left", "zmin": f"{name}_front", "ymin": f"{name}_face", "ymax": f"{name}_far"}
    spans = lambda f: ((-f * wide if half else 0.0, f * wide), (0.0, f * wide))
    m.add("upper", [solid_cap(1.0, spans(1.0), height, 1, knots(counts), sides("upper"), bulge)])
    stiff, primary, soft = spread(r, m.plan["decades"]), "lower_face", 1.0
    base = "cap" if below else r.choice(["block", "plane", "cap"])
    names = ["upper"]
    if base == "plane":
        primary = m.plane_obstacle([0, 0], [0, 1])
    else:
        other = [max(2, round(c * r.uniform(0.6, 1.2))) for c in counts]
        other[0] += other[0] % 2 if half else 0
        curve = 1e4 if base == "block" else r.uniform(1.0, 2.5)
        m.add("lower", [solid_cap(curve, spans(1.05), height, -1, knots(other), sides("lower"), below or (True, True))], stiff, m.plan["other"])
        m.clamp("lower_far")
        names.append("lower")
        soft = min(1.0, stiff)
    if not half:
        for name in names:
            m.hold(f"{name}_left", x=0)
    m.pressed("upper_face", primary, m.modulus * soft * 0.02)
    drive(m, "upper_far", soft, 10 ** r.uniform(-3.0, -2.1), not half, wide if not half else 2 * wide)


def crossed(m):
    """Cylinders that cross at a right angle."""
    quarter_caps(m, (True, False), not m.held and m.r.random() < 0.4, below=(False, True))


def ring(m):
    """A quarter of a ring, pressed flat by a plate or by a rigid plane."""
    r = m.r
    outer = 1.0
    inner, ratio = r.uniform(0.6, 0.92), r.choice([1, 3, 10, 30])
    m.depth = r.uniform(0.2, 0.6)
    counts = [m.n(r.randint(24, 40)), m.n(r.randint(2, 4))]
    sides = {"xmin": "cut_low", "xmax": "cut_high", "ymin": "ring_inside", "ymax": "ring_face"}
    m.add("ring", [sector(inner, outer, 0, 90, [graded(0, 1, counts[0], 1 / ratio), even(0, 1, counts[1])], sides)], bend=r.random() < 0.7)
    m.hold("cut_high", x=0)
    bend = (outer - inner) ** 3  # the ring is as much softer than a solid
    depth = 10 ** r.uniform(-3, -2)
    if r.random() < 0.4:
        m.hold("cut_low", y=depth)
        m.pressed("ring_face", m.plane_obstacle([0, outer], [0, -1]), m.modulus * bend * depth)
        return
    m.hold("cut_low", y=0)
    stiff = spread(r, m.plan["decades"])
    wide, high = r.uniform(0.6, 1.2), r.uniform(0.2, 0.5)
    other = [max(2, round(counts[0] * r.uniform(0.4, 0.8))), m.n(r.randint(3, 5))]
    m.block("plate", [0.0, outer], [wide, high], other, stiff, m.plan["other"], knots=[graded(0, 1, other[0], ratio), even(0, 1, other[1])])
    m.hold("plate_left", x=0)
    m.pressed("ring_face", "plate_bottom", m.modulus * bend * depth)
    if r.random() < 0.5:
        m.hold("plate_top", y=-depth)
    else:
        m.load("plate_top", pressure=m.modulus * bend * depth * 0.2)


def pin(m):
    """Half a pin in a plate's bore, solid and heavy, or hollow and moved; with a gap, with none, or pressed in."""
    r = m.r
    m.depth = r.uniform(0.3, 1.0)
    gap = r.choice([0.0, 10 ** r.uniform(-4, -2), 10 ** r.uniform(-4, -2), -(10 ** r.uniform(-4, -3))])
    eighth, along = m.n(r.randint(4, 8)), m.n(r.randint(3, 6))
    stiff = spread(r, m.plan["decades"])
    hollow = r.random() < 0.4
    matching = gap <= 0 and r.random() < 0.3
    pressure = m.modulus * min(1.0, stiff) * 10 ** r.uniform(-4, -2.7)
    names, modelled = {"cut": "pin_cut", "rim": "pin_face"}, r.random() < 0.6 and gap > 0
    radius = 1.0 - gap if modelled else 1.0
    if hollow:
        knots = [even(0, 1, 4 * eighth), even(0, 1, along)]
        sides = {"xmin": "pin_cut", "xmax": "pin_cut", "ymin": "pin_inside", "ymax": "pin_face"}
        m.add("pin", [sector(0.4 * radius, radius, -90, 90, knots, sides, (0.0, radius - 1.0))])
        m.clamp("pin_inside", y=-pressure / m.modulus * r.uniform(1, 4) - (gap if gap > 0 and not modelled else 0))
    else:
        m.add("pin", disc(radius, (0.0, radius - 1.0), (eighth, along), names))
        m.materials["pin"]["density"] = 1.0
        m.loads.append({"body": "pin", "acceleration": m.vector(0.0, -pressure)})
    m.hold("pin_cut", x=0)
    plate = eighth if matching else max(2, round(eighth * r.uniform(0.6, 1.4)))
    m.add("plate", bored(1.0, r.uniform(1.6, 3), (plate, m.n(r.randint(4, 8))), {"bore": "bore", "cut": "plate_cut", "bottom": "base", "right": None, "top": "lid"}),
          stiff, m.plan["element"] if matching else m.plan["other"])
    m.hold("plate_cut", x=0)
    m.clamp(r.choice(["base", "lid"]))
    fit = {"clearance": gap} if gap > 0 and not modelled else {"clearance": 0} if gap == 0 or not modelled else {}
    if gap < 0:
        fit = {"clearance": 0, "interference": -gap}
    m.pressed("pin_face", "bore", pressure, **fit)


def fit(m):
    """A hub pressed on a shaft or loose on it: axisymmetric with the shaft longer than the hub, or a quarter of both in a plane or 3D."""
    r = m.r
    stiff = spread(r, min(2, m.plan["decades"]))
    overlap, bore, outer = 10 ** r.uniform(-4, -2.7), r.uniform(0.2, 0.7), r.uniform(1.3, 2.5)
    pressure = overlap * m.modulus * min(1.0, stiff) * 0.3
    if m.kind == "axisymmetric":
        return axisymmetric_fit(m, stiff, overlap, bore, outer, pressure)
    m.depth = r.uniform(0.3, 1.0)
    counts = [m.n(r.randint(10, 18)), m.n(r.randint(3, 6))]
    sides = lambda name: {"xmin": f"{name}_low", "xmax": f"{name}_high", "ymin": f"{name}_inside", "ymax": f"{name}_outside"}
    other = counts if r.random() < 0.4 else [max(2, round(c * r.uniform(0.6, 1.4))) for c in counts]
    m.add("shaft", [sector(bore, 1.0, 0, 90, [even(0, 1, c) for c in counts], sides("shaft"))])
    m.add("hub", [sector(1.0, outer, 0, 90, [even(0, 1, other[0]), graded(0, 1, other[1], 3)], sides("hub"))], stiff)
    for name in ("shaft", "hub"):
        m.hold(f"{name}_low", y=0)
        m.hold(f"{name}_high", x=0)
    loose = r.random() < 0.3
    m.pressed("hub_inside", "shaft_outside", pressure, **({"clearance": overlap} if loose else {"clearance": 0, "interference": overlap}))
    if loose or r.random() < 0.5:
        m.load("shaft_inside", pressure=pressure * r.uniform(3, 10))
    if loose and r.random() < 0.5:  # out of round: only a part closes
        m.load("hub_outside", pressure=pressure)


def axisymmetric_fit(m, stiff, overlap, bore, outer, pressure):
    r = m.r
    long, short, start = r.uniform(1.5, 3), r.uniform(0.5, 1.2), r.uniform(0.1, 0.3)
    counts, ratio = [m.n(r.randint(4, 8)), m.n(r.randint(24, 40))], r.choice([1, 1, 4])
    m.block("shaft", [bore, 0.0], [1 - bore, long], counts, knots=[graded(0, 1, counts[0], 1 / ratio), even(0, 1, counts[1])])
    other = [m.n(r.randint(4, 8)), m.n(r.randint(12, 24))]
    m.block("hub", [1.0, start], [outer - 1, short], other, stiff, m.plan["other"], knots=[graded(0, 1, other[0], ratio), even(0, 1, other[1])])
    m.hold("shaft_bottom", y=0)
    m.pressed("hub_left", "shaft_right", pressure, clearance=0, interference=overlap)
    if m.held:
        m.hold("hub_bottom", y=0)
        m.load("shaft_left", pressure=pressure)
        return
    area, face = 2 * math.pi * short, math.pi * (outer**2 - 1)
    # Lame: pressure of the fit, of two rings of equal Poisson's ratio taken for zero.
    hollow = (1 + bore**2) / (1 - bore**2)
    thick = (outer**2 + 1) / (outer**2 - 1)
    fitted = overlap * m.modulus / (hollow + thick / stiff) * 0.8
    if r.random() < 0.5:
        m.load("hub_top", pressure=0.4 * m.shear_limit(fitted if m.law == "coulomb" else pressure) * area / face)
    else:  # pushed along by a motion, perhaps until it slides
        m.hold("hub_top", y=-overlap * r.uniform(0.2, 2))


def belt(m):
    """A belt round a drum, rigid or not, drawn tight at one end or both by motions: it slides from there."""
    r = m.r
    thick, angle = r.choice([0.01, 0.02, 0.05]), r.uniform(30, 180)
    m.depth = r.uniform(0.1, 0.4)
    counts = [m.n(r.randint(30, 60)), m.n(r.choice([1, 2, 2]))]
    clear = 1.5 / counts[0] if r.random() < 0.5 else -1  # whether the first and the last cell are off the drum
    m.add("belt", [sector(1.0, 1.0 + thick, 0, angle, [even(0, 1, counts[0]), even(0, 1, counts[1])],
                          {"xmin": "first", "xmax": "last", "ymin": lambda s, t, z=0.0: "belt_face" if clear < s < 1 - clear else None})], bend=True)
    a, pull = math.radians(angle), 10 ** r.uniform(-3.5, -2.3) * math.radians(angle)
    m.clamp("last", x=-pull * math.sin(a), y=pull * math.cos(a))
    m.clamp("first", y=-pull if r.random() < 0.3 else 0)
    if r.random() < 0.6:
        m.pressed("belt_face", m.cylinder_obstacle(1.0), m.modulus * thick * pull)
        return
    stiff, inner = 10 ** r.uniform(0, 2), r.uniform(0.5, 0.8)
    other = [max(4, round(counts[0] * r.uniform(0.5, 1.0))), m.n(4)]
    m.add("drum", [sector(inner, 1.0, 0, angle, [even(0, 1, other[0]), graded(0, 1, other[1], 0.3)], {"ymin": "drum_inside", "ymax": "drum_face"})],
          stiff, m.plan["other"])
    m.clamp("drum_inside")
    m.pressed("belt_face", "drum_face", m.modulus * thick * pull, clearance=0)


def rollers(m):
    """Half rollers on each other between two plates, held by contact and their plane of symmetry alone."""
    r = m.r
    m.depth = r.uniform(0.3, 1.0)
    count, eighth, along = r.randint(1, 3), m.n(r.randint(4, 7)), m.n(r.randint(3, 5))
    ratios = [spread(r, m.plan["decades"]) for _ in range(count)]
    y, below = 0.0, "base_top"
    sizes = [r.uniform(0.6, 1.0) for _ in range(count)]
    plate = [m.n(8), m.n(4)]
    m.block("base", [0.0, -0.6], [1.0, 0.6], plate, 1.0, m.plan["other"], knots=[graded(0, 1, plate[0], 5), graded(0, 1, plate[1], 0.3)])
    m.clamp("base_bottom")
    m.hold("base_left", x=0)
    soft = min(ratios + [1.0])
    for i, radius in enumerate(sizes):
        m.add(f"roller{i}", disc(radius, (0.0, y + radius), (eighth, along), {"cut": f"cut{i}", "rim": f"rim{i}"}), ratios[i])
        m.hold(f"cut{i}", x=0)
        m.pressed(f"rim{i}", below, m.modulus * soft * 0.01)
        y, below = y + 2 * radius, f"rim{i}"
    m.block("lid", [0.0, y], [1.0, 0.6], plate, 1.0, m.plan["other"], knots=[graded(0, 1, plate[0], 5), graded(0, 1, plate[1], 3)])
    m.hold("lid_left", x=0)
    m.pressed("lid_bottom", below, m.modulus * soft * 0.01)
    depth = 10 ** r.uniform(-3, -2.3)
    if r.random() < 0.5:
        m.load("lid_top", pressure=m.modulus * soft * depth)
    else:
        m.hold("lid_top", y=-depth * count)

FREE_PLANE = """h = {h}; f = {fine};
Point(1) = {{0, 0, 0, f}}; Point(2) = {{1, 1, 0, h}}; Point(3) = {{0, 1, 0, h}};
Circle(1) = {{1, 3, 2}}; Line(2) = {{2, 3}}; Line(3) = {{3, 1}};
Curve Loop(1) = {{1, 2, 3}}; Plane Surface(1) = {{1}};
Point(11) = {{0, 0, 0, f * {other}}}; Point(12) = {{1.5, 0, 0, h}}; Point(13) = {{1.5, -1.2, 0, h}}; Point(14) = {{0, -1.2, 0, h}};
Line(11) = {{11, 14}}; Line(12) = {{14, 13}}; Line(13) = {{13, 12}}; Line(14) = {{12, 11}};
Curve Loop(11) = {{11, 12, 13, 14}}; Plane Surface(11) = {{11}};
{recombine}
Mesh.ElementOrder = {order}; Mesh.SecondOrderIncomplete = {incomplete};
"""

FREE_PLANE_NAMES = """Physical Surface("round") = {1}; Physical Surface("block") = {11};
Physical Curve("face") = {1}; Physical Curve("round_top") = {2}; Physical Curve("round_left") = {3};
Physical Curve("block_top") = {14}; Physical Curve("block_bottom") = {12}; Physical Curve("block_left") = {11};
"""

FREE_SOLID = """SetFactory("OpenCASCADE"); h = {h}; f = {fine};
Sphere(1) = {{0, 1, 0, 1}}; Box(2) = {{0, 0, 0, 2, 1, 2}};
BooleanIntersection(3) = {{ Volume{{1}}; Delete; }}{{ Volume{{2}}; Delete; }};
Box(4) = {{0, -1, 0, 1.2, 1, 1.2}};
Field[1] = Ball; Field[1].Radius = 0.25; Field[1].Thickness = 0.8; Field[1].VIn = f; Field[1].VOut = h; Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
Mesh.ElementOrder = {order};
e = 1e-3;
Physical Volume("round") = {{3}}; Physical Volume("block") = {{4}};
all() = Boundary{{ Volume{{3}}; }};
left() = Surface In BoundingBox {{-e, -e, -e, e, 1 + e, 1 + e}}; front() = Surface In BoundingBox {{-e, -e, -e, 1 + e, 1 + e, e}};
top() = Surface In BoundingBox {{-e, 1 - e, -e, 1 + e, 1 + e, 1 + e}};
face() = all(); face() -= left(); face() -= front(); face() -= top();
Physical Surface("face") = {{face()}}; Physical Surface("round_left") = {{left()}};
Physical Surface("round_front") = {{front()}}; Physical Surface("round_top") = {{top()}};
Physical Surface("block_top") = {{Surface In BoundingBox {{-e, -e, -e, 1.2 + e, e, 1.2 + e}}}};
Physical Surface("block_bottom") = {{Surface In BoundingBox {{-e, -1 - e, -e, 1.2 + e, -1 + e, 1.2 + e}}}};
Physical Surface("block_left") = {{Surface In BoundingBox {{-e, -1 - e, -e, e, e, 1.2 + e}}}};
Physical Surface("block_front") = {{Surface In BoundingBox {{-e, -1 - e, -e, 1.2 + e, e, e}}}};
"""


def free_mesh(m):
    """A quarter of a disc or an eighth of a ball on a block, meshed by gmsh, finer at the contact."""
    r = m.r
    element = m.plan["element"]
    second = element in meshes.SECOND
    ratio, other = r.choice([2, 4, 8, 16]), r.choice([0.7, 1.0, 1.5])
    nodes = m.plan["unknowns"] / (3 if m.solid else 2)
    h = (2.0 / nodes * (8.0 if second else 1.0)) ** (1 / 3) if m.solid else (2.6 / nodes * (4.0 if second else 1.0)) ** 0.5
    h = min(h * ratio**0.4, 0.5)
    if m.solid:
        text = FREE_SOLID.format(h=f"{h:.4g}", fine=f"{max(h / ratio, 0.01):.4g}", order=2 if second else 1)
    else:
        quads = "Recombine Surface {1, 11};" if meshes.SHAPE[element] == "quad" else ""
        text = FREE_PLANE.format(h=f"{h:.4g}", fine=f"{h / ratio:.4g}", other=other, order=2 if second else 1, incomplete=int(element == "quad8"),
                                 recombine=quads) + FREE_PLANE_NAMES
    stiff = spread(r, m.plan["decades"])
    m.material("round", 1.0, element)
    m.material("block", stiff, element)
    m.mesh, m.files = {"file": "deck.geo"}, {"deck.geo": text}
    soft = min(1.0, stiff)
    for name in ("round_left", "block_left"):
        m.hold(name, x=0)
    if m.solid:
        m.hold("round_front", z=0)
        m.hold("block_front", z=0)
    m.clamp("block_bottom")
    m.pressed("face", "block_top", m.modulus * soft * 0.02)
    drive(m, "round_top", soft, 10 ** r.uniform(-3, -2.2), True, 1.0)
