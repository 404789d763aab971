//! Storage and topology of a triangulation of the whole plane: ids only.
//!
//! Every triangle has three *sides*; side `3t + i` runs from corner i to corner i+1 of triangle t, counter-clockwise, and knows its
//! twin in the neighbour. The outside of the hull is covered by *ghost* triangles, which share the one vertex [`GHOST`] at infinity,
//! so that every side has a twin and the topology is that of a sphere.

use crate::ids::{PieceId, RegionId, TriangleId, VertexId};

/// The vertex at infinity.
pub const GHOST: VertexId = VertexId(u32::MAX);

/// A directed side of a triangle: `3·triangle + i`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Side(pub u32);
