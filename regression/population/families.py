"""The families of the population: each a function that builds a model (model.py) from its random numbers. A plane model has y upwards; in 3D it
is extruded along z. Every model has an equilibrium by construction: what is not held is pressed, and pushed sideways by less than friction
takes, with resultants that stay well inside of what they rest on; or motions are prescribed. With `fails` in the plan it has none."""

import math

import numpy as np

import meshes
from meshes import Patch, even, graded, graded_both
from model import bored, cap, disc, sector, solid_cap, spread

# Kinds of models and laws that a family has, and whether it has variants without an equilibrium.
KINDS = {
    "blocks": ["plane_strain", "plane_stress", 3, 3], "layer": ["plane_strain", "plane_stress", "axisymmetric", 3],
    "cylinder": ["plane_strain", "plane_stress", 3], "sphere": ["axisymmetric", "axisymmetric", 3], "crossed": [3],
    "wedge": ["plane_strain", "plane_stress", 3], "punch": ["plane_strain", "axisymmetric", 3], "ring": ["plane_strain", "plane_stress", 3],
    "pin": ["plane_strain", "plane_stress", 3], "fit": ["axisymmetric", "plane_strain", 3], "beam": ["plane_strain", "plane_stress", 3],
    "belt": ["plane_strain", "plane_stress", 3], "chain": ["plane_strain", "axisymmetric", 3], "rollers": ["plane_strain", 3],
    "floating": ["plane_strain", "plane_stress", 3], "plates": [3, 3, "plane_strain"], "free_mesh": ["plane_strain", 3],
}
FAILING = ("blocks", "punch", "chain")


def vertical(m, boundary, pressure, depth):
    """Presses a face downwards: by pressure, or by a motion of about the same effect."""
    if m.r.random() < 0.65:
        m.load(boundary, pressure=pressure)
    else:
        m.hold(boundary, y=-pressure / m.modulus * depth)


def column(m, widths, heights, cells, ratios, elements, knots=None):
    """Blocks on each other, all centred; the lowest one is clamped below. Axisymmetric ones are discs."""
    y, half = 0.0, m.held or m.kind == "axisymmetric"
    for i, (width, height) in enumerate(zip(widths, heights)):
        name = f"b{i}"
        left = 0.0 if half else -width / 2
        m.block(name, [left, y], [width, height], cells[i], ratios[i], elements[i], knots=knots[i] if knots else None)
        if half:
            m.hold(f"{name}_left", x=0)
        y += height
    m.clamp("b0_bottom")
    return y


def shear_column(m, top, width, height, pressure, smallest, lengths):
    """Pushes the top of a column sideways, within friction and without tipping; or turns it by a pair of forces on its sides."""
    if m.kind == "axisymmetric":
        return
    limit = m.shear_limit(pressure) * (smallest / width if m.law == "tresca" else 1)
    most = 0.3 * pressure if m.held else min(0.7 * limit, 0.25 * pressure * smallest / height)  # supports on the left take any push
    what = m.r.choice(["push", "couple", "both", "none"])
    if what in ("push", "both"):
        m.load(top, traction=m.vector(m.r.uniform(0.2, 1) * most * (0.5 if what == "both" else 1), 0.0))
    if what in ("couple", "both"):
        body = top.split("_")[0]
        pair = m.r.uniform(0.2, 1) * 0.06 * pressure * smallest / lengths[-1]
        m.load(f"{body}_left", traction=m.vector(0.0, pair))
        m.load(f"{body}_right", traction=m.vector(0.0, -pair))


def without_equilibrium(m, top, pressure, width, smallest):
    """Pushes a column beyond friction, or pulls it apart."""
    m.status = 3
    if m.law != "frictionless" and m.kind != "axisymmetric" and m.r.random() < 0.6:
        limit = m.shear_limit(pressure) * (smallest / width if m.law == "tresca" else 1)
        m.load(top, traction=m.vector(m.r.uniform(1.1, 2.0) * limit, 0.0))
    else:
        m.load(top, traction=m.vector(0.0, m.r.uniform(1.05, 3) * pressure))


def blocks(m, count=None):
    """Two or three blocks, pressed, sheared, turned by a pair of forces."""
    r = m.r
    count = count or r.randint(2, 3)
    m.depth = r.uniform(0.5, 1.5)
    same = r.random() < 0.4
    widths = [r.uniform(0.8, 2.0)]
    for _ in range(count - 1):
        widths.append(widths[-1] if same else widths[-1] * r.uniform(0.5, 1.0))
    heights = [r.uniform(0.3, 1.0) for _ in range(count)]
    matching = same and r.random() < 0.5
    base = [[r.randint(4, 9), r.randint(2, 6)] for _ in range(count)]
    cells = [[m.n(base[0 if matching else i][0]), m.n(base[i][1])] for i in range(count)]
    ratios = [spread(r, m.plan["decades"]) for _ in range(count)]
    elements = [m.plan["element"]] + [m.plan["element"] if matching or r.random() < 0.8 else m.plan["other"] for _ in range(count - 1)]
    knots = None
    if r.random() < 0.4:
        ratio = r.choice([3, 10, 30, 100])
        knots = [[even(0, 1, c[0]), graded(0, 1, c[1], ratio ** (-1 if i == 0 else 1))] for i, c in enumerate(cells)]
    height = column(m, widths, heights, cells, ratios, elements, knots)
    pressure = m.modulus * min(ratios) * 10 ** r.uniform(-4, -2.5)
    top = f"b{count - 1}_top"
    for i in range(1, count):
        m.pressed(f"b{i}_bottom", f"b{i - 1}_top", pressure)
    if m.plan["fails"]:
        m.load(top, pressure=pressure)
        without_equilibrium(m, top, pressure, widths[-1], widths[-1])
        return
    if not m.held and m.kind != "axisymmetric" and r.random() < 0.3:  # driven by the motion of the top face, beyond sticking or not
        down = pressure * sum(h / (m.modulus * q) for h, q in zip(heights, ratios))
        m.clamp(top, y=-down, x=down * r.uniform(0, 2))
    else:
        m.load(top, pressure=pressure)
        shear_column(m, top, widths[-1], height, pressure, widths[-1], heights)


def chain(m):
    """Three to five bodies in a row."""
    blocks(m, m.r.randint(3, 5))


def layer(m):
    """A layer on a foundation, loaded on a short strip; it lifts at a distance. Half a model."""
    r = m.r
    m.depth = r.uniform(1, 3)
    length, deep, strip = r.uniform(5, 15), r.uniform(4, 12), 10 ** r.uniform(-0.7, 0.3)
    ratio = r.choice([1, 3, 10, 30, 100])
    rigid = r.random() < 0.25
    across = [m.n(r.randint(2, 5)), m.n(r.randint(14, 30))]

    def along(total, base, growth):
        near = max(1, m.n(base * 0.25))
        return np.concatenate([even(0, strip, near), graded(strip, total, m.n(base), growth)[1:]])
    fine, coarse = across[1], max(3, round(across[1] * r.uniform(0.5, 1.2)))
    knots = along(length, fine / m.scale, ratio) / length
    limit = strip / length
    short = m.solid and r.random() < 0.5
    name = lambda s, t, z=0.0: "strip" if s < limit and (not short or z < m.depth / 2) else None
    stiff = spread(r, m.plan["decades"])
    m.block("layer", [0.0, 0.0], [length, 1.0], [1, 1], 1.0, knots=[knots, even(0, 1, across[0])], sides={"ymax": name})
    m.hold("layer_left", x=0)
    pressure = m.modulus * min(1.0, stiff) * 10 ** r.uniform(-3.5, -2.3)
    primary = m.plane_obstacle([0, 0], [0, 1])
    if not rigid:
        wide = length * r.choice([1.0, 1.3])
        same = wide == length and r.random() < 0.4
        below = knots if same else along(wide, coarse / m.scale, ratio) / wide
        m.block("base", [0.0, -deep], [wide, deep], [1, 1], stiff, m.plan["element"] if same else m.plan["other"],
                knots=[below, graded(0, 1, m.n(8), 1 / r.choice([3, 10, 30]))])
        m.hold("base_left", x=0)
        m.clamp("base_bottom")
        primary = "base_top"
    m.load("strip", pressure=pressure)
    m.pressed("layer_bottom", primary, pressure * strip)


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


def drive(m, top, soft, depth, half, width):
    """Presses a round body by a motion that may have a part along the surface, or by a load where it is held sideways."""
    if half and m.r.random() < 0.6:
        m.load(top, pressure=m.modulus * soft * depth / width)
        return
    if half:
        m.hold(top, y=-depth)
    else:
        m.clamp(top, y=-depth, x=depth * m.r.uniform(0, 1.5))


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


def wedge(m):
    """A wedge pressed into a groove: half of it, or whole and held by contact alone."""
    r = m.r
    m.depth = r.uniform(0.4, 1.0)
    slope, foot, high, wide, over = math.tan(math.radians(r.uniform(12, 60))), r.uniform(0.1, 0.5), r.uniform(0.6, 1.2), r.uniform(0.5, 1.5), r.uniform(0, 0.2)
    half = r.random() < 0.5
    counts, ratio = [m.n(r.randint(5, 10)), m.n(r.randint(6, 12))], r.choice([1, 3, 10])
    top = foot + slope * high
    stiff = spread(r, m.plan["decades"])
    corner = lambda x: [(x[0], 0.0), (x[1], 0.0), (x[2], high), (x[3], high)]
    low = (0.0, foot, top, 0.0) if half else (-foot, foot, top, -top)
    wedge_sides = {"xmin": "wedge_left", "xmax": "wedge_right", "ymax": "wedge_top"}
    m.add("wedge", [Patch([even(0, 1, counts[0] * (1 if half else 2)), graded(0, 1, counts[1], ratio)], meshes.corners(corner(low)), wedge_sides)])
    other = [max(2, round(c * r.uniform(0.5, 1.3))) for c in counts]
    far = top + slope * over + wide
    face = [(foot - slope * over, -over), (far, -over), (far, high + over), (top + slope * over, high + over)]
    m.add("right", [Patch([graded(0, 1, other[0], 3), even(0, 1, other[1])], meshes.corners(face), {"xmin": "right_face", "xmax": "right_far"})],
          stiff, m.plan["other"])
    m.clamp("right_far")
    pressure = m.modulus * min(1.0, stiff) * 10 ** r.uniform(-4, -2.7)
    m.pressed("wedge_right", "right_face", pressure)
    if half:
        m.hold("wedge_left", x=0)
    else:
        mirrored = [(-face[1][0], -over), (-face[0][0], -over), (-face[3][0], high + over), (-far, high + over)]
        m.add("left", [Patch([graded(0, 1, other[0], 1 / 3), even(0, 1, other[1])], meshes.corners(mirrored), {"xmax": "left_face", "xmin": "left_far"})],
              stiff, m.plan["other"])
        m.clamp("left_far")
        m.pressed("wedge_left", "left_face", pressure)
    vertical(m, "wedge_top", pressure, high)


def punch(m):
    """A punch with sharp edges on a wide block, pressed, sheared or turned within friction."""
    r = m.r
    m.depth = r.uniform(0.3, 1.0)
    half = m.held or m.kind == "axisymmetric"
    wide, small = r.uniform(2, 4), r.uniform(0.5, 1.0)
    heights = [r.uniform(0.6, 2), r.uniform(0.3, 1)]
    ratio = r.choice([1, 3, 10, 30])
    cells = [[m.n(r.randint(12, 20)), m.n(r.randint(6, 10))], [m.n(r.randint(6, 10)), m.n(r.randint(3, 6))]]
    near = lambda c: graded(0, 1, c, 1 / ratio) if half else np.concatenate([graded(0, 0.5, c // 2 + 1, ratio)[:-1], graded(0.5, 1, c // 2 + 1, 1 / ratio)])
    knots = [[even(0, 1, cells[0][0]), graded(0, 1, cells[0][1], 1 / 5)], [near(cells[1][0]), graded(0, 1, cells[1][1], min(ratio, 5))]]
    ratios = [1.0, 10 ** r.uniform(-m.plan["decades"] / 2, m.plan["decades"])]
    height = column(m, [wide, small], heights, cells, ratios, [m.plan["other"], m.plan["element"]], knots)
    pressure = m.modulus * min(ratios) * 10 ** r.uniform(-4, -2.7)
    m.pressed("b1_bottom", "b0_top", pressure)
    m.load("b1_top", pressure=pressure)
    if m.plan["fails"]:
        without_equilibrium(m, "b1_top", pressure, small, small)
    else:
        shear_column(m, "b1_top", small, height - heights[0], pressure, small, heights)


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


def beam(m):
    """A beam that lies on a plane or a foundation under its weight and is lifted at one end: some length of it stays down."""
    r = m.r
    length, high = r.uniform(10, 40), 1.0
    m.depth = r.uniform(0.5, 2)
    lifted, rise = r.uniform(0.3, 0.7) * length, r.uniform(0.05, 0.5)
    weight = 24 * m.modulus * high**3 / 12 * rise / lifted**4
    counts = [m.n(r.randint(20, 60)), m.n(r.choice([1, 1, 2, 2]))]
    ratio = r.choice([1, 1, 3, 10])
    knots = [graded_both(0, 1, counts[0] + counts[0] % 2, ratio), even(0, 1, counts[1])]
    m.block("beam", [0.0, 0.0], [length, high], counts, bend=True, knots=knots if ratio > 1 else None)
    m.hold("beam_left", x=0)
    m.hold("beam_right", y=rise)
    m.load("beam_top", pressure=weight)
    if r.random() < 0.6:
        m.pressed("beam_bottom", m.plane_obstacle([0, 0], [0, 1]), weight)
        return
    stiff = 10 ** r.uniform(-1, 2)
    same = r.random() < 0.4
    other = [len(knots[0]) - 1 if same else max(4, round(counts[0] * r.uniform(0.4, 1.0))), m.n(3)]
    base, deep = [knots[0] if same else even(0, 1, other[0]), graded(0, 1, other[1], 1 / 3)], r.uniform(2, 6)
    m.block("base", [0.0, -deep], [length, deep], other, stiff, m.plan["element"] if same else m.plan["other"], knots=base)
    m.clamp("base_bottom")
    m.pressed("beam_bottom", "base_top", weight)


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


def floating(m):
    """A body that contact alone holds: in the corner of a pocket, squeezed by friction, a disc in a groove."""
    choice = m.r.choice(["pocket", "squeezed", "groove"] if not m.held else ["pocket", "stepped"])
    m.depth = m.r.uniform(0.4, 1.0)
    {"pocket": pocket, "squeezed": squeezed, "groove": groove, "stepped": stepped}[choice](m)


def pocket(m, push=0.3):
    """A block in a pocket with some play to the left, pressed down and to the right."""
    r = m.r
    play, wide, high, stiff = r.choice([0.0, 1e-3, 1e-2]), r.uniform(0.6, 1.5), r.uniform(0.6, 1.2), spread(r, m.plan["decades"])
    n, k, w = m.n(r.randint(4, 8)), m.n(r.randint(4, 8)), m.n(r.randint(2, 4))
    wall = r.uniform(0.3, 0.8)
    left, right, low = -play, wide, -wall
    lower, upper = even(0, 1, w), even(0, 1, k)
    xs = [(left - wall, left), (left, right), (right, right + wall)]
    patches = []
    for i, (x0, x1) in enumerate(xs):
        cells = even(0, 1, n if i == 1 else w)
        patches.append(Patch([cells, lower], meshes.box([x0, low], [x1 - x0, wall]), {"ymin": "pocket_base", **({"ymax": "pocket_floor"} if i == 1 else {})}))
        if i != 1:
            patches.append(Patch([cells, upper], meshes.box([x0, 0.0], [x1 - x0, high]), {("xmax" if i == 0 else "xmin"): "wall_left" if i == 0 else "wall_right"}))
    m.add("pocket", patches, stiff, m.plan["other"])
    m.clamp("pocket_base")
    n, k = [max(2, round(c * r.uniform(0.6, 1.4))) for c in (n, k)]
    m.block("block", [0.0, 0.0], [wide, high], [n, k])
    pressure = m.modulus * min(1.0, stiff) * 10 ** r.uniform(-4, -2.7)
    m.load("block_top", pressure=pressure)
    m.load("block_left", pressure=pressure * r.uniform(0.05, push))
    m.pressed("block_bottom", "pocket_floor", pressure)
    m.pressed("block_right", "wall_right", pressure)
    if play:
        m.pressed("block_left", "wall_left", pressure)


def stepped(m):
    """The same pushed harder, by more than the pressure on top."""
    pocket(m, 1.5)


def squeezed(m):
    """A block between two jaws, held by friction against a push along them."""
    r = m.r
    wide, high = r.uniform(0.6, 1.5), r.uniform(0.4, 1.0)
    stiff = spread(r, m.plan["decades"])
    cells = lambda: [m.n(r.randint(4, 8)), m.n(r.randint(3, 6))]
    m.block("jaw", [-0.2 * wide, -0.5], [1.4 * wide, 0.5], cells(), stiff, m.plan["other"])
    m.block("block", [0.0, 0.0], [wide, high], cells())
    m.block("lid", [-0.2 * wide, high], [1.4 * wide, 0.5], cells(), stiff, m.plan["other"])
    m.clamp("jaw_bottom")
    m.hold("lid_top", x=0, **({"z": 0} if m.solid else {}))
    pressure = m.modulus * min(1.0, stiff) * 10 ** r.uniform(-4, -2.7)
    m.load("lid_top", pressure=pressure)
    mean = pressure * 1.4
    m.pressed("block_bottom", "jaw_top", mean)
    m.pressed("block_top", "lid_bottom", mean)
    # The weight of the lid's load acts on both faces; half of what they hold, and no tipping.
    m.load("block_left", pressure=r.uniform(0.2, 0.5) * min(m.shear_limit(mean), mean * 0.3) * wide / high)


def groove(m):
    """A disc in a groove of two blocks, pulled down by its weight and turned a little by the friction of its sides."""
    r = m.r
    angle = math.radians(r.uniform(30, 60))
    eighth, along = m.n(r.randint(3, 6)), m.n(r.randint(3, 5))
    m.add("disc", disc(1.0, (0.0, 0.0), (eighth, along), {"rim": "rim"}, half=False))
    m.materials["disc"]["density"] = 1.0
    stiff = spread(r, m.plan["decades"])
    n, k = m.n(r.randint(8, 12)), m.n(r.randint(3, 5))
    for name, side in (("right", 1.0), ("left", -1.0)):
        # The face touches the disc where its normal has this angle with the vertical; it is 0.9 long.
        c, s = math.cos(angle), math.sin(angle)
        at = (side * s, -c)
        along_face = (side * c, s)
        out = (side * s, -c)
        p = lambda a, b: (at[0] + a * along_face[0] + b * out[0], at[1] + a * along_face[1] + b * out[1])
        points = [p(-0.45, 0.0), p(0.45, 0.0), p(0.45, 0.6), p(-0.45, 0.6)]
        m.add(name, [Patch([graded_both(0, 1, n + n % 2, 5), graded(0, 1, k, 3)], meshes.corners(points), {"ymin": f"{name}_face", "ymax": f"{name}_far"})],
              stiff, m.plan["other"])
        m.clamp(f"{name}_far")
    weight = m.modulus * min(1.0, stiff) * 10 ** r.uniform(-4.5, -3)
    m.loads.append({"body": "disc", "acceleration": m.vector(weight * r.uniform(-0.1, 0.1), -weight)})
    for name in ("right", "left"):
        m.pressed("rim", f"{name}_face", weight)


def plates(m):
    """Thin plates on each other, up to 400 times as wide as thick, pressed on a part."""
    r = m.r
    wide = r.choice([20, 50, 100, 200, 400])
    m.depth = wide * r.uniform(0.5, 1.0)
    count, limit = r.randint(2, 3), r.choice([0.3, 0.5, 1.0])
    base = r.randint(10, 16)
    m.layers = base * (0.8 if m.solid else 1)
    pressure = 10 ** r.uniform(-4, -3)
    ratios = [spread(r, min(2, m.plan["decades"])) for _ in range(count)]
    for i in range(count):
        name, n = f"p{i}", max(4, m.n(base * r.uniform(0.7, 1.2)))
        part = lambda s, t, z=0.0: "pressed" if s < limit and z < limit * m.depth else None
        cells = [n, r.randint(1, 2)]
        m.block(name, [0.0, float(i)], [float(wide), 1.0], cells, ratios[i], bend=r.random() < 0.3, sides={"ymax": part} if i == count - 1 and limit < 1 else None)
        m.hold(f"{name}_left", x=0)
        if i:
            m.pressed(f"{name}_bottom", f"p{i - 1}_top", pressure * m.modulus * min(ratios))
    m.clamp("p0_bottom")
    m.load("pressed" if limit < 1 else f"p{count - 1}_top", pressure=pressure * m.modulus * min(ratios))


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
