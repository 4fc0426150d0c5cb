"""Surfaces of blocks as triangles, by VTK: their outside, or a cut through them."""
import numpy as np


class Surface:
    """Points, triangles and point fields of the outside of a block; which cells the triangles are of, if that is known."""

    def __init__(self, name, points, triangles, arrays, cells=None):
        self.name, self.points, self.triangles, self.arrays, self.cells = name, points, triangles, arrays, cells

    def values(self, field):
        found = self.arrays[field]
        return found if found.ndim == 1 else np.linalg.norm(found, axis=1)


def triangulated(name, source):
    """The triangles that a filter of polygons makes; None if there are none."""
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    triangles = vtk.vtkTriangleFilter()
    triangles.PassLinesOff()
    triangles.PassVertsOff()
    triangles.SetInputConnection(source.GetOutputPort())
    triangles.Update()
    data = triangles.GetOutput()
    if data.GetNumberOfPolys() == 0:
        return None
    of_points = data.GetPointData()
    arrays = {of_points.GetArrayName(i): vtk_to_numpy(of_points.GetArray(i)) for i in range(of_points.GetNumberOfArrays())}
    faces = vtk_to_numpy(data.GetPolys().GetData()).reshape(-1, 4)[:, 1:]
    cells = data.GetCellData().GetArray("vtkOriginalCellIds")
    return Surface(name, vtk_to_numpy(data.GetPoints().GetData()).astype(float), faces, arrays, None if cells is None else vtk_to_numpy(cells))


def plane_of(point, normal):
    import vtk

    plane = vtk.vtkPlane()
    plane.SetOrigin(*point)
    plane.SetNormal(*normal)
    return plane


def outside(name, grid, behind=None):
    """The outer faces; of those the part behind a vtkPlane, if one is given."""
    import vtk

    skin = vtk.vtkDataSetSurfaceFilter()
    skin.SetNonlinearSubdivisionLevel(1)
    skin.PassThroughCellIdsOn()
    skin.SetInputData(grid)
    if behind is None:
        return triangulated(name, skin)
    clip = vtk.vtkClipPolyData()
    clip.SetInputConnection(skin.GetOutputPort())
    clip.SetClipFunction(behind)
    clip.InsideOutOn()
    return triangulated(name, clip)


def cut(name, grid, point, normal):
    import vtk

    cutter = vtk.vtkCutter()
    cutter.SetCutFunction(plane_of(point, normal))
    cutter.SetInputData(grid)
    return triangulated(name, cutter)


def area(surface):
    p = surface.points[surface.triangles]
    return np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1).sum() / 2
