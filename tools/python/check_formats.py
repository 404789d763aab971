#!/usr/bin/env python3
"""Writes meshes in every format and reads them as other people's programs do: meshio, gmsh and the Khronos glTF validator.

`check_formats.py SQUINCH VALIDATOR WORK DRAWING...` with the program, the folder of the npm package gltf-validator (`-`: none),
a folder to write in, and drawings to mesh (pip install meshio h5py gmsh). Exits 1 where a program refuses a file, or finds other names,
other numbers of cells under a name or other coordinates than the report and the VTU file have.
"""

import json
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import meshio
import numpy as np

try:
    import gmsh
except OSError as error:  # its wheel needs libGLU and other libraries of a desktop
    print(f"SKIPPED: gmsh cannot be loaded here: {error}")
    gmsh = None

SUFFIXES = {"vtk": "vtk", "msh": "msh", "msh22": "22.msh", "su2": "su2", "inp": "inp", "xdmf": "xdmf",
            "triangle": "node", "glb": "glb", "gltf": "gltf", "obj": "obj", "stl": "stl"}

VALIDATE = """
const fs = require('fs'), [folder, ...files] = process.argv.slice(1), validator = require(folder);
(async () => { for (const file of files) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { maxIssues: 20 });
  console.log(JSON.stringify({ file, ...report.issues }));
} })();
"""


def write(squinch, drawing, stem):
    """All formats of one mesh, and what the report says of it: cells by region, edges by boundary."""
    vtu, report = stem.with_suffix(".vtu"), stem.with_suffix(".json")
    subprocess.run([squinch, "mesh", drawing, "-o", vtu, "--report", report, "--quiet"], check=True)
    files = {"vtu": vtu}
    for name, suffix in SUFFIXES.items():
        files[name] = Path(f"{stem}.{suffix}")
        subprocess.run([squinch, "convert", vtu, files[name], "--format", name, "--quiet"], check=True)
        if name not in ("glb", "gltf", "xdmf"):
            back = files[name].with_suffix(".ele") if name == "triangle" else files[name]
            subprocess.run([squinch, "convert", back, stem.with_suffix(f".{name}.vtu"), "--quiet"], check=True)
    mesh = json.loads(report.read_text())["mesh"]
    regions = {group["name"]: group["cells"] for group in mesh["regions"]}
    boundaries = {group["name"]: group["edges"] for group in mesh["boundaries"]}
    return files, regions, boundaries


def by_number(mesh, array, kind):
    """How many cells of a kind each number has."""
    picked = [data for block, data in zip(mesh.cells, mesh.cell_data[array], strict=True) if block.type == kind]
    numbers, counts = np.unique(np.concatenate(picked), return_counts=True)
    return {int(number): int(count) for number, count in zip(numbers, counts)}


def by_name(mesh, dimension, kind):
    """How many cells of a kind each physical group of an MSH file has."""
    names = {number: name for name, (number, of) in mesh.field_data.items() if of == dimension}
    return {names[number]: count for number, count in by_number(mesh, "gmsh:physical", kind).items()}


def by_gmsh(path):
    """Cells by name of each physical group, and coordinates, as gmsh opens the file."""
    gmsh.open(str(path))
    groups = []
    for dimension in (2, 1):
        cells = {}
        for _, tag in gmsh.model.getPhysicalGroups(dimension):
            entities = gmsh.model.getEntitiesForPhysicalGroup(dimension, tag)
            count = sum(len(tags) for e in entities for tags in gmsh.model.mesh.getElements(dimension, e)[1])
            cells[gmsh.model.getPhysicalName(dimension, tag)] = count
        groups.append(cells)
    tags, places, _ = gmsh.model.mesh.getNodes()
    places = places.reshape(-1, 3)[np.argsort(tags)]
    assert len(gmsh.model.mesh.getDuplicateNodes()) == 0, "gmsh finds nodes twice"
    return groups, places


def xdmf_grids(path):
    """Every grid of an XDMF file by its name, as meshio reads it: it takes files of one grid, so each is put in one of its own."""
    grids = {}
    for grid in ElementTree.parse(path).getroot().iter("Grid"):
        root = ElementTree.Element("Xdmf", Version="3.0")
        ElementTree.SubElement(root, "Domain").append(grid)
        alone = path.with_suffix(f".{grid.get('Name')}.xdmf")
        ElementTree.ElementTree(root).write(alone)
        grids[grid.get("Name")] = meshio.read(alone)
    return grids


def xdmf_names(path, kind):
    """Names by their numbers in an XDMF file."""
    found = (i for i in ElementTree.parse(path).getroot().iter("Information") if i.get("Name").startswith(kind + ":"))
    return {int(i.get("Value")): i.get("Name").partition(":")[2] for i in found}


def in_order(points):
    return points[np.lexsort(points.T)]


def check(files, regions, boundaries, expect):
    points = meshio.read(files["vtu"]).points
    for name in ("msh", "msh22"):
        mesh = meshio.read(files[name])
        expect(f"meshio {name}", [by_name(mesh, 2, "triangle"), by_name(mesh, 1, "line")], [regions, boundaries])
        # meshio keeps the order of the file, which in 4.1 goes by entity.
        expect(f"meshio {name} points", np.array_equal(in_order(mesh.points), in_order(points)), True)
        if gmsh:
            groups, places = by_gmsh(files[name])
            expect(f"gmsh {name}", groups, [regions, boundaries])
            expect(f"gmsh {name} points", np.array_equal(places, points), True)
    mesh = meshio.read(files["vtk"])
    expect("meshio vtk points", np.array_equal(mesh.points, points), True)
    for array, kind, groups in (("region", "triangle", regions), ("boundary", "line", boundaries)):
        expect(f"meshio vtk {array}", sorted(by_number(mesh, array, kind).values()), sorted(groups.values()))
    mesh = meshio.read(files["inp"])
    expect("meshio inp points", np.allclose(mesh.points, points, rtol=1e-12, atol=0), True)
    def legal(groups):
        return {name.replace(" ", "_"): count for name, count in groups.items()}

    cells = {name: sum(map(len, sets)) for name, sets in mesh.cell_sets.items() if name in legal(regions)}
    expect("meshio inp regions", cells, legal(regions))
    expect("meshio inp boundaries", sorted(mesh.point_sets), sorted(legal(boundaries)))
    grids = xdmf_grids(files["xdmf"])
    for grid, array, kind, groups in (("mesh", "region", "triangle", regions), ("boundaries", "boundary", "line", boundaries)):
        names = xdmf_names(files["xdmf"], array)
        found = {names[number]: count for number, count in by_number(grids[grid], array, kind).items()}
        expect(f"meshio xdmf {array}", found, groups)
        expect(f"meshio xdmf {grid} points", np.array_equal(grids[grid].points, points[:, :2]), True)
    # Its tags are numbers: the names are not kept by it, their number and cells are; interfaces are in none.
    mesh = meshio.read(files["su2"])
    expect("meshio su2 points", np.array_equal(mesh.points, points[:, :2]), True)
    expect("meshio su2 triangles", sum(len(b.data) for b in mesh.cells if b.type == "triangle"), sum(regions.values()))
    corners = np.concatenate([block.data for block in mesh.cells if block.type == "triangle"])
    sides = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]))
    sides, uses = np.unique(sides, axis=0, return_counts=True)
    rim = sides[uses == 1]
    lines = np.sort(np.concatenate([block.data for block in mesh.cells if block.type == "line"]))
    expect("meshio su2 rim", np.array_equal(in_order(lines), in_order(rim)), True)
    mesh = meshio.read(files["stl"])
    expect("meshio stl", sum(len(block.data) for block in mesh.cells), sum(regions.values()))
    mesh = meshio.read(files["obj"])
    expect("meshio obj", sum(len(b.data) for b in mesh.cells if b.type == "triangle"), sum(regions.values()))


def check_second_order(squinch, files, regions, boundaries, expect):
    """gmsh's own files of second order, in all its forms, through squinch and back to meshio."""
    stem = files["msh"].with_suffix("")
    for version in (2.2, 4.1):
        for binary in (0, 1):
            gmsh.open(str(files["msh"]))
            gmsh.model.mesh.setOrder(2)
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", binary)
            second = Path(f"{stem}.second.msh")
            gmsh.write(str(second))
            points = in_order(meshio.read(second).points)
            for name in ("msh", "msh22", "vtk", "vtu"):
                file = Path(f"{stem}.second.{SUFFIXES.get(name, name)}")
                file = file.with_name("of_" + file.name)
                subprocess.run([squinch, "convert", second, file, "--format", name, "--quiet"], check=True)
                what = f"gmsh {version} {'binary' if binary else 'text'}, second order, to {name}"
                mesh = meshio.read(file)
                expect(f"{what}: points", np.allclose(in_order(mesh.points), points, rtol=1e-12, atol=1e-12), True)
                expect(what, {block.type for block in mesh.cells}, {"triangle6", "line3"})
                if name.startswith("msh"):
                    found = [by_name(mesh, 2, "triangle6"), by_name(mesh, 1, "line3")]
                    expect(f"{what}: names", found, [regions, boundaries])


def validate(folder, files, expect):
    command = ["node", "-e", VALIDATE, folder, *map(str, files)]
    for line in subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines():
        issues = json.loads(line)
        expect(f"glTF validator {issues['file']}", issues["numErrors"] + issues["numWarnings"], 0)
        for issue in issues["messages"]:
            print(f"    {issue['code']}: {issue['message']}")


def main(squinch, validator, work, *drawings):
    if gmsh:
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Verbosity", 1)
    faults = 0

    def expect(what, found, wanted):
        nonlocal faults
        right = found == wanted
        print(f"  {'ok   ' if right else 'WRONG'} {what}" + ("" if right else f": {found}, not {wanted}"))
        faults += not right

    scenes = []
    for drawing in drawings:
        print(drawing)
        files, regions, boundaries = write(squinch, drawing, Path(work) / Path(drawing).stem)
        check(files, regions, boundaries, expect)
        if gmsh:
            check_second_order(squinch, files, regions, boundaries, expect)
        scenes += [files["glb"], files["gltf"]]
    if validator == "-":
        print("SKIPPED: the glTF validator is not installed")
    else:
        validate(validator, scenes, expect)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    main(*sys.argv[1:])
