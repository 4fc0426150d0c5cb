"""What a verification case is, how it is run and how it is judged."""

import dataclasses
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
from typing import Callable, Optional

import numpy as np

from results import Result

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import page_tables  # noqa: E402, F401: for the scripts here

HERE = pathlib.Path(__file__).resolve().parent
PAGE = HERE / "results.md"  # with the tables of figures
INPUTS = HERE.parent.parent / "inputs"
ORDER_SLACK = 0.3  # what a measured order may stay below the expected one: meshes are not asymptotic


@dataclasses.dataclass
class Mesh:
    """One run: settings as the command line's --set takes them; h the size of a cell in whatever measure the case likes."""

    label: str
    h: float
    settings: list
    deck: Optional[pathlib.Path] = None  # instead of the case's
    generate: Optional[Callable] = None  # generate(path) writes the mesh file


@dataclasses.dataclass
class Quantity:
    """bound: the largest relative error on the first mesh (without an order: on each). order: expected at refinement. floor: error
    that the formula's own assumptions leave on this model, below which no order is asked for. differences: the order is that of
    the differences between the values of successive meshes, where the floor would hide it."""

    name: str
    bound: float
    order: Optional[float] = None
    floor: float = 0.0
    differences: bool = False
    unit_error: str = ""


@dataclasses.dataclass
class Case:
    """evaluate(result, mesh) -> {quantity: (found, expected)}, or {quantity: error} for a norm that is an error already."""

    name: str
    title: str
    source: str
    deck: pathlib.Path
    meshes: list
    quantities: list
    evaluate: Callable
    plot: Optional[Callable] = None  # plot(axes, [(mesh, result)]): a distribution beside the formula
    true_error: Optional[Callable] = None  # true_error(result, mesh) -> ||u - u_h|| in the energy norm, absolute
    effectivity: tuple = (0.7, 1.5)  # judged where true_error is there
    quick: tuple = (0,)  # numbers of the meshes that --quick runs
    needs: str = ""  # a value of `dimension` that not every version of the program has


@dataclasses.dataclass
class Row:
    mesh: Mesh
    result: Result
    errors: dict
    values: dict
    effectivity: Optional[float] = None


class Failed(RuntimeError):
    """A run that did not end as it should."""


class Program:
    """Runs Mortise on decks; the results live as long as this object."""

    def __init__(self, mortise, ranks=1, mpiexec="mpirun"):
        self.mortise, self.ranks, self.mpiexec = os.path.abspath(mortise), ranks, mpiexec
        self.scratch = tempfile.TemporaryDirectory(prefix="mortise_verification_")
        self.runs = 0

    def command(self, deck, settings):
        words = [self.mortise, str(deck)] + [word for setting in settings for word in ("--set", setting)]
        return [self.mpiexec, "--oversubscribe", "-n", str(self.ranks)] + words if self.ranks > 1 else words

    def attempt(self, deck, settings, generate=None):
        """Exit status, what was printed, the directory of the results, seconds of CPU."""
        self.runs += 1
        directory = pathlib.Path(self.scratch.name) / str(self.runs)
        if generate:
            mesh = directory.with_suffix(".msh")
            generate(mesh)
            settings = [f"mesh.file={mesh}", *settings]
        environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(
            self.command(deck, settings) + ["--output", str(directory)], capture_output=True, text=True, env=environment, timeout=1200
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return done.returncode, done.stdout + done.stderr, directory, seconds

    def run(self, deck, settings, generate=None):
        status, text, directory, seconds = self.attempt(deck, settings, generate)
        if status != 0:
            raise Failed(f"{deck.name} {' '.join(settings)}: exit status {status}\n{text[-2000:]}")
        return Result(directory, seconds)

    def refuses(self, case):
        """Whether this version of the program does not have the case's `dimension`; it must say so itself."""
        if not case.needs:
            return False
        done = subprocess.run([self.mortise, str(case.deck), "--check"], capture_output=True, text=True)
        return done.returncode == 1 and f'"{case.needs}" is not available' in done.stdout + done.stderr


def relative(found, expected):
    return abs(found - expected) / abs(expected) if expected else abs(found)


def solve(program, case, quick):
    """The rows of a case, one a mesh, and what was said by the runs that failed."""
    rows, failures = [], []
    for mesh in [case.meshes[i] for i in case.quick] if quick else case.meshes:
        try:
            result = program.run(mesh.deck or case.deck, mesh.settings, mesh.generate)
        except Failed as failure:
            failures.append(f"{mesh.label}: {failure}")
            continue
        found = case.evaluate(result, mesh)
        errors = {name: relative(*value) if isinstance(value, tuple) else value for name, value in found.items()}
        values = {name: value[0] if isinstance(value, tuple) else value for name, value in found.items()}
        row = Row(mesh, result, errors, values)
        if case.true_error:
            estimate = result.summary["error_estimate"]["discretization"]
            energy = 2 * result.summary["strain_energy"]
            row.effectivity = estimate * np.sqrt(energy / (1 - estimate**2)) / case.true_error(result, mesh)
        rows.append(row)
    return rows, failures


def slope(h, errors):
    """Least squares slope of log error over log h."""
    if len(h) < 2 or len(set(h)) < 2 or min(errors) <= 0:
        return None
    return float(np.polyfit(np.log(h), np.log(errors), 1)[0])


def order(quantity, rows):
    """The measured order of convergence, or None."""
    if quantity.order is None:
        return None
    h = [row.mesh.h for row in rows]
    if not quantity.differences:
        return slope(h, [row.errors[quantity.name] for row in rows])
    values = [row.values[quantity.name] for row in rows]
    return slope(h[:-1], [abs(b - a) for a, b in zip(values, values[1:])])


def judge(case, rows, quick):
    """What is wrong with the rows, and what is too little to say."""
    complaints = []
    for quantity in case.quantities:
        if not rows:
            break
        judged = rows if quantity.order is None or quick else rows[:1]
        for row in judged:
            if not row.errors[quantity.name] <= quantity.bound:
                complaints.append(f"{quantity.name} on {row.mesh.label}: error {row.errors[quantity.name]:.3g}, bound {quantity.bound:g}")
        if quick or quantity.order is None:
            continue
        if not quantity.differences and not rows[-1].errors[quantity.name] > quantity.floor:
            continue
        measured = order(quantity, rows)
        if measured is None or not measured >= quantity.order - ORDER_SLACK:
            text = "not to be had" if measured is None else f"{measured:.2f}"
            complaints.append(f"{quantity.name}: order {text}, expected {quantity.order:g}")
        if quantity.floor and quantity.differences and not rows[-1].errors[quantity.name] <= quantity.floor:
            complaints.append(f"{quantity.name}: error {rows[-1].errors[quantity.name]:.3g} on the finest mesh, floor {quantity.floor:g}")
    for row in rows:
        if row.effectivity is not None and not case.effectivity[0] <= row.effectivity <= case.effectivity[1]:
            complaints.append(f"effectivity on {row.mesh.label}: {row.effectivity:.2f}, expected {case.effectivity[0]} to {case.effectivity[1]}")
    return complaints
