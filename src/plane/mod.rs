//! The planar kernel and its engines.

mod carve;
pub mod constrained;
pub mod gcdr;
mod harvest;
pub mod insert;
pub mod lopping;
mod refined;
mod refinement;
mod remove;
mod subcurves;
mod suspects;
pub mod triangulation;

pub use subcurves::Midpoint;
