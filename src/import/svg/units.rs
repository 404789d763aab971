//! Lengths, transforms and view boxes (SVG 2, chapters 8 and 9), and the page: what a user unit is, and where up is.

use crate::geometry::Vec2;
use kurbo::{Affine, Size};
use roxmltree::Node;
use std::str::FromStr;
use svgtypes::{Align, AspectRatio, Length, LengthUnit, TransformListParser, TransformListToken, ViewBox};

/// CSS: an inch has 96 px.
pub(super) const CSS_DPI: f64 = 96.0;
/// The size of a drawing that says none, for percentages (CSS 2.2, section 10.3.2).
const DEFAULT_SIZE: Size = Size::new(300.0, 150.0);

/// What a percentage is a share of.
#[derive(Clone, Copy)]
pub(super) enum Axis {
    X,
    Y,
    /// The diagonal over √2.
    Both,
}

/// Inches in a unit that has a size of its own; px by `dpi`.
fn inches(unit: LengthUnit, dpi: f64) -> Option<f64> {
    match unit {
        LengthUnit::None | LengthUnit::Px => Some(1.0 / dpi),
        LengthUnit::In => Some(1.0),
        LengthUnit::Cm => Some(1.0 / 2.54),
        LengthUnit::Mm => Some(0.1 / 2.54),
        LengthUnit::Pt => Some(1.0 / 72.0),
        LengthUnit::Pc => Some(1.0 / 6.0),
        LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => None,
    }
}

/// A viewport in user units, by which lengths are read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Viewport {
    pub size: Size,
    pub dpi: f64,
}

impl Viewport {
    /// A length in user units; `None` where the text is none. A letter is taken to be 16 px high (`em`).
    pub fn length(&self, text: &str, axis: Axis) -> Option<f64> {
        let Length { number, unit } = Length::from_str(text.trim()).ok()?;
        let Size { width, height } = self.size;
        Some(match unit {
            LengthUnit::None | LengthUnit::Px => number,
            LengthUnit::Em => 16.0 * number,
            LengthUnit::Ex => 8.0 * number,
            LengthUnit::Percent => {
                let whole = match axis {
                    Axis::X => width,
                    Axis::Y => height,
                    Axis::Both => libm::hypot(width, height) * std::f64::consts::FRAC_1_SQRT_2,
                };
                whole * number / 100.0
            }
            absolute => number * self.dpi * inches(absolute, self.dpi)?,
        })
    }
}

/// Cosine and sine of an angle in degrees; exact at quarter turns.
fn direction(degrees: f64) -> Vec2 {
    let quarters = degrees / 90.0;
    if quarters == libm::floor(quarters) {
        let turns = quarters - 4.0 * libm::floor(quarters / 4.0);
        return [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0), Vec2::new(-1.0, 0.0), Vec2::new(0.0, -1.0)][turns as usize];
    }
    let (sin, cos) = libm::sincos(degrees.to_radians());
    Vec2::new(cos, sin)
}

/// The map of a `transform`; `None` where it cannot be read. The property of CSS may carry the units `px` and `deg`.
pub(super) fn transform(text: &str) -> Option<Affine> {
    if text.trim() == "none" {
        return Some(Affine::IDENTITY);
    }
    let plain = text.replace("px", "").replace("deg", "");
    let mut map = Affine::IDENTITY;
    for token in TransformListParser::from(plain.as_str()) {
        let skew = |degrees: f64| libm::tan(degrees.to_radians());
        map *= match token.ok()? {
            TransformListToken::Matrix { a, b, c, d, e, f } => Affine::new([a, b, c, d, e, f]),
            TransformListToken::Translate { tx, ty } => Affine::translate((tx, ty)),
            TransformListToken::Scale { sx, sy } => Affine::scale_non_uniform(sx, sy),
            TransformListToken::Rotate { angle } => {
                let Vec2 { x, y } = direction(angle);
                Affine::new([x, y, -y, x, 0.0, 0.0])
            }
            TransformListToken::SkewX { angle } => Affine::new([1.0, 0.0, skew(angle), 1.0, 0.0, 0.0]),
            TransformListToken::SkewY { angle } => Affine::new([1.0, skew(angle), 0.0, 1.0, 0.0, 0.0]),
        };
    }
    Some(map)
}

/// The view box of an element, where it has one; `Some(None)` of one without extent, which shows nothing.
pub(super) fn view_box(node: Node) -> Option<Option<ViewBox>> {
    node.attribute("viewBox").map(|text| ViewBox::from_str(text).ok())
}

fn aspect_ratio(node: Node) -> AspectRatio {
    let default = AspectRatio { defer: false, align: Align::XMidYMid, slice: false };
    node.attribute("preserveAspectRatio").and_then(|text| AspectRatio::from_str(text).ok()).unwrap_or(default)
}

/// From the view box of `node` to a viewport of this size at the origin.
pub(super) fn fit(node: Node, view: ViewBox, size: Size) -> Affine {
    let AspectRatio { align, slice, .. } = aspect_ratio(node);
    let (sx, sy) = (size.width / view.w, size.height / view.h);
    let origin = Affine::translate((-view.x, -view.y));
    let common = if slice { sx.max(sy) } else { sx.min(sy) };
    let (x, y) = match align {
        Align::None => return Affine::scale_non_uniform(sx, sy) * origin,
        Align::XMinYMin => (0.0, 0.0),
        Align::XMidYMin => (0.5, 0.0),
        Align::XMaxYMin => (1.0, 0.0),
        Align::XMinYMid => (0.0, 0.5),
        Align::XMidYMid => (0.5, 0.5),
        Align::XMaxYMid => (1.0, 0.5),
        Align::XMinYMax => (0.0, 1.0),
        Align::XMidYMax => (0.5, 1.0),
        Align::XMaxYMax => (1.0, 1.0),
    };
    let rest = Vec2::new(x * (size.width - common * view.w), y * (size.height - common * view.h));
    Affine::translate(rest) * Affine::scale(common) * origin
}

/// What the outermost element says of the whole.
pub(super) struct Page {
    /// Turns y upward: the mirror image in the view box, of a page without one in its height, else about y = 0.
    pub upward: Affine,
    pub viewport: Viewport,
    /// What a user unit is, and where that was read.
    pub unit: (String, String),
    pub notes: Vec<String>,
}

impl Page {
    pub fn new(root: Node, dpi: f64) -> Self {
        let view = view_box(root).flatten();
        let absolute = |name| {
            let length = Length::from_str(root.attribute(name)?.trim()).ok()?;
            let inches = length.number * inches(length.unit, dpi)?;
            (inches > 0.0 && inches.is_finite()).then_some((length, inches))
        };
        let (width, height) = (absolute("width"), absolute("height"));
        let px = |side: Option<(Length, f64)>| side.map(|(_, inches)| inches * dpi);
        let size = match view {
            Some(view) => Size::new(view.w, view.h),
            None => Size::new(px(width).unwrap_or(DEFAULT_SIZE.width), px(height).unwrap_or(DEFAULT_SIZE.height)),
        };
        let mirror = match view {
            Some(view) => 2.0 * view.y + view.h,
            None => px(height).unwrap_or(0.0),
        };
        let mut notes = Vec::new();
        let unit = user_unit(root, view, width, height, dpi, &mut notes);
        let upward = Affine::new([1.0, 0.0, 0.0, -1.0, 0.0, mirror]);
        Self { upward, viewport: Viewport { size, dpi }, unit, notes }
    }
}

/// What one user unit is, as a unit of length with a factor where that is not 1, and where it was read.
fn user_unit(
    root: Node,
    view: Option<ViewBox>,
    width: Option<(Length, f64)>,
    height: Option<(Length, f64)>,
    dpi: f64,
    notes: &mut Vec<String>,
) -> (String, String) {
    let across = view.zip(width).map(|(view, (length, inches))| (length, inches / length.number, view.w));
    let up = view.zip(height).map(|(view, (length, inches))| (length, inches / length.number, view.h));
    let size = |(length, inches, extent): (Length, f64, f64)| length.number * inches / extent;
    let chosen = match (across, up) {
        // Exporters round: a thousandth is no stretching.
        (Some(x), Some(y)) if (size(x) - size(y)).abs() > 1e-3 * size(x) => {
            let AspectRatio { align, slice, .. } = aspect_ratio(root);
            if align == Align::None {
                notes.push("width and height stretch the view box; the drawing was left as it is drawn.".into());
            }
            let takes_up = align != Align::None && (size(y) < size(x)) != slice;
            Some(if takes_up { y } else { x })
        }
        (x, y) => x.or(y),
    };
    let assumed = || (format!("{dpi} px to an inch, as no physical size is given"), 1.0, LengthUnit::Px);
    let (from, factor, unit) = match chosen {
        Some((length, _, extent)) if !matches!(length.unit, LengthUnit::None | LengthUnit::Px) => {
            ("width, height and viewBox".to_owned(), length.number / extent, length.unit)
        }
        Some((length, _, extent)) => (assumed().0, length.number / extent, LengthUnit::Px),
        None => assumed(),
    };
    let (factor, word) = match unit {
        LengthUnit::Mm => (factor, "mm"),
        LengthUnit::Cm => (factor, "cm"),
        LengthUnit::In => (factor, "in"),
        LengthUnit::Pt => (factor, "pt"),
        LengthUnit::Pc => (factor, "pc"),
        _ if dpi == CSS_DPI => (factor, "px"),
        _ => (factor / dpi, "in"),
    };
    // A factor of 1 that a quotient of rounded sizes missed.
    let text = if (factor - 1.0).abs() < 1e-9 { word.to_owned() } else { format!("{factor} {word}") };
    (text, from)
}
