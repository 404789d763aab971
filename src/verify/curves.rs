//! The mesh along the curves of the domain: nodes on them, chains of edges, chord errors and turnings.

use super::elevation::mids_on_curves;
use super::evidence::{CurvePart, Evidence, is_kept, place};
use super::tally::Tally;
use super::topology::ends_a_region;
use super::{Check, Status};
use crate::curve::Curve;
use crate::domain::Domain;
use crate::geometry::Point;
use crate::geometry::boxes::BoxHierarchy;
use crate::ids::{CurveId, Id, IdVec, PointId, VertexId};

/// Every linked node lies at the point of its curve at its parameter, within the welding distance and rounding. Ends
/// lie exactly on points of P. In a foreign mesh every node at which a region ends lies on some curve. Worst: the
/// largest distance.
pub fn on_curve(ev: &Evidence, domain: &Domain) -> Check {
    let mut tally = Tally::highest("on_curve");
    // A weld moves a curve by at most the tolerance; evaluation and storing round.
    let reach = domain.tolerance() + ev.rounding;
    for part in &ev.parts {
        let curve = &domain.curves()[part.curve];
        for (t, v) in part.t.into_iter().zip(part.nodes) {
            tally.count();
            let at = ev.node(v);
            let away = at.distance(curve.curve.point(t));
            tally.measure(away, at);
            let end = (t == 0.0 || t == 1.0).then(|| curve.ends[usize::from(t == 1.0)]);
            if away.is_nan() || away > reach {
                let c = part.curve.0;
                tally.flaw(|| format!("node {} at {} lies {away} from curve {c} at t = {t}", v.0, place(at)));
            } else if let Some(p) = end.filter(|_| !ev.promise.foreign) {
                exactly(ev, domain, p, v, &mut tally);
            }
        }
    }
    mids_on_curves(ev, domain, reach, &mut tally);
    for &i in &ev.unlinked {
        tally.count();
        tally.flaw(|| format!("{} is listed, but has no place on a curve", ev.tell_edge(ev.mesh.edges[i].nodes)));
    }
    if ev.promise.foreign {
        stray_nodes(ev, domain, &mut tally);
    } else {
        for &(p, v) in &ev.mesh.points {
            tally.count();
            exactly(ev, domain, p, v, &mut tally);
        }
    }
    tally.finish(Status::Proven)
}

fn exactly(ev: &Evidence, domain: &Domain, p: PointId, v: VertexId, tally: &mut Tally) {
    let (is, ought) = (ev.node(v), domain.points()[p]);
    if is != ought {
        tally.flaw(|| format!("node {} at {} is not point {} at {}", v.0, place(is), p.0, place(ought)));
    }
}

/// Reports nodes of edges that end a region, but lie on no curve.
fn stray_nodes(ev: &Evidence, domain: &Domain, tally: &mut Tally) {
    let mut found = vec![false; ev.mesh.nodes.len()];
    ev.parts.iter().flat_map(|p| p.nodes).for_each(|v| found[v.index()] = true);
    let hierarchy = BoxHierarchy::new(domain.curves().iter().map(|c| c.curve.bounds()));
    for v in ev.edges.edges().iter().filter(|e| ends_a_region(ev, e)).flat_map(|e| e.nodes) {
        if std::mem::replace(&mut found[v.index()], true) {
            continue;
        }
        tally.count();
        let at = ev.node(v);
        let curve = |i: usize| &domain.curves()[CurveId::from_index(i)].curve;
        let nearest = hierarchy.nearest(at, f64::INFINITY, |i, _| curve(i).nearest(at, 0.0, 1.0).1);
        let away = nearest.map_or(f64::INFINITY, |(_, d)| d);
        tally.measure(away, at);
        tally.flaw(|| format!("node {} at {} ends a region, but lies {away} from the nearest curve", v.0, place(at)));
    }
}

/// Every curve with a kept side is one chain of edges from its first point to its last: with ascending parameters,
/// without a gap, in one group. Checked: curves.
///
/// ```text
///    p ●───────●───────●───────● q      nodes[0] of the first part is p, at t[0] = 0
///      0      t₁      t₂       1        t[1] and nodes[1] of a part are t[0] and nodes[0] of the next
///                                       nodes[1] of the last part is q, at t[1] = 1
/// ```
pub fn curve_chain(ev: &Evidence, domain: &Domain) -> Check {
    let mut tally = Tally::highest("curve_chain");
    let node = ev.nodes_of_points(domain);
    let mut seen: IdVec<CurveId, bool> = vec![false; domain.curves().len()].into();
    for chain in ev.parts.chunk_by(|a, b| a.curve == b.curve) {
        tally.count();
        let id = chain[0].curve;
        let again = std::mem::replace(&mut seen[id], true);
        let ends = domain.curves()[id].ends.map(|p| node[p]);
        let flaw = if again { Some("comes in two groups".to_owned()) } else { gap_in(ev, chain, ends) };
        if let Some(flaw) = flaw {
            tally.flaw(|| format!("the chain of curve {} {flaw}", id.0));
        }
    }
    for (id, curve) in domain.curves().enumerate().filter(|(id, c)| !seen[*id] && is_kept(c.sides)) {
        tally.count();
        tally.flaw(|| format!("curve {} from {} has no edges", id.0, place(curve.curve.start())));
    }
    tally.finish(Status::Proven)
}

/// Why `chain` does not lead from one end to the other; `None` where it does.
fn gap_in(ev: &Evidence, chain: &[CurvePart], ends: [Option<VertexId>; 2]) -> Option<String> {
    let (first, last) = (chain.first()?, chain.last()?);
    let at = |v: VertexId| place(ev.node(v));
    if first.t[0] != 0.0 || Some(first.nodes[0]) != ends[0] {
        return Some(format!("begins at t = {}, node {} at {}", first.t[0], first.nodes[0].0, at(first.nodes[0])));
    }
    if last.t[1] != 1.0 || Some(last.nodes[1]) != ends[1] {
        return Some(format!("finishes at t = {}, node {} at {}", last.t[1], last.nodes[1].0, at(last.nodes[1])));
    }
    if let Some(back) = chain.iter().find(|p| p.t[0] >= p.t[1]) {
        return Some(format!("does not ascend: t = {:?} along {}", back.t, ev.tell_edge(back.nodes)));
    }
    let torn = chain.windows(2).find(|w| w[0].t[1] != w[1].t[0] || w[0].nodes[1] != w[1].nodes[0])?;
    Some(format!("has a gap after t = {}, node {} at {}", torn[0].t[1], torn[0].nodes[1].0, at(torn[0].nodes[1])))
}

/// If asked for: no curve is farther from its edge than the limit.
pub fn chord_error(ev: &Evidence, domain: &Domain) -> Check {
    // Evaluating the curve and its chord rounds.
    let limit = ev.promise.sizing.chord_error.map(|limit| limit * (1.0 + MEASURED_TWICE) + ev.rounding);
    along_pieces(ev, domain, "chord_error", limit, "lies", Curve::chord_error)
}

/// If asked for: along no edge its curve turns more than the limit. Radians.
pub fn edge_turning(ev: &Evidence, domain: &Domain) -> Check {
    let limit = ev.promise.sizing.edge_turning_rad.map(|limit| limit * (1.0 + MEASURED_TWICE));
    along_pieces(ev, domain, "edge_turning", limit, "turns", Curve::turning)
}

/// Equal cuts of a curve are found by iteration and stored as rounded parameters. 1e-9 of the limit is far above both
/// errors, and too small to matter.
const MEASURED_TWICE: f64 = 1e-9;

fn along_pieces(
    ev: &Evidence,
    domain: &Domain,
    name: &'static str,
    limit: Option<f64>,
    verb: &str,
    measure: impl Fn(&Curve, f64, f64) -> f64,
) -> Check {
    let Some(limit) = limit else { return Check::not_asked(name) };
    let mut tally = Tally::highest(name);
    for part in &ev.parts {
        tally.count();
        let (t0, t1) = part.range();
        let value = if t0 < t1 { measure(&domain.curves()[part.curve].curve, t0, t1) } else { 0.0 };
        let at: Point = ev.middle(part.nodes);
        tally.measure(value, at);
        if value.is_nan() || value > limit {
            tally.flaw(|| format!("curve {} {verb} {value} along {}", part.curve.0, ev.tell_edge(part.nodes)));
        }
    }
    tally.finish(Status::Proven)
}
