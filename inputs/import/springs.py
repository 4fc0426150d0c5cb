"""*SPRING of SPRINGA elements: springs between two nodes of solids, along the line between them."""


def read(model, bodies):
    """(springs by name as the deck has them, without their points' vectors: {points: node indices, bodies, stiffness}; elements and
    cards that are done). What has no counterpart is listed."""
    owner = {}
    for body in bodies.bodies:
        for i in body.elements:
            for n in model.elements[i].nodes:
                owner.setdefault(n, body.name)
    springs, done_elements, done_cards = {}, set(), set()
    for card in (c for c in model.cards if c.name == "SPRING"):
        rows = card.rows()
        if "NONLINEAR" in card.parameters or not rows:
            continue
        members = model.elements_of(card, card.line, card.need("ELSET"))
        if any(model.elements[i].type.upper() != "SPRINGA" for i in members):
            continue
        line, words = rows[-1]
        if len({w[0] for _, w in rows}) > 1:
            model.leave_out(card, "a stiffness that depends on temperature or frequency; the last one is taken, as in CalculiX")
        stiffness = card.value(words[0], line)
        done_cards.add(id(card))
        for i in members:
            element = model.elements[i]
            done_elements.add(i)
            ends = element.nodes
            if bodies.dimension == "axisymmetric":
                model.leave_out(card, f"the spring {element.number}: a point of an axisymmetric model of the deck is a ring")
            elif len(ends) != 2 or any(n not in owner for n in ends):
                model.leave_out(card, f"the spring {element.number}: its nodes are not both of solids; hold them by a `stiffness` of a support")
            elif not stiffness > 0 or model.points[ends[0]] == model.points[ends[1]]:
                model.leave_out(card, f"the spring {element.number} has no length, or no stiffness")
            else:
                springs[f"spring.{element.number}" if element.scope.name == "" else f"{element.scope.name}.spring.{element.number}"] = {
                    "points": ends, "bodies": [owner[n] for n in ends], "stiffness": stiffness}
    return springs, done_elements, done_cards
