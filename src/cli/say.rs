//! What people read on stderr: errors that point at the input, the summary, the progress.

use super::files::Input;
use super::{Halt, Volume};
use indicatif::{ProgressBar, ProgressStyle};
use miette::{LabeledSpan, MietteDiagnostic, NamedSource};
use squinch::domain::{Repair, RepairKind};
use squinch::mesh::verify::{Check, Status, Verdict};
use squinch::pipeline::{Exit, Outcome};
use squinch::refine::{Progress, StopReason};
use squinch::report::{FailureReport, Report};
use std::collections::BTreeMap;
use std::io::{self, IsTerminal, Write};
use std::ops::Range;
use std::time::{Duration, Instant};

/// One line on stderr. A closed stderr is no reason to fail.
pub fn line(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

pub fn error(text: &str) {
    line(&format!("{} {text}", Ink::stderr().red("error:")));
}

pub fn help(text: &str) {
    line(&format!("  {} {text}", Ink::stderr().dim("help:")));
}

/// Says why a verb ended early; the exit code that belongs to it.
pub fn halt(halt: Halt) -> Exit {
    match halt {
        Halt::Said(exit) => exit,
        Halt::Usage(text) => {
            error(&text);
            Exit::Usage
        }
        Halt::Unreadable(text) => {
            error(&text);
            Exit::Unreadable
        }
        Halt::Failure(report, input) => {
            failure(&report, input.as_deref());
            report.kind.exit()
        }
        Halt::Unwritable(text) => {
            error(&text);
            Exit::Unwritable
        }
    }
}

/// What stood in the way: with the line of the input where it is known, else with coordinates.
pub fn failure(report: &FailureReport, input: Option<&Input>) {
    if let (Some(input), Some(number)) = (input, report.line) {
        let text = String::from_utf8_lossy(&input.bytes);
        let span = span_of_line(&text, number, report.column);
        return pointing(&report.what, Some(&report.help), &input.path, &text, span);
    }
    let place = report.at.map_or_else(String::new, |at| format!(" at {}", place(at)));
    let path = input.map_or_else(String::new, |input| format!("{}: ", input.path));
    error(&format!("{path}{}{place}", report.what));
    if !report.help.is_empty() {
        help(&report.help);
    }
}

/// A message that points into a text.
pub fn pointing(what: &str, advice: Option<&str>, path: &str, text: &str, span: Range<usize>) {
    let mut diagnostic = MietteDiagnostic::new(what).with_label(LabeledSpan::at(span, "here"));
    diagnostic.help = advice.filter(|a| !a.is_empty()).map(str::to_owned);
    let report = miette::Report::new(diagnostic).with_source_code(NamedSource::new(path, text.to_owned()));
    line(&format!("{report:?}"));
}

/// Bytes of a line counted from 1, from a column counted from 1 on.
fn span_of_line(text: &str, number: usize, column: Option<usize>) -> Range<usize> {
    let start: usize = text.split_inclusive('\n').take(number.saturating_sub(1)).map(str::len).sum();
    let length = text[start..].lines().next().map_or(0, str::len);
    let skipped = column.map_or(0, |c| c.saturating_sub(1)).min(length);
    let from = (start..=start + skipped).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(start);
    from..start + length
}

/// Colours, where they are seen.
#[derive(Clone, Copy)]
pub struct Ink(bool);

impl Ink {
    pub fn stderr() -> Self {
        Self(io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none())
    }

    pub fn stdout() -> Self {
        Self(io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none())
    }

    fn paint(self, code: &str, text: &str) -> String {
        if self.0 { format!("\x1b[{code}m{text}\x1b[0m") } else { text.to_owned() }
    }

    pub fn red(self, text: &str) -> String {
        self.paint("1;31", text)
    }

    pub fn green(self, text: &str) -> String {
        self.paint("1;32", text)
    }

    pub fn bold(self, text: &str) -> String {
        self.paint("1", text)
    }

    pub fn dim(self, text: &str) -> String {
        self.paint("2", text)
    }
}

/// A count with thin groups of three: 1 234 567.
pub fn count(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// A number to so many significant digits, without an exponent where it is read better so.
pub fn number(x: f64, digits: usize) -> String {
    let short = format!("{x:.*e}", digits.saturating_sub(1));
    match short.parse::<f64>() {
        Ok(value) if value == 0.0 || (1e-4..1e15).contains(&value.abs()) => value.to_string(),
        Ok(value) => format!("{value:e}"),
        Err(_) => short,
    }
}

/// A place to nine significant digits.
pub fn place([x, y]: [f64; 2]) -> String {
    format!("({}, {})", number(x, 9), number(y, 9))
}

/// "1 region", "2 regions".
pub fn plural(n: usize, one: &str, many: &str) -> String {
    format!("{} {}", count(n), if n == 1 { one } else { many })
}

/// "3 lines, 1 arc" of kinds and their counts.
pub fn kinds(kinds: &BTreeMap<&'static str, usize>) -> String {
    let parts: Vec<_> = kinds.iter().map(|(kind, n)| plural(*n, kind, &many(kind))).collect();
    if parts.is_empty() { "no curves".into() } else { parts.join(", ") }
}

fn many(kind: &str) -> String {
    match kind {
        "bezier" => "beziers".into(),
        "nurbs" => "nurbs".into(),
        _ => format!("{kind}s"),
    }
}

/// "3 welds, 1 split" of repairs.
pub fn repair_kinds(repairs: &[Repair]) -> String {
    let mut kinds: BTreeMap<RepairKind, usize> = BTreeMap::new();
    for repair in repairs {
        *kinds.entry(repair.kind).or_default() += 1;
    }
    let word = |kind: RepairKind| match kind {
        RepairKind::Weld => ["weld", "welds"],
        RepairKind::GapClosed => ["gap closed", "gaps closed"],
        RepairKind::Split => ["split", "splits"],
        RepairKind::SelfSplit => ["split of a curve with itself", "splits of curves with themselves"],
        RepairKind::Corner => ["corner found", "corners found"],
        RepairKind::Duplicate => ["duplicate dropped", "duplicates dropped"],
        RepairKind::Overlap => ["overlap merged", "overlaps merged"],
        RepairKind::Collapsed => ["feature within the tolerance lost", "features within the tolerance lost"],
        RepairKind::ZeroLength => ["curve of no length dropped", "curves of no length dropped"],
        RepairKind::Seed => ["seed without a face", "seeds without a face"],
    };
    let parts: Vec<_> = kinds.into_iter().map(|(kind, n)| plural(n, word(kind)[0], word(kind)[1])).collect();
    parts.join(", ")
}

/// One line a repair.
pub fn repair_line(repair: &Repair) -> String {
    format!("{} {}, moved by {}", place(repair.at), repair.what, number(repair.size, 3))
}

/// The end of a run: what went in, what came out, what of it is promised. Without a mesh the failure says it all.
pub fn summary(outcome: &Outcome, wrote: &[String], volume: Volume) {
    let report = &outcome.report;
    if volume == Volume::Quiet || report.mesh.is_none() && volume < Volume::Verbose {
        return;
    }
    let ink = Ink::stderr();
    let row = |name: &str, text: &str| line(&format!("  {}  {text}", ink.dim(&format!("{name:<8}"))));
    line(&format!("{} {}", ink.bold("squinch"), report.input.path));
    input_rows(report, volume, &row);
    if let (Some(mesh), Some(quality)) = (&report.mesh, &report.quality) {
        let regions = if mesh.regions.len() > 1 { format!(", {} regions", mesh.regions.len()) } else { String::new() };
        row(
            "mesh",
            &format!(
                "{}, {}, {} on curves{regions}",
                plural(mesh.vertices, "vertex", "vertices"),
                plural(mesh.triangles, "triangle", "triangles"),
                plural(mesh.boundary_edges, "edge", "edges"),
            ),
        );
        row("angles", &format!("{:.2}° to {:.2}°{}", quality.min_angle_deg, quality.max_angle_deg, excused(report)));
    }
    if let Some(verdict) = &outcome.verdict {
        row("promise", &promise(verdict, ink));
        let shown = verdict.checks.iter().filter(|c| volume == Volume::Verbose || c.status == Status::Broken);
        shown.for_each(|check| check_lines(check, ink).iter().for_each(|text| line(text)));
    }
    stop_row(report, &row);
    row("time", &time(report));
    if !wrote.is_empty() {
        row("wrote", &wrote.join(", "));
    }
}

fn input_rows(report: &Report, volume: Volume, row: &dyn Fn(&str, &str)) {
    let input = &report.input;
    let Some(format) = &input.format else { return };
    let unit = input.unit.as_ref().map_or_else(String::new, |unit| format!(", in {unit}"));
    let area = report
        .quality
        .as_ref()
        .and_then(|q| q.exact_measure)
        .map_or_else(String::new, |a| format!(", area {}", number(a, 9)));
    row("input", &format!("{format}: {}{area}{unit}", kinds(&input.curves)));
    for skipped in &input.skipped {
        row("left out", &format!("{} {}: {}", skipped.count, skipped.entity, skipped.why));
    }
    if volume == Volume::Verbose {
        input.notes.iter().for_each(|note| row("note", note));
        input.repairs.iter().for_each(|repair| row("repair", &repair_line(repair)));
    } else if !input.repairs.is_empty() {
        row("repairs", &format!("{} (-v lists them)", repair_kinds(&input.repairs)));
    }
}

fn excused(report: &Report) -> String {
    let (Some(quality), Some(promise)) = (&report.quality, &report.promise) else { return String::new() };
    match promise.excused.count {
        0 => String::new(),
        n => format!(
            "; from {:.2}° but for {} at {}",
            quality.min_unexcused_angle_deg,
            plural(n, "triangle", "triangles"),
            plural(promise.excused.by_corner.len(), "sharp corner", "sharp corners"),
        ),
    }
}

/// "kept (3 proven, 2 reached)" or what is broken.
pub fn promise(verdict: &Verdict, ink: Ink) -> String {
    let names = |status: Status| -> Vec<&str> {
        verdict.checks.iter().filter(|c| c.status == status).map(|c| c.name).collect()
    };
    let broken = names(Status::Broken);
    if !broken.is_empty() {
        return format!("{}: {}", ink.red("broken"), broken.join(", "));
    }
    let reached = names(Status::Reached);
    let proven = names(Status::Proven).len();
    let rest =
        if reached.is_empty() { String::new() } else { format!("; reached, not proven: {}", reached.join(", ")) };
    format!("{}, {proven} proven{rest}", ink.green("kept"))
}

/// A check with its worst value and the first of its flaws.
pub fn check_lines(check: &Check, ink: Ink) -> Vec<String> {
    let status = match check.status {
        Status::Proven => ink.green("proven "),
        Status::Reached => ink.green("reached"),
        Status::Broken => ink.red("broken "),
        Status::NotAsked => ink.dim("n/a    "),
    };
    let counts = match check.status {
        Status::NotAsked => String::new(),
        Status::Broken => format!("{} of {}", count(check.broken), count(check.checked)),
        _ => count(check.checked),
    };
    let worst = check.worst.map_or_else(String::new, |w| format!("  worst {} at {}", number(w.value, 6), place(w.at)));
    let head = format!("    {status} {:<17} {counts:>12}{worst}", check.name);
    let flaws = check.flaws.iter().map(|flaw| format!("      {flaw}"));
    std::iter::once(head.trim_end().to_owned()).chain(flaws).collect()
}

fn stop_row(report: &Report, row: &dyn Fn(&str, &str)) {
    let Some(stop) = &report.stop else { return };
    let reason = match stop.reason {
        StopReason::Done => return,
        StopReason::VertexBudget => "the vertex budget ran out",
        StopReason::Cancelled => "the time ran out",
        StopReason::Arithmetic => "coordinates cannot be told apart any more",
    };
    let place = stop.places.first().map_or_else(String::new, |at| format!(", one at {}", place(*at)));
    row("stopped", &format!("{reason}; {} still owed{place}", plural(stop.owed, "cell", "cells")));
}

fn time(report: &Report) -> String {
    let s = &report.seconds;
    let memory = report.peak_memory_bytes.map_or_else(String::new, |b| format!(", {:.0} MB", b as f64 / 1e6));
    format!(
        "{:.2} s (read {:.2}, arrange {:.2}, mesh {:.2}, verify {:.2}, write {:.2}){memory}",
        s.total, s.read, s.arrange, s.mesh, s.verify, s.write
    )
}

/// A line of progress where stderr is a terminal and the work lasts.
pub struct Bar {
    begun: Instant,
    bar: Option<ProgressBar>,
    shown: bool,
}

impl Bar {
    /// Work shorter than this is over before a line is read.
    const PATIENCE: Duration = Duration::from_millis(400);

    pub fn new(volume: Volume) -> Self {
        Self { begun: Instant::now(), bar: None, shown: volume > Volume::Quiet && io::stderr().is_terminal() }
    }

    pub fn tell(&mut self, progress: &Progress) {
        if !self.shown || self.begun.elapsed() < Self::PATIENCE {
            return;
        }
        let bar = self.bar.get_or_insert_with(|| {
            let bar = ProgressBar::new_spinner();
            bar.set_style(ProgressStyle::with_template("{spinner} {msg}  {elapsed}").expect("a right template"));
            bar
        });
        let (vertices, queued) = (count(progress.vertices), count(progress.queued));
        bar.set_message(format!("{}: {vertices} vertices, {queued} waiting", progress.phase));
        bar.tick();
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_in_its_text() {
        let text = "one\r\ntwo ä\nthree";
        assert_eq!(&text[span_of_line(text, 1, None)], "one");
        assert_eq!(&text[span_of_line(text, 2, None)], "two ä");
        assert_eq!(&text[span_of_line(text, 2, Some(5))], "ä");
        assert_eq!(&text[span_of_line(text, 2, Some(6))], "ä", "inside a letter: from its beginning");
        assert_eq!(&text[span_of_line(text, 3, Some(99))], "");
        assert_eq!(span_of_line(text, 9, None), text.len()..text.len());
        assert_eq!(span_of_line("", 1, Some(3)), 0..0);
    }

    #[test]
    fn counts_are_read_at_a_glance() {
        assert_eq!(count(7), "7");
        assert_eq!(count(1234), "1 234");
        assert_eq!(count(1234567), "1 234 567");
        assert_eq!(number(1257.129794213, 9), "1257.12979");
        assert_eq!(number(-0.0, 6), "-0");
        assert_eq!(number(7.049770654139608e-8, 3), "7.05e-8");
        assert_eq!(number(25.0, 6), "25");
        assert_eq!(number(f64::INFINITY, 6), "inf");
        assert_eq!(place([1e16, 0.1 + 0.2]), "(1e16, 0.3)");
        assert_eq!(plural(1, "vertex", "vertices"), "1 vertex");
        assert_eq!(kinds(&BTreeMap::from([("line", 2), ("arc", 1)])), "1 arc, 2 lines");
    }
}
