#!/usr/bin/python3
"""Error against time and unknowns: solves a deck on a family of meshes, with several tolerances and elements, and tabulates what it cost.

    ./mortise study DECK [--refine N] [--tolerances T ...] [--elements E ...] [--ranks R] [--calculix] [--exact QUANTITY=VALUE ...]
        [--pressure FORMULA] [--quantity PATH ...] [--size NAME ... | --count NAME ...] [--factor F] [--set KEY=VALUE ...] [--output DIR]

    ./mortise study inputs/press_fit/press_fit.yaml --refine 3 --tolerances 1e-2 1e-4 --elements 1 2 --pressure 69.23
    ./mortise study inputs/hertz_cylinder/hertz_cylinder.yaml --pressure "3585.4 * sqrt(maximum(0, 1 - (x / 6.2146)**2))"

Meshes: the deck's own and N finer ones. Blocks: `cells` times F; .geo: a size among mesh.constants is divided by F, a count multiplied
(--size, --count where the file leaves it open); .msh, .step, .brep: gmsh splits each cell. F is 2 for plane models and sqrt 2 for solids.
On each: `solver.tolerance: auto` and those of --tolerances. Elements: names as in mesh.blocks (hex8, hex20, ...), or the order, 1 or 2,
for a .geo with the constant `order`; a formulation may follow (hex8:incompatible, 1:bbar).

Quantities are paths into summary.json; a vector counts by its length. Errors are relative to --exact, else to Richardson's extrapolation of
Mortise's runs, else to the finest of them; the table says which. --pressure gives the contact pressure as a formula in x, y, z and `force`,
the integral of the run's own pressure; its error is taken in the L2 norm over the secondary surface.

Writes study.csv, study.md, error_over_cpu.png and error_over_unknowns.png. CPU seconds are user and system time of the whole run, start,
reading and writing included; not the meshing by the command gmsh, which meshes a geometry once for all runs where it is installed. A .geo is
a script, which gmsh would let start programs and write files: unless you trust it and say --allow-scripts, each run of Mortise meshes it,
where it cannot. --calculix adds CalculiX on the same meshes; of a .geo it needs --allow-scripts. Exit status: 0 also where some runs failed
(the table says how); 1 bad input; 2 no run succeeded; 4 a file is not writable.
"""

import json
import pathlib
import re
import sys
import tempfile

from studies import convergence, measure, tables
from studies.arguments import parse
from studies.deck import look_up, read_deck
from studies.refinement import BadInput, Ladder, defined, have_gmsh


def last_words(text, status):
    """The line of a failed run that says why."""
    if status < 0:
        return f"ended by signal {-status}" + (", the time limit of the study" if status == -9 else "")
    found = [line.strip() for line in text.splitlines() if line.strip()]
    told = [
        line for line in found if any(word in line.lower() for word in ("not converged", "*error", "no equilibrium", "yaml:", "diverg", "cutbacks"))
    ]
    return " ".join((told or found[-1:] or ["no word"])[0].split())[:200].replace("|", "/")


def unknowns_of_mesh(text):
    """Of the run's first lines; primal_unknowns of summary.json counts a node once for each of its subdomains."""
    found = re.search(r"\bnodes, \d+ cells, (\d+) unknowns\b", text)
    return int(found.group(1)) if found else None


class Study:
    def __init__(self, arguments, deck, scratch):
        self.arguments, self.deck, self.scratch = arguments, deck, scratch
        self.ladder = Ladder(deck, arguments.deck, arguments)
        self.dimension = 3 if deck.get("dimension", 3) == 3 else 2
        self.blocks = "blocks" in self.ladder.mesh
        self.formula = None
        if arguments.pressure:
            try:
                from studies.pressure import Formula
            except ImportError as problem:
                raise BadInput(f"--pressure integrates by numpy, and {problem.name} is missing: apt-get install python3-numpy") from None
            self.formula = Formula(arguments.pressure)
        self.quantities = ([convergence.L2] if self.formula else []) + (arguments.quantity or self.usual_quantities())
        self.quantities += [path for path in arguments.exact if path not in self.quantities]
        self.check_elements()
        self.meshes = {}

    @property
    def premesh(self):
        """A geometry is meshed once where gmsh is there; cells of a .msh are split by it; CalculiX needs a file. The command lets a .geo
        do what it likes."""
        if self.blocks or not self.ladder.for_gmsh or self.ladder.is_script and not self.arguments.allow_scripts:
            return False
        splits = self.ladder.split and self.arguments.refine > 0
        return splits or self.arguments.calculix or self.ladder.file.suffix != ".msh" and have_gmsh()

    def usual_quantities(self):
        contacts = range(len(self.deck.get("contacts") or []))
        return [
            "strain_energy",
            "max_displacement",
            *(f"contacts.{i}.{key}" for i in contacts for key in ("force", "max_recovered_pressure")),
            "error_estimate.discretization",
        ]

    def check_elements(self):
        for element in self.arguments.elements:
            name, colon, formulation = element.partition(":")
            if colon and formulation not in ("standard", "bbar", "incompatible"):
                raise BadInput(f'--elements {element}: the formulation is "{formulation}"; expected standard, bbar or incompatible')
            if self.blocks:
                if name.isdigit():
                    raise BadInput(f"--elements {element}: the cells of blocks have names (hex8, hex20, quad4, ...), no order")
            elif name not in ("1", "2"):
                raise BadInput(f"--elements {element}: expected an order, 1 or 2, for a mesh from a file")
            elif self.ladder.file.suffix != ".geo":
                raise BadInput(f"--elements {element}: the cells of {self.ladder.file.name} are what they are; give a .geo with a constant `order`")
            elif "order" not in defined(self.ladder.file.read_text()):
                raise BadInput(
                    f"--elements {element}: {self.ladder.file.name} has no constant `order`; add to it\n"
                    "  DefineConstant[ order = 1 ]; Mesh.ElementOrder = order;"
                )

    def mesh_settings(self, step, element):
        """--set arguments for one mesh; gmsh meshes a geometry once for all that ask for it."""
        name, _, formulation = (element or "").partition(":")
        settings = [f"bodies.{body}.formulation={formulation}" for body in self.deck.get("bodies", {}) if formulation]
        if self.blocks:
            blocks = self.ladder.blocks(step, name)
            settings += [f"mesh.blocks.{key}.cells={block['cells']}" for key, block in blocks.items()]
            return settings + [f"mesh.blocks.{key}.element={name}" for key in blocks if name]
        if self.premesh:
            scale = f", scale: {self.ladder.mesh['scale']}" if "scale" in self.ladder.mesh else ""
            return settings + [f'mesh={{file: "{self.mesh_file(step, name)}"{scale}}}']
        settings += [f"mesh.constants.{key}={value!r}" for key, value in self.ladder.values(step).items()]
        return settings + ([f"mesh.constants.order={name}"] if name else [])

    def mesh_file(self, step, order):
        if (step, order) not in self.meshes:
            directory = pathlib.Path(tempfile.mkdtemp(dir=self.scratch))
            self.meshes[step, order] = self.ladder.write(step, int(order) if order else None, directory)
        return self.meshes[step, order]

    def row(self, program, element, step, tolerance, measured):
        label = element if self.blocks or not element else f"order {element}"
        return {
            "program": program,
            "element": label,
            "step": step,
            "mesh": self.ladder.name(step),
            "tolerance": tolerance,
            "status": measured.status,
            "message": last_words(measured.text, measured.status) if measured.status else "",
            "cpu": measured.cpu,
            "wall": measured.wall,
            "memory": measured.memory,
            "unknowns": None,
            "products": None,
            "values": {},
        }

    def cheapest(self, solve):
        """Of --repeat runs: other work on the machine only adds to the CPU seconds."""
        return min((solve() for _ in range(self.arguments.repeat)), key=lambda measured: measured.cpu)

    def mortise(self, step, element, tolerance):
        with tempfile.TemporaryDirectory(dir=self.scratch) as name:
            directory = pathlib.Path(name)
            command = [self.arguments.mortise, str(self.arguments.deck), "--output", str(directory / "out")]
            if self.arguments.allow_scripts:
                command.append("--allow-scripts")
            for setting in [*self.arguments.set, *self.mesh_settings(step, element), f"solver.tolerance={tolerance}"]:
                command += ["--set", setting]
            if self.arguments.ranks > 1:
                command = [self.arguments.mpiexec, "--oversubscribe", "--bind-to", "none", "-n", str(self.arguments.ranks), "--quiet", *command]
            measured = self.cheapest(lambda: measure.run(command, directory, self.arguments.time_limit))
            row = self.row("Mortise", element, step, tolerance, measured)
            summary_file = directory / "out" / "summary.json"
            if summary_file.exists():
                summary = json.loads(summary_file.read_text())
                row.update(
                    unknowns=unknowns_of_mesh(measured.text) or summary["primal_unknowns"],
                    products=summary["hessian_multiplications"],
                    memory=summary["peak_memory_bytes"] / 1e6,
                )
                row["values"] = {q: look_up(summary, q) for q in self.quantities if q != convergence.L2}
                if self.formula:
                    from studies import pressure

                    row["values"][convergence.L2] = pressure.relative_error(
                        pressure.of_mortise(directory / "out", self.arguments.contact, self.arguments.field), self.formula
                    )
        return row

    def calculix(self, step, element, solver, penalty):
        from studies import calculix

        with tempfile.TemporaryDirectory(dir=self.scratch) as name:
            directory = pathlib.Path(name)
            order, _, formulation = (element or "").partition(":")
            deck = dict(
                self.deck,
                bodies={body: dict(entry, **({"formulation": formulation} if formulation else {})) for body, entry in self.deck["bodies"].items()},
            )
            mesh = calculix.Mesh(self.mesh_file(step, order), self.dimension, self.ladder.mesh.get("scale", 1.0))
            measured = self.cheapest(lambda: calculix.solve(deck, mesh, penalty, solver, directory, self.arguments.time_limit))
            row = self.row(f"CalculiX {calculix.SOLVERS[solver]} {penalty:g} E", element, step, "", measured)
            row["unknowns"] = mesh.unknowns()
            if measured.status == 0:
                found = calculix.results(directory, deck, mesh, self.formula, self.arguments.contact)
                row["values"] = {q: found.get(q) for q in self.quantities}
        return row

    def combinations(self):
        for element in self.arguments.elements or [""]:
            for step in range(self.arguments.refine + 1):
                wanted = self.arguments.tolerances if self.arguments.tolerance_mesh in (None, step) else []
                for tolerance in [*wanted, "auto"]:
                    yield ("Mortise", element, step, tolerance), self.mortise, (step, element, tolerance)
                if self.arguments.calculix:
                    for solver in self.arguments.solvers:
                        for penalty in self.arguments.penalty:
                            yield ("CalculiX", element, step, ""), self.calculix, (step, element, solver, penalty)

    def run(self):
        rows, checked = [], False
        for label, solve, case in self.combinations():
            try:
                row = solve(*case)
            except BadInput as problem:  # of this mesh or translation; the others may still do
                if not rows:
                    raise
                row = self.row(*label, measure.Measured(None, None, None, 1, str(problem)))
            said = f"{row['cpu']:.2f} CPU s" if row["status"] == 0 else f"exit status {row['status']}: {row['message']}"
            print(
                "  " + ", ".join(filter(None, [row["program"], row["element"], f"mesh {row['mesh']}", row["tolerance"]])) + f": {said}",
                file=sys.stderr,
                flush=True,
            )
            rows.append(row)
            if row["program"] == "Mortise" and row["status"] == 0 and not checked:
                checked = True
                self.check_quantities(row)
        return rows

    def check_quantities(self, row):
        for quantity in self.quantities:
            if row["values"][quantity] is None:
                raise BadInput(f"{quantity}: summary.json has no such number")

    def remarks(self):
        arguments = self.arguments
        meshing = "the mesh is made once by gmsh and not counted" if self.premesh else "with the making of the mesh"
        repeats = f" (the least of {arguments.repeat} runs)" if arguments.repeat > 1 else ""
        result = [
            f"meshes: {self.ladder.says() or 'one'}",
            f"{arguments.ranks} rank{'s' if arguments.ranks > 1 else ''}; CPU seconds of the whole run{repeats}, {meshing}",
        ]
        if self.formula:
            result.append(f"{convergence.L2}: relative error of the contact pressure ({arguments.field} of Mortise) against {self.formula.text}")
        if arguments.calculix:
            result.append(
                "CalculiX: surface to surface contact, linear penalty in Young's moduli a length; nodal pressures of its .frd file; "
                f"iterative: its incomplete Cholesky solver; stopped after {arguments.time_limit:g} s"
            )
        return result


def without_calculix(study):
    """Why CalculiX is left out, or None."""
    from shutil import which

    if which("ccx") is None:
        return "CalculiX is left out: the command ccx is missing (apt-get install calculix-ccx)"
    if study.blocks:
        return "CalculiX is left out: a deck of blocks has no mesh file to give it; mesh a .geo instead"
    if not study.ladder.for_gmsh:
        return f"CalculiX is left out: gmsh makes no mesh file for it of {study.ladder.file.name}; expected a .geo, .msh, .step or .brep"
    if study.ladder.is_script and not study.arguments.allow_scripts:
        name = study.ladder.file.name
        return f"CalculiX is left out: gmsh would make its mesh file, and lets {name} start programs; if you trust it, --allow-scripts"
    try:
        import meshio  # noqa: F401
    except ImportError:
        return "CalculiX is left out: its translation needs meshio (apt-get install python3-meshio)"
    return None


def conduct(arguments, scratch):
    study = Study(arguments, read_deck(arguments.deck, arguments.set), scratch)
    remarks = study.remarks()
    if arguments.calculix:
        problem = without_calculix(study)
        if problem:
            print(f"mortise study: {problem}", file=sys.stderr)
            arguments.calculix = False
            remarks = study.remarks() + [problem]
    plot = arguments.plot or (convergence.L2 if study.formula else next(iter(arguments.exact), study.quantities[0]))
    if plot not in study.quantities:
        raise BadInput(f"--plot {plot}: not among the quantities ({', '.join(study.quantities)})")
    arguments.output.mkdir(parents=True, exist_ok=True)
    rows = study.run()
    good = [row for row in rows if row["status"] == 0]
    references = convergence.measure(rows, study.quantities, arguments.exact, study.dimension)
    title = study.deck.get("title", arguments.deck.stem)
    text = tables.report(title, remarks, rows, study.quantities, references)
    if arguments.calculix:
        text += "\n".join(tables.equal_error(rows, plot, plot) + [""])
    tables.write_whole(arguments.output / "study.csv", tables.comma_separated(rows, study.quantities))
    tables.write_whole(arguments.output / "study.md", text)
    print(text)
    said = tables.plots(rows, plot, title, arguments.output)
    print(said or f"Written to {arguments.output}: study.csv, study.md, error_over_cpu.png, error_over_unknowns.png")
    return 0 if good else 2


def main():
    try:
        arguments = parse(sys.argv[1:], __doc__)
        with tempfile.TemporaryDirectory(prefix="mortise_study_") as scratch:
            return conduct(arguments, pathlib.Path(scratch))
    except BadInput as problem:
        print(f"mortise study: {problem}", file=sys.stderr)
        return 1
    except OSError as problem:
        print(f"mortise study: {problem.filename}: {problem.strerror}", file=sys.stderr)
        return 4


if __name__ == "__main__":
    sys.exit(main())
