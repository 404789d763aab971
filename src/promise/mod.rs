//! What engine and verifier both know: to what a mesh is held, and what theory covers.

mod angle;
mod density;

pub use angle::{ANGLE_RULE_GUARANTEE_RAD, arc_turning, guaranteed_angle};
pub use density::{Densities, DensityPromise};

use crate::size::Sizing;

/// What a mesh is held to.
#[derive(Clone, Debug)]
pub struct Promise {
    /// κ, the smallest angle asked for; `None`: not asked.
    pub angle_min_rad: Option<f64>,
    /// Bounds on edge lengths, areas, chord errors and turnings.
    pub sizing: Sizing,
    /// Which engine made the mesh, with the bounds of that engine alone.
    pub engine: EnginePromise,
    /// A mesh from elsewhere: no links to curves, balls taken as (√2−1)·lfs₀.
    pub foreign: bool,
}

/// What the engine promises of itself.
#[derive(Clone, Copy, Debug)]
pub enum EnginePromise {
    /// Corner lopping: the mesh is Delaunay.
    Lopping(LoppingPromise),
    /// Generalized constrained refinement: the mesh is constrained Delaunay.
    Constrained(ConstrainedPromise),
}

/// What corner lopping promises: empty diametral circles, and balls around sharp corners.
#[derive(Clone, Copy, Debug)]
pub struct LoppingPromise {
    /// β, the factor by which a protecting ball shrinks: from ½ to below 1.
    pub beta: f64,
    /// The largest turning of a corner arc, where corner arcs were on: which excuse holds, and C₀.
    pub arc_turning_rad: Option<f64>,
    /// The bisector rule (whose η, μ are known), or the angle rule (η ≥ √2).
    pub midpoint_bisector: bool,
}

/// What generalized constrained Delaunay refinement promises instead.
#[derive(Clone, Copy, Debug)]
pub struct ConstrainedPromise {
    /// The angle is proven on segments that meet at more than this; `None`: nowhere.
    pub proven_above_rad: Option<f64>,
}

impl Promise {
    /// What corner lopping promises, where it made the mesh.
    pub fn lopping(&self) -> Option<&LoppingPromise> {
        match &self.engine {
            EnginePromise::Lopping(lopping) => Some(lopping),
            EnginePromise::Constrained(_) => None,
        }
    }

    /// Whether the mesh is constrained Delaunay only.
    pub fn is_constrained(&self) -> bool {
        self.lopping().is_none()
    }

    /// Whether corner arcs stand around sharp corners.
    pub fn has_corner_arcs(&self) -> bool {
        self.lopping().is_some_and(|lopping| lopping.arc_turning_rad.is_some())
    }
}
