"""The fields that a run left, as blocks by name: the one place that knows how solution.pvd and contact.pvd are laid out."""
import pathlib
import xml.etree.ElementTree

INDEX = {"solution": ("body", "body"), "contact": ("contact", "contact")}  # the cell field that numbers the blocks, and what they are


def states(directory, name):
    """Pairs of time and file of a .pvd; none if there is no such file."""
    collection = pathlib.Path(directory) / f"{name}.pvd"
    if not collection.exists():
        return []
    sets = xml.etree.ElementTree.parse(collection).getroot().iter("DataSet")
    return [(float(s.get("timestep", 0)), collection.parent / s.get("file")) for s in sets]


def load(directory, name, time=None, names=()):
    """Time and blocks of one state, the last or that nearest to `time`: pairs of a name and a vtkUnstructuredGrid, one for each body or
    contact. (None, []) if there is none. Files without names take them from `names`, if these are as many as the blocks."""
    found = [(t, file) for t, file in states(directory, name) if file.exists()]
    if not found:
        return None, []
    at, file = found[-1] if time is None else min(found, key=lambda state: abs(state[0] - time))
    if file.suffix == ".vtm":
        return at, _of_multiblock(file)
    return at, _by_index(_read(file), *INDEX.get(name, ("body", "block")), names)


def _read(file):
    import vtk

    reader = vtk.vtkXMLPUnstructuredGridReader() if file.suffix == ".pvtu" else vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def _of_multiblock(file):
    """Grids of one name, the parts of several ranks, become one."""
    import vtk

    reader = vtk.vtkXMLMultiBlockDataReader()
    reader.SetFileName(str(file))
    reader.Update()
    parts = {}

    def walk(block, name):
        if isinstance(block, vtk.vtkUnstructuredGrid):
            if block.GetNumberOfCells():
                parts.setdefault(name, []).append(block)
        elif hasattr(block, "GetNumberOfBlocks"):
            for i in range(block.GetNumberOfBlocks()):
                own = block.GetMetaData(i).Get(vtk.vtkCompositeDataSet.NAME()) if block.HasMetaData(i) else None
                walk(block.GetBlock(i), own or name or f"block {i + 1}")
        elif hasattr(block, "GetNumberOfPieces"):
            for i in range(block.GetNumberOfPieces()):
                walk(block.GetPiece(i), name)

    walk(reader.GetOutput(), "")
    return [(name, grids[0] if len(grids) == 1 else merged(grids)) for name, grids in parts.items()]


def _by_index(grid, field, kind, names):
    import numpy as np
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    index = grid.GetCellData().GetArray(field)
    if grid.GetNumberOfCells() == 0:
        return []
    if index is None:
        return [(kind, grid)]
    present, inverse = np.unique(vtk_to_numpy(index).astype(int), return_inverse=True)
    known = list(names) if len(names) > present[-1] else [f"{kind} {i + 1}" for i in range(present[-1] + 1)]
    if len(present) == 1:
        return [(known[present[0]], grid)]
    blocks = []
    order = np.argsort(inverse, kind="stable")
    for value, cells in zip(present, np.split(order, np.cumsum(np.bincount(inverse))[:-1])):
        take = vtk.vtkExtractCells()
        take.SetInputData(grid)
        ids = vtk.vtkIdList()
        ids.SetNumberOfIds(len(cells))
        for i, cell in enumerate(cells):
            ids.SetId(i, int(cell))
        take.SetCellList(ids)
        take.Update()
        blocks.append((known[value], take.GetOutput()))
    return blocks


def merged(grids):
    import vtk

    append = vtk.vtkAppendFilter()
    for grid in grids:
        append.AddInputData(grid)
    append.Update()
    return append.GetOutput()
