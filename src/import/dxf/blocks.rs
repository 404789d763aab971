//! Places entities: on visible layers, and in blocks, once for each insertion.

use super::DxfOptions;
use super::entities::figure;
use super::figure::{DEGENERATE, Figure, Insert, Level, NO_OUTLINE, Notices, Refusal, TILTED};
use super::fills::Fill;
use super::header::Header;
use super::layers::{AUXILIARY, CONTINUOUS, Hidden, LAYER_0, Layers, LineType, key};
use super::pairs::shown;
use super::sections::{Record, Sections};
use super::text;
use crate::curve::Curve;
use crate::domain::{Drawing, DrawnCurve, DrawnPoint, Label, OffPlane, Skipped};
use crate::geometry::{Point, Vec2};
use crate::ids::LayerId;
use crate::import::{ImportError, Selection};
use kurbo::Affine;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Largest number of instances, entities and spline control points after expansion, together.
const UNFOLDED: usize = 1_000_000;
/// Largest nesting of blocks in blocks.
const DEPTH: usize = 32;
/// A longer path through blocks is cut in messages.
const LONGEST_PATH: usize = 200;
/// The scales of an insertion whose products remain finite.
const SCALES: std::ops::Range<f64> = 1e-150..1e150;

/// An entity, read once and drawn once for each instance of its block. Layers and blocks are indices, because names may
/// be long.
struct Entity<'a> {
    kind: String,
    label: String,
    handle: Option<u64>,
    layer: LayerId,
    line_type: LineType,
    /// The block that an INSERT draws, where the file defines it.
    block: Option<usize>,
    figure: Result<Figure<'a>, &'static str>,
}

/// The place where the entities of a block are drawn.
struct Setting {
    map: Option<Affine>,
    z: f64,
    z_scale: f64,
    /// Largest factor from a length in the block to the drawing.
    scale: f64,
    /// The layer of entities on layer 0.
    layer: Option<LayerId>,
    /// The line type of entities with the line type BYBLOCK.
    line_type: Rc<str>,
    /// `INSERT "BOLT" (line 12) > `
    path: String,
    /// The blocks around it. They tell whether a block contains itself.
    within: Vec<usize>,
}

/// The attributes of an entity that is drawn: layer, line type, name and place.
struct Pen<'e, 'a> {
    entity: &'e Entity<'a>,
    layer: LayerId,
    line_type: Rc<str>,
    /// The entity with the path to its block, for messages.
    label: String,
    setting: &'e Setting,
}

/// A drawing while it is read.
pub(super) struct Sketch<'f, 'a> {
    file: &'f Sections<'a>,
    header: &'f Header,
    options: &'f DxfOptions,
    drawing: &'f mut Drawing,
    layers: Layers<'f>,
    block_of: BTreeMap<String, usize>,
    /// The entities of blocks that were read already.
    read: BTreeMap<usize, Rc<Vec<Entity<'a>>>>,
    fills: Vec<Fill>,
    skipped: BTreeMap<(String, &'static str), usize>,
    notices: Notices,
    /// Lowest and highest z of the drawn entities.
    heights: Option<[f64; 2]>,
    /// Number of entities projected onto the plane.
    flattened: usize,
    left: usize,
}

impl<'f, 'a> Sketch<'f, 'a> {
    /// An empty drawing for the blocks of a file.
    pub fn new(
        file: &'f Sections<'a>,
        header: &'f Header,
        options: &'f DxfOptions,
        selection: &'f Selection,
        drawing: &'f mut Drawing,
    ) -> Self {
        // The first block of a name counts.
        let blocks = file.blocks.iter().enumerate().rev();
        Self {
            file,
            header,
            options,
            drawing,
            layers: Layers::new(file, header, selection, options.line_types),
            block_of: blocks.map(|(i, (name, _))| (key(&header.name(name)), i)).collect(),
            read: BTreeMap::new(),
            fills: Vec::new(),
            skipped: BTreeMap::new(),
            notices: Notices::default(),
            heights: None,
            flattened: 0,
            left: UNFOLDED,
        }
    }

    /// Draws the entities of model space, and returns their hatches.
    pub fn draw(mut self) -> Result<Vec<Fill>, ImportError> {
        let setting = Setting {
            map: None,
            z: 0.0,
            z_scale: 1.0,
            scale: 1.0,
            layer: None,
            line_type: CONTINUOUS.into(),
            path: String::new(),
            within: Vec::new(),
        };
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
        if self.flattened > 0 {
            let note = format!("Entities that leave the XY plane, and were projected onto it: {}.", self.flattened);
            self.drawing.notes.push(note);
        }
        self.drawing.notes.extend(self.notices.into_notes());
        let skipped = |((entity, why), count): ((String, &str), usize)| Skipped { entity, count, why: why.into() };
        self.drawing.skipped.extend(self.skipped.into_iter().map(skipped));
        self.layers.hand_over(self.drawing);
        Ok(self.fills)
    }

    fn skip(&mut self, kind: &str, why: &'static str) {
        *self.skipped.entry((kind.to_owned(), why)).or_insert(0) += 1;
    }

    // ---- reading ----

    /// The entities of a block or of the drawing, each with its vertices and attributes.
    fn entities(&mut self, records: &[Record<'a>]) -> Result<Vec<Entity<'a>>, ImportError> {
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

    fn entity(&mut self, record: &Record<'a>, followers: &[Record<'a>]) -> Result<Entity<'a>, ImportError> {
        let name = self.header.name(record.text(8).filter(|n| !n.is_empty()).unwrap_or(b"0"));
        let layer = self.layers.id(&name);
        let is_set = |code| record.find(code).and_then(|pair| pair.integer()).is_some_and(|flag| flag != 0);
        let figure = match self.layers.why_not(layer) {
            _ if is_set(67) => Err("in paper space"),
            _ if is_set(60) => Err("invisible"),
            // On layer 0 of a block an entity is as visible as the block. A block may contain entities of other layers
            // than its own.
            Some(why) if layer != LAYER_0 && record.kind != "INSERT" => Err(why),
            _ => match figure(record, followers, &mut self.notices) {
                Ok(figure) => Ok(figure),
                Err(Refusal::Skip(why)) => Err(why),
                Err(Refusal::Degenerate) => Err(DEGENERATE),
                Err(Refusal::Broken(error)) => return Err(error),
            },
        };
        let block = match &figure {
            Ok(Figure::Insert(insert)) => self.block_of.get(&key(&self.header.name(insert.block))).copied(),
            _ => None,
        };
        let line_type = LineType::of(record, self.header);
        let (kind, label, handle) = (record.kind.clone(), record.label(), record.handle());
        Ok(Entity { kind, label, handle, layer, line_type, block, figure })
    }

    // ---- drawing ----

    fn draw_entity(&mut self, entity: &Entity<'a>, setting: &Setting) -> Result<(), ImportError> {
        let figure = match &entity.figure {
            Ok(figure) => figure,
            Err(why) => {
                self.skip(&entity.kind, why);
                return Ok(());
            }
        };
        let inherited = setting.layer.filter(|_| entity.layer == LAYER_0);
        let layer = inherited.unwrap_or(entity.layer);
        let line_type = self.layers.line_type(&entity.line_type, layer, &setting.line_type);
        if let Some(why) = self.why_not_drawn(figure, layer, &line_type) {
            self.skip(&entity.kind, why);
            return Ok(());
        }
        let pen = Pen { entity, layer, line_type, label: format!("{}{}", setting.path, entity.label), setting };
        match figure {
            Figure::Curves { curves, level, parts, last_decimal } => {
                self.draw_curves(curves, *level, parts, *last_decimal, pen)
            }
            Figure::Point { at, z } => {
                self.draw_point(*at, *z, pen);
                Ok(())
            }
            Figure::Fill { loops, last_decimal } => self.draw_fill(loops, *last_decimal, pen),
            Figure::Text { at, bytes } => self.draw_text(*at, bytes, &pen),
            Figure::Insert(insert) => self.draw_insert(insert, pen),
        }
    }

    /// Why a figure of this layer and line type is left out; `None`: it is drawn.
    fn why_not_drawn(&self, figure: &Figure, layer: LayerId, line_type: &str) -> Option<&'static str> {
        match figure {
            // A block may contain entities of other layers. Only a frozen layer makes these invisible, too.
            Figure::Insert(_) => self.layers.hidden(layer).filter(|h| *h == Hidden::Frozen).map(Hidden::why),
            Figure::Curves { .. } | Figure::Point { .. } | Figure::Fill { .. } | Figure::Text { .. } => {
                let auxiliary = || self.layers.is_auxiliary(line_type).then_some(AUXILIARY);
                self.layers.why_not(layer).or_else(auxiliary)
            }
        }
    }

    fn draw_curves(
        &mut self,
        curves: &[Curve],
        level: Level,
        parts: &str,
        last_decimal: f64,
        Pen { entity, layer, line_type, label, setting }: Pen<'_, 'a>,
    ) -> Result<(), ImportError> {
        let placed: Result<Vec<Option<Curve>>, _> =
            curves.iter().map(|curve| self.placed(curve, setting, &label)).collect();
        let placed = placed?;
        let lost = match level {
            Level::At(z) => {
                self.rise(setting, z);
                "too small for numbers once it is inserted"
            }
            Level::Leaves if self.options.flatten_z.is_on() => {
                self.flattened += 1;
                "seen from its side"
            }
            Level::Leaves => {
                self.leave_out(label, &placed);
                self.skip(&entity.kind, TILTED);
                return Ok(());
            }
        };
        let name = self.layers.name(layer, self.drawing);
        self.layers.count(layer, line_type);
        for (i, curve) in placed.into_iter().enumerate() {
            let text = if parts.is_empty() { label.clone() } else { format!("{label}, {parts} {}", i + 1) };
            match curve {
                Some(curve) => self.drawing.curves.push(DrawnCurve {
                    layer: Some(layer),
                    handle: entity.handle,
                    last_decimal: last_decimal * setting.scale,
                    ..DrawnCurve::new(curve, name, text)
                }),
                None => self.skip("curve", lost),
            }
        }
        Ok(())
    }

    fn draw_point(&mut self, at: Point, z: f64, Pen { layer, line_type, label, setting, .. }: Pen) {
        self.rise(setting, z);
        self.layers.count(layer, line_type);
        let at = setting.map.map_or(at, |map| map * at);
        let name = Some(self.layers.name(layer, self.drawing));
        self.drawing.points.push(DrawnPoint { at, name, entity: label });
    }

    fn draw_fill(
        &mut self,
        loops: &[Vec<Curve>],
        last_decimal: f64,
        Pen { entity, layer, line_type, label, setting }: Pen,
    ) -> Result<(), ImportError> {
        let placed: Result<Option<Vec<Vec<Curve>>>, _> = (loops.iter())
            .map(|outline| outline.iter().map(|curve| self.placed(curve, setting, &label)).collect())
            .collect();
        match placed? {
            Some(loops) => {
                self.layers.count(layer, line_type);
                let name = self.layers.name(layer, self.drawing);
                let (handle, last_decimal) = (entity.handle, last_decimal * setting.scale);
                self.fills.push(Fill { name, layer, handle, last_decimal, loops, entity: label });
            }
            None => self.skip(&entity.kind, "too small for numbers once it is inserted"),
        }
        Ok(())
    }

    /// A text draws no curve, but may name a region.
    fn draw_text(&mut self, at: Point, bytes: &[u8], pen: &Pen) -> Result<(), ImportError> {
        self.skip(&pen.entity.kind, NO_OUTLINE);
        if let Some(text) = text::name(&self.header.name(bytes)) {
            self.spend(1, &pen.label)?;
            let at = pen.setting.map.map_or(at, |map| map * at);
            self.drawing.labels.push(Label { at, text });
        }
        Ok(())
    }

    /// A curve mapped to its place; `None` where it shrinks to a point.
    fn placed(&mut self, curve: &Curve, setting: &Setting, label: &str) -> Result<Option<Curve>, ImportError> {
        let curve = match setting.map {
            None => curve.clone(),
            Some(map) => {
                self.spend(curve.control_count(), label)?;
                curve.transformed(map)
            }
        };
        let is_sound = match &curve {
            Curve::Arc(arc) => arc.radius > 0.0,
            Curve::Ellipse(ellipse) => ellipse.u.cross(ellipse.v) != 0.0,
            Curve::Clothoid(clothoid) => clothoid.length() > 0.0,
            Curve::Line(_) | Curve::Bezier(_) | Curve::Spline(_) => true,
        };
        Ok(is_sound.then_some(curve))
    }

    /// Counts an entity that is left out because it leaves the plane.
    fn leave_out(&mut self, entity: String, curves: &[Option<Curve>]) {
        let (mut drawn, mut from_end) = (curves.iter().flatten(), curves.iter().flatten().rev());
        if let (Some(first), Some(last)) = (drawn.next(), from_end.next()) {
            self.drawing.off_plane.push(OffPlane { entity, ends: [first.start(), last.end()] });
        }
    }

    /// Records a height.
    fn rise(&mut self, setting: &Setting, z: f64) {
        let z = setting.z + setting.z_scale * z;
        let [low, high] = self.heights.unwrap_or([z, z]);
        self.heights = Some([low.min(z), high.max(z)]);
    }

    fn spend(&mut self, cost: usize, label: &str) -> Result<(), ImportError> {
        self.left = self.left.checked_sub(cost).ok_or_else(|| {
            let what = format!("{label}: blocks unfold to more than {UNFOLDED} curves");
            ImportError::new(what, "leave out blocks that are not part of the outline, or explode and purge them")
        })?;
        Ok(())
    }

    /// Draws a block in all rows and columns, if the file defines it.
    fn draw_insert(&mut self, insert: &Insert<'a>, pen: Pen<'_, 'a>) -> Result<(), ImportError> {
        let (entity, setting) = (pen.entity, pen.setting);
        let Some(place) = entity.block else {
            self.skip(&entity.kind, "of a block that the file does not define");
            return Ok(());
        };
        let block = &self.file.blocks[place].1;
        if block.is_external {
            self.skip(&entity.kind, "of a block in another file (bind it)");
            return Ok(());
        }
        if setting.within.contains(&place) {
            self.skip(&entity.kind, "of a block that holds itself");
            return Ok(());
        }
        let path = self.path(insert, entity, setting);
        if setting.within.len() >= DEPTH {
            let what = format!("{path}blocks stand in blocks more than {DEPTH} deep");
            return Err(ImportError::new(what, "explode the inner blocks"));
        }
        let within = [&setting.within[..], &[place]].concat();
        let inner = Setting {
            map: None,
            z: setting.z + setting.z_scale * insert.z,
            z_scale: setting.z_scale * insert.z_scale,
            scale: 1.0,
            layer: Some(pen.layer),
            line_type: pen.line_type,
            path,
            within,
        };
        self.draw_block(place, insert, setting.map.unwrap_or_default(), inner)
    }

    /// Draws a block once for each row and column. `outer` maps the coordinates around the insertion to the drawing.
    ///
    /// ```text
    ///    block "B"      map = outer · T(offset) · insert.map · T(−base), applied from right to left:
    ///      ┌──┐
    ///      │  │         T(−base)    moves the base point to the origin
    ///      ●──┘         insert.map  scales, rotates, and moves to the insertion point
    ///    base           T(offset)   moves by column·steps[0] + row·steps[1], which are rotated but not scaled
    ///                   outer       is the map of the insertion of the block around it
    ///     ┌─┐ ┌─┐ ┌─┐   row 1
    ///     ●─┘ ●─┘ ●─┘
    ///     ┌─┐ ┌─┐ ┌─┐   row 0
    ///     ●─┘ ●─┘ ●─┘
    /// ```
    fn draw_block(
        &mut self,
        place: usize,
        insert: &Insert,
        outer: Affine,
        mut inner: Setting,
    ) -> Result<(), ImportError> {
        let entities = self.block_entities(place)?;
        let from_base = Affine::translate(-self.file.blocks[place].1.base.to_vec2());
        for (row, column) in (0..insert.rows).flat_map(|row| (0..insert.columns).map(move |column| (row, column))) {
            self.spend(1, &inner.path)?;
            let offset: Vec2 = insert.steps[0] * column as f64 + insert.steps[1] * row as f64;
            let map = outer * Affine::translate(offset) * insert.map * from_base;
            if !is_usable(map) {
                let what = format!("{}a block is drawn too large or too small for numbers", inner.path);
                return Err(ImportError::new(what, "correct the scales of the blocks"));
            }
            inner.map = Some(map);
            let [along, across] = columns(map);
            inner.scale = along.max(across);
            for entity in entities.iter() {
                self.spend(1, &inner.path)?;
                self.draw_entity(entity, &inner)?;
            }
        }
        Ok(())
    }

    /// The path to the entities of a block, for messages.
    fn path(&self, insert: &Insert, entity: &Entity, setting: &Setting) -> String {
        if setting.path.len() >= LONGEST_PATH {
            return setting.path.clone();
        }
        let name = self.header.name(&insert.block[..insert.block.len().min(LONGEST_PATH)]);
        let place = entity.label.trim_start_matches(entity.kind.as_str());
        format!("{}INSERT \"{}\"{place} > ", setting.path, shown(name.as_bytes()))
    }

    fn block_entities(&mut self, place: usize) -> Result<Rc<Vec<Entity<'a>>>, ImportError> {
        if let Some(entities) = self.read.get(&place) {
            return Ok(Rc::clone(entities));
        }
        let file = self.file;
        let entities = Rc::new(self.entities(&file.blocks[place].1.records)?);
        self.read.insert(place, Rc::clone(&entities));
        Ok(entities)
    }
}

/// The lengths of the mapped unit vectors of both axes.
fn columns(map: Affine) -> [f64; 2] {
    let [a, b, c, d, _, _] = map.as_coeffs();
    [libm::hypot(a, b), libm::hypot(c, d)]
}

fn is_usable(map: Affine) -> bool {
    let [.., x, y] = map.as_coeffs();
    let at = Point::new(x, y);
    columns(map).iter().all(|scale| SCALES.contains(scale)) && at.is_finite() && x.abs().max(y.abs()) < SCALES.end
}
