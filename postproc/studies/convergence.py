"""Rows of runs: references, errors, orders of convergence.

A row is a dictionary with program, element, step, mesh, tolerance, status, message, unknowns, products, cpu, wall, memory, `values`
{quantity: value}; `measure` adds `errors` (against the reference), `algebraic` (against the tightest run of the same mesh) and `orders`.
"""

import math

L2 = "pressure (L2)"


def is_error(quantity):
    """Needs no reference."""
    return quantity == L2 or quantity.startswith("error_estimate")


def usable(row, quantity):
    return row["status"] == 0 and row["values"].get(quantity) is not None


def looseness(row):
    """Least for the run of a mesh that was solved furthest: `auto` may stop before or after a number does, products tell."""
    return -(row["products"] or 0)


def series(rows, quantity=None, program=None):
    """{(program, element, tolerance): rows by step}."""
    result = {}
    for row in sorted(rows, key=lambda row: row["step"]):
        if (quantity is None or usable(row, quantity)) and (program is None or row["program"] == program):
            result.setdefault((row["program"], row["element"], row["tolerance"]), []).append(row)
    return result


def size(row, dimension):
    return row["unknowns"] ** (-1.0 / dimension)


def richardson(h, values):
    """Limit and order of values at three sizes with value = limit + c h^order; None where they do not converge so."""
    first, second = values[0] - values[1], values[1] - values[2]
    if first == 0 or second == 0 or first * second < 0 or abs(second) >= abs(first) or not h[0] > h[1] > h[2]:
        return None

    def ratio(p):
        return (h[0] ** p - h[1] ** p) / (h[1] ** p - h[2] ** p) - first / second

    low, high = 0.05, 12.0
    if ratio(low) > 0 or ratio(high) < 0:
        return None
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if ratio(middle) < 0 else (low, middle)
    if low < 0.3 or low > 8:
        return None
    return values[2] - second * h[2] ** low / (h[1] ** low - h[2] ** low), low


def reference(rows, quantity, exact, dimension):
    """(value, where it comes from, row that is the reference or None) or None."""
    if quantity in exact:
        return exact[quantity], "given", None
    chains = {}
    for (_, element, tolerance), chain in series(rows, quantity, "Mortise").items():
        chains.setdefault(element, []).append((tolerance, chain))
    extrapolated, finest = [], []
    for element, own in chains.items():
        tolerance, chain = min(own, key=lambda item: (-len(item[1]), looseness(item[1][-1])))
        values = [row["values"][quantity] for row in chain]
        if len(chain) >= 3:
            limit = richardson([size(row, dimension) for row in chain[-3:]], values[-3:])
            if limit:
                extrapolated.append(
                    (
                        abs(limit[0] - values[-1]),
                        limit[0],
                        f"Richardson's extrapolation of {element or 'the runs'}, tolerance {tolerance}, order {limit[1]:.1f}",
                        None,
                    )
                )
        last = min((chain[-1] for _, chain in own), key=lambda row: (-row["step"], looseness(row)))
        change = abs(values[-1] - values[-2]) if len(values) > 1 else math.inf
        finest.append(
            (
                change,
                -last["unknowns"],
                last["values"][quantity],
                "finest run: "
                + ", ".join(filter(None, [element, f"mesh {last['mesh']}", f"tolerance {last['tolerance']}"]))
                + "; errors near it are too small",
                last,
            )
        )
    if extrapolated:
        return min(extrapolated, key=lambda item: item[0])[1:]
    return min(finest, key=lambda item: item[:2])[2:] if finest else None


def relative(value, wanted):
    return abs(value - wanted) / abs(wanted) if wanted else abs(value)


def order(coarse, fine, dimension):
    """Exponent of the error against the size of cells."""
    if not coarse or not fine or coarse[1] <= 0 or fine[1] <= 0 or coarse[0]["unknowns"] == fine[0]["unknowns"]:
        return None
    return math.log(coarse[1] / fine[1]) / math.log(size(coarse[0], dimension) / size(fine[0], dimension))


def measure(rows, quantities, exact, dimension):
    """Fills in errors, algebraic and orders; returns {quantity: (value, where it comes from)}."""
    references = {}
    for row in rows:
        row.update(errors={}, algebraic={}, orders={})
    for quantity in quantities:
        found = (0.0, None, None) if is_error(quantity) else reference(rows, quantity, exact, dimension)
        if found is None:
            continue
        references[quantity] = found[:2]
        for row in rows:
            if usable(row, quantity) and row is not found[2]:
                row["errors"][quantity] = relative(row["values"][quantity], found[0])
        for chain in series(rows, quantity).values():
            for coarse, fine in zip(chain, chain[1:]):
                pair = [(row, row["errors"][quantity]) if quantity in row["errors"] else None for row in (coarse, fine)]
                value = order(*pair, dimension)
                if value is not None:
                    fine["orders"][quantity] = value
        if not is_error(quantity):
            algebraic(rows, quantity)
    return references


def algebraic(rows, quantity):
    """Change from the tightest run of the same program, element and mesh."""
    groups = {}
    for row in rows:
        if usable(row, quantity) and row["tolerance"]:
            groups.setdefault((row["program"], row["element"], row["step"]), []).append(row)
    for group in groups.values():
        tightest = min(group, key=looseness)
        for row in group:
            if row is not tightest:
                row["algebraic"][quantity] = relative(row["values"][quantity], tightest["values"][quantity])


def seconds_at(rows, quantity, wanted):
    """CPU seconds of a chain of runs at which its error falls to `wanted`: log-log interpolation between the two runs around it; None outside."""
    points = sorted((row["cpu"], row["errors"][quantity]) for row in rows if row["errors"].get(quantity))
    for (t0, e0), (t1, e1) in zip(points, points[1:]):
        if e0 >= wanted >= e1 and e0 > e1:
            return t0 * (t1 / t0) ** (math.log(e0 / wanted) / math.log(e0 / e1))
    return None
