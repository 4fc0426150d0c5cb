"""Makes bracket.step: a base plate with the lower half of a bolt's shank, an angle bracket, and the upper half of the bolt with its head. Needs gmsh's
Python module. Units: mm."""
import pathlib

import gmsh

HOLE, SHANK, HEAD = 5.5, 5.0, 8.0  # radii
CUT = 25.0                         # where the shank is cut, in the middle of the bracket's leg

gmsh.initialize()
occ = gmsh.model.occ
base = occ.addBox(0, 0, 0, 100, 60, 20)
stub = occ.addCylinder(55, 30, 20, 0, 0, CUT - 20, SHANK)
base = occ.fuse([(3, base)], [(3, stub)])[0]

leg = occ.addBox(20, 10, 20, 70, 40, 10)
wall = occ.addBox(20, 10, 30, 10, 40, 50)
hole = occ.addCylinder(55, 30, 20, 0, 0, 10, HOLE)
bracket = occ.fuse([(3, leg)], [(3, wall)])[0]
bracket = occ.cut(bracket, [(3, hole)])[0]
occ.synchronize()
inner = [tag for dim, tag in gmsh.model.getEntitiesInBoundingBox(29.9, 9.9, 29.9, 30.1, 50.1, 30.1, 1)]
bracket = occ.fillet([bracket[0][1]], inner, [5.0])

shank = occ.addCylinder(55, 30, CUT, 0, 0, 30 - CUT, SHANK)
head = occ.addCylinder(55, 30, 30, 0, 0, 7, HEAD)
bolt = occ.fuse([(3, shank)], [(3, head)])[0]
occ.synchronize()
for (dim, tag), name in zip(base + bracket + bolt, ("base", "bracket", "bolt")):
    gmsh.model.setEntityName(dim, tag, name)
gmsh.write(str(pathlib.Path(__file__).with_name("bracket.step")))
gmsh.finalize()
