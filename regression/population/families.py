"""The families of the population: each a function that builds a model (model.py) from its random numbers. A plane model has y upwards; in 3D it
is extruded along z. Every model has an equilibrium by construction: what is not held is pressed, and pushed sideways by less than friction
takes, with resultants that stay well inside of what they rest on; or motions are prescribed. With `fails` in the plan it has none.

Without friction every body is held across the direction that it is pressed in, by a plane of symmetry; with it a push is at most 0.7 of what
the law takes, and resultants pass within the middle half of what a body rests on; round bodies that friction holds are moved, not loaded. One deck
in 33 is pushed beyond friction by a tenth and more, or pulled apart: exit 3."""

from families_loose import floating
from families_round import belt, crossed, cylinder, fit, free_mesh, pin, ring, rollers, sphere
from families_stacked import beam, blocks, chain, layer, plates, punch, wedge

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
