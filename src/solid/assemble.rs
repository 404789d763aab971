//! [`Surfaces`] → [`Solid`]: welded, triangulated, split where points lie on edges, checked, flattened.

use super::boxes::Space;
use super::complex::{Complex, counted, shown};
use super::error::SolidError;
use super::exact::Place;
use super::options::{Assembly, Flatten};
use super::{Digits, Material, RegionSeed, Solid, Surfaces, crossing, flatten, orient, polygons, rims, split};
use crate::geometry::space::{cross, dot, length, minus, times};
use crate::geometry::unit_scale;

/// Units in the last place by which points of one plane may miss it. Measured on CAD parts: up to 1.3.
const LAST_PLACES: f64 = 4.0;

/// The greatest tolerance that is chosen unasked, in parts of the extent.
const LARGEST_TOLERANCE: f64 = 1e-5;

impl Surfaces {
    /// Makes a valid complex: equal points welded, polygons triangulated, doubled facets joined, edges split at points
    /// that lie on them, coplanar triangles of one name made one facet.
    ///
    /// # Errors
    /// [`SolidError`] with entity, place and way out: where there is no facet, where a surface is open or has no
    /// consistent orientation, where facets cross, and where polygons are not planar.
    pub fn assemble(&self, options: &Assembly) -> Result<Solid, SolidError> {
        let mut complex = self.weld(options)?;
        split::at_points(&mut complex);
        split::join_doubled(&mut complex);
        if complex.triangles.is_empty() {
            let at = complex.points.first().map_or([0.0; 3], |&p| complex.place(p));
            let help = "give a file with facets";
            return Err(SolidError::new("there is no facet of an area, and so nothing that is bounded,", at, help));
        }
        orient::orient(&mut complex)?;
        let flattened = flatten::flatten(&mut complex);
        let (mut found, mut count) = crossing::crossings(&complex);
        if count > 0 && flattened.is_moved(&complex) {
            flattened.undo(&mut complex);
            complex.repairs.push("Facets stay as they are: made flat, some would cross.".into());
            (found, count) = crossing::crossings(&complex);
        } else {
            flattened.tell(&mut complex);
        }
        crossing::refuse(&found, count)?;
        self.finish(complex)
    }

    /// The tolerance of flatness, in the coordinates of the file.
    fn tolerance(&self, flatten: Flatten, largest: f64, extent: f64) -> f64 {
        let last_place = |digits: i32| {
            let (_, exponent) = libm::frexp(largest);
            libm::ldexp(1.0, exponent - digits)
        };
        match flatten {
            Flatten::Within(tolerance) => tolerance.max(0.0),
            Flatten::Auto => {
                let unit = match self.digits {
                    Digits::Double => last_place(53),
                    Digits::Single => last_place(24),
                    Digits::Text(0.0) => return 0.0,
                    // Text with few digits becomes a double: not more exact than that.
                    Digits::Text(unit) => unit.max(last_place(53)),
                };
                (LAST_PLACES * unit).min(LARGEST_TOLERANCE * extent)
            }
        }
    }

    /// Points with equal ones made one, and the triangles of all facets on them.
    fn weld(&self, options: &Assembly) -> Result<Complex<'_>, SolidError> {
        let finite = |p: &&[f64; 3]| p.iter().any(|x| !x.is_finite());
        if let Some(wrong) = self.points.iter().find(finite) {
            return Err(SolidError::new("a coordinate is not a finite number", *wrong, "mend the file"));
        }
        let largest = self.points.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        let scale = unit_scale(largest);
        let bounds = Space::around(self.points.iter().copied());
        let extent = if self.points.is_empty() { 0.0 } else { length(minus(bounds.greatest, bounds.least)) };
        let mut complex = Complex {
            found: self,
            unscale: 1.0 / scale,
            tolerance: self.tolerance(options.flatten, largest, extent) * scale,
            points: Vec::new(),
            used: Vec::new(),
            triangles: Vec::new(),
            near: Vec::new(),
            required: Default::default(),
            repairs: self.notes.clone(),
        };
        let welded = weld_points(&mut complex, scale);
        // Where a file lists what bounds cells, a point alone is a vertex to be kept.
        complex.used = vec![matches!(self.material, Material::Cells { .. }); complex.points.len()];
        polygons::make_triangles(&mut complex, &welded, options.nonplanar)?;
        Ok(complex)
    }

    fn finish(&self, mut complex: Complex) -> Result<Solid, SolidError> {
        drop_unused(&mut complex);
        let made = rims::make_facets(&complex)?;
        let points = complex.points.iter().map(|&p| complex.place(p)).collect();
        Ok(Solid {
            points,
            segments: made.segments,
            facets: made.facets,
            names: self.names.clone(),
            material: self.material.clone(),
            unit: self.unit.clone(),
            repairs: complex.repairs,
        })
    }
}

/// Makes one point of equal ones; tells by point of the file which.
fn weld_points(complex: &mut Complex, scale: f64) -> Vec<u32> {
    // −0 and 0 are one place, but two to total_cmp: adding 0 makes them one.
    let places: Vec<Place> = complex.found.points.iter().map(|p| p.map(|x| x * scale + 0.0)).collect();
    let mut order: Vec<u32> = (0..places.len() as u32).collect();
    let compare = |a: &u32, b: &u32| {
        let (p, q) = (places[*a as usize], places[*b as usize]);
        p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])).then(p[2].total_cmp(&q[2]))
    };
    order.sort_by(|a, b| compare(a, b).then(a.cmp(b)));
    let mut first = vec![0u32; places.len()];
    for equal in order.chunk_by(|a, b| compare(a, b).is_eq()) {
        equal.iter().for_each(|&p| first[p as usize] = equal[0]);
    }
    let mut welded = vec![0u32; places.len()];
    let (mut count, mut at) = (0, None);
    for p in 0..places.len() {
        if first[p] as usize == p {
            welded[p] = complex.points.len() as u32;
            complex.points.push(places[p]);
        } else {
            welded[p] = welded[first[p] as usize];
            count += 1;
            at.get_or_insert(places[p]);
        }
    }
    // STL has no other way to say that triangles meet than to repeat their points.
    let repeats = complex.found.format.starts_with("STL");
    if let Some(at) = at.filter(|_| !repeats) {
        let (n, at) = (counted(count, "point"), shown(complex.place(at)));
        complex.repairs.push(format!("{n} in the place of another made one with it, the first at {at}."));
    }
    welded
}

/// Takes out points that belong to nothing.
fn drop_unused(complex: &mut Complex) {
    let mut now = vec![0u32; complex.points.len()];
    let mut kept = Vec::with_capacity(complex.points.len());
    for (p, &at) in complex.points.iter().enumerate() {
        now[p] = kept.len() as u32;
        if complex.used[p] {
            kept.push(at);
        }
    }
    let dropped = complex.points.len() - kept.len();
    if dropped == 0 {
        return;
    }
    complex.repairs.push(format!("{} of no facet dropped.", counted(dropped, "point")));
    complex.used = vec![true; kept.len()];
    complex.points = kept;
    complex.triangles.iter_mut().for_each(|t| t.corners = t.corners.map(|p| now[p as usize]));
    let required = std::mem::take(&mut complex.required);
    complex.required = required.into_iter().map(|(e, name)| (e.map(|p| now[p as usize]), name)).collect();
}

impl Solid {
    /// The least and the greatest corner of the box around all points; `None` of none.
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let bounds = Space::around(self.points.iter().copied());
        (!self.points.is_empty()).then_some([bounds.least, bounds.greatest])
    }

    /// The volume that the surfaces enclose, counted as often as they go around it, by the divergence theorem; `None`
    /// where cells are material by themselves ([`Material::Cells`]), whatever their facets' orientation.
    pub fn volume(&self) -> Option<f64> {
        if let Material::Cells { .. } = self.material {
            return None;
        }
        let [least, greatest] = self.bounds()?;
        // About the middle, so that far from the origin no digits are lost.
        let middle = times([least[0] + greatest[0], least[1] + greatest[1], least[2] + greatest[2]], 0.5);
        let mut sum = Sum::default();
        for facet in self.facets.iter() {
            for triangle in &facet.triangles {
                let [a, b, c] = triangle.map(|p| minus(self.points[p], middle));
                sum.add(f64::from(facet.winding) * dot(a, cross(b, c)));
            }
        }
        Some(sum.value() / 6.0)
    }

    /// The area of all facets, each counted once.
    pub fn area(&self) -> f64 {
        let mut sum = Sum::default();
        for triangle in self.facets.iter().flat_map(|facet| &facet.triangles) {
            let [a, b, c] = triangle.map(|p| self.points[p]);
            sum.add(0.5 * length(cross(minus(b, a), minus(c, a))));
        }
        sum.value()
    }

    /// The points that name regions.
    pub fn regions(&self) -> &[RegionSeed] {
        match &self.material {
            Material::Cells { regions, .. } => regions,
            Material::Winding => &[],
        }
    }
}

/// A sum that keeps what rounding would lose (Neumaier 1974).
#[derive(Default)]
struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    fn add(&mut self, x: f64) {
        let sum = self.sum + x;
        self.lost += if self.sum.abs() >= x.abs() { (self.sum - sum) + x } else { (x - sum) + self.sum };
        self.sum = sum;
    }

    fn value(&self) -> f64 {
        self.sum + self.lost
    }
}
