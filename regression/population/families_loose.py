"""Families of bodies that nothing but contact holds: in pockets, on steps, between jaws, in grooves."""

import math

import meshes
from meshes import Patch, even, graded, graded_both
from model import disc, spread


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
