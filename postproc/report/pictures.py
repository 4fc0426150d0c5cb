"""Pictures of a run without a display: the whole, a section, each body and each contact, of the last state that was written."""
import io
import math
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import fields  # noqa: E402
from triangles import Surface, area, cut, outside  # noqa: E402

PACKAGES = "python3-vtk9 python3-matplotlib"
MOST_FACES = 2_000_000  # of all bodies: beyond these a picture takes minutes
MOST_BODIES = MOST_CONTACTS = 12  # with pictures of their own
MOST_BYTES = 3_500_000  # of all pictures, which the page holds as text, a third longer
WIDE, SMALL = (640, 496), (430, 333)  # pixels of what is drawn; lettering grows with them
BESIDE, ABOVE = 165, 34  # pixels of legend and title of the small ones
NO_PRESSURE = "It presses nowhere"
DIAGONAL = (1.0, -1.6, 1.1)  # towards the eye


class Painter:
    """Makes PNG files of surfaces; knows the whole model, to show where a part of it is."""

    def __init__(self, surfaces):
        self.surfaces = surfaces
        self.all_points = np.concatenate([s.points for s in surfaces])
        self.flat = bool(np.ptp(self.all_points[:, 2]) <= 1e-12 * max(np.ptp(self.all_points, axis=0).max(), 1e-300))
        self.direction = np.array((0.0, 0.0, 1.0) if self.flat else DIAGONAL)
        self.whole = None  # the locator, drawn once

    def draw(self, surfaces, field, label, title, size=WIDE, direction=None, locate=None, mark=None, shift=0, view=None, ends=None, edges=False):
        """A PNG file. `view` stands for size and direction, `ends` for those of the scale; `edges` draws those of cells."""
        import matplotlib

        matplotlib.use("Agg")
        import raster
        from matplotlib import pyplot

        direction = self.direction if direction is None else direction
        view = view or raster.View(direction, np.concatenate([s.points[np.unique(s.triangles)] for s in surfaces]), *size)
        buffer = raster.Buffer(view)
        lit = not self.flat and shift == 0
        first = 0
        for s in surfaces:
            numbers = s.cells if edges and s.cells is not None else np.zeros(len(s.triangles), dtype=int)
            buffer.draw(s.points, s.triangles, s.values(field), first + numbers, lit)
            first += int(numbers.max()) + 1
        values = np.concatenate([s.values(field)[np.unique(s.triangles)] for s in surfaces])
        least, most = float(values.min()), float(values.max())
        top = float(np.percentile(values, 99.8))  # one node at an edge must not hide the rest
        if top <= least + 1e-9 * max(abs(least), abs(top)):
            top = most
        if most - least <= 1e-9 * max(abs(least), abs(most)):
            least, top = min(least, 0.0), max(most, 0.0)
        if ends is not None:
            least, top = ends
        scale = pyplot.Normalize(least, top if top > least else least + 1)
        palette = pyplot.get_cmap("viridis")
        picture = buffer.image(lambda v: palette(scale(v)))

        unit = size[0] / SMALL[0]
        width, height = size[0] / unit + BESIDE, size[1] / unit + ABOVE
        sheet = pyplot.figure(figsize=(width / 100, height / 100), dpi=100 * unit)
        box = lambda x, y, w, h: sheet.add_axes([x / width, y / height, w / width, h / height])
        sheet.text(8 / width, 1 - 22 / height, shorter(title, 60), fontsize=11, fontweight="bold")
        axes = box(0, 0, SMALL[0], height - ABOVE)
        axes.imshow(picture, extent=(0, size[0], 0, size[1]), interpolation="nearest", aspect="auto")
        axes.set_axis_off()
        self._tripod(box(SMALL[0] + 6, 2, 64, 64), view)
        if mark is not None:
            at = view.pixels(np.asarray([mark]))[0]
            axes.plot(*at, "o", markersize=11, markerfacecolor="none", markeredgecolor="#d1242f", markeredgewidth=1.6)
            axes.set_xlim(0, size[0])
            axes.set_ylim(0, size[1])
        legend = box(SMALL[0] + 22, 78, 17, height - ABOVE - 78 - (8 if locate is None else 122))
        beyond = "max" if top < most else "neither"
        colours = sheet.colorbar(pyplot.cm.ScalarMappable(scale, palette), cax=legend, extend=beyond, format="%.4g")
        colours.set_label(label)
        colours.ax.tick_params(labelsize=9)
        if locate is not None:
            where = box(SMALL[0] + 8, height - ABOVE - 106, 150, 112)
            where.imshow(self._locator(locate))
            where.set_axis_off()
        out = io.BytesIO()
        sheet.savefig(out, format="png")
        pyplot.close(sheet)
        return out.getvalue()

    @staticmethod
    def _tripod(axes, view):
        for unit, name in zip(np.eye(3), "xyz"):
            arrow = np.array([unit @ view.right, unit @ view.up])
            if np.linalg.norm(arrow) < 0.1:
                continue
            axes.plot([0, arrow[0]], [0, arrow[1]], color="#57606a", linewidth=1.2)
            axes.text(*((1 + 0.4 / np.linalg.norm(arrow)) * arrow), name, fontsize=8, color="#57606a", ha="center", va="center")
        axes.set_xlim(-1.6, 1.6)
        axes.set_ylim(-1.6, 1.6)
        axes.set_axis_off()

    def _locator(self, surface):
        """The model in grey, with a surface of it in blue, also where others hide it."""
        import raster

        view = raster.View(self.direction, self.all_points, 150, 112)
        if self.whole is None:
            buffer = raster.Buffer(view)
            for number, s in enumerate(self.surfaces):
                buffer.draw(s.points, s.triangles, np.zeros(len(s.points)), number, not self.flat)
            self.whole = buffer.image(lambda v: np.full((len(v), 3), 0.86))
        part = raster.Buffer(view)
        part.draw(surface.points, surface.triangles, np.zeros(len(surface.points)), 0, False)
        covered = part.mask()[:, :, None]
        return self.whole * (1 - covered) + np.array([0.12, 0.44, 0.92]) * covered


def shorter(words, length):
    return words if len(words) <= length else words[: length - 1] + "…"


def figures(x):
    return f"{x:.4g}"


def largest(values, none=""):
    if none and values.max() <= 0:
        return none
    return f"Largest at a node {figures(float(values.max()))}"


def section(painter, blocks, surfaces):
    """A plane across an axis through the place of the largest stress: the axis whose plane cuts most bodies, then most area."""
    field = "von_mises"
    known = [s for s in surfaces if field in s.arrays]
    points = painter.all_points
    low, high = points.min(axis=0), points.max(axis=0)
    size = high - low
    place, why, body = (low + high) / 2, "through the middle", None
    if known:
        body = max(known, key=lambda s: s.values(field).max())
        place, why = body.points[np.argmax(body.values(field))], f"at the place of the largest von Mises stress (ring), in {body.name}"
    label, wanted = ("von Mises stress", field) if known else ("displacement", "displacement")
    found = []
    for axis in range(3):
        at = place.copy()
        if body is not None:  # the outer face of a body shows nothing: a little inside
            least, most = body.points[:, axis].min(), body.points[:, axis].max()
            at[axis] = np.clip(at[axis], least + 0.01 * (most - least), most - 0.01 * (most - least))
        at[axis] += 1.23e-7 * size.max()  # not along faces of the mesh
        parts = [cut(name, grid, at, np.eye(3)[axis]) for name, grid in blocks]
        parts = [p for p in parts if p is not None and wanted in p.arrays]
        if parts:
            found.append((len(parts), sum(area(p) for p in parts), axis, at, parts))
    if not found:
        return None
    _, _, axis, at, parts = max(found, key=lambda f: f[:2])
    direction = np.array(((1.0, 0, 0), (0, -1.0, 0), (0, 0, 1.0))[axis])
    title = f"Section at {'xyz'[axis]} = {figures(at[axis])}: {label}"
    caption = f"{len(parts)} {'body is' if len(parts) == 1 else 'bodies are'} cut, {why}."
    return painter.draw(parts, wanted, label, title, direction=direction, mark=place if body is not None else None, shift=1), caption


def pressed_part(surface, values):
    """The faces about the part of a contact that presses, and the direction from which they are seen; all of them if that is most."""
    p = surface.points[surface.triangles]
    normals = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    load = np.maximum(values[surface.triangles].mean(axis=1), 0)
    towards = (normals * load[:, None]).sum(axis=0)
    weight = (np.linalg.norm(normals, axis=1) * load).sum()
    if weight == 0:
        towards, weight = normals.sum(axis=0), np.linalg.norm(normals, axis=1).sum()
    direction = np.array(DIAGONAL) if np.linalg.norm(towards) < 0.2 * weight else towards / np.linalg.norm(towards)
    direction = direction + 0.35 * np.cross(direction, [0.35, 0.93, 0.12])  # a little from the side, so that depth is seen
    if values.max() <= 0:
        return surface, direction, False
    pressed = surface.points[values > 0.01 * values.max()]
    low, high = pressed.min(axis=0), pressed.max(axis=0)
    margin = 0.3 * (high - low).max()
    inside = ((p > low - margin) & (p < high + margin)).all(axis=2).any(axis=1)
    if inside.mean() > 0.7 or not inside.any():
        return surface, direction, False
    return Surface(surface.name, surface.points, surface.triangles[inside], surface.arrays), direction, True


def curves(grid):
    """The lines of a contact of a plane model: for each piece the length along it, and its points' numbers, in order."""
    from vtk.util.numpy_support import vtk_to_numpy

    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    same = np.unique((points / max(np.abs(points).max(), 1e-300)).round(12), axis=0, return_inverse=True)[1].ravel()  # ranks have points of their own
    first = np.unique(same, return_index=True)[1]
    near = {}
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        ids = [int(first[same[cell.GetPointId(i)]]) for i in range(cell.GetNumberOfPoints())]
        if cell.GetCellDimension() != 1:
            continue
        if len(ids) == 3:
            ids = [ids[0], ids[2], ids[1]]
        for a, b in zip(ids, ids[1:]):
            near.setdefault(a, []).append(b)
            near.setdefault(b, []).append(a)
    left, found = set(near), []
    while left:
        start = min((n for n in left if len(near[n]) == 1), default=None)
        if start is None:  # closed lines
            start = min(left)
        line = [start]
        left.discard(start)
        while (following := next((n for n in near[line[-1]] if n in left), None)) is not None:
            line.append(following)
            left.discard(following)
        if len(near[start]) > 1 and start in near[line[-1]]:
            line.append(start)
        steps = np.linalg.norm(np.diff(points[line], axis=0), axis=1)
        found.append((np.concatenate([[0.0], np.cumsum(steps)]), np.array(line)))
    return points, found


def turned(points, length, line, values):
    """A closed line from its least pressure on, so that no peak is cut in two."""
    if line[0] != line[-1]:
        return length, line
    line = np.roll(line[:-1], -int(np.argmin(values[line[:-1]])))
    line = np.append(line, line[0])
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points[line], axis=0), axis=1))]), line


def along(name, grid, field):
    """The pressure over the length of a contact of a plane model."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot
    from vtk.util.numpy_support import vtk_to_numpy

    values = vtk_to_numpy(grid.GetPointData().GetArray(field))
    points, lines = curves(grid)
    lines = [turned(points, *line, values) for line in lines]
    pressed = [line for line in lines if values[line[1]].max() > 0] or lines[:1]
    width, height = SMALL[0] + BESIDE, SMALL[1] + ABOVE
    sheet = pyplot.figure(figsize=(width / 100, height / 100), dpi=100, layout="constrained")
    axes = sheet.subplots()
    ends = []
    for length, line in pressed[:8]:
        first = points[line[0]]
        words = f"from ({figures(first[0])}, {figures(first[1])})"
        axes.plot(length, values[line], marker="." if len(line) < 120 else None, linewidth=1.3, label=words)
        over = length[values[line] > 0]
        if len(over):
            beside = 0.5 * (over[-1] - over[0]) + 2 * length[-1] / max(len(length) - 1, 1)
            ends.append((max(over[0] - beside, 0), min(over[-1] + beside, length[-1])))
    if ends:
        axes.set_xlim(min(e[0] for e in ends), max(e[1] for e in ends))
    least, most = min(0.0, float(values.min())), float(values.max())
    axes.set_ylim(1.08 * least, least + 1.08 * (most - least) if most > least else 1.0)
    axes.set_xlabel("length along the contact" + ("" if len(pressed) > 1 else f" {words}"))
    axes.set_ylabel("contact pressure")
    axes.set_title(shorter(f"{name}: contact pressure", 52), fontsize=11, fontweight="bold", loc="left")
    axes.grid(color="#e3e7eb")
    if len(pressed) > 1:
        sheet.legend(fontsize=8, loc="outside lower center", ncols=min(len(pressed), 3))
    out = io.BytesIO()
    sheet.savefig(out, format="png")
    pyplot.close(sheet)
    more = f" {len(pressed)} lines press, 8 are drawn." if len(pressed) > 8 else ""
    return out.getvalue(), f"{largest(values, NO_PRESSURE)}.{more}"


def chosen(blocks, most, size, what):
    """The blocks of the largest sizes, in their order, and a sentence if some are left out."""
    if len(blocks) <= most:
        return blocks, ""
    largest = sorted(range(len(blocks)), key=lambda i: -size(blocks[i]))[:most]
    return [blocks[i] for i in sorted(largest)], f"{most} of {len(blocks)} {what} have a picture here, those with the largest values."


class Gallery:
    """Groups of pictures up to a size in bytes."""

    def __init__(self):
        self.groups, self.bytes, self.left_out = [], 0, 0

    def group(self, title, words=""):
        self.groups.append((title, words, []))

    def full(self):
        return self.bytes > MOST_BYTES

    def add(self, make):
        if self.full():
            self.left_out += 1
            return
        made = make()
        if made is not None:
            self.groups[-1][2].append(made)
            self.bytes += len(made[0])


def pressure_of(grid, field):
    from vtk.util.numpy_support import vtk_to_numpy

    found = grid.GetPointData().GetArray(field)
    return -math.inf if found is None or found.GetNumberOfTuples() == 0 else float(vtk_to_numpy(found).max())


def of_run(directory, contact_names=(), body_names=()):
    """Groups of pictures, (title, words, [(PNG bytes, caption)]), and why some or all are missing, or ''."""
    try:
        import matplotlib  # noqa: F401
        import vtk  # noqa: F401
    except ImportError as missing:
        return [], f"No pictures: {missing}. Install {PACKAGES}, or run ./mortise report, which does."
    time, blocks = fields.load(directory, "solution", names=body_names)
    _, touching = fields.load(directory, "contact", names=contact_names)
    surfaces = [s for s in (outside(name, grid) for name, grid in blocks) if s is not None]
    if not surfaces:
        return [], "No pictures: the run left no fields (output.fields)."
    faces = sum(len(s.triangles) for s in surfaces)
    if faces > MOST_FACES:
        return [], f"No pictures: the surface has {faces} triangles, more than {MOST_FACES}; look at solution.pvd in ParaView."

    painter, gallery = Painter(surfaces), Gallery()
    states = len(fields.states(directory, "solution"))
    when = f"; the state at time {figures(time)}, the last of {states}" if states > 1 else ""
    gallery.group("The whole", f"Of the undeformed bodies{when}.")
    stress, moved = "von_mises", "displacement"
    for field, label in ((stress, "von Mises stress"), (moved, "displacement")):
        known = [s for s in surfaces if field in s.arrays]
        if known:
            worst = max(known, key=lambda s: s.values(field).max())
            gallery.add(lambda: (painter.draw(known, field, label, label[0].upper() + label[1:]),
                                 f"{largest(worst.values(field))}, in {worst.name}."))
    if not painter.flat:
        gallery.add(lambda: section(painter, blocks, surfaces))

    pressure = "contact_pressure_recovered"
    pressed = [(name, grid) for name, grid in touching if pressure_of(grid, pressure) > -math.inf]
    shown, words = chosen(pressed, MOST_CONTACTS, lambda b: pressure_of(b[1], pressure), "contacts")
    gallery.group("Contacts", words)
    for name, grid in shown:
        if painter.flat:
            gallery.add(lambda: along(name, grid, pressure))
            continue

        def contact():
            surface = outside(name, grid)
            if surface is None:
                return None
            part, direction, narrowed = pressed_part(surface, surface.values(pressure))
            zoomed = " The part that presses and what is about it." if narrowed else ""
            return (painter.draw([part], pressure, "contact pressure", f"{name}: contact pressure", SMALL, direction, locate=surface),
                    f"{largest(surface.values(pressure), NO_PRESSURE)}.{zoomed}")

        gallery.add(contact)

    field = stress if any(stress in s.arrays for s in surfaces) else moved
    label = "von Mises stress" if field == stress else moved
    known = [s for s in surfaces if field in s.arrays]
    if len(surfaces) > 1 and known:
        shown, words = chosen(known, MOST_BODIES, lambda s: s.values(field).max(), "bodies")
        gallery.group("Bodies", words)
        for s in shown:
            gallery.add(lambda: (painter.draw([s], field, label, f"{s.name}: {label}", SMALL, locate=s), f"{largest(s.values(field))}."))
    why = f"{gallery.left_out} more pictures would make this page too large; look at solution.pvd in ParaView." if gallery.left_out else ""
    return [g for g in gallery.groups if g[2]], why
