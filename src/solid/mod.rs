//! Solids bounded by flat facets: as a file holds them ([`Surfaces`]), and as a valid piecewise linear complex
//! ([`Solid`]; Shewchuk & Si 2014, section 2), which is what the kernel in space takes.

mod assemble;
mod boxes;
mod complex;
mod crossing;
mod error;
mod exact;
mod flatten;
mod options;
mod orient;
mod plane;
mod polygons;
mod rims;
mod split;
mod triangulate;

pub use error::SolidError;
pub use options::{Assembly, Flatten, NonPlanar};

use crate::ids::{FacetId, IdVec, NameId, Names, PointId, SegmentId};

/// Points and polygons as found in a file: nothing guaranteed, nothing cleaned.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surfaces {
    /// The reader that made it: "TetGen poly", "STL (binary)", …
    pub format: String,
    /// The points, in the order of the file.
    pub points: Vec<[f64; 3]>,
    /// The facets, in the order of the file.
    pub facets: Vec<FoundFacet>,
    /// The texts of all names that facets and seeds refer to.
    pub names: Names,
    /// How the file says what is material.
    pub material: Material,
    /// The physical unit of a coordinate, where the file says.
    pub unit: Option<String>,
    /// How exactly the file writes its numbers.
    pub digits: Digits,
    /// What the reader noticed or mended, one sentence each.
    pub notes: Vec<String>,
}

/// A facet as found: polygons of one plane, or what should be one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FoundFacet {
    /// Its polygons, by places in [`Surfaces::points`]: three points and more bound the facet, two are a segment in it
    /// and one is a vertex in it. A facet of such parts alone is a dangling segment or vertex.
    pub polygons: Vec<Vec<u32>>,
    /// Points inside the polygons that are holes of the facet.
    pub holes: Vec<[f64; 3]>,
    /// Its name, where the file gives one.
    pub name: Option<NameId>,
    /// How messages refer to it: "facet 12 (line 40)", "triangle 7 of solid lid".
    pub entity: String,
}

/// How a file says which bounded cells are material.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// Every bounded cell but those that a hole point lies in (TetGen's formats).
    Cells {
        /// One point in each hole.
        holes: Vec<[f64; 3]>,
        /// Points that name the region that they lie in.
        regions: Vec<RegionSeed>,
    },
    /// Cells with a winding number above 0 (surfaces, oriented outward).
    Winding,
}

impl Default for Material {
    fn default() -> Self {
        Self::Cells { holes: Vec::new(), regions: Vec::new() }
    }
}

/// A point that names the region it lies in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionSeed {
    /// The point, strictly within the region.
    pub at: [f64; 3],
    /// The name of the region.
    pub name: NameId,
}

/// How exactly a file writes its numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Digits {
    /// As `f64`, or text with as many digits.
    #[default]
    Double,
    /// As `f32`.
    Single,
    /// As text whose last decimal has this unit, 0 where all numbers are whole.
    Text(f64),
}

/// A valid piecewise linear complex: facets meet in segments and points of the complex only.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solid {
    /// The points, no two equal.
    pub(crate) points: IdVec<PointId, [f64; 3]>,
    /// The segments: rims of facets, edges where facets meet, and dangling ones.
    pub(crate) segments: IdVec<SegmentId, Segment>,
    /// The facets.
    pub(crate) facets: IdVec<FacetId, Facet>,
    /// The texts of all names.
    pub(crate) names: Names,
    /// What is material.
    pub(crate) material: Material,
    /// The physical unit of a coordinate, where known.
    pub(crate) unit: Option<String>,
    /// What was mended on the way, one sentence each, with place.
    pub(crate) repairs: Vec<String>,
}

/// A straight edge of the complex.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Its two ends.
    pub ends: [PointId; 2],
    /// Its name, where the file names it.
    pub name: Option<NameId>,
}

/// A polygon of one plane, to within rounding.
///
/// ```text
///        ┌───────◀───────┐      rims: the outer one counter-clockwise as seen from the side that `triangles` face, inner ones
///        │  ┌──▶──┐   p  │      (of holes) clockwise: the facet lies on the left of each.
///        ▼  ▲     ▼   │  ▲      p: a segment inside, which the facet lies on both sides of
///        │  └──◀──┘      │
///        └───────▶───────┘
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Facet {
    /// Closed rims: the facet lies on the left of each edge from one point to the next.
    pub rims: Vec<Vec<PointId>>,
    /// The segments of the rims, and those inside.
    pub segments: Vec<SegmentId>,
    /// Points inside that are on none of its segments.
    pub inner_points: Vec<PointId>,
    /// Three of its points, far apart and counter-clockwise: the plane that signs are asked of.
    pub plane: [PointId; 3],
    /// The triangles of the input that the facet is made of: area and volume of the input are sums over them.
    pub triangles: Vec<[PointId; 3]>,
    /// How often its triangles stand in the input with this orientation less how often with the other: what the
    /// winding number changes by from the front of the facet to its back.
    pub winding: i32,
    /// Its name, where the file gives one.
    pub name: Option<NameId>,
    /// How messages refer to it.
    pub entity: String,
}

impl Solid {
    /// The points, no two equal.
    pub fn points(&self) -> &IdVec<PointId, [f64; 3]> {
        &self.points
    }

    /// The segments: rims of facets, edges where facets meet, and dangling ones.
    pub fn segments(&self) -> &IdVec<SegmentId, Segment> {
        &self.segments
    }

    /// The facets.
    pub fn facets(&self) -> &IdVec<FacetId, Facet> {
        &self.facets
    }

    /// The texts of all names.
    pub fn names(&self) -> &Names {
        &self.names
    }

    /// What is material.
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// The physical unit of a coordinate, where known.
    pub fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    /// What was mended on the way, one sentence each, with place.
    pub fn repairs(&self) -> &[String] {
        &self.repairs
    }
}
