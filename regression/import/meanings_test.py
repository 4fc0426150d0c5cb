#!/usr/bin/python3
"""What keywords mean beyond their plain reading: nodes that move, laws that give way, what sets repeat, what steps forget, where Abaqus and
CalculiX differ. Each is read as it is meant, or told."""

import re
import unittest

import numpy as np
from sample_models import CUBE, MODEL, SECOND, STEEL, Import, step  # sets the path of the modules under test, too

import elements
import projection

PRESS = "*DLOAD\nUPPER, P2, 5.\n"


def apart(gap):
    """SECOND, that far above the cube."""
    return re.sub(r"(?m)^(1[1-4],\d,\d),1$", rf"\1,{1 + gap:g}", SECOND)


class Meanings(Import):
    def findings(self, text, changes):
        return [f.reason for f in self.translate(text).model.findings if f.changes == changes]

    def told(self, text, words, changes=True):
        self.assertTrue(any(words in r for r in self.findings(text, changes)), self.findings(text, changes))


class Projection(unittest.TestCase):
    def test_nearest_places(self):
        """Beside the nearest one of many points of each face."""
        random = np.random.default_rng(1)
        for shape in projection.EXPONENTS:
            of = elements.family(shape)
            corners = np.array(projection.CORNERS[of], dtype=float)
            nodes = np.array([*corners, *((corners[a] + corners[b]) / 2 for a, b in elements.EDGES[of])])[: elements.NODES[shape]]
            face = np.zeros((len(nodes), 3))
            face[:, : nodes.shape[1]] = nodes
            face[:, : 2 if of == "line" else 3] += 0.05 * random.standard_normal((len(nodes), 2 if of == "line" else 3))
            line = np.linspace(0 if of == "tri" else -1, 1, 201)
            grid = line[:, None] if of == "line" else np.array([(a, b) for a in line for b in line if of == "quad" or a + b < 1 + 1e-9])
            on = projection.FUNCTIONS[shape].values(grid) @ face
            points = on[:: max(1, len(on) // 40)] + 0.2 * random.uniform(-1, 1, (len(on[:: max(1, len(on) // 40)]), 3))
            points[:, 2] *= of != "line"
            places, _, distances = projection.nearest([(shape, face, (0, 0, -1) if of != "line" else (0, -1, 0))], points, 9)
            sampled = np.linalg.norm(on - points[:, None], axis=2).min(axis=1)
            self.assertLess((distances - sampled).max(), 1e-9, shape)
            self.assertLess((sampled - distances).max(), 0.01, shape)
            np.testing.assert_allclose(np.linalg.norm(places - points, axis=1), distances)

    def test_outward_and_near(self):
        square = ("quad4", [(0, 0, 1), (0, 1, 1), (1, 1, 1), (1, 0, 1)], (0.5, 0.5, 0.5))
        _, normals, distances = projection.nearest([square], np.array([(0.3, 0.2, 1.1), (0.3, 0.2, 2)]), 0.5)
        np.testing.assert_allclose(normals[0], (0, 0, 1), atol=1e-12)
        np.testing.assert_allclose(distances, (0.1, np.inf))


class Adjust(Meanings):
    def foot(self, text):
        """Heights of the upper block's lower nodes after the import."""
        result = self.translate(text)
        return [round(result.model.points[result.model.assembly.nodes[n]][2], 12) for n in (11, 12, 13, 14)], result

    def tie(self, gap, more="", upper=None):
        return MODEL + (upper or apart(gap)) + f"*TIE, NAME=T{more}\nUPPER_BOTTOM, CUBE_TOP\n" + step(PRESS)

    def test_ties_move_their_nodes(self):
        for more in (", POSITION TOLERANCE=0.1", ", POSITION TOLERANCE=0.1, ADJUST=YES", ""):
            heights, result = self.foot(self.tie(0.05, more))
            self.assertEqual(heights, [1] * 4)
            self.assertEqual(result.deck["contacts"], [{"secondary": "UPPER_BOTTOM", "primary": "CUBE_TOP", "name": "T", "friction": {"bonded": True}}])
        self.assertEqual(self.foot(self.tie(0.05, ", POSITION TOLERANCE=0.1, ADJUST=NO"))[0], [1.05] * 4)
        self.assertEqual(self.findings(self.tie(0.05, ", POSITION TOLERANCE=0.1"), True), [])

    def test_ties_end_at_their_tolerance(self):
        for gap, more in ((0.2, ", POSITION TOLERANCE=0.1"), (0.1, "")):
            self.assertEqual(self.foot(self.tie(gap, more))[1].deck["contacts"], [])
            self.told(self.tie(gap, more), "nothing is tied")
        self.told(self.tie(0.05), "CalculiX's own tolerance", changes=False)
        tilted = self.tie(0.05, ", POSITION TOLERANCE=0.1", apart(0.05).replace("13,1,1,1.05", "13,1,1,1.2"))
        heights, result = self.foot(tilted)
        self.assertEqual(heights, [1, 1, 1.2, 1])
        self.assertEqual(result.deck["contacts"][0]["search_distance"], 0.1)
        self.told(tilted, "1 of 4 slave nodes are farther away")

    def test_ties_across_the_border_of_the_master(self):
        text = self.tie(0.05, ", POSITION TOLERANCE=0.1", apart(0.05).replace("12,1,0,", "12,1.5,0,").replace("13,1,1,", "13,1.5,1,"))
        self.assertEqual(self.foot(text)[0], [1, 1.05, 1.05, 1])
        self.told(text, "2 slave nodes lie beside the master", changes=False)

    def test_general_contact_takes_overlaps_away(self):
        head, law = "*SURFACE INTERACTION, NAME=I\n*CONTACT\n", "*CONTACT PROPERTY ASSIGNMENT\n,,I\n" + step(PRESS)
        for inclusions in (", ALL EXTERIOR\n", "\nUPPER_BOTTOM, CUBE_TOP\n"):
            general = head + f"*CONTACT INCLUSIONS{inclusions}" + law
            for gap, height in ((-0.05, 1), (0.05, 1.05), (0, 1)):
                self.assertEqual(self.foot(MODEL + apart(gap) + general)[0], [height] * 4)
                self.assertEqual(self.findings(MODEL + apart(gap) + general, True), [])
            self.told(MODEL + apart(-0.4) + general, "pass each other")

    def test_tied_pairs(self):
        pair = "*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I, TIED, ADJUST={}\nUPPER_BOTTOM, CUBE_TOP\n" + step(PRESS)
        self.told(MODEL + apart(0.05) + pair.format(0.01), "TIED: 4 slave nodes")
        self.assertEqual(self.findings(MODEL + apart(0.05) + pair.format(0.1), True), [])

    def test_contact_pairs(self):
        pair = "*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I, ADJUST={}\nUPPER_BOTTOM, CUBE_TOP\n" + step(PRESS)
        for gap, adjust, height in ((0.05, 0.1, 1), (0.05, 0.01, 1.05), (-0.05, 0.01, 1), (-0.05, 0, 1), (0.05, 0, 1.05)):
            self.assertEqual(self.foot(MODEL + apart(gap) + pair.format(adjust))[0], [height] * 4)
        some = MODEL + apart(0.05) + "*NSET, NSET=SOME\n11, 12\n" + pair.format("SOME")
        heights, result = self.foot(some)
        self.assertEqual((heights, result.deck["contacts"][0].get("clearance")), ([1, 1, 1.05, 1.05], None))
        self.assertEqual(self.findings(some, True), [])
        every = MODEL + apart(0.05) + "*NSET, NSET=SOME\n11, 12, 13, 14\n" + pair.format("SOME")
        self.assertEqual(self.foot(every)[1].deck["contacts"][0]["clearance"], 0)


class Laws(Meanings):
    def friction(self, card, behavior="", pair=""):
        laws = "*SURFACE INTERACTION, NAME=I\n" + behavior + card
        return MODEL + SECOND + laws + (pair or "*CONTACT PAIR, INTERACTION=I\nUPPER_BOTTOM, CUBE_TOP\n") + step(PRESS)

    def test_stick_slope(self):
        """Beside the shear modulus 80769 of cubes of size 1."""
        self.told(self.friction("*FRICTION\n0.3, 1.E5\n"), "81 %")
        self.told(self.friction("*FRICTION\n0.3, 1.E6\n"), "8.1 %", changes=False)
        stiff = self.friction("*FRICTION\n0.3, 1.E8\n")
        self.assertEqual(self.findings(stiff, True), [])
        self.assertEqual(len(self.findings(stiff, False)), 1)
        tied = self.friction("*FRICTION\n0.3, 1.E5\n", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1.E9\n")
        self.told(tied, "81 %")

    def test_elastic_slip(self):
        """Parts of the diagonal 1.414 of a face."""
        for parameter, part, changes in (
            ("SLIP TOLERANCE=0.005", None, None),
            ("SLIP TOLERANCE=0.02", "2 %", False),
            ("SLIP TOLERANCE=0.5", "50 %", True),
            ("ELASTIC SLIP=0.005", None, None),
            ("ELASTIC SLIP=0.02", "1.4 %", False),
            ("ELASTIC SLIP=0.2", "14 %", True),
        ):
            text = self.friction(f"*FRICTION, {parameter}\n0.3, 100.\n")  # the second number is a rate of slip
            if part:
                self.told(text, f"an elastic slip of {part}", changes)
            else:
                self.assertEqual(self.findings(text, True) + self.findings(text, False), [])

    def test_soft_general_contact(self):
        general = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n,,I\n"
        self.told(self.friction("", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.E5\n", general), "gives way")
        self.told(MODEL + SECOND + "*CONTACT\n" + step(PRESS), "no contact is made of it")


    def test_penalty_of_its_own(self):
        """Abaqus: a stiffness, and the clearance at which it begins."""
        self.told(self.friction("", "*SURFACE BEHAVIOR, PENALTY\n1.E5\n"), "gives way")
        self.told(self.friction("", "*SURFACE BEHAVIOR, AUGMENTED LAGRANGE\n1.E9, 0.01\n"), "clearance of 0.01")
        self.assertEqual(self.findings(self.friction("", "*SURFACE BEHAVIOR, PENALTY\n1.E9\n"), True), [])


    def test_tension_where_nodes_meet_faces(self):
        """CalculiX holds sides back up to its second number."""
        law = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.E9, {}\n"
        self.told(self.friction("", law.format("100.")), "a tension of up to 100")
        self.told(self.friction("", law.format("3.")), "a tension of up to 3 ", changes=False)
        surfaces = "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nUPPER_BOTTOM, CUBE_TOP\n"
        self.assertEqual(self.findings(self.friction("", law.format("100."), surfaces), True), [])

    def test_tied_law_pulls(self):
        law = "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1.E9\n"
        pair = "*CONTACT PAIR, INTERACTION=I{}\nUPPER_BOTTOM, CUBE_TOP\n" + step(PRESS)
        for gap in (0.05, -0.05):
            self.told(MODEL + apart(gap) + law + pair.format(""), "by force")
        self.assertEqual(self.findings(MODEL + apart(0.05) + law + pair.format(", ADJUST=0.1"), True), [])
        self.assertEqual(self.findings(MODEL + apart(0) + law + pair.format(""), True), [])

    def test_given_clearance_beside_adjust(self):
        law = "*SURFACE INTERACTION, NAME=I\n*CLEARANCE, SLAVE=UPPER_BOTTOM, MASTER=CUBE_TOP, VALUE=0.01\n"
        text = MODEL + apart(0.05) + law + "*CONTACT PAIR, INTERACTION=I, ADJUST=0.1\nUPPER_BOTTOM, CUBE_TOP\n" + step(PRESS)
        self.assertEqual(self.deck(text)["contacts"], [{"secondary": "UPPER_BOTTOM", "primary": "CUBE_TOP", "clearance": 0.01}])


class Couplings(Meanings):
    HEAD = MODEL + "*NODE\n50, .5, .5, 2.\n*SURFACE, NAME=GRIP\nCUBE, S2\n*SURFACE, NAME=SIDE\nCUBE, S4\n"
    GRIP = "*COUPLING, REF NODE=50, SURFACE=GRIP, CONSTRAINT NAME=C\n"

    def test_rotations_that_are_named(self):
        text = self.HEAD + self.GRIP + "*DISTRIBUTING\n{}" + step("*CLOAD\n50, 1, 7.\n50, 5, 3.\n")
        self.assertEqual(self.deck(text.format("1, 6\n"))["loads"], [{"coupling": "C", "force": [7, 0, 0], "moment": [0, 3, 0]}])
        self.told(text.format("1, 3\n"), "nothing is passed on")
        self.assertEqual(self.translate(text.format("1, 3\n")).deck["loads"], [{"coupling": "C", "force": [7, 0, 0]}])
        self.told(text.format(""), "CalculiX moves the first three alone")
        held = self.HEAD + self.GRIP + "*DISTRIBUTING\n1, 3\n" + step("*BOUNDARY\n50, 4, 6\n*CLOAD\n50, 1, 7.\n")
        self.assertEqual([s for s in self.deck(held)["supports"] if "coupling" in s], [])

    def test_degrees_of_freedom_of_reference_nodes(self):
        rigid = self.HEAD + "*NODE\n51, .5, .5, 2.\n*RIGID BODY, NSET=TOP, REF NODE=50, ROT NODE=51\n"
        for load in ("*CLOAD\n51, 5, 1.\n", "*CLOAD\n50, 7, 1.\n", "*BOUNDARY\n50, 11, 11, 0.1\n"):
            self.told(rigid + step(load), "of a reference node")
        self.assertEqual(self.findings(rigid + step("*BOUNDARY\n51, 1, 6\n*CLOAD\n50, 1, 1.\n"), True), [])

    def test_reference_nodes(self):
        both = self.HEAD + self.GRIP + "*KINEMATIC\n1, 3\n" + self.GRIP.replace("GRIP", "SIDE") + "*{}\n1, 3\n" + step("*CLOAD\n50, 1, 7.\n")
        result = self.translate(both.format("KINEMATIC"))
        self.assertEqual(len(result.boundaries[result.deck["couplings"]["C"]["boundary"]]), 2)
        self.assertEqual([f.reason for f in result.model.findings if f.changes], [])
        self.told(both.format("DISTRIBUTING"), "a coupling already")
        own = self.HEAD + self.GRIP.replace("50", "{}") + "*KINEMATIC\n1, 3\n" + step("*CLOAD\n1, 3, 1.\n")
        self.told(own.format(2), "belongs to a solid")
        self.assertEqual(self.findings(own.format(6), True), [])


class Repeated(Meanings):
    def test_members_that_are_loaded_twice(self):
        for sets, force in (("*NSET, NSET=D\n5, 6, 5\n", [2, 1]), ("*NSET, NSET=D\n5, 6\n*NSET, NSET=D\n5\n", [2, 1]),
                            ("*NSET, NSET=E\n5, 6\n*NSET, NSET=D\nE, 5\n", [2, 1]), ("*NSET, NSET=D, GENERATE\n5, 6\n5, 7, 2\n", [2, 1])):  # fmt: skip
            text = MODEL + sets + step("*CLOAD\nD, 3, 1.\n")
            self.told(text, "more than once")
            forces = {tuple(p): load["force"][2] / len(load["points"]) for load in self.translate(text).deck["loads"] for p in load["points"]}
            self.assertEqual([forces[0, 0, 1], forces[1, 0, 1]], force)
        for text in ("*ELSET, ELSET=D\n1, 1\n" + step("*DLOAD\nD, P2, 1.\n"), "*SURFACE, NAME=S\n1, S2\n1, S2\n" + step("*DSLOAD\nS, P, 1.\n"),
                     "*ELSET, ELSET=D\n1, 1\n*SURFACE, NAME=S\nD, S2\n" + step("*DSLOAD\nS, P, 1.\n")):  # fmt: skip
            self.told(MODEL + text, "more than once")
            self.assertEqual(self.translate(MODEL + text).deck["loads"][0]["pressure"], 2)
        held = MODEL + "*NSET, NSET=D\n5, 5\n" + step("*BOUNDARY\nD, 3, 3, 0.1\n*TEMPERATURE\nD, 9.\n")
        self.assertEqual(self.findings(held, True), [])


    def test_sets_that_grow_after_they_are_used(self):
        for between in ("*NSET, NSET=D\nTOP\n{}" + step("*CLOAD\nD, 3, 1.\n"), "*BOUNDARY\nTOP, 1\n{}" + step("*DLOAD\n1, P2, 1.\n")):
            self.told(MODEL + between.format("*NSET, NSET=TOP\n1\n"), "more members in lines below")
            self.assertEqual(self.findings(MODEL + between.format(""), True), [])
        self.assertEqual(self.findings(MODEL + "*NSET, NSET=TOP\n1\n*BOUNDARY\nTOP, 1\n" + step("*DLOAD\n1, P2, 1.\n"), True), [])


class Steps(Meanings):
    def test_first_card_decides_on_what_is_forgotten(self):
        deck = self.deck(MODEL + step("*CLOAD\nTOP, 3, 1.\n") + step("*CLOAD\nTOP, 1, 2.\n*CLOAD, OP=NEW\n5, 3, 3.\n"))
        acting = sum(np.array(load["force"]) * deck["steps"][1].get("scale", {}).get(load["name"], 1) for load in deck["loads"])
        self.assertEqual(list(acting), [8, 0, 6])
        self.told(MODEL + step("*CLOAD\nTOP, 3, 1.\n") + step("*CLOAD\n5, 1, 2.\n*CLOAD, OP=NEW\n5, 3, 3.\n"), "first *CLOAD", changes=False)

    def test_faces_and_surfaces_are_forgotten_apart(self):
        first = MODEL + "*SURFACE, NAME=S\n1, S2\n" + step("*DLOAD\n1, P3, 1.\n*DSLOAD\nS, P, 1.\n")
        self.told(first + step("*DLOAD, OP=NEW\n1, P4, 1.\n"), "CalculiX forgets them too")
        self.told(first.replace("P3", "P2") + step("*DSLOAD, OP=NEW\nS, P, 1.\n"), "CalculiX forgets them too")
        self.assertEqual(self.findings(first + step("*CLOAD, OP=NEW\n5, 1, 1.\n"), True), [])

    def test_loads_of_bodies_that_programs_replace_otherwise(self):
        weight = MODEL + step("*DLOAD\nCUBE, GRAV, 9., 0., 0., -1.\n")
        for again in ("CUBE, GRAV, 9., 0., 0., 1.", "CUBE, GRAV, 9., 1., 0., 0.", "1, GRAV, 9., 0., 0., -1."):
            self.told(weight + step(f"*DLOAD\n{again}\n"), "CalculiX keeps both")
            self.assertEqual(self.findings(weight + step(f"*DLOAD, OP=NEW\n{again}\n"), True), [])
        self.assertEqual(self.findings(weight + step("*DLOAD\nCUBE, GRAV, 5., 0., 0., -1.\n"), True), [])
        turning = MODEL + step("*DLOAD\nCUBE, CENTRIF, 9., 0., 0., 0., 0., 0., 1.\n")
        self.told(turning + step("*DLOAD\nCUBE, CENTRIF, 9., 1., 0., 0., 0., 0., 1.\n"), "second axis")
        self.assertEqual(self.findings(turning + step("*DLOAD\nCUBE, CENTRIF, 5., 0., 0., 0., 0., 0., 1.\n"), True), [])

    def test_amplitudes(self):
        smooth = "*AMPLITUDE, NAME=A, DEFINITION=SMOOTH STEP\n0., 0., 4., 1.\n"
        load = self.deck(MODEL + smooth + step("*DLOAD, AMPLITUDE=A\n1, P2, 1.\n"))["loads"][0]
        self.assertAlmostEqual(load["pressure"], 0.25**3 * (10 - 15 * 0.25 + 6 * 0.25**2))
        absolute = MODEL + "*AMPLITUDE, NAME=A, VALUE=ABSOLUTE\n0., 0., 1., 7.\n" + step("*DLOAD, AMPLITUDE=A\n1, P2, 2.\n")
        self.told(absolute, "ABSOLUTE")
        held = MODEL.replace("*BOUNDARY", "*AMPLITUDE, NAME=A\n0., 0., 1., 7.\n*BOUNDARY, AMPLITUDE=A")
        self.told(held + step("*DLOAD\n1, P2, 2.\n"), "before the first step")


class Parts(Meanings):
    WOOD = "*MATERIAL, NAME=WOOD\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n11,6,4,.35,.4,.3,.7,.8\n.06\n"

    def part(self, name, orientation):
        return f"*PART, NAME={name}\n{CUBE}*ORIENTATION, NAME=G{orientation}\n*SOLID SECTION, ELSET=CUBE, MATERIAL=WOOD, ORIENTATION=G\n*END PART\n"

    def axes(self, text):
        deck = self.translate(text + self.WOOD + step("")).deck
        return {body: deck["axes"][deck["materials"][entry["material"]]["orthotropic"]["axes"]] for body, entry in deck["bodies"].items()}

    def test_orientations_of_parts_are_their_own(self):
        text = self.part("P", "\n0,1,0, 0,0,1") + self.part("Q", "\n0,0,1, 1,0,0")
        for p in ("P", "Q"):
            text += f"*INSTANCE, NAME={p}1, PART={p}\n{2 if p == 'P' else 4},0,0\n*END INSTANCE\n"
        self.assertEqual(self.axes(text), {"P1": {"x": [0, 1, 0], "y": [0, 0, 1]}, "Q1": {"x": [0, 0, 1], "y": [1, 0, 0]}})

    def test_cylinders_move_with_their_instance(self):
        text = self.part("P", ", SYSTEM=CYLINDRICAL\n0,0,0, 0,0,1")
        for k in (1, 2):
            text += f"*INSTANCE, NAME=I{k}, PART=P\n{3 * k},0,0\n*END INSTANCE\n"
        found = self.axes(text)
        self.assertEqual([found[f"I{k}"]["point"] for k in (1, 2)], [[3, 0, 0], [6, 0, 0]])

    TURN = "1,0,0\n2,0,0, 2,0,5, 90.\n*END INSTANCE\n"  # (x, y, z) goes to (2 - y, x - 1, z)

    def test_directions_turn_with_their_instance(self):
        found = self.axes(self.part("P", "\n1,1,0, 0,1,0") + "*INSTANCE, NAME=I, PART=P\n" + self.TURN)["I"]
        np.testing.assert_allclose(found["x"], (-1, 1, 0), atol=1e-12)
        np.testing.assert_allclose(found["y"], (-1, 0, 0), atol=1e-12)
        found = self.axes(self.part("P", ", SYSTEM=CYLINDRICAL\n3,0,0, 3,1,0") + "*INSTANCE, NAME=I, PART=P\n" + self.TURN)["I"]
        np.testing.assert_allclose(found["point"], (2, 2, 0), atol=1e-12)
        np.testing.assert_allclose(found["axis"], (-1, 0, 0), atol=1e-12)

    def test_axes_of_supports_turn_with_their_instance(self):
        text = f"*PART, NAME=P\n{CUBE}*NSET, NSET=FOOT\n1,2,3,4\n*TRANSFORM, NSET=FOOT\n1,0,0, 0,1,0\n"
        text += "*SOLID SECTION, ELSET=CUBE, MATERIAL=WOOD\n*END PART\n*INSTANCE, NAME=I, PART=P\n" + self.TURN + self.WOOD
        deck = self.translate(text + step("*BOUNDARY\nI.FOOT,1,1,0.5\n*BOUNDARY\nI.FOOT,2,3\n")).deck
        axes = next(s["axes"] for s in deck["supports"] if s["displacement"].get("x"))
        np.testing.assert_allclose(deck["axes"][axes]["x"], (0, 1, 0), atol=1e-12)

    def test_one_material_with_and_without_directions(self):
        text = CUBE + SECOND.replace("MATERIAL=STEEL", "MATERIAL=WOOD, ORIENTATION=G") + "*SOLID SECTION, ELSET=CUBE, MATERIAL=WOOD\n"
        deck = self.translate(text + "*ORIENTATION, NAME=G\n0,1,0, 0,0,1\n" + self.WOOD + step("")).deck
        of = {body: deck["materials"][entry["material"]]["orthotropic"].get("axes") for body, entry in deck["bodies"].items()}
        self.assertEqual(of, {"CUBE": None, "UPPER": "G"})

    def test_sets_of_parts(self):
        """A spring of a part finds its elements there; the assembly has a set of the same name."""
        part = f"*PART, NAME=P\n{CUBE}*ELEMENT, TYPE=SPRINGA, ELSET=S\n77, 5, 3\n*SPRING, ELSET=S\n\n12.5\n"
        part += "*SOLID SECTION, ELSET=CUBE, MATERIAL=STEEL\n*END PART\n"
        text = part + "*INSTANCE, NAME=A, PART=P\n*END INSTANCE\n*INSTANCE, NAME=B, PART=P\n3,0,0\n*END INSTANCE\n*ELSET, ELSET=S, INSTANCE=A\n1\n"
        springs = self.deck(text + STEEL.replace("*SOLID SECTION, ELSET=CUBE, MATERIAL=STEEL\n", "") + step("*DLOAD\nA.CUBE, P2, 1.\n"))["springs"]
        self.assertEqual({name: s["points"][0] for name, s in springs.items()}, {"A.spring.77": [0, 0, 1], "B.spring.77": [3, 0, 1]})


class Others(Meanings):
    def test_thickness_is_told(self):
        plate = (
            "*NODE, NSET=ALL\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n*ELEMENT, TYPE=CPE4, ELSET=PLATE\n1, 1,2,3,4\n*MATERIAL, NAME=STEEL\n"
            "*ELASTIC\n2.1E5, 0.3\n*SOLID SECTION, ELSET=PLATE, MATERIAL=STEEL\n{}\n*BOUNDARY\n1, 1, 2\n2, 1, 2\n" + step("*DLOAD\n1, P3, 1.\n")
        )
        self.told(plate.format(0.4), "a thickness of 0.4", changes=False)
        self.assertEqual(self.findings(plate.format(1.0), False), [])

    def test_prisms_are_integrated_in_full(self):
        head = CUBE[: CUBE.index("*ELEMENT")] + "*ELEMENT, TYPE=C3D6, ELSET=CUBE\n1,1,2,3,5,6,7\n"
        self.told(head + MODEL[len(CUBE) :] + step("*DLOAD\n1, P2, 1.\n"), "take 2 points", changes=False)

    def test_what_is_refused(self):
        for text, why in (
            (MODEL + "*BOUNDARY\nTOP\n", "a degree of freedom"),
            (MODEL + "*BOUNDARY\nTOP, 0\n", "from 1 on"),
            (MODEL + step("*CLOAD\nTOP, 0, 1.\n"), "from 1 on"),
            (MODEL + "*MATERIAL, NAME=steel\n*ELASTIC\n1., 0.\n", "given twice"),
            (MODEL + "*SURFACE INTERACTION, NAME=I\n*SURFACE INTERACTION, NAME=i\n", "given twice"),
        ):
            self.assertIn(why, self.refused(text))

    def test_parameters_and_rows_that_count(self):
        rigid = CUBE + "*NODE\n9, 0.5, 0.5, 2.\n" + STEEL + "*NSET, NSET=TOP\n5, 6, 7, 8\n*BOUNDARY\n1, 1, 3\n2, 1, 3\n3, 1, 3\n4, 1, 3\n"
        rigid += "*RIGID BODY, NSET=TOP, REF NODE=9{}\n" + step("*CLOAD\n9, 3, 1.\n")
        self.told(rigid.format(", POSITION=CENTER OF MASS"), "POSITION")
        self.assertEqual(self.findings(rigid.format(", POSITION=INPUT"), True), [])
        self.told(MODEL + "*CYCLIC SYMMETRY MODEL, N=4, TIE=T\n0,0,0, 0,0,1\n" + step("*DLOAD\n1, P2, 1.\n"), "belongs to no *TIE")
        springs = MODEL + "*ELEMENT, TYPE=SPRINGA, ELSET=STRUT\n77, 5, 3\n*SPRING, ELSET=STRUT\n\n1.,,0.\n5.,,100.\n" + step("*DLOAD\nCUBE, P2, 1.\n")
        self.told(springs, "temperature")


if __name__ == "__main__":
    unittest.main()
