//! Checks the sources against the table "Who may import whom" of `src/README.md`.
//!
//! The sources are read as text: every path outside comments that begins with `crate`, `squinch` or `super` must lead
//! to a room that its own room may know. A row may be of a part of a room, as `import/step`: it may import what its
//! room may, and what its own row adds.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Rooms by their paths below `src`, each with those that it may import.
struct Table {
    rows: BTreeMap<String, BTreeSet<String>>,
    /// Rooms on which every other may stand.
    ground: BTreeSet<String>,
}

impl Table {
    /// The table under the heading "Who may import whom", and the ground that the sentence above it names.
    fn read(map: &str) -> Self {
        let section = map.split("## Who may import whom").nth(1).expect("the map has the table");
        let section = section.split("\n## ").next().unwrap_or(section);
        let (above, table) = section.split_at(section.find("| module |").expect("the table has a head"));
        let cells = |line: &str| line.split('|').skip(1).take(2).map(quoted).collect::<Vec<_>>();
        let mut rows = BTreeMap::new();
        for line in table.lines().skip(2).take_while(|line| line.starts_with('|')) {
            let [rooms, may] = &cells(line)[..] else { panic!("a row has rooms and what they import: {line}") };
            assert!(!rooms.is_empty() && !may.contains("*"), "{line}");
            rooms.iter().for_each(|room| assert!(rows.insert(room.clone(), may.clone()).is_none(), "{room} twice"));
        }
        Self { rows, ground: quoted(above) }
    }

    /// The room that a path lies in: the longest one of the table that it begins with.
    fn room_of(&self, path: &str) -> Option<&str> {
        let is_within =
            |room: &&String| path.strip_prefix(room.as_str()).is_some_and(|r| r.is_empty() || r.starts_with('/'));
        self.rows.keys().filter(is_within).max_by_key(|room| room.len()).map(String::as_str)
    }

    fn may_import(&self, room: &str, target: &str) -> bool {
        let is_within = |outer: &str| target == outer || target.starts_with(&format!("{outer}/"));
        let around = room.split_once('/').map(|(whole, _)| whole);
        let listed = [Some(room), around].into_iter().flatten().flat_map(|room| &self.rows[room]);
        target == room || Some(target) == around || listed.chain(&self.ground).any(|may| is_within(may))
    }
}

/// What stands between backquotes.
fn quoted(text: &str) -> BTreeSet<String> {
    text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

fn table() -> Table {
    Table::read(&fs::read_to_string(source_root().join("README.md")).expect("the map is readable"))
}

#[test]
fn every_room_keeps_to_the_table() {
    let table = table();
    let mut broken = Vec::new();
    for file in sources() {
        let text = fs::read_to_string(source_root().join(&file)).expect("a source is readable");
        let Some(room) = table.room_of(module_of(&file)) else { continue };
        for path in imported(&text, module_of(&file)) {
            if table.room_of(&path).is_some_and(|target| !table.may_import(room, target)) {
                broken.push(format!("{file} imports {path}"));
            }
        }
    }
    assert!(broken.is_empty(), "against the table in src/README.md:\n{}", broken.join("\n"));
}

#[test]
fn every_room_has_a_row() {
    let table = table();
    let sources = sources();
    let missing: Vec<&String> = sources.iter().filter(|file| table.room_of(module_of(file)).is_none()).collect();
    assert!(missing.is_empty(), "not in the table: {missing:?}");
    let is_there = |room: &String| sources.iter().any(|file| table.room_of(module_of(file)) == Some(room));
    let gone: Vec<&String> = table.rows.keys().filter(|room| !is_there(room)).collect();
    assert!(gone.is_empty(), "without a source: {gone:?}");
}

/// No imports form a cycle, directly or through others: neither between rooms nor between the files of one folder. So
/// each folder has an order in which one can read it.
///
/// ```text
///   domain/                      `domain` imports `curve`, so `curve` imports nothing that leads back to `domain`.
///   ├── mod.rs                   A `mod.rs` declares its children and holds what they share.
///   ├── locate.rs ◀────────╮     It and its children may import each other.
///   └── arrange/           │
///       ├── mod.rs         │
///       ├── fill.rs ───▶ trace.rs ──╳──▶ fill.rs     Two that import each other are one module in two files.
///       └── faces.rs ◀── fill.rs
/// ```
///
/// A file and the folder of its name count as one: `clip/part.rs` imports for `clip`, and is imported as `clip`.
#[test]
fn no_imports_run_in_a_circle() {
    let modules: BTreeSet<String> = sources().iter().map(|file| module_of(file).to_owned()).collect();
    let mut floors: BTreeMap<String, Graph> = BTreeMap::new();
    for file in sources() {
        let text = fs::read_to_string(source_root().join(&file)).expect("a source is readable");
        let module = module_of(&file);
        for target in imported(without_tests(&text), module) {
            if let Some(target) = module_with(&target, &modules)
                && let Some((floor, [from, to])) = floor_between(module, target)
            {
                floors.entry(floor).or_default().entry(from).or_default().insert(to);
            }
        }
    }
    assert!(floors.len() > 10, "floors are found: {}", floors.len());
    let (floor, [of, by]) = BY_DESIGN;
    let closes = floors.get_mut(floor).and_then(|graph| graph.get_mut(by)).is_some_and(|known| known.remove(of));
    assert!(closes, "{floor}: {by} no longer imports {of}, and needs no exception");
    let circles: Vec<String> = (floors.iter())
        .flat_map(|(floor, graph)| circle_of(graph).map(|circle| format!("src/{floor}: {}", circle.join(" → "))))
        .collect();
    assert!(circles.is_empty(), "imports run in a circle:\n{}", circles.join("\n"));
}

/// The one circle: the trait of all kinds of curves, and the answers that it gives by default, which ask it in turn.
const BY_DESIGN: (&str, [&str; 2]) = ("curve", ["kind", "spans"]);

/// What each of some siblings imports of the others.
type Graph = BTreeMap<String, BTreeSet<String>>;

/// A source up to its own tests, which may look at what they like.
fn without_tests(text: &str) -> &str {
    text.split("#[cfg(test)]\nmod tests").next().unwrap_or(text)
}

/// The module that a path leads to: the longest one that it begins with.
fn module_with<'m>(path: &str, modules: &'m BTreeSet<String>) -> Option<&'m str> {
    let mut path = path;
    loop {
        if let Some(module) = modules.get(path) {
            return Some(module);
        }
        path = path.rsplit_once('/')?.0;
    }
}

/// The folder in which the ways to two modules part, and what each way goes on with; `None` where one lies within the
/// other.
fn floor_between(from: &str, to: &str) -> Option<(String, [String; 2])> {
    let (from, to): (Vec<&str>, Vec<&str>) = (from.split('/').collect(), to.split('/').collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let parting = [*from.get(common)?, *to.get(common)?];
    Some((from[..common].join("/"), parting.map(str::to_owned)))
}

/// One circle of a graph, its first member again at the end.
fn circle_of(graph: &Graph) -> Option<Vec<String>> {
    /// `way` leads to `here`; `done` leads into no circle.
    fn walk(graph: &Graph, here: &str, way: &mut Vec<String>, done: &mut BTreeSet<String>) -> Option<Vec<String>> {
        if let Some(first) = way.iter().position(|name| name == here) {
            return Some(way[first..].iter().cloned().chain([here.to_owned()]).collect());
        }
        if !done.contains(here) {
            way.push(here.to_owned());
            for next in graph.get(here).into_iter().flatten() {
                if let Some(circle) = walk(graph, next, way, done) {
                    return Some(circle);
                }
            }
            way.pop();
            done.insert(here.to_owned());
        }
        None
    }
    let mut done = BTreeSet::new();
    graph.keys().find_map(|start| walk(graph, start, &mut Vec::new(), &mut done))
}

#[test]
fn a_circle_is_found() {
    let graph = |edges: &[(&str, &str)]| {
        let mut graph = Graph::new();
        for &(from, to) in edges {
            graph.entry(from.into()).or_default().insert(to.into());
        }
        graph
    };
    assert_eq!(circle_of(&graph(&[("a", "b"), ("a", "c"), ("b", "c")])), None);
    let circle = circle_of(&graph(&[("a", "b"), ("b", "c"), ("c", "d"), ("d", "b")]));
    assert_eq!(circle.expect("there is one"), ["b", "c", "d", "b"]);
    let parting = |from: &str, to: &str| floor_between(from, to).map(|(floor, [a, b])| format!("{floor}: {a} {b}"));
    assert_eq!(parting("import/dxf/hatch", "import/dxf/spline").as_deref(), Some("import/dxf: hatch spline"));
    assert_eq!(parting("run/plan/budget", "run/report").as_deref(), Some("run: plan report"));
    assert_eq!(parting("run/plan/budget", "size").as_deref(), Some(": run size"));
    assert_eq!(parting("curve/line", "curve"), None, "what a module holds for its children");
    let modules = ["curve".to_owned(), "curve/line".to_owned()].into();
    assert_eq!(module_with("curve/line/Line", &modules), Some("curve/line"));
    assert_eq!(module_with("curve/Curve", &modules), Some("curve"));
    assert_eq!(module_with("kurbo/Point", &modules), None);
}

#[test]
fn what_is_forbidden_is_found() {
    let text = "
        use crate::plane::lopping;
        use crate::{ids::CurveId, mesh::{Mesh, quality}, size};
        // use crate::nothing;
        /// [`crate::nothing`]
        fn f() { crate::curve::g(crate::domain::h()) }
        use super::super::export;
        use super::Cavity;
        use squinch::run::{self, request::Request};
    ";
    let found: Vec<String> = imported(text, "plane/gcdr/triangles").into_iter().collect();
    let all = [
        "curve/g",
        "domain/h",
        "ids/CurveId",
        "mesh/Mesh",
        "mesh/quality",
        "plane/export",
        "plane/gcdr/Cavity",
        "plane/lopping",
        "run",
        "run/request/Request",
        "size",
    ];
    assert_eq!(found, all);
    let table = table();
    let may = |file: &str, path: &str| {
        let [room, target] = [file, path].map(|path| table.room_of(path).expect("it has a row"));
        table.may_import(room, target)
    };
    assert!(may("plane/insert", "mesh/Mesh") && may("plane/lopping/begin", "plane/insert") && may("cli/mesh", "run"));
    assert!(may("import/step/read", "cad") && !may("import/poly", "cad"));
    assert!(!may("verify/mod", "plane/insert"), "the verifier must not know the kernels");
    assert!(!may("plane/gcdr", "plane/lopping/begin") && !may("plane/insert", "plane/gcdr"), "nor engines each other");
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

/// A source without its suffix; a room's own `mod.rs` is the room.
fn module_of(file: &str) -> &str {
    let module = file.trim_end_matches(".rs");
    module.strip_suffix("/mod").unwrap_or(module)
}

/// The paths that a source names by `crate` or `squinch`, or by climbing out of its module; with `/`, below `src`.
fn imported(text: &str, module: &str) -> BTreeSet<String> {
    let code: String = (text.lines())
        .filter(|line| !line.trim_start().starts_with("//"))
        .fold(String::new(), |all, line| all + line + "\n");
    let mut found = BTreeSet::new();
    for root in ["crate::", "squinch::"] {
        for (at, _) in code.match_indices(root) {
            expand(&code[at + root.len()..], "", &mut found);
        }
    }
    let mut rest = &code[..];
    while let Some(at) = rest.find("super::") {
        rest = &rest[at..];
        let mut above = module;
        while let Some(inner) = rest.strip_prefix("super::") {
            (above, rest) = (above.rsplit_once('/').map_or("", |(above, _)| above), inner);
        }
        expand(rest, above, &mut found);
    }
    found
}

/// A path, or every path of a `{…}` group, behind those that lead to it.
fn expand(path: &str, above: &str, found: &mut BTreeSet<String>) {
    let path = path.trim_start();
    let join = |name: &str| if above.is_empty() { name.to_owned() } else { format!("{above}/{name}") };
    let Some(group) = path.strip_prefix('{') else {
        let name: String = path.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        match path[name.len()..].strip_prefix("::") {
            Some(rest) => expand(rest, &join(&name), found),
            None if name.is_empty() || name == "self" => _ = found.insert(above.to_owned()),
            None => _ = found.insert(join(&name)),
        }
        return;
    };
    let (mut depth, mut start) = (0_usize, 0);
    for (i, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            ',' | '}' if depth == 0 => {
                if !group[start..i].trim().is_empty() {
                    expand(&group[start..i], above, found);
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
