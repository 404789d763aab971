//! The sections of a file that describe geometry: header, tables, blocks and entities, as records of pairs.

use super::pairs::{Pair, Pairs, Place, shown};
use crate::geometry::Point;
use crate::import::ImportError;
use std::collections::BTreeMap;

const NOT_A_NUMBER: &str =
    "correct the number in the file, or export it again (numbers have a decimal point and no other marks)";
const CUT: &str = "the file was cut short: export or copy it again";
/// Larger coordinates are refused: products of two must stay finite.
const LARGEST: f64 = 1e150;

/// One entity, or one entry of a table.
#[derive(Clone, Debug)]
pub(super) struct Record<'a> {
    /// Upper case.
    pub kind: String,
    /// The place of its first pair.
    pub place: Place,
    /// Its pairs, without the first.
    pub pairs: Vec<Pair<'a>>,
}

impl<'a> Record<'a> {
    fn new(start: &Pair<'a>) -> Self {
        Self { kind: shown(start.text()).to_ascii_uppercase(), place: start.place, pairs: Vec::new() }
    }

    /// A part of the record as a record, with the same kind and handle.
    pub fn part(&self, handle: Option<&Pair<'a>>, pairs: &[Pair<'a>]) -> Self {
        let pairs = handle.into_iter().chain(pairs).copied().collect();
        Self { kind: self.kind.clone(), place: self.place, pairs }
    }

    /// The first pair with this code.
    pub fn find(&self, code: i32) -> Option<&Pair<'a>> {
        self.pairs.iter().find(|p| p.code == code)
    }

    /// The text of a group.
    pub fn text(&self, code: i32) -> Option<&'a [u8]> {
        self.find(code).map(Pair::text)
    }

    /// An integer; `default` where there is none.
    pub fn integer(&self, code: i32, default: i64) -> Result<i64, ImportError> {
        self.find(code).map_or(Ok(default), |pair| self.integer_of(pair))
    }

    /// The integer of a pair.
    pub fn integer_of(&self, pair: &Pair) -> Result<i64, ImportError> {
        pair.integer().ok_or_else(|| self.wrong(pair, "not a whole number"))
    }

    /// A number; `default` where there is none.
    pub fn real(&self, code: i32, default: f64) -> Result<f64, ImportError> {
        Ok(self.optional(code)?.unwrap_or(default))
    }

    /// A number, if there is one.
    pub fn optional(&self, code: i32) -> Result<Option<f64>, ImportError> {
        self.find(code).map(|pair| self.real_of(pair)).transpose()
    }

    /// A number that must be there.
    pub fn required(&self, code: i32) -> Result<f64, ImportError> {
        self.optional(code)?.ok_or_else(|| self.broken(format!("group {code} is missing")))
    }

    /// The number of a pair.
    pub fn real_of(&self, pair: &Pair) -> Result<f64, ImportError> {
        let value = pair.real().ok_or_else(|| self.wrong(pair, "not a finite number"))?;
        if value.abs() > LARGEST {
            return Err(self.wrong(pair, "larger than any drawing"));
        }
        Ok(value)
    }

    /// The point whose x is the first group of this code; `None` where there is no such group.
    pub fn optional_point(&self, code: i32) -> Result<Option<[f64; 3]>, ImportError> {
        let Some(x) = self.optional(code)? else { return Ok(None) };
        Ok(Some([x, self.required(code + 10)?, self.real(code + 20, 0.0)?]))
    }

    /// The point whose x has this code, which must be there.
    pub fn point(&self, code: i32) -> Result<[f64; 3], ImportError> {
        self.optional_point(code)?.ok_or_else(|| self.broken(format!("group {code} is missing")))
    }

    /// All points whose x has this code, in order.
    pub fn points(&self, code: i32) -> Result<Vec<[f64; 3]>, ImportError> {
        let mut points: Vec<([f64; 3], bool)> = Vec::new();
        for pair in &self.pairs {
            if pair.code == code {
                points.push(([self.real_of(pair)?, 0.0, 0.0], false));
            } else if let (Some((point, has_y)), 10 | 20) = (points.last_mut(), pair.code - code) {
                let axis = (pair.code - code) as usize / 10;
                point[axis] = self.real_of(pair)?;
                *has_y |= axis == 1;
            }
        }
        match points.iter().position(|(_, has_y)| !has_y) {
            Some(i) => Err(self.broken(format!("point {} has no y, group {}", i + 1, code + 10))),
            None => Ok(points.into_iter().map(|(point, _)| point).collect()),
        }
    }

    /// All values of this code, in order.
    pub fn reals(&self, code: i32) -> Result<Vec<f64>, ImportError> {
        self.pairs.iter().filter(|p| p.code == code).map(|pair| self.real_of(pair)).collect()
    }

    /// The unit of the last decimal of the numbers with these codes, the finest of them; 0 where all are whole.
    pub fn last_decimal(&self, codes: &[i32]) -> f64 {
        finest(self.pairs.iter().filter(|p| codes.contains(&p.code)).map(Pair::last_decimal))
    }

    /// The number by which the file identifies the entity.
    pub fn handle(&self) -> Option<u64> {
        u64::from_str_radix(std::str::from_utf8(self.text(5)?).ok()?, 16).ok()
    }

    /// `LINE (handle 2F, line 1204)`.
    pub fn label(&self) -> String {
        let place = self.place;
        match self.text(5).filter(|handle| !handle.is_empty()) {
            Some(handle) => format!("{} (handle {}, {place})", self.kind, shown(handle)),
            None => format!("{} ({place})", self.kind),
        }
    }

    /// An error about the record.
    pub fn broken(&self, what: impl std::fmt::Display) -> ImportError {
        let help = "draw the entity anew, or export the file again";
        self.place.error(format!("{}: {what}", self.label()), help)
    }

    fn wrong(&self, pair: &Pair, why: &str) -> ImportError {
        pair.place.error(format!("{}: group {} is {pair}, {why}", self.label(), pair.code), NOT_A_NUMBER)
    }
}

/// The smallest of some units; 0 counts as none.
pub(super) fn finest(units: impl Iterator<Item = f64>) -> f64 {
    units.filter(|&unit| unit > 0.0).reduce(f64::min).unwrap_or(0.0)
}

/// A block: entities about a base point. An INSERT draws them.
#[derive(Clone, Debug)]
pub(super) struct Block<'a> {
    /// The base point.
    pub base: Point,
    /// Whether the entities are in another file.
    pub is_external: bool,
    /// The records of its entities.
    pub records: Vec<Record<'a>>,
}

/// The contents of a file, as far as they describe geometry.
#[derive(Debug, Default)]
pub(super) struct Sections<'a> {
    /// Variables of the header, each with its first value.
    pub header: BTreeMap<&'a [u8], Pair<'a>>,
    /// The table of layers.
    pub layers: Vec<Record<'a>>,
    /// The table of line types.
    pub line_types: Vec<Record<'a>>,
    /// Blocks with their names.
    pub blocks: Vec<(&'a [u8], Block<'a>)>,
    /// The entities of model space.
    pub entities: Vec<Record<'a>>,
    /// Whether the file is binary.
    pub is_binary: bool,
    /// Notes about the file.
    pub notes: Vec<String>,
}

/// Why reading a section ended.
#[derive(Clone, Copy, PartialEq, Eq)]
enum End {
    Section,
    /// EOF stands within the section.
    File,
}

impl<'a> Sections<'a> {
    /// # Errors
    /// Where the file is not a sequence of pairs, or ends before its entities do. A part of a drawing must not pass for
    /// the whole.
    pub fn read(bytes: &'a [u8]) -> Result<Self, ImportError> {
        let mut pairs = Pairs::new(bytes)?;
        let mut file = Self { is_binary: pairs.is_binary(), ..Self::default() };
        let mut has_entities = false;
        match file.read_sections(&mut pairs, &mut has_entities) {
            // After the entities nothing is needed.
            Err(error) if has_entities => file.notes.push(format!("What follows the entities is damaged ({error}).")),
            other => other?,
        }
        Ok(file)
    }

    fn read_sections(&mut self, pairs: &mut Pairs<'a>, has_entities: &mut bool) -> Result<(), ImportError> {
        while let Some(pair) = pairs.next()? {
            if pair.code == 999 {
                continue;
            }
            if pair.starts("EOF") {
                self.note_rest(pairs);
                return Ok(());
            }
            if !pair.starts("SECTION") {
                let what = format!("expected a section (0, SECTION), found {}, {pair}", pair.code);
                return Err(pair.place.error(what, "is this a DXF file? export it again"));
            }
            let Some(name) = pairs.next()? else { break };
            let (end, section) = (self.read_section(&name, pairs)?, shown(name.text()));
            *has_entities |= section.eq_ignore_ascii_case("ENTITIES");
            if end == End::File {
                self.notes.push(format!("Section {section} has no end, ENDSEC, but the file has (EOF)."));
                return Ok(());
            }
        }
        if !*has_entities {
            return Err(pairs.place().error("the file ends before its entities", CUT));
        }
        self.notes.push("The file does not say where it ends (EOF); its entities are whole.".into());
        Ok(())
    }

    fn note_rest(&mut self, pairs: &mut Pairs<'a>) {
        if !pairs.is_binary() && !matches!(pairs.next(), Ok(None)) {
            self.notes.push("What follows the end of the file (EOF) was passed over.".into());
        }
    }

    fn read_section(&mut self, name: &Pair<'a>, pairs: &mut Pairs<'a>) -> Result<End, ImportError> {
        let section = name.text().to_ascii_uppercase();
        match section.as_slice() {
            b"HEADER" => self.read_header(pairs),
            b"TABLES" => {
                let (layers, line_types) = (&mut self.layers, &mut self.line_types);
                read_records(pairs, "TABLES", |record| match record.kind.as_str() {
                    "LAYER" => layers.push(record),
                    "LTYPE" => line_types.push(record),
                    _ => {}
                })
            }
            b"BLOCKS" => self.read_blocks(pairs),
            b"ENTITIES" => {
                let entities = &mut self.entities;
                read_records(pairs, "ENTITIES", |record| entities.push(record))
            }
            _ => read_records(pairs, &shown(&section), drop),
        }
    }

    fn read_header(&mut self, pairs: &mut Pairs<'a>) -> Result<End, ImportError> {
        let mut variable = None;
        while let Some(pair) = pairs.next()? {
            if let Some(end) = end_of_section(&pair) {
                return Ok(end);
            }
            if pair.code == 9 {
                variable = Some(pair.text());
            } else if let Some(name) = variable {
                self.header.entry(name).or_insert(pair);
            }
        }
        Err(cut_in(pairs, "HEADER"))
    }

    fn read_blocks(&mut self, pairs: &mut Pairs<'a>) -> Result<End, ImportError> {
        /// Flags of a block whose entities are in another file.
        const EXTERNAL: i64 = 4 | 8;
        let mut records = Vec::new();
        let end = read_records(pairs, "BLOCKS", |record| records.push(record))?;
        for record in records {
            match record.kind.as_str() {
                "BLOCK" => {
                    let [x, y, _] = record.optional_point(10)?.unwrap_or_default();
                    let is_external = record.integer(70, 0)? & EXTERNAL != 0;
                    let block = Block { base: Point::new(x, y), is_external, records: Vec::new() };
                    self.blocks.push((record.text(2).unwrap_or_default(), block));
                }
                "ENDBLK" => {}
                _ => {
                    if let Some((_, block)) = self.blocks.last_mut() {
                        block.records.push(record);
                    }
                }
            }
        }
        Ok(end)
    }
}

fn end_of_section(pair: &Pair) -> Option<End> {
    match pair.code {
        0 if pair.starts("ENDSEC") => Some(End::Section),
        0 if pair.starts("EOF") => Some(End::File),
        _ => None,
    }
}

fn cut_in(pairs: &Pairs, section: &str) -> ImportError {
    pairs.place().error(format!("the file ends in the middle of section {section}"), CUT)
}

/// The records of a section. Pairs without geometry are left out: links to other entities, and data of applications.
fn read_records<'a>(
    pairs: &mut Pairs<'a>,
    section: &str,
    mut take: impl FnMut(Record<'a>),
) -> Result<End, ImportError> {
    let mut record: Option<Record<'a>> = None;
    while let Some(pair) = pairs.next()? {
        if pair.code == 0 {
            if let Some(whole) = record.take() {
                take(whole);
            }
            if let Some(end) = end_of_section(&pair) {
                return Ok(end);
            }
            record = Some(Record::new(&pair));
        } else if let Some(record) = &mut record
            && !matches!(pair.code, 100 | 102 | 310..=369 | 999..)
        {
            record.pairs.push(pair);
        }
    }
    Err(cut_in(pairs, section))
}
