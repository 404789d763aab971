//! Text → entities by number, and access to their attributes.

use super::MOST_LISTED;
use crate::import::ImportError;
use step_io::parser::{Attribute, Graph, RawEntity, Span, parse};

/// Largest size of a file. The parsed entities take some ten times its size in memory.
const MOST_BYTES: usize = 256 << 20;

/// A result with an error of this reader.
pub(super) type Result<T> = std::result::Result<T, ImportError>;

/// The header entities that the standard requires, empty.
const HEADER: [(&str, &str); 3] = [
    ("FILE_DESCRIPTION", "FILE_DESCRIPTION((''),'2;1');"),
    ("FILE_NAME", "FILE_NAME('','',(''),(''),'','','');"),
    ("FILE_SCHEMA", "FILE_SCHEMA((''));"),
];

/// The entities, and notes about repairs. Old writers leave header entities out; no geometry depends on them.
pub(super) fn parsed(bytes: &[u8]) -> Result<(Graph, Vec<String>)> {
    if bytes.len() > MOST_BYTES {
        let what = format!("the file has {} bytes; at most {MOST_BYTES} are read", bytes.len());
        return Err(ImportError::new(what, "export the part that is to be meshed alone"));
    }
    let mut text = bytes.to_vec();
    let mut notes = Vec::new();
    loop {
        let error = match parse(text.as_slice()) {
            Ok(graph) => {
                notes.extend(graph.warnings.iter().take(MOST_LISTED).map(ToString::to_string));
                return Ok((graph, notes));
            }
            Err(error) => error,
        };
        let missing = match &error {
            step_io::Error::MissingHeaderEntity { name } => HEADER.iter().find(|(known, _)| known == name),
            _ => None,
        };
        // Each of the three is added once at most.
        let (Some((name, empty)), Some(at)) = (missing, header(&text).filter(|_| notes.len() < HEADER.len())) else {
            return Err(broken(&error));
        };
        text.splice(at..at, empty.bytes());
        notes.push(format!("the header has no {name}: read as if it were empty"));
    }
}

/// The place of the header's first entity.
fn header(text: &[u8]) -> Option<usize> {
    let word = text.windows(6).position(|word| word == b"HEADER")?;
    Some(word + text[word..].iter().position(|&b| b == b';')? + 1)
}

fn broken(error: &step_io::Error) -> ImportError {
    use step_io::Error::{
        InvalidAttributePosition, Lex, MalformedFileSchema, NestingTooDeep, TooLarge, UnexpectedToken,
    };
    let span: Option<Span> = match error {
        Lex(lex) => Some(lex.span),
        UnexpectedToken { span, .. }
        | MalformedFileSchema { span }
        | InvalidAttributePosition { span, .. }
        | NestingTooDeep { span }
        | TooLarge { span } => Some(*span),
        _ => None,
    };
    let text = error.to_string();
    let what = match (&span, text.split_once(": ")) {
        (Some(_), Some((_, what))) => what.to_owned(),
        _ => text.trim_start_matches("parse error: ").to_owned(),
    };
    let mut error = ImportError::new(what, "the file is damaged or not a STEP file: export it anew");
    error.line = span.map(|span| span.line as usize);
    error.column = span.map(|span| span.column as usize);
    error
}

/// One type of an entity, with the attributes of that type in order.
#[derive(Clone, Copy)]
pub(super) struct Entity<'a> {
    /// Its number.
    pub id: u64,
    line: usize,
    /// Its type.
    pub kind: &'a str,
    /// Its attributes.
    pub attributes: &'a [Attribute],
}

impl<'a> Entity<'a> {
    /// An error about the entity.
    pub(super) fn fail(&self, what: impl std::fmt::Display) -> ImportError {
        let what = format!("{} #{} {what}", self.kind, self.id);
        ImportError::at(self.line, what, "the entity is not as ISO 10303-42 has it: export the file anew")
    }

    /// An attribute.
    pub(super) fn attribute(&self, i: usize) -> Result<&'a Attribute> {
        self.attributes.get(i).ok_or_else(|| self.fail(format!("has no attribute {}", i + 1)))
    }

    /// The number of the entity that an attribute refers to.
    pub(super) fn reference(&self, i: usize) -> Result<u64> {
        reference(self.attribute(i)?).ok_or_else(|| self.fail(format!("refers to nothing in attribute {}", i + 1)))
    }

    /// An attribute that is a list.
    pub(super) fn list(&self, i: usize) -> Result<&'a [Attribute]> {
        match self.attribute(i)? {
            Attribute::List(list) => Ok(list),
            _ => Err(self.fail(format!("has no list in attribute {}", i + 1))),
        }
    }

    /// The numbers of the entities that an attribute lists.
    pub(super) fn references(&self, i: usize) -> Result<Vec<u64>> {
        let list = self.list(i)?.iter().map(reference).collect::<Option<_>>();
        list.ok_or_else(|| self.fail(format!("lists something else than entities in attribute {}", i + 1)))
    }

    /// An attribute that is a number.
    pub(super) fn real(&self, i: usize) -> Result<f64> {
        real(self.attribute(i)?).ok_or_else(|| self.fail(format!("has no number in attribute {}", i + 1)))
    }

    /// An attribute that lists numbers.
    pub(super) fn reals(&self, i: usize) -> Result<Vec<f64>> {
        let list = self.list(i)?.iter().map(real).collect::<Option<_>>();
        list.ok_or_else(|| self.fail(format!("lists something else than numbers in attribute {}", i + 1)))
    }

    /// An attribute that is a non-negative integer.
    pub(super) fn whole(&self, i: usize) -> Result<usize> {
        let number = match self.attribute(i)? {
            Attribute::Integer(n) => usize::try_from(*n).ok(),
            _ => None,
        };
        number.ok_or_else(|| self.fail(format!("has no whole number in attribute {}", i + 1)))
    }

    /// `.T.` or `.F.`; unknown counts as true, which is its usual value.
    pub(super) fn flag(&self, i: usize) -> Result<bool> {
        match self.attribute(i)? {
            Attribute::Enum(word) => Ok(word != "F"),
            _ => Err(self.fail(format!("has no truth value in attribute {}", i + 1))),
        }
    }

    /// A name. Some writers write `NONE` where there is none.
    pub(super) fn name(&self) -> Option<&'a str> {
        match self.attributes.first() {
            Some(Attribute::String(name)) => Some(name.trim()).filter(|name| !name.is_empty() && *name != "NONE"),
            _ => None,
        }
    }
}

/// The number of the entity that an attribute refers to.
pub(super) fn reference(attribute: &Attribute) -> Option<u64> {
    match attribute {
        Attribute::EntityRef(id) => Some(*id),
        _ => None,
    }
}

/// The value of an attribute that is a number.
pub(super) fn real(attribute: &Attribute) -> Option<f64> {
    match attribute {
        Attribute::Real(value) => Some(*value),
        Attribute::Integer(value) => Some(*value as f64),
        Attribute::Typed { value, .. } => match value.as_ref() {
            Attribute::Real(value) => Some(*value),
            Attribute::Integer(value) => Some(*value as f64),
            _ => None,
        },
        _ => None,
    }
}

/// The types of an entity with their attributes: one, or the parts of a complex entity.
pub(super) fn parts(entity: &RawEntity) -> impl Iterator<Item = Entity<'_>> {
    let (id, line) = (entity.id(), entity.span().line as usize);
    let (simple, complex) = match entity {
        RawEntity::Simple { name, attributes, .. } => (Some((name, attributes)), None),
        RawEntity::Complex { parts, .. } => (None, Some(parts.iter().map(|part| (&part.name, &part.attributes)))),
    };
    let parts = simple.into_iter().chain(complex.into_iter().flatten());
    parts.map(move |(kind, attributes)| Entity { id, line, kind, attributes })
}

/// The entities of a file, by number.
#[derive(Clone, Copy)]
pub(super) struct File<'a> {
    /// The parsed entities.
    pub graph: &'a Graph,
}

impl<'a> File<'a> {
    /// An entity as the first of some types that it has.
    pub(super) fn entity(&self, id: u64, kinds: &[&str]) -> Result<Entity<'a>> {
        let found =
            self.graph.get(id).map(|raw| kinds.iter().find_map(|kind| parts(raw).find(|part| part.kind == *kind)));
        match found {
            Some(Some(entity)) => Ok(entity),
            Some(None) => Err(self.first(id)?.fail(format!("stands where {} is expected", kinds.join(" or ")))),
            None => Err(self.dangling(id)),
        }
    }

    /// An error about a number without an entity.
    pub(super) fn dangling(&self, id: u64) -> ImportError {
        ImportError::new(
            format!("#{id} is referred to and not there"),
            "the file is cut short or damaged: export it anew",
        )
    }

    /// The first type of an entity: of a complex one, no more than a word for messages.
    pub(super) fn first(&self, id: u64) -> Result<Entity<'a>> {
        self.graph.get(id).and_then(|raw| parts(raw).next()).ok_or_else(|| self.dangling(id))
    }
}
