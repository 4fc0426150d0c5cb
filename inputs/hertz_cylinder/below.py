#!/usr/bin/env python3
"""The stress below a line contact, of finite elements beside boundary elements, and what each costs.

    below.py MORTISE [--picture FILE.png] [--h 0.2] [--table] [--write]

Runs hertz_cylinder.yaml with a sixteenth of its force, a = 0.03 R, and a block of 2 m, for which Hertz's formulas hold. The picture shows
the von Mises stress over the largest pressure of Hertz's formula, both methods on the meshes of one size, and the depth of the largest one.
--table: over mesh sizes the errors of the largest pressure and of the depth of the largest von Mises stress on the axis of symmetry, 0.7042 a,
with unknowns and CPU time over that of the first row; --write puts it into README.md.
"""
import argparse
import csv
import json
import math
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "regression"))
import page_tables  # noqa: E402

HEAD = ["method", "h", "unknowns", "largest pressure", "depth of the largest von Mises stress", "its height", "CPU time, of the first row's"]
R, FORCE = 50.0, 35e3 / 16  # of the whole cylinder
A = math.sqrt(4 * FORCE * R * ((1 - 0.3**2) / 210e3 + (1 - 0.3**2) / 70e3) / math.pi)  # [Johnson 1985, 4.43]
P0 = 2 * FORCE / (math.pi * A)


def on_the_axis(s, nu=0.3):
    """von Mises stress over p0 at the depth s a [Johnson 4.46]."""
    r = math.sqrt(1 + s * s)
    x, y = -((1 + 2 * s * s) / r - 2 * s), -1 / r
    z = nu * (x + y)
    return math.sqrt(((x - y)**2 + (y - z)**2 + (z - x)**2) / 2)


def top_of(depths, values):
    """Where a parabola through the largest of them and its neighbours is highest, and how high."""
    k = min(max(values.index(max(values)), 1), len(values) - 2)
    (a, b, c), step = values[k - 1:k + 2], depths[k] - depths[k - 1]
    shift = (a - c) / (2 * (a - 2 * b + c))
    return depths[k] + shift * step, b - (a - c) * shift / 4


def solve(mortise, method, h, points, order=1):
    """Rows of interior.csv, the summary and CPU seconds."""
    with tempfile.TemporaryDirectory(prefix="mortise_below_") as directory:
        directory = pathlib.Path(directory)
        (directory / "points.csv").write_text("".join(f"{x:.12g} {y:.12g}\n" for x, y in points))
        command = [mortise, str(HERE / "hertz_cylinder.yaml"), "--output", str(directory / "out")]
        for setting in [f"bodies.{b}.method={method}" for b in ("cylinder", "block")] + [
                f"mesh.constants={{h: {h}, order: {order}, d: 3, W: 2000, H: 2000}}",
                f"loads=[{{boundary: cylinder_top, force: [0, {-FORCE / 2}]}}]", f"output.interior.points={directory / 'points.csv'}"]:
            command += ["--set", setting]
        environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_THREAD_LIMIT="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                           OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        finished = subprocess.run(command, capture_output=True, text=True, env=environment)
        seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        if finished.returncode != 0:
            raise SystemExit(f"{method}, {h}: exit status {finished.returncode}\n{finished.stdout[-2000:]}{finished.stderr[-2000:]}")
        with (directory / "out" / "interior.csv").open(newline="") as lines:
            rows = list(csv.DictReader(lines))
        return rows, json.loads((directory / "out" / "summary.json").read_text()), seconds


def axis_points():
    return [0.4 + 0.01 * i for i in range(81)]


def depth_of(rows, depths):
    return top_of(depths, [float(row["von_mises"]) / P0 for row in rows])


def table(mortise, write):
    exact = top_of(axis_points(), [on_the_axis(s) for s in axis_points()])
    print(f"formula: {exact[1]:.4f} p0 at {exact[0]:.4f} a\n")
    print(page_tables.line_of(HEAD))
    first, found = None, []
    points = [(0, -s * A) for s in axis_points()]
    for name, method, order, sizes in (("boundary elements", "boundary_elements", 1, (0.4, 0.2, 0.1, 0.05)),
                                       ("quad4", "finite_elements", 1, (0.2, 0.1, 0.05, 0.025, 0.0125)),
                                       ("quad9", "finite_elements", 2, (0.4, 0.2, 0.1, 0.05))):
        for h in sizes:
            rows, summary, seconds = solve(mortise, method, h, points, order)
            depth, height = depth_of(rows, axis_points())
            pressure = summary["contacts"][0]["max_pressure"]
            first = first or seconds
            errors = (100 * (value - 1) for value in (pressure / P0, depth / exact[0], height / exact[1]))
            found.append([name, str(h), f"{summary['primal_unknowns']:,}", *(f"{error:+.2f} %" for error in errors), f"{seconds / first:.1f}"])
            print(page_tables.line_of(found[-1]), flush=True)
    if write:
        page_tables.write(HERE / "README.md", "below the contact", HEAD, found, keys=2, known=[tuple(row[:2]) for row in found])


def picture(mortise, h, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot
    import numpy
    x, t = numpy.linspace(0.002, 2, 81), numpy.linspace(0.002, 2.2, 89)
    block = [(a * A, -b * A) for b in t for a in x]
    cylinder = [(a * A, R - math.sqrt(R * R - (a * A)**2) + b * A / 2) for b in t for a in x]
    figure, axes = pyplot.subplots(1, 2, figsize=(9, 6.2), sharey=True, layout="constrained")
    for axis, method in zip(axes, ("finite_elements", "boundary_elements")):
        rows, summary, seconds = solve(mortise, method, h, block + cylinder)
        for points, body in ((block, "block"), (cylinder, "cylinder")):
            values = {(round(float(r["x"]), 6), round(float(r["y"]), 6)): float(r["von_mises"]) / P0 for r in rows if r["body"] == body}
            field = numpy.array([values[round(a, 6), round(b, 6)] for a, b in points]).reshape(len(t), len(x))
            place = numpy.array(points).reshape(len(t), len(x), 2) / A
            levels = numpy.linspace(0, 0.6, 25)
            shown = axis.contourf(place[..., 0], place[..., 1], field, levels=levels, cmap="viridis", extend="max")
            axis.contour(place[..., 0], place[..., 1], field, levels=levels[::2], colors="white", linewidths=0.4)
            if body == "block":
                at = numpy.unravel_index(numpy.argmax(field), field.shape)
                axis.plot(*place[at], "r+", markersize=11, clip_on=False)
                where = f"{field[at]:.3f} p0 at {-place[at][1]:.2f} a"
        axis.set_aspect("equal")
        axis.set_title(f"{method.replace('_', ' ')}, h = a / {A / h:.1f}\n{summary['primal_unknowns']:,} unknowns; largest in the block: {where}",
                       fontsize=9)
        axis.set_xlabel("x / a")
    axes[0].set_ylabel("y / a")
    figure.colorbar(shown, ax=axes, label="von Mises stress / p0", shrink=0.8, ticks=numpy.linspace(0, 0.6, 7))
    figure.savefig(path, dpi=72)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise")
    parser.add_argument("--picture", type=pathlib.Path)
    parser.add_argument("--h", type=float, default=0.2)
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    if arguments.picture:
        picture(arguments.mortise, arguments.h, arguments.picture)
    if arguments.table or arguments.write:
        table(arguments.mortise, arguments.write)


if __name__ == "__main__":
    main()
