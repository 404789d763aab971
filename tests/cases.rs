//! Runs that once went wrong, each as its case file: they end with a verified mesh, at an announced limit, or with a
//! located refusal; and as the file says that is right.
//!
//! What is right stands above a case, in lines that begin with `#: ` and are TOML ([`Right`]).

use serde::Deserialize;
use squinch::domain::Domain;
use squinch::import::Format;
use squinch::run::case::Case;
use squinch::run::{Exit, Extent, Outcome, Source, run};
use squinch::watch::no_clock;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

/// How a case has to end.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Right {
    /// The commit before it was fixed, and what went wrong there.
    was: String,
    /// The exit code.
    exit: i32,
    /// How many regions there are.
    faces: Option<usize>,
    /// The names of all regions, and what area the curves enclose under each.
    regions: Option<BTreeMap<String, f64>>,
    /// The names of all boundaries, in any order.
    boundaries: Option<Vec<String>>,
    /// What a refusal says, among other things.
    says: Option<String>,
    /// How many triangles there are at most.
    triangles_max: Option<usize>,
}

/// The areas of the regions of each name, by the curves.
fn areas(domain: &Domain) -> BTreeMap<String, f64> {
    let mut areas = BTreeMap::new();
    for region in domain.regions().as_slice() {
        *areas.entry(domain.names().text(region.name).to_owned()).or_default() += region.area;
    }
    areas
}

impl Right {
    /// What stands above a case.
    fn above(text: &str) -> Result<Self, toml::de::Error> {
        let lines: Vec<&str> = text.lines().map_while(|line| line.strip_prefix("#: ")).collect();
        toml::from_str(&lines.join("\n"))
    }

    fn holds(&self, name: &str, outcome: &Outcome) {
        let failure = outcome.report.failure.as_ref();
        let was = &self.was;
        assert_eq!(outcome.exit as i32, self.exit, "{name}: {failure:?} (was {was})");
        if let Some(says) = &self.says {
            let what = failure.map_or("", |failure| failure.what.as_str());
            assert!(what.contains(says), "{name}: {what:?} does not say {says:?} (was {was})");
        }
        if let Some(regions) = &self.regions {
            let found = areas(outcome.domain.as_ref().expect("a domain"));
            let whole: f64 = regions.values().sum();
            let differ = regions.iter().any(|(of, area)| found.get(of).is_none_or(|a| (a - area).abs() > 1e-6 * whole));
            assert!(!differ && found.len() == regions.len(), "{name}: {found:?} (was {was})");
        }
        if let Some(faces) = self.faces {
            let found = outcome.domain.as_ref().map(|domain| domain.regions().len());
            assert_eq!(found, Some(faces), "{name} (was {was})");
        }
        let mesh = outcome.report.mesh.as_ref();
        if let Some(boundaries) = &self.boundaries {
            let mut found: Vec<&str> = mesh.expect("a mesh").boundaries.iter().map(|b| b.name.as_str()).collect();
            let mut wanted: Vec<&str> = boundaries.iter().map(String::as_str).collect();
            found.sort_unstable();
            wanted.sort_unstable();
            assert_eq!(found, wanted, "{name} (was {was})");
        }
        if let Some(most) = self.triangles_max {
            let triangles = mesh.expect("a mesh").triangles;
            assert!(triangles <= most, "{name}: {triangles} triangles (was {was})");
        }
    }
}

#[test]
fn every_case_ends_as_is_right() {
    let mut files: Vec<PathBuf> =
        fs::read_dir("tests/cases").expect("the cases are there").map(|e| e.expect("an entry").path()).collect();
    files.sort();
    assert!(!files.is_empty());
    for file in files {
        let name = &file.display().to_string();
        let text = fs::read_to_string(&file).expect("a case is text");
        let right = Right::above(&text).unwrap_or_else(|e| panic!("{name}: what is right, in lines with '#: ': {e}"));
        let case = Case::from_toml(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        let (bytes, nodes) = case.bytes().unwrap_or_else(|e| panic!("{name}: {e}"));
        let format = case.input.format.as_deref().and_then(Format::from_name);
        let source = Source { path: &case.input.name, bytes: &bytes, format, nodes: nodes.as_deref(), of_many: false };
        let outcome = run(&source, &case.request, Extent::Whole(&mut |_| true), &no_clock);
        assert_ne!(outcome.exit, Exit::Bug, "{name}: {:?}", outcome.report.failure);
        match &outcome.report.failure {
            None if outcome.exit == Exit::Missed => assert!(outcome.report.stop.is_some(), "{name}"),
            None => assert!(outcome.verdict.as_ref().is_some_and(|verdict| verdict.kept()), "{name}"),
            Some(failure) => {
                assert!(failure.at.is_some() || failure.line.is_some(), "{name}: {failure:?}");
                assert!(!failure.help.is_empty(), "{name}: {failure:?}");
            }
        }
        right.holds(name, &outcome);
    }
}
