//! What is to be meshed: a [`Drawing`] as found, and the [`Domain`] (PRCC) that [`Drawing::arrange`] proves it to be.

mod arrange;
mod drawing;
mod features;
mod flaws;
mod locate;
mod planar;

pub use arrange::{ArrangeError, ArrangeOptions, Repair, RepairKind, Unarranged};
pub use drawing::{
    Clip, Drawing, DrawnCurve, DrawnPoint, FaceInfo, FillRule, Layer, Seed, SeedKind, Shape, SizeRequest, Skipped,
    Unmatched,
};
pub use features::Features;
pub use locate::Locator;
pub use planar::{Corner, Domain, DomainCurve, Incident, Region};
