//! The mesh of what is material, as plain data.

use super::tetrahedra::Face;
use super::{Complex, Fault};
use crate::ids::{Id, IdVec, NameId, Names, TetId, VertexId};
use crate::mesh::solid::{FacetTriangle, SegmentEdge, SolidMesh};
use std::collections::BTreeSet;

/// Name of a facet that the input does not name.
const UNNAMED: &str = "facet";

impl Complex<'_> {
    /// Tetrahedra of a region, their nodes in the order of insertion, facets and segments that bound or lie in them.
    pub(super) fn mesh(mut self) -> Result<SolidMesh, Fault> {
        let regions = self.regions()?;
        let net = &self.kernel.net;
        let kept: Vec<(TetId, crate::ids::RegionId)> =
            net.tets().filter_map(|t| Some((t, regions.of[t.index()]?))).collect();
        let mut mesh = SolidMesh { names: self.solid.names().clone(), ..SolidMesh::default() };
        mesh.unit = self.solid.unit().map(str::to_owned);
        mesh.regions = regions.names.iter().map(|name| mesh.names.intern(name)).collect();
        let mut is_used = vec![false; net.points.len()];
        kept.iter().flat_map(|&(t, _)| net.corners(t)).for_each(|v| is_used[v.index()] = true);
        let mut node_of: IdVec<VertexId, Option<VertexId>> = vec![None; net.points.len()].into();
        for v in net.points.ids().filter(|v| is_used[v.index()]) {
            node_of[v] = Some(mesh.nodes.push(net.points[v].map(|x| x / self.factor)));
            mesh.weights.push(net.weights[v] / (self.factor * self.factor));
        }
        let node = |v: VertexId| node_of[v].expect("a corner of a kept tetrahedron");
        for &(t, region) in &kept {
            mesh.tetrahedra.push(net.corners(t).map(node));
            mesh.tetrahedron_regions.push(region);
        }
        mesh.points = self.vertex_of.enumerate().filter_map(|(point, &v)| Some((point, node_of[v]?))).collect();
        mesh.triangles = self.facet_triangles(&kept, &mut mesh.names, node);
        mesh.edges = self.segment_edges(&kept, node);
        Ok(mesh)
    }

    /// The triangles on facets that a kept tetrahedron has, by facet.
    fn facet_triangles(
        &self,
        kept: &[(TetId, crate::ids::RegionId)],
        names: &mut Names,
        node: impl Fn(VertexId) -> VertexId,
    ) -> Vec<FacetTriangle> {
        let net = &self.kernel.net;
        let unnamed: NameId = names.intern(UNNAMED);
        let faces = kept.iter().flat_map(|&(t, _)| (0..4).map(move |i| Face::of(t, i)));
        let on_facets = faces.filter(|&f| net.facet(f).is_some()).map(|f| super::facets::sorted(net.triangle(f)));
        let on_facets: BTreeSet<[VertexId; 3]> = on_facets.collect();
        let mut triangles: Vec<FacetTriangle> = on_facets
            .iter()
            .map(|sorted| {
                let (facet, corners) = self.triangles[sorted];
                let name = self.solid.facets()[facet].name.unwrap_or(unnamed);
                FacetTriangle { nodes: corners.map(&node), name, facet: Some(facet) }
            })
            .collect();
        triangles.sort_by_key(|triangle| triangle.facet);
        triangles
    }

    /// The edges of segments that a kept tetrahedron has, by segment and along it.
    fn segment_edges(
        &self,
        kept: &[(TetId, crate::ids::RegionId)],
        node: impl Fn(VertexId) -> VertexId,
    ) -> Vec<SegmentEdge> {
        let pairs = |&(t, _): &(TetId, crate::ids::RegionId)| {
            let c = self.kernel.net.corners(t);
            [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]].map(|[i, j]: [usize; 2]| [c[i].min(c[j]), c[i].max(c[j])])
        };
        let there: BTreeSet<[VertexId; 2]> = kept.iter().flat_map(pairs).collect();
        let mut edges = Vec::new();
        for (segment, chain) in self.chains.enumerate() {
            for pair in chain.windows(2).filter(|p| there.contains(&[p[0].min(p[1]), p[0].max(p[1])])) {
                let nodes = [node(pair[0]), node(pair[1])];
                edges.push(SegmentEdge { nodes, name: self.solid.segments()[segment].name, segment: Some(segment) });
            }
        }
        edges
    }
}
