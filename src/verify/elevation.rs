//! Order 2: cells are valid, and nodes within edges lie on the curves.

use super::evidence::{Evidence, place};
use super::tally::Tally;
use super::{Check, Status};
use crate::domain::Domain;
use crate::mesh::{Mesh, quality};

/// Order 2: the Jacobian determinant of every cell is positive throughout, by Bézier bounds, and cells that share an
/// edge share the node within it. Checked: cells and edges.
pub fn jacobian(ev: &Evidence) -> Check {
    if ev.mesh.order() == 1 {
        return Check::not_asked("jacobian");
    }
    let mut tally = Tally::highest("jacobian");
    for t in ev.mesh.triangles.ids() {
        tally.count();
        if !quality::is_valid(ev.mesh, t) {
            tally.flaw(|| format!("{} is folded by its nodes of order 2", ev.tell(t)));
        }
    }
    for edge in ev.edges.edges() {
        tally.count();
        let mid = |side: super::edges::TriangleSide| ev.mesh.triangle_mids[side.triangle][side.corner];
        let [left, right] = [edge.left(), edge.right()].map(|side| side.map(mid));
        if left.is_some() && right.is_some() && left != right {
            tally.flaw(|| format!("{} has another node within it on either side", ev.tell_edge(edge.nodes)));
        }
    }
    tally.finish(Status::Proven)
}

/// Order 2: the node within each linked edge lies on its curve between the ends of the edge. A node in the middle of
/// the chord is exempt: the side was straightened, and is listed. Adds to the check `on_curve`.
pub fn mids_on_curves(ev: &Evidence, domain: &Domain, reach: f64, tally: &mut Tally) {
    for (edge, &mid) in ev.mesh.edges.iter().zip(&ev.mesh.edge_mids) {
        let Some(link) = edge.link else { continue };
        let at = ev.node(mid);
        let [t0, t1] = [link.t[0].min(link.t[1]), link.t[0].max(link.t[1])];
        let (_, away) = domain.curves()[link.curve].curve.nearest(at, t0, t1);
        if away > reach && at.distance(ev.middle(edge.nodes)) <= ev.rounding {
            tally.exempt();
            continue;
        }
        tally.count();
        tally.measure(away, at);
        if away.is_nan() || away > reach {
            tally.flaw(|| format!("node {} at {} within an edge lies {away} from its curve", mid.0, place(at)));
        }
    }
}

/// The flaws of lists of order 2 whose lengths or ids do not fit the mesh, as sentences.
pub fn unreadable(mesh: &Mesh) -> Vec<String> {
    let mut flaws = Vec::new();
    if mesh.order() == 1 {
        return flaws;
    }
    let lists = [("triangles", mesh.triangles.len(), mesh.triangle_mids.len())];
    for (what, cells, mids) in lists.into_iter().chain([("listed edges", mesh.edges.len(), mesh.edge_mids.len())]) {
        if cells != mids {
            flaws.push(format!("{cells} {what}, but {mids} of them have nodes of order 2"));
        }
    }
    let leads = |v: &&crate::ids::VertexId| mesh.nodes.get(**v).is_none();
    let stray = mesh.triangle_mids.iter().flatten().chain(&mesh.edge_mids).filter(leads).count();
    if stray > 0 {
        flaws.push(format!("{stray} nodes within edges do not exist"));
    }
    flaws
}
