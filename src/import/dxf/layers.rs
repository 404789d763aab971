//! Layers: which are visible and selected, and the line types drawn on them.

use super::LineTypes;
use super::header::Header;
use super::sections::{Record, Sections};
use crate::domain::{Drawing, Layer};
use crate::ids::{IdVec, LayerId, NameId};
use crate::import::selection::{Chooser, Selection};
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// Layer 0. Its entities in a block take the layer of the block. Every file has it.
pub(super) const LAYER_0: LayerId = LayerId(0);

/// The default line type.
pub(super) const CONTINUOUS: &str = "CONTINUOUS";

const FROZEN: &str = "on a frozen layer";
const OFF: &str = "on a layer that is off";
const DEFPOINTS: &str = "on the layer Defpoints, of construction points";
/// Why lines of certain line types are left out.
pub(super) const AUXILIARY: &str = "of a line type that draws no edge (--line-types all keeps it)";
const NOT_SELECTED: &str = "on a layer that --layers or --skip-layers leaves out";

/// Why a layer is invisible.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Hidden {
    Frozen,
    Off,
    Defpoints,
}

impl Hidden {
    /// The reason in words.
    pub fn why(self) -> &'static str {
        match self {
            Self::Frozen => FROZEN,
            Self::Off => OFF,
            Self::Defpoints => DEFPOINTS,
        }
    }
}

/// The line type of an entity, from group 6.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum LineType {
    OfLayer,
    /// That of the INSERT that draws the block.
    OfBlock,
    /// In upper case.
    Named(Rc<str>),
}

impl LineType {
    /// The line type of a record.
    pub fn of(record: &Record, header: &Header) -> Self {
        let name = header.name(record.text(6).unwrap_or_default()).to_uppercase();
        match name.as_str() {
            "" | "BYLAYER" => Self::OfLayer,
            "BYBLOCK" => Self::OfBlock,
            name => Self::Named(name.into()),
        }
    }
}

struct Row {
    /// The name in the spelling that the file uses first.
    text: String,
    /// The name in the drawing, once something is drawn on the layer.
    name: Option<NameId>,
    hidden: Option<Hidden>,
    /// Whether the layer is selected.
    selected: bool,
    line_type: Rc<str>,
    /// Number of drawn entities, by line type.
    drawn: BTreeMap<Rc<str>, usize>,
}

/// The layers of a file: those of its table, and those that entities name.
pub(super) struct Layers<'s> {
    rows: IdVec<LayerId, Row>,
    id_of: BTreeMap<String, LayerId>,
    chooser: Chooser<'s>,
    line_types: LineTypes,
    /// Line types that are chain lines by their patterns, in upper case.
    chained: BTreeSet<String>,
}

impl<'s> Layers<'s> {
    /// The layers and line types of the tables of a file.
    pub fn new(file: &Sections, header: &Header, selection: &'s Selection, line_types: LineTypes) -> Self {
        let chained = file.line_types.iter().filter(|record| is_chained(record));
        let mut layers = Self {
            rows: IdVec::new(),
            id_of: BTreeMap::new(),
            chooser: Chooser::new(selection, false),
            line_types,
            chained: chained.map(|record| header.name(record.text(2).unwrap_or_default()).to_uppercase()).collect(),
        };
        layers.id("0");
        for record in &file.layers {
            layers.add(record, header);
        }
        layers
    }

    fn add(&mut self, record: &Record, header: &Header) {
        let flag = |code| record.find(code).and_then(|pair| pair.integer()).unwrap_or(0);
        let hidden = if flag(70) & 1 != 0 {
            Some(Hidden::Frozen)
        } else if flag(62) < 0 {
            Some(Hidden::Off)
        } else {
            None
        };
        let layer = self.id(&header.name(record.text(2).unwrap_or_default()));
        let row = &mut self.rows[layer];
        row.hidden = row.hidden.or(hidden);
        if let LineType::Named(name) = LineType::of(record, header) {
            row.line_type = name;
        }
    }

    /// The layer of this name, added to the table if it is new.
    pub fn id(&mut self, name: &str) -> LayerId {
        let key = key(name);
        if let Some(&layer) = self.id_of.get(&key) {
            return layer;
        }
        let hidden = (key == "defpoints").then_some(Hidden::Defpoints);
        let row = Row {
            text: name.to_owned(),
            name: None,
            hidden,
            selected: self.chooser.takes([name]),
            line_type: CONTINUOUS.into(),
            drawn: BTreeMap::new(),
        };
        let layer = self.rows.push(row);
        self.id_of.insert(key, layer);
        layer
    }

    /// Why the layer is invisible, if it is.
    pub fn hidden(&self, layer: LayerId) -> Option<Hidden> {
        self.rows[layer].hidden
    }

    /// Why entities of this layer are left out, if they are.
    pub fn why_not(&self, layer: LayerId) -> Option<&'static str> {
        let row = &self.rows[layer];
        row.hidden.map(Hidden::why).or((!row.selected).then_some(NOT_SELECTED))
    }

    /// The line type of an entity on this layer, in a block drawn with line type `of_block`.
    pub fn line_type(&self, line_type: &LineType, layer: LayerId, of_block: &Rc<str>) -> Rc<str> {
        match line_type {
            LineType::OfLayer => Rc::clone(&self.rows[layer].line_type),
            LineType::OfBlock => Rc::clone(of_block),
            LineType::Named(name) => Rc::clone(name),
        }
    }

    /// Whether lines of this type are no edges, and are left out.
    pub fn is_auxiliary(&self, line_type: &str) -> bool {
        self.line_types == LineTypes::Edges && (is_auxiliary(line_type) || self.chained.contains(line_type))
    }

    /// Counts a drawn entity.
    pub fn count(&mut self, layer: LayerId, line_type: Rc<str>) {
        *self.rows[layer].drawn.entry(line_type).or_insert(0) += 1;
    }

    /// The name of curves on the layer.
    pub fn name(&mut self, layer: LayerId, drawing: &mut Drawing) -> NameId {
        let Row { text, name, .. } = &mut self.rows[layer];
        *name.get_or_insert_with(|| drawing.names.intern(text))
    }

    /// Adds the layers to the drawing, and the names that were asked for and do not exist.
    pub fn hand_over(self, drawing: &mut Drawing) {
        let line_types = |row: &Row| row.drawn.iter().map(|(name, &count)| (name.to_string(), count)).collect();
        let layer = |row: &Row| Layer { name: row.text.clone(), line_types: line_types(row) };
        drawing.layers = self.rows.iter().map(layer).collect();
        drawing.unmatched = self.chooser.unmatched();
    }
}

/// Whether a line type is a chain line by its pattern: dashes with dots, or long dashes with short ones. Names vary
/// (SLD-Center of SolidWorks, AM_ISO08W050, Strichpunkt). Patterns with letters or symbols are pipes and fences.
fn is_chained(record: &Record) -> bool {
    /// Dashes count as equally long if the shorter one has this part of the longer one.
    const ALIKE: f64 = 0.9;
    let reals = |code: i32| record.reals(code).unwrap_or_default();
    let dashes: Vec<f64> = reals(49).into_iter().filter(|&length| length >= 0.0).collect();
    let (shortest, longest) = dashes.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &d| (a.min(d), b.max(d)));
    shortest < ALIKE * longest && reals(74).iter().all(|&symbol| symbol == 0.0)
}

/// Whether drafting standards use a line type, in upper case, for centre lines, hidden lines or borders.
///
/// The names are those of `acad.lin` and `acadiso.lin`. The standard types come in groups: `CENTER2` is finer and
/// `CENTERX2` is coarser than `CENTER`. Types of ISO 128 have numbers: 02 dashed, 03 dashed spaced, 04 to 15 with dots
/// or double dashes. Of JIS, 08 are centre lines and 09 phantom lines.
fn is_auxiliary(line_type: &str) -> bool {
    const GROUPS: [&str; 9] =
        ["CENTER", "CENTRE", "PHANTOM", "HIDDEN", "DASHDOT", "DIVIDE", "BORDER", "JIS_08", "JIS_09"];
    const ISO: [&str; 4] = ["ACAD_ISO", "AM_ISO", "ISO", "DIN_ISO"];
    let is_iso = |rest: &str| {
        let digits = rest.trim_start_matches(['_', '-', ' ']);
        let end = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
        digits[..end].len() == 2 && digits[end..].starts_with('W') && matches!(digits[..end].parse(), Ok(4..=15))
    };
    GROUPS.iter().any(|group| line_type.starts_with(group))
        || ISO.iter().filter_map(|iso| line_type.strip_prefix(iso)).any(is_iso)
}

/// The key of a layer or block. Names are equal in upper and lower case.
pub(super) fn key(name: &str) -> String {
    name.to_lowercase()
}
