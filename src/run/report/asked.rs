//! The options of a run in its report: each option of the request under its name there, in the order of the groups.
//!
//! An option of another engine, or of a stage that the run did not reach, is `null`.

use crate::domain::{Domain, Drawing};
use crate::options::{Described, Group, Kind};
use crate::run::request::{Engine, Request};
use crate::size::Sizing;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::borrow::Cow;

/// The first options: the unit of all lengths (`null`: the unknown unit of the file), the engine, and the two angles of
/// its theory.
const FIRST: [&str; 4] = ["length_unit", "engine", "angle_min_deg", "tau_rad"];

/// Every option as used. Lengths in `length_unit`, areas in its square.
#[derive(Clone, Debug, Serialize)]
#[serde(transparent)]
pub struct RequestReport(Map<String, Value>);

impl RequestReport {
    /// The options as asked, but for those of solids.
    pub fn new(request: &Request) -> Self {
        Self::of(request, |group| group != Group::Facets)
    }

    /// The options of a solid as asked, in its unit; those of drawings are `null`.
    pub fn of_solid(request: &Request, unit: Option<&str>) -> Self {
        let mut told = Self::of(request, |_| true);
        let of_drawings = |group| !matches!(group, Group::Facets | Group::Budget);
        for option in Request::options().iter().filter(|option| of_drawings(option.group)) {
            told.0.insert(option.report.clone(), Value::Null);
        }
        told.0.extend(FIRST.map(|name| (name.to_owned(), Value::Null)));
        told.0.insert("length_unit".into(), json!(unit));
        told
    }

    fn of(request: &Request, uses: impl Fn(Group) -> bool) -> Self {
        let asked = serde_json::to_value(request).expect("options are words, numbers and lists of them");
        let mut told: Map<String, Value> = FIRST.map(|name| (name.to_owned(), Value::Null)).into_iter().collect();
        for option in Request::options_in_groups().into_iter().filter(|option| uses(option.group)) {
            told.insert(option.report.clone(), tell(option, request, &asked[&option.key]));
        }
        Self(told)
    }

    /// Sets the options whose value depends on the drawing and its domain.
    pub fn note_use(&mut self, drawing: &Drawing, domain: &Domain, tau_rad: f64, sizing: &Sizing) {
        let unit = drawing.unit.as_ref().map(|(unit, _)| unit);
        let used = [
            ("length_unit", json!(unit)),
            ("tolerance", json!(domain.tolerance())),
            ("tau_rad", json!(tau_rad)),
            ("chord_error", json!(sizing.chord_error)),
        ];
        self.0.extend(used.map(|(name, value)| (name.to_owned(), value)));
    }

    /// An option by its name in the report; `null` where there is none.
    pub fn get(&self, name: &str) -> &Value {
        self.0.get(name).unwrap_or(&Value::Null)
    }
}

/// An option as reported. `asked` is its value in the request's file form, `null` where that has none.
fn tell(option: &Described, request: &Request, asked: &Value) -> Value {
    if option.group == Group::Gcdr && request.engine != Engine::Gcdr {
        return Value::Null;
    }
    match option.key.as_str() {
        // Known only after their use.
        "tolerance" | "chord-error" => Value::Null,
        "edge-turning" => json!(request.limits.edge_turning.deg()),
        "size" => json!(request.limits.size.as_ref().map(ToString::to_string)),
        "size-of" => request.limits.size_of.iter().map(|s| (s.name.clone(), json!(s.edge))).collect(),
        "scale" => json!(request.scale.unwrap_or(1.0)),
        "delta2" => json!(request.regions().delta2),
        "delta1" => json!(request.regions().delta1),
        "mu" => json!(request.regions().mu),
        "snap" => json!(request.gcdr.snap.as_ref().map(ToString::to_string)),
        _ => match (&option.kind, asked) {
            (Kind::Word(words), word) if is_switch(words) => json!(word == "on"),
            (Kind::Text, Value::Number(number)) => json!(number.as_f64().map(|n| n.to_string())),
            (Kind::Texts, Value::Null) => json!([]),
            (_, asked) => asked.clone(),
        },
    }
}

fn is_switch(words: &[(String, Option<String>)]) -> bool {
    matches!(words, [(on, _), (off, _)] if on == "on" && off == "off")
}

/// The schema of an option as reported.
fn schema(option: &Described) -> Value {
    let kind = match (option.key.as_str(), &option.kind) {
        ("size-of", _) => json!({ "type": "object", "additionalProperties": { "type": "number" } }),
        ("edge-turning" | "chord-error", _) | (_, Kind::Number) => json!({ "type": ["number", "null"] }),
        (_, Kind::Integer) => json!({ "type": ["integer", "null"] }),
        (_, Kind::Word(words)) if is_switch(words) => json!({ "type": ["boolean", "null"] }),
        (_, Kind::Texts) => json!({ "type": "array", "items": { "type": "string" } }),
        (_, Kind::Word(_) | Kind::Text) => json!({ "type": ["string", "null"] }),
    };
    let Value::Object(mut kind) = kind else { unreachable!("each is an object") };
    kind.insert("description".into(), json!(option.help));
    Value::Object(kind)
}

impl JsonSchema for RequestReport {
    fn schema_name() -> Cow<'static, str> {
        "RequestReport".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let first = |name: &str| {
            let (kind, what) = match name {
                "length_unit" => ("string", "Unit of all lengths; null: the file's own, which is not known"),
                _ => ("number", "As used, also where auto was asked for; null where the run did not come so far"),
            };
            (name.to_owned(), json!({ "type": [kind, "null"], "description": what }))
        };
        let mut properties: Map<String, Value> = FIRST.into_iter().map(first).collect();
        properties
            .extend(Request::options_in_groups().into_iter().map(|option| (option.report.clone(), schema(option))));
        let of_solids = Request::options().iter().filter(|option| option.group == Group::Facets);
        let of_solids: Vec<&String> = of_solids.map(|option| &option.report).collect();
        let required: Vec<&String> = properties.keys().filter(|name| !of_solids.contains(name)).collect();
        json_schema!({
            "description": "Every option as used. Lengths in `length_unit`, areas in its square",
            "type": "object",
            "required": required,
            "properties": properties,
        })
    }
}
