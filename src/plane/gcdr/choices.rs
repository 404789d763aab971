//! The options of the engine: its parameters, and the strategy that chooses points.

use super::SteinerStrategy;
use super::parameters::{Regions, radius_edge_of};
use super::steiner;
use crate::geometry::Point;
use crate::options::{OutOfBounds, Switch};
use crate::size::rows_of;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Parameters of generalized constrained refinement, and the strategy that chooses its points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", default)]
pub struct Choices {
    /// With gcdr: points in triangles lie within r(1 - delta2) of the circumcenter, off-centres and optimal points
    /// within r - delta2 l/(2 sin angle), where l is the shortest edge [default: 1; the least that the angle allows
    /// with strategies that choose within equal disks]
    #[schemars(extend("group" = "gcdr", "value" = "D", "rare" = true))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delta2: Option<f64>,
    /// With gcdr: points on segments lie in the middle part of length |s|(1 - delta1) [default: 1]
    #[schemars(extend("group" = "gcdr", "value" = "D", "rare" = true))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delta1: Option<f64>,
    /// With gcdr: points on segments that have a vertex of another segment nearby lie in the middle part of length
    /// |s|(1 - mu) [default: 1]
    #[schemars(extend("group" = "gcdr", "value" = "M", "rare" = true))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mu: Option<f64>,
    /// With gcdr: the strategy that chooses the points in triangles; nothing is proven for the free ones.
    #[schemars(extend("group" = "gcdr", "value" = "WHO", "rare" = true))]
    pub steiner: Steiner,
    /// With --steiner snap: the pitch of a square grid through the origin, or a file of places: `x y` on every line.
    #[schemars(extend("group" = "gcdr", "value" = "H|FILE", "rare" = true, "file" = true))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub snap: Option<SnapTo>,
    /// With --steiner random.
    #[schemars(extend("group" = "gcdr", "value" = "N", "rare" = true))]
    pub seed: u64,
    /// With gcdr: measure the density of every inserted point (local feature size over distance to the nearest visible
    /// vertex), and check it against the known bounds.
    #[schemars(extend("group" = "gcdr", "value" = "on|off", "rare" = true))]
    pub densities: Switch,
}

impl Default for Choices {
    fn default() -> Self {
        Self {
            delta2: None,
            delta1: None,
            mu: None,
            steiner: Steiner::Center,
            snap: None,
            seed: 0,
            densities: Switch::Off,
        }
    }
}

impl Choices {
    /// The first choice that is out of its bounds.
    ///
    /// # Errors
    /// With the option and its value.
    pub fn check(&self) -> Result<(), OutOfBounds> {
        for (option, value) in [("delta2", self.delta2), ("delta1", self.delta1), ("mu", self.mu)] {
            let value = value.unwrap_or(1.0);
            let holds = value > 0.0 && value <= 1.0;
            OutOfBounds::unless(holds, option, &value, "a share above 0 and at most 1 is needed")?;
        }
        let given = self.snap.as_ref().map_or("none".into(), SnapTo::to_string);
        let together = self.snap.is_some() == (self.steiner == Steiner::Snap);
        let why = "--steiner snap and a pitch or a file of places are needed together";
        OutOfBounds::unless(together, "snap", &given, why)?;
        match self.snap.as_ref().and_then(SnapTo::flaw) {
            Some(flaw) => OutOfBounds::unless(false, "snap", &given, flaw),
            None => Ok(()),
        }
    }

    /// δ₂, δ₁ and μ as given. Those not given are 1; but for a strategy with equal disks that does not choose centres,
    /// δ₂ is the least that the angle (radians) allows.
    pub fn regions(&self, angle_min_rad: f64) -> Regions {
        let default = match self.steiner {
            Steiner::Center | Steiner::Offcenter | Steiner::Optimal | Steiner::OffcenterFree | Steiner::OptimalFree => {
                Regions::CENTERS
            }
            Steiner::Extreme | Steiner::Random | Steiner::Snap | Steiner::Size => {
                Regions::widest_disks(radius_edge_of(angle_min_rad))
            }
        };
        Regions {
            delta2: self.delta2.unwrap_or(default.delta2),
            delta1: self.delta1.unwrap_or(default.delta1),
            mu: self.mu.unwrap_or(default.mu),
        }
    }

    /// The strategy, for a smallest angle in radians.
    pub fn strategy(&self, angle_min_rad: f64) -> Box<dyn SteinerStrategy> {
        match self.steiner {
            Steiner::Center => Box::new(steiner::Center),
            Steiner::Offcenter => Box::new(steiner::OffCenter::new(angle_min_rad, false)),
            Steiner::Optimal => Box::new(steiner::Optimal::new(angle_min_rad, false)),
            Steiner::Extreme => Box::new(steiner::Extreme),
            Steiner::Random => Box::new(steiner::Random::new(self.seed)),
            Steiner::Size => Box::new(steiner::BySize),
            Steiner::Snap => match &self.snap {
                Some(SnapTo::Pitch(pitch)) => Box::new(steiner::Grid { pitch: *pitch }),
                Some(SnapTo::Places(places)) => {
                    Box::new(steiner::Places::new(places.iter().map(|&[x, y]| Point::new(x, y))))
                }
                // `check` refuses it.
                None => Box::new(steiner::Center),
            },
            Steiner::OffcenterFree => Box::new(steiner::OffCenter::new(angle_min_rad, true)),
            Steiner::OptimalFree => Box::new(steiner::Optimal::new(angle_min_rad, true)),
        }
    }
}

/// The strategy that chooses the points that refine triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
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
    /// Where new edges have the length that the size limits permit.
    Size,
    /// Off-centres wherever they lie: nothing is proven.
    OffcenterFree,
    /// Locally optimal points wherever they lie: nothing is proven.
    OptimalFree,
}

impl Steiner {
    /// Every strategy, in the order in which the option `--steiner` lists them.
    pub const ALL: [Self; 9] = [
        Self::Center,
        Self::Offcenter,
        Self::Optimal,
        Self::Extreme,
        Self::Random,
        Self::Snap,
        Self::Size,
        Self::OffcenterFree,
        Self::OptimalFree,
    ];

    /// Whether its points are taken wherever they lie ([`SteinerStrategy::is_free`]). Then nothing is guaranteed.
    pub fn is_free(self) -> bool {
        match self {
            Self::OffcenterFree | Self::OptimalFree => true,
            Self::Center | Self::Offcenter | Self::Optimal | Self::Extreme | Self::Random | Self::Snap | Self::Size => {
                false
            }
        }
    }
}

/// What points are snapped to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum SnapTo {
    /// The points of a square grid through the origin, at this distance from each other.
    Pitch(f64),
    /// Given places, each [x, y].
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::{Kind, described};

    #[test]
    fn every_strategy_is_listed_and_as_free_as_it_says() {
        let options = described::<Choices>();
        let Some(Kind::Word(words)) = options.iter().find(|o| o.key == "steiner").map(|o| &o.kind) else {
            panic!("a strategy is a word")
        };
        let listed = Steiner::ALL.map(|steiner| serde_json::to_value(steiner).unwrap());
        assert_eq!(words.iter().map(|(word, _)| word.as_str().into()).collect::<Vec<serde_json::Value>>(), listed);
        for steiner in Steiner::ALL {
            let choices = Choices { steiner, ..Choices::default() };
            assert_eq!(choices.strategy(0.3).is_free(), steiner.is_free(), "{steiner:?}");
        }
    }
}
