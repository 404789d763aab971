//! The named groups of a tetrahedral mesh as files number them, and on which tetrahedra its facet triangles lie.

use crate::ids::{Id, NameId, TetId, VertexId};
use crate::mesh::solid::SolidMesh;
use crate::meshio::groups::Kind;
use crate::meshio::names::name_comment;
use std::collections::BTreeMap;
use std::io::{self, Write};

/// Names in the order of first use, numbered from 0.
#[derive(Default)]
pub struct Numbered<'m> {
    /// The names.
    pub texts: Vec<&'m str>,
    number_of: BTreeMap<NameId, usize>,
}

impl<'m> Numbered<'m> {
    fn of(mesh: &'m SolidMesh, names: impl Iterator<Item = NameId>) -> Self {
        let mut numbered = Self::default();
        for name in names {
            numbered.number_of.entry(name).or_insert_with(|| {
                numbered.texts.push(mesh.names.text(name));
                numbered.texts.len() - 1
            });
        }
        numbered
    }

    /// The number of a name that is in use.
    pub fn number(&self, name: NameId) -> usize {
        self.number_of[&name]
    }

    /// Writes each name as a comment, with its number from 1.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_comments(&self, kind: Kind, out: &mut impl Write) -> io::Result<()> {
        let names = self.texts.iter().enumerate();
        names.map(|(i, name)| name_comment(kind, &(i + 1).to_string(), name)).try_for_each(|c| writeln!(out, "# {c}"))
    }
}

/// Names of regions, facets and segments. Regions of one name are one group, and so are facets.
pub struct Groups<'m> {
    /// Regions.
    pub regions: Numbered<'m>,
    /// Facets.
    pub facets: Numbered<'m>,
    /// Segments, as far as they have names.
    pub segments: Numbered<'m>,
    /// Facets, then segments of other names: for formats with one list of both.
    pub boundaries: Numbered<'m>,
}

impl<'m> Groups<'m> {
    /// # Errors
    /// `InvalidInput` where the mesh's lists do not fit together: writers index it without asking again.
    pub fn of(mesh: &'m SolidMesh) -> io::Result<Self> {
        check(mesh)?;
        let facets = || mesh.triangles.iter().map(|t| t.name);
        let segments = || mesh.edges.iter().filter_map(|e| e.name);
        Ok(Self {
            regions: Numbered::of(mesh, mesh.regions.iter().copied()),
            facets: Numbered::of(mesh, facets()),
            segments: Numbered::of(mesh, segments()),
            boundaries: Numbered::of(mesh, facets().chain(segments())),
        })
    }

    /// The group of a tetrahedron.
    pub fn region(&self, mesh: &SolidMesh, t: TetId) -> usize {
        self.regions.number(mesh.regions[mesh.tetrahedron_regions[t]])
    }
}

/// Places in a list, by group, in the list's order.
pub fn by_group(groups: usize, group_of: impl Iterator<Item = Option<usize>>) -> Vec<Vec<usize>> {
    let mut lists = vec![Vec::new(); groups];
    for (i, group) in group_of.enumerate() {
        if let Some(group) = group {
            lists[group].push(i);
        }
    }
    lists
}

/// The lists of a mesh fit together: every id is within its list, and formats with 32-bit numbers can hold it.
///
/// # Errors
/// `InvalidInput` where they do not.
pub fn check(mesh: &SolidMesh) -> io::Result<()> {
    let names = mesh.names.iter().count();
    let wrong = |what: &str| Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    let corners = 4 * mesh.tetrahedra.len() + 3 * mesh.triangles.len() + 2 * mesh.edges.len();
    if mesh.nodes.len().max(corners) > i32::MAX as usize {
        return wrong("the mesh has more corners than 32 bits can number (2^31 - 1)");
    }
    let node = |v: &VertexId| v.index() < mesh.nodes.len();
    let named = |name: NameId| name.index() < names;
    let right = mesh.tetrahedron_regions.len() == mesh.tetrahedra.len()
        && (mesh.weights.is_empty() || mesh.weights.len() == mesh.nodes.len())
        && mesh.tetrahedra.iter().flatten().all(node)
        && mesh.tetrahedron_regions.iter().all(|r| r.index() < mesh.regions.len())
        && mesh.regions.iter().all(|&name| named(name))
        && mesh.triangles.iter().all(|t| named(t.name) && t.nodes.iter().all(node))
        && mesh.edges.iter().all(|e| e.name.is_none_or(named) && e.nodes.iter().all(node))
        && mesh.points.iter().all(|(_, v)| node(v));
    if right { Ok(()) } else { wrong("the lists of the mesh do not fit together") }
}

/// The corners of the face opposite each corner of a positive tetrahedron, counter-clockwise as seen from outside.
pub const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// For each facet triangle of a mesh the tetrahedra that have it, each with the corner that the face is opposite to.
pub fn tetrahedra_at(mesh: &SolidMesh) -> Vec<Vec<(TetId, usize)>> {
    let mut on_facet = vec![false; mesh.nodes.len()];
    let mut triangles: Vec<([VertexId; 3], usize)> = Vec::with_capacity(mesh.triangles.len());
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        triangle.nodes.iter().for_each(|v| on_facet[v.index()] = true);
        triangles.push((ascending(triangle.nodes), i));
    }
    triangles.sort_unstable();
    let mut found = vec![Vec::new(); triangles.len()];
    for (t, corners) in mesh.tetrahedra.enumerate() {
        for (corner, face) in FACES.into_iter().enumerate() {
            let nodes = face.map(|i| corners[i]);
            if nodes.iter().all(|v| on_facet[v.index()]) {
                let nodes = ascending(nodes);
                let first = triangles.partition_point(|entry| entry.0 < nodes);
                let same = triangles[first..].iter().take_while(|entry| entry.0 == nodes);
                same.for_each(|&(_, i)| found[i].push((t, corner)));
            }
        }
    }
    found
}

fn ascending(mut nodes: [VertexId; 3]) -> [VertexId; 3] {
    nodes.sort_unstable();
    nodes
}
