//! The evidence: what the verifier derives from mesh and domain before it checks anything.

use super::edges::EdgeTable;
use crate::domain::Domain;
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::{self, Point, Rect};
use crate::ids::{CurveId, Id, IdVec, NameId, PointId, RegionId, TriangleId, VertexId};
use crate::mesh::{Mesh, RIM_ROUNDING};
use crate::promise::Promise;
use std::collections::BTreeSet;

/// The part of a curve that a mesh edge approximates.
#[derive(Clone, Copy, Debug)]
pub struct CurvePart {
    /// The curve of the domain.
    pub curve: CurveId,
    /// Parameters of the two nodes, within 0..1; ascending in a mesh that passes `curve_chain`.
    pub t: [f64; 2],
    /// The end nodes, in the direction of the curve.
    pub nodes: [VertexId; 2],
    /// Place of the edge in the edge table, where the mesh has it.
    pub edge: Option<usize>,
    /// Name that the mesh gives the edge; `None` where the mesh lists no such edge.
    pub name: Option<NameId>,
}

impl CurvePart {
    /// The parameters, ascending.
    pub fn range(&self) -> (f64, f64) {
        (self.t[0].min(self.t[1]), self.t[0].max(self.t[1]))
    }
}

/// A mesh and a domain, with what all checks need of them.
pub struct Evidence<'a> {
    /// The domain, where it is known.
    pub domain: Option<&'a Domain>,
    /// The mesh to verify.
    pub mesh: &'a Mesh,
    /// The guarantees to verify.
    pub promise: &'a Promise,
    /// By node: whether it is no corner, but lies within an edge of order 2.
    pub within: IdVec<VertexId, bool>,
    /// The nodes multiplied by a power of two to unit magnitude, for exact signs.
    pub signs: IdVec<VertexId, Point>,
    /// All edges of the mesh.
    pub edges: EdgeTable,
    /// Parts of curves in the mesh's order; in a foreign mesh as the verifier found them, by curve and parameter.
    pub parts: Vec<CurvePart>,
    /// Listed edges without a link, or with a parameter outside 0..1.
    pub unlinked: Vec<usize>,
    /// The classes of regions.
    pub classes: Classes,
    /// Four units in the last place of the largest coordinate: a point that is rounded to `f64` a few times moves no
    /// farther.
    pub rounding: f64,
    /// How far rounding may move a node off the rim of a ball.
    pub rim: f64,
}

impl<'a> Evidence<'a> {
    /// The evidence of a mesh that has no `unreadable` flaws.
    pub fn gather(domain: Option<&'a Domain>, mesh: &'a Mesh, promise: &'a Promise) -> Self {
        let of_domain = domain.filter(|d| !d.points().is_empty()).map_or(0.0, |d| geometry::magnitude(d.bounds()));
        let magnitude = geometry::bounds_of(mesh.nodes.iter().copied()).map_or(0.0, geometry::magnitude).max(of_domain);
        let factor = geometry::unit_scale(magnitude);
        let edges = EdgeTable::new(mesh.nodes.len(), &mesh.triangles);
        // An ulp of a number in [2^e, 2^(e+1)) is ε·2^e; ε times the magnitude is one to two of them.
        let rounding = 4.0 * f64::EPSILON * magnitude;
        let mut within: IdVec<VertexId, bool> = vec![false; mesh.nodes.len()].into();
        mesh.triangle_mids.iter().flatten().for_each(|&v| within[v] = true);
        let (mut parts, unlinked) = match domain {
            Some(domain) if promise.foreign => {
                (recovered(domain, mesh, &within, domain.tolerance() + rounding), Vec::new())
            }
            Some(_) => linked(mesh),
            None => (Vec::new(), Vec::new()),
        };
        for part in &mut parts {
            part.edge = edges.find(part.nodes[0], part.nodes[1]);
        }
        Self {
            domain,
            mesh,
            promise,
            within,
            signs: mesh.nodes.iter().map(|&p| geometry::scaled(p, factor)).collect(),
            edges,
            parts,
            unlinked,
            classes: Classes::of(domain, mesh, promise.foreign),
            rounding,
            rim: RIM_ROUNDING * magnitude,
        }
    }

    /// The coordinates of a node, as in the mesh.
    pub fn node(&self, v: VertexId) -> Point {
        self.mesh.nodes[v]
    }

    /// The middle between two nodes.
    pub fn middle(&self, nodes: [VertexId; 2]) -> Point {
        self.node(nodes[0]).midpoint(self.node(nodes[1]))
    }

    /// The centroid of a triangle.
    pub fn centroid(&self, t: TriangleId) -> Point {
        let [a, b, c] = self.mesh.corners(t);
        a + ((b - a) + (c - a)) / 3.0
    }

    /// The class of a triangle's region.
    pub fn class(&self, t: TriangleId) -> u32 {
        self.classes.of_mesh[self.mesh.triangle_regions[t]]
    }

    /// The node of each point of P: as listed, or (foreign) as found on the curves.
    pub fn nodes_of_points(&self, domain: &Domain) -> IdVec<PointId, Option<VertexId>> {
        let mut node: IdVec<PointId, Option<VertexId>> = vec![None; domain.points().len()].into();
        for &(p, v) in &self.mesh.points {
            node[p] = Some(v);
        }
        if self.promise.foreign {
            for part in &self.parts {
                let ends = domain.curves()[part.curve].ends;
                for (t, v) in part.t.into_iter().zip(part.nodes) {
                    if t == 0.0 || t == 1.0 {
                        node[ends[usize::from(t == 1.0)]] = Some(v);
                    }
                }
            }
        }
        node
    }

    /// "triangle 7 (0 1 2) at (x, y)".
    pub fn tell(&self, t: TriangleId) -> String {
        let [a, b, c] = self.mesh.triangles[t].map(|v| v.0);
        format!("triangle {} ({a} {b} {c}) at {}", t.0, place(self.centroid(t)))
    }

    /// "edge 3–4 at (x, y)".
    pub fn tell_edge(&self, nodes: [VertexId; 2]) -> String {
        format!("edge {}–{} at {}", nodes[0].0, nodes[1].0, place(self.middle(nodes)))
    }
}

/// A place as text: "(x, y)".
pub fn place(p: Point) -> String {
    format!("({}, {})", p.x, p.y)
}

/// Regions of one name are one class, since a name is all that a mesh file keeps of a region.
pub struct Classes {
    /// The name of each class.
    pub names: Vec<String>,
    /// The class of each region of the mesh.
    pub of_mesh: IdVec<RegionId, u32>,
    /// The class of each region of the domain.
    pub of_domain: IdVec<RegionId, u32>,
}

impl Classes {
    fn of(domain: Option<&Domain>, mesh: &Mesh, foreign: bool) -> Self {
        let in_mesh: Vec<&str> = mesh.regions.iter().map(|&n| mesh.names.text(n)).collect();
        let in_domain: Vec<&str> = domain.map_or(Vec::new(), |d| d.regions().iter().map(|r| d.name(r.name)).collect());
        let mut names: Vec<&str> = in_mesh.iter().chain(&in_domain).copied().collect();
        names.sort_unstable();
        names.dedup();
        // A mesh file of a format without names: all its regions are one class, since nothing else could be compared.
        let known: BTreeSet<&str> = in_domain.iter().copied().collect();
        let unknown = |n: &&str| !known.contains(n);
        let nameless = foreign && in_mesh.iter().any(unknown);
        let class = |n: &&str| if nameless { 0 } else { names.binary_search(n).unwrap_or(0) as u32 };
        let (of_mesh, of_domain) = (in_mesh.iter().map(class).collect(), in_domain.iter().map(class).collect());
        let names =
            if nameless { vec!["the whole mesh".into()] } else { names.iter().map(|&n| n.to_owned()).collect() };
        Self { names, of_mesh, of_domain }
    }
}

/// The mesh's own links, and the listed edges that have none within 0..1.
fn linked(mesh: &Mesh) -> (Vec<CurvePart>, Vec<usize>) {
    let (mut parts, mut unlinked) = (Vec::with_capacity(mesh.edges.len()), Vec::new());
    for (i, edge) in mesh.edges.iter().enumerate() {
        match edge.link {
            Some(link) if link.t.iter().all(|t| (0.0..=1.0).contains(t)) => {
                let name = Some(edge.name);
                parts.push(CurvePart { curve: link.curve, t: link.t, nodes: edge.nodes, edge: None, name });
            }
            _ => unlinked.push(i),
        }
    }
    (parts, unlinked)
}

/// Boxes per curve in the search for nodes on curves. A mesh has many nodes near few curves, and small boxes exclude
/// most of them.
const SEARCH_PARTS: usize = 16;

/// Parts of the kept curves between consecutive corners of cells that lie on them, within `reach`.
fn recovered(domain: &Domain, mesh: &Mesh, within: &IdVec<VertexId, bool>, reach: f64) -> Vec<CurvePart> {
    let kept: Vec<CurveId> = domain.curves().enumerate().filter(|(_, c)| is_kept(c.sides)).map(|(id, _)| id).collect();
    let range = |part: usize| {
        let (k, n) = (part % SEARCH_PARTS, SEARCH_PARTS as f64);
        (kept[part / SEARCH_PARTS], k as f64 / n, (k + 1) as f64 / n)
    };
    let boxes = (0..kept.len() * SEARCH_PARTS).map(|part| {
        let (curve, t0, t1) = range(part);
        domain.curves()[curve].curve.bounds_of(t0, t1).inflate(reach, reach)
    });
    let hierarchy = BoxHierarchy::new(boxes);
    let mut found: Vec<(CurveId, f64, VertexId)> = Vec::new();
    for (v, &p) in mesh.nodes.enumerate().filter(|(v, _)| !within[*v]) {
        hierarchy.meeting(Rect::from_points(p, p), |part| {
            let (id, t0, t1) = range(part);
            let curve = &domain.curves()[id].curve;
            let (t, away) = curve.nearest(p, t0, t1);
            if p.distance(curve.start()) <= reach {
                found.push((id, 0.0, v));
            } else if p.distance(curve.end()) <= reach {
                found.push((id, 1.0, v));
            } else if away <= reach {
                found.push((id, t, v));
            }
            true
        });
    }
    found.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.2.cmp(&b.2)).then(a.1.total_cmp(&b.1)));
    found.dedup_by_key(|f| (f.0, f.2)); // a node between two boxes is found in both
    found.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
    let listed = ListedNames::of(mesh);
    let pairs = found.windows(2).filter(|w| w[0].0 == w[1].0);
    pairs
        .map(|w| {
            let nodes = [w[0].2, w[1].2];
            CurvePart { curve: w[0].0, t: [w[0].1, w[1].1], nodes, edge: None, name: listed.name(nodes) }
        })
        .collect()
}

/// Whether a curve with these regions on its sides is in the mesh: one of them is kept.
pub fn is_kept(sides: [Option<RegionId>; 2]) -> bool {
    sides.iter().any(Option::is_some)
}

/// Names of the listed edges, by their nodes.
struct ListedNames(Vec<([VertexId; 2], NameId)>);

impl ListedNames {
    fn of(mesh: &Mesh) -> Self {
        let ascending = |[a, b]: [VertexId; 2]| [a.min(b), a.max(b)];
        let mut list: Vec<_> = mesh.edges.iter().map(|e| (ascending(e.nodes), e.name)).collect();
        list.sort_unstable();
        Self(list)
    }

    fn name(&self, [a, b]: [VertexId; 2]) -> Option<NameId> {
        let key = [a.min(b), a.max(b)];
        self.0.binary_search_by_key(&key, |l| l.0).ok().map(|i| self.0[i].1)
    }
}

/// Flaws that exclude a check: ids that do not exist and coordinates that are not finite, as sentences. Empty for a
/// mesh that can be verified.
pub fn unreadable(domain: Option<&Domain>, mesh: &Mesh) -> Vec<String> {
    let mut flaws = Vec::new();
    // Sides of triangles are numbered in u32, and one value is reserved.
    if mesh.triangles.len() >= u32::MAX as usize / 3 {
        flaws.push(format!("{} triangles are more than can be judged", mesh.triangles.len()));
    }
    if mesh.triangle_regions.len() != mesh.triangles.len() {
        flaws.push(format!(
            "{} triangles, but {} of them have a region",
            mesh.triangles.len(),
            mesh.triangle_regions.len()
        ));
    }
    let names = mesh.names.iter().count();
    let leads = |v: VertexId| v.index() < mesh.nodes.len();
    let mut demand = |holds: bool, sentence: &dyn Fn() -> String| {
        if !holds {
            flaws.push(sentence());
        }
    };
    for (v, p) in mesh.nodes.enumerate() {
        demand(p.is_finite(), &|| format!("node {} is at {}", v.0, place(*p)));
    }
    for (t, corners) in mesh.triangles.enumerate() {
        demand(corners.iter().all(|&v| leads(v)), &|| format!("triangle {} names a node that does not exist", t.0));
    }
    for (t, region) in mesh.triangle_regions.enumerate() {
        demand(region.index() < mesh.regions.len(), &|| format!("triangle {} is of an unknown region", t.0));
    }
    for (r, name) in mesh.regions.enumerate() {
        demand(name.index() < names, &|| format!("region {} has an unknown name", r.0));
    }
    let curves = domain.map_or(usize::MAX, |d| d.curves().len());
    for (i, e) in mesh.edges.iter().enumerate() {
        let known = e.nodes.iter().all(|&v| leads(v)) && e.name.index() < names;
        demand(known, &|| format!("listed edge {i} has an unknown node or name"));
        demand(e.link.is_none_or(|l| l.curve.index() < curves), &|| {
            format!("listed edge {i} lies on an unknown curve")
        });
    }
    let points = domain.map_or(usize::MAX, |d| d.points().len());
    let known = |p: PointId| p.index() < points;
    for (i, &(p, v)) in mesh.points.iter().enumerate() {
        demand(known(p) && leads(v), &|| format!("listed point {i} is an unknown point or node"));
    }
    for (i, ball) in mesh.balls.iter().enumerate() {
        demand(known(ball.corner), &|| format!("ball {i} is around an unknown point"));
    }
    flaws
}
