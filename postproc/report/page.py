"""The page: what a run's summary.json, deck.yaml and history.csv hold, as HTML of its own."""
import base64
import math

from markup import largest, number, paragraph, percent, section, table, text, vector
from model import model

STYLE = """
body { font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; color: #1b1f24; max-width: 78em; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; margin-bottom: .2em; } h2 { font-size: 1.15em; margin-top: 2em; border-bottom: 1px solid #d5dae0; }
table { border-collapse: collapse; margin: .6em 0; } th, td { padding: .2em .8em .2em 0; text-align: left; vertical-align: top; }
th { font-weight: 600; color: #57606a; } td.n { text-align: right; font-variant-numeric: tabular-nums; } tr + tr td { border-top: 1px solid #eef1f4; }
.state { padding: .7em 1em; border-radius: 6px; font-weight: 600; } .good { background: #dff3e4; } .bad { background: #ffd9d6; }
.warning { background: #fff4cf; border-radius: 6px; padding: .5em 1em; margin: .5em 0; } .quiet { color: #57606a; }
figure { margin: 1em 0; } figure img, figure svg { max-width: 100%; height: auto; } figcaption { color: #57606a; font-size: .92em; }
h3 { font-size: 1em; margin: 1.4em 0 .2em; } .pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 34em), 1fr)); gap: 1em 1.5em; } .pictures figure { margin: 0; }
@media print { body { margin: 0; max-width: none; } details { display: block; } figure { break-inside: avoid; } h2 { break-after: avoid; } }
"""

ENDS = {
    0: ("good", "Solved to the tolerance."),
    1: ("bad", "Not solved: the command line, the deck or the mesh is wrong."),
    2: ("bad", "Not solved: the iteration did not converge. These numbers are no solution."),
    3: ("bad", "Not solved: no equilibrium exists. Something moves."),
    4: ("bad", "Not solved: the machine failed the run, or it was told to end."),
    None: ("bad", "Not finished: the run was still at work when this was written, or was stopped."),
}


def gallery(groups, missing):
    """Groups of pictures with headings; small ones stand beside each other."""
    parts = []
    for title, words, shown in groups:
        parts += [f"<h3>{text(title)}</h3>", paragraph(words), f'<div class="pictures">{"".join(figure(*of) for of in shown)}</div>']
    return section("Pictures", *parts, paragraph(missing))


def figure(png, caption):
    data = base64.b64encode(png).decode()
    return f'<figure><img alt="{text(caption)}" src="data:image/png;base64,{data}"><figcaption>{text(caption)}</figcaption></figure>'


def head(summary):
    kind, words = ENDS.get(summary.get("exit_status"), ENDS[None])
    if summary.get("exit_status") == 0 and not summary.get("converged"):
        kind, words = ENDS[None]
    parts = [f"<h1>{text(summary.get('title') or 'A run without a title')}</h1>", f'<p class="state {kind}">{text(words)}</p>']
    for w in summary.get("warnings", []):
        step = f"step {w['step']}: " if w.get("step") else ""
        parts.append(f'<p class="warning">{text(step + w["text"])}.<br><b>Cure:</b> {text(w["cure"])}</p>')
    for s in summary.get("stuck", []):
        parts.append(f'<p class="warning">Stuck in contact {text(s["contact"])}: {s["points"]} points, {text(s["states"])}, '
                     f"the worst at {vector(s['place'])}.</p>")
    return "".join(parts)


def place(at):
    return f"{at.get('body') or at.get('contact') or ''} {vector(at['coordinates'])}".strip() if at and at.get("coordinates") else ""


def value_of(probe):
    """Of an extreme its value; of a point what is there; of a path where it is written."""
    if "value" in probe:
        return number(probe["value"])
    if "displacement" in probe:
        along = f" along {probe['axes']}" if probe.get("axes") else ""
        return f"moves {vector(probe['displacement'])}{along}, von Mises {number(probe.get('von_mises'))}"
    return f"probe.{probe['name']}.csv"


def results(state, about):
    """`about`: the point of the moments of supports."""
    big = table(("", "value", "where"), [("largest von Mises stress", state.get("max_von_mises"), place(state.get("max_von_mises_place"))),
                                         ("largest displacement", state.get("max_displacement"), ""), ("strain energy", state.get("strain_energy"), "")])
    e = state.get("error_estimate", {})
    errors = paragraph(f"Estimated error in the energy norm: of the mesh {percent(e.get('discretization'))}, of the solver "
                       f"{percent(e.get('algebraic'))}. Stresses at single points may be off by more than the mesh's figure.")
    reactions = state.get("reactions", [])
    most = max((largest(r["force"]) for r in reactions), default=0)
    turn = max((largest(r["moment"]) for r in reactions if r.get("moment")), default=0)
    forces = table(("support", "force on the bodies", f"moment about {vector(about)}"),
                   [(r.get("name") or r["boundary"], vector(r["force"], most), vector(r["moment"], turn) if r.get("moment") else "") for r in reactions + total(reactions)])
    points = table(("coupling", "moves", "turns", "force on the boundary", "moment about the point", "supports' force", "supports' moment"),
                   [(c["name"], vector(c["displacement"], largest(c["rotation"])), vector(c["rotation"], largest(c["displacement"])),
                     *(vector(c[k], largest(c["force"] + c["moment"])) for k in ("force", "moment", "reaction_force", "reaction_moment")))
                    for c in state.get("couplings", [])])
    springs = table(("spring", "force (> 0 pulls)", "elongation"), [(s["name"], s["force"], s["elongation"]) for s in state.get("springs", [])])
    probes = table(("probe", "quantity", "value", "where"),
                   [(p["name"], " ".join(f"{k} {p[k]}" for k in ("largest", "smallest") if p.get(k)), value_of(p), place(p.get("place")))
                    for p in state.get("probes", [])])
    return big + errors + forces + points + springs + probes


def total(reactions):
    """All supports together: what balances the loads."""
    if len(reactions) < 2:
        return []
    add = lambda key: [None if any(r[key][c] is None for r in reactions) else sum(r[key][c] for r in reactions) for c in range(3)]
    return [{"boundary": "all together", "force": add("force"), "moment": add("moment") if all(r.get("moment") for r in reactions) else None}]


def rounded(gap):
    return 0 if gap is not None and abs(gap) < 1e-15 else gap


def contacts(state):
    rows = []
    for c in state.get("contacts", []):
        gap = c.get("initial_gap") or {}
        rows.append((c["name"], vector(c["force"]), c["max_recovered_pressure"], c["max_pressure"], c["area"], f"{c['open']} / {c['stick']} / {c['slip']}",
                     f"{number(rounded(gap.get('smallest')))} ({number(gap.get('touching_area'))} touches)",
                     f"{number(c['preload']['force'])}, shortened {number(c['preload']['shortening'])}" if c.get("preload") else ""))
    return table(("contact", "force on the secondary side", "pressure", "at one node", "area", "open / stick / slip", "initial gap", "preload"), rows)


def steps(summary):
    rows = [(s["name"], s["time"], "yes" if s["converged"] else "NO", s["max_von_mises"], s["max_displacement"], s["hessian_multiplications"])
            for s in summary.get("steps", [])]
    return section("Load steps", table(("step", "time", "solved", "largest von Mises", "largest displacement", "products"), rows))


def history(rows):
    """The gradient of each product on a logarithmic scale, as SVG."""
    curve = []
    for row in rows:
        try:
            n, g = float(row["hessian_multiplications"]), float(row["projected_gradient"])
        except (KeyError, TypeError, ValueError):
            continue
        if g > 0 and math.isfinite(g):
            curve.append((n, math.log10(g)))
    if len(curve) < 2:
        return ""
    left, right = min(n for n, _ in curve), max(n for n, _ in curve)
    low, high = math.floor(min(g for _, g in curve)), math.ceil(max(g for _, g in curve))
    x = lambda n: 60 + 620 * (n - left) / max(right - left, 1)
    y = lambda g: 20 + 200 * (high - g) / max(high - low, 1)
    lines = "".join(f'<line x1="60" x2="680" y1="{y(g):.1f}" y2="{y(g):.1f}" stroke="#e3e7eb"/><text x="52" y="{y(g) + 4:.1f}" text-anchor="end" '
                    f'font-size="11">1e{g}</text>' for g in range(low, high + 1, max(1, (high - low) // 8)))
    points = " ".join(f"{x(n):.1f},{y(g):.1f}" for n, g in curve)
    return (f'<figure><svg viewBox="0 0 700 260" width="700">{lines}<polyline fill="none" stroke="#1f6feb" stroke-width="1.5" points="{points}"/>'
            f'<text x="370" y="248" text-anchor="middle" font-size="12">products with F ({left:.0f} to {right:.0f})</text></svg>'
            "<figcaption>Residual (projected gradient) of the solver</figcaption></figure>")


def solver(summary, rows):
    r = summary.get("residuals", {})
    return section("Solver", paragraph(f"{summary.get('algorithm', '')}: {summary.get('hessian_multiplications', 0)} products with F, "
                                       f"{summary.get('outer_iterations', 0)} outer iterations, {summary.get('friction_steps', 0)} friction steps; "
                                       f"{number(summary.get('time', {}).get('total'), 3)} s on {summary.get('ranks', 1)} ranks."),
                   table(("residual", "value"), [(k.replace("_", " "), v) for k, v in r.items()]), history(rows))


def page(summary, deck, rows, pictures, missing):
    """`pictures`: groups of pictures as pictures.of_run() gives them; `missing`: why some are not there, or ''."""
    solved = bool(summary.get("contacts") or summary.get("reactions") or summary.get("max_displacement"))
    parts = [head(summary)]
    if solved:
        states = summary.get("steps", [])
        when = f", load step {states[-1]['name']}, time {number(states[-1]['time'])}" if states else ""
        about = summary.get("moments_about", [0, 0, 0])
        parts += [section("Results" + when, results(summary, about)), section("Contacts" + when, contacts(summary)), steps(summary)]
    parts.append(gallery(pictures, missing))
    parts += [model(summary, deck), solver(summary, rows)]
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
            f"<title>{text(summary.get('title') or 'Mortise')}</title><style>{STYLE}</style></head><body>{''.join(parts)}"
            f'<p class="quiet">Mortise {text(summary.get("version", ""))}</p></body></html>\n')
