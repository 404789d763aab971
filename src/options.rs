//! Options: each is written once, as a field of the options struct of its module.
//!
//! The field's name in kebab-case is its key on the command line, in a `--config` file and in a case file. Its doc
//! comment is its help, the default of its struct is its default, and `#[schemars(extend(…))]` adds what the type does
//! not express:
//!
//! | attribute | says |
//! |---|---|
//! | `group` | the heading under which it stands, a [`Group`] |
//! | `value` | what stands for its value in the help: `LENGTH` |
//! | `report` | its name in the report, where that has a unit: `timeout_s` |
//! | `rare` | that only the long help has it |
//! | `switch` | that `on` may be left out |
//! | `file` | that the name of a file may stand for its content |
//! | `commas` | that several values may stand between commas |
//!
//! [`described`] lists the options of a struct. The command line, the report and its schema are made of that list.

use schemars::{JsonSchema, generate::SchemaSettings};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fmt;

/// The headings of options, in the order of the help.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Group {
    /// The engine, and the rules of corner lopping.
    Engine,
    /// Bounds on angles, sizes and the distance from the curves.
    Bounds,
    /// Options on reading, healing and naming a drawing.
    Input,
    /// Limits that end refinement early: vertices and seconds.
    Budget,
    /// Only for airfoil coordinates.
    Airfoils,
    /// Only for a face of a solid (STEP).
    Solids,
    /// Only for solids that are meshed by tetrahedra.
    Facets,
    /// Only for the engine of generalized constrained refinement.
    Gcdr,
}

/// An option, as described by its field.
#[derive(Clone, Debug, PartialEq)]
pub struct Described {
    /// Its key: the name in kebab-case, without leading dashes: `min-angle`.
    pub key: String,
    /// The heading under which the help lists it.
    pub group: Group,
    /// The placeholder of its value in the help: `LENGTH`.
    pub value: String,
    /// A sentence without its full stop, with the default if there is one.
    pub help: String,
    /// Name in the report, in snake case, with the unit where it has one: `timeout_s`.
    pub report: String,
    /// Whether only the long help lists it.
    pub rare: bool,
    /// Whether the value `on` may be left out.
    pub switch: bool,
    /// Whether the name of a file may stand for its content.
    pub file: bool,
    /// Whether several values may stand between commas.
    pub commas: bool,
    /// The kind of its values.
    pub kind: Kind,
}

/// The kind of an option's value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number, whole or not.
    Number,
    /// A whole number, not negative.
    Integer,
    /// One of some words, each with its meaning.
    Word(Vec<(String, Option<String>)>),
    /// A text that the option's own type parses: a number with a sign, a word or a number, a pair.
    Text,
    /// Any number of texts.
    Texts,
}

/// The options of a struct, including those of the structs that it flattens, in the order of its fields.
pub fn described<T: JsonSchema>() -> Vec<Described> {
    let inline = |settings: &mut SchemaSettings| settings.inline_subschemas = true;
    let settings = SchemaSettings::draft2020_12().with(inline);
    let schema = settings.into_generator().into_root_schema_for::<T>().to_value();
    let fields = schema["properties"].as_object().expect("options are a struct");
    fields.iter().map(|(key, field)| Described::new(key, field)).collect()
}

impl Described {
    /// An option, from the schema of its field.
    fn new(key: &str, field: &Value) -> Self {
        let text = |attribute: &str| field[attribute].as_str().map(str::to_owned);
        let needed = |attribute: &str| text(attribute).unwrap_or_else(|| panic!("the option {key} has no {attribute}"));
        let is = |attribute: &str| field[attribute] == Value::Bool(true);
        let comment = needed("description");
        let default = match &field["default"] {
            Value::String(word) => format!(" [default: {word}]"),
            Value::Number(number) => format!(" [default: {}]", plain(number)),
            Value::Null | Value::Bool(_) | Value::Array(_) | Value::Object(_) => String::new(),
        };
        let told = comment.contains("[default");
        Self {
            key: key.into(),
            group: Group::deserialize(&field["group"]).unwrap_or_else(|e| panic!("the group of the option {key}: {e}")),
            value: needed("value"),
            help: sentence(&comment) + if told { "" } else { &default },
            report: text("report").unwrap_or_else(|| key.replace('-', "_")),
            rare: is("rare"),
            switch: is("switch"),
            file: is("file"),
            commas: is("commas"),
            kind: Kind::of(field),
        }
    }
}

/// Turns a doc comment into a line of help.
fn sentence(comment: &str) -> String {
    comment.replace('\n', " ").trim_end_matches('.').to_owned()
}

/// A number as people write it: 20 instead of 20.0.
fn plain(number: &serde_json::Number) -> String {
    number.as_f64().map_or_else(|| number.to_string(), |value| value.to_string())
}

impl Kind {
    fn of(field: &Value) -> Self {
        if let Some(words) = words(field) {
            return Self::Word(words);
        }
        let is = |kind: &str| match &field["type"] {
            Value::Array(kinds) => kinds.iter().any(|k| k == kind),
            only => only == kind,
        };
        let plain = [("array", Self::Texts), ("integer", Self::Integer), ("number", Self::Number)];
        plain.into_iter().find(|(kind, _)| is(kind)).map_or(Self::Text, |(_, kind)| kind)
    }
}

/// The words of a choice, from the schema of its enum: in their order if each has a doc comment, else those without one
/// first.
fn words(field: &Value) -> Option<Vec<(String, Option<String>)>> {
    let word = |choice: &Value, help: Option<String>| {
        let list = choice["enum"].as_array().into_iter().flatten();
        list.chain(choice.get("const")).filter_map(Value::as_str).map(|w| (w.to_owned(), help.clone())).collect()
    };
    let choices: Vec<(String, Option<String>)> = match field["oneOf"].as_array() {
        Some(choices) => {
            let documented = |choice: &Value| -> Vec<_> { word(choice, choice["description"].as_str().map(sentence)) };
            choices.iter().flat_map(documented).collect()
        }
        // Here the description belongs to the option, not to the words.
        None => word(field, None),
    };
    (!choices.is_empty()).then_some(choices)
}

/// On or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Switch {
    /// Turned on.
    On,
    /// Turned off.
    Off,
}

impl Switch {
    /// Whether it is `On`.
    pub fn is_on(self) -> bool {
        self == Self::On
    }
}

/// An option out of its bounds.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("--{option} {value}: {why}")]
pub struct OutOfBounds {
    /// The option's key, without leading dashes.
    pub option: &'static str,
    /// The refused value, as text.
    pub value: String,
    /// The bounds, as a phrase that says what is needed.
    pub why: &'static str,
}

impl OutOfBounds {
    /// Refuses the value of an option unless its bounds hold.
    ///
    /// # Errors
    /// With the option, its value and `why`.
    pub fn unless(holds: bool, option: &'static str, value: &dyn fmt::Display, why: &'static str) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self { option, value: value.to_string(), why }) }
    }

    /// Refuses given numbers that are not positive and finite.
    ///
    /// # Errors
    /// With the first such option.
    pub fn unless_positive(numbers: &[(&'static str, Option<f64>)]) -> Result<(), Self> {
        let positive = |(option, value): &(&'static str, Option<f64>)| {
            let value = value.unwrap_or(1.0);
            Self::unless(value.is_finite() && value > 0.0, option, &value, "a positive number is needed")
        };
        numbers.iter().try_for_each(positive)
    }
}

/// The form of mixed options in a file: a number, or a word or a number with a sign behind it.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Scalar {
    /// A plain number.
    Number(f64),
    /// A word, or a number with a sign behind it: `auto`, `2%`.
    Text(String),
}

impl From<String> for Scalar {
    fn from(text: String) -> Self {
        text.parse().map_or(Self::Text(text), Self::Number)
    }
}

/// Implements the conversions from and to a [`Scalar`] for types with `FromStr` and `Display`, for `#[serde(try_from,
/// into)]`.
macro_rules! scalar {
    ($($name:ident),*) => {$(
        impl TryFrom<$crate::options::Scalar> for $name {
            type Error = String;
            fn try_from(value: $crate::options::Scalar) -> Result<Self, String> {
                match value {
                    $crate::options::Scalar::Number(number) => number.to_string().parse(),
                    $crate::options::Scalar::Text(text) => text.parse(),
                }
            }
        }
        impl From<$name> for $crate::options::Scalar {
            fn from(value: $name) -> Self {
                value.to_string().into()
            }
        }
    )*};
}
pub(crate) use scalar;

/// Parses a number, for the types of options.
///
/// # Errors
/// A sentence with the text.
pub fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| format!("'{text}' is not a number"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The options of two modules, gathered.
    #[derive(Serialize, Deserialize, JsonSchema)]
    #[serde(rename_all = "kebab-case", default)]
    struct All {
        /// Who works
        #[schemars(extend("group" = "engine", "value" = "WHO"))]
        who: Who,
        #[serde(flatten)]
        room: Room,
        /// Seconds it may take
        #[schemars(extend("group" = "budget", "value" = "S", "report" = "wait_s"))]
        wait: Option<f64>,
    }

    #[derive(Serialize, Deserialize, JsonSchema)]
    #[serde(rename_all = "kebab-case", default)]
    struct Room {
        /// How far
        /// [default there: 3]
        #[schemars(extend("group" = "bounds", "value" = "LENGTH", "rare" = true))]
        far_off: f64,
        /// Of which names
        #[schemars(extend("group" = "bounds", "value" = "A,B", "commas" = true))]
        of: Vec<String>,
    }

    #[derive(Default, Serialize, Deserialize, JsonSchema)]
    #[serde(rename_all = "lowercase")]
    enum Who {
        /// The first
        #[default]
        One,
        /// Another.
        Other,
    }

    impl Default for All {
        fn default() -> Self {
            Self { who: Who::One, room: Room::default(), wait: None }
        }
    }

    impl Default for Room {
        fn default() -> Self {
            Self { far_off: 3.0, of: Vec::new() }
        }
    }

    #[test]
    fn options_are_described_by_their_fields() {
        let options = described::<All>();
        let keys: Vec<&str> = options.iter().map(|o| o.key.as_str()).collect();
        assert_eq!(keys, ["who", "far-off", "of", "wait"]);
        assert_eq!(options[0].help, "Who works [default: one]");
        assert_eq!(
            options[0].kind,
            Kind::Word(vec![("one".into(), Some("The first".into())), ("other".into(), Some("Another".into()))])
        );
        assert_eq!((options[1].kind.clone(), options[1].rare), (Kind::Number, true));
        assert_eq!(options[1].help, "How far [default there: 3]", "told already");
        assert_eq!((options[2].kind.clone(), options[2].commas), (Kind::Texts, true));
        assert_eq!((options[3].kind.clone(), options[3].report.as_str()), (Kind::Number, "wait_s"));
        assert_eq!(options[3].group, Group::Budget);
    }

    #[test]
    fn bounds_name_the_option_and_the_value() {
        let refused = OutOfBounds::unless_positive(&[("grade", None), ("scale", Some(2.0)), ("chord", Some(-1.0))]);
        assert_eq!(refused.unwrap_err().to_string(), "--chord -1: a positive number is needed");
    }
}
