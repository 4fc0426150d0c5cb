#!/usr/bin/python3
"""Cards, sets, parts, loads, steps: what ./mortise import makes of an input file, without the program."""

import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "inputs" / "import"))
import elements  # noqa: E402
import import_deck  # noqa: E402
from reader import InputError, read_cards, real  # noqa: E402

CUBE = """*NODE, NSET=ALL
1,0,0,0
2,1,0,0
3,1,1,0
4,0,1,0
5,0,0,1
6,1,0,1
7,1,1,1
8,0,1,1
*ELEMENT, TYPE=C3D8, ELSET=CUBE
1,1,2,3,4,5,6,7,8
"""
SECOND = """*NODE
11,0,0,1
12,1,0,1
13,1,1,1
14,0,1,1
15,0,0,2
16,1,0,2
17,1,1,2
18,0,1,2
*ELEMENT, TYPE=C3D8, ELSET=UPPER
2,11,12,13,14,15,16,17,18
*SOLID SECTION, ELSET=UPPER, MATERIAL=STEEL
*SURFACE, NAME=CUBE_TOP
CUBE, S2
*SURFACE, NAME=UPPER_BOTTOM
UPPER, S1
"""
STEEL = """*MATERIAL, NAME=STEEL
*ELASTIC
210000., .3
*DENSITY
2.
*EXPANSION
1.E-5
*SOLID SECTION, ELSET=CUBE, MATERIAL=STEEL
"""
HELD = "*NSET, NSET=BOTTOM, GENERATE\n1, 4\n*NSET, NSET=TOP\n5, 6, 7, 8\n*BOUNDARY\nBOTTOM, ENCASTRE\n"
MODEL = CUBE + STEEL + HELD


def step(text, head="*STEP"):
    return f"{head}\n*STATIC\n{text}*END STEP\n"


class Import(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="mortise_import_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.schema = json.loads(import_deck.SCHEMA.read_text())

    def translate(self, text, **files):
        for name, content in files.items():
            (self.folder / f"{name}.txt").write_text(content)
        (self.folder / "model.inp").write_text(text)
        return import_deck.import_file(self.folder / "model.inp", self.folder / "deck.yaml", self.schema)

    def deck(self, text, **files):
        """The deck of a file of which nothing is left out."""
        result = self.translate(text, **files)
        self.assertEqual([f.reason for f in result.model.findings if f.changes], [])
        return result.deck

    def left_out(self, text):
        return [(f.line, f.keyword, f.reason) for f in self.translate(text).model.findings if f.changes]

    def refused(self, text):
        with self.assertRaises(InputError) as caught:
            self.translate(text)
        return str(caught.exception)


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
        self.assertIn("is turned", self.refused(part + place + self.WOOD + "*ORIENTATION, NAME=G\n1,0,0, 0,1,0\n" + step("")))


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
        self.assertEqual(self.contact("*FRICTION\n.3, 1000.\n", ", ADJUST=0.1"), {**sides, "friction": {"coulomb": 0.3}, "adjust": 0.1})
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
            + "*NODE\n50, .5, .5, 2.\n*SURFACE, NAME=GRIP\nCUBE, S2\n*COUPLING, REF NODE=50, SURFACE=GRIP, CONSTRAINT NAME=C\n*DISTRIBUTING\n1, 3\n"
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
