#!/usr/bin/python3
"""Cards, sets, parts, materials, what is left out: what ./mortise import makes of an input file, without the program."""

import contextlib
import io
import pathlib
import unittest

from sample_models import CUBE, HELD, MODEL, SECOND, STEEL, Import, step  # sets the path of the modules under test, too

import elements
import import_deck
from reader import InputError, read_cards, real


class Cards(Import):
    def cards(self, text, **files):
        for name, content in files.items():
            (self.folder / f"{name}.txt").write_text(content)
        (self.folder / "model.inp").write_text(text)
        return read_cards(self.folder / "model.inp")

    def test_case_blanks_comments_and_lines_that_go_on(self):
        found = self.cards('** first\n*Solid Section,\n  elset = "My Set",\n** between\n material=St\n 1. ,\n\n** after\n*STEP\n')
        self.assertEqual([c.name for c in found], ["SOLIDSECTION", "STEP"])
        self.assertEqual(found[0].parameters, {"ELSET": "My Set", "MATERIAL": "St"})
        self.assertEqual((found[0].line, found[0].data), (2, [(6, ["1."])]))

    def test_includes_cards_and_data(self):
        found = self.cards("*NODE\n*INCLUDE, INPUT=more.txt\n2,1,1,1\n", more="1,0,0,0\n*NSET, NSET=A\n1,\n")
        self.assertEqual([(c.name, len(c.data)) for c in found], [("NODE", 1), ("NSET", 2)])
        with self.assertRaisesRegex(InputError, "includes itself"):
            self.cards("*INCLUDE, INPUT=a.txt\n", a="*INCLUDE, INPUT=a.txt\n")
        with self.assertRaisesRegex(InputError, r'model.inp:2: there is no file "b.txt"'):
            self.cards("*HEADING\n*INCLUDE, INPUT=b.txt\n")

    def test_numbers_of_fortran(self):
        self.assertEqual([real(t) for t in ("1.5D+3", "1.5+3", ".5", "2.", "-1e-2")], [1500, 1500, 0.5, 2, -0.01])
        for text in ("nan", "inf", "1,5", "", "0x10", "1e400", "1_0", "--1"):
            self.assertRaises(ValueError, real, text)


class Mesh(Import):
    def test_faces_have_the_areas_of_a_traction(self):
        square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0, 0), (1, 0.5, 0), (0.5, 1, 0), (0, 0.5, 0)]
        for shape, expected in (("quad4", [1 / 4] * 4), ("quad8", [-1 / 12] * 4 + [1 / 3] * 4)):
            for value, right in zip(elements.nodal_areas(shape, square[: elements.NODES[shape]]), expected):
                self.assertAlmostEqual(value, right)
        triangle = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.5, 0, 0), (0.5, 0.5, 0), (0, 0.5, 0)]
        for value, right in zip(elements.nodal_areas("tri6", triangle), [0] * 3 + [1 / 6] * 3):
            self.assertAlmostEqual(value, right)
        for value, right in zip(elements.nodal_areas("line3", [(0, 0, 0), (3, 0, 0), (1.5, 0, 0)]), [0.5, 0.5, 2]):
            self.assertAlmostEqual(value, right)

    def test_middle_nodes_of_gmsh(self):
        """Every node of a cell lies between the corners that gmsh expects."""
        for shape in ("tet10", "hex20", "prism15"):
            of = elements.family(shape)
            corners = elements.CORNERS[of]
            names = [{i} for i in range(corners)] + [set(pair) for pair in elements.EDGES[of]]
            ours = [names[k] for k in elements.to_gmsh(shape)][corners:]
            self.assertEqual(ours, [set(pair) for pair in elements.GMSH_EDGES[of]])

    def test_sets_of_sets_before_they_are_given(self):
        text = CUBE + STEEL + "*BOUNDARY\nOuter, 1, 3\n*NSET, NSET=OUTER\ninner, 4\n*NSET, NSET=INNER, GENERATE\n1, 3, 1\n"
        self.assertEqual(
            self.deck(text + step("*DLOAD\nCUBE, P2, 5.\n"))["supports"], [{"boundary": "Outer", "displacement": {"x": 0, "y": 0, "z": 0}}]
        )
        self.assertIn(
            "holds itself",
            self.refused(text.replace("1, 3, 1", "1, 3\n").replace(", GENERATE", "").replace("1, 3\n\n", "OUTER\n") + step("")),
        )

    def test_bodies_are_what_hangs_together(self):
        deck = self.deck(MODEL + SECOND + step("*DLOAD\nUPPER, P2, 5.\n"))
        self.assertEqual(list(deck["bodies"]), ["CUBE", "UPPER"])
        joined = MODEL + SECOND.replace("2,11,12,13,14,15", "2,5,6,7,8,15")
        body = self.deck(joined + step("*DLOAD\nUPPER, P2, 5.\n"))["bodies"]
        self.assertEqual(list(body.values()), [{"volumes": {"CUBE_CUBE": "STEEL", "CUBE_UPPER": "STEEL"}}])
        hinge = self.left_out(MODEL + SECOND.replace("2,11,12,13,14,15", "2,5,6,13,14,15") + step(""))
        self.assertIn("share 2 nodes but no face", hinge[0][2])

    def test_parts_are_placed(self):
        part = "*PART, NAME=Block\n" + CUBE + "*NSET, NSET=BOTTOM\n1,2,3,4\n*SURFACE, NAME=TOP\nCUBE, S2\n*SURFACE, NAME=FOOT\nCUBE, S1\n"
        part += "*SOLID SECTION, ELSET=CUBE, MATERIAL=STEEL\n*END PART\n"
        assembly = "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=Low, PART=Block\n*END INSTANCE\n*INSTANCE, NAME=High, PART=BLOCK\n0.,0.,1.\n"
        assembly += (
            "0.,0.,1., 0.,0.,2., 90.\n*END INSTANCE\n*NSET, NSET=GROUND, INSTANCE=Low\nBOTTOM\n*SURFACE, NAME=PRESSED\nHigh.TOP_SET, S2\n"
        )
        assembly += "*ELSET, ELSET=X, INSTANCE=High\n1\n*END ASSEMBLY\n"
        assembly = assembly.replace("High.TOP_SET", "X")
        steel = STEEL.replace("*SOLID SECTION, ELSET=CUBE, MATERIAL=STEEL\n", "")
        text = (
            part
            + assembly
            + steel
            + "*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nHigh.FOOT, Low.TOP\n*BOUNDARY\nGROUND, PINNED\n"
        )
        result = self.translate(text + step("*DSLOAD\nPRESSED, P, 3.\n"))
        self.assertEqual([f for f in result.model.findings if f.changes], [])
        self.assertEqual(list(result.deck["bodies"]), ["Low", "High"])
        self.assertEqual(result.deck["contacts"], [{"secondary": "High.FOOT", "primary": "Low.TOP"}])
        self.assertEqual([[round(c, 12) for c in p] for p in result.model.points[8:11]], [[0, 0, 1], [0, 1, 1], [-1, 1, 1]])

    def test_what_is_wrong_says_where(self):
        self.assertIn("model.inp:11: element 1 has 7 nodes", self.refused(MODEL.replace("6,7,8\n*", "6,7\n*", 1) + step("")))
        self.assertIn("node 99, which does not exist", self.refused(MODEL.replace("6,7,8\n", "6,7,99\n", 1)))
        self.assertIn('there is no set of nodes "NOWHERE"', self.refused(MODEL + "*BOUNDARY\nNOWHERE, 1\n"))
        self.assertIn('has no face "P7"', self.refused(MODEL + step("*DLOAD\nCUBE, P7, 1.\n")))


class Orthotropy(Import):
    WOOD = "*MATERIAL, NAME=WOOD\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n11,6,4,.35,.4,.3,.7,.8\n.06\n"

    def wood(self, section="", more="", head=CUBE):
        return self.deck(head + self.WOOD + more + f"*SOLID SECTION, ELSET=CUBE, MATERIAL=WOOD{section}\n" + HELD + step(""))

    def test_constants(self):
        found = self.wood(more="*EXPANSION, TYPE=ORTHO\n1.E-5, 2.E-5, 3.E-5\n")["materials"]["WOOD"]
        self.assertEqual(found["orthotropic"]["shear_modulus"], [0.7, 0.8, 0.06])
        self.assertEqual(found["orthotropic"]["thermal_expansion"], [1e-5, 2e-5, 3e-5])
        self.assertNotIn("axes", found["orthotropic"])
        deck = self.deck(MODEL.replace("*EXPANSION\n1.E-5", "*EXPANSION, TYPE=ORTHO\n1.E-5, 2.E-5, 3.E-5") + step(""))
        steel = deck["materials"]["STEEL"]["orthotropic"]
        self.assertEqual(steel["young_modulus"], [210000.0] * 3)
        self.assertAlmostEqual(steel["shear_modulus"][2], 210000 / 2.6, 6)

    def test_stiffness(self):
        text = self.WOOD.replace("ENGINEERING CONSTANTS\n11,6,4,.35,.4,.3,.7,.8\n.06", "ORTHO\n4,1,3,0,0,2,.7,.8\n.06")
        found = self.deck(CUBE + text + "*SOLID SECTION, ELSET=CUBE, MATERIAL=WOOD\n" + HELD + step(""))["materials"]["WOOD"]
        for value, expected in zip(found["orthotropic"]["young_modulus"], (11 / 3, 11 / 4, 2)):  # of [[4, 1], [1, 3]] and 2
            self.assertAlmostEqual(value, expected, 12)
        self.assertAlmostEqual(found["orthotropic"]["poisson_ratio"][0], 1 / 3, 12)
        self.assertEqual(found["orthotropic"]["shear_modulus"], [0.7, 0.8, 0.06])

    def test_directions(self):
        turned = self.wood(", ORIENTATION=GRAIN", "*ORIENTATION, NAME=GRAIN\n2,0,0, 0,3,0\n3, 90.\n")
        self.assertEqual(turned["materials"]["WOOD"]["orthotropic"]["axes"], "GRAIN")
        for name, expected in (("x", (0, 1, 0)), ("y", (-1, 0, 0))):
            for value, one in zip(turned["axes"]["GRAIN"][name], expected):
                self.assertAlmostEqual(value, one, 12)
        moved = self.wood(", ORIENTATION=GRAIN", "*ORIENTATION, NAME=GRAIN\n1,1,0, 0,2,0, 0,1,0\n")
        self.assertEqual(moved["axes"]["GRAIN"], {"x": [1, 0, 0], "y": [0, 1, 0]})
        rings = self.wood(", ORIENTATION=GRAIN", "*ORIENTATION, NAME=GRAIN, SYSTEM=CYLINDRICAL\n1,2,0, 1,2,5\n")
        self.assertEqual(rings["axes"]["GRAIN"], {"axis": [0, 0, 5], "point": [1, 2, 0]})

    def test_what_cannot_be_said(self):
        for section, more, why in (
            (", ORIENTATION=GRAIN", "", 'there is no *ORIENTATION "GRAIN"'),
            (", ORIENTATION=G", "*ORIENTATION, NAME=G\n1,0,0, 2,0,0\n", "lie on one line"),
            (", ORIENTATION=G", "*ORIENTATION, NAME=G, SYSTEM=SPHERICAL\n1,0,0, 2,0,0\n", "SYSTEM=RECTANGULAR and CYLINDRICAL"),
            (", ORIENTATION=G", "*ORIENTATION, NAME=G, SYSTEM=CYLINDRICAL\n1,0,0, 2,0,0\n3, 5.\n", "has no counterpart"),
        ):
            text = CUBE + self.WOOD + more + f"*SOLID SECTION, ELSET=CUBE, MATERIAL=WOOD{section}\n" + HELD + step("")
            self.assertIn(why, self.refused(text))
        part = f"*PART, NAME=P\n{CUBE}*SOLID SECTION, ELSET=CUBE, MATERIAL=WOOD, ORIENTATION=G\n*END PART\n"
        place = "*INSTANCE, NAME=A, PART=P\n0,0,0\n0,0,0, 0,0,1, 30.\n*END INSTANCE\n"
        self.assertIn("belong into its part", self.refused(part + place + self.WOOD + "*ORIENTATION, NAME=G\n1,0,0, 0,1,0\n" + step("")))


class Writers(Import):
    def test_prepomax(self):
        """A file as PrePoMax writes it; two_plates.inp is one of FreeCAD's."""
        result = self.translate((pathlib.Path(__file__).parent / "prepomax.inp").read_text())
        self.assertEqual([f for f in result.model.findings if f.changes], [])
        self.assertEqual(result.deck["contacts"], [{"secondary": "Slave", "primary": "Master", "friction": {"coulomb": 0.2}}])
        self.assertEqual(
            [(s["boundary"], s["displacement"]) for s in result.deck["supports"]],
            [("Internal_Selection-1_Fixed-1", {"x": 0, "y": 0, "z": 0}), ("Top", {"x": 0, "y": 0})],
        )
        self.assertEqual(result.deck["loads"], [{"boundary": "Top", "pressure": 100}])


class LeftOut(Import):
    def test_nothing_is_dropped_silently(self):
        text = (
            MODEL + "*WHATEVER\n1, 2\n*EQUATION\n2\n5,1,1.,6,1,-1.\n" + step("*FOUNDATION\nCUBE, F2, 1.\n*NODE FILE\nU\n", "*STEP, NLGEOM")
        )
        self.assertEqual([k for _, k, _ in self.left_out(text)], ["*WHATEVER", "*EQUATION", "*STEP, NLGEOM", "*FOUNDATION"])
        written = (self.folder / "deck.yaml").read_text()
        self.assertIn("#   model.inp:26: *WHATEVER", written)

    def test_parameters_that_are_unknown(self):
        for there, keyword, unknown in (
            ("*NODE, ", "*NODE", "FOO"), ("*ELASTIC", "*ELASTIC", "DEPENDENCIES"), ("*BOUNDARY", "*BOUNDARY", "FOO"),
            ("*SOLID SECTION, ", "*SOLID SECTION", "COMPOSITE"), ("*STATIC", "*STATIC", "FULLYPLASTIC"), ("*DLOAD", "*DLOAD", "FOO"),
        ):  # fmt: skip
            head = there.rstrip(", ")
            text = (MODEL + step("*DLOAD\nCUBE, P2, 1.\n")).replace(there, f"{head}, {unknown}=1" + there[len(head) :], 1)
            self.assertEqual([(k, r) for _, k, r in self.left_out(text)], [(keyword, f"{unknown} is not understood")])
        quiet = MODEL.replace("*NSET, ", "*NSET, INTERNAL, ").replace("*ELASTIC\n", "*ELASTIC, TYPE=ISO\n")
        self.assertEqual(self.left_out(quiet + step("*DLOAD, OP=NEW\nCUBE, P2, 1.\n", "*STEP, INC=9, UNSYMM=YES")), [])
        other = "*STEP\n*FREQUENCY\n3\n*BOUNDARY, FOO=1\nBOTTOM, 1\n*END STEP\n"  # of what is left out as a whole nothing more is told
        self.assertEqual([k for _, k, _ in self.left_out(MODEL + step("*DLOAD\nCUBE, P2, 1.\n") + other)], ["*STEP"])

    def test_mass_that_is_weighed(self):
        mass = MODEL + "*NONSTRUCTURAL MASS, ELSET=CUBE, UNITS=TOTAL MASS\n3.\n"
        self.assertEqual(self.left_out(mass + step("*DLOAD\nCUBE, P2, 1.\n")), [])
        self.assertEqual([k for _, k, _ in self.left_out(mass + step("*DLOAD\nCUBE, GRAV, 9., 0, 0, -1\n"))], ["*NONSTRUCTURAL MASS"])

    def test_exit_status(self):
        path = self.folder / "model.inp"
        path.write_text(MODEL + step("*DLOAD\nCUBE, P2, 1.\n"))
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            self.statuses(path)

    def statuses(self, path):
        self.assertEqual(import_deck.main([str(path)]), 0)
        self.assertEqual(import_deck.main([str(path)]), 1)  # the deck is there
        path.write_text(MODEL + step("*DLOAD\nCUBE, BX, 1.\n"))
        self.assertEqual(import_deck.main([str(path), "--force"]), 1)
        self.assertEqual(import_deck.main([str(path), "--force", "--partial"]), 0)

    def test_couplings_where_the_deck_has_them(self):
        text = (
            MODEL
            + "*NODE\n50, .5, .5, 2.\n*SURFACE, NAME=GRIP\nCUBE, S2\n*COUPLING, REF NODE=50, SURFACE=GRIP, CONSTRAINT NAME=C\n*DISTRIBUTING\n1, 6\n"
        )
        text += step("*CLOAD\n50, 1, 7.\n50, 5, 3.\n")
        self.schema["properties"].pop("couplings", None)
        self.assertIn("*COUPLING", [k for _, k, _ in self.left_out(text)])
        self.schema["properties"]["couplings"] = {}
        deck = self.deck(text)
        self.assertEqual(deck["couplings"], {"C": {"boundary": "GRIP", "point": [0.5, 0.5, 2.0], "kind": "distributing"}})
        self.assertEqual(deck["loads"], [{"coupling": "C", "force": [7, 0, 0], "moment": [0, 3, 0]}])


if __name__ == "__main__":
    unittest.main()
