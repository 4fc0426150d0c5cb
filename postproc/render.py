#!/usr/bin/env python3
"""Renders the fields of a run to a PNG file, off screen.

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

import pyvista

import fields


def contact_names(directory):
    """Those of summary.json, in the order of the files."""
    try:
        return [c["name"] for c in json.loads((directory / "summary.json").read_text()).get("contacts", [])]
    except (OSError, ValueError):
        return []


def named(name, patterns):
    return any(fnmatch.fnmatchcase(name, p) for p in patterns)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("picture", type=pathlib.Path, nargs="?")
    parser.add_argument("--field", default=None)
    parser.add_argument("--warp", type=float, default=0.0)
    parser.add_argument("--view", default="iso", choices=["iso", "x", "y", "z", "-x", "-y", "-z"])
    parser.add_argument("--contact", action="store_true")
    parser.add_argument("--edges", action="store_true")
    parser.add_argument("--max", type=float, default=None)
    parser.add_argument("--focus", type=float, nargs=3, default=None)
    parser.add_argument("--zoom", type=float, default=1.2)
    parser.add_argument("--time", type=float, default=None)
    parser.add_argument("--sectors", type=int, default=1)
    parser.add_argument("--only", nargs="+", default=["*"], metavar="NAME")
    parser.add_argument("--hide", nargs="+", default=[], metavar="NAME")
    parser.add_argument("--cut", type=float, nargs=6, default=None, metavar=("X", "Y", "Z", "NX", "NY", "NZ"))
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()

    kind = "contact" if arguments.contact else "solution"
    _, blocks = fields.load(arguments.directory, kind, arguments.time, contact_names(arguments.directory) if arguments.contact else ())
    if not blocks:
        parser.error(f"{arguments.directory / kind}.pvd has no fields")
    names = [name for name, _ in blocks]
    if arguments.list:
        print("\n".join(names))
        return
    if arguments.picture is None:
        parser.error("which PNG file?")
    for pattern in arguments.only + arguments.hide:
        if not any(named(name, [pattern]) for name in names):
            parser.error(f"nothing is called {pattern}; there are {', '.join(names)}")
    shown = [grid for name, grid in blocks if named(name, arguments.only) and not named(name, arguments.hide)]
    if not shown:
        parser.error("nothing is left to show")
    mesh = pyvista.wrap(fields.merged(shown))
    field = arguments.field or ("contact_pressure_recovered" if arguments.contact else "von_mises")
    if field not in mesh.point_data:
        parser.error(f"there is no point field {field}; there are {', '.join(mesh.point_data.keys())}")
    if arguments.warp and "displacement" in mesh.point_data:
        mesh = mesh.warp_by_vector("displacement", factor=arguments.warp)

    if arguments.sectors > 1:  # the outer faces, which turn cheaply; vectors stay as they are
        face = mesh.extract_surface()
        mesh = pyvista.merge([face.rotate_z(360 * k / arguments.sectors) for k in range(arguments.sectors)], merge_points=False)

    if arguments.cut:
        mesh = mesh.clip(normal=arguments.cut[3:], origin=arguments.cut[:3])
        if mesh.n_cells == 0:
            parser.error("nothing is left on this side of the plane")

    plotter = pyvista.Plotter(off_screen=True, window_size=(1000, 750))
    limits = None if arguments.max is None else (0, arguments.max)
    plotter.add_mesh(mesh, scalars=field, cmap="viridis", show_edges=arguments.edges, clim=limits, line_width=0.5 if arguments.edges else None,
                     scalar_bar_args={"title": field.replace("_", " "), "title_font_size": 18, "label_font_size": 14, "fmt": "%.3g", "n_labels": 4,
                                      "position_x": 0.25, "position_y": 0.02, "height": 0.08})
    plotter.set_background("white")
    if arguments.view == "iso":
        plotter.view_isometric()
    else:
        getattr(plotter, {"x": "view_yz", "y": "view_xz", "z": "view_xy"}[arguments.view[-1]])(negative=arguments.view.startswith("-"))
    if arguments.focus:
        shift = [new - old for new, old in zip(arguments.focus, plotter.camera.focal_point)]
        plotter.camera.position = [p + d for p, d in zip(plotter.camera.position, shift)]
        plotter.camera.focal_point = arguments.focus
    plotter.camera.zoom(arguments.zoom)
    plotter.screenshot(str(arguments.picture))


if __name__ == "__main__":
    main()
