#!/usr/bin/env python3
"""The page of a run: well-formed, with the numbers of summary.json, and what went wrong first. report_test.py MORTISE"""
import contextlib
import html.parser
import importlib.util
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "postproc"), str(ROOT / "postproc" / "report")]
import pictures  # noqa: E402
import raster  # noqa: E402
import render as render_script  # noqa: E402
import report as report_script  # noqa: E402

DRAWS = all(importlib.util.find_spec(module) for module in ("vtk", "matplotlib"))
MORTISE = sys.argv.pop(1) if len(sys.argv) > 1 else None
CASES = ROOT / "regression" / "cases"
VOID = {"meta", "img", "br", "line", "polyline"}


class Page(html.parser.HTMLParser):
    """Fails on tags that do not match; keeps the text and the first words."""

    def __init__(self, source):
        super().__init__()
        self.open, self.words = [], []
        self.feed(source)
        assert not self.open, self.open

    def handle_starttag(self, tag, attributes):
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if tag not in VOID:
            assert self.open and self.open[-1] == tag, (tag, self.open)
            self.open.pop()

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("style", "title") and data.strip():
            self.words.append(data.strip())


def report(directory, *options):
    command = ["/usr/bin/python3", str(ROOT / "postproc" / "report" / "report.py"), str(directory), *options]
    return subprocess.run(command, capture_output=True, text=True)


def within(script, *words):
    """The script in this process, which has loaded its libraries, with a sample a pixel of its pictures instead of four."""
    with unittest.mock.patch.object(raster, "OVERSAMPLING", 1), unittest.mock.patch.object(sys, "argv", [script.__file__, *map(str, words)]):
        with contextlib.redirect_stdout(io.StringIO()):
            script.main()


class Reports(unittest.TestCase):
    def run_deck(self, deck, *options):
        directory = pathlib.Path(tempfile.mkdtemp(dir=self.scratch.name))
        done = subprocess.run([MORTISE, str(deck), "--output", str(directory), *options], capture_output=True, text=True)
        return directory, done.returncode

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.scratch.cleanup()

    def page_of(self, directory):
        done = report(directory, "--no-pictures")
        self.assertEqual(done.returncode, 0, done.stderr)
        source = (directory / "report.html").read_text()
        self.assertNotIn("http", source.replace("http-equiv", ""))  # nothing from a network
        return Page(source).words

    def test_a_solved_run(self):
        directory, status = self.run_deck(CASES / "coupling_cap.yaml", "--set", "title=Cap <1> & Größe")
        self.assertEqual(status, 0)
        words = self.page_of(directory)
        self.assertEqual(words[:2], ["Cap <1> & Größe", "Solved to the tolerance."])
        summary = json.loads((directory / "summary.json").read_text())
        for value in (summary["max_von_mises"], summary["strain_energy"], summary["contacts"][0]["max_recovered_pressure"]):
            self.assertIn(f"{value:.4g}", words)
        for name in ("cap", "upper.zmin/lower.zmax", "steel", "lower"):
            self.assertIn(name, words)

    def test_load_steps_and_a_plane_model(self):
        directory, status = self.run_deck(CASES / "coupling_steps.yaml")
        self.assertEqual(status, 0)
        words = self.page_of(directory)
        for name in ("Load steps", "half", "all", "turned", "straight", "grip", "coupling grip"):
            self.assertIn(name, words)
        self.assertIn("Results, load step straight, time 4", words)  # of which state they are
        self.assertIn("bent 0.5, pulled 0", words)

    def test_all_that_holds_and_loads_a_model_is_told(self):
        directory, status = self.run_deck(CASES / "coupling_cap.yaml", "--set", "supports[0]={boundary: lower.zmin, stiffness: {x: 5e4, y: 5e4, z: 5e4}}",
                                          "--set", "contacts[0].friction={coulomb: 0.3}", "--set", "output.probes={low: {smallest: uz}, tip: {point: [1, 1, 2], axes: turned}}",
                                          "--set", "output.moments_about=[1, 2, 3]", "--set", "axes={turned: {x: [1, 1, 0], y: [0, 0, 1]}}")  # fmt: skip
        summary = json.loads((directory / "summary.json").read_text())
        self.assertEqual(status, 0, summary)
        words = self.page_of(directory)
        self.assertTrue(any("along turned, von Mises" in word for word in words), words)
        for name in ("stiffness x 5e4, y 5e4, z 5e4", "coulomb 0.3", "smallest uz", f"{summary['probes'][0]['value']:.4g}", "moment about (1, 2, 3)"):
            self.assertTrue(any(name == word or name.replace("5e4", "50000") == word for word in words), (name, words))

    def test_a_run_that_did_not_converge_says_so_first(self):
        directory, status = self.run_deck(CASES / "coupling_cap.yaml", "--set", "solver.max_multiplications=2", "--set", "solver.algorithm=face_newton")
        self.assertEqual(status, 2)
        words = self.page_of(directory)
        self.assertIn("did not converge", words[1])
        self.assertNotIn("Solved to the tolerance.", words)

    @unittest.skipUnless(DRAWS, "needs python3-vtk9 and python3-matplotlib")
    def test_pictures_of_the_whole_of_contacts_and_of_bodies(self):
        directory, _ = self.run_deck(CASES / "coupling_cap.yaml")
        done = report(directory)
        self.assertEqual(done.returncode, 0, done.stderr)
        source = (directory / "report.html").read_text()
        words = Page(source).words
        summary = json.loads((directory / "summary.json").read_text())
        self.assertEqual(source.count("data:image/png;base64,"), 3 + len(summary["contacts"]) + summary["bodies"])
        self.assertLess(len(source), 5_000_000)
        most = f"Largest at a node {summary['max_von_mises']:.4g}, in "
        self.assertTrue(any(w.startswith(most) for w in words), words)
        pressure = f"Largest at a node {summary['contacts'][0]['max_recovered_pressure']:.4g}."
        self.assertTrue(any(w.startswith(pressure) for w in words), words)
        for title in ("The whole", "Contacts", "Bodies"):
            self.assertIn(title, words)

    @unittest.skipUnless(DRAWS, "needs python3-vtk9 and python3-matplotlib")
    def test_pictures_of_a_plane_model_and_of_many_bodies(self):
        blocks = ", ".join(f"b{i}: {{origin: [{2 * i}, 0], size: [1, 1], cells: [2, 2], element: quad4}}" for i in range(15))
        deck = pathlib.Path(self.scratch.name) / "many.yaml"
        deck.write_text(
            f"""dimension: plane_strain
mesh: {{blocks: {{{blocks}}}}}
materials: {{steel: {{young_modulus: 1000, poisson_ratio: 0.3}}}}
bodies: {{b*: {{material: steel}}}}
supports:
  - {{boundary: "b*.xmin", displacement: {{x: 0}}}}
loads:
  - {{boundary: "b*.ymax", pressure: "1 + x"}}
contacts:
  - {{name: floor, secondary: "b*.ymin", primary: {{plane: {{point: [0, 0], normal: [0, 1]}}}}}}
"""
        )
        directory, status = self.run_deck(deck)
        self.assertEqual(status, 0)
        within(report_script, directory)
        source = (directory / "report.html").read_text()
        words = Page(source).words
        self.assertIn("12 of 15 bodies have a picture here, those with the largest values.", words)
        self.assertIn("12 of 15 contacts have a picture here, those with the largest values.", words)
        self.assertEqual(source.count("data:image/png;base64,"), 2 + 12 + 12)

    @unittest.skipUnless(DRAWS, "needs python3-vtk9 and python3-matplotlib")
    def test_render_chooses_and_cuts_bodies_by_name(self):
        from matplotlib import image

        directory, status = self.run_deck(CASES / "stack.yaml")
        self.assertEqual(status, 0)
        bodies = json.loads((directory / "summary.json").read_text())["body_names"]

        def render(*options, status=0):
            command = ["/usr/bin/python3", str(ROOT / "postproc" / "render.py"), str(directory), *options]
            done = subprocess.run(command, capture_output=True, text=True)
            self.assertEqual(done.returncode, status, done.stderr)
            return done.stdout + done.stderr

        self.assertEqual(render("--list").split(), bodies)
        self.assertIn(f"there are {', '.join(bodies)}", render("no.png", "--only", "lost", status=2))
        points = np.array([0.5, 0.5, 0.5])
        drawn = []
        for name, options in (("whole", []), ("one", ["--only", bodies[0], "--edges"]), ("half", ["--cut", *map(str, points), "1", "0", "0"]),
                              ("near", ["--zoom", "30", "--focus", *map(str, points), "--max", "1"]), ("contact", ["--contact", "--warp", "3"])):
            file = directory / f"{name}.png"
            within(render_script, directory, file, *options)
            drawn.append(image.imread(file))
        self.assertEqual(len({picture.tobytes() for picture in drawn}), len(drawn))
        self.assertTrue(all(picture.shape == drawn[0].shape for picture in drawn))
        middle = drawn[3][120:500, 100:500, :3]
        self.assertLess(middle.min(axis=2).max(), 1)  # so near, a body fills the picture

    def test_no_run_there(self):
        done = report(self.scratch.name)
        self.assertEqual(done.returncode, 1)
        self.assertIn("expected the output directory of a run", done.stderr)


class Pixels(unittest.TestCase):
    """The depth buffer, looked at along z: a square of side 1 is 50 pixels wide, 100 of the buffer."""

    def setUp(self):
        self.square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
        self.halves = np.array([[0, 1, 2], [0, 2, 3]])
        self.buffer = raster.Buffer(raster.View([0, 0, 1], self.square, 100, 100, margin=0.25))

    def grid(self, field):
        return getattr(self.buffer, field).reshape(self.buffer.shape)

    def test_a_square_covers_its_pixels_and_varies_linearly(self):
        self.buffer.draw(self.square, self.halves, self.square[:, 0])
        mesh, value = self.grid("mesh"), self.grid("value")
        self.assertTrue((mesh[52:148, 52:148] == 0).all())
        self.assertTrue((mesh[:48] == -1).all() and (mesh[152:] == -1).all() and (mesh[:, :48] == -1).all() and (mesh[:, 152:] == -1).all())
        self.assertLess(abs((mesh == 0).sum() - 10_000), 500)
        expected = (np.arange(52, 148) + 0.5 - 50) / 100
        self.assertLess(np.abs(value[52:148, 52:148] - expected).max(), 0.011)  # a pixel

    def test_triangles_far_larger_than_the_window_fill_it(self):
        self.buffer.draw(self.square * 400 - [150, 150, 0], self.halves, (self.square[:, 0] + self.square[:, 1]) * 400 - 300, np.array([3, 3]))
        self.assertTrue((self.grid("mesh") == 3).all())
        self.assertLess(abs(self.grid("value")[100, 100] - 1.0), 0.03)

    def test_what_is_nearer_hides_what_is_behind(self):
        for order in ((0, 1), (1, 0)):
            self.setUp()
            for number in order:  # 1 is nearer, and covers the left half
                points = self.square * ([1, 1, 1] if number == 0 else [0.5, 1, 1]) + [0, 0, number]
                self.buffer.draw(points, self.halves, np.full(4, float(number)), number)
            mesh = self.grid("mesh")
            self.assertTrue((mesh[60:140, 55:95] == 1).all())
            self.assertTrue((mesh[60:140, 105:145] == 0).all())


if __name__ == "__main__":
    unittest.main()
