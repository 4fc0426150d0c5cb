#!/usr/bin/env python3
"""How long a build from nothing and the suite take, for the table in README.md.

    build_times.py [--program] [--write]

Of the preset release, in a folder of its own: the program alone, then all tests, then the suite as `./mortise test` runs it; with --program the first of these.
Each row is written as it comes. What a command that fails has written stays in build/build_times.log; a suite that fails has its row all the same,
since it runs to its end, and the exit status is 1."""

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

LOG = ROOT / "build" / "build_times.log"
SUITE = "the suite, `ctest -LE study`"
ROWS = ["the program, `ninja mortise`", "then all tests, `ninja`", SUITE]


def environment():
    """What the preset of the suite sets."""
    presets = json.loads((ROOT / "CMakePresets.json").read_text())["testPresets"]
    return dict(os.environ, **next(preset["environment"] for preset in presets if preset["name"] == "all"))


def timed(*command):
    """Seconds on the clock and of the processors, and the exit status. The end of what a command that fails has written is shown, all of it kept."""
    used = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    clock, processors = time.monotonic(), used()
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment())
    if done.returncode:
        LOG.write_text(done.stdout)
        print(f"{done.stdout[-5000:]}\n{' '.join(command)}: exit {done.returncode}; all of it in {LOG}", file=sys.stderr)
    return time.monotonic() - clock, used() - processors, done.returncode


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", action="store_true", help="the program alone")
    parser.add_argument("--write", action="store_true", help="write the table of README.md")
    arguments = parser.parse_args()
    (ROOT / "build").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=ROOT / "build") as build:

        def row(what, *command):
            clock, processors, status = timed(*command)
            if status and what != SUITE:
                sys.exit(1)
            cells = [what, f"{clock:.0f}", f"{processors:.0f}"]
            print(*cells, sep=", ", flush=True)
            if arguments.write:
                page_tables.write(HERE / "README.md", "build", [f"on {os.cpu_count()} processors", "seconds", "CPU seconds"], [cells],
                                  known=[(name,) for name in ROWS])
            return status

        if timed("cmake", "--preset", "release", "-B", build)[2]:
            return 1
        status = row(ROWS[0], "ninja", "-C", build, "mortise")
        if not arguments.program:
            row(ROWS[1], "ninja", "-C", build)
            status = row(SUITE, "ctest", "--test-dir", build, "-LE", "study", "-j", str(os.cpu_count()), "--output-on-failure")
    return status


if __name__ == "__main__":
    sys.exit(main())
