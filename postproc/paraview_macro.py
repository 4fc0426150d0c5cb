"""Opens a run of Mortise in ParaView as its report shows it: the whole, a section at the largest stress, and the contacts, side by side.

In ParaView: Macros > Import new macro..., this file; then open solution.pvd of a run and press the macro. Without a display
(Debian's ParaView ends by a signal with --force-offscreen-rendering alone; packages xvfb and xauth):

    xvfb-run -a pvpython paraview_macro.py OUT picture.png
"""
import json
import pathlib
import sys
import textwrap

import numpy as np
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

DIAGONAL = (1.0, -1.6, 1.1)  # towards the eye, as in the report
LETTERS, WIDTH = 11, 50  # points, and letters of a line
SINGLE_NODES = 99.8  # percentile at which the colours end: one node at an edge must not hide the rest


def directory():
    """That of the command line, or of the file that is open."""
    if len(sys.argv) > 1:
        return pathlib.Path(sys.argv[1])
    source = simple.GetActiveSource()
    while source is not None and not hasattr(source, "FileName"):
        source = getattr(source, "Input", None)
    if source is None:
        raise SystemExit("open solution.pvd of a run first, and select it in the pipeline browser")
    name = source.FileName
    return pathlib.Path(name if isinstance(name, str) else name[0]).parent


def values_of(source, field):
    """Of all points of all blocks."""
    data = simple.servermanager.Fetch(source)
    grids = [data]
    if data.IsA("vtkCompositeDataSet"):
        walk = data.NewIterator()
        grids = []
        walk.InitTraversal()
        while not walk.IsDoneWithTraversal():
            grids.append(walk.GetCurrentDataObject())
            walk.GoToNextItem()
    arrays = [grid.GetPointData().GetArray(field) for grid in grids]
    arrays = [vtk_to_numpy(a) for a in arrays if a is not None and a.GetNumberOfTuples()]
    return np.concatenate(arrays) if arrays else np.zeros(0)


def show(source, view, field, title):
    """`source` in the colours of a field of points; whether it has any."""
    values = values_of(source, field)
    if not values.size:
        return False
    least, most = float(values.min()), float(np.percentile(values, SINGLE_NODES))
    if most - least <= 1e-9 * max(abs(least), abs(most)):
        most = float(values.max())
    display = simple.Show(source, view)
    simple.ColorBy(display, ("POINTS", field), separate=True)
    colours = simple.GetColorTransferFunction(field, display, separate=True)
    colours.ApplyPreset("Viridis (matplotlib)", True)
    colours.RescaleTransferFunction(least, most if most > least else least + 1)
    legend = simple.GetScalarBar(colours, view)
    legend.Title, legend.ComponentTitle = field.replace("_", " "), ""
    legend.Visibility, legend.WindowLocation, legend.ScalarBarLength = 1, "Lower Center", 0.5
    legend.Orientation = "Horizontal"
    legend.TitleFontSize = legend.LabelFontSize = LETTERS
    lines = "\n".join(textwrap.fill(line, WIDTH) for line in title.split("\n"))
    text = simple.Show(simple.Text(registrationName=title, Text=lines), view)
    text.WindowLocation, text.FontSize, text.Justification = "Upper Left Corner", LETTERS, "Left"
    return True


def look(view, source, flat, direction=DIAGONAL):
    """From `direction`, with z upwards; at plane models from the front."""
    bounds = source.GetDataInformation().GetBounds()
    middle = np.array([(bounds[2 * i] + bounds[2 * i + 1]) / 2 for i in range(3)])
    towards = np.array((0.0, 0.0, 1.0) if flat else direction)
    view.CameraFocalPoint = middle
    view.CameraPosition = middle + towards
    view.CameraViewUp = (0, 1, 0) if flat or abs(towards[2]) > 0.9 * np.linalg.norm(towards) else (0, 0, 1)
    view.ResetCamera(True)
    view.GetActiveCamera().Zoom(0.8)  # room for title and legend


def section(solution, place):
    """A plane through `place` across the shortest extent of the model, and where it is seen from."""
    bounds = solution.GetDataInformation().GetBounds()
    extent = np.array([bounds[2 * i + 1] - bounds[2 * i] for i in range(3)])
    least = np.array([bounds[2 * i] for i in range(3)])
    inside = np.clip(place, least + 0.01 * extent, least + 0.99 * extent) + 1.23e-7 * extent.max()  # not along faces of the mesh
    axis = int(np.argmin(extent))
    plane = simple.Slice(registrationName="section", Input=solution, SliceType="Plane")
    plane.SliceType.Origin = inside
    plane.SliceType.Normal = np.eye(3)[axis]
    plane.UpdatePipeline()
    return plane, ((1.0, 0, 0), (0, -1.0, 0), (0, 0, 1.0))[axis]


def last_state(reader):
    times = list(reader.TimestepValues) if hasattr(reader, "TimestepValues") else []
    if times:
        simple.GetAnimationScene().AnimationTime = times[-1]
        reader.UpdatePipeline(times[-1])
    else:
        reader.UpdatePipeline()


def side_by_side(layout, views):
    """Halves have the numbers 2 n + 1 and 2 n + 2 of what n was."""
    place = 0
    for left, view in zip(range(len(views), 0, -1), views):
        if left > 1:
            layout.SplitHorizontal(place, 1 / left)
            layout.AssignView(2 * place + 1, view)
            place = 2 * place + 2
        else:
            layout.AssignView(place, view)


def open_run(out):
    """The views of a run, from left to right."""
    simple._DisableFirstRenderCameraReset()  # of ParaView's own traces
    summary = json.loads((out / "summary.json").read_text())
    solution = simple.PVDReader(registrationName="solution", FileName=str(out / "solution.pvd"))
    last_state(solution)
    bounds = solution.GetDataInformation().GetBounds()
    flat = bounds[5] - bounds[4] <= 1e-12 * max(bounds[1] - bounds[0], bounds[3] - bounds[2])
    layout = simple.CreateLayout(out.name)
    views = []

    def new_view():
        view = simple.CreateView("RenderView")
        views.append(view)
        return view

    verdict = "Solved." if summary["converged"] else f"NOT SOLVED, exit status {summary['exit_status']}: do not trust the fields."
    warned = f" {len(summary['warnings'])} warnings, see summary.json." if summary.get("warnings") else ""
    field = "von_mises"
    whole = new_view()
    show(solution, whole, field, f"{summary['title'] or out.name}\n{verdict}{warned}")
    look(whole, solution, flat)
    if not flat and summary.get("max_von_mises_place"):
        plane, direction = section(solution, np.array(summary["max_von_mises_place"]["coordinates"]))
        view = new_view()
        if show(plane, view, field, "Section at the largest stress"):
            look(view, plane, False, direction)
    if (out / "contact.pvd").exists():
        contacts = simple.PVDReader(registrationName="contacts", FileName=str(out / "contact.pvd"))
        last_state(contacts)
        view = new_view()
        if show(contacts, view, "contact_pressure_recovered", "Contact pressure"):
            look(view, contacts, flat)
    side_by_side(layout, views)
    simple.RenderAllViews()
    return layout


def main():
    layout = open_run(directory())
    if len(sys.argv) > 2:
        simple.SaveScreenshot(sys.argv[2], layout, ImageResolution=(1800, 700))


main()
