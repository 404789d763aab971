//! The options of a run, on the command line and in a `--config` file alike; the command line overrides the file.
//!
//! Both are made from the options of a [`Request`] ([`squinch::options`]): a new field there is an option here.

use super::Halt;
use super::say;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser, ValueParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use serde::Deserialize;
use squinch::import::Format;
use squinch::options::{Described, Group, Kind};
use squinch::plane::gcdr::SnapTo;
use squinch::run::Exit;
use squinch::run::request::Request;
use squinch::size::Given;
use std::path::{Path, PathBuf};
use toml::de::{DeString, DeValue};
use toml::{Spanned, Table, Value};

/// What a run is asked for. An option that is not given keeps its default.
#[derive(Clone, Default)]
pub struct Options {
    manner: Manner,
    /// The options of the request that are given, by key.
    asked: Table,
}

/// How to run, as opposed to what to make.
#[derive(Args, Clone, Default, Deserialize)]
#[serde(rename_all = "kebab-case", default)]
struct Manner {
    /// Options from a TOML file, keys as the long options here; the command line wins
    #[arg(long, value_name = "FILE.toml", help_heading = "General")]
    #[serde(skip)]
    config: Option<PathBuf>,
    /// Threads; the result does not depend on it [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), allow_hyphen_values = true, help_heading = "General")]
    threads: Option<u64>,
    /// Format of the input, where suffix and content give none: airfoil, poly, node, outline, dxf, svg, step, smesh, off, stl
    #[arg(long, value_name = "FORMAT", help_heading = "Input")]
    input_format: Option<String>,
}

impl Args for Options {
    fn augment_args(command: Command) -> Command {
        Manner::augment_args(command).args(Request::options_in_groups().into_iter().map(argument))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Options {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let given = |option: &&Described| matches.value_source(&option.key) == Some(ValueSource::CommandLine);
        let value = |option: &Described| {
            let mut values = matches.get_many::<Value>(&option.key).into_iter().flatten().cloned();
            Some(if option.kind == Kind::Texts { Value::Array(values.collect()) } else { values.next()? })
        };
        let options = Request::options().iter().filter(given);
        let asked = options.filter_map(|option| Some((option.key.clone(), value(option)?))).collect();
        Ok(Self { manner: Manner::from_arg_matches(matches)?, asked })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// The argument of an option.
fn argument(option: &'static Described) -> Arg {
    let argument = Arg::new(&*option.key)
        .long(&*option.key)
        .value_name(&*option.value)
        .help(&*option.help)
        .help_heading(heading(option.group))
        .hide_short_help(option.rare)
        .allow_hyphen_values(!matches!(option.kind, Kind::Word(_) | Kind::Texts))
        .value_parser(parser(option));
    let argument = match option.kind {
        Kind::Texts => argument.action(ArgAction::Append),
        Kind::Number | Kind::Integer | Kind::Word(_) | Kind::Text => argument,
    };
    let argument = if option.commas { argument.value_delimiter(',') } else { argument };
    if option.switch { argument.num_args(0..=1).require_equals(true).default_missing_value("on") } else { argument }
}

fn heading(group: Group) -> &'static str {
    match group {
        Group::Engine | Group::Gcdr => "Engine",
        Group::Bounds => "Bounds",
        Group::Input => "Input",
        Group::Budget => "Budget",
        Group::Airfoils => "Airfoils",
        Group::Solids | Group::Facets => "Solids",
    }
}

/// The parser of an option: text → a value of the option's type.
fn parser(option: &'static Described) -> ValueParser {
    let checked = |value: Value| {
        // The content of a file is read later, with the file.
        if option.file { Ok(value) } else { check(option, value) }
    };
    match &option.kind {
        Kind::Number => ValueParser::new(|text: &str| text.parse().map(Value::Float)),
        Kind::Integer => ValueParser::new(move |text: &str| {
            let number: u64 = text.parse().map_err(|e: std::num::ParseIntError| e.to_string())?;
            checked(Value::Integer(i64::try_from(number).map_err(|e| e.to_string())?))
        }),
        Kind::Word(words) => {
            let word = |(word, help): &'static (String, Option<String>)| match help {
                Some(help) => PossibleValue::new(&**word).help(&**help),
                None => PossibleValue::new(&**word),
            };
            PossibleValuesParser::new(words.iter().map(word)).map(Value::String).into()
        }
        Kind::Text | Kind::Texts => ValueParser::new(move |text: &str| checked(Value::String(text.to_owned()))),
    }
}

/// A value of an option, if the request accepts it.
fn check(option: &Described, value: Value) -> Result<Value, String> {
    let whole = if option.kind == Kind::Texts { Value::Array(vec![value.clone()]) } else { value.clone() };
    let asked: Table = [(option.key.clone(), whole)].into_iter().collect();
    Request::deserialize(asked).map_err(|e| e.message().to_owned())?;
    Ok(value)
}

/// Resolved options: the request, and the format of the input.
pub struct Resolved {
    /// The request.
    pub request: Request,
    /// The format of the input, if given.
    pub input_format: Option<Format>,
}

impl Options {
    /// Defaults, overridden by the config file, overridden by the command line. Checks them and sets the number of
    /// threads.
    pub fn resolve(&self) -> Result<Resolved, Halt> {
        self.resolve_over("")
    }

    /// As [`Options::resolve`], with a recorded request (TOML) between the defaults and the config file.
    pub fn resolve_over(&self, recorded: &str) -> Result<Resolved, Halt> {
        let mut asked: Table = recorded.parse().map_err(usage)?;
        let mut manner = self.manner.clone();
        if let Some(path) = &self.manner.config {
            let config = read_config(path)?;
            manner.threads = manner.threads.or(config.manner.threads);
            manner.input_format = manner.input_format.or(config.manner.input_format);
            asked.extend(config.asked);
        }
        asked.extend(self.asked.clone());
        read_sizes(&mut asked)?;
        read_snap(&mut asked)?;
        let request: Request = Value::Table(asked).try_into().map_err(usage)?;
        request.validate().map_err(usage)?;
        if let Some(threads) = manner.threads {
            // More threads than cores cost their stacks and gain nothing. The bytes of the result do not depend on the
            // number.
            let cores = std::thread::available_parallelism().map_or(1, usize::from);
            squinch::threads::set_count(usize::try_from(threads).unwrap_or(usize::MAX).min(cores));
        }
        let input_format = manner.input_format.as_deref().map(input_format).transpose()?;
        Ok(Resolved { request, input_format })
    }
}

/// Replaces the name of a file of sizes by its content, so that a case holds the sizes.
fn read_sizes(asked: &mut Table) -> Result<(), Halt> {
    let Some(Value::String(given)) = asked.get("size") else { return Ok(()) };
    let wrong = |e: String| Halt::Usage(format!("--size {given}: {e}"));
    let sizes: Given = if Path::new(given).is_file() {
        let text = std::fs::read_to_string(given).map_err(|e| wrong(e.to_string()))?;
        Given::read_samples(&text).map_err(wrong)?
    } else {
        given.parse().map_err(wrong)?
    };
    asked.insert("size".into(), Value::try_from(sizes).map_err(usage)?);
    Ok(())
}

/// Replaces the name of a file of places by its content.
fn read_snap(asked: &mut Table) -> Result<(), Halt> {
    let Some(Value::String(given)) = asked.get("snap") else { return Ok(()) };
    let wrong = |e: String| Halt::Usage(format!("--snap {given}: {e}"));
    let snap = match given.parse() {
        Ok(pitch) => SnapTo::Pitch(pitch),
        Err(_) => {
            let text = std::fs::read_to_string(given)
                .map_err(|e| wrong(format!("neither a pitch nor a file that can be read: {e}")))?;
            SnapTo::read_places(&text).map_err(wrong)?
        }
    };
    asked.insert("snap".into(), Value::try_from(snap).map_err(usage)?);
    Ok(())
}

fn usage(error: impl std::fmt::Display) -> Halt {
    Halt::Usage(error.to_string().trim_end().to_owned())
}

fn input_format(name: &str) -> Result<Format, Halt> {
    Format::from_name(name).ok_or_else(|| {
        let names: Vec<_> = Format::ALL.iter().map(|f| f.name()).collect();
        Halt::Usage(format!("--input-format {name}: one of {}", names.join(", ")))
    })
}

/// The options of a file. An error points to its place.
fn read_config(path: &Path) -> Result<Options, Halt> {
    let shown = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|e| Halt::Usage(format!("--config {shown}: {e}")))?;
    let pointing = |what: &str, span: std::ops::Range<usize>| {
        say::pointing(what, None, &shown, &text, span);
        Halt::Said(Exit::Usage)
    };
    let read = || -> Result<Options, (String, std::ops::Range<usize>)> {
        let wrong = |e: toml::de::Error| (e.message().to_owned(), e.span().unwrap_or_default());
        let mut options = Options::default();
        for (key, value) in toml::de::DeTable::parse(&text).map_err(wrong)?.into_inner() {
            options.take(key, value)?;
        }
        Ok(options)
    };
    read().map_err(|(what, span)| pointing(&what, span))
}

impl Options {
    /// Reads an entry of a file. The error has its place.
    fn take(
        &mut self,
        key: Spanned<DeString>,
        value: Spanned<DeValue>,
    ) -> Result<(), (String, std::ops::Range<usize>)> {
        let (place, key_place) = (value.span(), key.span());
        let key = key.into_inner().into_owned();
        let value = Value::deserialize(toml::de::ValueDeserializer::from(value)).expect("a value is one");
        let entry: Table = [(key.clone(), value.clone())].into_iter().collect();
        let wrong = |e: toml::de::Error| (e.message().to_owned(), place.clone());
        match key.as_str() {
            "threads" => self.manner.threads = Manner::deserialize(entry).map_err(wrong)?.threads,
            "input-format" => self.manner.input_format = Manner::deserialize(entry).map_err(wrong)?.input_format,
            _ => {
                let option = Request::options().iter().find(|option| option.key == key);
                let option = option.ok_or_else(|| (unknown(&key), key_place))?;
                let is_text = option.file && value.is_str();
                if !is_text {
                    Request::deserialize(entry).map_err(wrong)?;
                }
                self.asked.insert(key, value);
            }
        }
        Ok(())
    }
}

/// The message about an unknown option, with the most similar one.
fn unknown(key: &str) -> String {
    let likeness = |option: &&Described| strsim::jaro_winkler(&option.key, key);
    let near = Request::options().iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    near.map_or_else(String::new, |near| format!("unknown option `{key}`; the nearest is `{}`", near.key))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{CommandFactory, Parser};
    use squinch::options::Switch;
    use squinch::run::request::{FillChoice, MaxTurning};
    use squinch::size::ChordError;
    use std::collections::BTreeSet;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        options: Options,
    }

    #[test]
    fn every_option_of_a_request_can_be_given_and_nothing_else() {
        let command = Line::command();
        let given: BTreeSet<&str> = command.get_arguments().filter_map(Arg::get_long).collect();
        let manner = ["config", "threads", "input-format"];
        let options = Request::options().iter().map(|option| option.key.as_str());
        assert_eq!(given, options.chain(manner).collect());
        // A key of a request is an option, and nothing else.
        let written = toml::Table::try_from(Request::default()).unwrap();
        assert!(written.keys().all(|key| given.contains(key.as_str())), "{written:?}");
    }

    #[test]
    fn what_is_no_option_is_told_with_the_nearest_one() {
        assert_eq!(unknown("max-trning"), "unknown option `max-trning`; the nearest is `max-turning`");
        let line = Line::parse_from(["x", "--size", "x +"]);
        let Err(Halt::Usage(why)) = line.options.resolve() else { panic!("no expression") };
        assert!(why.starts_with("--size x +: "), "{why}");
    }

    #[test]
    fn the_report_tells_every_option() {
        let report = squinch::run::report::RequestReport::new(&Request::default());
        let told = serde_json::to_value(&report).unwrap();
        for option in Request::options() {
            // A drawing's report has none of the options of tetrahedra.
            let has = option.group != Group::Facets;
            assert_eq!(told.get(&option.report).is_some(), has, "{} as {}", option.key, option.report);
        }
        let of_solid = serde_json::to_value(squinch::run::report::RequestReport::of_solid(&Request::default(), None));
        let of_solid = of_solid.unwrap();
        assert!(Request::options().iter().all(|option| of_solid.get(&option.report).is_some()));
    }

    #[test]
    fn what_is_given_reaches_the_request() {
        let line = Line::parse_from([
            "x",
            "--min-angle",
            "15",
            "--max-turning",
            "auto",
            "--size-of",
            "a=1",
            "--size-of",
            "b=2",
            "--incidence",
            "-3",
            "--fill-rule",
            "evenodd",
            "--corner-arcs",
            "off",
            "--max-vertices",
            "1000",
            "--input-format",
            "poly",
            "--chord-error",
            "1%",
        ]);
        let Ok(Resolved { request, input_format }) = line.options.resolve() else { panic!("refused") };
        assert_eq!(input_format, Some(Format::Poly));
        assert_eq!(request.min_angle, 15.0);
        assert_eq!(request.max_turning, MaxTurning::Auto);
        assert_eq!(request.limits.size_of.len(), 2);
        assert_eq!(request.airfoil.incidence_deg, -3.0);
        assert_eq!(request.fill_rule, FillChoice::EvenOdd);
        assert_eq!(request.corner_arcs, Switch::Off);
        assert_eq!(request.max_vertices, 1000);
        assert_eq!(request.limits.chord_error, Some(ChordError::Percent(1.0)));
        assert_eq!(request.rules, Request::default().rules);
    }
}
