//! The options of assembling a solid.

use crate::options::{OutOfBounds, Scalar, number, scalar};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// How a solid is made of surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", default)]
pub struct Assembly {
    /// Distance by which points may miss the plane of their facet; then they are moved onto it. 0: only triangles that
    /// are exactly coplanar make one facet. auto: 4 units in the last place as the file writes numbers.
    #[schemars(extend("group" = "facets", "value" = "LENGTH|auto"))]
    pub flatten: Flatten,
    /// What becomes of polygons that miss their plane by more than that.
    #[schemars(extend("group" = "facets", "value" = "HOW"))]
    pub nonplanar: NonPlanar,
}

impl Assembly {
    /// Whether the options are within bounds.
    ///
    /// # Errors
    /// With the option and its value.
    pub fn check(&self) -> Result<(), OutOfBounds> {
        match self.flatten {
            Flatten::Within(length) => {
                let holds = length.is_finite() && length >= 0.0;
                OutOfBounds::unless(holds, "flatten", &length, "a length that is not negative is needed, or auto")
            }
            Flatten::Auto => Ok(()),
        }
    }
}

/// How far points may lie from the plane of their facet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Scalar", into = "Scalar")]
#[schemars(with = "String")]
pub enum Flatten {
    /// By four units in the last place as the file writes numbers, never by more than 1e-5 of the extent; by nothing
    /// where all numbers are whole.
    #[default]
    Auto,
    /// By this much; 0: exactly coplanar triangles alone make a facet.
    Within(f64),
}

scalar!(Flatten);

impl FromStr for Flatten {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Self::Auto),
            _ => Ok(Self::Within(number(text)?)),
        }
    }
}

impl fmt::Display for Flatten {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Within(length) => length.fmt(f),
        }
    }
}

/// What becomes of polygons that miss their plane by more than [`Assembly::flatten`] allows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NonPlanar {
    /// They are refused.
    #[default]
    Refuse,
    /// They are cut in triangles, each a facet of its own.
    Triangles,
}
