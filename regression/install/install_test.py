#!/usr/bin/env python3
"""What `cmake --install` lays down is whole: its commands work away from the sources and from the build.

    install_test.py BUILD
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
DECK = """mesh: {file: bar.geo}
materials: {steel: {young_modulus: 1000, poisson_ratio: 0}}
bodies: {bar: {material: steel}}
supports: [{boundary: foot, displacement: {x: 0, y: 0, z: 0}}]
loads: [{boundary: head, pressure: -2}]
"""
GEOMETRY = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 3};
Physical Volume("bar") = {1};
Physical Surface("foot") = {5};
Physical Surface("head") = {6};
"""
STEPS = """mesh: {blocks: {lower: {size: [1, 1, 1], cells: [9, 9, 9]}, upper: {origin: [0, 0, 1], size: [1, 1, 1], cells: [8, 8, 8]}}}
materials: {soft: {young_modulus: 1, poisson_ratio: 0.3}}
bodies: {"*": {material: soft}}
supports: [{boundary: lower.zmin, displacement: {x: 0, y: 0, z: 0}}]
loads: [{name: press, boundary: upper.zmax, pressure: 0.01}, {name: shear, boundary: upper.zmax, traction: [0.0015, 0, 0]}]
contacts: [{secondary: upper.zmin, primary: lower.zmax, friction: {coulomb: 0.3}}]
steps: [{name: shear, scale: {shear: 1}, increments: 40}]
"""
INPUT = """*NODE
1, 0,0,0
2, 1,0,0
3, 1,1,0
4, 0,1,0
5, 0,0,1
6, 1,0,1
7, 1,1,1
8, 0,1,1
*ELEMENT, TYPE=C3D8, ELSET=CUBE
1, 1,2,3,4,5,6,7,8
*NSET, NSET=ROOT
1,2,3,4
*MATERIAL, NAME=STEEL
*ELASTIC
1000, 0.3
*SOLID SECTION, ELSET=CUBE, MATERIAL=STEEL
*STEP
*STATIC
*BOUNDARY
ROOT, 1, 3
*CLOAD
7, 3, 1
*END STEP
"""


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(prefix="mortise_install_")
        cls.prefix = pathlib.Path(cls.scratch.name) / "prefix"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", cls.prefix], check=True, stdout=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def run_in(self, name, *words, status=0):
        place = pathlib.Path(self.scratch.name) / name
        place.mkdir(exist_ok=True)
        for file, text in (("bar.yaml", DECK), ("bar.geo", GEOMETRY), ("cube.inp", INPUT)):
            (place / file).write_text(text)
        ran = subprocess.run([self.prefix / "bin" / "mortise", *words], cwd=place, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             env=dict(os.environ, MORTISE_RANKS="2"))
        self.assertEqual(ran.returncode, status, ran.stdout)
        return place, ran.stdout

    def test_a_deck_is_solved(self):
        for words in (["bar.yaml"], ["run", "bar.yaml"]):
            place, _ = self.run_in("-".join(words), *words)
            summary = json.loads((place / "bar.out" / "summary.json").read_text())
            self.assertAlmostEqual(summary["max_von_mises"], 2, 5)
            self.assertEqual(summary["ranks"], len(words))

    def test_a_run_on_ranks_that_is_told_to_end_says_so(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            place = pathlib.Path(self.scratch.name) / number.name
            place.mkdir()
            (place / "steps.yaml").write_text(STEPS)
            # As a terminal does, the signal goes to all processes of the group.
            run = subprocess.Popen([self.prefix / "bin" / "mortise", "run", "steps.yaml"], cwd=place, text=True, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, env=dict(os.environ, MORTISE_RANKS="2"), start_new_session=True,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
            while run.poll() is None and not (place / "steps.out" / "results.2.h5").exists():
                time.sleep(0.01)
            os.killpg(run.pid, number)
            said = run.communicate(timeout=120)[0]
            self.assertEqual(run.returncode, 130, said)
            self.assertIn("told to end", said)
            self.assertEqual(json.loads((place / "steps.out" / "summary.json").read_text())["exit_status"], 130)

    def test_decks_are_made_and_explained(self):
        self.assertIn("pressure", self.run_in("explain", "explain", "loads")[1])
        place, said = self.run_in("new", "new", "bar.geo", "-o", "made.yaml")
        self.assertIn("foot", (place / "made.yaml").read_text(), said)
        place, said = self.run_in("import", "import", "cube.inp")
        self.assertTrue((place / "cube.yaml").exists(), said)

    def test_what_belongs_to_the_sources_is_refused(self):
        for word in ("build", "test", "package"):
            self.assertIn("for the sources", self.run_in("refused", word, status=1)[1])
        self.assertIn("no deck", self.run_in("refused", "lost.yaml", status=1)[1])
        commands = self.run_in("refused", status=1)[1]
        self.assertIn("  mortise report OUT", commands)
        for of_sources in ("./mortise", "mortise test", "mortise package", "builds"):
            self.assertNotIn(of_sources, commands)

    def test_documents_and_schema_are_there(self):
        for name in ("share/mortise/docs/schema.json", "share/doc/mortise/docs/tutorial.md", "share/doc/mortise/copyright",
                     "share/doc/mortise/examples/press_fit/press_fit.yaml", "share/mortise/postproc/report/report.py"):
            self.assertTrue((self.prefix / name).exists(), name)
        links = [path for path in self.prefix.rglob("*") if path.is_symlink()]
        self.assertTrue(all(path.exists() for path in links), links)


if __name__ == "__main__":
    unittest.main()
