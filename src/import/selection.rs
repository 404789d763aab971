//! Which layers of a file are read.

use crate::domain::Unmatched;
use glob::{MatchOptions, Pattern};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt;
use std::str::FromStr;

/// A name, or a pattern with `*`, `?` and `[…]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "String", into = "String")]
pub struct Glob {
    text: String,
    pattern: Pattern,
}

impl Glob {
    fn matches(&self, name: &str, case: MatchOptions) -> bool {
        let same = if case.case_sensitive { name == self.text } else { name.eq_ignore_ascii_case(&self.text) };
        same || self.pattern.matches_with(name, case)
    }
}

impl FromStr for Glob {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        // Where the brackets of a name are not a valid pattern, the name matches itself.
        let pattern = Pattern::new(text).or_else(|_| Pattern::new(&Pattern::escape(text)));
        Ok(Self { text: text.into(), pattern: pattern.map_err(|e| e.to_string())? })
    }
}

impl TryFrom<String> for Glob {
    type Error = String;
    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Glob> for String {
    fn from(glob: Glob) -> Self {
        glob.text
    }
}

impl fmt::Display for Glob {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// Which layers are read.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", default)]
pub struct Selection {
    /// Only these layers (DXF) or layers and ids (SVG) are read: names or patterns as PART*, with commas or repeated.
    #[schemars(extend("group" = "input", "value" = "A,B", "commas" = true))]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<Glob>,
    /// These layers or ids are not read: names or patterns as in --layers.
    #[schemars(extend("group" = "input", "value" = "A,B", "commas" = true))]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub skip_layers: Vec<Glob>,
}

/// What the selection says about an entity by its names.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Choice {
    asked: bool,
    skipped: bool,
}

/// Decides for each entity whether it is selected, and records which patterns matched.
pub(super) struct Chooser<'a> {
    selection: &'a Selection,
    case: MatchOptions,
    names: BTreeSet<String>,
    matched: BTreeSet<&'a str>,
}

/// Largest number of similar names that are offered for one that does not exist.
const NEAR: usize = 5;

impl<'a> Chooser<'a> {
    /// Compiles the patterns.
    pub fn new(selection: &'a Selection, case_sensitive: bool) -> Self {
        let case = MatchOptions { case_sensitive, ..MatchOptions::default() };
        Self { selection, case, names: BTreeSet::new(), matched: BTreeSet::new() }
    }

    /// Whether an entity with these names is read: its layer, or in SVG its own names and those of all groups around
    /// it.
    pub fn takes<'n>(&mut self, names: impl IntoIterator<Item = &'n str>) -> bool {
        let choice = self.choice(Choice::default(), names);
        self.allows(choice)
    }

    /// What the selection says about an entity by its own names, inside groups about which it says `around`.
    pub fn choice<'n>(&mut self, around: Choice, names: impl IntoIterator<Item = &'n str>) -> Choice {
        names.into_iter().fold(around, |said, name| {
            if !self.names.contains(name) {
                self.learn(name);
            }
            let any = |globs: &[Glob]| globs.iter().any(|glob| glob.matches(name, self.case));
            let Selection { layers, skip_layers } = self.selection;
            Choice { asked: said.asked || any(layers), skipped: said.skipped || any(skip_layers) }
        })
    }

    /// Whether an entity is read about which the selection says this.
    pub fn allows(&self, choice: Choice) -> bool {
        (self.selection.layers.is_empty() || choice.asked) && !choice.skipped
    }

    /// Records a layer, also if nothing is drawn on it.
    pub fn learn(&mut self, name: &str) {
        let globs = self.selection.layers.iter().chain(&self.selection.skip_layers);
        self.matched.extend(globs.filter(|glob| glob.matches(name, self.case)).map(|glob| glob.text.as_str()));
        self.names.insert(name.into());
    }

    /// The patterns that matched nothing.
    pub fn unmatched(self) -> Vec<Unmatched> {
        let options = [("--layers", &self.selection.layers), ("--skip-layers", &self.selection.skip_layers)];
        let globs = options.into_iter().flat_map(|(option, globs)| globs.iter().map(move |glob| (option, glob)));
        let missed = globs.filter(|(_, glob)| !self.matched.contains(glob.text.as_str()));
        let near = |glob: &Glob| {
            let wanted = glob.text.to_lowercase();
            let mut names: Vec<&String> = self.names.iter().collect();
            let likeness = |name: &str| strsim::jaro_winkler(&name.to_lowercase(), &wanted);
            names.sort_by(|a, b| likeness(b).total_cmp(&likeness(a)));
            names.into_iter().take(NEAR).cloned().collect()
        };
        missed.map(|(option, glob)| Unmatched { asked: format!("{option} {glob}"), near: near(glob) }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn globs(texts: &[&str]) -> Vec<Glob> {
        texts.iter().map(|text| text.parse().unwrap()).collect()
    }

    #[test]
    fn names_and_patterns_select() {
        let selection = Selection { layers: globs(&["PART*", "[odd"]), skip_layers: globs(&["*-old"]) };
        let mut chooser = Chooser::new(&selection, false);
        assert!(chooser.takes(["part 1"]));
        assert!(chooser.takes(["[odd"]));
        assert!(!chooser.takes(["frame"]));
        assert!(!chooser.takes(["PART-OLD"]), "in any case of letters");
        assert!(chooser.takes(["frame", "PART"]), "one of several names");
        assert_eq!(chooser.unmatched(), []);
    }

    #[test]
    fn what_matches_nothing_is_told_with_what_is_near() {
        let selection = Selection { layers: vec![], skip_layers: globs(&["FRMAE", "CENTER"]) };
        let mut chooser = Chooser::new(&selection, true);
        ["PART", "FRAME", "CENTER"].into_iter().for_each(|name| chooser.learn(name));
        let unmatched = chooser.unmatched();
        assert_eq!(unmatched.len(), 1);
        assert_eq!(unmatched[0].asked, "--skip-layers FRMAE");
        assert_eq!(unmatched[0].near[0], "FRAME");
    }
}
