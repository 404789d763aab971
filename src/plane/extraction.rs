//! Extraction of the mesh: the kept triangles, those with a region, as plain data.

use super::insert::Kernel;
use super::subcurves::{Carrier, Subcurves};
use crate::domain::Domain;
use crate::geometry::{Point, order};
use crate::ids::{CurveId, IdVec, SubcurveId, TriangleId, VertexId};
use crate::mesh::{CurveEdge, CurveLink, Mesh};

/// The sources of a mesh. Vertices 0, 1, … of the triangulation are the points of the domain.
pub struct Extraction<'a> {
    /// The domain that was meshed.
    pub domain: &'a Domain,
    /// The triangulation, with regions.
    pub delaunay: &'a Kernel,
    /// C′; each is an edge of the triangulation.
    pub subcurves: &'a Subcurves,
}

impl Extraction<'_> {
    /// The kept triangles as plain data. Nodes are numbered along a Hilbert curve, triangles by their nodes. So
    /// neighbours in the plane are neighbours in memory, and files compress better.
    pub fn mesh(&self) -> Mesh {
        let topology = self.delaunay.topology();
        let kept: Vec<TriangleId> = topology.triangles().filter(|&t| topology.region(t).is_some()).collect();
        let mut mesh = Mesh { names: self.domain.names().clone(), ..Mesh::default() };
        let node_of = self.nodes(&kept, &mut mesh);
        let corners = |t: TriangleId| topology.corners(t).map(|v| node_of[v].expect("corners are nodes"));
        let mut kept: Vec<(VertexId, TriangleId)> =
            kept.into_iter().map(|t| (corners(t).into_iter().min().expect("three corners"), t)).collect();
        kept.sort_unstable();
        for (_, t) in kept {
            mesh.triangles.push(corners(t));
            mesh.triangle_regions.push(topology.region(t).expect("only kept triangles"));
        }
        mesh.regions = self.domain.regions().iter().map(|r| r.name).collect();
        mesh.colours = self.domain.colours().clone();
        mesh.edges = self.curve_edges(&node_of);
        mesh.points = self.domain.points().ids().filter_map(|p| Some((p, node_of[VertexId(p.0)]?))).collect();
        mesh
    }

    /// Makes the corners of the kept triangles nodes of the mesh. Returns the node of each vertex.
    fn nodes(&self, kept: &[TriangleId], mesh: &mut Mesh) -> IdVec<VertexId, Option<VertexId>> {
        let topology = self.delaunay.topology();
        let mut node_of: IdVec<VertexId, Option<VertexId>> = vec![None; self.delaunay.points().len()].into();
        kept.iter().flat_map(|&t| topology.corners(t)).for_each(|v| node_of[v] = Some(v));
        let used: Vec<VertexId> = node_of.iter().filter_map(|&v| v).collect();
        let points: Vec<Point> = used.iter().map(|&v| self.delaunay.point(v)).collect();
        for i in order::hilbert(&points) {
            node_of[used[i as usize]] = Some(mesh.nodes.push(points[i as usize]));
        }
        node_of
    }

    /// The subcurves of curves with a kept region on a side, by curve and in order along it.
    fn curve_edges(&self, node_of: &IdVec<VertexId, Option<VertexId>>) -> Vec<CurveEdge> {
        let mut subcurves: Vec<(CurveId, f64, SubcurveId)> = self
            .subcurves
            .ids()
            .filter_map(|id| match self.subcurves.get(id) {
                subcurve if subcurve.is_gone() => None,
                subcurve => match subcurve.carrier {
                    Carrier::Curve(curve) => Some((curve, subcurve.t[0], id)),
                    Carrier::Arc(..) => None,
                },
            })
            .collect();
        subcurves.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        subcurves
            .into_iter()
            .filter(|&(curve, ..)| self.domain.curves()[curve].sides.iter().any(Option::is_some))
            .map(|(curve, _, id)| {
                let subcurve = self.subcurves.get(id);
                CurveEdge {
                    nodes: subcurve.ends.map(|v| node_of[v].expect("an edge of a kept triangle")),
                    name: self.domain.curves()[curve].name,
                    link: Some(CurveLink { curve, t: subcurve.t }),
                }
            })
            .collect()
    }
}
