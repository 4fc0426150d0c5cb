"""Products with F that a deck takes, for the tables of this page."""
import json
import pathlib
import subprocess
import tempfile


def products_of(mortise, deck, settings):
    """Of a run that has to be solved; `settings`: KEY=VALUE, as of --set."""
    with tempfile.TemporaryDirectory(prefix="mortise_products_") as directory:
        command = [mortise, str(deck), "--output", directory] + [word for s in settings for word in ("--set", s)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(done.stdout + done.stderr)
        return json.loads((pathlib.Path(directory) / "summary.json").read_text())["hessian_multiplications"]
