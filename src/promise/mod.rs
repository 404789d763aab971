//! What engine and verifier share: the guarantees that a mesh is checked for, and the angles that theory covers.

mod angle;
mod density;

pub use angle::{ANGLE_RULE_GUARANTEE_RAD, arc_turning, guaranteed_angle};
pub use density::{Densities, DensityPromise};

use crate::size::Sizing;

/// The guarantees that a mesh is checked for.
#[derive(Clone, Debug)]
pub struct Promise {
    /// κ, the smallest angle asked for; `None`: not asked.
    pub angle_min_rad: Option<f64>,
    /// Limits on edge lengths, areas, chord errors and turnings.
    pub sizing: Sizing,
    /// Which engine made the mesh, with the bounds of that engine alone.
    pub engine: EnginePromise,
    /// A mesh from elsewhere: no links to curves, balls taken as (√2−1)·lfs₀.
    pub foreign: bool,
}

/// The guarantees of the engine that made the mesh.
#[derive(Clone, Copy, Debug)]
pub enum EnginePromise {
    /// Corner lopping: the mesh is Delaunay.
    Lopping(LoppingPromise),
    /// Generalized constrained refinement: the mesh is constrained Delaunay.
    Constrained(ConstrainedPromise),
}

/// The guarantees of corner lopping: empty diametral circles, and balls around sharp corners.
#[derive(Clone, Copy, Debug)]
pub struct LoppingPromise {
    /// β, the factor by which a protecting ball shrinks: from ½ to below 1.
    pub beta: f64,
    /// The largest turning of a corner arc, in radians; `None`: no corner arcs. It decides which triangles are exempt,
    /// and C₀.
    pub arc_turning_rad: Option<f64>,
    /// `true`: the bisector rule, whose η and μ are known; `false`: the angle rule, η ≥ √2.
    pub midpoint_bisector: bool,
}

/// The guarantees of generalized constrained Delaunay refinement.
#[derive(Clone, Copy, Debug)]
pub struct ConstrainedPromise {
    /// The angle is proven on segments that meet at more than this, in radians; `None`: nowhere.
    pub proven_above_rad: Option<f64>,
}

impl Promise {
    /// The guarantees of corner lopping, where it made the mesh.
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

    /// Whether there are corner arcs around sharp corners.
    pub fn has_corner_arcs(&self) -> bool {
        self.lopping().is_some_and(|lopping| lopping.arc_turning_rad.is_some())
    }
}
