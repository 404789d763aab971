//! The planar kernel and its engines.

pub mod insert;
pub mod triangulation;
