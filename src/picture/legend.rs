//! What the legend below a picture says: the names of areas and lines, the kinds of markers, a scale of colours.

use super::PictureOptions;
use super::canvas::Colour;
use super::markers::{self, Mended};

/// What a picture explains below itself.
#[derive(Clone, Debug, Default)]
pub struct Legend {
    pub lines: Vec<String>,
    pub areas: Vec<String>,
    pub markers: Vec<(Mended, String)>,
    /// Whether markers may stand for several.
    pub crowded: bool,
    pub scale: Option<Scale>,
}

/// A scale of colours with a histogram.
#[derive(Clone, Debug)]
pub struct Scale {
    pub title: &'static str,
    pub counts: Vec<usize>,
    pub shades: Vec<Colour>,
    /// Place along the scale (0–1) and text.
    pub ticks: Vec<(f64, String)>,
}

impl Legend {
    /// With an entry for every kind of repair that `options` point at.
    pub fn with_markers(self, options: &PictureOptions) -> Self {
        Self { markers: markers::entries(options), crowded: markers::mended(options).count() > 1, ..self }
    }
}
