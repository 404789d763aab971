//! The planar kernel and its engines.

mod balls;
mod carve;
pub mod constrained;
pub mod gcdr;
mod harvest;
pub mod insert;
pub mod lopping;
mod remove;
mod subcurves;
pub mod triangulation;

pub use subcurves::Midpoint;
