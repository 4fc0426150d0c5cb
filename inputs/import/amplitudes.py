"""*AMPLITUDE: factors of loads over the time of a step, or over that of all steps."""


class Amplitudes:
    def __init__(self, cards):
        self.tables = {}
        for card in cards:
            if card.name != "AMPLITUDE":
                continue
            words = [(line, w) for line, row in card.rows() for w in row]
            values = [card.value(w, line) for line, w in words]
            form = card.get("DEFINITION", "TABULAR").upper().replace(" ", "")
            relative = card.get("VALUE", "RELATIVE").upper() != "ABSOLUTE"
            known = form in ("TABULAR", "SMOOTHSTEP") and len(values) % 2 == 0 and values and relative
            table = sorted(zip(values[::2], values[1::2]), key=lambda p: p[0]) if known else None
            shift, rise = (card.value(card.get(key) or "0", card.line) for key in ("SHIFTX", "SHIFTY"))
            self.tables[card.need("NAME").upper()] = (
                table and [(t + shift, v + rise) for t, v in table],
                card.get("TIME").upper().replace(" ", "") == "TOTALTIME",
                form == "SMOOTHSTEP",
            )

    def in_total_time(self, card):
        """Whether the amplitude of a load goes on in the steps after it."""
        return self.tables.get(card.get("AMPLITUDE").upper(), (None, False))[1]

    def of(self, card, begin, end):
        """(factors at the start and the end of a step, whether it runs straight between them), or None where it is no table of factors."""
        name = card.get("AMPLITUDE").upper()
        if name not in self.tables:
            raise card.error(f'there is no *AMPLITUDE "{card.get("AMPLITUDE")}"')
        table, total, smooth = self.tables[name]
        if table is None:
            return None
        first, last = (begin, end) if total else (0.0, end - begin)

        def at(t):
            if t <= table[0][0]:
                return table[0][1]
            for (t0, v0), (t1, v1) in zip(table, table[1:]):
                if t <= t1:
                    part = 1.0 if t1 == t0 else (t - t0) / (t1 - t0)
                    return v0 + (v1 - v0) * (part**3 * (10 - 15 * part + 6 * part**2) if smooth else part)
            return table[-1][1]

        start, stop = at(first), at(last)
        inside = [(t, v) for t, v in table if first < t < last]
        straight = all(
            abs(v - (start + (stop - start) * (t - first) / (last - first))) <= 1e-6 * max(map(abs, (start, stop, v, 1e-300)))
            for t, v in inside
        )
        return start, stop, straight and not smooth
