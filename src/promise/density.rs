//! Bounds on the density of the vertices that constrained refinement inserts.

/// Bounds on D(p) = lfs(p)/R(p) by the type of p; infinite where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Densities {
    /// Bound for type A: the vertex was inserted for a skinny triangle.
    pub a: f64,
    /// Bound for type B: on a segment with no visible vertex of another segment in its diametral circle.
    pub b: f64,
    /// Bound for type C: on a segment with such a vertex.
    pub c: f64,
}

/// What densities are held to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DensityPromise {
    /// The largest density allowed, by type.
    pub bounds: Densities,
    /// Whether theory stands behind the bounds.
    pub proven: bool,
}
