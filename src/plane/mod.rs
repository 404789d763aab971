//! The planar kernel and its engines.

mod balls;
mod carve;
pub mod insert;
mod remove;
pub mod triangulation;

pub use subcurves::Midpoint;
