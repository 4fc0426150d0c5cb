#!/usr/bin/python3
"""Loads, supports, steps and contacts: what ./mortise import makes of an input file, without the program."""

import unittest

from sample_models import CUBE, MODEL, SECOND, STEEL, Import, step


class Loads(Import):
    def loads(self, text):
        return self.deck(MODEL + step(text))["loads"]

    def test_pressures_add_within_a_step(self):
        self.assertEqual(self.loads("*DLOAD\n1, P2, 1.\nCUBE, P2, 2.\n"), [{"boundary": "loaded", "pressure": 3.0}])

    def test_weight_and_warmth(self):
        loads = self.loads("*DLOAD\nCUBE, GRAV, 9810., 0., 0., -2.\n*TEMPERATURE\nALL, 80.\n")
        self.assertEqual(loads, [{"body": "CUBE", "acceleration": [0, 0, -9810]}, {"body": "CUBE", "temperature_change": 80}])
        warm = self.deck(MODEL + "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n" + step("*TEMPERATURE\nALL, 80.\n"))
        self.assertEqual(warm["loads"], [{"body": "CUBE", "temperature_change": 60}])

    def test_warmth_that_varies(self):
        """A file for each body, of as many fields as it takes; what is a multiple of one field needs no other."""
        one = self.translate(MODEL + step("*TEMPERATURE\nTOP, 80.\n") + step("*TEMPERATURE\nTOP, 20.\n"))
        loads = one.deck["loads"]
        self.assertEqual([load["temperature_change"]["field"] for load in loads], ["warmth_1"])
        self.assertEqual(one.deck["steps"][1]["scale"], {loads[0]["name"]: 0.25})
        (number, fields), = one.temperatures.values()
        self.assertEqual(sorted(fields["warmth_1"].values()), [0, 0, 0, 0, 80, 80, 80, 80])
        two = self.translate(MODEL + step("*TEMPERATURE\nTOP, 80.\n") + step("*TEMPERATURE\nTOP, 20.\nBOTTOM, 10.\n"))
        self.assertEqual([load["temperature_change"]["field"] for load in two.deck["loads"]], ["warmth_1", "warmth_2"])

    def test_amplitudes_in_total_time_go_on(self):
        rising = "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n0.,0., 4.,8.\n"
        deck = self.deck(MODEL + rising + step("*DLOAD, AMPLITUDE=A\n1, P2, 1.\n") + step("") + step("*DLOAD\n1, P2, 5.\n"))
        self.assertEqual(deck["loads"][0]["pressure"], 5)
        self.assertEqual([s["scale"] for s in deck["steps"]], [{"pressure_loaded": 0.4}, {"pressure_loaded": 0.8}, {"pressure_loaded": 1.0}])
        moved = self.deck(MODEL + rising + step("*BOUNDARY, AMPLITUDE=A\nTOP, 3, 3, 0.1\n") + step(""))
        self.assertEqual([s.get("scale") for s in moved["steps"]], [{"TOP": 0.5}, {"TOP": 1.0}])
        text = MODEL + rising + step("*CLOAD, AMPLITUDE=A\nTOP, 3, 1.\n*CLOAD\nTOP, 3, 1.\n") + step("")
        self.assertIn("is not followed", self.left_out(text)[0][2])

    def test_amplitudes_are_shifted(self):
        text = MODEL + "*AMPLITUDE, NAME=A, SHIFTX=0.5, SHIFTY=1.\n0.,0., 1.,0.5, 2.,3.\n" + step("*DLOAD, AMPLITUDE=A\n1, P2, 8.\n")
        self.assertEqual(self.deck(text)["loads"], [{"boundary": "loaded", "pressure": 10.0}])

    def test_gravity_that_turns(self):
        both = MODEL + step("*DLOAD\nCUBE, GRAV, 9., 0., 0., -1.\n") + step("*DLOAD\nCUBE, GRAV, 5., 0., 1., 0.\n")
        reasons = [f.reason for f in self.translate(both).model.findings]
        self.assertEqual(sum("CalculiX keeps both" in r for r in reasons), 1)

    def test_turning(self):
        loads = self.loads("*DLOAD\nCUBE, CENTRIF, 9.E4, 1., 2., 0., 0., 0., 2.\n")
        self.assertEqual(loads, [{"body": "CUBE", "centrifugal": {"axis": [0, 0, 1], "point": [1, 2, 0], "speed": 300}}])
        self.assertIn("direction", self.refused(MODEL + step("*DLOAD\nCUBE, CENTRIF, 9.E4, 1., 2., 0.\n")))
        self.assertIn("not negative", self.refused(MODEL + step("*DLOAD\nCUBE, CENTRIF, -9.E4, 1., 2., 0., 0., 0., 2.\n")))

    def test_forces_of_a_uniform_traction(self):
        self.assertEqual(self.loads("*CLOAD\nTOP, 3, -2.\n"), [{"boundary": "TOP", "force": [0, 0, -8]}])
        uneven = self.translate(MODEL + step("*CLOAD\nTOP, 3, -2.\n5, 3, -1.\n"))
        self.assertEqual([f.reason for f in uneven.model.findings if f.changes], [])
        sums = [sum(load["force"][2] for load in uneven.deck["loads"]), sum(len(load.get("points", [])) for load in uneven.deck["loads"])]
        self.assertIn(sums, ([-9, 1], [-9, 4], [-9, 5]))  # the uniform part on its face or all of them on their nodes
        self.assertEqual(self.loads("*CLOAD\n5, 3, -2.\n"), [{"points": [[0, 0, 1]], "body": "CUBE", "force": [0, 0, -2]}])

    def test_supports_that_are_no_faces(self):
        text = MODEL + "*BOUNDARY\n5, 1\n6, 1, 2, 0.5\n" + step("*DLOAD\nCUBE, P2, 1.\n")
        self.assertEqual(self.left_out(text), [])
        points = [s for s in self.deck(text)["supports"] if "points" in s]
        self.assertEqual([(s["points"], s["displacement"]) for s in points], [([[0, 0, 1]], {"x": 0}), ([[1, 0, 1]], {"x": 0.5, "y": 0.5})])

    def test_springs(self):
        springs = "*ELEMENT, TYPE=SPRINGA, ELSET=STRUT\n77, 5, 3\n*SPRING, ELSET=STRUT\n\n12.5\n"
        deck = self.deck(MODEL + springs + step("*DLOAD\nCUBE, P2, 1.\n"))
        self.assertEqual(deck["springs"], {"spring.77": {"points": [[0, 0, 1], [1, 1, 0]], "bodies": ["CUBE", "CUBE"], "stiffness": 12.5}})
        self.assertEqual(self.left_out(MODEL + springs + step("*DLOAD\nCUBE, P2, 1.\n")), [])
        lost = self.left_out(MODEL + springs.replace("*SPRING,", "*SPRING, NONLINEAR,") + step("*DLOAD\nCUBE, P2, 1.\n"))
        self.assertEqual(sorted(entry[1] for entry in lost), ["*ELEMENT", "*SPRING"])

    def test_coupled_points_with_axes_of_their_own(self):
        """x' = y, y' = -x: motions where all are given, forces in any case; what is held along some of them is left out."""
        text = MODEL + "*NODE\n9, 0.5, 0.5, 2.\n*NSET, NSET=REF\n9\n*RIGID BODY, NSET=TOP, REF NODE=9\n*TRANSFORM, NSET=REF\n0,1,0, -1,0,0\n"
        held = self.deck(text + step("*BOUNDARY\n9, 1, 1, 0.1\n9, 2, 2, 0.2\n9, 3, 3, 0.3\n"))["supports"][-1]["displacement"]
        self.assertEqual({k: round(v, 12) for k, v in held.items()}, {"x": -0.2, "y": 0.1, "z": 0.3})
        pushed = self.deck(text + step("*CLOAD\n9, 1, 5.\n9, 5, 2.\n"))["loads"][0]
        self.assertEqual((pushed["force"], pushed["moment"]), ([0, 5, 0], [-2, 0, 0]))
        self.assertIn("alone", self.left_out(text + step("*BOUNDARY\n9, 1, 1, 0.1\n"))[0][2])

    def test_thickness(self):
        """Of plane models: what acts on nodes, and springs between them, is that of a thickness 1 in the deck."""
        text = (
            "*NODE, NSET=ALL\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n9, 0.5, 2\n*ELEMENT, TYPE=CPS4, ELSET=PLATE\n1, 1,2,3,4\n"
            + "*MATERIAL, NAME=STEEL\n*ELASTIC\n2.1E5, 0.3\n*SOLID SECTION, ELSET=PLATE, MATERIAL=STEEL\n0.25\n"
            + "*ELEMENT, TYPE=SPRINGA, ELSET=STRUT\n77, 1, 3\n*SPRING, ELSET=STRUT\n\n30.\n*NSET, NSET=TOP\n3, 4\n"
            + "*RIGID BODY, NSET=TOP, REF NODE=9\n*BOUNDARY\n1, 1, 2\n2, 1, 2\n"
        )
        deck = self.deck(text + step("*CLOAD\n9, 2, 1.\n9, 6, 2.\n"))
        self.assertEqual(deck["springs"]["spring.77"]["stiffness"], 120)
        self.assertEqual(deck["loads"], [{"coupling": "TOP_2", "force": [0, 4], "moment": [0, 0, 8]}])

    def test_supports_at_common_edges(self):
        """A node that two sets hold belongs to the faces of both, and one that a face holds already needs no more."""
        text = (
            CUBE
            + STEEL
            + "*NSET, NSET=X0\n1, 4, 5, 8\n*NSET, NSET=Y0\n1, 2, 5, 6\n*BOUNDARY\nX0, XSYMM\nY0, 1, 2\n1, 1\n"
            + step("*DLOAD\n1, P2, 1.\n")
        )
        self.assertEqual(
            [(s["boundary"], s["displacement"]) for s in self.deck(text)["supports"]], [("X0", {"x": 0}), ("Y0", {"x": 0, "y": 0})]
        )

    def test_steps(self):
        text = (
            MODEL
            + step("*DLOAD\nCUBE, P2, 10.\n*BOUNDARY\nTOP, 1, 1, 0.1\n")
            + step("*DLOAD\nCUBE, P2, 20.\n*BOUNDARY, OP=NEW\nBOTTOM, 1, 3\n")
        )
        deck = self.deck(text + step("*DLOAD, OP=NEW\n"))
        self.assertEqual(deck["loads"], [{"boundary": "TOP", "pressure": 20.0, "name": "pressure_TOP"}])
        self.assertEqual(
            deck["steps"],
            [
                {"name": "1", "scale": {"pressure_TOP": 0.5}},
                {"name": "2", "scale": {"pressure_TOP": 1.0}, "off": ["TOP"]},
                {"name": "3", "scale": {"pressure_TOP": 0.0}},
            ],
        )

    def test_amplitudes_count_at_the_end(self):
        table = "*AMPLITUDE, NAME=A\n0., 0., 2., 1.\n"
        self.assertEqual(
            self.deck(MODEL + table + step("*DLOAD, AMPLITUDE=A\nCUBE, P2, 10.\n"))["loads"], [{"boundary": "CUBE_P2", "pressure": 5.0}]
        )


class Contacts(Import):
    PAIR = "*SURFACE INTERACTION, NAME=I\n{law}*CONTACT PAIR, INTERACTION=I{more}\nUPPER_BOTTOM, CUBE_TOP\n"

    def contact(self, law="", more="", extra=""):
        text = MODEL + SECOND + self.PAIR.format(law=law, more=more) + extra
        return self.deck(text + step("*DLOAD\nUPPER, P2, 5.\n"))["contacts"][0]

    def test_laws_that_give_way(self):
        law = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={}\n"
        text = lambda own: MODEL + SECOND + self.PAIR.format(law=own, more="") + step("*DLOAD\nUPPER, P2, 5.\n")
        reasons = lambda own, changes: [f.reason for f in self.translate(text(own)).model.findings if f.changes == changes]
        self.assertIn("1e+02 %", self.left_out(text(law.format("LINEAR") + "2.1E5\n"))[0][2])
        self.assertTrue(any("10 %" in r for r in reasons(law.format("LINEAR") + "2.1E6\n", False)))
        self.assertEqual(reasons(law.format("LINEAR") + "1.E9\n", True), [])
        self.assertIn("clearance of 0.01", self.left_out(text(law.format("EXPONENTIAL") + "0.01, 10.\n"))[0][2])
        self.assertIn("TABULAR", self.left_out(text(law.format("TABULAR") + "0., 0.\n10., 0.1\n"))[0][2])

    def test_laws(self):
        sides = {"secondary": "UPPER_BOTTOM", "primary": "CUBE_TOP"}
        self.assertEqual(self.contact(), sides)
        self.assertEqual(self.contact("*FRICTION\n.3, 1.E7\n", ", ADJUST=0.1"), {**sides, "friction": {"coulomb": 0.3}, "adjust": 0.1})
        self.assertEqual(self.contact(extra="*CLEARANCE, SLAVE=UPPER_BOTTOM, MASTER=CUBE_TOP, VALUE=0.02\n"), {**sides, "clearance": 0.02})
        tie = self.deck(MODEL + SECOND + "*TIE, NAME=T\nUPPER_BOTTOM, CUBE_TOP\n" + step("*DLOAD\nUPPER, P2, 5.\n"))
        self.assertEqual(tie["contacts"], [{**sides, "name": "T", "friction": {"bonded": True}}])

    def test_general_contact(self):
        def made(inclusions, assignment):
            laws = "*SURFACE INTERACTION, NAME=I\n*FRICTION\n.3\n*CONTACT\n"
            general = f"*CONTACT INCLUSIONS{inclusions}*CONTACT PROPERTY ASSIGNMENT\n{assignment}, I\n"
            text = MODEL + SECOND + laws + general + step("*DLOAD\nUPPER, P2, 5.\n")
            return self.translate(text).deck["contacts"], [f.keyword for f in self.translate(text).model.findings if f.changes]

        sides, friction = {"secondary": "UPPER_BOTTOM", "primary": "CUBE_TOP"}, {"friction": {"coulomb": 0.3}}
        pair = "\nUPPER_BOTTOM, CUBE_TOP\n"
        self.assertEqual(made(pair, ","), ([{**sides, **friction}], []))
        self.assertEqual(made(pair, "CUBE_TOP, UPPER_BOTTOM"), ([{**sides, **friction}], []))
        self.assertEqual(made(", ALL EXTERIOR\n", ","), ([{"auto": True, **friction}], []))
        self.assertEqual(made(pair, "CUBE_TOP,"), ([sides], ["*CONTACT PROPERTY ASSIGNMENT"]))
        self.assertEqual(made("\n, CUBE_TOP\n", ",")[1], ["*CONTACT INCLUSIONS", "*CONTACT PROPERTY ASSIGNMENT"])

    def test_bodies_do_not_touch_themselves(self):
        text = (
            MODEL + SECOND.replace("2,11,12,13,14,15", "2,5,6,7,8,15").replace("UPPER, S1", "UPPER, S3") + self.PAIR.format(law="", more="")
        )
        self.assertTrue(any("*CONTACT PAIR" == k for _, k, _ in self.left_out(text + step(""))))

    def test_bolts(self):
        bolt = MODEL.replace("*BOUNDARY", "*NODE\n99, 0., 0., 9.\n*BOUNDARY", 1)
        long = bolt + SECOND.replace("2,11,12,13,14,15", "2,5,6,7,8,15").replace("CUBE, S2", "1, S2").replace(
            "*SURFACE, NAME=UPPER_BOTTOM\nUPPER, S1\n", ""
        )
        text = (
            long
            + "*PRE-TENSION SECTION, SURFACE=CUBE_TOP, NODE=99\n"
            + step("*CLOAD\n99, 1, 50.\n")
            + step("*BOUNDARY, FIXED\n99, 1\n*DLOAD\nUPPER, P2, 1.\n")
        )
        deck = self.deck(text)
        self.assertEqual(len(deck["bodies"]), 2)
        self.assertEqual(deck["contacts"][0]["preload"], {"force": 50.0})
        self.assertEqual(
            deck["steps"], [{"name": "1", "scale": {"pressure_UPPER_P2": 0.0}}, {"name": "2", "scale": {"pressure_UPPER_P2": 1.0}}]
        )
        for direction, sign in (("0, 0, 2.", 1), ("0, 0, -1.", -1)):
            cut = long + f"*PRE-TENSION SECTION, SURFACE=CUBE_TOP, NODE=99\n{direction}\n" + step("*BOUNDARY\n99, 1, 1, 0.25\n")
            self.assertEqual(self.deck(cut)["contacts"][0]["preload"], {"shortening": sign * 0.25})
        oblique = long + "*PRE-TENSION SECTION, SURFACE=CUBE_TOP, NODE=99\n1, 0, 1\n" + step("*BOUNDARY\n99, 1, 1, 0.25\n")
        self.assertIn("not the normal", self.left_out(oblique)[0][2])
        warm = self.deck(text.replace("99, 1, 50.\n", "99, 1, 50.\n*TEMPERATURE\nALL, 9.\n15, 9.\n16, 9.\n17, 9.\n18, 9.\n", 1))  # the nodes that the cut doubles as well
        self.assertEqual([load["temperature_change"] for load in warm["loads"] if "temperature_change" in load], [9, 9])


if __name__ == "__main__":
    unittest.main()
