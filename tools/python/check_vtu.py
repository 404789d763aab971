#!/usr/bin/env python3
"""Reads .vtu files as meshio and as VTK do, and prints counts and names.

`check_vtu.py FILE...` (pip install meshio vtk). Exits 1 where a file cannot be read, where the two disagree, or where a
triangle has no named region or a line no named boundary.
"""

import sys

import meshio
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

TRIANGLE, LINE = 5, 3


def by_meshio(path):
    mesh = meshio.read(path)
    cells = [(block.type, data) for block, data in zip(mesh.cells, mesh.cell_data["region"], strict=True)]
    numbers = {"triangle": mesh.cell_data["region"], "line": mesh.cell_data["boundary"]}
    groups = {}
    for kind in numbers:
        picked = [numbers[kind][i] for i, (t, _) in enumerate(cells) if t == kind]
        groups[kind] = np.concatenate(picked) if picked else np.empty(0, int)
    curves = [(c, t) for (kind, _), c, t in zip(cells, mesh.cell_data["curve"], mesh.cell_data["t"]) if kind == "line"]
    return {
        "points": mesh.points,
        "triangles": groups["triangle"],
        "lines": groups["line"],
        "links": sum(int((c >= 0).sum()) for c, _ in curves),
        "fields": {name: np.asarray(values).ravel() for name, values in mesh.field_data.items()},
    }


def by_vtk(path):
    errors = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(errors)
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    if errors.GetOutput().strip():
        raise ValueError(errors.GetOutput().strip())
    grid = reader.GetOutput()
    types = np.array([grid.GetCellType(i) for i in range(grid.GetNumberOfCells())], int)
    cell = {name: vtk_to_numpy(grid.GetCellData().GetArray(name)) for name in ("region", "boundary", "curve", "t")}
    fields = grid.GetFieldData()
    return {
        "points": vtk_to_numpy(grid.GetPoints().GetData()),
        "triangles": cell["region"][types == TRIANGLE],
        "lines": cell["boundary"][types == LINE],
        "links": int((cell["curve"][types == LINE] >= 0).sum()),
        "fields": {
            fields.GetArrayName(i): vtk_to_numpy(fields.GetArray(i)).ravel() for i in range(fields.GetNumberOfArrays())
        },
    }


def names(fields, prefix):
    return {int(n): name.removeprefix(prefix) for name, ns in fields.items() if name.startswith(prefix) for n in ns}


def text(values):
    return bytes(values).decode() if values.dtype == np.uint8 else ", ".join(f"{v}" for v in values)


def check(path):
    one, other = by_meshio(path), by_vtk(path)
    faults = []
    for key in ("points", "triangles", "lines", "links"):
        if not np.array_equal(one[key], other[key]):
            faults.append(f"meshio and VTK disagree on {key}")
    # VTK does not keep a field array that is empty.
    filled = {name for name, values in one["fields"].items() if len(values)}
    if filled != {name for name, values in other["fields"].items() if len(values)}:
        faults.append("meshio and VTK disagree on the names of field arrays")
    elif any(not np.array_equal(one["fields"][name], other["fields"][name]) for name in filled):
        faults.append("meshio and VTK disagree on field arrays")
    print(f"{path}: {len(one['points'])} points, {len(one['triangles'])} triangles, {len(one['lines'])} lines")
    for kind, prefix in (("triangles", "region:"), ("lines", "boundary:")):
        known = names(other["fields"], prefix)
        for number in np.unique(other[kind]):
            if int(number) not in known:
                faults.append(f"{kind} of number {number} have no name")
        for number, name in sorted(known.items()):
            print(f"  {prefix[:-1]} {number} {name!r}: {int((other[kind] == number).sum())} {kind}")
    print(f"  {other['links']} lines know their curve, {len(other['fields'].get('ball_radius', []))} balls")
    for name, values in sorted(other["fields"].items()):
        if name.startswith("squinch:"):
            print(f"  {name.removeprefix('squinch:')} = {text(values)!r}")
    for fault in faults:
        print(f"  WRONG: {fault}")
    return not faults


def main(paths):
    if not paths:
        sys.exit(__doc__)
    good = True
    for path in paths:
        try:
            good = check(path) and good
        except Exception as error:  # whatever meshio raises, the next file is still checked
            print(f"{path}: WRONG: {error}")
            good = False
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main(sys.argv[1:])
