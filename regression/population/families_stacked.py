"""Families of blocks on each other: stacks, chains, layers, wedges, punches, beams, plates."""

import math

import numpy as np

import meshes
from meshes import Patch, even, graded, graded_both
from model import spread


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
