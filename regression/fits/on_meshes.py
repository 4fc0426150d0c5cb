"""Solves decks on meshes that are made for them."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "population"))
import meshes  # noqa: E402


def solved(mortise, deck, bodies):
    """The summary of a run of a deck, a text whose mesh is `mesh.msh`: of `bodies`, see meshes.write. Ends with the terminal if it is not solved."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        meshes.write(folder / "mesh.msh", bodies)
        (folder / "deck.yaml").write_text(deck)
        done = subprocess.run([mortise, str(folder / "deck.yaml"), "--output", str(folder / "out")], capture_output=True, text=True,
                              env=dict(os.environ, OMP_NUM_THREADS="1"), timeout=300)
        if done.returncode != 0:
            raise SystemExit(f"{deck}\n{done.stdout}{done.stderr}\nexit status {done.returncode}")
        return json.loads((folder / "out" / "summary.json").read_text())
