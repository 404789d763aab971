//! Bounds on the density of the vertices that constrained refinement inserts.

/// Bounds on D(p) = lfs(p)/R(p) by the type of p; infinite where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Densities {
    pub a: f64,
    pub b: f64,
    pub c: f64,
}

/// What densities are held to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DensityPromise {
    pub bounds: Densities,
    /// Whether theory stands behind the bounds.
    pub proven: bool,
}
