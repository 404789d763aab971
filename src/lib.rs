//! squinch: provably good meshes of domains with curved boundaries.
#![forbid(unsafe_code)]

pub mod canvas;
pub mod case;
pub mod curve;
pub mod domain;
pub mod export;
pub mod generate;
pub mod geometry;
pub mod ids;
pub mod import;
pub mod mesh;
pub mod pipeline;
pub mod plane;
pub mod reduce;
pub mod refine;
pub mod report;
pub mod request;
pub mod size;
