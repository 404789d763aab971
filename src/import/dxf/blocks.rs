//! Entities put where they belong: on layers that are seen or not, and in blocks, as often as these are inserted.

use super::entities::{Figure, Insert, Notices, Refusal, figure};
use super::header::Header;
use super::pairs::shown;
use super::sections::{Block, Record, Sections};
use crate::curve::Curve;
use crate::domain::{Drawing, DrawnCurve, DrawnPoint, Skipped};
use crate::geometry::{Point, Vec2};
use crate::ids::NameId;
use crate::import::ImportError;
use kurbo::Affine;
use std::collections::BTreeMap;
use std::rc::Rc;

/// How much blocks may unfold to: instances, entities, and control points of splines together.
const UNFOLDED: usize = 1_000_000;
/// How deep blocks may stand in blocks.
const DEPTH: usize = 32;
/// A longer way through blocks is not told in full.
const LONGEST_PATH: usize = 200;
/// The scales of an insertion that leave numbers to work with.
const SCALES: std::ops::Range<f64> = 1e-150..1e150;

/// The hatched area of one entity.
pub(super) struct Fill {
    pub name: NameId,
    pub outlines: Vec<Curve>,
    pub entity: String,
}

/// An entity, read.
struct Entity {
    kind: String,
    label: String,
    layer: String,
    figure: Result<Figure, &'static str>,
}

struct Layer {
    /// As the file spells it first.
    name: NameId,
    hidden: Option<Hidden>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Hidden {
    Frozen,
    Off,
    Defpoints,
}

impl Hidden {
    fn why(self) -> &'static str {
        match self {
            Self::Frozen => "on a frozen layer",
            Self::Off => "on a layer that is off",
            Self::Defpoints => "on the layer Defpoints, of construction points",
        }
    }
}

/// Where and how the entities of a block are drawn.
struct Setting {
    map: Option<Affine>,
    z: f64,
    z_scale: f64,
    /// The layer that entities on layer 0 take.
    layer: Option<String>,
    /// `INSERT "BOLT" (line 12) > `
    path: String,
    /// Blocks that it stands in, to tell a block that holds itself.
    within: Vec<String>,
}

/// A drawing in the making.
pub(super) struct Sketch<'f, 'a> {
    file: &'f Sections<'a>,
    header: &'f Header,
    drawing: &'f mut Drawing,
    layers: BTreeMap<String, Layer>,
    blocks: BTreeMap<String, &'f Block<'a>>,
    /// Entities of the blocks that were drawn already.
    read: BTreeMap<String, Rc<Vec<Entity>>>,
    fills: Vec<Fill>,
    skipped: BTreeMap<(String, &'static str), usize>,
    notices: Notices,
    /// Lowest and highest height of what is drawn.
    heights: Option<[f64; 2]>,
    left: usize,
}

impl<'f, 'a> Sketch<'f, 'a> {
    pub fn new(file: &'f Sections<'a>, header: &'f Header, drawing: &'f mut Drawing) -> Self {
        // The first block of a name counts.
        let blocks = file.blocks.iter().rev().map(|(name, block)| (key(&header.name(name)), block)).collect();
        let mut sketch = Self {
            file,
            header,
            drawing,
            layers: BTreeMap::new(),
            blocks,
            read: BTreeMap::new(),
            fills: Vec::new(),
            skipped: BTreeMap::new(),
            notices: Notices::default(),
            heights: None,
            left: UNFOLDED,
        };
        for record in &file.layers {
            sketch.add_layer(record);
        }
        sketch
    }

    /// Draws the entities of model space; hands back their hatches.
    pub fn draw(mut self) -> Result<Vec<Fill>, ImportError> {
        let setting = Setting { map: None, z: 0.0, z_scale: 1.0, layer: None, path: String::new(), within: Vec::new() };
        for entity in self.entities(&self.file.entities)? {
            self.draw_entity(&entity, &setting)?;
        }
        if let Some([low, high]) = self.heights
            && low < high
        {
            self.drawing
                .notes
                .push(format!("Curves lie at heights from {low} to {high}: all were laid into one plane."));
        }
        self.drawing.notes.extend(self.notices.into_notes());
        let skipped = |((entity, why), count): ((String, &str), usize)| Skipped { entity, count, why: why.into() };
        self.drawing.skipped.extend(self.skipped.into_iter().map(skipped));
        Ok(self.fills)
    }

    fn skip(&mut self, kind: &str, why: &'static str) {
        *self.skipped.entry((kind.to_owned(), why)).or_insert(0) += 1;
    }

    // ---- layers ----

    fn add_layer(&mut self, record: &Record) {
        let name = self.header.name(record.text(2).unwrap_or_default());
        let flag = |code| record.find(code).and_then(|pair| pair.integer()).unwrap_or(0);
        let hidden = if flag(70) & 1 != 0 {
            Some(Hidden::Frozen)
        } else if flag(62) < 0 {
            Some(Hidden::Off)
        } else {
            None
        };
        let layer = self.layer(&key(&name), &name);
        layer.hidden = layer.hidden.or(hidden);
    }

    /// The layer of this key, which is made under this name if there is none.
    fn layer(&mut self, key: &str, name: &str) -> &mut Layer {
        let names = &mut self.drawing.names;
        let hidden = key.eq_ignore_ascii_case("defpoints").then_some(Hidden::Defpoints);
        self.layers.entry(key.to_owned()).or_insert_with(|| Layer { name: names.intern(name), hidden })
    }

    // ---- reading ----

    /// The entities of a block or of the drawing, each with the vertices and attributes that follow it.
    fn entities(&mut self, records: &[Record<'a>]) -> Result<Vec<Entity>, ImportError> {
        let mut entities = Vec::new();
        let mut rest = records;
        while let Some((record, after)) = rest.split_first() {
            let followers = match record.kind.as_str() {
                "POLYLINE" => after.iter().take_while(|r| r.kind == "VERTEX").count(),
                _ => 0,
            };
            let (followers, after) = after.split_at(followers);
            rest = after;
            if record.kind != "SEQEND" {
                entities.push(self.entity(record, followers)?);
            }
        }
        Ok(entities)
    }

    fn entity(&mut self, record: &Record<'a>, followers: &[Record<'a>]) -> Result<Entity, ImportError> {
        let name = self.header.name(record.text(8).filter(|n| !n.is_empty()).unwrap_or(b"0"));
        let layer = key(&name);
        let hidden = self.layer(&layer, &name).hidden;
        let is_set = |code| record.find(code).and_then(|pair| pair.integer()).is_some_and(|flag| flag != 0);
        let figure = match hidden {
            _ if is_set(67) => Err("in paper space"),
            _ if is_set(60) => Err("invisible"),
            // On layer 0 of a block an entity is as visible as the block, and a block may hold what is not on its layer.
            Some(hidden) if layer != "0" && record.kind != "INSERT" => Err(hidden.why()),
            _ => match figure(record, followers, &mut self.notices) {
                Ok(figure) => Ok(figure),
                Err(Refusal::Skip(why)) => Err(why),
                Err(Refusal::Broken(error)) => return Err(error),
            },
        };
        Ok(Entity { kind: record.kind.clone(), label: record.label(), layer, figure })
    }

    // ---- drawing ----

    fn draw_entity(&mut self, entity: &Entity, setting: &Setting) -> Result<(), ImportError> {
        let figure = match &entity.figure {
            Ok(figure) => figure,
            Err(why) => {
                self.skip(&entity.kind, why);
                return Ok(());
            }
        };
        let inherited = setting.layer.as_ref().filter(|_| entity.layer == "0");
        let layer = inherited.unwrap_or(&entity.layer);
        let Layer { name, hidden } = self.layers[layer];
        let insert_of_shown = matches!(figure, Figure::Insert(_)) && hidden != Some(Hidden::Frozen);
        if let Some(hidden) = hidden.filter(|_| !insert_of_shown) {
            self.skip(&entity.kind, hidden.why());
            return Ok(());
        }
        let label = format!("{}{}", setting.path, entity.label);
        match figure {
            Figure::Curves { curves, z, parts } => {
                self.rise(setting, *z);
                for (i, curve) in curves.iter().enumerate() {
                    let entity = if parts.is_empty() { label.clone() } else { format!("{label}, {parts} {}", i + 1) };
                    let curve = self.placed(curve, setting, &label)?;
                    match curve {
                        Some(curve) => self.drawing.curves.push(DrawnCurve { curve, name, entity, shape: None }),
                        None => self.skip("curve", "too small for numbers once it is inserted"),
                    }
                }
            }
            Figure::Point { at, z } => {
                self.rise(setting, *z);
                let at = setting.map.map_or(*at, |map| map * *at);
                self.drawing.points.push(DrawnPoint { at, name: Some(name), entity: label });
            }
            Figure::Fill { outlines } => {
                let placed: Result<Option<Vec<Curve>>, _> =
                    outlines.iter().map(|curve| self.placed(curve, setting, &label)).collect();
                match placed? {
                    Some(outlines) => self.fills.push(Fill { name, outlines, entity: label }),
                    None => self.skip("HATCH", "too small for numbers once it is inserted"),
                }
            }
            Figure::Insert(insert) => {
                let layer = layer.clone();
                self.draw_insert(insert, entity, layer, setting)?;
            }
        }
        Ok(())
    }

    /// A curve where the setting puts it; `None` where it shrinks to nothing.
    fn placed(&mut self, curve: &Curve, setting: &Setting, label: &str) -> Result<Option<Curve>, ImportError> {
        let Some(map) = setting.map else { return Ok(Some(curve.clone())) };
        self.spend(weight(curve), label)?;
        let curve = curve.transformed(map);
        let is_sound = match &curve {
            Curve::Arc(arc) => arc.radius > 0.0,
            Curve::Ellipse(ellipse) => ellipse.u.cross(ellipse.v) != 0.0,
            Curve::Line(_) | Curve::Bezier(_) | Curve::Spline(_) => true,
        };
        Ok(is_sound.then_some(curve))
    }

    /// Takes note of a height.
    fn rise(&mut self, setting: &Setting, z: f64) {
        let z = setting.z + setting.z_scale * z;
        let [low, high] = self.heights.unwrap_or([z, z]);
        self.heights = Some([low.min(z), high.max(z)]);
    }

    fn spend(&mut self, cost: usize, label: &str) -> Result<(), ImportError> {
        self.left = self.left.checked_sub(cost).ok_or_else(|| {
            let what = format!("{label}: blocks unfold to more than {UNFOLDED} curves");
            ImportError::new(what, "leave out blocks that are no part of the outline, or explode and purge them")
        })?;
        Ok(())
    }

    fn draw_insert(
        &mut self,
        insert: &Insert,
        entity: &Entity,
        layer: String,
        setting: &Setting,
    ) -> Result<(), ImportError> {
        let name = self.header.name(&insert.block);
        let block_key = key(&name);
        let Some(&block) = self.blocks.get(&block_key) else {
            self.skip(&entity.kind, "of a block that the file does not define");
            return Ok(());
        };
        if block.is_external {
            self.skip(&entity.kind, "of a block in another file (bind it)");
            return Ok(());
        }
        if setting.within.contains(&block_key) {
            self.skip(&entity.kind, "of a block that holds itself");
            return Ok(());
        }
        let step = format!(
            "INSERT \"{}\"{} > ",
            shown(name.as_bytes()),
            entity.label.trim_start_matches(entity.kind.as_str())
        );
        let path =
            if setting.path.len() < LONGEST_PATH { format!("{}{step}", setting.path) } else { setting.path.clone() };
        if setting.within.len() >= DEPTH {
            let what = format!("{path}blocks stand in blocks more than {DEPTH} deep");
            return Err(ImportError::new(what, "explode the inner blocks"));
        }
        let mut within = setting.within.clone();
        within.push(block_key.clone());
        let entities = self.block_entities(&block_key, block)?;
        let from_base = Affine::translate(-block.base.to_vec2());
        let mut inner = Setting {
            map: None,
            z: setting.z + setting.z_scale * insert.z,
            z_scale: setting.z_scale * insert.z_scale,
            layer: Some(layer),
            path,
            within,
        };
        for (row, column) in (0..insert.rows).flat_map(|row| (0..insert.columns).map(move |column| (row, column))) {
            self.spend(1, &inner.path)?;
            let offset: Vec2 = insert.steps[0] * column as f64 + insert.steps[1] * row as f64;
            let map = setting.map.unwrap_or_default() * Affine::translate(offset) * insert.map * from_base;
            if !is_usable(map) {
                let what = format!("{}a block is drawn too large or too small for numbers", inner.path);
                return Err(ImportError::new(what, "correct the scales of the blocks"));
            }
            inner.map = Some(map);
            for entity in entities.iter() {
                self.spend(1, &inner.path)?;
                self.draw_entity(entity, &inner)?;
            }
        }
        Ok(())
    }

    fn block_entities(&mut self, key: &str, block: &Block<'a>) -> Result<Rc<Vec<Entity>>, ImportError> {
        if let Some(entities) = self.read.get(key) {
            return Ok(Rc::clone(entities));
        }
        let entities = Rc::new(self.entities(&block.records)?);
        self.read.insert(key.to_owned(), Rc::clone(&entities));
        Ok(entities)
    }
}

/// Names of layers and blocks are the same in upper and lower case.
fn key(name: &str) -> String {
    name.to_lowercase()
}

/// What a curve costs in memory, where a line costs 1.
fn weight(curve: &Curve) -> usize {
    match curve {
        Curve::Line(_) | Curve::Arc(_) | Curve::Ellipse(_) => 1,
        Curve::Bezier(bezier) => bezier.points.len(),
        Curve::Spline(spline) => spline.spans.iter().map(|span| span.points.len()).sum(),
    }
}

fn is_usable(map: Affine) -> bool {
    let [a, b, c, d, x, y] = map.as_coeffs();
    let columns = [libm::hypot(a, b), libm::hypot(c, d)];
    let at = Point::new(x, y);
    columns.iter().all(|scale| SCALES.contains(scale)) && at.is_finite() && x.abs().max(y.abs()) < SCALES.end
}
