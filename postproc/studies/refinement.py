"""A family of ever finer meshes from one deck.

Blocks: `cells` is multiplied. A .geo file: a constant that is a size is divided, one that is a count is multiplied; which is which is read
from what the file does with it (`evidence`). A .msh, .step or .brep file: gmsh splits every cell.
"""

import pathlib
import re
import shutil
import subprocess


class BadInput(Exception):
    """What the user needs to mend, in words."""


def expressions(text):
    """The right-hand sides that decide on the size of cells: (what it is, expression)."""
    for match in re.finditer(r"\bPoint\s*\([^)]*\)\s*=\s*\{([^}]*)\}", text):
        parts = split_arguments(match.group(1))
        if len(parts) == 4:
            yield "size", parts[3]
    for match in re.finditer(r"\bTransfinite\s+(?:Curve|Line)\s*\{[^}]*\}\s*=\s*([^;]*?)(?:\bUsing\b[^;]*)?;", text):
        yield "division", match.group(1)
    for match in re.finditer(r"\bLayers\s*\{([^;]*?)\}\s*;", text):
        yield "division", match.group(1)
    for match in re.finditer(
        r"\b(?:Mesh\.(?:MeshSize|CharacteristicLength)\w*|MeshSize\s*\{[^}]*\}|Characteristic\s+Length\s*\{[^}]*\})\s*=\s*([^;]*);", text
    ):
        yield "size", match.group(1)
    for match in re.finditer(r"\bField\s*\[[^\]]*\]\.(?:F|Size\w*|LcMin|LcMax|VIn|VOut|h\w+)\s*=\s*([^;]*);", text):
        yield "size", re.sub(r'^\s*Sprintf\s*\(\s*"[^"]*"\s*,', "", match.group(1))


def split_arguments(text):
    """At the commas outside brackets."""
    parts, depth, part = [], 0, ""
    for letter in text:
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0:
            parts.append(part)
            part = ""
        else:
            part += letter
    return parts + [part]


def substituted(expression, assignments, depth=3):
    """With the variables of the file replaced by what they were set from."""
    for _ in range(depth):
        expression = re.sub(
            r"\b[A-Za-z_]\w*\b(?!\s*\()", lambda m: f"({assignments[m.group()]})" if m.group() in assignments else m.group(), expression
        )
    return expression


def defined(text):
    """Names and defaults of DefineConstant."""
    result = {}
    for match in re.finditer(r"\bDefineConstant\s*\[(.*?)\]", text, re.S):
        for name, value in re.findall(r"([A-Za-z_]\w*)\s*=\s*\{?\s*([-+0-9.eE]+)", match.group(1)):
            result[name] = float(value)
    return result


def evidence(text):
    """{constant: "size" or "count"} of a .geo file, as far as its use in the file tells; its order is neither."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)
    constants = defined(text)
    bare = re.sub(r"\bDefineConstant\s*\[.*?\]", "", text, flags=re.S)
    assignments = {name: value for name, value in re.findall(r"(?:^|[;\n])\s*([A-Za-z_]\w*)\s*=\s*([^;{}\"]*);", bare) if name not in constants}
    found = {}
    for kind, expression in expressions(bare):
        expression = substituted(expression, assignments)
        below = set(re.findall(r"/\s*\(*\s*([A-Za-z_]\w*)", expression)) & set(constants)
        above = (set(re.findall(r"[A-Za-z_]\w*", expression)) & set(constants)) - below
        for name in above if kind == "size" else ():
            found.setdefault(name, set()).add("size")
        for name in below if kind == "division" else ():
            found.setdefault(name, set()).add("size")
        for name in above if kind == "division" and not below else ():
            found.setdefault(name, set()).add("count")
    return {name: " and ".join(sorted(kinds)) for name, kinds in found.items() if name != "order"}


def choose(geometry, given, size, count):
    """[(constant, "size" or "count", value)] to refine by."""
    text = geometry.read_text()
    values = {**defined(text), **given}
    if size or count:
        wanted = [(name, "size") for name in size] + [(name, "count") for name in count]
    else:
        found = evidence(text)
        tier = {name: kind for name, kind in found.items() if name in given} or found
        kinds = set(tier.values())
        if not tier:
            raise BadInput(
                f"{geometry.name}: no constant is seen to decide on the size of cells; "
                + (
                    f"name one with --size or --count (there are {', '.join(values)})"
                    if values
                    else "give it one, such as DefineConstant[ h = 0.1 ]; with h as the fourth number of its points"
                )
            )
        if len(tier) > 1 and kinds != {"count"} or kinds - {"size", "count"}:
            raise BadInput(
                f"{geometry.name}: several constants may set the size of cells ({', '.join(f'{n}: {k}' for n, k in tier.items())}); "
                f"name the one to divide with --size NAME, or those to multiply with --count NAME"
            )
        wanted = list(tier.items())
    for name, kind in wanted:
        if name not in values:
            raise BadInput(f"--{kind} {name}: {geometry.name} has no constant of that name; it has {', '.join(values) or 'none'}")
        if kind == "count" and float(values[name]) != int(values[name]):
            raise BadInput(f"--count {name}: its value {values[name]} is no whole number; is it a size (--size {name})?")
    return [(name, kind, values[name]) for name, kind in wanted]


def multiplied(count, factor):
    """A whole number; an even one stays even."""
    step = 2 if count % 2 == 0 else 1
    return max(step, step * round(count * factor / step))


class Ladder:
    """The meshes of a deck: step 0 is the deck's own."""

    def __init__(self, deck, path, arguments):
        self.deck, self.mesh = deck, deck.get("mesh", {})
        self.plane = deck.get("dimension", 3) != 3
        self.factor = arguments.factor or (2.0 if self.plane else 2.0**0.5)
        self.constants, self.split = [], False
        if "blocks" in self.mesh:
            if arguments.size or arguments.count:
                raise BadInput("--size and --count are constants of a .geo file; this deck has blocks, whose cells are multiplied by --factor")
            return
        if "file" not in self.mesh:
            raise BadInput("the deck has no mesh")
        self.file = (path.parent / self.mesh["file"]).resolve()
        if not self.file.exists():
            raise BadInput(f"{self.file}: no such file")
        if self.file.suffix == ".geo":
            if arguments.refine or arguments.size or arguments.count:
                self.constants = choose(self.file, self.mesh.get("constants", {}), arguments.size, arguments.count)
        elif arguments.size or arguments.count:
            raise BadInput(f"--size and --count are constants of a .geo file; {self.file.name} is refined by splitting its cells")
        else:
            self.split, self.factor = True, 2.0
            if arguments.refine:
                if not self.for_gmsh:
                    raise BadInput(f"{self.file.name} cannot be refined: expected a .geo, .msh, .step or .brep; --refine 0 takes the mesh as it is")
                need_gmsh(f"to refine {self.file.name}")

    @property
    def is_script(self):
        return "blocks" not in self.mesh and self.file.suffix.lower() == ".geo"

    @property
    def for_gmsh(self):
        """Whether the command gmsh takes the file for what its ending says. What it knows by neither ending nor head it runs as a script."""
        if self.file.suffix == ".msh":
            with open(self.file, "rb") as stream:
                return stream.read(11).startswith((b"$MeshFormat", b"$Comments", b"$NOD"))
        return self.file.suffix in (".geo", ".step", ".stp", ".brep")

    def says(self):
        """One line: how the mesh is refined."""
        if "blocks" in self.mesh:
            return f"cells of all blocks times {self.factor:.4g}"
        if self.split:
            return "every cell split in two along each edge (gmsh -refine; new nodes stand on the old facets, not on the true curve)"
        return ", ".join(f"{name} {'divided by' if kind == 'size' else 'times'} {self.factor:.4g}" for name, kind, _ in self.constants)

    def values(self, step):
        """{constant: value} of a .geo file."""
        return {
            name: float(f"{value / self.factor**step:.6g}") if kind == "size" else multiplied(int(value), self.factor**step)
            for name, kind, value in self.constants
        }

    def name(self, step):
        if "blocks" in self.mesh or self.split:
            return f"{step}" if step else "the deck's"
        return ", ".join(f"{name} = {value:g}" for name, value in self.values(step).items()) or "the deck's"

    def blocks(self, step, element=None):
        result = {}
        for name, block in self.mesh["blocks"].items():
            block = dict(block, cells=[max(1, round(n * self.factor**step)) for n in block["cells"]])
            result[name] = dict(block, element=element) if element else block
        return result

    def write(self, step, order, directory):
        """A .msh file of gmsh's; `order` None: as the file says."""
        need_gmsh("to mesh the geometry once for all runs")
        target = directory / "mesh.msh"
        command = ["gmsh", f"-{2 if self.plane else 3}", str(self.file), "-format", "msh2", "-o", str(target)]
        if self.split:
            command[1:3] = ["-0" if self.file.suffix == ".msh" else command[1], str(self.file)]
        for name, value in {**self.mesh.get("constants", {}), **self.values(step), **({"order": order} if order else {})}.items():
            command += ["-setnumber", name, repr(value)]
        call(command, target)
        for _ in range(step if self.split else 0):
            call(["gmsh", "-refine", str(target), "-format", "msh2", "-o", str(target)], target)
        return target


def have_gmsh():
    return shutil.which("gmsh") is not None


def need_gmsh(purpose):
    if not have_gmsh():
        raise BadInput(f"the command gmsh is needed {purpose}: apt-get install gmsh")


def call(command, target):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0 or not pathlib.Path(target).exists():
        said = [line for line in (done.stdout + done.stderr).splitlines() if "Error" in line]
        raise BadInput(f"gmsh could not mesh {command[2]}: {' '.join(said[:3]) or 'exit status ' + str(done.returncode)}")
