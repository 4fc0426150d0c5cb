"""Materials and sections: what the elements are made of."""

import orthotropy

IGNORED = {"CONDUCTIVITY", "SPECIFICHEAT", "LATENTHEAT", "ELECTRICALCONDUCTIVITY", "DAMPING", "DEPVAR", "INELASTICHEATFRACTION"}
PROPERTIES = IGNORED | {"MATERIAL", "ELASTIC", "EXPANSION", "DENSITY"}
LEFT_OUT = {
    "PLASTIC": "the material stays elastic",
    "CYCLICHARDENING": "the material stays elastic",
    "CREEP": "the material does not creep",
    "HYPERELASTIC": "the deck has linear elasticity alone",
    "HYPERFOAM": "the deck has linear elasticity alone",
    "VISCOELASTIC": "the deck has linear elasticity alone",
    "USERMATERIAL": "the deck has linear elasticity alone",
    "MOHRCOULOMB": "the material stays elastic",
    "DRUCKERPRAGER": "the material stays elastic",
    "DEFORMATIONPLASTICITY": "the material stays elastic",
    "CASTIRONPLASTICITY": "the material stays elastic",
    "CONCRETEDAMAGEDPLASTICITY": "the material stays elastic",
    "HYPOELASTIC": "the deck has linear elasticity alone",
}
OTHER_SECTIONS = {
    "SHELLSECTION",
    "BEAMSECTION",
    "BEAMGENERALSECTION",
    "MEMBRANESECTION",
    "TRUSSSECTION",
    "SHELLGENERALSECTION",
    "SURFACESECTION",
    "COHESIVESECTION",
    "GASKETSECTION",
    "FLUIDSECTION",
    "CONNECTORSECTION",
    "SPRING",
    "DASHPOT",
    "MASS",
    "GAP",
    "ROTARYINERTIA",
    "FRAMESECTION",
    "EULERIANSECTION",
}


def read_materials(model):
    """Materials by name in capitals: {name, density, thermal_expansion} and {young_modulus, poisson_ratio} or {orthotropic}; cards that are
    done."""
    materials, current, done = {}, None, set()
    for card in model.cards:
        if card.name == "MATERIAL":
            if card.need("NAME").upper() in materials:
                raise card.error(f'the material "{card.get("NAME")}" is given twice')
            current = materials.setdefault(card.get("NAME").upper(), {"name": card.get("NAME"), "card": card})
            done.add(id(card))
        elif card.name in PROPERTIES | set(LEFT_OUT) and current is not None:
            done.add(id(card))
            read_property(model, card, current)
        elif card.name not in ("AMPLITUDE",):
            current = current if card.name in ("ORIENTATION",) else None
    for material in materials.values():
        orthotropy.finish(model, material)
    return materials, done


def read_property(model, card, material):
    if card.name in LEFT_OUT:
        model.leave_out(card, f'material "{material["name"]}": {LEFT_OUT[card.name]}')
        return
    if card.name in IGNORED:
        model.note(card, f'material "{material["name"]}": without influence on a static equilibrium at given temperatures')
        return
    kind = orthotropy.kind_of(card)
    if kind in {"ELASTIC": orthotropy.ELASTIC, "EXPANSION": orthotropy.EXPANSION}.get(card.name, ()):
        orthotropy.read(model, card, material)
        return
    rows = [[card.value(w, line, 0.0) for w in words] for line, words in card.rows() if words]
    if not rows:
        raise card.error("expected a line with values")
    if not (kind in ("ISO", "ISOTROPIC") or card.name == "DENSITY"):
        model.leave_out(card, f'material "{material["name"]}": TYPE={kind}; isotropic and orthotropic constants alone are translated')
        return
    constants = {"ELASTIC": 2, "EXPANSION": 1, "DENSITY": 1}[card.name]
    values = [row[:constants] for row in rows]
    if any(v != values[0] for v in values):
        model.leave_out(card, f'material "{material["name"]}": values that depend on temperature; the first line is taken')
    if len(values[0]) < constants:
        raise card.error("expected Young's modulus and Poisson's ratio")
    if card.name == "ELASTIC":
        material["young_modulus"], material["poisson_ratio"] = values[0]
    else:
        material["density" if card.name == "DENSITY" else "thermal_expansion"] = values[0][0]


def read_sections(model, materials):
    """Element -> (material, name of the section's set), and element -> thickness where one is given."""
    of, thickness, used = {}, {}, set()
    for card, scope in [s for own in (model.assembly, *model.instances.values()) for s in own.sections]:
        name, material = card.need("ELSET"), card.need("MATERIAL").upper()
        if material not in materials:
            raise card.error(f'there is no *MATERIAL "{card.get("MATERIAL")}"')
        if not {"young_modulus", "orthotropic"} & materials[material].keys():
            raise card.error(f'the material "{card.get("MATERIAL")}" has no linear *ELASTIC: there is nothing to solve it with')
        material = orthotropy.of_section(model, card, scope, materials, material)
        used.add(material)
        rows = card.rows()
        t = card.value(rows[0][1][0], rows[0][0], 1.0) if rows and rows[0][1] else 1.0
        for e in model.elements_of(card, card.line, name, scope):
            of[e] = (material, name)
            thickness[e] = t or 1.0
    return of, thickness, used
