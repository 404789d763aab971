//! squinch: provably good triangle meshes of domains with curved boundaries.
//!
//! Curves stay curves: lines, arcs, Béziers, splines and clothoids are split to a bounded turning and meshed by
//! corner-lopping Delaunay refinement (Pav & Walkington 2005), which terminates for any angle between them. An
//! independent verifier then checks the mesh against the curves.
//!
//! ```
//! use squinch::plane::lopping::{Options, refine};
//! use squinch::prelude::*;
//!
//! // A disk with a smaller one that touches it from inside: an angle of zero.
//! let mut drawing = Drawing::default();
//! drawing.add(Curve::circle(Point::new(0.0, 0.0), 1.0)?, "rim", "circle 1");
//! drawing.add(Curve::circle(Point::new(0.5, 0.0), 0.5)?, "bore", "circle 2");
//!
//! let tau_rad = 0.5;
//! let domain = drawing.arrange(&ArrangeOptions::default())?.split_to_turning(tau_rad);
//! let options = Options::default();
//! let refined = refine(&domain, &options, Until::End, &mut |_progress| true)?;
//! let mesh = refined.mesh.expect("the budget is large");
//!
//! let verdict = verify(Some(&domain), &mesh, &options.promise(false));
//! assert!(verdict.kept());
//! assert!(mesh.edges_of("bore").count() > 0);
//! assert_eq!(verdict.exempt.len(), 1); // the corner where the circles touch: its sharp triangles are exempt
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`run::run`] does all of this from the bytes of a file, as the command line does.
#![forbid(unsafe_code)]
#![warn(missing_docs, clippy::missing_errors_doc)]

#[cfg(feature = "cad")]
pub mod cad;
pub mod curve;
pub mod domain;
mod formats;
pub mod generate;
pub mod geometry;
pub mod ids;
pub mod import;
pub mod mesh;
pub mod meshio;
pub mod options;
pub mod picture;
pub mod plane;
pub mod prelude;
pub mod promise;
pub mod refine;
pub mod run;
pub mod section;
pub mod size;
pub mod solid;
pub mod space;
pub mod threads;
pub mod verify;
pub mod watch;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
