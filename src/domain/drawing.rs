//! Curves, names and seeds as a file holds them. Nothing is guaranteed and nothing is cleaned.

use crate::curve::Curve;
use crate::geometry::{Frame, Point, Rect, finest_decimal};
use crate::ids::{ClipId, Colour, IdVec, LayerId, NameId, Names, ShapeId};
use std::collections::BTreeMap;

/// A drawing as found.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// The reader that made it: "airfoil (Selig)", "poly", "outline", …
    pub format: String,
    /// A short title: the header line, or the file's stem.
    pub title: String,
    /// The names of all boundaries, regions and points, by the ids used in the other fields.
    pub names: Names,
    /// The colours of regions, where the file has some. Of several shapes with one name, the colour with the most area.
    pub colours: BTreeMap<NameId, Colour>,
    /// The curves, in the order of the file; they may cross, overlap or leave gaps.
    pub curves: Vec<DrawnCurve>,
    /// Points that become vertices of the mesh, on a curve or not.
    pub points: Vec<DrawnPoint>,
    /// Points that mark the faces they lie in as holes or as named regions.
    pub seeds: Vec<Seed>,
    /// Texts. A text that is the only one in a region names it, where nothing else does.
    pub labels: Vec<Label>,
    /// The filled shapes of a picture, in the order in which they are painted.
    pub shapes: IdVec<ShapeId, Shape>,
    /// The clips of shapes and curves.
    pub clips: IdVec<ClipId, Clip>,
    /// The layers of the file, in its order.
    pub layers: IdVec<LayerId, Layer>,
    /// The rule by which bounded faces are inside.
    pub fill: FillRule,
    /// Whether this is a picture whose numbers have only the digits of a picture. Its invisibly small features are
    /// taken for accidental.
    pub sketch: bool,
    /// The physical unit of a coordinate ("m", "mm", "chord", …) and where it was read from, where known.
    pub unit: Option<(String, String)>,
    /// The place of the drawing's plane in space, for a face of a solid.
    pub frame: Option<Frame>,
    /// The planar faces of the solid that the drawing is one of, by their numbers.
    pub faces: Vec<FaceInfo>,
    /// Entities that were left out because they leave the plane of the drawing. They may be the reason why an outline
    /// does not close.
    pub off_plane: Vec<OffPlane>,
    /// What the reader left out, with counts.
    pub skipped: Vec<Skipped>,
    /// Layers that were asked for and that the file does not have.
    pub unmatched: Vec<Unmatched>,
    /// What the reader noticed or corrected (format quirks), one sentence each.
    pub notes: Vec<String>,
    /// Size requests that came with the drawing (see `size::Source`): name or point sources.
    pub sizes: Vec<SizeRequest>,
}

/// A request for a cell size that came with a drawing.
#[derive(Clone, Debug, PartialEq)]
pub enum SizeRequest {
    /// Mesh edges on the boundary of this name no longer than `edge`.
    Boundary {
        /// The name of the boundary.
        name: NameId,
        /// The largest edge length, in units of the drawing.
        edge: f64,
    },
    /// Mesh edges in the region of this name no longer than `edge`.
    Region {
        /// The name of the region.
        name: NameId,
        /// The largest edge length, in units of the drawing.
        edge: f64,
    },
    /// Cells near the segment `from`–`to` no larger than `edge`, growing by `grade` a unit of distance away from it.
    Near {
        /// The start of the segment.
        from: Point,
        /// The end of the segment; equal to `from` for a point source.
        to: Point,
        /// The largest edge length at the segment, in units of the drawing.
        edge: f64,
        /// The growth of that length, a unit of distance away from the segment.
        grade: f64,
    },
    /// Everywhere.
    Everywhere {
        /// The largest edge length, in units of the drawing.
        edge: f64,
    },
}

/// A curve of a drawing, with its name and origin.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnCurve {
    /// The geometry, in units of the drawing.
    pub curve: Curve,
    /// Name of the boundary that the curve belongs to.
    pub name: NameId,
    /// Where it came from, for messages: "line 12", "segment 7", "path outline, curve 3".
    pub entity: String,
    /// The shape whose outline it is a part of. The curves of a shape are closed outlines, end to end.
    pub shape: Option<ShapeId>,
    /// The clip of a curve that belongs to no shape: the curve is kept where it lies in the clip.
    pub clip: Option<ClipId>,
    /// The layer that it is drawn on, where the file has layers.
    pub layer: Option<LayerId>,
    /// The handle of its entity in the file (group 5 of a DXF entity).
    pub handle: Option<u64>,
    /// One unit of the last decimal with which the file writes its ends, as a length; 0 where they are exact: whole
    /// numbers, or binary files. Computed ends (of arcs, by transforms) have the unit that results from their numbers.
    pub last_decimal: f64,
}

impl DrawnCurve {
    /// A curve with only a name and its origin for messages; its ends are exact.
    pub fn new(curve: Curve, name: NameId, entity: impl Into<String>) -> Self {
        Self {
            curve,
            name,
            entity: entity.into(),
            shape: None,
            clip: None,
            layer: None,
            handle: None,
            last_decimal: 0.0,
        }
    }

    /// The same curve with the last decimal read off the coordinates of its ends, for a file that writes the ends
    /// themselves. For computed ends that would be about their rounding.
    pub fn with_written_ends(self) -> Self {
        let ends = [self.curve.start(), self.curve.end()];
        Self { last_decimal: finest_decimal(ends.into_iter().flat_map(|end| [end.x, end.y])), ..self }
    }
}

/// A layer of a drawing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layer {
    /// The name of the layer as the file writes it.
    pub name: String,
    /// How many entities are drawn on it, by their line type; by the empty text where the format has none.
    pub line_types: BTreeMap<String, usize>,
}

/// A layer that was asked for, by its name or a pattern, and that the file does not have.
#[derive(Clone, Debug, PartialEq)]
pub struct Unmatched {
    /// The option with its value, as typed: `--layers PRAT`.
    pub asked: String,
    /// Similar names of layers of the file, the most similar first.
    pub near: Vec<String>,
}

/// An entity that was left out because it leaves the plane of the drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct OffPlane {
    /// Where it came from, for messages.
    pub entity: String,
    /// Its ends, projected onto the plane.
    pub ends: [Point; 2],
}

/// A filled shape of a picture. A later shape lies on top of an earlier one.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Name of the region where the shape is on top.
    pub name: NameId,
    /// Whether it is filled where its winding number is odd; else where the winding number is not 0.
    pub even_odd: bool,
    /// Where it came from, for messages.
    pub entity: String,
    /// The clip that restricts it.
    pub clip: Option<ClipId>,
    /// The clip that it is a part of: such a shape is not painted itself.
    pub part_of: Option<ClipId>,
}

impl Shape {
    /// A shape without a clip.
    pub fn new(name: NameId, even_odd: bool, entity: impl Into<String>) -> Self {
        Self { name, even_odd, entity: entity.into(), clip: None, part_of: None }
    }
}

/// A clip: shapes and curves that refer to it are kept only where one of its parts is filled, and only within the clip
/// around it. Its parts are shapes ([`Shape::part_of`]), which may themselves have earlier clips.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clip {
    /// The clip around it, an earlier one.
    pub within: Option<ClipId>,
}

/// A point that becomes a vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnPoint {
    /// The coordinates of the point.
    pub at: Point,
    /// The name of the point, where the file gives one.
    pub name: Option<NameId>,
    /// Where it came from, for messages.
    pub entity: String,
}

/// A text of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The point at which the text is placed.
    pub at: Point,
    /// The text as the file has it.
    pub text: String,
}

/// A point that decides about the face in which it lies.
#[derive(Clone, Debug, PartialEq)]
pub struct Seed {
    /// A point inside the face.
    pub at: Point,
    /// What it decides.
    pub kind: SeedKind,
    /// Where it came from, for messages.
    pub entity: String,
}

/// What a seed decides about its face.
#[derive(Clone, Debug, PartialEq)]
pub enum SeedKind {
    /// The face, and every face reached from it without crossing a curve, is no part of the domain.
    Hole,
    /// The face belongs to the region of this name, with an area limit where given.
    Region {
        /// The name of the region.
        name: NameId,
        /// The largest area of a triangle, in the square of the drawing's unit; `None`: no limit.
        max_area: Option<f64>,
    },
}

/// Which bounded faces are inside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FillRule {
    /// Winding number not zero.
    NonZero,
    /// Odd winding number.
    #[default]
    EvenOdd,
    /// Every bounded face is a region, except those reached from a hole seed.
    Regions,
    /// A face is inside where a shape fills it, by the shape's own rule; the topmost one names it.
    Shapes,
    /// Odd winding number of the curves that belong to no shape, or where a shape fills the face; the topmost one names
    /// it.
    EvenOddAndShapes,
}

/// A planar face of a solid.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct FaceInfo {
    /// Its number in the file.
    pub id: u64,
    /// Its name; empty where it has none.
    pub name: String,
    /// Its area, in the square of the drawing's unit; `None` where `flaw` says why it cannot be drawn.
    pub area: Option<f64>,
    /// Unit vector out of the solid.
    pub normal: [f64; 3],
    /// Why the face cannot be drawn; `None` where it can.
    pub flaw: Option<String>,
}

/// Entities that a reader left out.
#[derive(Clone, Debug, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct Skipped {
    /// The kind of entity: a tag, a type or a keyword of the format.
    pub entity: String,
    /// How many of them were left out for this reason.
    pub count: usize,
    /// The reason.
    pub why: String,
}

impl Drawing {
    /// The box around all curves and points, whether clipped or not, without the outlines of clips; `None` for an empty
    /// drawing.
    pub fn bounds(&self) -> Option<Rect> {
        let cuts = |c: &DrawnCurve| c.shape.is_some_and(|shape| self.shapes[shape].part_of.is_some());
        let curves = self.curves.iter().filter(|c| !cuts(c)).map(|c| c.curve.bounds());
        let points = self.points.iter().map(|p| Rect::from_points(p.at, p.at));
        curves.chain(points).reduce(|a, b| a.union(b))
    }

    /// Adds a curve of the named boundary.
    pub fn add(&mut self, curve: Curve, name: &str, entity: impl Into<String>) {
        let name = self.names.intern(name);
        self.curves.push(DrawnCurve::new(curve, name, entity));
    }
}
