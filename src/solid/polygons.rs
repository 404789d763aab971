//! Facets as found → triangles.

use super::complex::{Complex, Triangle, counted, edge, shown};
use super::error::SolidError;
use super::exact::{Place, Side, along, collinear, in_triangle, side};
use super::options::NonPlanar;
use super::plane::{three_far, through};
use super::triangulate::{Flat, NONE, Unflat, triangulate};
use crate::geometry::space::{cross, dot, minus, plus};
use std::collections::BTreeMap;

/// What was dropped on the way: how many, and the place of the first.
#[derive(Default)]
struct Dropped {
    count: usize,
    first: Option<String>,
}

impl Dropped {
    fn note(&mut self, entity: &str, at: Place) {
        self.count += 1;
        self.first.get_or_insert_with(|| format!("{entity} at {}", shown(at)));
    }

    fn told(&self, what: &str) -> Option<String> {
        let first = self.first.as_ref()?;
        Some(format!("{} {what}, the first {first}.", counted(self.count, "facet")))
    }
}

/// Makes triangles, required edges and used points of all facets found. `welded` leads from points of the file to those
/// of the complex.
pub(super) fn make_triangles(complex: &mut Complex, welded: &[u32], nonplanar: NonPlanar) -> Result<(), SolidError> {
    let (mut flat, mut cut) = (Dropped::default(), Dropped::default());
    for f in 0..complex.found.facets.len() {
        let parts = Parts::of(complex, welded, f)?;
        parts.all().for_each(|p| complex.used[p as usize] = true);
        let Some(&start) = parts.loops.first().and_then(|l| l.first()) else {
            if parts.collapsed {
                let at = parts.all().next().map_or([0.0; 3], |p| complex.place_of(p));
                flat.note(&complex.found.facets[f].entity, at);
            }
            continue;
        };
        match parts.triangles(complex, f, nonplanar)? {
            Made::Triangles => {}
            Made::Nothing => flat.note(&complex.found.facets[f].entity, complex.place_of(start)),
            Made::Cut => cut.note(&complex.found.facets[f].entity, complex.place_of(start)),
        }
    }
    complex.repairs.extend(flat.told("of zero area dropped"));
    complex.repairs.extend(cut.told("not planar and cut in triangles"));
    Ok(())
}

enum Made {
    Triangles,
    /// All its points lie on one line.
    Nothing,
    /// Triangles, each a facet of its own.
    Cut,
}

/// The polygons of a facet, sorted by what they are.
struct Parts {
    loops: Vec<Vec<u32>>,
    segments: Vec<[u32; 2]>,
    points: Vec<u32>,
    /// Whether a polygon became less than one when repeated points were dropped.
    collapsed: bool,
}

impl Parts {
    fn of(complex: &mut Complex, welded: &[u32], f: usize) -> Result<Self, SolidError> {
        let found = &complex.found.facets[f];
        let mut parts = Self { loops: Vec::new(), segments: Vec::new(), points: Vec::new(), collapsed: false };
        for polygon in &found.polygons {
            let mut corners: Vec<u32> = polygon.iter().filter_map(|&p| welded.get(p as usize).copied()).collect();
            corners.dedup();
            while corners.len() > 1 && corners.first() == corners.last() {
                corners.pop();
            }
            match (polygon.len(), &corners[..]) {
                (_, []) => {}
                (1, &[p]) => parts.points.push(p),
                (2, &[a, b]) => parts.segments.push([a, b]),
                (_, [_, _, _, ..]) => parts.loops.push(corners),
                (_, _) => parts.collapsed = true,
            }
        }
        if parts.loops.is_empty() {
            for s in &parts.segments {
                complex.required.entry(edge(s[0], s[1])).or_insert(found.name);
            }
        }
        Ok(parts)
    }

    /// Every point, with repetitions.
    fn all(&self) -> impl Iterator<Item = u32> + '_ {
        let of_loops = self.loops.iter().flatten().copied();
        of_loops.chain(self.segments.iter().flatten().copied()).chain(self.points.iter().copied())
    }

    /// The loops' edges, and the segments.
    fn edges(&self) -> Vec<[u32; 2]> {
        let sides = |l: &Vec<u32>| (0..l.len()).map(|i| [l[i], l[(i + 1) % l.len()]]).collect::<Vec<_>>();
        self.loops.iter().flat_map(sides).chain(self.segments.iter().copied()).collect()
    }

    fn triangles(&self, complex: &mut Complex, f: usize, nonplanar: NonPlanar) -> Result<Made, SolidError> {
        if let ([corners], [], []) = (&self.loops[..], &self.segments[..], &self.points[..])
            && let [a, b, c] = corners[..]
        {
            if collinear([a, b, c].map(|p| complex.points[p as usize])) {
                return Ok(Made::Nothing);
            }
            let group = complex.new_group(false);
            push(complex, [a, b, c], f, group);
            return Ok(Made::Triangles);
        }
        let mut ids: Vec<u32> = self.all().collect();
        ids.sort_unstable();
        ids.dedup();
        let places: Vec<Place> = ids.iter().map(|&p| complex.points[p as usize]).collect();
        let Some(three) = three_far(&places) else { return Ok(Made::Nothing) };
        let planarity = planarity(complex, f, &places, three, nonplanar)?;
        self.fill(complex, f, &ids, &places, planarity)?;
        Ok(if planarity == Planarity::Not { Made::Cut } else { Made::Triangles })
    }

    /// Triangulates the facet as seen along an axis.
    fn fill(
        &self,
        complex: &mut Complex,
        f: usize,
        ids: &[u32],
        places: &[Place],
        planarity: Planarity,
    ) -> Result<(), SolidError> {
        let local: BTreeMap<u32, u32> = ids.iter().zip(0..).map(|(&id, i)| (id, i)).collect();
        let sense = self.area_vector(complex);
        let axis = axis_of_plane(places, sense);
        let points: Vec<_> = places.iter().map(|&p| along(axis, p)).collect();
        let edges: Vec<[u32; 2]> = self.edges().iter().map(|e| e.map(|p| local[&p])).collect();
        let flat = triangulate(&points, &edges).map_err(|e| self.refuse(complex, f, places, e))?;
        let outside = flat.reached(&[], true);
        let holes = hole_seeds(complex, f, &flat, &outside, places, axis);
        let hole = flat.reached(&holes, false);
        let inside: Vec<bool> = outside.iter().zip(&hole).map(|(out, hole)| !out && !hole).collect();
        let mut group = complex.new_group(planarity == Planarity::Near);
        for (t, corners) in flat.corners.iter().enumerate() {
            for (i, across) in flat.across[t].iter().enumerate() {
                // An edge with the facet on both sides, or on none.
                let beyond = across.triangle != NONE && inside[across.triangle as usize];
                if across.fixed && inside[t] == beyond && planarity != Planarity::Not {
                    let [a, b] = [corners[(i + 1) % 3], corners[(i + 2) % 3]].map(|k| ids[k as usize]);
                    complex.required.entry(edge(a, b)).or_insert(None);
                }
            }
            if inside[t] {
                let [a, b, c] = corners.map(|k| ids[k as usize]);
                push(complex, if sense[axis] < 0.0 { [a, c, b] } else { [a, b, c] }, f, group);
                if planarity == Planarity::Not {
                    group = complex.new_group(false);
                }
            }
        }
        Ok(())
    }

    /// Twice the area of the largest loop, as a vector at right angles to it.
    fn area_vector(&self, complex: &Complex) -> Place {
        let of_loop = |l: &Vec<u32>| {
            let at = |i: usize| complex.points[l[i % l.len()] as usize];
            let from_first = |i: usize| cross(minus(at(i), at(0)), minus(at(i + 1), at(0)));
            (1..l.len() - 1).map(from_first).fold([0.0; 3], plus)
        };
        let areas = self.loops.iter().map(of_loop);
        areas.reduce(|a, b| if dot(b, b) > dot(a, a) { b } else { a }).unwrap_or([0.0; 3])
    }

    fn refuse(&self, complex: &Complex, f: usize, places: &[Place], why: Unflat) -> SolidError {
        let entity = &complex.found.facets[f].entity;
        let at = |i: u32| complex.place(places[i as usize]);
        match why {
            Unflat::Equal(a, b) => {
                let what = format!("{entity}: two of its points lie above each other on its plane");
                let help = "the polygons of a facet must be planar; --nonplanar triangles does not help here: mend it";
                SolidError::new(what, at(a), help).also_at([at(b)])
            }
            Unflat::Collinear => {
                SolidError::new(format!("{entity}: its points are all but on one line"), at(0), "take the facet out")
            }
            Unflat::Crossing([a, b], [c, d]) => {
                let what = format!(
                    "{entity}: its edge from {} to {} crosses that from {} to {}",
                    shown(at(a)),
                    shown(at(b)),
                    shown(at(c)),
                    shown(at(d))
                );
                let help = "polygons of a facet may meet in points that both have; add the point where they cross";
                SolidError::new(what, at(a), help).also_at([at(b), at(c), at(d)])
            }
        }
    }
}

/// The axis along which a plane is seen largest: by the area of its polygons, where they have any, else by three points.
fn axis_of_plane(places: &[Place], sense: Place) -> usize {
    let of_points = three_far(places).and_then(|t| super::exact::axis_of(t.map(|i| places[i])));
    let normal = three_far(places).and_then(|t| through(t.map(|i| places[i]))).map(|plane| plane.normal);
    let normal = if dot(sense, sense) > 0.0 { sense } else { normal.unwrap_or(sense) };
    let largest = (0..3).fold(0, |best, k| if normal[k].abs() > normal[best].abs() { k } else { best });
    if normal[largest] == 0.0 { of_points.unwrap_or(2) } else { largest }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Planarity {
    Exact,
    /// Within the tolerance of one plane.
    Near,
    /// Cut in triangles on request.
    Not,
}

fn planarity(
    complex: &Complex,
    f: usize,
    places: &[Place],
    three: [usize; 3],
    nonplanar: NonPlanar,
) -> Result<Planarity, SolidError> {
    let [a, b, c] = three.map(|i| places[i]);
    if places.iter().all(|&p| side(a, b, c, p) == Side::On) {
        return Ok(Planarity::Exact);
    }
    let plane = through([a, b, c]).and_then(|plane| plane.fitted(places, &[]));
    let distance = plane.map_or(f64::INFINITY, |plane| plane.worst(places));
    if distance <= complex.tolerance {
        return Ok(Planarity::Near);
    }
    match nonplanar {
        NonPlanar::Triangles => Ok(Planarity::Not),
        NonPlanar::Refuse => {
            let far = plane.and_then(|plane| {
                let height = |p: &&Place| plane.height(**p).abs();
                places.iter().max_by(|p, q| height(p).total_cmp(&height(q)))
            });
            let what = format!(
                "{} is not planar: its points lie up to {:.3e} from the best plane, and {:.3e} is what the digits of the file explain,",
                complex.found.facets[f].entity,
                distance * complex.unscale,
                complex.tolerance * complex.unscale
            );
            let help = "--nonplanar triangles cuts it in triangles, --flatten T lets points move by up to T";
            Err(SolidError::new(what, complex.place(*far.unwrap_or(&a)), help))
        }
    }
}

fn push(complex: &mut Complex, corners: [u32; 3], f: usize, group: u32) {
    let winding = match complex.found.material {
        super::Material::Cells { .. } => 0,
        super::Material::Winding => 1,
    };
    complex.triangles.push(Triangle { corners, facet: f as u32, group, winding });
}

/// The triangles that hold the hole points of a facet.
fn hole_seeds(
    complex: &mut Complex,
    f: usize,
    flat: &Flat,
    outside: &[bool],
    places: &[Place],
    axis: usize,
) -> Vec<u32> {
    let mut seeds = Vec::new();
    for hole in &complex.found.facets[f].holes {
        let p = hole.map(|x| x / complex.unscale);
        let holds = |t: &usize| !outside[*t] && in_triangle(axis, flat.corners[*t].map(|i| places[i as usize]), p);
        match (0..flat.corners.len()).find(holds) {
            Some(t) => seeds.push(t as u32),
            None => {
                let entity = &complex.found.facets[f].entity;
                complex.repairs.push(format!("The hole point {} lies in no part of {entity}.", shown(*hole)));
            }
        }
    }
    seeds
}
