//! Options of pictures: colours, and the window.

use clap::ValueEnum;
use serde::Serialize;
use squinch::geometry::Rect;
use squinch::picture::MeshColour;

/// What colours the triangles.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Colour {
    Quality,
    Region,
    Paint,
    Size,
    Layer,
}

impl Colour {
    /// The colouring of a mesh.
    pub fn of_mesh(self) -> MeshColour {
        match self {
            Self::Quality => MeshColour::Quality,
            Self::Region => MeshColour::Region,
            Self::Size => MeshColour::Size,
            Self::Paint => MeshColour::Paint,
            // Layers colour drawings only. A mesh is coloured by region.
            Self::Layer => MeshColour::Region,
        }
    }
}

/// Parses a window.
pub fn window(text: &str) -> Result<Rect, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse::<f64>()).collect();
    match numbers.as_deref() {
        Ok(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 && [x0, y0, x1, y1].iter().all(|x| x.is_finite()) => {
            Ok(Rect::new(x0, y0, x1, y1))
        }
        _ => Err("four numbers X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 are expected".into()),
    }
}
