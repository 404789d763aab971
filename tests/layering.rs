//! Who may import whom: the table of `src/README.md`, kept.
//!
//! The sources are read as text: every `crate::…` path outside comments must lead to a module that its own module may know.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Ground that every module stands on.
const GROUND: &[&str] = &["ids", "geometry", "canvas", "trace", "watch"];

/// Module, and what it may import besides the ground. `*`: everything.
const TABLE: &[(&str, &[&str])] = &[
    ("ids", &[]),
    ("geometry", &[]),
    ("canvas", &[]),
    ("trace", &[]),
    ("watch", &[]),
    ("curve", &[]),
    ("domain", &["curve"]),
    ("size", &["curve", "domain"]),
    ("refine", &[]),
    ("mesh", &["curve", "domain"]),
    ("promise", &["size"]),
    ("verify", &["curve", "domain", "size", "mesh", "promise"]),
    ("plane", &["curve", "domain", "size", "refine", "mesh", "promise"]),
    ("import", &["curve", "domain"]),
    ("export", &["curve", "domain", "mesh"]),
    ("cad", &["curve", "domain"]),
    ("generate", &["curve", "domain"]),
    ("lib", &["*"]),
    ("main", &["*"]),
    ("cli", &["*"]),
    ("case", &["*"]),
    ("reduce", &["*"]),
    ("request", &["*"]),
    ("report", &["*"]),
    ("pipeline", &["*"]),
];

/// Files (or folders, by their slash) that may import more than the rest of their module.
const EXCEPTIONS: &[(&str, &[&str])] = &[
    // Reads back mesh files, not drawings.
    ("import/mesh/", &["mesh"]),
    // Knows the format; what a face of a solid is, any door of a solid shares.
    ("import/step.rs", &["cad"]),
];

#[test]
fn every_module_keeps_to_the_table() {
    let mut broken = Vec::new();
    for file in sources() {
        let text = fs::read_to_string(source_root().join(&file)).expect("a source is readable");
        for target in imported(&text) {
            if !may_import(&file, &target) {
                broken.push(format!("{file} imports crate::{target}"));
            }
        }
    }
    assert!(broken.is_empty(), "against the table in src/README.md:\n{}", broken.join("\n"));
}

#[test]
fn every_module_stands_in_the_table() {
    let known: BTreeSet<&str> = TABLE.iter().map(|(module, _)| *module).collect();
    let missing: BTreeSet<String> =
        sources().iter().map(|file| module_of(file)).filter(|module| !known.contains(module.as_str())).collect();
    assert!(missing.is_empty(), "not in the table: {missing:?}");
}

#[test]
fn the_reader_of_paths_finds_them_all() {
    let text = "
        use crate::plane::lopping;
        use crate::{ids::CurveId, mesh::{Mesh, quality}, size};
        // use crate::nothing;
        /// [`crate::nothing`]
        fn f() { crate::curve::g(crate::domain::h()) }
        use super::super::export;
    ";
    let found: Vec<String> = imported(text).into_iter().collect();
    assert_eq!(found, ["curve", "domain", "export", "ids", "mesh", "plane", "size"]);
    assert!(may_import("plane/lopping.rs", "mesh"));
    assert!(may_import("import/mesh/vtu.rs", "mesh"));
    assert!(!may_import("import/poly.rs", "mesh"));
    assert!(!may_import("verify/mod.rs", "plane"), "the judge must not know the kernels");
    assert!(may_import("cli/mesh.rs", "plane"));
}

fn source_root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Every Rust source, relative to `src`, with `/`, sorted.
fn sources() -> Vec<String> {
    let root = source_root();
    let mut waiting = vec![root.clone()];
    let mut files = Vec::new();
    while let Some(folder) = waiting.pop() {
        for entry in fs::read_dir(&folder).expect("a source folder is readable") {
            let path = entry.expect("a folder entry is readable").path();
            if path.is_dir() {
                waiting.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let relative = path.strip_prefix(&root).expect("below src");
                let parts: Vec<_> = relative.iter().map(|p| p.to_string_lossy().into_owned()).collect();
                files.push(parts.join("/"));
            }
        }
    }
    files.sort();
    files
}

/// The top module that a file belongs to.
fn module_of(file: &str) -> String {
    file.split('/').next().unwrap_or(file).trim_end_matches(".rs").to_owned()
}

fn may_import(file: &str, target: &str) -> bool {
    let module = module_of(file);
    let allowed = |list: &[&str]| list.contains(&target) || list.contains(&"*");
    let row = TABLE.iter().find(|(name, _)| *name == module);
    let exception = EXCEPTIONS.iter().find(|(name, _)| *name == file || name.ends_with('/') && file.starts_with(name));
    target == module
        || GROUND.contains(&target)
        || row.is_some_and(|(_, list)| allowed(list))
        || exception.is_some_and(|(_, list)| allowed(list))
}

/// The top modules that a source names by `crate::`, or by climbing out of its own module.
fn imported(text: &str) -> BTreeSet<String> {
    let code: String = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .fold(String::new(), |all, line| all + line + "\n");
    let mut found = BTreeSet::new();
    for (at, _) in code.match_indices("crate::") {
        heads(&code[at + "crate::".len()..], &mut found);
    }
    let known: BTreeSet<&str> = TABLE.iter().map(|(module, _)| *module).collect();
    for (at, _) in code.match_indices("super::super::") {
        let mut above = BTreeSet::new();
        heads(&code[at + "super::super::".len()..], &mut above);
        found.extend(above.into_iter().filter(|name| known.contains(name.as_str())));
    }
    found
}

/// The first name of a path, or of every path of a `{…}` group.
fn heads(path: &str, found: &mut BTreeSet<String>) {
    let name =
        |text: &str| -> String { text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect() };
    let Some(group) = path.strip_prefix('{') else {
        found.insert(name(path));
        return;
    };
    let (mut depth, mut start) = (0_usize, 0);
    for (i, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            ',' | '}' if depth == 0 => {
                let head = name(&group[start..i]);
                if !head.is_empty() {
                    found.insert(head);
                }
                if c == '}' {
                    return;
                }
                start = i + 1;
            }
            '}' => depth -= 1,
            _ => {}
        }
    }
}
