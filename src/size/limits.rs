//! The limits on cells that a user can give, and their values for a drawing.

use super::{ByPlace, Given, SAMPLE_GRADE, Sizing, Source};
use crate::geometry::Point;
use crate::options::{OutOfBounds, number, scalar};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Limits on cells. Lengths are in the units of the mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", default)]
pub struct Limits {
    /// Largest area of a triangle.
    #[schemars(extend("group" = "bounds", "value" = "AREA"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_area: Option<f64>,
    /// Largest length of an edge.
    #[schemars(extend("group" = "bounds", "value" = "LENGTH"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_edge: Option<f64>,
    /// Triangles whose circumradius is below this are not refined for their angles.
    #[schemars(extend("group" = "bounds", "value" = "LENGTH"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_edge: Option<f64>,
    /// Largest distance from mesh boundary to curve: a length, or a share of the drawing's diagonal as in 0.1%.
    #[schemars(extend("group" = "bounds", "value" = "LENGTH|E%"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chord_error: Option<ChordError>,
    /// Largest turning of the curve along a mesh edge, in degrees, or off.
    #[schemars(extend("group" = "bounds", "value" = "DEG|off", "report" = "edge_turning_deg"))]
    pub edge_turning: EdgeTurning,
    /// Longest edge by place: an expression in x and y as in "0.1 + 0.05*hypot(x-2, y)", or a file with `x y size` on
    /// every line, from which the size grows by --grade [default there: 0.3]
    #[schemars(extend("group" = "bounds", "value" = "FILE|EXPR", "file" = true))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<Given>,
    /// Growth of the edge length of a sized boundary or region a unit of distance away from it.
    #[schemars(extend("group" = "bounds", "value" = "G"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grade: Option<f64>,
    /// Largest length of an edge on the boundary, or in the region, of this name; may be repeated.
    #[schemars(extend("group" = "bounds", "value" = "NAME=LENGTH"))]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub size_of: Vec<SizeOf>,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_area: None,
            max_edge: None,
            min_edge: None,
            chord_error: None,
            edge_turning: EdgeTurning::Deg(15.0), // 24 edges a circle; without it a thin airfoil gets 14 edges in all
            size: None,
            grade: None,
            size_of: Vec::new(),
        }
    }
}

impl Limits {
    /// The first limit that is out of its bounds.
    ///
    /// # Errors
    /// With the option and its value.
    pub fn check(&self) -> Result<(), OutOfBounds> {
        OutOfBounds::unless_positive(&[
            ("max-area", self.max_area),
            ("max-edge", self.max_edge),
            ("min-edge", self.min_edge),
            ("grade", self.grade),
        ])?;
        if let Some(error) = self.chord_error {
            let holds = error.value().is_finite() && error.value() > 0.0;
            let why = "a positive length is needed, or a positive share as in 0.1%";
            OutOfBounds::unless(holds, "chord-error", &error, why)?;
        }
        if let EdgeTurning::Deg(turning) = self.edge_turning {
            let holds = turning > 0.0 && turning <= 60.0;
            OutOfBounds::unless(holds, "edge-turning", &turning, "degrees above 0 and at most 60, or off")?;
        }
        for size in &self.size_of {
            let holds = size.edge.is_finite() && size.edge > 0.0;
            OutOfBounds::unless(holds, "size-of", size, "a positive length is needed")?;
        }
        if let Some((size, flaw)) = self.size.as_ref().and_then(|size| Some((size, size.flaw()?))) {
            OutOfBounds::unless(false, "size", size, flaw)?;
        }
        match (self.min_edge, self.max_edge) {
            (Some(least), Some(largest)) => {
                OutOfBounds::unless(least <= largest, "min-edge", &least, "more than --max-edge")
            }
            (None, _) | (_, None) => Ok(()),
        }
    }

    /// The limits that hold everywhere and by place, for a drawing of this diagonal. Limits by name are resolved later,
    /// with the domain. A share of an unknown diagonal sets no limit.
    pub fn sizing(&self, diagonal: Option<f64>) -> Sizing {
        Sizing {
            max_area: self.max_area,
            max_edge: self.max_edge,
            min_edge: self.min_edge,
            chord_error: self.chord_error.and_then(|e| e.length(diagonal)),
            edge_turning_rad: self.edge_turning.deg().map(f64::to_radians),
            grade: self.grade,
            sources: Vec::new(),
            by_place: match &self.size {
                Some(Given::Expression(expression)) => Some(ByPlace { expression: expression.clone(), scale: 1.0 }),
                Some(Given::Samples(_)) | None => None,
            },
        }
    }

    /// The places of a file of sizes, as sources from which the size grows by `grade`.
    pub fn samples(&self) -> Vec<Source> {
        let Some(Given::Samples(samples)) = &self.size else { return Vec::new() };
        let grade = self.grade.unwrap_or(SAMPLE_GRADE);
        let near =
            |&[x, y, edge]: &[f64; 3]| Source::Near { from: Point::new(x, y), to: Point::new(x, y), edge, grade };
        samples.iter().map(near).collect()
    }
}

scalar!(ChordError, EdgeTurning);

/// Largest distance from a mesh edge to its curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "crate::options::Scalar", into = "crate::options::Scalar")]
pub enum ChordError {
    /// A length in the units of the mesh.
    Length(f64),
    /// Percent of the drawing's diagonal.
    Percent(f64),
}

impl ChordError {
    fn value(self) -> f64 {
        match self {
            Self::Length(value) | Self::Percent(value) => value,
        }
    }

    /// As a length, for a drawing of this diagonal; `None` for a share of an unknown diagonal.
    pub fn length(self, diagonal: Option<f64>) -> Option<f64> {
        match self {
            Self::Length(length) => Some(length),
            Self::Percent(percent) => diagonal.map(|d| 0.01 * percent * d),
        }
    }
}

impl FromStr for ChordError {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text.strip_suffix('%') {
            Some(percent) => Ok(Self::Percent(number(percent)?)),
            None => Ok(Self::Length(number(text)?)),
        }
    }
}

impl fmt::Display for ChordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length(length) => length.fmt(f),
            Self::Percent(percent) => write!(f, "{percent}%"),
        }
    }
}

/// Largest turning of the curve along a mesh edge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "crate::options::Scalar", into = "crate::options::Scalar")]
pub enum EdgeTurning {
    /// No limit.
    Off,
    /// The largest turning, in degrees.
    Deg(f64),
}

impl EdgeTurning {
    /// The limit in degrees; `None` where it is off.
    pub fn deg(self) -> Option<f64> {
        match self {
            Self::Off => None,
            Self::Deg(degrees) => Some(degrees),
        }
    }
}

impl FromStr for EdgeTurning {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "off" => Ok(Self::Off),
            _ => Ok(Self::Deg(number(text)?)),
        }
    }
}

impl fmt::Display for EdgeTurning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Off => f.write_str("off"),
            Self::Deg(degrees) => degrees.fmt(f),
        }
    }
}

/// Edges on a boundary, or in a region, of this name no longer than `edge`: `NAME=H`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "String", into = "String")]
pub struct SizeOf {
    /// The name of a boundary or of a region.
    pub name: String,
    /// The largest length of an edge there, in the units of the mesh.
    pub edge: f64,
}

impl FromStr for SizeOf {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let (name, edge) = text.rsplit_once('=').ok_or("NAME=H is expected")?;
        if name.is_empty() {
            return Err("a name is missing before '='".into());
        }
        Ok(Self { name: name.into(), edge: number(edge)? })
    }
}

impl TryFrom<String> for SizeOf {
    type Error = String;
    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<SizeOf> for String {
    fn from(size: SizeOf) -> Self {
        size.to_string()
    }
}

impl fmt::Display for SizeOf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.name, self.edge)
    }
}
