"""Reads a deck, and numbers of summary.json by their path."""

import math

from studies.refinement import BadInput


def numbers(value):
    """PyYAML takes 210.0e3 for a string."""
    if isinstance(value, dict):
        return {key: numbers(part) for key, part in value.items()}
    if isinstance(value, list):
        return [numbers(part) for part in value]
    try:
        return float(value) if isinstance(value, str) else value
    except ValueError:
        return value


def read_deck(path, settings):
    try:
        import yaml
    except ImportError:
        raise BadInput("reading a deck needs PyYAML: apt-get install python3-yaml, and run this with /usr/bin/python3") from None
    try:
        deck = numbers(yaml.safe_load(path.read_text()))
        if not isinstance(deck, dict):
            raise BadInput(f"{path}: this is no deck, which would have keys such as mesh, materials, bodies")
        for setting in settings:
            key, equal, value = setting.partition("=")
            if not equal:
                raise BadInput(f"--set {setting}: expected KEY=VALUE")
            place = deck
            *way, last = key.split(".")
            for part in way:
                place = place[int(part)] if isinstance(place, list) else place.setdefault(part, {})
            place[int(last) if isinstance(place, list) else last] = numbers(yaml.safe_load(value))
    except OSError as problem:
        raise BadInput(f"{path}: {problem.strerror}") from None
    except (yaml.YAMLError, TypeError, ValueError, IndexError) as problem:
        raise BadInput(f"{path}: {problem}") from None
    return deck


def look_up(summary, path):
    """A number of summary.json; the length of a vector; None where there is none."""
    value = summary
    try:
        for key in path.split("."):
            value = value[int(key)] if isinstance(value, list) else value[key]
    except (KeyError, IndexError, ValueError, TypeError):
        return None
    if isinstance(value, list) and all(isinstance(part, (int, float)) for part in value):
        return math.hypot(*value)
    return value if isinstance(value, (int, float)) and not isinstance(value, bool) else None
