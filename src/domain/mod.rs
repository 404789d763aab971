//! The input of a mesh: a [`Drawing`] as found, and the [`Domain`] (PRCC) that [`Drawing::arrange`] makes of it.

mod arrange;
mod drawing;
mod features;
mod flaws;
mod locate;
mod naming;
mod planar;

pub use arrange::{ArrangeError, ArrangeOptions, Loose, Repair, RepairKind, Unarranged};
pub use drawing::{
    Clip, Drawing, DrawnCurve, DrawnPoint, FaceInfo, FillRule, Label, Layer, OffPlane, Seed, SeedKind, Shape,
    SizeRequest, Skipped, Unmatched,
};
pub use features::Features;
pub use locate::Locator;
pub use naming::{NameBy, Naming, Target};
pub use planar::{Corner, Domain, DomainCurve, Incident, Region};
