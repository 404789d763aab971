//! The planar kernel and its engines.

pub mod constrained;
mod extraction;
pub mod gcdr;
pub mod insert;
mod labelling;
pub mod lopping;
mod queue;
mod refined;
mod refinement;
mod remove;
mod subcurves;
pub mod triangulation;

pub use subcurves::Midpoint;
