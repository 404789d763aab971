//! The planar kernel and its engines.

pub mod insert;
mod remove;
pub mod triangulation;
