"""Pieces of HTML: tables, sections, numbers with four figures."""
import html
import math

MOST_ROWS = 20  # longer tables fold


def text(value):
    return html.escape(str(value))


def number(x, digits=4):
    """Four figures; what is not known is a dash."""
    if x is None or (isinstance(x, float) and not math.isfinite(x)):
        return "–"
    return f"{x:.{digits}g}"


def largest(x):
    return max((abs(c) for c in x if c is not None), default=0)


def vector(x, beside=0.0):
    """Components that are rounding beside the others, or beside a size, are 0."""
    size = max(largest(x), beside)
    return "(" + ", ".join(number(0 if c is not None and abs(c) < 1e-9 * size else c) for c in x) + ")"


def percent(x):
    return "not estimated" if x is None else f"about {100 * x:.2g} %"


def table(head, rows):
    if not rows:
        return ""
    cell = lambda c: f'<td class="n">{number(c)}</td>' if isinstance(c, (int, float)) or c is None else f"<td>{text(c)}</td>"
    body = "".join("<tr>" + "".join(cell(c) for c in row) + "</tr>" for row in rows)
    whole = f"<table><tr>{''.join(f'<th>{text(h)}</th>' for h in head)}</tr>{body}</table>"
    return whole if len(rows) <= MOST_ROWS else f"<details><summary>{len(rows)} rows</summary>{whole}</details>"


def section(title, *parts):
    parts = [p for p in parts if p]
    return f"<h2>{text(title)}</h2>" + "".join(parts) if parts else ""


def paragraph(words):
    return f"<p>{text(words)}</p>" if words else ""
