//! Bounds on the density of the vertices that constrained refinement inserts.

/// Bounds on D(p) = lfs(p)/R(p) by the type of p; infinite where there is none (Foteinos, Chernikov & Chrisochoides
/// 2010, section 5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Densities {
    /// Bound for type A: the vertex was inserted for a skinny triangle.
    pub a: f64,
    /// Bound for type B: on a segment with no visible vertex of another segment in its diametral circle.
    pub b: f64,
    /// Bound for type C: on a segment with such a vertex.
    pub c: f64,
}

/// The bounds that densities are checked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DensityPromise {
    /// The largest density allowed, by type.
    pub bounds: Densities,
    /// Whether theory proves the bounds.
    pub proven: bool,
}
