//! What is asked of one run: every option of `mesh` with its default, its unit and its bounds.
//!
//! Keys are the long options of the command line, in a `--config` file and in a case file alike. Angles are degrees, τ is in radians,
//! lengths are in the units of the mesh: the file's own, unless `unit` or `scale` asks for another.

use crate::curve::Curve;
use crate::domain::{FillRule, Loose, NameBy, Naming};
use crate::import::Glob;
use crate::plane::gcdr::Regions;
use crate::plane::gcdr::parameters::radius_edge_of;
use crate::promise::guaranteed_angle;
use crate::size::{Given, rows_of};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_3;
use std::fmt;
use std::str::FromStr;

/// κ that ends in practice: arcsin(1/(2√2)) = 20.7048…°, rounded down (Pav & Walkington 2005, section 5).
const ANGLE_MIN_DEG: f64 = 20.7;
/// τ of the paper's examples, which with κ above ends in practice.
const TAU_RAD: f64 = 0.5;
/// Smallest τ that `auto` takes: below it pieces multiply and the guarantee gains little.
const TAU_AUTO_LEAST_RAD: f64 = 0.1;

/// The options of one run. [`Request::validate`] says what is out of bounds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", default, deny_unknown_fields)]
pub struct Request {
    pub engine: Engine,
    /// κ in degrees; 0: no angle is asked for.
    pub min_angle: f64,
    pub max_turning: MaxTurning,
    pub beta: f64,
    pub ball_shrinking: BallShrinking,
    pub midpoint: Midpoint,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_area: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_edge: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_edge: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chord_error: Option<ChordError>,
    pub edge_turning: EdgeTurning,
    /// Longest edge by place: an expression in x and y, or sizes at places.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<Given>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grade: Option<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub size_of: Vec<SizeOf>,
    pub order: Order,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Free ends nearer than this, to each other or to an open line, are joined; nothing else is welded by it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub close: Option<f64>,
    pub loose: LooseEnds,
    pub fill_rule: FillChoice,
    pub strokes: Strokes,
    pub overlap: Overlap,
    pub keep: Keep,
    /// Layers that are read, and layers that are not; patterns.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<Glob>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub skip_layers: Vec<Glob>,
    /// Names given by hand, and what has a name of its own without that.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub name: Vec<NameBy>,
    pub names: NamesOf,
    /// DXF: which line types are read.
    pub line_types: LineTypes,
    /// DXF: what leaves the XY plane is projected onto it.
    pub flatten_z: Switch,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Pixels to an inch, in a drawing that gives no physical size.
    pub dpi: f64,
    pub corner_arcs: Switch,
    /// δ₂, δ₁ and μ of gcdr; see [`Request::regions`] for the defaults.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delta2: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delta1: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mu: Option<f64>,
    pub steiner: Steiner,
    /// Of `steiner = "snap"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub snap: Option<SnapTo>,
    /// Of `steiner = "random"`.
    pub seed: u64,
    /// With gcdr: D(p) of every inserted vertex is measured and held to its bound.
    pub densities: Switch,
    pub max_vertices: usize,
    /// Seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub timeout: Option<f64>,
    pub trailing_edge: TrailingEdge,
    /// Radius in chords; 0: the section itself is meshed.
    pub far_field: f64,
    /// Degrees.
    pub incidence: f64,
    /// The chord that a section is scaled to, before `unit` and `scale`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chord: Option<f64>,
    /// The face of a solid to be meshed: its entity number, its name, or `largest`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub face: Option<String>,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            engine: Engine::Lop,
            min_angle: ANGLE_MIN_DEG,
            max_turning: MaxTurning::Rad(TAU_RAD),
            beta: 0.95, // the paper's own choice: balls stay large
            ball_shrinking: BallShrinking::Batched,
            midpoint: Midpoint::Bisector,
            max_area: None,
            max_edge: None,
            min_edge: None,
            chord_error: None,
            edge_turning: EdgeTurning::Deg(15.0), // 24 edges a circle; without it a thin airfoil gets 14 edges in all
            size: None,
            grade: None,
            size_of: Vec::new(),
            order: Order::First,
            tolerance: None,
            close: None,
            loose: LooseEnds::Auto,
            fill_rule: FillChoice::Auto,
            strokes: Strokes::Auto,
            overlap: Overlap::Paint,
            keep: Keep::Inside,
            layers: Vec::new(),
            skip_layers: Vec::new(),
            name: Vec::new(),
            names: NamesOf::Layer,
            line_types: LineTypes::Edges,
            flatten_z: Switch::Off,
            unit: None,
            scale: None,
            dpi: 96.0, // CSS
            corner_arcs: Switch::On,
            delta2: None,
            delta1: None,
            mu: None,
            steiner: Steiner::Center,
            snap: None,
            seed: 0,
            densities: Switch::Off,
            max_vertices: 5_000_000,
            timeout: None,
            trailing_edge: TrailingEdge::Keep,
            far_field: 20.0,
            incidence: 0.0,
            chord: None,
            face: None,
        }
    }
}

/// An option out of its bounds.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("--{option} {value}: {why}")]
pub struct RequestError {
    pub option: &'static str,
    pub value: String,
    pub why: &'static str,
}

impl Request {
    /// The first option that is out of its bounds.
    pub fn validate(&self) -> Result<(), RequestError> {
        let refuse =
            |option, value: &dyn fmt::Display, why| Err(RequestError { option, value: value.to_string(), why });
        let positive = [
            ("max-area", self.max_area),
            ("max-edge", self.max_edge),
            ("min-edge", self.min_edge),
            ("grade", self.grade),
            ("scale", self.scale),
            ("chord", self.chord),
            ("dpi", Some(self.dpi)),
            ("timeout", self.timeout),
            ("close", self.close),
        ];
        for (option, value) in positive {
            if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
                return refuse(option, &value, "a positive number is needed");
            }
        }
        if !(0.0..60.0).contains(&self.min_angle) {
            return refuse("min-angle", &self.min_angle, "an angle from 0 to below 60 degrees is needed");
        }
        if let MaxTurning::Rad(tau) = self.max_turning
            && !(tau > 0.0 && tau <= FRAC_PI_3)
        {
            return refuse("max-turning", &tau, "radians above 0 and at most π/3 = 1.0471975511965976, or auto");
        }
        if !(0.5..1.0).contains(&self.beta) {
            return refuse("beta", &self.beta, "a factor from 0.5 to below 1 is needed");
        }
        if let Some(error) = self.chord_error
            && !(error.value().is_finite() && error.value() > 0.0)
        {
            return refuse("chord-error", &error, "a positive length is needed, or a positive share as in 0.1%");
        }
        if let EdgeTurning::Deg(turning) = self.edge_turning
            && !(turning > 0.0 && turning <= 60.0)
        {
            return refuse("edge-turning", &turning, "degrees above 0 and at most 60, or off");
        }
        if let Some(size) = self.size_of.iter().find(|s| !(s.edge.is_finite() && s.edge > 0.0)) {
            return refuse("size-of", size, "a positive length is needed");
        }
        if let Some((size, flaw)) = self.size.as_ref().and_then(|size| Some((size, size.flaw()?))) {
            return refuse("size", size, flaw);
        }
        if let Some(tolerance) = self.tolerance.filter(|t| !(t.is_finite() && *t >= 0.0)) {
            return refuse("tolerance", &tolerance, "a length that is not negative is needed");
        }
        if let (Some(least), Some(largest)) = (self.min_edge, self.max_edge)
            && least > largest
        {
            return refuse("min-edge", &least, "more than --max-edge");
        }
        for (option, value) in [("delta2", self.delta2), ("delta1", self.delta1), ("mu", self.mu)] {
            if let Some(value) = value.filter(|v| !(*v > 0.0 && *v <= 1.0)) {
                return refuse(option, &value, "a share above 0 and at most 1 is needed");
            }
        }
        if self.snap.is_some() != (self.steiner == Steiner::Snap) {
            let given = self.snap.as_ref().map_or("none".into(), SnapTo::to_string);
            return refuse("snap", &given, "--steiner snap and a pitch or a file of places are needed together");
        }
        if let Some((snap, flaw)) = self.snap.as_ref().and_then(|snap| Some((snap, snap.flaw()?))) {
            return refuse("snap", snap, flaw);
        }
        if self.max_vertices < 3 {
            return refuse("max-vertices", &self.max_vertices, "a mesh has 3 vertices or more");
        }
        if !(self.far_field == 0.0 || self.far_field.is_finite() && self.far_field >= 1.0) {
            return refuse("far-field", &self.far_field, "1 chord or more, or 0 to mesh the section itself");
        }
        if !(-180.0..=180.0).contains(&self.incidence) {
            return refuse("incidence", &self.incidence, "degrees from -180 to 180 are needed");
        }
        Ok(())
    }

    /// κ in radians.
    pub fn angle_min_rad(&self) -> f64 {
        self.min_angle.to_radians()
    }

    /// δ₂, δ₁ and μ as given; where not: 1, but the widest disks that the angle leaves to a strategy whose disks are alike and that would not
    /// take centres.
    pub fn regions(&self) -> Regions {
        let default = match self.steiner {
            Steiner::Center | Steiner::Offcenter | Steiner::Optimal | Steiner::OffcenterFree | Steiner::OptimalFree => {
                Regions::CENTERS
            }
            Steiner::Extreme | Steiner::Random | Steiner::Snap | Steiner::Size => {
                Regions::widest_disks(radius_edge_of(self.angle_min_rad()))
            }
        };
        Regions {
            delta2: self.delta2.unwrap_or(default.delta2),
            delta1: self.delta1.unwrap_or(default.delta1),
            mu: self.mu.unwrap_or(default.mu),
        }
    }

    /// τ in radians for these curves: as given, or for `auto` the largest from 0.1 to π/3 whose guarantee covers the angle, else 0.5.
    pub fn tau_rad<'a>(&self, curves: impl IntoIterator<Item = &'a Curve>) -> f64 {
        let MaxTurning::Auto = self.max_turning else {
            return self.max_turning.given();
        };
        let round = curves.into_iter().all(Curve::is_round);
        let lens_share = if round { 0.5 } else { 1.0 }; // the lens angle of a circular arc is half its turning
        largest_tau(self.angle_min_rad(), lens_share)
    }
}

/// The largest τ in 0.1..π/3 with κ(λ = share·τ) ≥ `angle_rad`, else 0.5. κ falls as λ grows, so halving finds it.
fn largest_tau(angle_rad: f64, lens_share: f64) -> f64 {
    let covers = |tau: f64| guaranteed_angle(lens_share * tau) >= angle_rad;
    let (mut covered, mut missed) = (TAU_AUTO_LEAST_RAD, FRAC_PI_3);
    if covers(missed) {
        return missed;
    }
    if !covers(covered) {
        return TAU_RAD;
    }
    // 50 halvings of an interval below 1 reach the spacing of f64 at 0.1.
    for _ in 0..50 {
        let middle = 0.5 * (covered + missed);
        if covers(middle) {
            covered = middle;
        } else {
            missed = middle;
        }
    }
    covered
}

/// Who refines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Engine {
    /// Corner lopping (Pav & Walkington 2005).
    Lop,
    /// Generalized constrained Delaunay refinement (Foteinos, Chernikov & Chrisochoides 2010).
    Gcdr,
}

impl FromStr for Engine {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "lop" => Ok(Self::Lop),
            "gcdr" => Ok(Self::Gcdr),
            _ => Err("lop or gcdr is expected".into()),
        }
    }
}

/// Who chooses the points that refine triangles, with gcdr.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Steiner {
    /// Centres: Chew's second algorithm.
    Center,
    /// Off-centres (Üngör 2004), within regions that are larger in skinnier triangles.
    Offcenter,
    /// Locally optimal points (Erten & Üngör 2007), kept within such regions.
    Optimal,
    /// The border of the regions.
    Extreme,
    /// Anywhere in the regions, by --seed.
    Random,
    /// The points of a grid, or places of a file, by --snap, where the regions hold any.
    Snap,
    /// Where new edges are as long as the sizes ask for.
    Size,
    /// Off-centres wherever they lie: nothing is proven.
    OffcenterFree,
    /// Locally optimal points wherever they lie: nothing is proven.
    OptimalFree,
}

impl Steiner {
    /// Whether its points are taken wherever they lie.
    pub fn is_free(self) -> bool {
        matches!(self, Self::OffcenterFree | Self::OptimalFree)
    }
}

/// What points are snapped to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SnapTo {
    /// The points of a square grid through the origin, so far apart.
    Pitch(f64),
    Places(Vec<[f64; 2]>),
}

impl SnapTo {
    /// Reads a file of places: `x y` on every line, as sizes by place are read.
    ///
    /// # Errors
    /// A sentence with the line that is not so.
    pub fn read_places(text: &str) -> Result<Self, String> {
        rows_of(text, "x y").map(Self::Places)
    }

    fn flaw(&self) -> Option<&'static str> {
        match self {
            Self::Pitch(pitch) if !(pitch.is_finite() && *pitch > 0.0) => Some("a positive pitch is needed"),
            Self::Places(places) if places.is_empty() => Some("a place is needed"),
            Self::Places(places) if !places.iter().flatten().all(|x| x.is_finite()) => {
                Some("finite coordinates are needed")
            }
            Self::Pitch(_) | Self::Places(_) => None,
        }
    }
}

impl fmt::Display for SnapTo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pitch(pitch) => write!(f, "{pitch}"),
            Self::Places(places) => write!(f, "{} places", places.len()),
        }
    }
}

/// Polynomial order of the cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u64", into = "u64")]
pub enum Order {
    First,
    /// A node within every edge, on the curve.
    Second,
}

impl TryFrom<u64> for Order {
    type Error = String;
    fn try_from(order: u64) -> Result<Self, String> {
        match order {
            1 => Ok(Self::First),
            2 => Ok(Self::Second),
            _ => Err("1 or 2 is expected".into()),
        }
    }
}

impl From<Order> for u64 {
    fn from(order: Order) -> Self {
        match order {
            Order::First => 1,
            Order::Second => 2,
        }
    }
}

impl FromStr for Order {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        text.parse::<u64>().map_err(|e| e.to_string())?.try_into()
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum BallShrinking {
    /// Shrink until the ball is clear, then insert once.
    Batched,
    /// Insert a shell for every step, as printed in the paper.
    Literal,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Midpoint {
    /// Where the curve crosses the perpendicular bisector of its chord.
    Bisector,
    /// Where it crosses the bisector of the angle under which the encroaching vertex sees the chord.
    Angle,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Keep {
    /// The faces that the fill rule says are inside.
    Inside,
    /// Adds an axis-parallel box named `box` and keeps every bounded face.
    All,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Strokes {
    /// Centre lines where nothing is filled; else left out.
    Auto,
    /// Centre lines of what is stroked and not filled.
    Lines,
    /// What strokes cover is filled, as by another shape over the fill.
    Area,
    /// Left out.
    Ignore,
}

/// Which line types of a DXF drawing are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum LineTypes {
    /// Not those for centre, hidden and phantom lines; where nothing else is drawn, all.
    Edges,
    All,
}

/// What becomes of overlapping shapes of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Overlap {
    /// By paint order: the topmost shape has it all, under its name.
    Paint,
    /// Every set of shapes has a region of its own, named by all of them, the topmost first: leaf+stem.
    Fragment,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Switch {
    On,
    Off,
}

impl Switch {
    pub fn is_on(self) -> bool {
        self == Self::On
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum TrailingEdge {
    Keep,
    Sharp,
    Blunt,
    Round,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "cli", value(rename_all = "lower"))]
pub enum FillChoice {
    /// The file's own rule.
    Auto,
    /// Winding number not zero.
    NonZero,
    /// Odd winding number.
    EvenOdd,
    /// Every bounded face, but those reached from a hole point.
    Regions,
}

impl FillChoice {
    pub fn rule(self) -> Option<FillRule> {
        match self {
            Self::Auto => None,
            Self::NonZero => Some(FillRule::NonZero),
            Self::EvenOdd => Some(FillRule::EvenOdd),
            Self::Regions => Some(FillRule::Regions),
        }
    }
}

/// What has a name of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum NamesOf {
    /// Every layer, or what else the file names.
    Layer,
    /// Every closed outline: HOLES-1, HOLES-2.
    Outline,
    /// Every entity, by its handle where it has one: HOLES-2F.
    Entity,
}

impl NamesOf {
    pub fn rule(self) -> Naming {
        match self {
            Self::Layer => Naming::Layer,
            Self::Outline => Naming::Outline,
            Self::Entity => Naming::Entity,
        }
    }
}

/// What becomes of lines that bound nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum LooseEnds {
    /// Plainly open lines are kept, outlines that miss closing refused.
    Auto,
    /// All are mesh edges where they lie in a region.
    Keep,
    /// All are left out.
    Drop,
    /// All are refused.
    Error,
}

impl LooseEnds {
    pub fn rule(self) -> Loose {
        match self {
            Self::Auto => Loose::Auto,
            Self::Keep => Loose::Keep,
            Self::Drop => Loose::Drop,
            Self::Error => Loose::Error,
        }
    }
}

/// A number, or a word or a number with a sign behind it: how mixed options stand in a file.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Scalar {
    Number(f64),
    Text(String),
}

impl From<String> for Scalar {
    fn from(text: String) -> Self {
        text.parse().map_or(Self::Text(text), Self::Number)
    }
}

macro_rules! scalar {
    ($($name:ident),*) => {$(
        impl TryFrom<Scalar> for $name {
            type Error = String;
            fn try_from(value: Scalar) -> Result<Self, String> {
                match value {
                    Scalar::Number(number) => number.to_string().parse(),
                    Scalar::Text(text) => text.parse(),
                }
            }
        }
        impl From<$name> for Scalar {
            fn from(value: $name) -> Self {
                value.to_string().into()
            }
        }
    )*};
}
scalar!(MaxTurning, ChordError, EdgeTurning);

fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| format!("'{text}' is not a number"))
}

/// τ, the largest turning of a curve before it is meshed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Scalar", into = "Scalar")]
pub enum MaxTurning {
    /// The largest τ whose guarantee covers the angle asked for.
    Auto,
    Rad(f64),
}

impl MaxTurning {
    fn given(self) -> f64 {
        match self {
            Self::Auto => TAU_RAD,
            Self::Rad(tau) => tau,
        }
    }
}

impl FromStr for MaxTurning {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Self::Auto),
            _ => Ok(Self::Rad(number(text)?)),
        }
    }
}

impl fmt::Display for MaxTurning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Rad(tau) => tau.fmt(f),
        }
    }
}

/// Largest distance from a mesh edge to its curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Scalar", into = "Scalar")]
pub enum ChordError {
    Length(f64),
    /// Percent of the drawing's diagonal.
    Percent(f64),
}

impl ChordError {
    fn value(self) -> f64 {
        match self {
            Self::Length(value) | Self::Percent(value) => value,
        }
    }

    /// As a length, in a drawing of this diagonal; `None` of a share of a diagonal that is not known.
    pub fn length(self, diagonal: Option<f64>) -> Option<f64> {
        match self {
            Self::Length(length) => Some(length),
            Self::Percent(percent) => diagonal.map(|d| 0.01 * percent * d),
        }
    }
}

impl FromStr for ChordError {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text.strip_suffix('%') {
            Some(percent) => Ok(Self::Percent(number(percent)?)),
            None => Ok(Self::Length(number(text)?)),
        }
    }
}

impl fmt::Display for ChordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length(length) => length.fmt(f),
            Self::Percent(percent) => write!(f, "{percent}%"),
        }
    }
}

/// Largest turning of the curve along a mesh edge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Scalar", into = "Scalar")]
pub enum EdgeTurning {
    Off,
    Deg(f64),
}

impl EdgeTurning {
    pub fn deg(self) -> Option<f64> {
        match self {
            Self::Off => None,
            Self::Deg(degrees) => Some(degrees),
        }
    }
}

impl FromStr for EdgeTurning {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "off" => Ok(Self::Off),
            _ => Ok(Self::Deg(number(text)?)),
        }
    }
}

impl fmt::Display for EdgeTurning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Off => f.write_str("off"),
            Self::Deg(degrees) => degrees.fmt(f),
        }
    }
}

/// Edges on a boundary, or in a region, of this name no longer than `edge`: `NAME=H`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct SizeOf {
    pub name: String,
    pub edge: f64,
}

impl FromStr for SizeOf {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let (name, edge) = text.rsplit_once('=').ok_or("NAME=H is expected")?;
        if name.is_empty() {
            return Err("a name is missing before '='".into());
        }
        Ok(Self { name: name.into(), edge: number(edge)? })
    }
}

impl TryFrom<String> for SizeOf {
    type Error = String;
    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<SizeOf> for String {
    fn from(size: SizeOf) -> Self {
        size.to_string()
    }
}

impl fmt::Display for SizeOf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.name, self.edge)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_the_contracts_and_in_bounds() {
        let request = Request::default();
        assert_eq!(request.validate(), Ok(()));
        assert_eq!(request.min_angle, 20.7);
        assert_eq!(request.max_turning, MaxTurning::Rad(0.5));
        assert_eq!(request.edge_turning, EdgeTurning::Deg(15.0));
        assert_eq!((request.beta, request.max_vertices, request.far_field), (0.95, 5_000_000, 20.0));
        assert_eq!(toml::from_str::<Request>("").unwrap(), request);
    }

    #[test]
    fn a_request_survives_its_file() {
        let request = Request {
            max_turning: MaxTurning::Auto,
            chord_error: Some(ChordError::Percent(0.1)),
            edge_turning: EdgeTurning::Off,
            size_of: vec![SizeOf { name: "a=b".into(), edge: 1.0 / 3.0 }],
            max_area: Some(1e-300),
            unit: Some("mm".into()),
            fill_rule: FillChoice::EvenOdd,
            ..Request::default()
        };
        let text = toml::to_string(&request).unwrap();
        assert_eq!(toml::from_str::<Request>(&text).unwrap(), request, "{text}");
    }

    #[test]
    fn numbers_and_words_are_read() {
        let request: Request =
            toml::from_str("max-turning = 1\nchord-error = '2%'\nedge-turning = 7.5\nsize-of = ['wing=0.1']").unwrap();
        assert_eq!(request.max_turning, MaxTurning::Rad(1.0));
        assert_eq!(request.chord_error, Some(ChordError::Percent(2.0)));
        assert_eq!(request.chord_error.unwrap().length(Some(50.0)), Some(1.0));
        assert_eq!(request.edge_turning, EdgeTurning::Deg(7.5));
        for wrong in [
            "max-turning = 'much'",
            "max-trning = 1",
            "size-of = ['0.1']",
            "order = 3",
            "size = 'x +'",
            "engine = 'ruppert'",
        ] {
            assert!(toml::from_str::<Request>(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn what_is_out_of_bounds_is_named() {
        let refused = |change: &dyn Fn(&mut Request)| {
            let mut request = Request::default();
            change(&mut request);
            request.validate().expect_err("out of bounds").option
        };
        assert_eq!(refused(&|r| r.min_angle = 60.0), "min-angle");
        assert_eq!(refused(&|r| r.min_angle = f64::NAN), "min-angle");
        assert_eq!(refused(&|r| r.max_turning = MaxTurning::Rad(1.05)), "max-turning");
        assert_eq!(refused(&|r| r.max_turning = MaxTurning::Rad(f64::NAN)), "max-turning");
        assert_eq!(refused(&|r| r.beta = 1.0), "beta");
        assert_eq!(refused(&|r| r.max_area = Some(0.0)), "max-area");
        assert_eq!(refused(&|r| r.chord_error = Some(ChordError::Percent(-1.0))), "chord-error");
        assert_eq!(refused(&|r| r.size_of = vec![SizeOf { name: "a".into(), edge: f64::NAN }]), "size-of");
        assert_eq!(refused(&|r| r.tolerance = Some(-1.0)), "tolerance");
        assert_eq!(refused(&|r| r.max_vertices = 2), "max-vertices");
        assert_eq!(refused(&|r| r.far_field = 0.5), "far-field");
        assert_eq!(refused(&|r| (r.min_edge, r.max_edge) = (Some(2.0), Some(1.0))), "min-edge");
    }

    #[test]
    fn auto_takes_the_largest_turning_that_is_proven() {
        let auto = |degrees: f64, share| largest_tau(degrees.to_radians(), share);
        assert_eq!(auto(20.7, 1.0), TAU_RAD, "no τ ≥ 0.1 covers it");
        assert_eq!(auto(2.0, 1.0), FRAC_PI_3);
        let tau = auto(15.0, 1.0);
        assert!(guaranteed_angle(tau) >= 15_f64.to_radians());
        assert!(guaranteed_angle(tau * (1.0 + 1e-9)) < 15_f64.to_radians());
        assert!(auto(15.0, 0.5) > 1.9 * tau, "arcs have half the lens angle");
    }
}
