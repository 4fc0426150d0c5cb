#!/usr/bin/env python3
"""The READMEs, the pages of docs/ and regression/ and the list of changes, held against the tree.

    check.py [ROOT]

Fails, with file and line, if
- a line outside tables and code has more than 160 characters,
- a README has more than 70 lines, about a page,
- a relative link, or a path of the repository in backticks or in a code block, leads to nothing,
- a table of files (first heading "file..." or "header...") names what does not exist, or that of a module of lib lacks one of its source
  files. Of a module the table names stems: `clusters` stands for clusters.hpp and clusters.cpp, be they in include or in src,
- a kind of warning in the table of docs/design/warnings.md is among the `warnings` of no expected.json of regression.
Results (`*.out`) need not exist. Exit status 1 if anything is found.
"""
import json
import pathlib
import re
import sys

LONGEST_LINE = 160
LONGEST_README = 70
FOLDERS = ("app", "docs", "inputs", "lib", "postproc", "regression")
SOURCES = (".c", ".cpp", ".hpp")
LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE_SPAN = re.compile(r"`([^`]+)`")
REPOSITORY_PATH = re.compile(rf"(?<![\w./-])(?:{'|'.join(FOLDERS)})/[\w./*+-]*")
LIST_ITEM = re.compile(r"\s*([-*+]|\d+[.)])\s")


def pages(root):
    """The pages at the root, the READMEs of the tree and all pages of docs/ and regression/, results left out."""
    found = [*root.glob("*.md"), *(root / "docs").rglob("*.md")]
    for folder in FOLDERS:
        found += (root / folder).rglob("*.md" if folder == "regression" else "README.md")
    hidden = lambda path: any(part.startswith(".") or part.endswith(".out") for part in path.relative_to(root).parts)
    return sorted({path for path in found if path.is_file() and not hidden(path)})


def kinds(lines):
    """For each line whether it is "code", "table" or "text": fenced or indented blocks, and lines that begin with a bar."""
    result, fenced, in_list, previous = [], False, False, "blank"
    for line in lines:
        if line.lstrip().startswith("```"):
            fenced, kind = not fenced, "code"
        elif fenced:
            kind = "code"
        elif not line.strip():
            kind = previous if previous == "code" else "blank"
        elif line.startswith("    ") and not in_list and previous in ("blank", "code"):
            kind = "code"
        else:
            kind = "table" if line.startswith("|") else "text"
            in_list = bool(LIST_ITEM.match(line)) or in_list and line.startswith(" ")
        result.append("text" if kind == "blank" else kind)
        previous = kind
    return result


def long_lines(lines, kind):
    for number, line in enumerate(lines, 1):
        if kind[number - 1] == "text" and len(line) > LONGEST_LINE:
            yield number, f"{len(line)} characters; at most {LONGEST_LINE}"


def exists(root, path):
    path = path.rstrip(".")
    if any(part.endswith(".out") for part in path.split("/")):
        return True
    return any(root.glob(path.rstrip("/"))) if "*" in path else (root / path).exists()


def dead_ends(root, page, lines, kind):
    """Links, and paths of the repository, that lead nowhere."""
    for number, line in enumerate(lines, 1):
        code = kind[number - 1] == "code"
        for target in [] if code else LINK.findall(CODE_SPAN.sub("", line)):
            if not re.match(r"[a-z]+:|#", target) and not (page.parent / target.split("#")[0]).exists():
                yield number, f"the link {target} leads to nothing"
        for text in [line] if code else CODE_SPAN.findall(line):
            for path in REPOSITORY_PATH.findall(text):
                if not exists(root, path):
                    yield number, f"{path} does not exist"


def file_table(lines, kind):
    """(line, name) of everything in backticks in the first column of the tables of files."""
    in_table = is_files = False
    for number, line in enumerate(lines, 1):
        if kind[number - 1] != "table":
            in_table = False
            continue
        first = line.split("|")[1]
        if not in_table:
            in_table, is_files = True, re.match(r"\s*(files?|headers?)\b", first) is not None
        elif is_files:
            for name in CODE_SPAN.findall(first):
                yield number, name


def wrong_table(root, page, lines, kind):
    named = list(file_table(lines, kind))
    if not named:
        return
    module = page.parent if page.parent.parent == root / "lib" else None
    if module is None:
        for number, name in named:
            if not (page.parent / name).exists():
                yield number, f"the table's file {name} does not exist"
        return
    sources = {path.stem for folder in ("include", "src") for path in (module / folder).rglob("*") if path.suffix in SOURCES}
    for number, name in named:
        if pathlib.PurePath(name).stem not in sources:
            yield number, f"the module has no source file {name}"
    for stem in sorted(sources - {pathlib.PurePath(name).stem for _, name in named}):
        yield named[0][0], f"the table of files lacks {stem}"


def untested_warnings(root, page, lines, kind):
    """Kinds of warnings that no deck is expected to give."""
    if page != root / "docs/design/warnings.md":
        return
    told = {word for path in (root / "regression").glob("*/*.expected.json") for word in json.loads(path.read_text()).get("warnings", [])}
    for number, line in enumerate(lines, 1):
        if kind[number - 1] == "table" and not line.startswith("| kind"):
            for name in CODE_SPAN.findall(line.split("|")[1]):
                if name not in told:
                    yield number, f"no regression case expects the warning {name}"


def complaints(root, page):
    lines = page.read_text(encoding="utf-8").splitlines()
    kind = kinds(lines)
    yield from long_lines(lines, kind)
    if page.name == "README.md" and len(lines) > LONGEST_README:
        yield len(lines), f"{len(lines)} lines; a README has at most {LONGEST_README}"
    yield from dead_ends(root, page, lines, kind)
    yield from wrong_table(root, page, lines, kind)
    yield from untested_warnings(root, page, lines, kind)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2]).resolve()
    every = pages(root)
    found = [f"{page.relative_to(root)}:{number}: {what}" for page in every for number, what in complaints(root, page)]
    print("\n".join(found + [f"{len(every)} pages, {len(found)} complaints"]))
    return 1 if found or len(every) < 2 else 0


if __name__ == "__main__":
    sys.exit(main())
