//! Every face of a mesh once, with the tetrahedra and facet triangles on it: found by counting, a node at a time, so that
//! no table of all faces is ever held.

use super::grouped::Grouped;
use crate::ids::{Id, TetId, VertexId};
use crate::mesh::solid::SolidMesh;
use std::ops::Range;

/// Nodes of a task: enough to be worth a thread's while.
const TASK: u32 = 4096;

/// The corners of the face opposite each corner, counter-clockwise as seen from outside a positive tetrahedron.
pub const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// A face of a tetrahedron.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side {
    pub tetrahedron: TetId,
    /// The corner that the face is opposite to.
    pub corner: usize,
}

/// A triangle of three nodes with all that lies on it.
pub struct Face<'f> {
    /// The nodes, ascending.
    pub nodes: [VertexId; 3],
    pub sides: &'f [Side],
    /// Facet triangles, as places in the mesh's list.
    pub triangles: &'f [u32],
}

pub struct Faces<'m> {
    mesh: &'m SolidMesh,
    /// Tetrahedra by the least of their nodes, and by the second: every face is of one of those.
    tetrahedra: Grouped,
    /// Facet triangles by the least of their nodes.
    triangles: Grouped,
}

impl<'m> Faces<'m> {
    /// Ids of the mesh must lead somewhere.
    pub fn new(mesh: &'m SolidMesh) -> Self {
        let low_nodes = || {
            mesh.tetrahedra.enumerate().flat_map(|(t, nodes)| {
                let mut nodes = *nodes;
                nodes.sort_unstable();
                let second = (nodes[1] != nodes[0]).then_some((nodes[1].index(), t.0));
                [(nodes[0].index(), t.0)].into_iter().chain(second)
            })
        };
        let low_node = mesh.triangles.iter().map(|t| t.nodes.iter().min().map(|v| v.index()));
        Self {
            mesh,
            tetrahedra: Grouped::of(mesh.nodes.len(), low_nodes),
            triangles: Grouped::by(mesh.nodes.len(), low_node),
        }
    }

    /// Ranges of nodes that together are all of them; they depend on the mesh alone.
    pub fn tasks(&self) -> Vec<Range<u32>> {
        let end = self.mesh.nodes.len() as u32;
        (0..end).step_by(TASK as usize).map(|first| first..end.min(first.saturating_add(TASK))).collect()
    }

    /// Visits every face whose least node is in the range, in the order of its nodes.
    pub fn visit(&self, nodes: Range<u32>, mut look: impl FnMut(&Face)) {
        let (mut found, mut sides, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
        let first_triangle = 4 * self.mesh.tetrahedra.len() as u32;
        for low in nodes.map(VertexId) {
            found.clear();
            for &t in self.tetrahedra.of_group(low.index()) {
                let corners = self.mesh.tetrahedra[TetId(t)];
                for (corner, face) in (0..).zip(FACES) {
                    let nodes = ascending(face.map(|i| corners[i])).0;
                    if nodes[0] == low {
                        found.push((nodes[1], nodes[2], 4 * t + corner));
                    }
                }
            }
            for &i in self.triangles.of_group(low.index()) {
                let nodes = ascending(self.mesh.triangles[i as usize].nodes).0;
                found.push((nodes[1], nodes[2], first_triangle + i));
            }
            found.sort_unstable();
            for run in found.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
                let split = run.partition_point(|entry| entry.2 < first_triangle);
                sides.clear();
                sides.extend(run[..split].iter().map(|&(_, _, code)| side(code)));
                triangles.clear();
                triangles.extend(run[split..].iter().map(|entry| entry.2 - first_triangle));
                look(&Face { nodes: [low, run[0].0, run[0].1], sides: &sides, triangles: &triangles });
            }
        }
    }
}

fn side(code: u32) -> Side {
    Side { tetrahedron: TetId(code / 4), corner: (code % 4) as usize }
}

/// Three nodes in ascending order, and whether that is an even permutation of theirs.
pub fn ascending([mut a, mut b, mut c]: [VertexId; 3]) -> ([VertexId; 3], bool) {
    let mut even = true;
    let mut order = |x: &mut VertexId, y: &mut VertexId| {
        if *x > *y {
            std::mem::swap(x, y);
            even = !even;
        }
    };
    order(&mut a, &mut b);
    order(&mut b, &mut c);
    order(&mut a, &mut b);
    ([a, b, c], even)
}
