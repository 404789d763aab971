//! How an element is painted: its own declarations and inherited properties (SVG 2, chapter 6).

use super::stroke::{Cap, Join, Pen};
use super::units::{Axis, Quantity, Viewport};
use roxmltree::Node;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::str::FromStr;
use svgtypes::{Color, Paint, PaintFallback};

macro_rules! properties {
    ($($property:ident $name:literal),* $(,)?) => {
        /// A property that matters to outlines.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Property { $($property),* }
        const PROPERTIES: &[(&str, Property)] = &[$(($name, Property::$property)),*];
    };
}
properties! {
    Fill "fill", FillRule "fill-rule", FillOpacity "fill-opacity", Stroke "stroke", StrokeWidth "stroke-width",
    StrokeOpacity "stroke-opacity", StrokeLinecap "stroke-linecap", StrokeLinejoin "stroke-linejoin",
    StrokeMiterlimit "stroke-miterlimit", StrokeDasharray "stroke-dasharray", StrokeDashoffset "stroke-dashoffset",
    VectorEffect "vector-effect", StopColor "stop-color", StopOpacity "stop-opacity", Opacity "opacity", Display "display", Visibility "visibility", Color "color",
    ClipPath "clip-path", ClipRule "clip-rule", Overflow "overflow", Mask "mask", Filter "filter", Marker "marker",
    MarkerStart "marker-start", MarkerMid "marker-mid", MarkerEnd "marker-end", Transform "transform",
    TransformOrigin "transform-origin", TransformBox "transform-box", Translate "translate", Rotate "rotate", Scale "scale",
    X "x", Y "y", Width "width", Height "height", Cx "cx", Cy "cy", R "r", Rx "rx", Ry "ry", D "d",
}

/// The property of this name.
pub(super) fn property(name: &str) -> Option<Property> {
    PROPERTIES.iter().find(|(n, _)| *n == name).map(|(_, property)| *property)
}

/// Largest number of variables within variables.
const SUBSTITUTIONS_MAX: usize = 16;

/// The declarations of one element.
#[derive(Clone, Debug)]
pub(super) struct Declared<'a> {
    values: [Option<&'a str>; PROPERTIES.len()],
    custom: Vec<(&'a str, &'a str)>,
    /// Property and value, where the value is of an unsupported kind: a variable without value, or a calculation.
    pub unread: Vec<(&'static str, &'a str)>,
}

impl Default for Declared<'_> {
    fn default() -> Self {
        Self { values: [None; PROPERTIES.len()], custom: Vec::new(), unread: Vec::new() }
    }
}

/// Custom properties, by their names.
type Variables<'a> = Rc<BTreeMap<&'a str, &'a str>>;

impl<'a> Declared<'a> {
    /// The presentation attributes of an element.
    pub fn of_attributes(node: Node<'a, 'a>) -> Self {
        let mut declared = Self::default();
        for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
            // `rotate` is an attribute of text, not the property of that name.
            let known = property(attribute.name());
            let known = known.filter(|p| !matches!(p, Property::Translate | Property::Rotate | Property::Scale));
            known.into_iter().for_each(|property| declared.set(property, attribute.value().trim()));
        }
        declared
    }

    /// The value of a property.
    pub fn get(&self, property: Property) -> Option<&'a str> {
        self.values[property as usize]
    }

    /// The value of a property, unless it is a keyword that all properties have.
    pub fn given(&self, property: Property) -> Option<&'a str> {
        self.get(property).filter(|value| !is_wide(value))
    }

    /// Declares a property.
    pub fn set(&mut self, property: Property, value: &'a str) {
        // An invalid value is not a declaration: the one with lower precedence counts.
        let valid = match property {
            _ if value.contains("var(") || is_wide(value) => true,
            Property::Fill | Property::Stroke => paint(value).is_some(),
            Property::FillRule | Property::ClipRule => matches!(value, "nonzero" | "evenodd"),
            _ => true,
        };
        if valid {
            self.values[property as usize] = Some(value);
        }
    }

    /// Declares a variable.
    pub fn set_custom(&mut self, name: &'a str, value: &'a str) {
        self.custom.push((name, value));
    }

    /// The declarations with values in place of variables. Keywords that stand for no value are removed.
    fn resolved(mut self, variables: &Variables<'a>) -> Self {
        for (&(name, property), value) in PROPERTIES.iter().zip(&mut self.values) {
            let Some(given) = *value else { continue };
            *value = substituted(given, variables);
            if value.is_none_or(|value| !is_told(property) && is_calculated(value)) {
                self.unread.push((name, given));
            }
        }
        self
    }

    /// A value from 0 to 1, as an opacity; 1 where none is given.
    pub fn opacity(&self, property: Property) -> f64 {
        self.given(property).and_then(share).unwrap_or(1.0)
    }
}

/// Whether a value contains a calculating function of CSS. None is read.
fn is_calculated(value: &str) -> bool {
    ["calc(", "min(", "max(", "clamp("].iter().any(|function| value.contains(function))
}

/// Whether the place that reads the property reports an invalid value.
fn is_told(property: Property) -> bool {
    use Property::{ClipPath, Rotate, Scale, Transform, Translate};
    matches!(property, ClipPath | Rotate | Scale | Transform | Translate)
}

/// Whether a value is a keyword that all properties have.
fn is_wide(value: &str) -> bool {
    matches!(value, "inherit" | "initial" | "unset" | "revert" | "revert-layer")
}

/// The value, or in place of a variable its value or fallback; `None` where it has neither. A variable among other
/// words is not read.
fn substituted<'a>(text: &'a str, variables: &Variables<'a>) -> Option<&'a str> {
    let mut text = text;
    for _ in 0..SUBSTITUTIONS_MAX {
        let Some(inner) = text.strip_prefix("var(").and_then(|rest| rest.strip_suffix(')')) else {
            return (!text.contains("var(")).then_some(text);
        };
        let (name, fallback) = inner.split_once(',').map_or((inner, None), |(name, rest)| (name, Some(rest.trim())));
        text = variables.get(name.trim()).copied().or(fallback)?;
    }
    None
}

/// A number or percentage, as a value from 0 to 1.
pub(super) fn share(text: &str) -> Option<f64> {
    let Quantity { number, unit } = Quantity::parse(text)?;
    let share = if unit == "%" { number / 100.0 } else { number };
    Some(share.clamp(0.0, 1.0))
}

/// Red, green, blue and opacity of a colour, by name or by number.
pub(super) fn rgba(text: &str) -> Option<[f64; 4]> {
    let Color { red, green, blue, alpha } = Color::from_str(text.trim()).ok()?;
    Some([red, green, blue, alpha].map(|part| f64::from(part) / 255.0))
}

// ---- inheritance ----

/// The inherited properties of an element.
#[derive(Clone, Debug)]
pub(super) struct Style<'a> {
    fill: &'a str,
    /// Whether the fill rule is even-odd.
    pub even_odd: bool,
    /// Opacity of the fill, from 0 to 1.
    pub fill_opacity: f64,
    stroke: &'a str,
    /// Opacity of the stroke, from 0 to 1.
    pub stroke_opacity: f64,
    stroke_width: &'a str,
    line_cap: &'a str,
    line_join: &'a str,
    miter_limit: &'a str,
    dashes: &'a str,
    dash_offset: &'a str,
    /// Whether the element is visible.
    pub visible: bool,
    color: &'a str,
    /// Whether the rule of the outline as a part of a clip path is even-odd.
    pub clip_even_odd: bool,
    variables: Variables<'a>,
}

impl Default for Style<'_> {
    fn default() -> Self {
        Self {
            fill: "black",
            even_odd: false,
            fill_opacity: 1.0,
            stroke: "none",
            stroke_opacity: 1.0,
            stroke_width: "1",
            line_cap: "butt",
            line_join: "miter",
            miter_limit: "4",
            dashes: "none",
            dash_offset: "0",
            visible: true,
            color: "black",
            clip_even_odd: false,
            variables: Variables::default(),
        }
    }
}

/// How an element is filled or stroked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Painted<'a> {
    No,
    /// A colour, as `#rrggbb` or as its keyword.
    Colour(String),
    /// The gradient or pattern of this id, or the fallback.
    Server(&'a str, Option<String>),
}

impl<'a> Style<'a> {
    /// The style of an element inside one of this style, and its declarations with values in place of variables.
    pub fn of(&self, declared: Declared<'a>) -> (Self, Declared<'a>) {
        let mut style = self.clone();
        if !declared.custom.is_empty() {
            let own = declared.custom.iter().copied();
            style.variables = Rc::new(self.variables.iter().map(|(name, value)| (*name, *value)).chain(own).collect());
        }
        let declared = declared.resolved(&style.variables);
        let first = Self::default();
        let above = |property| if declared.get(property) == Some("initial") { &first } else { self };
        let given = |property| declared.given(property);
        let opacity = |property, inherited: f64| given(property).and_then(share).unwrap_or(inherited);
        let rule = |property, inherited: bool| given(property).map_or(inherited, |rule| rule == "evenodd");
        style.fill = given(Property::Fill).unwrap_or(above(Property::Fill).fill);
        style.stroke = given(Property::Stroke).unwrap_or(above(Property::Stroke).stroke);
        style.color = given(Property::Color).unwrap_or(above(Property::Color).color);
        style.even_odd = rule(Property::FillRule, above(Property::FillRule).even_odd);
        style.clip_even_odd = rule(Property::ClipRule, above(Property::ClipRule).clip_even_odd);
        style.visible = given(Property::Visibility).map_or(above(Property::Visibility).visible, |v| v == "visible");
        style.fill_opacity = opacity(Property::FillOpacity, above(Property::FillOpacity).fill_opacity);
        style.stroke_opacity = opacity(Property::StrokeOpacity, above(Property::StrokeOpacity).stroke_opacity);
        let width = given(Property::StrokeWidth).filter(|width| Quantity::parse(width).is_some());
        style.stroke_width = width.unwrap_or(above(Property::StrokeWidth).stroke_width);
        style.line_cap = given(Property::StrokeLinecap).unwrap_or(above(Property::StrokeLinecap).line_cap);
        style.line_join = given(Property::StrokeLinejoin).unwrap_or(above(Property::StrokeLinejoin).line_join);
        style.miter_limit = given(Property::StrokeMiterlimit).unwrap_or(above(Property::StrokeMiterlimit).miter_limit);
        style.dashes = given(Property::StrokeDasharray).unwrap_or(above(Property::StrokeDasharray).dashes);
        style.dash_offset = given(Property::StrokeDashoffset).unwrap_or(above(Property::StrokeDashoffset).dash_offset);
        (style, declared)
    }

    /// How the element is filled.
    pub fn fill(&self) -> Painted<'a> {
        if self.fill_opacity > 0.0 { self.painted(self.fill) } else { Painted::No }
    }

    /// How the element is stroked.
    pub fn stroke(&self) -> Painted<'a> {
        let has_width = Quantity::parse(self.stroke_width).is_none_or(|width| width.number > 0.0);
        if self.stroke_opacity > 0.0 && has_width { self.painted(self.stroke) } else { Painted::No }
    }

    /// How strokes are drawn. An invalid value counts as not given.
    pub fn pen(&self, viewport: Viewport) -> Pen {
        let length = |text: &str| viewport.length(text, Axis::Both);
        let words = self.dashes.split([',', ' ', '\t', '\n']).filter(|word| !word.is_empty());
        Pen {
            width: length(self.stroke_width).unwrap_or(1.0),
            cap: match self.line_cap {
                "round" => Cap::Round,
                "square" => Cap::Square,
                _ => Cap::Butt,
            },
            join: match self.line_join {
                "round" => Join::Round,
                "bevel" => Join::Bevel,
                _ => Join::Miter,
            },
            miter_limit: self.miter_limit.parse().ok().filter(|limit| *limit >= 1.0).unwrap_or(4.0),
            dashes: words.map(length).collect::<Option<_>>().unwrap_or_default(),
            dash_offset: length(self.dash_offset).unwrap_or(0.0),
        }
    }

    fn painted(&self, value: &'a str) -> Painted<'a> {
        let current = || colour(self.color, Color::from_str(self.color).unwrap_or(Color::black()));
        match paint(value) {
            None | Some(Paint::None | Paint::Inherit | Paint::ContextFill | Paint::ContextStroke) => Painted::No,
            Some(Paint::CurrentColor) => current().map_or(Painted::No, Painted::Colour),
            Some(Paint::Color(c)) => colour(value, c).map_or(Painted::No, Painted::Colour),
            Some(Paint::FuncIRI(id, fallback)) => {
                let fallback = fallback.and_then(|fallback| match fallback {
                    PaintFallback::None => None,
                    PaintFallback::CurrentColor => current(),
                    PaintFallback::Color(c) => colour("", c),
                });
                Painted::Server(id, fallback)
            }
        }
    }
}

/// A paint, without an ICC colour after it.
fn paint(value: &str) -> Option<Paint<'_>> {
    let value = value.split(" icc-color(").next().unwrap_or(value).trim();
    if value.eq_ignore_ascii_case("currentcolor") {
        return Some(Paint::CurrentColor);
    }
    Paint::from_str(value).ok()
}

/// The name of a colour: its keyword if given as one, else `#rrggbb`; `None` of an invisible one.
fn colour(text: &str, color: Color) -> Option<String> {
    let word = text.trim();
    if color.alpha == 0 {
        None
    } else if !word.is_empty() && word.bytes().all(|b| b.is_ascii_alphabetic()) {
        Some(word.to_ascii_lowercase())
    } else {
        Some(format!("#{:02x}{:02x}{:02x}", color.red, color.green, color.blue))
    }
}
