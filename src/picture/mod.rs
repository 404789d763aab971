//! Pictures of a drawing, a domain and a mesh: curves by the name of their boundary, cells by quality, region or size.
//!
//! `scene.rs` draws each of them on a `sheet.rs` with its `annotations.rs`. The result is a [`Canvas`] in pixels,
//! written as SVG or painted as PNG.
//!
//! ```text
//!     layers, from below:    drawing                domain              mesh
//!                            curves by name         regions             cells by colour
//!                            points, ends           curves by name      edges, thin
//!                            labels of seeds        points of P         boundary edges by name
//!                                                   acute corners       balls, dashed
//!                            ────────── repairs, marks and labels, caption and legend ──────────
//! ```

mod annotations;
mod canvas;
mod cells;
mod frame;
mod glyphs;
mod legend;
mod markers;
mod palette;
mod path;
mod scene;
mod sheet;
mod used;
mod words;

pub use canvas::Canvas;
pub use scene::{picture_of_domain, picture_of_drawing, picture_of_mesh};

use crate::domain::Repair;
use crate::geometry::{Point, Rect};
use std::io;
use std::path::Path;

/// A format of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// As text.
    Svg,
    /// In pixels.
    Png,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 2] = [Self::Svg, Self::Png];

    /// The name by which a user asks for the format, equal to the suffix of its files.
    pub const fn name(self) -> &'static str {
        self.suffixes()[0]
    }

    /// The suffix of its file.
    pub const fn suffixes(self) -> &'static [&'static str] {
        match self {
            Self::Svg => &["svg"],
            Self::Png => &["png"],
        }
    }

    /// The format of this name, in any case.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name().eq_ignore_ascii_case(name))
    }

    /// The format that a path's suffix asks for.
    pub fn of(path: &Path) -> Option<Self> {
        Self::named(path.extension()?.to_str()?)
    }

    /// A picture as the bytes of a file.
    ///
    /// # Errors
    /// Where the picture is larger than memory.
    pub fn encode(self, canvas: &Canvas) -> io::Result<Vec<u8>> {
        match self {
            Self::Svg => canvas.svg().map(String::into_bytes),
            Self::Png => canvas.png(1.0),
        }
    }
}

/// What colours the triangles of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MeshColour {
    /// The smallest angle, 0–60°.
    #[default]
    Quality,
    /// The name of the region: one colour for each name.
    Region,
    /// The colour of the region in the drawing; without one, that of `Region`.
    Paint,
    /// The root of the area, on a logarithmic scale.
    Size,
}

/// Options of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureOptions {
    /// Width in pixels, from 120 to 8192; other values are clamped.
    pub width_px: u32,
    /// The window to show, in the drawing's units; `None`: all of it.
    pub view: Option<Rect>,
    /// Whether protecting balls are drawn, as dashed circles.
    pub balls: bool,
    /// Of a drawing: whether curves are coloured by layer instead of by name.
    pub layers: bool,
    /// Places to mark with a label: flaws.
    pub marks: Vec<(Point, String)>,
    /// Repairs, marked by kind. Where many are near each other, one marker has their number beside it.
    pub repairs: Vec<Repair>,
    /// Flaws that were found and not repaired, marked likewise.
    pub unhealed: Vec<Repair>,
    /// The beginning of the caption.
    pub title: String,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            width_px: 1200,
            view: None,
            balls: true,
            layers: false,
            marks: Vec::new(),
            repairs: Vec::new(),
            unhealed: Vec::new(),
            title: String::new(),
        }
    }
}

/// Names of the colour classes, for options: "quality", "region", "paint", "size".
impl std::str::FromStr for MeshColour {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "quality" => Ok(Self::Quality),
            "region" => Ok(Self::Region),
            "paint" => Ok(Self::Paint),
            "size" => Ok(Self::Size),
            _ => Err(format!("'{text}' is not a colouring: quality, region, paint or size")),
        }
    }
}
