#!/usr/bin/env python3
"""Runs verification cases and compares them with formulas: table, judgement, plots.

    verify.py MORTISE [case ...] [--quick] [--plots DIR] [--write] [--markdown FILE] [--ranks N] [--mpiexec MPIEXEC] [--list]

A case is named by itself or by its family (a module of cases/). --quick runs the coarsest mesh of each case and compares its errors
with the bounds stated; without it the orders of convergence are judged as well. --write puts a row for each case into results.md,
--markdown a table for each case, with all meshes, into a file. Exit status 1 if a case fails. Needs numpy, and matplotlib for --plots.
"""

import argparse
import importlib
import pathlib
import sys

import study
from cases import FAMILIES


def all_cases():
    return {family: importlib.import_module(f"cases.{family}").CASES for family in FAMILIES}


def chosen(names):
    families = all_cases()
    by_name = {case.name: [case] for cases in families.values() for case in cases} | families
    if not names:
        return [case for cases in families.values() for case in cases]
    unknown = [name for name in names if name not in by_name]
    if unknown:
        raise SystemExit(f"no case or family {', '.join(unknown)}; there are {', '.join(by_name)}")
    return [case for name in names for case in by_name[name]]


def shown(value, form="{:.2g}"):
    return "-" if value is None else form.format(value)


def table(case, rows):
    """The lines of a case: one a mesh, then the orders."""
    names = [quantity.name for quantity in case.quantities]
    head = ["mesh", "unknowns", *names, "effectivity", "products", "s"]
    lines = [
        [
            row.mesh.label,
            str(row.result.summary["primal_unknowns"]),
            *(f"{row.errors[name]:.2e}" for name in names),
            shown(row.effectivity, "{:.2f}"),
            str(row.result.summary["hessian_multiplications"]),
            f"{row.result.seconds:.1f}",
        ]
        for row in rows
    ]
    if any(quantity.order is not None for quantity in case.quantities) and len(rows) > 1:
        lines.append(
            ["order: expected / measured", ""]
            + ["-" if q.order is None else f"{q.order:g} / {shown(study.order(q, rows), '{:.2f}')}" for q in case.quantities]
            + ["", "", ""]
        )
    return head, lines


def aligned(head, lines):
    widths = [max(len(line[i]) for line in [head, *lines]) for i in range(len(head))]
    return "\n".join("  " + "  ".join(word.ljust(width) for word, width in zip(line, widths)).rstrip() for line in [head, *lines])


def markdown(case, head, lines, complaints):
    text = [f"### {case.name}: {case.title}", "", f"{case.source}", "", "| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    text += ["| " + " | ".join(line) + " |" for line in lines]
    return "\n".join(text + [""] + ([f"Fails: {'; '.join(complaint.splitlines()[0] for complaint in complaints)}.", ""] if complaints else []))


HEAD = ["case", "meshes: unknowns", "errors on the finest mesh (order: expected / measured)", "effectivity", "CPU s"]


def key(case):
    return f"`{case.name}`: {case.title}"


def known_keys():
    """Of the rows that the table of the page has."""
    return [(key(case),) for cases in all_cases().values() for case in cases]


def percent(error):
    return f"{error:.1e}" if error < 1e-3 else f"{100 * error:.2g} %"


def row_of(case, rows, complaints):
    """The row of a case in the table of the page."""
    errors = []
    for quantity in case.quantities:
        measured = study.order(quantity, rows)
        orders = "" if quantity.order is None else f" ({quantity.order:g}/{shown(measured, '{:.2f}')})"
        errors.append(f"{quantity.name} {percent(rows[-1].errors[quantity.name])}{orders}")
    if complaints:
        errors.append("**fails**")
    unknowns = [row.result.summary["primal_unknowns"] for row in rows]
    effectivities = [row.effectivity for row in rows if row.effectivity is not None]
    return [
        key(case),
        f"{len(rows)}: {min(unknowns):,} to {max(unknowns):,}",
        "; ".join(errors),
        f"{min(effectivities):.2f} to {max(effectivities):.2f}" if effectivities else "-",
        f"{sum(row.result.seconds for row in rows):.0f}",
    ]


def draw(case, rows, directory):
    """One picture a case: the distribution beside the formula, and the errors over h."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    converging = [q for q in case.quantities if q.order is not None and len(rows) > 1]
    if case.plot is None and not converging:
        return
    figure, axes = plt.subplots(1, bool(case.plot) + bool(converging), figsize=(4.6 * (bool(case.plot) + bool(converging)), 3.4), squeeze=False)
    if case.plot:
        case.plot(axes[0, 0], [(row.mesh, row.result) for row in rows])
    if converging:
        last = axes[0, -1]
        h = [row.mesh.h for row in rows]
        for quantity, mark in zip(converging, "os^vDx+*"):
            (line,) = last.loglog(h, [row.errors[quantity.name] for row in rows], mark + "-", markersize=4, label=quantity.name)
            end = rows[0].errors[quantity.name]
            last.loglog(h, [end * (x / h[0]) ** quantity.order for x in h], ":", color=line.get_color(), linewidth=0.8)
        last.set_xticks(h, [f"{x:.2g}" for x in h])
        last.minorticks_off()
        last.set_xlabel("h")
        last.set_ylabel("relative error (dotted: expected order)")
        last.legend(fontsize=7)
    figure.suptitle(case.title, fontsize=9)
    figure.tight_layout()
    directory.mkdir(parents=True, exist_ok=True)
    figure.savefig(directory / f"{case.name}.png", dpi=80)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mortise", nargs="?")
    parser.add_argument("case", nargs="*")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--plots", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--markdown", type=pathlib.Path)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--mpiexec", default="mpirun")
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()
    if arguments.list or arguments.mortise is None:
        for family, cases in all_cases().items():
            print(f"{family}: {', '.join(case.name for case in cases)}")
        return 0
    if arguments.write and arguments.quick:
        parser.error("--write is for all meshes")
    program = study.Program(arguments.mortise, arguments.ranks, arguments.mpiexec)
    failed, skipped, seconds, text = [], [], 0.0, []
    for case in chosen(arguments.case):
        if arguments.quick and not case.quick:
            continue
        if program.refuses(case):
            print(f"{case.name}: skipped, this version has no dimension: {case.needs}\n", flush=True)
            skipped.append(case.name)
            continue
        print(f"{case.name}: {case.title}\n  {case.source}", flush=True)
        rows, failures = study.solve(program, case, arguments.quick)
        complaints = failures + study.judge(case, rows, arguments.quick)
        head, lines = table(case, rows)
        print(aligned(head, lines), *(f"  FAILED: {complaint}" for complaint in complaints), "" if complaints else "  passed\n", sep="\n", flush=True)
        failed += [case.name] if complaints else []
        seconds += sum(row.result.seconds for row in rows)
        text.append(markdown(case, head, lines, complaints))
        if arguments.write and rows:
            study.page_tables.write(study.PAGE, "formulas", HEAD, [row_of(case, rows, complaints)], known=known_keys())
        if arguments.plots and rows:
            draw(case, rows, arguments.plots)
    print(f"{len(failed)} failed{': ' if failed else ''}{', '.join(failed)}; {len(skipped)} skipped; {seconds:.0f} s of CPU in the program")
    if arguments.markdown:
        arguments.markdown.write_text("\n".join(text))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
