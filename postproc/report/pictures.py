"""Pictures of a run without a display: the surface, seen along a diagonal and painted from back to front."""
import io
import pathlib
import xml.etree.ElementTree

PACKAGES = "python3-vtk9 python3-matplotlib"
MOST_FACES = 400_000  # beyond these a picture takes minutes


def last_file(directory, name):
    """The file of the last state of a .pvd, or None."""
    collection = directory / f"{name}.pvd"
    if not collection.exists():
        return None
    sets = xml.etree.ElementTree.parse(collection).getroot().iter("DataSet")
    files = [directory / s.get("file") for s in sets]
    return files[-1] if files and files[-1].exists() else None


def surface(file):
    """Points, triangles and point fields of the outside of a .vtu or .pvtu file."""
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLPUnstructuredGridReader() if file.suffix == ".pvtu" else vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    outside = vtk.vtkDataSetSurfaceFilter()
    outside.SetNonlinearSubdivisionLevel(1)
    outside.SetInputConnection(reader.GetOutputPort())
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(outside.GetOutputPort())
    triangles.Update()
    data = triangles.GetOutput()
    if data.GetNumberOfPolys() == 0:
        return None
    fields = {data.GetPointData().GetArrayName(i): vtk_to_numpy(data.GetPointData().GetArray(i)) for i in range(data.GetPointData().GetNumberOfArrays())}
    return vtk_to_numpy(data.GetPoints().GetData()), vtk_to_numpy(data.GetPolys().GetData()).reshape(-1, 4)[:, 1:], fields


def paint(points, triangles, values, label):
    """PNG bytes of one field."""
    import matplotlib

    matplotlib.use("Agg")
    import numpy as np
    from matplotlib import pyplot
    from matplotlib.collections import PolyCollection

    flat = np.ptp(points[:, 2]) == 0
    view = np.array([0.0, 0.0, 1.0]) if flat else np.array([1.0, -1.6, 1.1]) / np.linalg.norm([1.0, -1.6, 1.1])
    right = np.array([1.0, 0.0, 0.0]) if flat else np.cross([0.0, 0.0, 1.0], view)
    right /= np.linalg.norm(right)
    up = np.cross(view, right)
    corners = points[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
    order = np.argsort(corners.mean(axis=1) @ view)
    seen = np.stack([corners @ right, corners @ up], axis=2)[order]
    field = values[triangles].mean(axis=1)[order]
    light = 1.0 if flat else (0.55 + 0.45 * np.abs(normal @ view) / length)[order][:, None]
    top = np.percentile(values, 99.8) if values.size else 1.0  # one node at an edge must not hide the rest
    scale = pyplot.Normalize(float(values.min()), float(max(top, values.min() + 1e-300)))
    colours = pyplot.get_cmap("viridis")(scale(field))
    colours[:, :3] *= light
    picture, axes = pyplot.subplots(figsize=(8.4, 5.4), layout="constrained")
    axes.add_collection(PolyCollection(seen, facecolors=colours, edgecolors=colours, linewidths=0.2, rasterized=True))
    axes.autoscale_view()
    axes.set_aspect("equal", anchor="W")
    axes.set_axis_off()
    picture.colorbar(pyplot.cm.ScalarMappable(scale, "viridis"), ax=axes, shrink=0.8, label=label, extend="max" if top < values.max() else "neither")
    out = io.BytesIO()
    picture.savefig(out, format="png", dpi=110)
    pyplot.close(picture)
    return out.getvalue()


def of_run(directory):
    """Pairs of PNG bytes and captions, and why there is none if so."""
    import numpy as np

    try:
        import matplotlib  # noqa: F401
        import vtk  # noqa: F401
    except ImportError as missing:
        return [], f"No pictures: {missing}. Install {PACKAGES}, or run ./mortise report, which does."
    wanted = {"solution": (("von_mises", "von Mises stress"), ("displacement", "displacement")),
              "contact": (("contact_pressure_recovered", "contact pressure"),)}
    found = []
    for name, fields in wanted.items():
        file = last_file(pathlib.Path(directory), name)
        drawn = surface(file) if file else None
        if drawn is None:
            continue
        points, triangles, arrays = drawn
        if len(triangles) > MOST_FACES:
            return found, f"No picture of {name}: its surface has {len(triangles)} triangles, more than {MOST_FACES}; look at {name}.pvd in ParaView."
        for field, label in fields:
            if field not in arrays:
                continue
            values = arrays[field] if arrays[field].ndim == 1 else np.linalg.norm(arrays[field], axis=1)
            found.append((paint(points, triangles, values, label), f"{label[0].upper() + label[1:]}, on the undeformed bodies; largest at a node {values.max():.4g}"))
    return found, "" if found else "No pictures: the run left no fields (output.fields)."
