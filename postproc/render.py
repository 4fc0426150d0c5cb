#!/usr/bin/python3
"""Renders the fields of a run to a PNG file, without a display. Needs the packages of packages.txt beside it.

    render.py OUTPUT_DIRECTORY PICTURE.png [--field von_mises] [--warp 100] [--view=iso|x|y|z|-x|-y|-z] [--contact] [--edges] [--max VALUE]
        [--focus X Y Z] [--zoom 1.2] [--time 1.5] [--sectors 9] [--only 'roller*' ...] [--hide NAME ...] [--cut X Y Z NX NY NZ]

--contact shows the contact surfaces (fields contact_pressure, contact_pressure_recovered, gap, slip, contact_status) instead of the volume; --warp
multiplies the displacements; --max ends the colour scale, since peaks at edges and corners hide the rest; --time chooses a load step, the last if not
given; --sectors shows one of n equal sectors about z with all the others. --only and --hide choose bodies (with --contact: contacts) by name, with
wild cards; --list prints the names. --cut takes away what lies beyond the plane through a point with a normal, on the side to which that points.
"""
import argparse
import fnmatch
import json
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "report"))
import fields  # noqa: E402
import pictures  # noqa: E402
import raster  # noqa: E402
import triangles  # noqa: E402

# From which side the eye looks, of plane models with z towards it.
TOWARDS_THE_EYE = {"x": (1, 0, 0), "y": (0, -1, 0), "z": (0, 0, 1), "-x": (-1, 0, 0), "-y": (0, 1, 0), "-z": (0, 0, -1)}


def arguments_of(parser):
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("picture", type=pathlib.Path, nargs="?")
    parser.add_argument("--field", default=None)
    parser.add_argument("--warp", type=float, default=0.0)
    parser.add_argument("--view", default="iso", choices=["iso", *TOWARDS_THE_EYE])
    parser.add_argument("--contact", action="store_true")
    parser.add_argument("--edges", action="store_true")
    parser.add_argument("--max", type=float, default=None)
    parser.add_argument("--focus", type=float, nargs=3, default=None)
    parser.add_argument("--zoom", type=float, default=1.0)
    parser.add_argument("--time", type=float, default=None)
    parser.add_argument("--sectors", type=int, default=1)
    parser.add_argument("--only", nargs="+", default=["*"], metavar="NAME")
    parser.add_argument("--hide", nargs="+", default=[], metavar="NAME")
    parser.add_argument("--cut", type=float, nargs=6, default=None, metavar=("X", "Y", "Z", "NX", "NY", "NZ"))
    parser.add_argument("--list", action="store_true")
    return parser.parse_args()


def names_of(directory, contacts):
    """Of the bodies or contacts, in the order of their numbers in the fields."""
    try:
        summary = json.loads((directory / "summary.json").read_text())
    except (OSError, ValueError):
        return []
    return [c["name"] for c in summary.get("contacts", [])] if contacts else summary.get("body_names", [])


def named(name, patterns):
    return any(fnmatch.fnmatchcase(name, p) for p in patterns)


def chosen(parser, arguments):
    """The blocks that are to be seen, and the state's time."""
    kind = "contact" if arguments.contact else "solution"
    time, blocks = fields.load(arguments.directory, kind, arguments.time, names_of(arguments.directory, arguments.contact))
    if not blocks:
        parser.error(f"{arguments.directory / kind}.pvd has no fields")
    names = [name for name, _ in blocks]
    if arguments.list:
        print("\n".join(names))
        sys.exit()
    if arguments.picture is None:
        parser.error("which PNG file?")
    for pattern in arguments.only + arguments.hide:
        if not any(named(name, [pattern]) for name in names):
            parser.error(f"nothing is called {pattern}; there are {', '.join(names)}")
    shown = [(name, grid) for name, grid in blocks if named(name, arguments.only) and not named(name, arguments.hide)]
    if not shown:
        parser.error("nothing is left to show")
    return time, shown


def copied(surface, sectors):
    """The sectors about z; vectors stay as they are."""
    for k in range(sectors):
        angle = 2 * np.pi * k / sectors
        turn = np.array([[np.cos(angle), np.sin(angle), 0], [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        yield triangles.Surface(surface.name, surface.points @ turn, surface.triangles, surface.arrays, surface.cells)


def surfaces_of(parser, arguments, blocks):
    if arguments.cut:  # what is behind the plane, and the section
        point, normal = arguments.cut[:3], arguments.cut[3:]
        behind = triangles.plane_of(point, normal)
        found = [part for name, grid in blocks for part in (triangles.outside(name, grid, behind), triangles.cut(name, grid, point, normal))]
    else:
        found = [triangles.outside(name, grid) for name, grid in blocks]
    found = [s for s in found if s is not None]
    if not found:
        lines = arguments.contact and not arguments.cut
        parser.error("contacts of plane models are lines, which ./mortise report plots" if lines else "nothing is left on this side of the plane")
    for surface in found:
        if arguments.warp and "displacement" in surface.arrays:
            surface.points = surface.points + arguments.warp * surface.arrays["displacement"]
    return [copy for surface in found for copy in copied(surface, arguments.sectors)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments = arguments_of(parser)
    try:
        import matplotlib  # noqa: F401
        import vtk  # noqa: F401
    except ImportError as missing:
        parser.error(f"{missing}; apt-get install {pictures.PACKAGES}")
    time, blocks = chosen(parser, arguments)
    surfaces = surfaces_of(parser, arguments, blocks)
    field = arguments.field or ("contact_pressure_recovered" if arguments.contact else "von_mises")
    if field not in surfaces[0].arrays:
        parser.error(f"there is no point field {field}; there are {', '.join(surfaces[0].arrays)}")

    painter = pictures.Painter(surfaces)
    direction = painter.direction if arguments.view == "iso" else TOWARDS_THE_EYE[arguments.view]
    view = raster.View(direction, painter.all_points, *pictures.WIDE)
    view.scale *= arguments.zoom
    if arguments.focus:
        view.middle = np.array(arguments.focus) @ np.stack([view.right, view.up], axis=1)
    label = title = "von Mises stress" if field == "von_mises" else field.replace("_", " ")
    if len(fields.states(arguments.directory, "contact" if arguments.contact else "solution")) > 1:
        title += f" at time {pictures.figures(time)}"
    if arguments.warp:
        title += f", displacements {pictures.figures(arguments.warp)} times"
    ends = None if arguments.max is None else (0, arguments.max)
    arguments.picture.write_bytes(painter.draw(surfaces, field, label, title, view=view, ends=ends, edges=arguments.edges))


if __name__ == "__main__":
    main()
