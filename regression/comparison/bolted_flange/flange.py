"""Makes flange.step: half of a flanged joint, cut at y = 0 between the bolts. A lower flange with the shanks of three M12 bolts up to a cut, an upper flange
with its pipe, and what is above the cut of each bolt, with the head. Needs gmsh's Python module. Units: mm."""
import math
import pathlib

import gmsh

BORE, PIPE, RIM, CIRCLE = 40, 50, 90, 70      # radii of the rings and of the circle of bolts
SHANK, HOLE, HEAD = 6, 6.75, 9.5              # radii
LOWER, UPPER, TOP, HEIGHT = 30, 18, 60, 8     # thicknesses of the flanges, where the pipe ends above the joint, height of the heads
CUT = 9                                       # above the joint, in the middle of the upper flange
ANGLES = (30, 90, 150)

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
occ = gmsh.model.occ


def cylinder(radius, bottom, top, at=(0, 0), angle=2 * math.pi):
    return [(3, occ.addCylinder(*at, bottom, 0, 0, top - bottom, radius, angle=angle))]


def ring(inner, outer, bottom, top):
    return occ.cut(cylinder(outer, bottom, top, angle=math.pi), cylinder(inner, bottom, top))[0]


places = [(CIRCLE * math.cos(math.radians(a)), CIRCLE * math.sin(math.radians(a))) for a in ANGLES]
lower = occ.fuse(ring(BORE, RIM, -LOWER, 0), [s for at in places for s in cylinder(SHANK, 0, CUT, at)])[0]
upper = occ.fuse(ring(BORE, RIM, 0, UPPER), ring(BORE, PIPE, UPPER, TOP))[0]
upper = occ.cut(upper, [s for at in places for s in cylinder(HOLE, 0, UPPER, at)])[0]
bolts = [occ.fuse(cylinder(SHANK, CUT, UPPER, at), cylinder(HEAD, UPPER, UPPER + HEIGHT, at))[0] for at in places]
occ.synchronize()
for (_, tag), name in zip(lower + upper + sum(bolts, []), ("lower", "upper", "bolt_1", "bolt_2", "bolt_3")):
    gmsh.model.setEntityName(3, tag, name)
gmsh.write(str(pathlib.Path(__file__).with_name("flange.step")))
gmsh.finalize()
