//! Gmsh's MSH: 4.1 in binary, and 2.2 as text for readers that know no other (MFEM, `gmshToFoam`, …).
//!
//! Each region is a physical group of dimension 2, each boundary one of dimension 1, each name of nodes one of
//! dimension 0. Each cell is in a group, because Gmsh's readers take only grouped cells once there is a group. Tags
//! count regions from 1, then boundaries, then names of nodes, so no two groups share a tag even where a reader ignores
//! dimensions. In 4.1 there is one surface for each region, one curve for each boundary and one point for each named
//! node. Order 2 is held (types 8 and 9, in our own order of nodes).
//!
//! MFEM 4.10 and Gmsh read both. deal.II 9.4 and FreeFEM 4.11 read 2.2 only: deal.II reads no binary, FreeFEM exits
//! without a message. deal.II refuses a group of edges inside the domain. scikit-fem 12 loses such groups from 2.2, and
//! all boundaries of order 2.
//!
//! Not held: the unit, the plane of the mesh (its coordinates in space are held), links to curves, balls. `"` in names
//! becomes `'`.

use crate::ids::{Id, NameId, RegionId, VertexId};
use crate::mesh::Mesh;
use crate::meshio::groups::{Groups, sides, undirected};
use crate::meshio::names::legal_names;
use std::io::{self, Write};

/// Gmsh cuts longer names short.
pub const LONGEST_NAME: usize = 127;

/// Writes MSH 4.1 in binary, little-endian.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together.
pub fn write_41(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    out.write_all(b"$MeshFormat\n4.1 1 8\n")?;
    out.write_all(&1_i32.to_le_bytes())?;
    out.write_all(b"\n$EndMeshFormat\n")?;
    write_names(&groups, out)?;
    let entities = Entities::of(mesh, &groups);
    section("Entities", &entities.describe(mesh, &groups), out)?;
    section("Nodes", &entities.nodes(mesh), out)?;
    section("Elements", &entities.elements(mesh, &groups), out)
}

/// Writes MSH 2.2 as text, coordinates with all their digits.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together.
pub fn write_22(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    out.write_all(b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")?;
    write_names(&groups, out)?;
    writeln!(out, "$Nodes\n{}", mesh.nodes.len())?;
    for (i, [x, y, z]) in mesh.places().enumerate() {
        writeln!(out, "{} {x:?} {y:?} {z:?}", i + 1)?;
    }
    let cells = mesh.edges.len() + mesh.triangles.len() + mesh.named_nodes.len();
    writeln!(out, "$EndNodes\n$Elements\n{cells}")?;
    let (line, triangle) = types(mesh);
    let mut tag = 0;
    let mut element = |kind: u32, group: usize, nodes: &mut dyn Iterator<Item = VertexId>, out: &mut dyn Write| {
        tag += 1;
        write!(out, "{tag} {kind} 2 {group} {group}")?;
        for v in nodes {
            write!(out, " {}", v.0 + 1)?;
        }
        writeln!(out)
    };
    for (i, edge) in mesh.edges.iter().enumerate() {
        let group = groups.regions.len() + groups.boundary(edge) + 1;
        element(line, group, &mut edge.nodes.into_iter().chain(mesh.edge_mids.get(i).copied()), out)?;
    }
    for (t, corners) in mesh.triangles.enumerate() {
        let mids = mesh.triangle_mids.get(t).into_iter().flatten().copied();
        let group = groups.region(mesh.triangle_regions[t]) + 1;
        element(triangle, group, &mut corners.iter().copied().chain(mids), out)?;
    }
    for &(node, name) in &mesh.named_nodes {
        element(POINT, groups.point_tag(name), &mut std::iter::once(node), out)?;
    }
    writeln!(out, "$EndElements")
}

/// Gmsh's element type of a point.
const POINT: u32 = 15;

impl Groups<'_> {
    /// The tag of the physical group of a named node.
    fn point_tag(&self, name: NameId) -> usize {
        self.regions.len() + self.boundaries.len() + self.point(name) + 1
    }
}

/// Gmsh's element types of lines and triangles.
fn types(mesh: &Mesh) -> (u32, u32) {
    if mesh.order() == 1 { (1, 2) } else { (8, 9) }
}

/// A name that can stand between quotation marks, on one line.
pub fn quotable(name: &str) -> String {
    let legal: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    legal.replace('"', "'")
}

fn write_names(groups: &Groups, out: &mut impl Write) -> io::Result<()> {
    let (regions, boundaries, points) = (&groups.regions, &groups.boundaries, &groups.points);
    let names = [(0, regions.len() + boundaries.len(), points), (1, regions.len(), boundaries), (2, 0, regions)];
    writeln!(out, "$PhysicalNames\n{}", regions.len() + boundaries.len() + points.len())?;
    for (dimension, before, names) in names {
        for (i, name) in legal_names(names, LONGEST_NAME, quotable).iter().enumerate() {
            writeln!(out, "{dimension} {} \"{name}\"", before + i + 1)?;
        }
    }
    writeln!(out, "$EndPhysicalNames")
}

pub fn section(name: &str, bytes: &Bytes, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "${name}")?;
    out.write_all(&bytes.0)?;
    writeln!(out, "\n$End{name}")
}

/// Binary words of MSH 4.1: `int` has 4 bytes, `size_t` and `double` have 8.
#[derive(Default)]
pub struct Bytes(pub Vec<u8>);

impl Bytes {
    pub fn ints(&mut self, values: impl IntoIterator<Item = usize>) {
        // Tags and types: below 2³² as ids are, and as tags below 2³¹ for as many names and regions.
        self.0.extend(values.into_iter().flat_map(|v| (v as i32).to_le_bytes()));
    }

    pub fn sizes(&mut self, values: impl IntoIterator<Item = usize>) {
        self.0.extend(values.into_iter().flat_map(|v| (v as u64).to_le_bytes()));
    }

    pub fn doubles(&mut self, values: impl IntoIterator<Item = f64>) {
        self.0.extend(values.into_iter().flat_map(f64::to_le_bytes));
    }
}

/// The entities of MSH 4.1 to which nodes and cells belong: surface `r + 1` for region `r`, curve `b + 1` for boundary
/// `b`, point `k + 1` for the named node `k`.
struct Entities {
    /// The nodes of each curve and each surface. A named node belongs to its point. Any other belongs to the first
    /// curve on which it lies, else to the first surface, else (a node of no cell) to surface 1.
    on_curves: Vec<Vec<usize>>,
    on_surfaces: Vec<Vec<usize>>,
    /// Curves that bound each surface.
    bounds: Vec<Vec<usize>>,
}

impl Entities {
    fn of(mesh: &Mesh, groups: &Groups) -> Self {
        let mut curve_of: Vec<Option<usize>> = vec![None; mesh.nodes.len()];
        for (i, edge) in mesh.edges.iter().enumerate() {
            for v in edge.nodes.iter().chain(mesh.edge_mids.get(i)) {
                curve_of[v.index()].get_or_insert(groups.boundary(edge));
            }
        }
        let mut surface_of: Vec<Option<usize>> = vec![None; mesh.nodes.len()];
        for (t, corners) in mesh.triangles.enumerate() {
            for v in corners.iter().chain(mesh.triangle_mids.get(t).into_iter().flatten()) {
                surface_of[v.index()].get_or_insert(mesh.triangle_regions[t].index());
            }
        }
        let surfaces = mesh.regions.len().max(usize::from(!mesh.nodes.is_empty()));
        let mut entities = Self {
            on_curves: vec![Vec::new(); groups.boundaries.len()],
            on_surfaces: vec![Vec::new(); surfaces],
            bounds: bounding_curves(mesh, groups, surfaces),
        };
        let mut named = vec![false; mesh.nodes.len()];
        mesh.named_nodes.iter().for_each(|(node, _)| named[node.index()] = true);
        for (node, (curve, surface)) in
            curve_of.into_iter().zip(surface_of).enumerate().filter(|(node, _)| !named[*node])
        {
            match curve {
                Some(curve) => entities.on_curves[curve].push(node),
                None => entities.on_surfaces[surface.unwrap_or(0)].push(node),
            }
        }
        entities
    }

    fn describe(&self, mesh: &Mesh, groups: &Groups) -> Bytes {
        let mut bytes = Bytes::default();
        let places: Vec<[f64; 3]> = mesh.places().collect();
        let box_of = |cells: &mut dyn Iterator<Item = VertexId>, bytes: &mut Bytes| {
            let places = cells.map(|v| places[v.index()]);
            let (low, high) = places
                .map(|p| (p, p))
                .reduce(|(low, high), (p, _)| {
                    (std::array::from_fn(|k| low[k].min(p[k])), std::array::from_fn(|k| high[k].max(p[k])))
                })
                .unwrap_or_default();
            bytes.doubles(low.into_iter().chain(high));
        };
        bytes.sizes([mesh.named_nodes.len(), self.on_curves.len(), self.on_surfaces.len(), 0]);
        for (k, &(node, name)) in mesh.named_nodes.iter().enumerate() {
            bytes.ints([k + 1]);
            bytes.doubles(places[node.index()]);
            bytes.sizes([1]);
            bytes.ints([groups.point_tag(name)]);
        }
        for (b, edges) in groups.edges().into_iter().enumerate() {
            bytes.ints([b + 1]);
            box_of(&mut edges.iter().flat_map(|&i| mesh.edges[i].nodes), &mut bytes);
            bytes.sizes([1]);
            bytes.ints([groups.regions.len() + b + 1]);
            bytes.sizes([0]);
        }
        let triangles = self.triangles(mesh);
        for (s, curves) in self.bounds.iter().enumerate() {
            bytes.ints([s + 1]);
            box_of(&mut triangles[s].iter().flat_map(|&t| mesh.triangles.as_slice()[t]), &mut bytes);
            let group = mesh.regions.get(RegionId::from_index(s));
            bytes.sizes([usize::from(group.is_some())]);
            bytes.ints(group.map(|_| groups.region(RegionId::from_index(s)) + 1));
            bytes.sizes([curves.len()]);
            bytes.ints(curves.iter().map(|c| c + 1));
        }
        bytes
    }

    fn triangles(&self, mesh: &Mesh) -> Vec<Vec<usize>> {
        let mut triangles = vec![Vec::new(); self.on_surfaces.len()];
        for (t, region) in mesh.triangle_regions.enumerate() {
            triangles[region.index()].push(t.index());
        }
        triangles
    }

    fn nodes(&self, mesh: &Mesh) -> Bytes {
        let mut bytes = Bytes::default();
        let places: Vec<[f64; 3]> = mesh.places().collect();
        let named: Vec<Vec<usize>> = mesh.named_nodes.iter().map(|(node, _)| vec![node.index()]).collect();
        let points = named.iter().enumerate().map(|(k, nodes)| (0, k, nodes));
        let curves = self.on_curves.iter().enumerate().map(|(c, nodes)| (1, c, nodes));
        let surfaces = self.on_surfaces.iter().enumerate().map(|(s, nodes)| (2, s, nodes));
        let blocks: Vec<_> = points.chain(curves).chain(surfaces).filter(|(.., nodes)| !nodes.is_empty()).collect();
        bytes.sizes([blocks.len(), places.len(), usize::from(!places.is_empty()), places.len()]);
        for (dimension, entity, nodes) in blocks {
            bytes.ints([dimension, entity + 1, 0]);
            bytes.sizes([nodes.len()]);
            bytes.sizes(nodes.iter().map(|n| n + 1));
            bytes.doubles(nodes.iter().flat_map(|&n| places[n]));
        }
        bytes
    }

    fn elements(&self, mesh: &Mesh, groups: &Groups) -> Bytes {
        let mut bytes = Bytes::default();
        let (line, triangle) = types(mesh);
        let cells = mesh.edges.len() + mesh.triangles.len();
        let count = cells + mesh.named_nodes.len();
        let lines = groups.edges();
        let triangles = self.triangles(mesh);
        let blocks = lines.iter().chain(&triangles).filter(|cells| !cells.is_empty()).count();
        bytes.sizes([mesh.named_nodes.len() + blocks, count, usize::from(count > 0), count]);
        for (k, (node, _)) in mesh.named_nodes.iter().enumerate() {
            bytes.ints([0, k + 1, POINT as usize]);
            bytes.sizes([1, cells + k + 1, node.index() + 1]);
        }
        for (b, edges) in lines.iter().enumerate().filter(|(_, edges)| !edges.is_empty()) {
            bytes.ints([1, b + 1, line as usize]);
            bytes.sizes([edges.len()]);
            for &i in edges {
                bytes.sizes([i + 1]);
                bytes.sizes(mesh.edges[i].nodes.iter().chain(mesh.edge_mids.get(i)).map(|v| v.index() + 1));
            }
        }
        for (s, cells) in triangles.iter().enumerate().filter(|(_, cells)| !cells.is_empty()) {
            bytes.ints([2, s + 1, triangle as usize]);
            bytes.sizes([cells.len()]);
            for &t in cells {
                bytes.sizes([mesh.edges.len() + t + 1]);
                let mids = mesh.triangle_mids.as_slice().get(t).into_iter().flatten();
                bytes.sizes(mesh.triangles.as_slice()[t].iter().chain(mids).map(|v| v.index() + 1));
            }
        }
        bytes
    }
}

fn bounding_curves(mesh: &Mesh, groups: &Groups, surfaces: usize) -> Vec<Vec<usize>> {
    let mut bounds = vec![std::collections::BTreeSet::new(); surfaces];
    let sides = sides(mesh);
    for edge in &mesh.edges {
        for (t, _) in sides.get(&undirected(edge.nodes)).into_iter().flatten() {
            bounds[mesh.triangle_regions[*t].index()].insert(groups.boundary(edge));
        }
    }
    bounds.into_iter().map(|curves| curves.into_iter().collect()).collect()
}
