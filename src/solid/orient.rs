//! Whether a surface is closed, and which of its sides is outside.

use super::Material;
use super::boxes::Space;
use super::complex::{Complex, Use, counted, shown};
use super::error::SolidError;
use super::exact::Place;
use crate::geometry::space::{cross, dot, length, minus};
use crate::ids::Forest;

/// At most this many places are listed of one flaw.
const LISTED: usize = 20;

/// Orients neighbouring triangles alike; for a surface, checks that it is closed and turns what is inside out.
///
/// # Errors
/// [`SolidError`] where the surface is open, or has no two sides.
pub(super) fn orient(complex: &mut Complex) -> Result<(), SolidError> {
    if complex.found.material != Material::Winding {
        flood(complex);
        return Ok(());
    }
    let uses = complex.uses();
    refuse_open(complex, &uses)?;
    if unbalanced(complex, &uses).is_some() {
        let turned = flood(complex);
        if let Some(&first) = turned.first() {
            let n = counted(turned.len(), "triangle");
            let at = shown(complex.place(complex.corners(first)[0]));
            let entity = complex.entity(first);
            complex
                .repairs
                .push(format!("{n} turned, so that neighbours are oriented alike, the first {entity} at {at}."));
        }
        if let Some(ends) = unbalanced(complex, &complex.uses()) {
            let what = "the surface has no consistent orientation: triangles that share an edge disagree";
            let at = ends.map(|p| complex.place_of(p));
            let help = "orient the triangles outward in the program that made the file";
            return Err(SolidError::new(what, at[0], help).also_at([at[1]]));
        }
    }
    turn_inside_out(complex);
    Ok(())
}

fn times_used(complex: &Complex, chunk: &[Use]) -> i64 {
    chunk.iter().map(|u| i64::from(complex.triangles[u.triangle as usize].winding)).sum()
}

/// The first edge that is not passed as often one way as the other.
fn unbalanced(complex: &Complex, uses: &[Use]) -> Option<[u32; 2]> {
    let sum = |chunk: &[Use]| -> i64 {
        let signed = |u: &Use| {
            let winding = i64::from(complex.triangles[u.triangle as usize].winding);
            if u.forward { winding } else { -winding }
        };
        chunk.iter().map(signed).sum()
    };
    uses.chunk_by(|a, b| a.ends == b.ends).find(|chunk| sum(chunk) != 0).map(|chunk| chunk[0].ends)
}

fn refuse_open(complex: &Complex, uses: &[Use]) -> Result<(), SolidError> {
    let open = |chunk: &&[Use]| times_used(complex, chunk) % 2 != 0;
    let rims: Vec<&[Use]> = uses.chunk_by(|a, b| a.ends == b.ends).filter(open).collect();
    let Some(first) = rims.first() else { return Ok(()) };
    let mut forest = Forest::new(complex.points.len());
    rims.iter().for_each(|rim| forest.join(rim[0].ends[0] as usize, rim[0].ends[1] as usize));
    let mut roots: Vec<usize> = rims.iter().map(|rim| forest.root(rim[0].ends[0] as usize)).collect();
    roots.sort_unstable();
    roots.dedup();
    let what = format!(
        "the surface is open: {} along {}, the first at an edge of {}",
        counted(roots.len(), "rim"),
        counted(rims.len(), "edge"),
        complex.entity(first[0].triangle)
    );
    let at = complex.place_of(first[0].ends[0]);
    let mut places: Vec<Place> = vec![complex.place_of(first[0].ends[1])];
    places.extend(roots.iter().take(LISTED).map(|&root| complex.place_of(root as u32)));
    let help = "close the surface; points that should be one must be equal";
    Err(SolidError::new(what, at, help).also_at(places))
}

/// Orients triangles as their neighbours are, across edges of two triangles and within a facet, and tells which it
/// turned: the fewer ones of each connected part.
fn flood(complex: &mut Complex) -> Vec<u32> {
    let links = links(complex);
    let n = complex.triangles.len();
    let mut turned: Vec<Option<bool>> = vec![None; n];
    let mut all = Vec::new();
    for seed in 0..n {
        if turned[seed].is_some() {
            continue;
        }
        turned[seed] = Some(false);
        let mut part = vec![seed as u32];
        let mut next = 0;
        while let Some(&t) = part.get(next) {
            next += 1;
            let here = turned[t as usize] == Some(true);
            let from = links.partition_point(|link| link.0 < t);
            for &(_, u, alike) in links[from..].iter().take_while(|link| link.0 == t) {
                if turned[u as usize].is_none() {
                    turned[u as usize] = Some(here == alike);
                    part.push(u);
                }
            }
        }
        let is_turned = |t: &u32| turned[*t as usize] == Some(true);
        let more = 2 * part.iter().filter(|t| is_turned(t)).count() > part.len();
        all.extend(part.iter().copied().filter(|t| is_turned(t) != more));
    }
    all.sort_unstable();
    for &t in &all {
        complex.triangles[t as usize].corners.swap(1, 2);
    }
    all
}

/// Pairs of triangles that should be oriented alike, each both ways, and whether they are.
fn links(complex: &Complex) -> Vec<(u32, u32, bool)> {
    let mut links = Vec::new();
    let mut link = |a: &Use, b: &Use| {
        // Triangles of one orientation pass their edge in opposite ways.
        let alike = a.forward != b.forward;
        links.extend([(a.triangle, b.triangle, alike), (b.triangle, a.triangle, alike)]);
    };
    let group = |u: &Use| complex.triangles[u.triangle as usize].group;
    for chunk in complex.uses().chunk_by(|a, b| a.ends == b.ends) {
        if let [a, b] = chunk {
            link(a, b);
            continue;
        }
        for (i, a) in chunk.iter().enumerate() {
            chunk[i + 1..].iter().filter(|b| group(b) == group(a)).for_each(|b| link(a, b));
        }
    }
    links.sort_unstable();
    links
}

/// A closed part of a surface.
struct Part {
    triangles: Vec<u32>,
    volume: f64,
    bounds: Space,
}

/// Turns every outermost part that has a negative volume, with what lies in it.
fn turn_inside_out(complex: &mut Complex) {
    let parts = parts(complex);
    if parts.iter().all(|part| part.volume >= 0.0) {
        return;
    }
    let containers: Vec<Vec<usize>> = parts.iter().map(|part| containers(complex, &parts, part)).collect();
    let outermost = |i: usize| containers[i].is_empty();
    let inverted: Vec<usize> = (0..parts.len()).filter(|&i| outermost(i) && parts[i].volume < 0.0).collect();
    for (i, part) in parts.iter().enumerate() {
        if inverted.contains(&i) || containers[i].iter().any(|c| inverted.contains(c)) {
            for &t in &part.triangles {
                complex.triangles[t as usize].corners.swap(1, 2);
            }
        }
    }
    if let Some(&first) = inverted.first() {
        let n = counted(inverted.len(), "surface");
        let t = parts[first].triangles[0];
        let at = shown(complex.place(complex.corners(t)[0]));
        let entity = complex.entity(t);
        complex.repairs.push(format!("{n} oriented inward turned, the first with {entity} at {at}."));
    }
}

fn parts(complex: &Complex) -> Vec<Part> {
    let mut forest = Forest::new(complex.triangles.len());
    for chunk in complex.uses().chunk_by(|a, b| a.ends == b.ends) {
        chunk[1..].iter().for_each(|u| forest.join(chunk[0].triangle as usize, u.triangle as usize));
    }
    let mut parts: Vec<Part> = Vec::new();
    let mut of_root = std::collections::BTreeMap::new();
    for t in 0..complex.triangles.len() {
        let at = *of_root.entry(forest.root(t)).or_insert(parts.len());
        if at == parts.len() {
            parts.push(Part { triangles: Vec::new(), volume: 0.0, bounds: Space::around([]) });
        }
        parts[at].triangles.push(t as u32);
    }
    for part in &mut parts {
        let corners = part.triangles.iter().map(|&t| (t, complex.corners(t)));
        let volume =
            |(t, [a, b, c]): (u32, [Place; 3])| f64::from(complex.triangles[t as usize].winding) * dot(a, cross(b, c));
        part.volume = corners.clone().map(volume).sum();
        part.bounds = Space::around(corners.flat_map(|(_, abc)| abc));
    }
    parts
}

fn containers(complex: &Complex, parts: &[Part], part: &Part) -> Vec<usize> {
    let at = complex.corners(part.triangles[0])[0];
    let holds = |other: &Part| {
        let around = other.bounds.encloses(part.bounds) && other.triangles[0] != part.triangles[0];
        // A half, as only 0 and a whole turn can be, but for rounding and points on the surface.
        around && turns_around(complex, other, at).abs() > 0.5
    };
    (0..parts.len()).filter(|&i| holds(&parts[i])).collect()
}

/// How often a surface goes around a place: the sum of its triangles' solid angles (van Oosterom & Strackee 1983).
fn turns_around(complex: &Complex, part: &Part, at: Place) -> f64 {
    let angle = |&t: &u32| {
        let [a, b, c] = complex.corners(t).map(|p| minus(p, at));
        let (la, lb, lc) = (length(a), length(b), length(c));
        let across = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        let winding = f64::from(complex.triangles[t as usize].winding);
        winding * libm::atan2(dot(a, cross(b, c)), across)
    };
    part.triangles.iter().map(angle).sum::<f64>() / std::f64::consts::TAU
}
