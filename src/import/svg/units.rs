//! Lengths, angles and view boxes (SVG 2, chapter 8; CSS Values 4), and the page: the size of a user unit, and the
//! direction of y.

use crate::geometry::{Rect, Vec2};
use kurbo::{Affine, Size};
use roxmltree::Node;
use std::str::FromStr;
use svgtypes::{Align, AspectRatio, ViewBox};

/// Pixels of CSS to an inch.
pub(super) const CSS_DPI: f64 = 96.0;
/// The size of a drawing that gives none, for percentages (CSS 2.2, section 10.3.2).
const DEFAULT_SIZE: Size = Size::new(300.0, 150.0);

/// The length that a percentage refers to.
#[derive(Clone, Copy)]
pub(super) enum Axis {
    X,
    Y,
    /// The diagonal over √2.
    Both,
}

/// A number with its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Quantity<'a> {
    /// The number.
    pub number: f64,
    /// The text of the unit, empty where there is none.
    pub unit: &'a str,
}

impl<'a> Quantity<'a> {
    /// The first quantity of a text, and the rest.
    pub fn first(text: &'a str) -> Option<(Self, &'a str)> {
        let bytes = text.as_bytes();
        let digits = |from: usize| from + bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
        let sign = |at: usize| at + usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
        let whole = digits(sign(0));
        let mut end = if bytes.get(whole) == Some(&b'.') { digits(whole + 1) } else { whole };
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            // An exponent has digits; the unit `em` has none.
            let exponent = sign(end + 1);
            end = if digits(exponent) > exponent { digits(exponent) } else { end };
        }
        let number = text[..end].parse().ok()?;
        let rest = &text[end..];
        let unit = rest.find(|c: char| !c.is_ascii_alphabetic() && c != '%').unwrap_or(rest.len());
        let (unit, rest) = rest.split_at(unit);
        Some((Self { number, unit }, rest))
    }

    /// A text that is exactly one quantity.
    pub fn parse(text: &'a str) -> Option<Self> {
        let (quantity, rest) = Self::first(text.trim())?;
        rest.is_empty().then_some(quantity)
    }

    /// The size of an absolute unit in inches; px by `dpi`.
    fn inches(self, dpi: f64) -> Option<f64> {
        match self.unit.to_ascii_lowercase().as_str() {
            "" | "px" => Some(1.0 / dpi),
            "in" => Some(1.0),
            "cm" => Some(1.0 / 2.54),
            "mm" => Some(0.1 / 2.54),
            "q" => Some(0.025 / 2.54),
            "pt" => Some(1.0 / 72.0),
            "pc" => Some(1.0 / 6.0),
            _ => None,
        }
    }

    /// An angle in degrees. A number without unit is in degrees.
    pub fn degrees(self) -> Option<f64> {
        match self.unit.to_ascii_lowercase().as_str() {
            "" | "deg" => Some(self.number),
            "grad" => Some(0.9 * self.number),
            "rad" => Some(self.number.to_degrees()),
            "turn" => Some(360.0 * self.number),
            _ => None,
        }
    }
}

/// A viewport in user units. Lengths refer to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Viewport {
    /// Width and height.
    pub size: Size,
    /// Pixels to an inch.
    pub dpi: f64,
}

/// Pixels of the font size: em, ex and similar units are parts of it. Fonts are not read.
const LETTER: f64 = 16.0;

impl Viewport {
    /// A length in user units; `None` where the text is not a length. The font size (`em`) is taken to be 16 px.
    pub fn length(&self, text: &str, axis: Axis) -> Option<f64> {
        self.measure(Quantity::parse(text)?, axis)
    }

    /// A quantity in user units.
    pub fn measure(&self, quantity: Quantity, axis: Axis) -> Option<f64> {
        let Size { width, height } = self.size;
        let share = match quantity.unit.to_ascii_lowercase().as_str() {
            "em" | "rem" | "lh" | "rlh" | "ic" => LETTER,
            "ex" | "ch" | "cap" => 0.5 * LETTER,
            "vw" | "vi" | "svw" | "lvw" | "dvw" => width / 100.0,
            "vh" | "vb" | "svh" | "lvh" | "dvh" => height / 100.0,
            "vmin" => width.min(height) / 100.0,
            "vmax" => width.max(height) / 100.0,
            "%" => match axis {
                Axis::X => width / 100.0,
                Axis::Y => height / 100.0,
                Axis::Both => libm::hypot(width, height) * std::f64::consts::FRAC_1_SQRT_2 / 100.0,
            },
            "" | "px" => 1.0,
            _ => self.dpi * quantity.inches(self.dpi)?,
        };
        Some(quantity.number * share)
    }
}

/// The view box of an element, if it has one. `Some(None)`: a view box without extent, which shows nothing.
pub(super) fn view_box(node: Node) -> Option<Option<ViewBox>> {
    node.attribute("viewBox").map(|text| ViewBox::from_str(text).ok())
}

fn aspect_ratio(node: Node) -> AspectRatio {
    let default = AspectRatio { defer: false, align: Align::XMidYMid, slice: false };
    node.attribute("preserveAspectRatio").and_then(|text| AspectRatio::from_str(text).ok()).unwrap_or(default)
}

/// The map from the view box of `node` to a viewport of this size at the origin.
///
/// ```text
///    view box (min-x, min-y, w, h)        viewport (0, 0, W, H)        "xMidYMid meet": one scale for both axes,
///    ┌───────────────┐                    ┌───────┬───────┬───┐        min(W/w, H/h), and equal margins.
///    │      ◯        │      ──────▶       │       │   ◯   │   │        "slice" takes max(W/w, H/h): the rest reaches
///    └───────────────┘                    └───────┴───────┴───┘        beyond the viewport, which cuts it.
/// ```
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

/// The facts that the outermost element gives about the file.
pub(super) struct Page {
    /// The map that turns y upward: a mirror image in the view box, else in the height, else about y = 0.
    pub upward: Affine,
    /// The viewport of the outermost element.
    pub viewport: Viewport,
    /// The area of the page, in user units; `None` where the file gives no size.
    pub frame: Option<Rect>,
    /// The size of a user unit, and where it was read.
    pub unit: (String, String),
    /// Notes about the page.
    pub notes: Vec<String>,
}

impl Page {
    /// Reads the page.
    pub fn new(root: Node, dpi: f64) -> Self {
        let view = view_box(root).flatten();
        let absolute = |name| {
            let length = Quantity::parse(root.attribute(name)?)?;
            let inches = length.number * length.inches(dpi)?;
            (inches > 0.0 && inches.is_finite()).then_some((length, inches))
        };
        let (width, height) = (absolute("width"), absolute("height"));
        let px = |side: Option<(Quantity, f64)>| side.map(|(_, inches)| inches * dpi);
        let size = match view {
            Some(view) => Size::new(view.w, view.h),
            None => Size::new(px(width).unwrap_or(DEFAULT_SIZE.width), px(height).unwrap_or(DEFAULT_SIZE.height)),
        };
        let mirror = match view {
            Some(view) => 2.0 * view.y + view.h,
            None => px(height).unwrap_or(0.0),
        };
        let in_px = px(width).zip(px(height)).map(|(width, height)| Size::new(width, height));
        let frame = match (view, in_px) {
            (Some(view), Some(size)) => {
                let shown = Rect::from_origin_size((0.0, 0.0), size);
                Some(fit(root, view, size).inverse().transform_rect_bbox(shown))
            }
            (Some(view), None) => Some(Rect::from_origin_size((view.x, view.y), (view.w, view.h))),
            (None, size) => size.map(|size| Rect::from_origin_size((0.0, 0.0), size)),
        };
        let mut notes = Vec::new();
        let unit = user_unit(root, view, width, height, dpi, &mut notes);
        let upward = Affine::new([1.0, 0.0, 0.0, -1.0, 0.0, mirror]);
        Self { upward, viewport: Viewport { size, dpi }, frame, unit, notes }
    }
}

/// The size of a user unit, as a unit of length with a factor if that is not 1, and where it was read.
fn user_unit(
    root: Node,
    view: Option<ViewBox>,
    width: Option<(Quantity, f64)>,
    height: Option<(Quantity, f64)>,
    dpi: f64,
    notes: &mut Vec<String>,
) -> (String, String) {
    let across = view.zip(width).map(|(view, (length, inches))| (length, inches / length.number, view.w));
    let up = view.zip(height).map(|(view, (length, inches))| (length, inches / length.number, view.h));
    let size = |(length, inches, extent): (Quantity, f64, f64)| length.number * inches / extent;
    let chosen = match (across, up) {
        // Exporters round: a difference of a thousandth is not a distortion.
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
    let px = || "px".to_owned();
    let assumed = || (format!("{dpi} px to an inch, as no physical size is given"), 1.0, px());
    let (from, factor, unit) = match chosen {
        Some((length, _, extent)) if !matches!(length.unit.to_ascii_lowercase().as_str(), "" | "px") => {
            ("width, height and viewBox".to_owned(), length.number / extent, length.unit.to_ascii_lowercase())
        }
        Some((length, _, extent)) => (assumed().0, length.number / extent, px()),
        None => assumed(),
    };
    let (factor, word) = match unit.as_str() {
        "q" => (0.25 * factor, "mm"),
        "px" if dpi == CSS_DPI => (factor, "px"),
        "px" => (factor / dpi, "in"),
        physical => (factor, physical),
    };
    // Quotients of rounded sizes may miss a factor of 1.
    let text = if (factor - 1.0).abs() < 1e-9 { word.to_owned() } else { format!("{factor} {word}") };
    (text, from)
}
