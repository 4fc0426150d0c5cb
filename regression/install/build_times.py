#!/usr/bin/env python3
"""How long a build from nothing and the suite take, for the table in README.md.

    build_times.py [--program] [--write]

Of the preset release, in a folder of its own: the program alone, then all tests, then the suite as `./mortise test` runs it; with --program the first of these."""

import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE.parent))
import page_tables  # noqa: E402


def environment():
    """What the preset of the suite sets."""
    presets = json.loads((ROOT / "CMakePresets.json").read_text())["testPresets"]
    return dict(os.environ, **next(preset["environment"] for preset in presets if preset["name"] == "all"))


def timed(*command):
    """Seconds on the clock and of the processors. What a command that fails has written is shown."""
    used = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    clock, processors = time.monotonic(), used()
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment())
    if done.returncode:
        sys.exit(f"{done.stdout}\n{' '.join(command)}: exit {done.returncode}")
    return time.monotonic() - clock, used() - processors


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", action="store_true", help="the program alone")
    parser.add_argument("--write", action="store_true", help="write the table of README.md")
    arguments = parser.parse_args()
    rows = []
    (ROOT / "build").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=ROOT / "build") as build:

        def row(what, *command):
            clock, processors = timed(*command)
            rows.append([what, f"{clock:.0f}", f"{processors:.0f}"])
            print(*rows[-1], sep=", ", flush=True)

        timed("cmake", "--preset", "release", "-B", build)
        row("the program, `ninja mortise`", "ninja", "-C", build, "mortise")
        if not arguments.program:
            row("then all tests, `ninja`", "ninja", "-C", build)
            row("the suite, `ctest -LE study`", "ctest", "--test-dir", build, "-LE", "study", "-j", str(os.cpu_count()),
                "--output-on-failure")
    if arguments.write:
        page_tables.write(HERE / "README.md", "build", [f"on {os.cpu_count()} processors", "seconds", "CPU seconds"], rows)


if __name__ == "__main__":
    main()
