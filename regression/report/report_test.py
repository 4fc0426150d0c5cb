#!/usr/bin/env python3
"""The page of a run: well-formed, with the numbers of summary.json, and what went wrong first. report_test.py MORTISE"""
import html.parser
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
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
        for name in ("Load steps", "half", "all", "turned", "straight", "grip"):
            self.assertIn(name, words)

    def test_a_run_that_did_not_converge_says_so_first(self):
        directory, status = self.run_deck(CASES / "coupling_cap.yaml", "--set", "solver.max_multiplications=2", "--set", "solver.algorithm=face_newton")
        self.assertEqual(status, 2)
        words = self.page_of(directory)
        self.assertIn("did not converge", words[1])
        self.assertNotIn("Solved to the tolerance.", words)

    def test_no_run_there(self):
        done = report(self.scratch.name)
        self.assertEqual(done.returncode, 1)
        self.assertIn("expected the output directory of a run", done.stderr)


if __name__ == "__main__":
    unittest.main()
