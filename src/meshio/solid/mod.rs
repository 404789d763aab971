//! Writers of tetrahedral meshes, a file a format; the bytes of each file of an output.

mod groups;
pub mod inp;
pub mod medit;
pub mod msh;
pub mod su2;
pub mod tetgen;
pub mod vtu;
