//! Our own format: curves as JSON. It holds each kind of curve exactly, names, points, seeds and sizes. [`SCHEMA`]
//! describes it to editors.
//!
//! ```
//! let text = r#"{ "squinch": 1, "unit": "mm", "curves": [
//!     { "name": "rim", "circle": { "center": [0, 0], "radius": 2 } },
//!     { "name": "hole", "arc": { "from": [-1, 0], "to": [1, 0], "bulge": 1 } },
//!     { "name": "hole", "line": [[1, 0], [-1, 0]] } ] }"#;
//! let drawing = squinch::import::outline::read(text.as_bytes(), "plate")?;
//! assert_eq!(drawing.curves.len(), 3);
//! // What is written reads back the same, to the last bit.
//! let again = squinch::import::outline::to_json(&drawing);
//! assert_eq!(squinch::import::outline::read(again.as_bytes(), "plate")?.curves, drawing.curves);
//! # Ok::<(), squinch::import::ImportError>(())
//! ```

mod curves;
mod read;
mod write;

use super::{Certainty, Facts, without_bom};

pub use read::read;
pub use write::to_json;

/// The published JSON Schema of the format.
pub const SCHEMA: &str = include_str!("../outline.schema.json");

/// The facts of outlines.
pub(super) const FACTS: Facts = Facts {
    name: "outline",
    suffixes: &["json"],
    sign: |bytes| without_bom(bytes).trim_ascii_start().starts_with(b"{"),
    certainty: Certainty::Mark,
    read: |bytes, stem, _| read(bytes, stem).map(Into::into),
};

/// The version of the format.
const VERSION: u32 = 1;

fn curve_entity(i: usize) -> String {
    format!("curve {i}")
}
fn shape_entity(i: usize) -> String {
    format!("shape {i}")
}
fn point_entity(i: usize) -> String {
    format!("point {i}")
}
fn seed_entity(i: usize) -> String {
    format!("seed {i}")
}
