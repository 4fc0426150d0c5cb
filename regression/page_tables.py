#!/usr/bin/env python3
"""Tables of figures in pages, written by the scripts that make the figures.

    PROGRAM ... | page_tables.py PAGE NAME        puts the table of markdown that a program prints into a page
    page_tables.py --check                        as the test `pages.tables`: see check()

In a page a table of figures stands between two lines, the first of which names the table and the script that writes it:

    <!-- table: NAME, by SCRIPT -->
    <!-- end of table -->

Its first cells are the keys of its rows. What a script did not run again stays as it was: rows of other keys, and cells that are None.

A table of what is chosen or extrapolated and not measured, as limits, defaults or sizes of models, stands below the line

    <!-- constants -->
"""
import itertools
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
BEGIN = re.compile(r"<!-- table: (?P<name>[^,]+), by (?P<script>\S+) -->")
END = "<!-- end of table -->"
CONSTANTS = "<!-- constants -->"
RULE = re.compile(r"\|[-|: ]+\|")  # below the heading of a table
NOT_A_FIGURE = re.compile(r"`[^`]*`|\[[^]]*\]\([^)]*\)")  # code and links
FIGURE = re.compile(r"(some |below |above |at most |more than |about )?[-+<>~]? ?\d")


def cells_of(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def line_of(cells):
    return "| " + " | ".join(cells) + " |"


def find(lines, name):
    """Where the table of a name begins and ends: the lines of its marks."""
    for begin, line in enumerate(lines):
        if (mark := BEGIN.fullmatch(line)) and mark["name"] == name:
            return begin, lines.index(END, begin)
    raise SystemExit(f"the page has no table {name}: a line <!-- table: {name}, by SCRIPT --> and a line {END}")


def read(page, name):
    """Heading and rows of a table, lists of cells."""
    lines = page.read_text(encoding="utf-8").splitlines()
    begin, end = find(lines, name)
    rows = [cells_of(line) for line in lines[begin + 1:end] if line.startswith("|")]
    return (rows[0], rows[2:]) if rows else ([], [])


def merged(old, new, keys, known):
    """Rows of a table: `new` ones in the place of old ones of the same first `keys` cells, in the order of `known` keys, without what is not
    among these; if there are none, old ones first."""
    found = {tuple(row[:keys]): row for row in old}
    for row in new:
        before = found.get(tuple(row[:keys]), [""] * len(row))
        found[tuple(row[:keys])] = [was if cell is None else cell for was, cell in zip(before, row)]
    return list(found.values()) if known is None else [found[key] for key in known if key in found]


def write(page, name, head, rows, keys=1, known=None):
    """Writes a table into its place in the page: `head` and `rows` are lists of cells. `known`: the keys, tuples of `keys` cells, that the
    table may have, in order."""
    page = pathlib.Path(page)
    lines = page.read_text(encoding="utf-8").splitlines()
    begin, end = find(lines, name)
    old_head, old = read(page, name)
    rows = [[None if cell is None else str(cell) for cell in row] for row in rows]
    if old_head != head:  # of other columns
        old = []
    lines[begin + 1:end] = [line_of(head), "|" + "---|" * len(head), *map(line_of, merged(old, rows, keys, known))]
    page.write_text("\n".join(lines) + "\n", encoding="utf-8")


def known_rows():
    """For tables that must have a row for each case, and no other: their page and name, and the keys."""
    for folder in ("hard", "verification"):
        sys.path.insert(0, str(HERE / folder))
    import hard
    import sides
    import study
    import verify

    yield hard.PAGE, "hard", hard.known_keys()
    yield study.PAGE, "formulas", verify.known_keys()
    yield study.PAGE, "sides", sides.known_keys()


def is_of_figures(rows):
    """Whether several cells begin with a number."""
    return sum(FIGURE.match(NOT_A_FIGURE.sub("", cell).strip()) is not None for row in rows for cell in row) > 1


def wants_script(lines, rule, in_regression):
    """Of a table without a mark, whose rule stands at the number of a line: below regression/ all but lists of files and pictures, elsewhere
    what has figures."""
    if rule > 1 and lines[rule - 2] == CONSTANTS:
        return False
    rows = [cells_of(line) for line in itertools.takewhile(lambda line: line.startswith("|"), lines[rule + 1:])]
    return not re.match(r"\| *(`?file|!\[|header)", lines[rule - 1]) if in_regression else is_of_figures(rows)


def pages():
    """All pages but what a script writes as a whole (docs/make_reference.py) and results."""
    root = HERE.parent
    found = [page for folder in ("app", "docs", "inputs", "lib", "postproc", "regression") for page in (root / folder).rglob("*.md")]
    return [page for page in sorted([*root.glob("*.md"), *found]) if page.name != "reference.md" and ".out" not in "".join(page.parts)]


def check():
    """Complaints: a table of figures without a script that writes it, and, of tables whose rows are known, a case without a row or a row without
    a case."""
    for page in pages():
        lines, name = page.read_text(encoding="utf-8").splitlines(), page.relative_to(HERE.parent)
        inside = None
        for number, line in enumerate(lines, 1):
            if mark := BEGIN.fullmatch(line):
                if inside:
                    yield f"{name}:{number}: the table {inside} has no end"
                inside, script = mark["name"], page.parent / mark["script"]
                if not script.exists() or "page_tables" not in script.read_text(encoding="utf-8"):
                    yield f"{name}:{number}: {mark['script']} writes no tables"
            elif line == END:
                inside = None
            elif inside is None and RULE.fullmatch(line) and wants_script(lines, number - 1, HERE in page.parents):
                yield f"{name}:{number}: this table has no script that writes it"
        if inside:
            yield f"{name}: the table {inside} has no end"
    for page, name, keys in known_rows():
        found = [tuple(row[:len(keys[0])]) for row in read(page, name)[1]]
        for key in keys:
            if key not in found:
                yield f"{page.relative_to(HERE)}, {name}: no row for {' '.join(key)}"
        for key in found:
            if key not in keys:
                yield f"{page.relative_to(HERE)}, {name}: {' '.join(key)} is no case"


def main():
    if sys.argv[1:] == ["--check"]:
        complaints = list(check())
        print("\n".join(complaints + [f"{len(complaints)} complaints"]))
        return 1 if complaints else 0
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    rows = [cells_of(line) for line in sys.stdin.read().splitlines() if line.startswith("|")]
    write(sys.argv[1], sys.argv[2], rows[0], rows[2:])
    return 0


if __name__ == "__main__":
    sys.exit(main())
