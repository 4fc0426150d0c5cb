#!/usr/bin/env python3
"""One page, report.html, of what a run left in its output directory.

    report.py OUTPUT_DIRECTORY|DECK.yaml [--output PAGE.html] [--no-pictures]

The page holds everything itself and needs no network. A run that failed has one too, which says so first.
"""
import argparse
import csv
import json
import pathlib
import sys

import page
import pictures


def output_of(deck):
    """Where a run of the deck leaves its results."""
    import yaml

    try:
        wanted = ((yaml.safe_load(deck.read_text()) or {}).get("output") or {}).get("directory")
    except (OSError, ValueError, AttributeError, yaml.YAMLError) as error:
        sys.exit(f"report: {deck}: {error}")
    return deck.parent / (wanted or f"{deck.stem}.out")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--output", type=pathlib.Path)
    parser.add_argument("--no-pictures", action="store_true")
    arguments = parser.parse_args()
    directory = arguments.directory if arguments.directory.is_dir() or arguments.directory.suffix not in (".yaml", ".yml") else output_of(arguments.directory)
    try:
        summary = json.loads((directory / "summary.json").read_text())
    except (OSError, ValueError) as error:
        sys.exit(f"report: {directory / 'summary.json'}: {error}; expected the output directory of a run, as deck.out")
    try:
        import yaml

        deck = yaml.safe_load((directory / "deck.yaml").read_text()) or {}
    except (ImportError, OSError, ValueError):
        deck = {}
    rows = []
    if (directory / "history.csv").exists():
        with (directory / "history.csv").open(newline="") as lines:
            rows = list(csv.DictReader(lines))
    drawn, why = ([], "") if arguments.no_pictures else pictures.of_run(
        directory, [c["name"] for c in summary.get("contacts", [])], summary.get("body_names", [])
    )
    target = arguments.output or directory / "report.html"
    part = target.with_name(target.name + ".part")
    part.write_text(page.page(summary, deck, rows, drawn, why), encoding="utf-8")
    part.replace(target)
    print(target)


if __name__ == "__main__":
    main()
