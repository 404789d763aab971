//! What most programs need: `use squinch::prelude::*`.

pub use crate::curve::Curve;
pub use crate::domain::{ArrangeOptions, Domain, Drawing, FillRule};
pub use crate::geometry::Point;
pub use crate::import::Format as DrawingFormat;
pub use crate::mesh::Mesh;
pub use crate::refine::Until;
pub use crate::run::request::Request;
pub use crate::run::{Exit, Extent, Outcome, Source, run, run_drawing};
pub use crate::verify::{Verdict, verify};
pub use crate::watch::no_clock;
