//! The text of the legend below a picture: names of areas and lines, kinds of markers, a scale of colours.

use super::PictureOptions;
use super::canvas::Colour;
use super::markers::{self, Mended};

/// The legend of a picture.
#[derive(Clone, Debug, Default)]
pub struct Legend {
    /// Names of lines.
    pub lines: Vec<String>,
    /// Names of areas.
    pub areas: Vec<String>,
    /// Markers with their text.
    pub markers: Vec<(Mended, String)>,
    /// Whether a marker may stand for several repairs.
    pub crowded: bool,
    /// The scale of colours.
    pub scale: Option<Scale>,
}

/// A scale of colours with a histogram.
#[derive(Clone, Debug)]
pub struct Scale {
    /// Its title.
    pub title: &'static str,
    /// The histogram.
    pub counts: Vec<usize>,
    /// The colours of the bars.
    pub shades: Vec<Colour>,
    /// Position along the scale (0–1) and text.
    pub ticks: Vec<(f64, String)>,
}

impl Legend {
    /// Adds an entry for each kind of repair in `options`.
    pub fn with_markers(self, options: &PictureOptions) -> Self {
        Self { markers: markers::entries(options), crowded: markers::mended(options).count() > 1, ..self }
    }
}
