//! The end of a run: its exit code, and why it has no mesh.

use super::Outcome;
use super::report::{FailureKind, FailureReport, StopReport};
use crate::domain::{ArrangeError, Unarranged};
use crate::import::ImportError;
use crate::plane::lopping::RefineError;
use crate::refine::{Stop, StopReason};
use crate::verify::{Status, Verdict};
use crate::watch::Stopped;

/// How a run ended, as an exit code (contract of the command line).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Every guarantee holds.
    Done = 0,
    /// Of a batch: some input ended with another code.
    SomeFailed = 1,
    /// Wrong options, or a request that does not fit the drawing.
    Usage = 2,
    /// The input cannot be read.
    Unreadable = 3,
    /// The drawing has no valid arrangement, or features that coordinates cannot tell apart.
    Geometry = 4,
    /// A requested bound is missed outside of the exempt places, or a budget ran out.
    Missed = 5,
    /// An output cannot be written.
    Unwritable = 6,
    /// A bug of squinch.
    Bug = 70,
    /// The user interrupted the run.
    Cancelled = 130,
}

impl FailureKind {
    /// The exit code of such a failure.
    pub fn exit(self) -> Exit {
        match self {
            Self::Request => Exit::Usage,
            Self::Unreadable => Exit::Unreadable,
            Self::Geometry => Exit::Geometry,
            Self::NoMesh => Exit::Missed,
            Self::Bug => Exit::Bug,
        }
    }
}

/// Names of the broken checks.
pub fn broken(verdict: &Verdict) -> Vec<&'static str> {
    verdict.checks.iter().filter(|c| c.status == Status::Broken).map(|c| c.name).collect()
}

/// Checks of bounds that were asked for. All other checks hold for any mesh that squinch makes.
const REQUESTED: &[&str] = &[
    "min_angle",
    "max_angle",
    "chord_error",
    "edge_turning",
    "size",
    "radius_edge",
    "density_a",
    "density_b",
    "density_c",
];
/// Checks that hold only at the end of refinement: unresolved where a budget stopped it.
const REFINED: &[&str] = &["empty_diametral", "ball_radius", "lfs_ratio"];

/// The exit code of a verified mesh.
pub(super) fn exit_of(verdict: &Verdict, reason: StopReason) -> Exit {
    let done = reason == StopReason::Done;
    let exemptible = |name: &str| REQUESTED.contains(&name) || !done && REFINED.contains(&name);
    let broken = broken(verdict);
    if broken.iter().any(|name| !exemptible(name)) {
        Exit::Bug
    } else if broken.is_empty() && done {
        Exit::Done
    } else {
        Exit::Missed
    }
}

/// The end of a run in words without coordinates. A reduced case must have the same.
pub fn ending(outcome: &Outcome) -> String {
    if let Some(failure) = &outcome.report.failure {
        let kind = match failure.kind {
            FailureKind::Request => "request",
            FailureKind::Unreadable => "unreadable",
            FailureKind::Geometry => "geometry",
            FailureKind::NoMesh => "no mesh",
            FailureKind::Bug => "bug",
        };
        return format!("{kind}: {}", without_numbers(&failure.what));
    }
    let broken = outcome.verdict.as_ref().map(broken).unwrap_or_default();
    match outcome.report.stop.as_ref().map(|s| s.reason) {
        Some(StopReason::Done) | None if broken.is_empty() => "done".into(),
        Some(StopReason::Done) | None => format!("missed: {}", broken.join(", ")),
        Some(StopReason::VertexBudget) => "stopped: vertex budget".into(),
        Some(StopReason::TimedOut) => "stopped: timeout".into(),
        Some(StopReason::Cancelled) => "stopped: cancelled".into(),
        Some(StopReason::Arithmetic) => "stopped: arithmetic".into(),
        Some(StopReason::NoProgress) => "stopped: no progress".into(),
    }
}

/// A text with `#` in place of each number.
fn without_numbers(text: &str) -> String {
    let of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-' | 'e' | 'E');
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let sign = rest[..start].ends_with(['-', '+']);
        plain.push_str(&rest[..start - usize::from(sign)]);
        plain.push('#');
        let end = rest[start..].find(|c| !of_number(c)).map_or(rest.len(), |n| start + n);
        rest = &rest[end..];
    }
    plain + rest
}

impl From<ImportError> for FailureReport {
    fn from(error: ImportError) -> Self {
        let ImportError { what, line, column, help } = error;
        let [line, column] = [line, column].map(|number| number.and_then(|n| u32::try_from(n).ok()));
        Self { line, column, ..Self::new(FailureKind::Unreadable, what, help) }
    }
}

impl From<ArrangeError> for FailureReport {
    fn from(error: ArrangeError) -> Self {
        let also_at = error.also_at.iter().map(|&at| at.into()).collect();
        Self { also_at, ..Self::new(FailureKind::Geometry, error.what, error.help).at(error.at) }
    }
}

impl From<Unarranged> for FailureReport {
    fn from(why: Unarranged) -> Self {
        match why {
            Unarranged::Invalid(error) => error.into(),
            Unarranged::Stopped(stopped) => stopped.into(),
        }
    }
}

impl From<Stopped> for FailureReport {
    fn from(Stopped: Stopped) -> Self {
        let stop = Stop { reason: StopReason::Cancelled, unresolved: 0, places: Vec::new(), angle_deg: None };
        no_mesh(&stop, "--timeout")
    }
}

impl From<RefineError> for FailureReport {
    fn from(error: RefineError) -> Self {
        Self::new(FailureKind::Geometry, error.what, error.help).at(error.at)
    }
}

/// Why a stopped refinement has no mesh. `more` is the option that lets it run longer.
pub fn no_mesh(stop: &Stop, more: &str) -> FailureReport {
    let (what, help) = match stop.reason {
        StopReason::VertexBudget => {
            ("the vertex budget ended before there was a valid mesh", "allow more by --max-vertices".into())
        }
        StopReason::Cancelled | StopReason::TimedOut => {
            ("the run was stopped before there was a valid mesh", format!("allow more by {more}"))
        }
        StopReason::Done | StopReason::Arithmetic | StopReason::NoProgress => (
            "features are nearer to each other than the coordinates can tell apart",
            "move the drawing nearer to the origin, or weld by a larger --tolerance".into(),
        ),
    };
    let mut failure = FailureReport::new(FailureKind::NoMesh, what, help);
    failure.stop = Some(Box::new(StopReport::new(stop)));
    match stop.places.first() {
        Some(&place) => failure.at(place),
        None => failure,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_forget_numbers() {
        assert_eq!(without_numbers("line 12 meets arc 7 at -1.5e-3, twice"), "line # meets arc # at #, twice");
        assert_eq!(without_numbers("no number"), "no number");
        assert_eq!(without_numbers("3"), "#");
    }
}
