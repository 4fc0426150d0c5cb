"""Writes what a study found: study.csv, study.md and the two plots. A file appears under its name when it is whole."""

import csv
import io
import os

from studies import convergence

COLUMNS = ("program", "element", "mesh", "tolerance", "status", "unknowns", "products", "cpu", "wall", "memory")


def write_whole(path, content):
    part = path.with_name(f".{path.name}.part")
    part.write_bytes(content if isinstance(content, bytes) else content.encode())
    os.replace(part, path)


def comma_separated(rows, quantities):
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    heads = [
        name
        for q in quantities
        for name in ((q,) if convergence.is_error(q) else (q, f"error of {q}", f"change from the tightest of {q}", f"order of {q}"))
    ]
    writer.writerow([*COLUMNS, *heads, "message"])
    for row in rows:
        cells = []
        for q in quantities:
            cells += [row["values"].get(q)]
            if not convergence.is_error(q):
                cells += [row[key].get(q) for key in ("errors", "algebraic", "orders")]
        writer.writerow(["" if cell is None else cell for cell in [*(row[c] for c in COLUMNS), *cells, row["message"]]])
    return text.getvalue()


def percent(value):
    return "-" if value is None else f"{100 * value:.2g} %"


def rounded(value, form):
    return "-" if value is None else format(value, form)


def aligned(head, body):
    """A markdown table that can be read as text."""
    widths = [max(len(str(row[i])) for row in [head, *body]) for i in range(len(head))]
    line = [f"| {' | '.join(str(cell).ljust(width) for cell, width in zip(row, widths))} |" for row in [head, *body]]
    return [line[0], "|" + "|".join("-" * (width + 2) for width in widths) + "|", *line[1:]]


def cell(row, quantity):
    """Value, error and order of one quantity."""
    if row["values"].get(quantity) is None:
        return "-"
    value = "" if convergence.is_error(quantity) else f"{row['values'][quantity]:.6g}; "
    error = percent(row["errors"][quantity]) if quantity in row["errors"] else "reference" if row["status"] == 0 else "-"
    order = f"; {row['orders'][quantity]:.1f}" if quantity in row["orders"] else ""
    return f"{value}{error}{order}"


def main_table(rows, quantities):
    head = ["program, element", "mesh", "tolerance", "unknowns", "products", "CPU s", "wall s", "MB", *quantities]
    body = []
    for row in rows:
        end = [cell(row, q) for q in quantities]
        if row["status"] != 0 and end:
            end[0] = f"exit status {row['status']}"
        body.append(
            [
                f"{row['program']} {row['element']}".strip(),
                row["mesh"],
                row["tolerance"] or "-",
                row["unknowns"] or "-",
                row["products"] or "-",
                rounded(row["cpu"], ".2f"),
                rounded(row["wall"], ".2f"),
                rounded(row["memory"], ".0f"),
                *end,
            ]
        )
    return aligned(head, body)


def failures(rows):
    """What the runs said that ended with another exit status than 0, once each."""
    said = {}
    for row in rows:
        if row["status"] != 0:
            run = " ".join(filter(None, [row["program"], row["element"], f"mesh {row['mesh']}", row["tolerance"]]))
            said.setdefault((row["status"], row["message"]), []).append(run)
    return [""] * bool(said) + [f"- exit status {status}: {message} ({'; '.join(runs)})" for (status, message), runs in said.items()]


def algebraic_table(rows, quantities):
    """Of the meshes that were solved with more than one tolerance."""
    chosen = [q for q in quantities if any(q in row["algebraic"] for row in rows)]
    if not chosen:
        return []
    body = [
        [
            f"{row['program']} {row['element']}".strip(),
            row["mesh"],
            row["tolerance"],
            row["products"],
            rounded(row["cpu"], ".2f"),
            *(f"{percent(row['algebraic'].get(q))}; {percent(row['errors'].get(q))}" for q in chosen),
        ]
        for row in rows
        if row["algebraic"]
    ]
    return [
        "",
        "The solver's share: change from the tightest run of the same mesh; error against the reference.",
        "",
        *aligned(["program, element", "mesh", "tolerance", "products", "CPU s", *chosen], body),
    ]


def report(title, remarks, rows, quantities, references):
    text = [f"# {title}", ""] + [f"- {remark}" for remark in remarks]
    text += [f"- {q}: reference {value:.8g}, {where}" for q, (value, where) in references.items() if where]
    text += [
        "",
        "A quantity's columns: value; relative error; measured order (exponent of the error against the size of cells, unknowns^(-1/dimension)).",
        "",
    ]
    return "\n".join(text + main_table(rows, quantities) + failures(rows) + algebraic_table(rows, quantities)) + "\n"


def equal_error(rows, quantity, names):
    """CPU seconds of the programs at the errors of the runs with `auto`, and their ratio to Mortise's best element."""
    chains = {key: chain for key, chain in convergence.series(rows, quantity).items() if key[2] in ("auto", "")}
    ours = {key: chain for key, chain in chains.items() if key[0] == "Mortise"}
    theirs = {key: chain for key, chain in chains.items() if key[0] != "Mortise"}
    body = []
    for key, chain in theirs.items():
        for row in chain:
            error = row["errors"].get(quantity)
            best = (
                min((seconds for seconds in (seconds_of(own, quantity, error) for own in ours.values()) if seconds), default=None) if error else None
            )
            body.append(
                [
                    f"{key[0]} {key[1]}",
                    row["mesh"],
                    percent(error),
                    f"{row['cpu']:.2f}",
                    rounded(best, ".2f"),
                    f"{row['cpu'] / best:.1f}" if best else "-",
                ]
            )
    if not body:
        return []
    return [
        "",
        f"At equal error of {names}: CPU seconds of the other program's run, of Mortise with its best element, and their ratio.",
        "",
        *aligned(["program, element", "mesh", "error", "CPU s", "Mortise: CPU s", "ratio"], body),
    ]


def seconds_of(chain, quantity, wanted):
    """As seconds_at, and the cheapest run of all where even that is more exact."""
    done = [row for row in chain if row["errors"].get(quantity)]
    cheaper = [row["cpu"] for row in done if row["errors"][quantity] <= wanted]
    between = convergence.seconds_at(chain, quantity, wanted)
    return min([value for value in [between, *cheaper] if value], default=None)


def plots(rows, quantity, title, directory):
    """Error over CPU seconds and over unknowns; returns a sentence where there is no matplotlib."""
    try:
        import matplotlib
    except ImportError:
        return "No plots: python3-matplotlib is missing (apt-get install python3-matplotlib). The tables are complete."
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    for axis, label in (("cpu", "CPU seconds"), ("unknowns", "unknowns")):
        figure, plot = plt.subplots(figsize=(7.5, 5.5))
        draw(plot, rows, quantity, axis)
        plot.set(xscale="log", yscale="log", xlabel=label, ylabel=f"relative error of {quantity}")
        plot.set_title(title, fontsize=10)
        plot.grid(True, which="both", linewidth=0.3)
        plot.legend(fontsize=8)
        figure.tight_layout()
        picture = io.BytesIO()
        figure.savefig(picture, format="png", dpi=110)
        plt.close(figure)
        write_whole(directory / f"error_over_{'cpu' if axis == 'cpu' else 'unknowns'}.png", picture.getvalue())
    return None


def draw(plot, rows, quantity, axis):
    """One line an element or program, through the runs that stop by themselves (else the tightest); thin lines through the tolerances of a mesh."""
    good = [row for row in rows if row["status"] == 0 and row["errors"].get(quantity)]
    names = list(dict.fromkeys((row["program"], row["element"]) for row in good))
    marked = labelled = False
    for number, name in enumerate(names):
        own = [row for row in good if (row["program"], row["element"]) == name]
        tolerances = {row["tolerance"] for row in own}
        chosen = "auto" if "auto" in tolerances else min(own, key=convergence.looseness)["tolerance"]
        line = sorted((row for row in own if row["tolerance"] == chosen), key=lambda row: row["step"])
        ours = name[0] == "Mortise"
        plot.plot(
            [row[axis] for row in line],
            [row["errors"][quantity] for row in line],
            "-o" if ours else "--s",
            color=f"C{number}",
            markersize=4,
            label=" ".join(name).strip(),
        )
        for step in sorted({row["step"] for row in own}):
            thin = sorted((row for row in own if row["step"] == step and row["tolerance"]), key=lambda row: row["products"])
            plot.plot(
                [row[axis] for row in thin],
                [row["errors"][quantity] for row in thin],
                ":.",
                color=f"C{number}",
                linewidth=0.8,
                markersize=3,
                label=None if labelled or len(thin) < 2 else "tolerances on one mesh",
            )
            labelled = labelled or len(thin) > 1
        stars = [row for row in own if row["tolerance"] == "auto"]
        plot.plot(
            [row[axis] for row in stars],
            [row["errors"][quantity] for row in stars],
            "*",
            color=f"C{number}",
            markersize=13,
            markeredgecolor="black",
            label="stopped by itself (auto)" if stars and not marked else None,
        )
        marked = marked or bool(stars)
