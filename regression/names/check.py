#!/usr/bin/env python3
"""Names in anonymous namespaces, which unity builds bring together.

    check.py [ROOT]

In a batch all anonymous namespaces of a module are one, and a name there hides that of a header for the files that follow:
without a message, and with another value. Fails, with file and line, if a constant or a type in an anonymous namespace
- stands in that of another source file of the module too,
- or has the name of anything that a header of the module declares at namespace scope.
Functions may overload those of another file, but are not to have the name of a header's constant or type. Modules are the folders
of lib with their sources and their tests apart, and app. Exit status 1 if anything is found.
"""
import collections
import pathlib
import re
import sys

ANONYMOUS = re.compile(r"namespace\s*\{")
NAMESPACE_END = re.compile(r"\}\s*//\s*(anonymous )?namespace\s*$")
TYPE = re.compile(r"(?:(?:struct|class|enum class|enum)\s+(\w+)\b(?!\s*;)|using\s+(\w+)\s*=)")
FUNCTION = re.compile(r"[^=(]*?(\w+)\(")
CONSTANT = re.compile(r"[\s*&,](\w+)\s*(?:=|\{|\[)")
OTHER = re.compile(r"(?:(?:namespace|template|extern|static_assert|TEST|TEST_P|INSTANTIATE_TEST_SUITE_P)\b|using (?!\w+ =))")


def declared(path, anonymous):
    """(name, kind, line) of what stands at the left margin inside anonymous namespaces of a file, or outside of them."""
    inside, raw_text, found = False, False, []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if raw_text or 'R"' in line:
            raw_text = ')"' not in line.partition('R"')[2] if 'R"' in line else ')"' not in line
            if 'R"' not in line:
                continue
        if ANONYMOUS.match(line):
            inside = True
        elif NAMESPACE_END.match(line):
            inside = False
        elif inside == anonymous and re.match(r"[A-Za-z]", line) and not OTHER.match(line):
            code = line.split("//")[0]
            if match := TYPE.match(code):
                found.append((match.group(1) or match.group(2), "type", number))
            elif match := FUNCTION.match(code):
                found.append((match.group(1), "function", number))
            else:
                found += [(name, "constant", number) for name in CONSTANT.findall(code)]
    return found


def check(sources, headers, root):
    problems, of_headers, seen = [], collections.defaultdict(set), {}
    for path in headers:
        for name, kind, _ in declared(path, anonymous=False):
            of_headers[name].add(kind)
    for path in sources:
        for name, kind, number in declared(path, anonymous=True):
            place = f"{path.relative_to(root)}:{number}: {name}"
            kinds = of_headers.get(name, set())
            if kinds if kind != "function" else kinds - {"function"}:
                problems.append(f"{place} is declared in a header of the module too")
            if kind == "function":
                continue
            if seen.setdefault(name, path) != path:
                problems.append(f"{place} stands in {seen[name].relative_to(root)} too")
    return problems


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2]).resolve()
    problems, files = [], 0
    for folder in [root / "app", *sorted((root / "lib").iterdir())]:
        headers = [path for path in folder.rglob("*.hpp") if path.parent.name != "test"]
        own = folder if folder.name == "app" else folder / "src"
        for sources, further in ((own, []), (folder / "test", (folder / "test").glob("*.hpp"))):
            of_folder = sorted(sources.rglob("*.cpp"))
            files += len(of_folder)
            problems += check(of_folder, [*headers, *further], root)
    if files == 0:
        problems.append(f"{root}: no source files")
    print("\n".join(problems) or f"{files} source files: no name of theirs hides another")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
