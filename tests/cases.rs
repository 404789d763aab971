//! Runs that once went wrong, each as its case file: they end with a verified mesh, at an announced limit, or with a
//! located refusal.

use squinch::import::Format;
use squinch::run::case::Case;
use squinch::run::{Exit, Extent, Source, run};
use squinch::watch::no_clock;
use std::fs;
use std::path::PathBuf;

#[test]
fn every_case_ends_with_a_mesh_at_a_limit_or_with_a_located_refusal() {
    let mut files: Vec<PathBuf> =
        fs::read_dir("tests/cases").expect("the cases are there").map(|e| e.expect("an entry").path()).collect();
    files.sort();
    assert!(!files.is_empty());
    for file in files {
        let name = file.display();
        let text = fs::read_to_string(&file).expect("a case is text");
        let case = Case::from_toml(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        let (bytes, nodes) = case.bytes().unwrap_or_else(|e| panic!("{name}: {e}"));
        let format = case.input.format.as_deref().and_then(Format::from_name);
        let source = Source { path: &case.input.name, bytes: &bytes, format, nodes: nodes.as_deref(), of_many: false };
        let outcome = run(&source, &case.request, Extent::Whole(&mut |_| true), &no_clock);
        assert_ne!(outcome.exit, Exit::Bug, "{name}: {:?}", outcome.report.failure);
        match &outcome.report.failure {
            None if outcome.exit == Exit::Missed => assert!(outcome.report.stop.is_some(), "{name}"),
            None => assert!(outcome.verdict.is_some_and(|verdict| verdict.kept()), "{name}"),
            Some(failure) => assert!(failure.at.is_some() && !failure.help.is_empty(), "{name}: {failure:?}"),
        }
    }
}
