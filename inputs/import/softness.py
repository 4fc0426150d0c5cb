"""Laws of contact that give way, beside the bodies that they act on: a penalty is exact contact in the deck, a spring is none."""

import numpy as np

SOFT, VISIBLE = 0.3, 0.02  # how far a law gives way, in parts of what the bodies do: no penalty any more; worth a word
FAR = 1e-4  # of the bodies' size, or of Young's modulus: clearances at which contact begins to press, gaps that are pulled shut, tensions
SLIP, MUCH_SLIP = 0.005, 0.05  # elastic slip in parts of the slave's faces: what Abaqus takes by itself; no penalty any more


class Softness:
    def report_soft(self, law, sides, nodal):
        """sides: the boundaries, or None for contact of all bodies; nodal: whether nodes meet faces, which CalculiX's linear law then holds back."""
        own = self.bodies_of(sides) if sides else [range(len(self.bodies.bodies))] * 2
        size = min(
            max(np.ptp([self.model.points[n] for n in self.bodies.nodes_of_body(b)], axis=0).max() for b in side) for side in own
        )
        used = {m for side in own for b in side for m, _ in self.bodies.bodies[b].volumes.values()}
        if "stiffness" in law:
            self.report_spring(*law["stiffness"], size, "Young's", min(map(self.young_modulus, used)), "contact of the deck gives way by nothing")
        if nodal and "tension" in law:
            value, card = law["tension"]
            young = min(map(self.young_modulus, used))
            self.model.leave_out(
                card,
                f"a tension of up to {value:g} where sides part, beside Young's modulus {young:.3g}: contact of the deck holds none",
                changes=value > FAR * young,
            )
        if "stick" in law and (law.get("friction") or law.get("bonded")):
            self.report_spring(*law["stick"], size, "shear", min(map(self.shear_modulus, used)), "what sticks in the deck, or is tied, does not slide at all")
        if "slip" in law and sides and law.get("friction"):
            self.report_slip(*law["slip"], sides)
        if "clearance" in law and law["clearance"][0] > FAR * size:
            value, card = law["clearance"]
            self.model.leave_out(card, f"pressure from a clearance of {value:g} on, beside bodies of {size:.3g}: contact of the deck begins at 0")

    def report_spring(self, value, card, size, kind, modulus, instead):
        part = modulus / (value * size) if value > 0 else 1.0
        if part > VISIBLE:
            text = f"{value:g} an area and length gives way by some {100 * part:.2g} % of what a body of {size:.3g} and {kind} modulus {modulus:.3g} does"
            self.model.leave_out(card, f"{text}: {instead}", changes=part > SOFT)

    def report_slip(self, value, relative, card, sides):
        """Elastic slip at the bound of friction, as a length or in parts of the mean size of the slave's faces."""
        size, _ = self.sizes(*(self.boundaries[side] for side in sides[::-1]))
        part = value if relative else value / size
        if part > SLIP:
            self.model.leave_out(
                card,
                f"an elastic slip of {100 * part:.2g} % of the slave's faces, {part * size:.3g}, before friction is full: what sticks in the deck does "
                "not slide at all",
                changes=part > MUCH_SLIP,
            )

    def young_modulus(self, m):
        material = self.materials[m]
        return material["young_modulus"] if "young_modulus" in material else min(material["orthotropic"]["young_modulus"])

    def shear_modulus(self, m):
        material = self.materials[m]
        if "young_modulus" in material:
            return material["young_modulus"] / (2 + 2 * material["poisson_ratio"])
        return min(material["orthotropic"]["shear_modulus"])
