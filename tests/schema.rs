//! The schemas that `squinch schema` prints fit what the program writes and reads.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn squinch(folder: &Path, arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_squinch")).current_dir(folder).args(arguments).output();
    String::from_utf8(output.expect("squinch starts").stdout).expect("UTF-8")
}

fn bench(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("schema-{name}"));
    let _ = fs::remove_dir_all(&folder); // left by an earlier run, if at all
    fs::create_dir_all(&folder).expect("a folder to work in");
    folder
}

fn schema(which: &str) -> Value {
    serde_json::from_str(&squinch(Path::new("."), &["schema", which])).expect("a schema is JSON")
}

/// Where a value does not fit a schema: of what schemas of ours use, and every key must be known.
fn misfits(root: &Value, schema: &Value, value: &Value, at: &str, found: &mut Vec<String>) {
    if let Some(target) = schema["$ref"].as_str() {
        let target = root.pointer(target.trim_start_matches('#')).expect("a definition");
        return misfits(root, target, value, at, found);
    }
    for word in ["anyOf", "oneOf"] {
        if let Some(choices) = schema[word].as_array() {
            let fits = |choice: &Value| {
                let mut none = Vec::new();
                misfits(root, choice, value, at, &mut none);
                none.is_empty()
            };
            if !choices.iter().any(fits) {
                found.push(format!("{at}: {value} is none of {word}"));
            }
        }
    }
    if schema.get("const").is_some_and(|only| only != value)
        || schema["enum"].as_array().is_some_and(|choices| !choices.contains(value))
    {
        found.push(format!("{at}: {value} is none of the words"));
    }
    let kind = match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(n) if n.is_f64() => "number",
        Value::Number(_) => "integer",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    };
    let named = |word: &Value| word == kind || (kind == "integer" && word == "number");
    let right = match &schema["type"] {
        Value::Null => true,
        Value::Array(kinds) => kinds.iter().any(named),
        word => named(word),
    };
    if !right {
        found.push(format!("{at}: {value} is no {}", schema["type"]));
    }
    if let Some(items) = value.as_array() {
        for (i, item) in items.iter().enumerate().filter(|_| schema.get("items").is_some()) {
            misfits(root, &schema["items"], item, &format!("{at}/{i}"), found);
        }
    }
    if let (Some(object), Some(_)) = (value.as_object(), schema.get("type")) {
        let required = schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
        required.filter(|key| !object.contains_key(*key)).for_each(|key| found.push(format!("{at}: no {key}")));
        for (key, value) in object {
            let at = format!("{at}/{key}");
            match (schema["properties"].get(key), schema.get("additionalProperties")) {
                (Some(property), _) => misfits(root, property, value, &at, found),
                (None, Some(more)) if more.is_object() => misfits(root, more, value, &at, found),
                _ => found.push(format!("{at} is not in the schema")),
            }
        }
    }
}

fn fits(schema: &Value, value: &Value) {
    let mut found = Vec::new();
    misfits(schema, schema, value, "", &mut found);
    assert!(found.is_empty(), "{found:#?}");
}

const OPEN: &str = r#"{ "squinch": 1, "curves": [{ "name": "a", "line": [[0, 0], [1, 0]] }] }"#;

#[test]
fn reports_fit_their_schema() {
    let (folder, schema) = (bench("report"), schema("report"));
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples");
    fs::write(folder.join("open.json"), OPEN).expect("written");
    fs::write(folder.join("bad.json"), "{ \"squinch\": 1, \"curves\": 7 }").expect("written");
    let sample = |name: &str| samples.join(name).display().to_string();
    let [plate, logo, wedge] = [sample("plate.json"), sample("logo.svg"), sample("tangent_curves.json")];
    for (k, more) in [
        vec![plate.as_str(), "--order", "2", "--max-edge", "20"],
        vec![plate.as_str(), "--max-vertices", "200"],
        vec![logo.as_str(), "--engine", "gcdr", "--tolerance", "0"],
        vec![wedge.as_str()],
        vec!["open.json"],
        vec!["bad.json"],
    ]
    .into_iter()
    .enumerate()
    {
        let report = format!("{k}.json");
        squinch(&folder, &[&["mesh", "-o", "x.vtu", "--quiet", "--report", &report], more.as_slice()].concat());
        let text = fs::read_to_string(folder.join(&report)).expect("a report");
        fits(&schema, &serde_json::from_str(&text).expect("JSON"));
    }
}

#[test]
fn lines_of_a_batch_fit_their_schema() {
    let (folder, schema) = (bench("batch"), schema("batch"));
    fs::write(folder.join("open.json"), OPEN).expect("written");
    fs::write(folder.join("square.poly"), "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n")
        .expect("written");
    let lines = squinch(&folder, &["batch", "square.poly", "open.json", "--out-dir", "out", "--format", "vtu", "-q"]);
    assert_eq!(lines.lines().count(), 2);
    lines.lines().for_each(|line| fits(&schema, &serde_json::from_str(line).expect("JSON")));
}

#[test]
fn a_schema_that_lacks_a_key_is_noticed() {
    let mut schema = schema("batch");
    schema["properties"].as_object_mut().expect("properties").remove("exit");
    let line = serde_json::json!({ "input": "x", "exit": 0 });
    let mut found = Vec::new();
    misfits(&schema, &schema, &line, "", &mut found);
    assert!(found.contains(&"/exit is not in the schema".into()) && found.contains(&": no kept".into()), "{found:?}");
}

#[test]
fn all_schemas_come_under_their_names() {
    let all: Value = serde_json::from_str(&squinch(&bench("all"), &["schema"])).expect("JSON");
    let names: Vec<_> = all.as_object().expect("an object").keys().collect();
    assert_eq!(names, ["outline", "report", "batch"]);
    for name in names {
        assert_eq!(all[name], schema(name));
        assert!(all[name]["$schema"].is_string(), "{name}");
    }
}
