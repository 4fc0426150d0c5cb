"""The cards of an Abaqus or CalculiX input file: keyword, parameters, data lines, and where each stands."""

import dataclasses
import math
import pathlib
import re


class InputError(Exception):
    """What makes a file unreadable; the text says where."""


@dataclasses.dataclass
class Card:
    """One keyword with what follows it. `name` and the keys of `parameters` are in capitals without blanks."""

    name: str
    parameters: dict
    file: pathlib.Path
    line: int
    data: list = dataclasses.field(default_factory=list)  # (line, fields)
    spelt: str = ""  # the keyword for people: in capitals, with its blanks
    order: int = 0  # among all cards
    scope: object = None  # of a card of a part, where an instance has it: that instance

    def get(self, key, default=""):
        return self.parameters.get(key, default)

    def error(self, message, line=None):
        return InputError(f"{self.file}:{line or self.line}: {message}")

    def need(self, key):
        if not self.get(key):
            raise self.error(f"*{self.name} needs {key}=")
        return self.get(key)

    def rows(self):
        """(line, fields) of the data lines that hold any; fields are stripped, empty ones at the end are gone."""
        return [row for row in self.data if row[1]]

    def number(self, text, line):
        try:
            return int(text)
        except ValueError:
            raise self.error(f'expected a number, found "{text}"', line) from None

    def value(self, text, line, default=None):
        if text == "" and default is not None:
            return default
        try:
            return real(text)
        except ValueError:
            raise self.error(f'expected a number, found "{text}"', line) from None


def real(text):
    """A number as Fortran writes it: 1.5D+3, 1.5+3 as well. Throws ValueError, also for what is not finite."""
    plain = text
    if not text or text[-1] not in "0123456789." or "_" in text or not re.fullmatch(r"[\d.eE+-]+", text) or re.search(r"[\d.][+-]", text):
        plain = text.strip().lower().replace("d", "e")
        plain = re.sub(r"(?<=[\d.])([+-]\d+)$", r"e\1", plain)
        if not re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", plain):
            raise ValueError(text)
    value = float(plain)
    if not math.isfinite(value):
        raise ValueError(text)
    return value


def is_number(text):
    return re.fullmatch(r"\d+", text) is not None


def unquoted(text):
    return text.strip().strip('"').strip()


def fields(line):
    result = [unquoted(word) for word in line.split(",")]
    while result and not result[-1]:
        result.pop()
    return result


def lines(path, root, above=()):
    """(file, line number, text) of a file and of those that it includes, without comments and blank lines."""
    path = path.resolve()
    if path in above:
        raise InputError(f"{path}: the file includes itself")
    try:
        text = path.read_text(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None
    if "\0" in text:
        raise InputError(f"{path}: is no text file")
    pending, start = "", 0
    for number, line in enumerate(text.splitlines(), 1):
        line = line.strip()
        if not line or line.startswith("**"):
            continue
        if pending or (line.startswith("*") and line.endswith(",")):  # a keyword line that goes on in the next one
            pending, start = pending + line, start or number
            if line.endswith(","):
                continue
            line, begun, pending, start = pending, start, "", 0
        else:
            begun = number
        if re.match(r"\*\s*include\b", line, re.IGNORECASE):
            yield from included(line, path, begun, root, (*above, path))
        else:
            yield path, begun, line
    if pending:
        yield path, start, pending


def included(line, path, number, root, above):
    name = parameters(line).get("INPUT", "")
    if not name:
        raise InputError(f"{path}:{number}: *INCLUDE needs INPUT=")
    yield from lines(beside(name, path, number, root), root, above)


def beside(name, path, number, root):
    """A file that another one names: beside the first file, or beside that other one."""
    for folder in (root, path.parent):
        if (folder / name).is_file():
            return folder / name
    raise InputError(f'{path}:{number}: there is no file "{name}" beside {path.name}')


def parameters(line):
    result = {}
    for word in line.split(",")[1:]:
        key, _, value = word.partition("=")
        if key.strip():
            result[re.sub(r"\s", "", key).upper()] = unquoted(value)
    return result


def read_cards(path):
    """All cards of a file, in order. Throws InputError."""
    path = pathlib.Path(path)
    root, result = path.resolve().parent, []
    for file, number, line in lines(path, root):
        if line.startswith("*"):
            keyword = line[1:].partition(",")[0].upper()
            card = Card(re.sub(r"\s", "", keyword), parameters(line), file, number, spelt=" ".join(keyword.split()), order=len(result))
            result.append(card)
            if card.get("INPUT"):
                data = beside(card.get("INPUT"), file, number, root)
                card.data += [(number, fields(text)) for _, _, text in lines(data, root)]
        elif not result:
            raise InputError(f"{file}:{number}: the file does not begin with a keyword")
        elif result[-1].name != "HEADING":
            result[-1].data.append((number, fields(line)))
    if not result:
        raise InputError(f"{path}: holds no keyword")
    return result
