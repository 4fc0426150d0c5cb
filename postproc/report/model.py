"""What was solved: bodies, materials, contacts, supports, loads and load steps of a run's deck, as tables."""
from markup import number, paragraph, section, table

PLACES = ("boundary", "body", "coupling", "points")
HOLDS = ("displacement", "rotation", "stiffness")
LOADS = ("pressure", "traction", "force", "moment", "acceleration", "centrifugal", "temperature_change")
GAPS = ("interference", "adjust", "clearance", "preload", "cyclic")


def plain(value):
    """A value of the deck on one line."""
    if isinstance(value, dict):
        return ", ".join(f"{k.replace('_', ' ')} {plain(v)}" for k, v in value.items())
    if isinstance(value, list):
        return f"({', '.join(plain(v) for v in value)})"
    return str(value)


def what(entry, keys):
    return "; ".join(f"{k.replace('_', ' ')} {plain(entry[k])}" for k in keys if entry.get(k) not in (None, "", {}, []))


def where(entry):
    words = what(entry, PLACES)
    return words + (f", along {entry['axes']}" if entry.get("axes") else "")


def body(name, entry):
    made = entry.get("material") or plain(entry.get("volumes") or {})
    return name, made, entry.get("method", "finite_elements").replace("_", " "), entry.get("formulation", "")


def material(name, entry):
    if constants := entry.get("orthotropic"):
        return name, plain(constants.get("young_modulus")), what(constants, ("poisson_ratio", "shear_modulus", "axes")), *(
            plain(constants.get(k)) if constants.get(k) else entry.get(k) for k in ("density", "thermal_expansion"))
    return name, *(entry.get(k) for k in ("young_modulus", "poisson_ratio", "density", "thermal_expansion"))


def contact(entry):
    sides = "found by the program" if entry.get("auto") else f"{plain(entry.get('secondary'))} / {plain(entry.get('primary'))}"
    given = {k: v for k, v in entry.items() if k in GAPS and v not in (0, "0")}
    return entry.get("name", ""), sides, plain(entry.get("friction") or "none"), what(given, GAPS)


def step(index, entry):
    factors = ", ".join(f"{name} {number(float(x))}" for name, x in (entry.get("scale") or {}).items())
    return (entry.get("name") or str(index), factors, *(", ".join(entry.get(k) or []) for k in ("off", "on")), str(entry.get("increments", 1)))


def model(summary, deck):
    size = (f"Dimension {deck.get('dimension', 3)}; {summary.get('bodies', 0)} bodies, {summary.get('primal_unknowns', 0)} unknowns in "
            f"{summary.get('subdomains', 0)} subdomains, {summary.get('dual_unknowns', 0)} multipliers. Any consistent units: those of the deck.")
    named = lambda key: (deck.get(key) or {}).items()
    listed = lambda key: [entry for entry in deck.get(key) or [] if isinstance(entry, dict)]
    return section(
        "Model", paragraph(size),
        table(("body", "material", "method", "formulation"), [body(n, b or {}) for n, b in named("bodies")]),
        table(("material", "Young's modulus", "Poisson's ratio", "density", "thermal expansion"), [material(n, m) for n, m in named("materials")]),
        table(("contact", "secondary / primary side", "friction", "gap"), [contact(c) for c in listed("contacts")]),
        table(("coupling", "boundary", "kind", "point"), [(n, c["boundary"], c.get("kind", ""), plain(c["point"])) for n, c in named("couplings")]),
        table(("axes", "directions"), [(n, plain(a)) for n, a in named("axes")]),
        table(("spring", "stiffness"), [(n, s.get("stiffness")) for n, s in named("springs")]),
        table(("support", "on", "prescribes"), [(s.get("name", ""), where(s), what(s, HOLDS)) for s in listed("supports")]),
        table(("load", "on", "quantity"), [(l.get("name", ""), where(l), what(l, LOADS)) for l in listed("loads")]),
        table(("load step", "factors at its end", "off", "on", "increments"), [step(i, s) for i, s in enumerate(listed("steps"), 1)]))
