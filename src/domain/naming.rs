//! Names that the user gives: to the curve or the region at a place, to an entity by its handle, to every outline or
//! entity.

use super::{Drawing, Seed, SeedKind};
use crate::geometry::boxes::BoxHierarchy;
use crate::geometry::{Point, Rect, extent};
use crate::ids::Forest;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::str::FromStr;

/// `NAME=x,y`, `NAME=in:x,y` or `NAME=handle:2F`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "String", into = "String")]
pub struct NameBy {
    /// The name.
    pub name: String,
    /// What gets the name.
    pub target: Target,
}

/// What is named.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// The curve nearest to a place.
    Nearest(Point),
    /// The region at a place.
    Region(Point),
    /// The curves of an entity.
    Handle(u64),
}

/// What gets a name of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Naming {
    /// Every layer, or what else the file names.
    Layer,
    /// Every closed outline: HOLES-1, HOLES-2.
    Outline,
    /// Every entity, by its handle where it has one: HOLES-2F.
    Entity,
}

impl FromStr for NameBy {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let (name, target) = text.rsplit_once('=').ok_or("NAME=x,y, NAME=in:x,y or NAME=handle:H is expected")?;
        if name.is_empty() {
            return Err("a name is missing before '='".into());
        }
        let target = if let Some(handle) = target.strip_prefix("handle:") {
            let handle = u64::from_str_radix(handle, 16);
            Target::Handle(
                handle.map_err(|_| format!("'{target}' is no handle, a hexadecimal number as in handle:2F"))?,
            )
        } else if let Some(place) = target.strip_prefix("in:") {
            Target::Region(place_of(place)?)
        } else {
            Target::Nearest(place_of(target)?)
        };
        Ok(Self { name: name.into(), target })
    }
}

fn place_of(text: &str) -> Result<Point, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    let place = text.split_once(',').and_then(|(x, y)| Some(Point::new(number(x)?, number(y)?)));
    place.ok_or_else(|| format!("'{text}' is no place, two numbers as in 3.5,-2"))
}

impl TryFrom<String> for NameBy {
    type Error = String;
    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<NameBy> for String {
    fn from(name: NameBy) -> Self {
        name.to_string()
    }
}

impl fmt::Display for NameBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.target {
            Target::Nearest(at) => write!(f, "{}={},{}", self.name, at.x, at.y),
            Target::Region(at) => write!(f, "{}=in:{},{}", self.name, at.x, at.y),
            Target::Handle(handle) => write!(f, "{}=handle:{handle:X}", self.name),
        }
    }
}

/// Ends nearer than this part of the diagonal count as one, as where gaps are closed.
const SAME_END: f64 = 1e-6;

impl Drawing {
    /// Gives a name. Returns a sentence on what was named, except for a region.
    ///
    /// # Errors
    /// Where there is no curve with that handle, or no curve at all; the message lists handles that exist.
    pub fn give_name(&mut self, given: &NameBy) -> Result<Option<String>, String> {
        match given.target {
            Target::Nearest(at) => self.name_nearest(&given.name, at).map(Some),
            Target::Region(at) => {
                let (name, entity) = (self.names.intern(&given.name), format!("--name {given}"));
                // Of several points in a region the first names it.
                self.seeds.insert(0, Seed { at, kind: SeedKind::Region { name, max_area: None }, entity });
                Ok(None)
            }
            Target::Handle(handle) => self.name_entity(&given.name, handle).map(Some),
        }
    }

    fn name_nearest(&mut self, name: &str, at: Point) -> Result<String, String> {
        let away = |k: usize| self.curves[k].curve.nearest(at, 0.0, 1.0).1;
        let boxes = BoxHierarchy::new(self.curves.iter().map(|drawn| drawn.curve.bounds()));
        let (nearest, distance) =
            boxes.nearest(at, f64::INFINITY, |k, _| away(k)).ok_or("the drawing has no curves")?;
        let same = boxes.nearest(at, distance.next_up(), |k, _| if k == nearest { f64::INFINITY } else { away(k) });
        let name = self.names.intern(name);
        self.curves[nearest].name = name;
        let as_near = same.map_or_else(String::new, |(other, _)| {
            format!("; {} is as near: a place within one of them tells which", self.curves[other].entity)
        });
        let entity = &self.curves[nearest].entity;
        let away: f64 = format!("{distance:.3e}").parse().unwrap_or(distance);
        Ok(format!("{} names {entity}, {away} away from ({}, {}){as_near}.", self.names.text(name), at.x, at.y))
    }

    fn name_entity(&mut self, name: &str, handle: u64) -> Result<String, String> {
        let of_entity: Vec<usize> = (0..self.curves.len()).filter(|&k| self.curves[k].handle == Some(handle)).collect();
        let Some(&first) = of_entity.first() else {
            let handles: BTreeSet<u64> = self.curves.iter().filter_map(|drawn| drawn.handle).collect();
            let listed: Vec<String> = handles.iter().take(8).map(|handle| format!("{handle:X}")).collect();
            return Err(match listed.is_empty() {
                true => "the curves of this file have no handles".into(),
                false => format!("no curve has this handle; those that are read have {}, …", listed.join(", ")),
            });
        };
        let id = self.names.intern(name);
        of_entity.iter().for_each(|&k| self.curves[k].name = id);
        Ok(format!("{name} names {}.", self.curves[first].entity))
    }

    /// Gives every outline or entity a name of its own.
    pub fn name_each(&mut self, naming: Naming) {
        match naming {
            Naming::Layer => {}
            Naming::Outline => self.name_outlines(),
            Naming::Entity => self.name_entities(),
        }
    }

    fn name_entities(&mut self) {
        for k in 0..self.curves.len() {
            let drawn = &self.curves[k];
            let own = drawn.handle.map_or_else(|| drawn.entity.clone(), |handle| format!("{handle:X}"));
            let text = format!("{}-{own}", self.names.text(drawn.name));
            self.curves[k].name = self.names.intern(&text);
        }
    }

    /// Numbers the closed outlines of each name in the order in which they begin. Open lines keep their names.
    fn name_outlines(&mut self) {
        let mut numbers: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        let mut named = Vec::new();
        for (k, outline) in self.closed_outlines().into_iter().enumerate() {
            let Some(outline) = outline else { continue };
            let name = self.curves[k].name;
            let number = *numbers.entry((name.0 as usize, outline)).or_insert_with(|| {
                let count = counts.entry(name.0 as usize).or_default();
                *count += 1;
                *count
            });
            named.push((k, format!("{}-{number}", self.names.text(name))));
        }
        for (k, text) in named {
            self.curves[k].name = self.names.intern(&text);
        }
    }

    /// The closed outline to which each curve belongs. Its curves have one name and shape, are joined end to end, and
    /// have no free end.
    fn closed_outlines(&self) -> Vec<Option<usize>> {
        let near = SAME_END * self.bounds().map_or(0.0, extent);
        let ends: Vec<Point> = self.curves.iter().flat_map(|drawn| [drawn.curve.start(), drawn.curve.end()]).collect();
        let around = |&at: &Point| Rect::from_points(at, at).inflate(near / 2.0, near / 2.0);
        let key = |end: usize| (self.curves[end / 2].name, self.curves[end / 2].shape);
        let mut outlines = Forest::new(self.curves.len());
        let mut meets = vec![false; ends.len()];
        BoxHierarchy::new(ends.iter().map(around)).pairs(
            |_| Default::default(),
            |i, j| {
                if key(i) == key(j) {
                    outlines.join(i / 2, j / 2);
                    (meets[i], meets[j]) = (true, true);
                }
            },
        );
        let roots: Vec<usize> = (0..self.curves.len()).map(|k| outlines.root(k)).collect();
        let open: BTreeSet<usize> = (0..ends.len()).filter(|&end| !meets[end]).map(|end| roots[end / 2]).collect();
        roots.into_iter().map(|root| Some(root).filter(|root| !open.contains(root))).collect()
    }
}
