//! Gmsh's MSH of tetrahedra: 4.1 in binary, and 2.2 as text.
//!
//! Every name of regions is a physical group of dimension 3, every name of facets one of dimension 2 and every name of
//! segments one of dimension 1. Edges on segments without a name are left out: once there is a group, Gmsh's readers take
//! grouped cells only. Tags count regions from 1, then facets, then segments, so that no two groups share one. In 4.1
//! there is one volume, surface or curve a group; none says what bounds it.
//!
//! Not held: the unit, the weights, links to the solid. In names `"` becomes `'`.

use super::write::{Bytes, LONGEST_NAME, quotable, section};
use crate::ids::{Id, IdVec, VertexId};
use crate::mesh::solid::SolidMesh;
use crate::meshio::names::legal_names;
use crate::meshio::solid_groups::{Groups, by_group};
use std::io::{self, Write};

/// Gmsh's types of lines, triangles and tetrahedra.
const KINDS: [usize; 3] = [1, 2, 4];

/// Writes MSH 4.1 in binary, little-endian.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together.
pub fn write_41(mesh: &SolidMesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    let entities = entities(mesh, &groups);
    out.write_all(b"$MeshFormat\n4.1 1 8\n")?;
    out.write_all(&1_i32.to_le_bytes())?;
    out.write_all(b"\n$EndMeshFormat\n")?;
    write_names(&groups, out)?;
    section("Entities", &describe(mesh, &entities), out)?;
    section("Nodes", &nodes(mesh, &entities), out)?;
    section("Elements", &elements(&entities), out)
}

/// Writes MSH 2.2 as text, coordinates with all their digits.
///
/// # Errors
/// Those of `out`; `InvalidInput` where the mesh's lists do not fit together.
pub fn write_22(mesh: &SolidMesh, out: &mut impl Write) -> io::Result<()> {
    let groups = Groups::of(mesh)?;
    let entities = entities(mesh, &groups);
    out.write_all(b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")?;
    write_names(&groups, out)?;
    writeln!(out, "$Nodes\n{}", mesh.nodes.len())?;
    for (i, [x, y, z]) in mesh.nodes.iter().enumerate() {
        writeln!(out, "{} {x:?} {y:?} {z:?}", i + 1)?;
    }
    let cells: usize = entities.iter().map(|e| e.cells.len()).sum();
    writeln!(out, "$EndNodes\n$Elements\n{cells}")?;
    let mut tag = 0;
    for entity in &entities {
        for cell in &entity.cells {
            tag += 1;
            write!(out, "{tag} {} 2 {} {}", entity.kind(), entity.group, entity.group)?;
            cell.iter().try_for_each(|v| write!(out, " {}", v.0 + 1))?;
            writeln!(out)?;
        }
    }
    writeln!(out, "$EndElements")
}

/// What a group is: cells of one dimension.
struct Entity {
    dimension: usize,
    /// Its tag, from 1 in each dimension.
    tag: usize,
    /// The tag of its physical group.
    group: usize,
    cells: Vec<Vec<VertexId>>,
}

impl Entity {
    fn kind(&self) -> usize {
        KINDS[self.dimension - 1]
    }
}

/// Curves, then surfaces, then volumes.
fn entities(mesh: &SolidMesh, groups: &Groups) -> Vec<Entity> {
    let (regions, facets) = (groups.regions.texts.len(), groups.facets.texts.len());
    let of_edge = mesh.edges.iter().map(|e| e.name.map(|name| groups.segments.number(name)));
    let of_triangle = mesh.triangles.iter().map(|t| Some(groups.facets.number(t.name)));
    let of_cell = mesh.tetrahedra.ids().map(|t| Some(groups.region(mesh, t)));
    let mut entities = Vec::new();
    let mut add = |dimension: usize, before: usize, lists: Vec<Vec<usize>>, cell: &dyn Fn(usize) -> Vec<VertexId>| {
        for (i, list) in lists.into_iter().enumerate() {
            let cells = list.into_iter().map(cell).collect();
            entities.push(Entity { dimension, tag: i + 1, group: before + i + 1, cells });
        }
    };
    let segments = by_group(groups.segments.texts.len(), of_edge);
    add(1, regions + facets, segments, &|i| mesh.edges[i].nodes.to_vec());
    add(2, regions, by_group(facets, of_triangle), &|i| mesh.triangles[i].nodes.to_vec());
    add(3, 0, by_group(regions, of_cell), &|i| mesh.tetrahedra.as_slice()[i].to_vec());
    entities
}

fn write_names(groups: &Groups, out: &mut impl Write) -> io::Result<()> {
    let (regions, facets, segments) = (&groups.regions.texts, &groups.facets.texts, &groups.segments.texts);
    writeln!(out, "$PhysicalNames\n{}", regions.len() + facets.len() + segments.len())?;
    for (dimension, before, names) in
        [(1, regions.len() + facets.len(), segments), (2, regions.len(), facets), (3, 0, regions)]
    {
        for (i, name) in legal_names(names, LONGEST_NAME, quotable).iter().enumerate() {
            writeln!(out, "{dimension} {} \"{name}\"", before + i + 1)?;
        }
    }
    writeln!(out, "$EndPhysicalNames")
}

fn describe(mesh: &SolidMesh, entities: &[Entity]) -> Bytes {
    let mut bytes = Bytes::default();
    let count = |dimension| entities.iter().filter(|e| e.dimension == dimension).count();
    // No points.
    bytes.sizes([0, count(1), count(2), count(3)]);
    for entity in entities {
        bytes.ints([entity.tag]);
        let nodes = || entity.cells.iter().flatten().map(|&v| mesh.nodes[v]);
        let bound = |k: usize, pick: fn(f64, f64) -> f64| nodes().map(|p| p[k]).reduce(pick).unwrap_or(0.0);
        bytes.doubles((0..3).map(|k| bound(k, f64::min)));
        bytes.doubles((0..3).map(|k| bound(k, f64::max)));
        bytes.sizes([1]);
        bytes.ints([entity.group]);
        // Nothing is said of what bounds it.
        bytes.sizes([0]);
    }
    bytes
}

/// Every node is of the first entity that has it; one of no cell, which Gmsh could not keep, of the last.
fn nodes(mesh: &SolidMesh, entities: &[Entity]) -> Bytes {
    let mut owner: IdVec<VertexId, Option<usize>> = vec![None; mesh.nodes.len()].into();
    for (i, entity) in entities.iter().enumerate() {
        entity.cells.iter().flatten().for_each(|&v| _ = owner[v].get_or_insert(i));
    }
    let last = entities.len().checked_sub(1);
    let lists = by_group(entities.len(), owner.iter().map(|owner| owner.or(last)));
    let owned = || entities.iter().zip(&lists).filter(|(_, list)| !list.is_empty());
    let mut bytes = Bytes::default();
    let n = mesh.nodes.len();
    bytes.sizes([owned().count(), n, usize::from(n > 0), n]);
    for (entity, list) in owned() {
        bytes.ints([entity.dimension, entity.tag, 0]);
        bytes.sizes([list.len()]);
        bytes.sizes(list.iter().map(|i| i + 1));
        bytes.doubles(list.iter().flat_map(|&i| mesh.nodes.as_slice()[i]));
    }
    bytes
}

fn elements(entities: &[Entity]) -> Bytes {
    let full = || entities.iter().filter(|e| !e.cells.is_empty());
    let count: usize = full().map(|e| e.cells.len()).sum();
    let mut bytes = Bytes::default();
    bytes.sizes([full().count(), count, usize::from(count > 0), count]);
    let mut tag = 0;
    for entity in full() {
        bytes.ints([entity.dimension, entity.tag, entity.kind()]);
        bytes.sizes([entity.cells.len()]);
        for cell in &entity.cells {
            tag += 1;
            bytes.sizes([tag]);
            bytes.sizes(cell.iter().map(|v| v.index() + 1));
        }
    }
    bytes
}
