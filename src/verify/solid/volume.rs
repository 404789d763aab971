//! Whether the mesh fills what is material, and its regions are as large as the input says.

use super::cells::{Wall, signed_volume};
use super::evidence::{Evidence, middle, place};
use super::facets::{Planes, cells_of};
use crate::geometry::space::{cross, dot, length, minus};
use crate::ids::{FacetId, Id, IdVec, NameId, RegionId, TetId};
use crate::solid::{Material, Solid};
use crate::verify::tally::Tally;
use crate::verify::{Check, Status};
use std::f64::consts::PI;

/// Where a region ends there is a facet, material is where the input says, and the tetrahedra of each region have the
/// volume that the facets around it enclose, by the divergence theorem over the triangles of the input.
///
/// Tetrahedra count with their absolute volume: two that overlap are too much. A facet that has the same regions on both
/// sides all over counts with the triangles of the input; another one, at which a wall ends, with those of the mesh,
/// which *facets* holds against the input. Checked: the whole and each name of a region. Worst: the largest difference.
/// `bare` are faces that end a region and are on no facet.
pub fn volume(ev: &Evidence, solid: &Solid, walls: &[Wall], planes: &Planes, bare: Tally) -> Check {
    let mut tally = bare;
    material(ev, solid, walls, &mut tally);
    let sums = Sums::of(ev, solid, walls, planes);
    let regions = ev.mesh.regions.iter().copied().collect::<std::collections::BTreeSet<NameId>>();
    sums.whole.compare("the mesh", &mut tally);
    for name in regions {
        if let Some(sum) = sums.of_name.get(name) {
            sum.compare(&format!("region \"{}\"", ev.mesh.names.text(name)), &mut tally);
        }
    }
    tally.finish(Status::Proven)
}

/// The volume of something as its tetrahedra have it, and as the facets around enclose it.
#[derive(Clone, Copy, Default)]
struct Volumes {
    has: Sum,
    right: Sum,
    /// What rounding of the terms, and nodes as far off their planes as they may be, can change.
    slack: f64,
    /// Where it is.
    at: Option<[f64; 3]>,
}

impl Volumes {
    fn compare(&self, what: &str, tally: &mut Tally) {
        tally.count();
        let (has, right) = (self.has.value(), self.right.value());
        tally.measure((has - right).abs(), self.at.unwrap_or_default());
        if (has - right).abs() > self.slack {
            tally.flaw(|| format!("{what} has the volume {has} instead of {right}, off by more than {}", self.slack));
        }
    }
}

/// A sum that keeps what rounding leaves out (Neumaier 1974): it errs by one unit in its last place, and terms of ε².
#[derive(Clone, Copy, Default)]
struct Sum {
    high: f64,
    low: f64,
}

impl Sum {
    fn add(&mut self, x: f64) {
        let sum = self.high + x;
        self.low += if self.high.abs() >= x.abs() { (self.high - sum) + x } else { (x - sum) + self.high };
        self.high = sum;
    }

    fn value(&self) -> f64 {
        self.high + self.low
    }
}

/// Volumes of the whole and by the name of regions.
struct Sums {
    whole: Volumes,
    of_name: IdVec<NameId, Volumes>,
    /// Cones are taken from here: near the middle they are small.
    origin: [f64; 3],
}

/// Rounding of a product of three differences and the sum of six of them, relative to the product of their lengths.
const DETERMINANT_ROUNDING: f64 = 16.0 * f64::EPSILON;

impl Sums {
    fn of(ev: &Evidence, solid: &Solid, walls: &[Wall], planes: &Planes) -> Self {
        let names = ev.mesh.names.iter().count();
        let origin = middle(ev.mesh.nodes.as_slice());
        let mut sums = Self { whole: Volumes::default(), of_name: vec![Volumes::default(); names].into(), origin };
        for t in ev.mesh.tetrahedra.ids() {
            sums.add_cell(ev, t);
        }
        for (f, facet) in solid.facets().enumerate() {
            let triangles = ev.triangles_of.of_group(f.index());
            let mut sides = triangles.iter().map(|&i| sides(ev, walls[i as usize]));
            let Some(first) = sides.next() else { continue };
            if sides.all(|s| s == first) {
                for t in &facet.triangles {
                    sums.add_cone(t.map(|p| solid.points()[p]), first, planes.reach[f]);
                }
            } else {
                for &i in triangles {
                    sums.add_cone(ev.triangle(i), self::sides(ev, walls[i as usize]), planes.reach[f]);
                }
            }
        }
        sums
    }

    fn add_cell(&mut self, ev: &Evidence, t: TetId) {
        let corners = ev.corners(t);
        let [a, b, c, d] = corners;
        let volume = signed_volume(corners).abs();
        let lengths = length(minus(b, a)) * length(minus(c, a)) * length(minus(d, a));
        for sum in [&mut self.whole, &mut self.of_name[ev.region_name(t)]] {
            sum.has.add(volume);
            sum.slack += DETERMINANT_ROUNDING * lengths / 6.0;
            sum.at.get_or_insert(a);
        }
    }

    /// Adds the cone over a triangle of a facet to what lies behind it, and takes it from what lies in front.
    fn add_cone(&mut self, [a, b, c]: [[f64; 3]; 3], [front, back]: [Option<NameId>; 2], reach: f64) {
        let (u, v) = (minus(b, a), minus(c, a));
        let (normal, away) = (cross(u, v), minus(a, self.origin));
        let cone = dot(away, normal) / 6.0;
        let slack = DETERMINANT_ROUNDING * length(away) * length(u) * length(v) / 6.0 + reach * length(normal) / 2.0;
        let add = |sum: &mut Volumes, cone: f64| {
            sum.right.add(cone);
            sum.slack += slack;
        };
        if front.is_some() != back.is_some() {
            add(&mut self.whole, if back.is_some() { cone } else { -cone });
        }
        if front != back {
            back.into_iter().for_each(|name| add(&mut self.of_name[name], cone));
            front.into_iter().for_each(|name| add(&mut self.of_name[name], -cone));
        }
    }
}

/// The names of the regions in front of a facet triangle and behind it.
fn sides(ev: &Evidence, wall: Wall) -> [Option<NameId>; 2] {
    [wall.front, wall.back].map(|t| t.map(|t| ev.region_name(t)))
}

fn material(ev: &Evidence, solid: &Solid, walls: &[Wall], tally: &mut Tally) {
    match solid.material() {
        Material::Cells { holes, .. } => {
            for (at, cell) in holes.iter().zip(cells_of(ev, holes)) {
                if let Some(t) = cell {
                    tally.flaw(|| format!("the hole at {} is filled by {}", place(*at), ev.tell(t)));
                }
            }
        }
        Material::Winding => {
            for (f, facet) in solid.facets().enumerate() {
                for &i in ev.triangles_of.of_group(f.index()) {
                    winding_at(ev, f, facet.winding, i, walls[i as usize], tally);
                }
            }
            regions_are_inside(ev, solid, tally);
        }
    }
}

/// From outside, where the winding number is at most 0, to material, where it is more, it grows.
fn winding_at(ev: &Evidence, f: FacetId, winding: i32, triangle: u32, wall: Wall, tally: &mut Tally) {
    let right = match (wall.front, wall.back) {
        (None, Some(_)) => winding > 0,
        (Some(_), None) => winding < 0,
        (Some(_), Some(_)) | (None, None) => true,
    };
    if !right {
        let nodes = ev.mesh.triangles[triangle as usize].nodes;
        tally.flaw(|| format!("{} of {} has material on the wrong side", ev.tell_triangle(nodes), ev.tell_facet(f)));
    }
}

/// Regions that are looked at: each takes time in proportion to the triangles of the input.
const REGIONS: usize = 64;

/// A place within each region has a winding number above 0, by the angles at which it sees the triangles of the input.
fn regions_are_inside(ev: &Evidence, solid: &Solid, tally: &mut Tally) {
    let mut largest: IdVec<RegionId, Option<(f64, TetId)>> = vec![None; ev.mesh.regions.len()].into();
    for (t, &region) in ev.mesh.tetrahedron_regions.enumerate() {
        let volume = signed_volume(ev.corners(t)).abs();
        if largest[region].is_none_or(|(v, _)| volume > v) {
            largest[region] = Some((volume, t));
        }
    }
    for (_, t) in largest.iter().take(REGIONS).flatten() {
        let at = middle(&ev.corners(*t));
        let angles = solid.facets().iter().flat_map(|facet| {
            let of = move |t: &[crate::ids::PointId; 3]| solid_angle(t.map(|p| minus(solid.points()[p], at)));
            facet.triangles.iter().map(move |t| f64::from(facet.winding) * of(t))
        });
        // A whole number but for rounding: one half is as far from both as can be.
        if angles.sum::<f64>() / (4.0 * PI) < 0.5 {
            tally.flaw(|| format!("{} is in a region outside of the surfaces", ev.tell(*t)));
        }
    }
}

/// The solid angle of a triangle as seen from the origin, positive from behind (van Oosterom & Strackee 1983).
fn solid_angle([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let (la, lb, lc) = (length(a), length(b), length(c));
    let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    2.0 * libm::atan2(dot(a, cross(b, c)), below)
}
