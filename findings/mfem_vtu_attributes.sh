#!/usr/bin/env bash
# PyMFEM 4.10.0.1 (MFEM 4.10) and the attributes of a VTU mesh.
#
# Common guess: cell attributes come from the array that is named `material` or `attribute`, as they do from legacy VTK files.
# Real behaviour: the name of the array is never looked at. MFEM takes the first array of <CellData>, whatever it is called, and only where the XML
# attribute `Scalars` of <CellData> says "material" or "attribute". Without that every element has the attribute 1, with no word; with another
# array in front, the attributes are that array's values.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet 'mfem==4.10.0.1'
cat > try.py <<'PY'
import mfem.ser as mfem

FILE = """<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="4" NumberOfCells="2">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 0 2 3</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">3 6</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">5 5</DataArray></Cells>
<CellData%s>%s</CellData>
</Piece></UnstructuredGrid></VTKFile>
"""


def attributes(scalars, *arrays):
    data = "".join('<DataArray type="Int32" Name="%s" format="ascii">%d %d</DataArray>' % a for a in arrays)
    with open("mesh.vtu", "w") as f:
        f.write(FILE % (' Scalars="%s"' % scalars if scalars else "", data))
    mesh = mfem.Mesh("mesh.vtu")
    return [mesh.GetAttribute(i) for i in range(mesh.GetNE())]


seen = {
    "array material, no Scalars": attributes(None, ("material", 3, 7)),
    "array material, Scalars=material": attributes("material", ("material", 3, 7)),
    "array region, Scalars=region": attributes("region", ("region", 3, 7)),
    "arrays other and material, Scalars=material": attributes("material", ("other", 5, 6), ("material", 3, 7)),
}
for what, found in seen.items():
    print("%-45s %s" % (what, found))
assert list(seen.values()) == [[1, 1], [3, 7], [1, 1], [5, 6]], "MFEM behaves otherwise now"
PY
venv/bin/python try.py
