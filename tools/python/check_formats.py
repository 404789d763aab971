#!/usr/bin/env python3
"""Writes meshes in every format and reads them as other people's programs do: meshio, gmsh, MFEM, scikit-fem, pyvista, trimesh, FreeFEM, deal.II and
the Khronos glTF validator.

`check_formats.py [--deal] SQUINCH VALIDATOR WORK DRAWING...` with the program, the folder of the npm package gltf-validator (`-`: none),
a folder to write in, and drawings to mesh. Exits 1 where a program refuses a file, or finds other names, other numbers of cells under
a name or other coordinates than the report and the VTU file have. A reader that is not installed is skipped, and that is said:

    pip install meshio h5py gmsh mfem scikit-fem pyvista trimesh
    apt-get install --no-install-recommends freefem++ libfreefem++

`--deal` also runs deal.II, by a reader of a few lines that is compiled into WORK. Its development files are 300 packages, two to three
minutes of installing, and so not for every run: `apt-get install --no-install-recommends libdeal.ii-dev`.
"""

import collections
import importlib
import json
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from urllib.parse import unquote

import meshio
import numpy as np


def loaded(module):
    """A module, or None where it is not installed or cannot be loaded here, which is said."""
    try:
        return importlib.import_module(module)
    except (ImportError, OSError) as error:  # the wheel of gmsh needs libGLU and other libraries of a desktop
        print(f"SKIPPED: {module} cannot be loaded here: {error}")
        return None


gmsh, mfem, skfem, pyvista, trimesh = map(loaded, ("gmsh", "mfem.ser", "skfem", "pyvista", "trimesh"))
freefem = shutil.which("FreeFem++-nw") or shutil.which("FreeFem++")
if not freefem:
    print("SKIPPED: FreeFEM is not installed")

SUFFIXES = {"vtk": "vtk", "vtk-text": "text.vtk", "msh": "msh", "msh22": "22.msh", "su2": "su2", "inp": "inp", "xdmf": "xdmf",
            "triangle": "node", "glb": "glb", "gltf": "gltf", "obj": "obj", "stl": "stl"}

# Files for one reader: format, suffix, options.
FOR_READERS = {
    "plain": ("vtu", "plain.vtu", ["--plain"]),
    "xdmf single": ("xdmf", "single.xdmf", ["--xdmf", "single"]),
    "msh22 rim": ("msh22", "rim.msh", ["--interior-lines", "off"]),
    "vtk-text rim": ("vtk-text", "rim.vtk", ["--lines", "on", "--interior-lines", "off"]),
    "obj bare": ("obj", "bare.obj", ["--lines", "off"]),
    "glb bare": ("glb", "bare.glb", ["--lines", "off"]),
}

# Cells by material and edges of the rim by boundary id, as deal.II reads them.
DEAL = """
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/tria.h>
#include <fstream>
#include <iostream>
#include <map>
int main(int, char **files) {
  const std::string file = files[1];
  dealii::Triangulation<2> grid;
  dealii::GridIn<2> reader(grid);
  std::ifstream in(file);
  if (file.substr(file.size() - 4) == ".vtk") reader.read_vtk(in); else reader.read_msh(in);
  std::map<unsigned, unsigned> groups[2];
  for (const auto &cell : grid.active_cell_iterators()) {
    ++groups[0][cell->material_id()];
    for (unsigned side = 0; side < cell->n_faces(); ++side)
      if (cell->face(side)->at_boundary()) ++groups[1][cell->face(side)->boundary_id()];
  }
  for (const auto &group : groups) {
    for (const auto &pair : group) std::cout << pair.second << ' ';
    std::cout << std::endl;
  }
}
"""

FREEFEM = """
load "{plugin}"
mesh Th = {reader}("{file}");
int[int] edges = labels(Th), cells = regions(Th);
cout << "FOUND " << Th.nt << " " << Th.nbe << " " << cells.n << " " << edges.n << endl;
"""

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
    for name, (form, suffix, options) in FOR_READERS.items():
        files[name] = Path(f"{stem}.{suffix}")
        subprocess.run([squinch, "convert", vtu, files[name], "--format", form, "--quiet", *options], check=True)
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
    named = {f"region:{name}" for name in regions} | {f"boundary:{name}" for name in boundaries}
    for array, kind, groups in (("region", "triangle", regions), ("boundary", "line", boundaries)):
        expect(f"meshio vtk {array}", sorted(by_number(mesh, array, kind).values()), sorted(groups.values()))
    expect("meshio vtk names", set(map(unquote, mesh.field_data)), named)
    mesh = meshio.read(files["vtk-text"])
    expect("meshio vtk-text points", np.array_equal(mesh.points, points), True)
    expect("meshio vtk-text regions", sorted(by_number(mesh, "region", "triangle").values()), sorted(regions.values()))
    expect("meshio vtk-text names", set(map(unquote, mesh.field_data)), named)
    expect("meshio vtk-text edges", {n: len(mesh.field_data[f"boundary:{n}".replace(" ", "%20")]) for n in boundaries}, boundaries)
    mesh = meshio.read(files["plain"])
    expect("meshio plain vtu", sorted(by_number(mesh, "region", "triangle").values()), sorted(regions.values()))
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
    mesh = meshio.read(files["xdmf single"])
    for array, kind, groups in (("region", "triangle", regions), ("boundary", "line", boundaries)):
        names = {number: key.partition(":")[2] for key, (number, _) in mesh.field_data.items() if key.startswith(array)}
        found = {names[number]: count for number, count in by_number(mesh, array, kind).items()}
        expect(f"meshio xdmf of one grid, {array}", found, groups)
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
    for name in ("obj", "obj bare"):
        mesh = meshio.read(files[name])
        expect(f"meshio {name}", sum(len(b.data) for b in mesh.cells if b.type == "triangle"), sum(regions.values()))
        used, made = (words(path, first) for path, first in ((files[name], "usemtl"), (files[name].with_suffix(".mtl"), "newmtl")))
        expect(f"materials of {name}", used, made)
    rim_edges = len(rim)
    if gmsh:
        gmsh.open(str(files["vtk-text"]))
        expect("gmsh vtk-text", sum(map(len, gmsh.model.mesh.getElements(2)[1])), sum(regions.values()))
    if trimesh:
        check_trimesh(files, regions, boundaries, expect)
    if mfem:
        check_mfem(files, regions, boundaries, rim_edges, expect)
    if skfem:
        check_skfem(files, regions, boundaries, expect)
    if pyvista:
        check_pyvista(files, regions, boundaries, named, expect)
    if freefem:
        check_freefem(files, regions, boundaries, rim_edges, expect)
    return rim_edges


def words(path, first):
    """What follows a word at the beginning of lines."""
    found = (line.split(maxsplit=1) for line in path.read_text().splitlines())
    return {line[1] for line in found if len(line) == 2 and line[0] == first}


def check_trimesh(files, regions, boundaries, expect):
    """Named nodes of glTF; materials of OBJ, a mesh each."""
    for name, boundary in (("glb", boundaries), ("gltf", boundaries), ("glb bare", {})):
        scene = trimesh.load(files[name], process=False)
        cells = [len(mesh.faces) for mesh in scene.geometry.values() if isinstance(mesh, trimesh.Trimesh)]
        expect(f"trimesh {name} regions", sorted(cells), sorted(regions.values()))
        # Names that are there twice are told apart by it.
        expect(f"trimesh {name} nodes", set(regions) | set(boundary) <= set(scene.graph.nodes), True)
        expect(f"trimesh {name} number of nodes", len(scene.graph.nodes_geometry), len(regions) + len(boundary))
    scene = trimesh.load(files["obj bare"], process=False, split_object=False, group_material=True, force="scene")
    expect("trimesh obj materials", sorted(len(mesh.faces) for mesh in scene.geometry.values()), sorted(regions.values()))


def check_mfem(files, regions, boundaries, rim_edges, expect):
    """MSH with groups and names; text VTK with regions; plain VTU with regions."""
    for name in ("msh", "msh22", "vtk-text", "plain"):
        mesh = mfem.Mesh(str(files[name]), 1, 1)
        cells = collections.Counter(mesh.GetAttribute(i) for i in range(mesh.GetNE()))
        edges = collections.Counter(mesh.GetBdrAttribute(i) for i in range(mesh.GetNBE()))
        of_groups = name.startswith("msh")
        expect(f"MFEM {name} cells", sorted(cells.values()), sorted(regions.values()))
        expect(f"MFEM {name} edges", sorted(edges.values()), sorted(boundaries.values()) if of_groups else [rim_edges])


def check_skfem(files, regions, boundaries, expect):
    """By meshio, which has one group a name: where a region and a boundary share one, it keeps the region's."""
    mesh = skfem.Mesh.load(str(files["msh"]))
    found = {name: len(cells) for name, cells in mesh.subdomains.items() if not name.startswith("gmsh:")}
    expect("scikit-fem msh regions", found, regions)
    wanted = {name: count for name, count in boundaries.items() if name not in regions}
    expect("scikit-fem msh boundaries", {name: len(edges) for name, edges in mesh.boundaries.items() if name}, wanted)


def check_pyvista(files, regions, boundaries, named, expect):
    triangles, lines = sum(regions.values()), sum(boundaries.values())
    for name, cells in (("vtu", triangles + lines), ("vtk", triangles + lines), ("vtk-text", triangles), ("plain", triangles)):
        mesh = pyvista.read(files[name])
        expect(f"pyvista {name} cells", mesh.n_cells, cells)
        if name != "plain":
            found = {key for key in mesh.field_data if key.startswith(("region:", "boundary:"))}
            expect(f"pyvista {name} names", found, named)
    # Two grids are blocks; `pyvista.read` itself wants times.
    from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
    for name in ("xdmf", "xdmf single"):
        reader = vtkXdmfReader()
        reader.SetFileName(str(files[name]))
        reader.Update()
        expect(f"VTK {name} cells", reader.GetOutputDataObject(0).GetNumberOfCells(), triangles + lines)


def check_freefem(files, regions, boundaries, rim_edges, expect):
    """MSH 2.2 with groups (4.1 ends it); VTK in both forms, with cells and no groups."""
    triangles, lines = sum(regions.values()), sum(boundaries.values())
    for name, plugin, reader, wanted in (
        ("msh22", "gmsh", "gmshload", [triangles, lines, len(regions), len(boundaries)]),
        ("vtk", "iovtk", "vtkload", [triangles, lines]),
        ("vtk-text", "iovtk", "vtkload", [triangles, rim_edges]),
    ):
        script = files[name].with_suffix(".edp")
        script.write_text(FREEFEM.format(plugin=plugin, reader=reader, file=files[name].resolve()))
        # Debian's own list of places does not have the one where it puts the plugins.
        paths = os.pathsep.join(str(path) for path in Path("/usr/lib").glob("**/freefem++"))
        environment = {"FF_LOADPATH": paths, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", **os.environ}
        run = subprocess.run([freefem, "-nw", "-v", "0", script], capture_output=True, text=True, env=environment, timeout=120)
        found = re.search(r"^FOUND (.*)$", run.stdout, re.MULTILINE)
        numbers = [int(word) for word in found[1].split()][: len(wanted)] if found else run.stdout[-300:]
        expect(f"FreeFEM {name}", numbers, wanted)


def deal_reader(work):
    """The program that reads with deal.II, compiled once; None where deal.II is not installed."""
    program, source = work / "deal_reader", work / "deal_reader.cc"
    if not Path("/usr/include/deal.II").exists() or not shutil.which("mpicxx"):
        print("SKIPPED: deal.II is not installed (apt-get install --no-install-recommends libdeal.ii-dev)")
        return None
    if not program.exists() or source.read_text() != DEAL:
        source.write_text(DEAL)
        folders = [f"-I/usr/include/{name}" for name in ("deal.II", "trilinos", "suitesparse")]
        libraries = ["-ldeal.ii", "-ltbb", "-ltrilinos_teuchoscomm", "-ltrilinos_teuchoscore"]
        subprocess.run(["mpicxx", "-std=c++17", "-w", *folders, source, *libraries, "-o", program], check=True)
    return program


def check_deal(program, files, regions, rim_edges, expect):
    """Text only, and no boundary within the domain."""
    for name in ("msh22 rim", "vtk-text rim", "vtk-text"):
        run = subprocess.run([program.resolve(), files[name]], capture_output=True, text=True)
        cells, edges, *_ = [[int(word) for word in line.split()] for line in run.stdout.splitlines()] + [run.stderr[:300]] * 2
        expect(f"deal.II {name}", (sorted(cells), sum(edges)) if run.returncode == 0 else run.stderr[:300],
               (sorted(regions.values()), rim_edges))


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


def main(squinch, validator, work, *drawings, deal=False):
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
    deal_program = deal_reader(Path(work)) if deal else None
    if not deal:
        print("SKIPPED: deal.II, which --deal asks for")
    for drawing in drawings:
        print(drawing)
        files, regions, boundaries = write(squinch, drawing, Path(work) / Path(drawing).stem)
        rim_edges = check(files, regions, boundaries, expect)
        if deal_program:
            check_deal(deal_program, files, regions, rim_edges, expect)
        if gmsh:
            check_second_order(squinch, files, regions, boundaries, expect)
        scenes += [files["glb"], files["gltf"], files["glb bare"]]
    if validator == "-":
        print("SKIPPED: the glTF validator is not installed")
    else:
        validate(validator, scenes, expect)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    arguments = [word for word in sys.argv[1:] if word != "--deal"]
    if len(arguments) < 4:
        sys.exit(__doc__)
    main(*arguments, deal="--deal" in sys.argv)
