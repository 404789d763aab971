//! The edge table: every edge of a mesh once, with the triangles on its two sides. It is made by a counting sort,
//! without a hash map.
//!
//! ```text
//!           2          half-edges by smaller node       edges, first          left       right
//!         ╱   ╲        0:  (1, t₀0) (2, t₀2)            first[0] = 0:  0–1    t₀, 0      t₁, 0
//!       ╱  t₀   ╲          (1, t₁0) (3, t₁1)                           0–2    none       t₀, 2
//!     0 ───────── 1    1:  (2, t₀1) (3, t₁2)                           0–3    t₁, 1      none
//!       ╲  t₁   ╱      each bucket sorted by the        first[1] = 3:  1–2    t₀, 1      none
//!         ╲   ╱        larger node: runs are edges                     1–3    none       t₁, 2
//!           3          t₀ = (0, 1, 2), t₁ = (1, 0, 3)
//! ```

use crate::ids::{IdVec, TriangleId, VertexId};

/// Stands for no triangle on that side.
const NONE: u32 = u32::MAX;

/// A side of a triangle: side `i` runs from corner `i` to corner `i + 1`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct TriangleSide {
    /// The triangle, on its left.
    pub triangle: TriangleId,
    /// The corner at which it starts, in 0..3.
    pub corner: usize,
}

impl TriangleSide {
    fn packed(self) -> u32 {
        3 * self.triangle.0 + self.corner as u32
    }

    fn unpacked(side: u32) -> Option<Self> {
        (side != NONE).then_some(Self { triangle: TriangleId(side / 3), corner: (side % 3) as usize })
    }
}

/// An edge between two nodes, the smaller id first.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Edge {
    /// The two nodes, ascending.
    pub nodes: [VertexId; 2],
    sides: [u32; 2],
}

impl Edge {
    /// The triangle on the left of `nodes[0]` → `nodes[1]`.
    pub fn left(&self) -> Option<TriangleSide> {
        TriangleSide::unpacked(self.sides[0])
    }

    /// The triangle on the right of `nodes[0]` → `nodes[1]`.
    pub fn right(&self) -> Option<TriangleSide> {
        TriangleSide::unpacked(self.sides[1])
    }
}

/// The edges of a mesh, ascending by their nodes.
pub struct EdgeTable {
    edges: Vec<Edge>,
    /// `edges[first[v]..first[v + 1]]` have `v` as their smaller node.
    first: Vec<u32>,
    /// Sides whose place in the table was taken already: a third triangle at an edge, or two sides that run the same
    /// way.
    pub surplus: Vec<TriangleSide>,
    /// Triangles that name a node twice.
    pub collapsed: Vec<TriangleId>,
}

impl EdgeTable {
    /// The edges of `triangles`, whose nodes are below `nodes`. Takes O(n), apart from the sort of each node's few
    /// edges.
    pub fn new(nodes: usize, triangles: &IdVec<TriangleId, [VertexId; 3]>) -> Self {
        let mut start = vec![0u32; nodes + 1];
        let mut collapsed = Vec::new();
        for (id, t) in triangles.enumerate() {
            if t[0] == t[1] || t[1] == t[2] || t[2] == t[0] {
                collapsed.push(id);
            }
            sides_of(t).for_each(|(_, from, to)| start[from.min(to).0 as usize + 1] += 1);
        }
        for v in 0..nodes {
            start[v + 1] += start[v];
        }
        let mut free = start.clone();
        let mut entries = vec![(VertexId(0), 0u32); start[nodes] as usize];
        for (triangle, t) in triangles.enumerate() {
            for (corner, from, to) in sides_of(t) {
                let slot = &mut free[from.min(to).0 as usize];
                entries[*slot as usize] = (from.max(to), TriangleSide { triangle, corner }.packed());
                *slot += 1;
            }
        }
        let mut table =
            Self { edges: Vec::with_capacity(entries.len() / 2), first: vec![0], surplus: Vec::new(), collapsed };
        for v in 0..nodes {
            let bucket = &mut entries[start[v] as usize..start[v + 1] as usize];
            bucket.sort_unstable();
            table.add_bucket(VertexId(v as u32), bucket, triangles);
            table.first.push(table.edges.len() as u32);
        }
        table
    }

    fn add_bucket(&mut self, low: VertexId, bucket: &[(VertexId, u32)], triangles: &IdVec<TriangleId, [VertexId; 3]>) {
        for run in bucket.chunk_by(|a, b| a.0 == b.0) {
            let mut edge = Edge { nodes: [low, run[0].0], sides: [NONE; 2] };
            for &(_, packed) in run {
                let Some(side) = TriangleSide::unpacked(packed) else { continue };
                let forward = triangles[side.triangle][side.corner] == low;
                let place = &mut edge.sides[usize::from(!forward)];
                if *place == NONE {
                    *place = packed;
                } else {
                    self.surplus.push(side);
                }
            }
            self.edges.push(edge);
        }
    }

    /// All edges, ascending by their nodes.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The place of the edge between two nodes in the table; `None` where there is none.
    pub fn find(&self, a: VertexId, b: VertexId) -> Option<usize> {
        let (low, high) = (a.min(b), a.max(b));
        let (start, end) = (self.first[low.0 as usize] as usize, self.first[low.0 as usize + 1] as usize);
        self.edges[start..end].binary_search_by_key(&high, |e| e.nodes[1]).ok().map(|i| start + i)
    }
}

/// Corner, first and last node of each side that has two nodes.
fn sides_of(t: &[VertexId; 3]) -> impl Iterator<Item = (usize, VertexId, VertexId)> + '_ {
    (0..3).map(|i| (i, t[i], t[(i + 1) % 3])).filter(|(_, a, b)| a != b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(list: &[[u32; 3]]) -> IdVec<TriangleId, [VertexId; 3]> {
        list.iter().map(|t| t.map(VertexId)).collect()
    }

    #[test]
    fn two_triangles_share_one_edge_with_both_sides() {
        let table = EdgeTable::new(4, &triangles(&[[0, 1, 2], [0, 2, 3]]));
        assert_eq!(table.edges().len(), 5);
        assert_eq!(table.edges().iter().filter(|e| e.left().is_none() || e.right().is_none()).count(), 4);
        let shared = table.edges()[table.find(VertexId(2), VertexId(0)).unwrap()];
        assert_eq!(shared.left(), Some(TriangleSide { triangle: TriangleId(1), corner: 0 }));
        assert_eq!(shared.right(), Some(TriangleSide { triangle: TriangleId(0), corner: 2 }));
        assert_eq!(table.find(VertexId(1), VertexId(3)), None);
        assert!(table.surplus.is_empty() && table.collapsed.is_empty());
    }

    #[test]
    fn a_third_triangle_a_repeated_one_and_a_collapsed_one_are_told() {
        let third = EdgeTable::new(5, &triangles(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]]));
        assert_eq!(third.surplus, [TriangleSide { triangle: TriangleId(2), corner: 0 }]);
        let twice = EdgeTable::new(3, &triangles(&[[0, 1, 2], [1, 2, 0]]));
        assert_eq!(twice.surplus.len(), 3);
        let collapsed = EdgeTable::new(2, &triangles(&[[0, 0, 1]]));
        assert_eq!(collapsed.collapsed, [TriangleId(0)]);
    }
}
