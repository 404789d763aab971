//! The request of one run: the options of the modules, and those of the whole run.
//!
//! Keys are the long options of the command line, the same in a `--config` file and in a case file
//! ([`crate::options`]). Angles are in degrees, τ is in radians, and lengths are in the units of the mesh: those of the
//! file, unless `unit` or `scale` gives others.

use crate::curve::Curve;
use crate::domain::{FillRule, Loose, NameBy, Naming};
use crate::import::{DxfOptions, Selection, Strokes};
use crate::options::{Described, OutOfBounds, Switch, described, number, scalar};
use crate::plane::gcdr::{self, Regions};
use crate::plane::lopping::Rules;
use crate::promise::guaranteed_angle;
use crate::section;
use crate::size::Limits;
use crate::solid::Assembly;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_3;
use std::fmt;
use std::str::FromStr;
use std::sync::LazyLock;

/// The κ that ends in practice: arcsin(1/(2√2)) = 20.7048…°, rounded down (Pav & Walkington 2005, section 5).
const ANGLE_MIN_DEG: f64 = 20.7;
/// The τ of the paper's examples, which ends in practice with the κ above.
const TAU_RAD: f64 = 0.5;
/// Smallest τ of `auto`. Below it the number of pieces grows and the guarantee gains little.
const TAU_AUTO_LEAST_RAD: f64 = 0.1;

/// The options of one run. [`Request::validate`] says what is out of bounds.
// serde does not guarantee that unknown fields are denied beside flattened structs. A test checks it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", default, deny_unknown_fields)]
pub struct Request {
    /// Who refines: lop, corner lopping, or gcdr, generalized constrained Delaunay refinement.
    #[schemars(extend("group" = "engine", "value" = "lop|gcdr"))]
    pub engine: Engine,
    /// Smallest angle, in degrees; 0: none.
    // κ
    #[schemars(extend("group" = "bounds", "value" = "DEG", "report" = "angle_min_deg"))]
    pub min_angle: f64,
    /// Largest turning of a curve before it is meshed, at most π/3; auto: the largest whose guarantee covers the angle.
    #[schemars(extend("group" = "engine", "value" = "RAD|auto", "rare" = true))]
    pub max_turning: MaxTurning,
    /// Rules of corner lopping: `beta` and where subcurves are split.
    #[serde(flatten)]
    pub rules: Rules,
    /// Bounds on sizes, areas, chord errors and turnings.
    #[serde(flatten)]
    pub limits: Limits,
    /// Order of the cells: 2 puts a node on the curve within every edge.
    #[schemars(extend("group" = "bounds", "value" = "1|2"))]
    pub order: Order,
    /// Welding distance; 0 heals nothing, and lists what it leaves as `unhealed` [default: 1e-9 of the diagonal, or up
    /// to 1e-4 (SVG) or 1e-6 where slivers would take too many vertices; ends that meet nothing else: 1e-6]
    #[schemars(extend("group" = "input", "value" = "LENGTH"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Joins free ends that are nearer than this to each other, or to an open line that goes on beyond the corner;
    /// welds nothing else.
    #[schemars(extend("group" = "input", "value" = "LENGTH"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub close: Option<f64>,
    /// What becomes of lines that bound nothing: auto keeps plainly open ones and refuses outlines that miss closing.
    #[schemars(extend("group" = "input", "value" = "HOW"))]
    pub loose: Loose,
    /// Which faces are inside [default: auto, the file's own rule]
    #[schemars(extend("group" = "input", "value" = "RULE"))]
    pub fill_rule: FillChoice,
    /// What becomes of strokes: auto makes centre lines where nothing is filled, area fills what they cover.
    #[schemars(extend("group" = "input", "value" = "HOW"))]
    pub strokes: Strokes,
    /// Filled shapes that overlap: the topmost has it all, or each overlap is a region named by all of its shapes.
    #[schemars(extend("group" = "input", "value" = "HOW"))]
    pub overlap: Overlap,
    /// all: adds a box named `box` and keeps every bounded face.
    #[schemars(extend("group" = "input", "value" = "WHAT"))]
    pub keep: Keep,
    /// Layers that are read, and those that are left out.
    #[serde(flatten)]
    pub selection: Selection,
    /// A name for the curve nearest to a place, for the region at a place (in:), or for a DXF entity (handle:); may be
    /// repeated.
    #[schemars(extend("group" = "input", "value" = "NAME=X,Y|in:X,Y|handle:H"))]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub name: Vec<NameBy>,
    /// What has a name of its own: each layer, each closed outline (HOLES-1, HOLES-2) or each entity.
    #[schemars(extend("group" = "input", "value" = "WHAT"))]
    pub names: Naming,
    /// How DXF files are read.
    #[serde(flatten)]
    pub dxf: DxfOptions,
    /// Unit of the mesh; the drawing's coordinates are converted where their unit is known.
    #[schemars(extend("group" = "input", "value" = "UNIT"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Factor on every coordinate [default: 1]
    #[schemars(extend("group" = "input", "value" = "S"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Pixels to an inch, in a drawing that gives no physical size.
    #[schemars(extend("group" = "input", "value" = "D"))]
    pub dpi: f64,
    /// Arcs around sharp corners, which bound the largest angle.
    #[schemars(extend("group" = "engine", "value" = "on|off", "rare" = true))]
    pub corner_arcs: Switch,
    /// Options of generalized constrained refinement, unused by the other engine.
    #[serde(flatten)]
    pub gcdr: gcdr::Choices,
    /// Vertices after which refinement stops.
    #[schemars(extend("group" = "budget", "value" = "N"))]
    pub max_vertices: usize,
    /// Seconds after which arranging, cutting and refining stop. A mesh that is valid by then is still verified and
    /// written, which takes time in proportion to its size.
    #[schemars(extend("group" = "budget", "value" = "S", "report" = "timeout_s"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub timeout: Option<f64>,
    /// How a section of airfoil coordinates becomes a drawing; unused for other formats.
    #[serde(flatten)]
    pub airfoil: section::Options,
    /// How the surfaces of a solid are put together; unused for drawings.
    #[serde(flatten)]
    pub solid: Assembly,
    /// The planar face to mesh, by its entity number or name, or largest; with batch, all gives each a mesh of its own
    /// [default: largest]
    #[schemars(extend("group" = "solids", "value" = "ID|NAME|largest|all"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub face: Option<String>,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            engine: Engine::Lop,
            min_angle: ANGLE_MIN_DEG,
            max_turning: MaxTurning::Rad(TAU_RAD),
            rules: Rules::default(),
            limits: Limits::default(),
            order: Order::First,
            tolerance: None,
            close: None,
            loose: Loose::Auto,
            fill_rule: FillChoice::Auto,
            strokes: Strokes::Auto,
            overlap: Overlap::Paint,
            keep: Keep::Inside,
            selection: Selection::default(),
            name: Vec::new(),
            names: Naming::Layer,
            dxf: DxfOptions::default(),
            unit: None,
            scale: None,
            dpi: 96.0, // CSS
            corner_arcs: Switch::On,
            gcdr: gcdr::Choices::default(),
            max_vertices: 5_000_000,
            timeout: None,
            airfoil: section::Options::default(),
            solid: Assembly::default(),
            face: None,
        }
    }
}

impl Request {
    /// Every option, in the order of the fields.
    pub fn options() -> &'static [Described] {
        static OPTIONS: LazyLock<Vec<Described>> = LazyLock::new(described::<Request>);
        &OPTIONS
    }

    /// Every option, group by group, in each in the order of the fields.
    pub fn options_in_groups() -> Vec<&'static Described> {
        let mut options: Vec<&Described> = Self::options().iter().collect();
        options.sort_by_key(|option| option.group);
        options
    }

    /// The first option that is out of its bounds.
    ///
    /// # Errors
    /// With the option and its value.
    pub fn validate(&self) -> Result<(), OutOfBounds> {
        let angle = self.min_angle;
        let is_sharp = (0.0..60.0).contains(&angle);
        OutOfBounds::unless(is_sharp, "min-angle", &angle, "an angle from 0 to below 60 degrees is needed")?;
        if let MaxTurning::Rad(tau) = self.max_turning {
            let why = "radians above 0 and at most π/3 = 1.0471975511965976, or auto";
            OutOfBounds::unless(tau > 0.0 && tau <= FRAC_PI_3, "max-turning", &tau, why)?;
        }
        self.rules.check()?;
        self.limits.check()?;
        if let Some(tolerance) = self.tolerance {
            let holds = tolerance.is_finite() && tolerance >= 0.0;
            OutOfBounds::unless(holds, "tolerance", &tolerance, "a length that is not negative is needed")?;
        }
        OutOfBounds::unless_positive(&[
            ("close", self.close),
            ("scale", self.scale),
            ("dpi", Some(self.dpi)),
            ("timeout", self.timeout),
        ])?;
        self.gcdr.check()?;
        self.solid.check()?;
        OutOfBounds::unless(
            self.max_vertices >= 3,
            "max-vertices",
            &self.max_vertices,
            "a mesh has 3 vertices or more",
        )?;
        self.airfoil.check()
    }

    /// κ in radians.
    pub fn angle_min_rad(&self) -> f64 {
        self.min_angle.to_radians()
    }

    /// δ₂, δ₁ and μ for the angle.
    pub fn regions(&self) -> Regions {
        self.gcdr.regions(self.angle_min_rad())
    }

    /// τ in radians for these curves: as given, or for `auto` the largest from 0.1 to π/3 whose guarantee covers the
    /// angle, else 0.5.
    pub fn tau_rad<'a>(&self, curves: impl IntoIterator<Item = &'a Curve>) -> f64 {
        let MaxTurning::Auto = self.max_turning else {
            return self.max_turning.given();
        };
        let round = curves.into_iter().all(Curve::is_round);
        let lens_share = if round { 0.5 } else { 1.0 }; // the lens angle of a circular arc is half its turning
        largest_tau(self.angle_min_rad(), lens_share)
    }
}

/// The largest τ in 0.1..π/3 with κ(λ = share·τ) ≥ `angle_rad`, else 0.5. κ falls as λ grows, so bisection finds it.
fn largest_tau(angle_rad: f64, lens_share: f64) -> f64 {
    let covers = |tau: f64| guaranteed_angle(lens_share * tau) >= angle_rad;
    let (mut covered, mut missed) = (TAU_AUTO_LEAST_RAD, FRAC_PI_3);
    if covers(missed) {
        return missed;
    }
    if !covers(covered) {
        return TAU_RAD;
    }
    // 50 bisections of an interval below 1 reach the spacing of f64 at 0.1.
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Engine {
    /// Corner lopping (Pav & Walkington 2005).
    Lop,
    /// Generalized constrained Delaunay refinement (Foteinos, Chernikov & Chrisochoides 2010).
    Gcdr,
}

/// Polynomial order of the cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "u64", into = "u64")]
pub enum Order {
    /// Straight cells, with nodes at their corners only.
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

/// Which faces of the arrangement are meshed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Keep {
    /// The faces that the fill rule says are inside.
    Inside,
    /// Adds an axis-parallel box named `box` and keeps every bounded face.
    All,
}

/// What becomes of overlapping shapes of artwork.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Overlap {
    /// By paint order: an overlap belongs to the topmost shape, under its name.
    Paint,
    /// Each set of overlapping shapes has a region, named by all of them, the topmost first: leaf+stem.
    Fragment,
}

/// Which fill rule says what is inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
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
    /// The rule of this name; `None` for the file's own.
    pub fn rule(self) -> Option<FillRule> {
        match self {
            Self::Auto => None,
            Self::NonZero => Some(FillRule::NonZero),
            Self::EvenOdd => Some(FillRule::EvenOdd),
            Self::Regions => Some(FillRule::Regions),
        }
    }
}

scalar!(MaxTurning);

/// τ, the largest turning of a curve before it is meshed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "crate::options::Scalar", into = "crate::options::Scalar")]
pub enum MaxTurning {
    /// The largest τ whose guarantee covers the angle asked for.
    Auto,
    /// The largest turning in radians, above 0 and at most π/3.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::Kind;
    use crate::size::{ChordError, EdgeTurning, SizeOf};

    #[test]
    fn the_defaults_are_the_contracts_and_in_bounds() {
        let request = Request::default();
        assert_eq!(request.validate(), Ok(()));
        assert_eq!(request.min_angle, 20.7);
        assert_eq!(request.max_turning, MaxTurning::Rad(0.5));
        assert_eq!(request.limits.edge_turning, EdgeTurning::Deg(15.0));
        assert_eq!((request.rules.beta, request.max_vertices, request.airfoil.far_field), (0.95, 5_000_000, 20.0));
        assert_eq!(toml::from_str::<Request>("").unwrap(), request);
    }

    #[test]
    fn a_request_survives_its_file() {
        let request = Request {
            max_turning: MaxTurning::Auto,
            limits: Limits {
                chord_error: Some(ChordError::Percent(0.1)),
                edge_turning: EdgeTurning::Off,
                size_of: vec![SizeOf { name: "a=b".into(), edge: 1.0 / 3.0 }],
                max_area: Some(1e-300),
                ..Limits::default()
            },
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
        assert_eq!(request.limits.chord_error, Some(ChordError::Percent(2.0)));
        assert_eq!(request.limits.chord_error.unwrap().length(Some(50.0)), Some(1.0));
        assert_eq!(request.limits.edge_turning, EdgeTurning::Deg(7.5));
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
        assert_eq!(refused(&|r| r.rules.beta = 1.0), "beta");
        assert_eq!(refused(&|r| r.limits.max_area = Some(0.0)), "max-area");
        assert_eq!(refused(&|r| r.limits.chord_error = Some(ChordError::Percent(-1.0))), "chord-error");
        assert_eq!(refused(&|r| r.limits.size_of = vec![SizeOf { name: "a".into(), edge: f64::NAN }]), "size-of");
        assert_eq!(refused(&|r| r.tolerance = Some(-1.0)), "tolerance");
        assert_eq!(refused(&|r| r.max_vertices = 2), "max-vertices");
        assert_eq!(refused(&|r| r.airfoil.far_field = 0.5), "far-field");
        assert_eq!(refused(&|r| (r.limits.min_edge, r.limits.max_edge) = (Some(2.0), Some(1.0))), "min-edge");
    }

    #[test]
    fn every_number_has_bounds() {
        for option in Request::options().iter().filter(|option| option.kind == Kind::Number) {
            let request: Request = toml::from_str(&format!("{} = nan", option.key)).unwrap();
            assert_eq!(request.validate().map_err(|e| e.option), Err(&*option.key));
        }
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
