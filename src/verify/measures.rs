//! Sizes, areas and names.

use super::evidence::{CurvePart, Evidence, is_kept};
use super::tally::Tally;
use super::{Check, Status};
use crate::domain::Domain;
use crate::geometry::Point;
use crate::ids::{Id, NameId, RegionId, VertexId};
use crate::mesh::quality;
use crate::size::{SizeField, Source};
use std::collections::BTreeSet;

/// A length is measured from rounded coordinates: its error is a few ε, and 1e-12 is thousands of ε.
const MEASURED: f64 = 1.0 + 1e-12;

/// If asked for: no cell exceeds a limit. Edges are checked against `max_edge` and the sources, areas against
/// `max_area` and the limits of regions. Checked: triangles and listed edges. Worst: the largest ratio of a size to its
/// limit.
pub fn size(ev: &Evidence) -> Check {
    let limits = Limits::of(ev);
    if !limits.any() {
        return Check::not_asked("size");
    }
    let mut tally = Tally::highest("size");
    for t in ev.mesh.triangles.ids() {
        tally.count();
        let corners = ev.mesh.corners(t);
        let region = ev.mesh.triangle_regions[t];
        let excess = limits.excess_of_triangle(corners, region);
        tally.measure(excess, corners[0]);
        if excess > MEASURED {
            tally.flaw(|| format!("{} is {excess} times as large as asked for", ev.tell(t)));
        }
    }
    for edge in &ev.mesh.edges {
        tally.count();
        let [a, b] = edge.nodes.map(|v| ev.node(v));
        let excess = a.distance(b) / limits.boundary[edge.name.index()];
        tally.measure(excess, a);
        if excess > MEASURED {
            tally.flaw(|| format!("{} is {excess} times as long as asked for", ev.tell_edge(edge.nodes)));
        }
    }
    tally.finish(Status::Proven)
}

/// All limits, by region and boundary; infinite where there is none.
struct Limits {
    /// Longest edge and largest area by region of the mesh.
    region: Vec<(f64, f64)>,
    /// Longest edge by name.
    boundary: Vec<f64>,
    /// The sources by place; they come with a domain.
    near: Option<SizeField>,
}

impl Limits {
    fn of(ev: &Evidence) -> Self {
        let sizing = &ev.promise.sizing;
        let (edge, area) = (sizing.max_edge.unwrap_or(f64::INFINITY), sizing.max_area.unwrap_or(f64::INFINITY));
        let names: Vec<NameId> = ev.mesh.names.iter().map(|(id, _)| id).collect();
        let mut limits = Self {
            region: vec![(edge, area); ev.mesh.regions.len()],
            boundary: vec![f64::INFINITY; names.len()],
            near: ev.domain.map(|domain| SizeField::new(sizing, domain)).filter(SizeField::limits_by_place),
        };
        for source in &sizing.sources {
            limits.add(ev, source);
        }
        if let Some(domain) = ev.domain {
            limits.add_areas_of_regions(ev, domain);
        }
        limits
    }

    fn add(&mut self, ev: &Evidence, source: &Source) {
        match source {
            Source::Boundary { name, edge } => {
                if let Some(id) = ev.mesh.names.find(name) {
                    self.boundary[id.index()] = self.boundary[id.index()].min(*edge);
                }
            }
            Source::Region { name, edge } => {
                for (limit, id) in self.region.iter_mut().zip(ev.mesh.regions.iter()) {
                    if ev.mesh.names.text(*id) == name {
                        limit.0 = limit.0.min(*edge);
                    }
                }
            }
            Source::Near { .. } => {}
        }
    }

    /// Adds the area limits of the drawing. Of several regions of one name, the largest limit counts.
    fn add_areas_of_regions(&mut self, ev: &Evidence, domain: &Domain) {
        let mut largest: Vec<Option<f64>> = vec![None; ev.classes.names.len()];
        for (id, region) in domain.regions().enumerate() {
            let limit = &mut largest[ev.classes.of_domain[id] as usize];
            let own = region.max_area.unwrap_or(f64::INFINITY);
            *limit = Some(limit.map_or(own, |other| own.max(other)));
        }
        for (limit, &class) in self.region.iter_mut().zip(ev.classes.of_mesh.iter()) {
            limit.1 = limit.1.min(largest[class as usize].unwrap_or(f64::INFINITY));
        }
    }

    fn any(&self) -> bool {
        let asked = |v: f64| v < f64::INFINITY;
        self.region.iter().any(|r| asked(r.0) || asked(r.1))
            || self.boundary.iter().any(|&b| asked(b))
            || self.near.is_some()
    }

    /// The triangle's size over its tightest limit.
    fn excess_of_triangle(&self, corners: [Point; 3], region: RegionId) -> f64 {
        let [a, b, c] = corners;
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let (edge, area) = self.region[region.index()];
        let centroid = a + ((b - a) + (c - a)) / 3.0;
        let near = self.near.as_ref().map_or(edge, |field| field.limit_at(centroid).min(edge));
        (longest / near).max(quality::area(corners) / area)
    }
}

/// For every region name: the area of the triangles and the area between chords and curves add up to the area that the
/// curves enclose. Checked: region names. Worst: the largest difference.
///
/// ```text
///        .-───-.
///      .´ lens  `.          lens: the area between a curve and its chords, negative where the curve bends inwards
///     ●───────────●
///     │ triangles │         triangles + lenses = asked, the exact area of the region, by the integral along its curves
///     ●───────────●
/// ```
pub fn area(ev: &Evidence, domain: &Domain) -> Check {
    let mut tally = Tally::highest("area");
    let mut sums = vec![Sums::default(); ev.classes.names.len()];
    for t in ev.mesh.triangles.ids() {
        sums[ev.class(t) as usize].triangles += quality::area(ev.mesh.corners(t));
    }
    for (id, region) in domain.regions().enumerate() {
        sums[ev.classes.of_domain[id] as usize].asked += region.area;
    }
    add_lenses(ev, domain, &mut sums);
    let bounds = domain.bounds();
    for (name, sum) in ev.classes.names.iter().zip(sums) {
        tally.count();
        let off = (sum.triangles + sum.lenses - sum.asked).abs();
        tally.measure(off, bounds.center());
        // Sums of a million rounded terms have an error of at most about 1e-9 of the area of the box. A rim moved by
        // welding or rounding sweeps its length times that distance.
        let slack = 1e-9 * bounds.area() + (domain.tolerance() + ev.rounding) * sum.rim;
        if off.is_nan() || off > slack {
            let (has, asked) = (sum.triangles + sum.lenses, sum.asked);
            tally.flaw(|| format!("\"{name}\" covers {has} with its curves, but they enclose {asked}"));
        }
    }
    tally.finish(Status::Proven)
}

#[derive(Clone, Default)]
struct Sums {
    triangles: f64,
    /// Between chords and curves: positive where the curve bulges out of the triangles.
    lenses: f64,
    asked: f64,
    rim: f64,
}

/// Adds the signed area between each curve and its chords to the region on its left, and subtracts it from the region
/// on its right.
fn add_lenses(ev: &Evidence, domain: &Domain, sums: &mut [Sums]) {
    let side = |curve: usize, side: usize| {
        domain.curves().as_slice()[curve].sides[side].map(|r| ev.classes.of_domain[r] as usize)
    };
    for (id, curve) in domain.curves().enumerate().filter(|(_, c)| is_kept(c.sides)) {
        // Relative to the start of the curve, so that an offset loses no digits.
        let area = curve.curve.signed_area(curve.curve.start());
        let length = curve.curve.length();
        for (s, sign) in [(0, 1.0), (1, -1.0)] {
            if let Some(class) = side(id.index(), s) {
                sums[class].lenses += sign * area;
                sums[class].rim += length;
            }
        }
    }
    for part in &ev.parts {
        let origin = domain.curves()[part.curve].curve.start();
        let [a, b] = part.nodes.map(|v| ev.node(v) - origin);
        for (s, sign) in [(0, 1.0), (1, -1.0)] {
            if let Some(class) = side(part.curve.index(), s) {
                sums[class].lenses -= sign * 0.5 * a.cross(b);
            }
        }
    }
}

/// Every region name and every name of a curve with a kept side is in the mesh, and each edge on a curve has the name
/// of the curve. In a foreign mesh only the kind of names that it kept, of regions or of boundaries, is checked; n/a
/// where it kept neither. Checked: names and edges.
pub fn names(ev: &Evidence, domain: &Domain) -> Check {
    let mesh = ev.mesh;
    let (regions, boundaries) = (kept_regions(ev, domain), kept_boundaries(ev, domain));
    if !regions && !boundaries {
        return Check::not_asked("names");
    }
    let mut tally = Tally::highest("names");
    if regions {
        let has_cells = in_use(ev, mesh.triangle_regions.iter().map(|&r| mesh.regions[r]));
        every_name(domain, domain.regions().iter().map(|r| r.name), &has_cells, &mut tally, |name| {
            format!("no triangle is of the region \"{name}\"")
        });
    }
    if boundaries {
        let has_edges = in_use(ev, mesh.edges.iter().map(|e| e.name));
        every_name(domain, names_of_boundaries(domain), &has_edges, &mut tally, |name| {
            format!("no edge is of the boundary \"{name}\"")
        });
        names_of_edges(ev, domain, &mut tally);
    }
    tally.finish(Status::Proven)
}

fn names_of_boundaries(domain: &Domain) -> impl Iterator<Item = NameId> {
    domain.curves().iter().filter(|c| is_kept(c.sides)).map(|c| c.name)
}

/// Distinct names of the mesh.
fn in_use<'a>(ev: &Evidence<'a>, names: impl Iterator<Item = NameId>) -> BTreeSet<&'a str> {
    distinct(names).into_iter().map(|name| ev.mesh.names.text(name)).collect()
}

fn every_name(
    domain: &Domain,
    asked: impl Iterator<Item = NameId>,
    has: &BTreeSet<&str>,
    tally: &mut Tally,
    sentence: impl Fn(&str) -> String,
) {
    for name in distinct(asked).into_iter().map(|name| domain.name(name)) {
        tally.count();
        if !has.contains(name) {
            tally.flaw(|| sentence(name));
        }
    }
}

/// Whether any region of the mesh has a name of the domain.
fn kept_regions(ev: &Evidence, domain: &Domain) -> bool {
    let has = in_use(ev, ev.mesh.triangle_regions.iter().map(|&r| ev.mesh.regions[r]));
    !ev.promise.foreign || !has.is_disjoint(&in_domain(domain, domain.regions().iter().map(|r| r.name)))
}

/// Whether any boundary of the mesh has a name of the domain. Numbers that do not fit are the numbers of another
/// program: a format without names has nothing else.
fn kept_boundaries(ev: &Evidence, domain: &Domain) -> bool {
    let asked = in_domain(domain, names_of_boundaries(domain));
    let has = in_use(ev, ev.mesh.edges.iter().map(|e| e.name));
    let are_numbers = has.iter().all(|name| name.parse::<i64>().is_ok());
    let fits = |p: &CurvePart| p.name.is_none_or(|name| ev.mesh.names.text(name) == name_asked(domain, p));
    let known = !has.is_disjoint(&asked);
    !ev.promise.foreign || known && (!are_numbers || ev.parts.iter().all(fits))
}

fn in_domain(domain: &Domain, names: impl Iterator<Item = NameId>) -> BTreeSet<&str> {
    distinct(names).into_iter().map(|name| domain.name(name)).collect()
}

fn name_asked<'a>(domain: &'a Domain, part: &CurvePart) -> &'a str {
    domain.name(domain.curves()[part.curve].name)
}

/// Each edge on a curve has the name of the curve, and in a foreign mesh no other edge has a name of a curve.
fn names_of_edges(ev: &Evidence, domain: &Domain, tally: &mut Tally) {
    for part in &ev.parts {
        let Some(has) = part.name.map(|n| ev.mesh.names.text(n)) else { continue };
        tally.count();
        let asked = name_asked(domain, part);
        if has != asked {
            tally.flaw(|| format!("{} is of \"{has}\", its curve of \"{asked}\"", ev.tell_edge(part.nodes)));
        }
    }
    if !ev.promise.foreign {
        return;
    }
    let ascending = |[a, b]: [VertexId; 2]| [a.min(b), a.max(b)];
    let mut on_curves: Vec<_> = ev.parts.iter().map(|p| ascending(p.nodes)).collect();
    on_curves.sort_unstable();
    let asked = in_domain(domain, names_of_boundaries(domain));
    for edge in ev.mesh.edges.iter().filter(|e| on_curves.binary_search(&ascending(e.nodes)).is_err()) {
        let has = ev.mesh.names.text(edge.name);
        if asked.contains(has) {
            tally.count();
            tally.flaw(|| format!("{} is of \"{has}\", but lies on no curve", ev.tell_edge(edge.nodes)));
        }
    }
}

fn distinct(names: impl Iterator<Item = NameId>) -> Vec<NameId> {
    let mut list: Vec<NameId> = names.collect();
    list.sort_unstable();
    list.dedup();
    list
}
