#!/usr/bin/env bash
# meshio 5.3.5 and an XDMF file with an Information element beside its grid.
#
# Common guess: Information, which XDMF allows in any element to hold what programs need, is passed over by a reader that has no use for it.
# Real behaviour: meshio counts every child of Domain as a grid. One Information element (a unit, the name of a program) makes it print "Only supports one grid
# right now" for a file that has one grid, and leave by SystemExit, so that `except Exception` around the call does not catch it.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet 'meshio==5.3.5' 'h5py==3.14.0'
cat > try.py <<'PY'
import meshio

FILE = """<?xml version="1.0"?>
<Xdmf Version="3.0"><Domain>%s<Grid Name="mesh" GridType="Uniform">
<Geometry GeometryType="XYZ"><DataItem DataType="Float" Dimensions="4 3" Format="XML" Precision="8">0 0 0 1 0 0 1 1 0 0 1 0</DataItem></Geometry>
<Topology TopologyType="Triangle" NumberOfElements="2"><DataItem DataType="Int" Dimensions="2 3" Format="XML" Precision="8">0 1 2 0 2 3</DataItem></Topology>
</Grid></Domain></Xdmf>
"""


def read(name, extra):
    with open(name, "w") as f:
        f.write(FILE % extra)
    try:
        return len(meshio.read(name).cells_dict["triangle"])
    except BaseException as error:
        return type(error).__name__


seen = [read("plain.xdmf", ""), read("told.xdmf", '<Information Name="unit" Value="mm"/>')]
print("without Information: %s triangles; with it: %s" % tuple(seen))
assert seen == [2, "SystemExit"], "meshio behaves otherwise now"
PY
venv/bin/python try.py
