//! Messages on stderr: errors with their place in the input, the summary, the progress.

use super::files::Input;
use super::output::Output;
use super::{Halt, Volume};
use indicatif::{ProgressBar, ProgressStyle};
use miette::{LabeledSpan, MietteDiagnostic, NamedSource};
use squinch::domain::{Repair, RepairKind};
use squinch::geometry::Place;
use squinch::mesh::quality::Quality;
use squinch::refine::StopReason;
use squinch::run::report::{FailureReport, InputReport, MeshReport, QualityReport, Report};
use squinch::run::{Exit, Outcome};
use squinch::verify::{Check, Exemption, Status, Verdict};
use squinch::watch::Progress;
use std::collections::BTreeMap;
use std::io::{self, IsTerminal, Write};
use std::ops::Range;
use std::time::{Duration, Instant};

/// Prints a line on stderr, [`harmless`]. Errors of a closed stderr are ignored.
pub fn line(text: &str) {
    let _ = writeln!(io::stderr(), "{}", harmless(text));
}

/// A text as one line that is safe for a terminal. Control characters, which could steer a terminal, are written as
/// numbers. The middle of a very long text is left out. All text for people goes through here; [`Ink`] passes.
pub fn harmless(text: &str) -> String {
    const HEAD: usize = 3000;
    const TAIL: usize = 500;
    let long = text.char_indices().nth(HEAD + TAIL).is_some();
    let head = text.char_indices().nth(HEAD).filter(|_| long).map_or(text.len(), |(i, _)| i);
    let tail = text.char_indices().nth_back(TAIL - 1).filter(|_| long).map_or(text.len(), |(i, _)| i);
    let gap = if long { " […] " } else { "" };
    [&text[..head], gap, &text[tail..]]
        .iter()
        .flat_map(|part| part.chars())
        .map(|c| Ink::code(c).map_or_else(|| shown(c), str::to_owned))
        .collect()
}

/// A character without an effect on a terminal other than being shown.
fn shown(c: char) -> String {
    match c {
        '\t' => " ".into(),
        // Control characters, and those that change the direction of writing.
        _ if c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}') =>
        {
            c.escape_unicode().to_string()
        }
        _ => c.to_string(),
    }
}

/// Prints an error.
pub fn error(text: &str) {
    line(&format!("{} {text}", Ink::stderr().red("error:")));
}

/// Prints advice.
pub fn help(text: &str) {
    line(&format!("  {} {text}", Ink::stderr().dim("help:")));
}

/// Prints why a verb ended early, and returns the exit code.
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

/// Prints a failure: with the line of the input if it is known, else with coordinates.
pub fn failure(report: &FailureReport, input: Option<&Input>) {
    if let (Some(input), Some(number)) = (input, report.line) {
        let text = String::from_utf8_lossy(&input.bytes);
        let span = span_of_line(&text, number as usize, report.column.map(|column| column as usize));
        return pointing(&report.what, Some(&report.help), &input.path, &text, span);
    }
    let path = input.map_or_else(String::new, |input| format!("{}: ", input.path));
    error(&format!("{path}{}", located(&report.what, report.at)));
    if !report.help.is_empty() {
        help(&report.help);
    }
}

/// What is wrong, with the place unless the text names it.
pub fn located(what: &str, at: Option<Place>) -> String {
    match at.map(place) {
        Some(place) if !what.contains(&place) => format!("{what} at {place}"),
        Some(_) | None => what.to_owned(),
    }
}

/// Prints a few lines about an input that failed, which may explain the failure.
pub fn remarks(input: &InputReport, volume: Volume) {
    // Quiet runs print none of this, and verbose runs print all of it elsewhere.
    if volume != Volume::Normal {
        return;
    }
    let row = |name: &str, text: &str| line(&format!("  {}  {text}", Ink::stderr().dim(&format!("{name:<8}"))));
    note_rows(&input.notes, volume, &row);
    repair_rows(&[], &input.unhealed, volume, &mut |name, text| row(name, text));
}

/// Prints what an output does not hold of a mesh.
pub fn losses(output: Output, losses: &[&str]) {
    losses.iter().for_each(|loss| line(&format!("  not kept by {}: {loss}", output.name())));
}

/// Prints a message that points into a text.
pub fn pointing(what: &str, advice: Option<&str>, path: &str, text: &str, span: Range<usize>) {
    let (excerpt, span) = excerpt(text, span);
    let mut diagnostic = MietteDiagnostic::new(harmless(what)).with_label(LabeledSpan::at(span, "here"));
    diagnostic.help = advice.filter(|a| !a.is_empty()).map(harmless);
    let report = miette::Report::new(diagnostic).with_source_code(NamedSource::new(harmless(path), excerpt));
    let _ = writeln!(io::stderr(), "{report:?}");
}

/// The line of a span and its neighbours, harmless and cut to a readable width, after as many empty lines as precede
/// them; and the place of the span in that.
fn excerpt(text: &str, span: Range<usize>) -> (String, Range<usize>) {
    /// Number of characters of a line that are shown before the span, and from it on.
    const BEFORE: usize = 60;
    const FROM: usize = 100;
    let start = text[..span.start].rfind('\n').map_or(0, |i| i + 1);
    let end = text[span.start..].find('\n').map_or(text.len(), |i| span.start + i);
    let beginning = |line: &str| line.chars().take(BEFORE + FROM).map(shown).collect::<String>();
    let above = text[..start].trim_end_matches('\n').rsplit('\n').next().unwrap_or("");
    let number = text[..start].matches('\n').count();
    let skipped = text[start..span.start].chars().count().saturating_sub(BEFORE);
    let before: String = text[start..span.start].chars().skip(skipped).map(shown).collect();
    let from: String = text[span.start..end].trim_end_matches('\r').chars().take(FROM).map(shown).collect();
    let below = text.get(end + 1..).and_then(|rest| rest.lines().next());
    let mut excerpt = "\n".repeat(number.saturating_sub(1));
    if number > 0 {
        excerpt += &(beginning(above) + "\n");
    }
    excerpt += &before;
    let at = excerpt.len()..excerpt.len() + from.len();
    excerpt += &(from + "\n");
    excerpt.extend(below.map(|line| beginning(line) + "\n"));
    (excerpt, at)
}

/// The bytes of a line (from 1), beginning at a column (from 1).
fn span_of_line(text: &str, number: usize, column: Option<usize>) -> Range<usize> {
    let start: usize = text.split_inclusive('\n').take(number.saturating_sub(1)).map(str::len).sum();
    let length = text[start..].lines().next().map_or(0, str::len);
    let skipped = column.map_or(0, |c| c.saturating_sub(1)).min(length);
    let from = (start..=start + skipped).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(start);
    from..start + length
}

/// Colours, on a terminal.
#[derive(Clone, Copy)]
pub struct Ink(bool);

impl Ink {
    /// Colours for stderr.
    pub fn stderr() -> Self {
        Self(io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none())
    }

    /// Colours for stdout.
    pub fn stdout() -> Self {
        Self(io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none())
    }

    /// The escape code of a character that stands for a colour. [`harmless`] replaces these noncharacters, which occur
    /// in no valid text, so no text can steer a terminal by them.
    fn code(c: char) -> Option<&'static str> {
        match c {
            '\u{fdd0}' => Some("\x1b[0m"),
            '\u{fdd1}' => Some("\x1b[1;31m"),
            '\u{fdd2}' => Some("\x1b[1;32m"),
            '\u{fdd3}' => Some("\x1b[1m"),
            '\u{fdd4}' => Some("\x1b[2m"),
            _ => None,
        }
    }

    fn paint(self, colour: char, text: &str) -> String {
        if self.0 { format!("{colour}{text}\u{fdd0}") } else { text.to_owned() }
    }

    /// A text in red.
    pub fn red(self, text: &str) -> String {
        self.paint('\u{fdd1}', text)
    }

    /// A text in green.
    pub fn green(self, text: &str) -> String {
        self.paint('\u{fdd2}', text)
    }

    /// A bold text.
    pub fn bold(self, text: &str) -> String {
        self.paint('\u{fdd3}', text)
    }

    /// A dim text.
    pub fn dim(self, text: &str) -> String {
        self.paint('\u{fdd4}', text)
    }
}

/// A count with thin spaces between groups of three digits: 1 234 567.
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

/// A number with this many significant digits, without an exponent where that is readable.
pub fn number(x: f64, digits: usize) -> String {
    let short = format!("{x:.*e}", digits.saturating_sub(1));
    match short.parse::<f64>() {
        Ok(value) if value == 0.0 || (1e-4..1e15).contains(&value.abs()) => value.to_string(),
        Ok(value) => format!("{value:e}"),
        Err(_) => short,
    }
}

/// A place with nine significant digits.
pub fn place(at: impl Into<Place>) -> String {
    let coordinates: Vec<String> = at.into().coordinates().iter().map(|&x| number(x, 9)).collect();
    format!("({})", coordinates.join(", "))
}

/// "1 region", "2 regions".
pub fn plural(n: usize, one: &str, many: &str) -> String {
    format!("{} {}", count(n), if n == 1 { one } else { many })
}

/// "3 lines, 1 arc" from kinds and their counts.
pub fn kinds(kinds: &BTreeMap<&'static str, usize>) -> String {
    let parts: Vec<_> = kinds.iter().map(|(kind, n)| plural(*n, kind, &many(kind))).collect();
    if parts.is_empty() { "no curves".into() } else { parts.join(", ") }
}

fn many(kind: &str) -> String {
    match kind.strip_suffix('y') {
        _ if kind.ends_with('s') => kind.into(),
        Some(stem) => format!("{stem}ies"),
        None => format!("{kind}s"),
    }
}

/// "3 welds, 1 split" from repairs.
fn repair_kinds(repairs: &[Repair]) -> String {
    let mut kinds: BTreeMap<RepairKind, usize> = BTreeMap::new();
    for repair in repairs {
        *kinds.entry(repair.kind).or_default() += 1;
    }
    let counted = |(kind, n): (RepairKind, usize)| plural(n, kind.words()[0], kind.words()[1]);
    let parts: Vec<_> = kinds.into_iter().map(counted).collect();
    parts.join(", ")
}

/// The line of one repair.
fn repair_line(repair: &Repair) -> String {
    let size = if repair.size > 0.0 { format!(", by {}", number(repair.size, 3)) } else { String::new() };
    format!("{} {}{size}", place(repair.at), repair.what)
}

/// Prints the number of inputs with each exit code. `earlier` of them were done in an earlier run.
pub fn batch(exits: &BTreeMap<u8, usize>, earlier: usize, seconds: f64) {
    let inputs: usize = exits.values().sum();
    let before = if earlier > 0 { format!(", {} of them in an earlier run", count(earlier)) } else { String::new() };
    line(&format!("{} {}{before}, {seconds:.1} s", Ink::stderr().bold("squinch"), plural(inputs, "input", "inputs")));
    for (exit, n) in exits {
        let what = match exit {
            0 => "done, every guarantee holds",
            2 => "with options that do not fit",
            3 => "unreadable",
            4 => "geometry invalid",
            5 => "a requested bound missed, or a budget ran out",
            6 => "output not written",
            _ => "our bug",
        };
        line(&format!("  {:>8}  {what} ({exit})", count(*n)));
    }
}

/// Prints the end of a run: input, mesh and guarantees. Without a mesh the failure says all.
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
        row("mesh", &cells(mesh));
        let angles = match quality {
            QualityReport::Plane(q) => {
                format!("{:.2}° to {:.2}°{}", q.min_angle_deg, q.max_angle_deg, exemptions(q, report))
            }
            QualityReport::Space(q) => format!("dihedral, {:.2}° to {:.2}°", q.min_dihedral_deg, q.max_dihedral_deg),
        };
        row("angles", &angles);
    }
    if let Some(verdict) = &outcome.verdict {
        row("checks", &guarantees(verdict, ink));
        let shown = verdict.checks.iter().filter(|c| volume == Volume::Verbose || c.status == Status::Broken);
        shown.for_each(|check| check_lines(check, ink).iter().for_each(|text| line(text)));
    }
    stop_row(report, &row);
    row("time", &time(report));
    if !wrote.is_empty() {
        row("wrote", &wrote.join(", "));
    }
}

/// The counts of a mesh.
fn cells(mesh: &MeshReport) -> String {
    let vertices = plural(mesh.vertices, "vertex", "vertices");
    let triangles = plural(mesh.triangles, "triangle", "triangles");
    let edges = plural(mesh.boundary_edges, "edge", "edges");
    let regions = if mesh.regions.len() > 1 { format!(", {} regions", mesh.regions.len()) } else { String::new() };
    match mesh.tetrahedra {
        0 => format!("{vertices}, {triangles}, {edges} on curves{regions}"),
        n => {
            let tetrahedra = plural(n, "tetrahedron", "tetrahedra");
            format!("{vertices}, {tetrahedra}, {triangles} on facets, {edges} on segments{regions}")
        }
    }
}

fn input_rows(report: &Report, volume: Volume, row: &dyn Fn(&str, &str)) {
    let input = &report.input;
    let Some(format) = &input.format else { return };
    let unit = input.unit.as_ref().map_or_else(String::new, |unit| format!(", in {unit}"));
    let measure = match &report.quality {
        Some(QualityReport::Space(q)) => Some(("volume", q.exact_measure.unwrap_or(q.measure))),
        Some(QualityReport::Plane(q)) => q.exact_measure.map(|area| ("area", area)),
        None => None,
    };
    let area = measure.map_or_else(String::new, |(what, size)| format!(", {what} {}", number(size, 9)));
    row("input", &format!("{format}: {}{area}{unit}", kinds(&input.curves)));
    for skipped in &input.skipped {
        row("left out", &format!("{} {}: {}", skipped.count, skipped.entity, skipped.why));
    }
    note_rows(&input.notes, volume, row);
    repair_rows(&input.repairs, &input.unhealed, volume, &mut |name, text| row(name, text));
}

/// Prints notes about the input: a few, or all with `-v`.
fn note_rows(notes: &[String], volume: Volume, row: &dyn Fn(&str, &str)) {
    const FEW: usize = 4;
    let shown = if volume == Volume::Verbose { notes.len() } else { FEW };
    // Notes about an option (they begin with its dashes) answer the command line. They come first, and all of them are
    // printed.
    let (answers, remarks): (Vec<&String>, Vec<&String>) = notes.iter().partition(|note| note.starts_with("--"));
    answers.iter().chain(remarks.iter().take(shown)).for_each(|note| row("note", note));
    if remarks.len() > shown {
        row("", &format!("and {} (-v lists them)", plural(remarks.len() - shown, "note more", "notes more")));
    }
}

/// Prints repairs, and those that `--tolerance 0` left: counted by kinds, or one by one with `-v`.
pub fn repair_rows(repairs: &[Repair], unhealed: &[Repair], volume: Volume, row: &mut dyn FnMut(&str, &str)) {
    if volume == Volume::Verbose {
        repairs.iter().for_each(|repair| row("repair", &repair_line(repair)));
        unhealed.iter().for_each(|repair| row("unhealed", &repair_line(repair)));
        return;
    }
    if !repairs.is_empty() {
        row("repairs", &format!("{} (-v lists them)", repair_kinds(repairs)));
    }
    if !unhealed.is_empty() {
        row("unhealed", &format!("by default there would be {} (-v lists them)", repair_kinds(unhealed)));
    }
}

/// How many triangles are exempt from the smallest angle, and the smallest angle of the others.
fn exemptions(quality: &Quality, report: &Report) -> String {
    let Some(promise) = &report.promise else { return String::new() };
    let triangles = |n: usize| plural(n, "triangle", "triangles");
    let (by_size, corners): (Vec<_>, Vec<_>) = promise.excused.by_corner.iter().partition(|e| e.why == "min_edge");
    let cells = |exempt: &[&Exemption]| exempt.iter().map(|e| e.cells.len()).sum::<usize>();
    let mut parts = Vec::new();
    if !corners.is_empty() {
        let places = plural(corners.len(), "sharp corner", "sharp corners");
        parts.push(format!("{} at {places}", triangles(cells(&corners))));
    }
    if !by_size.is_empty() {
        parts.push(format!("{} not refined because of --min-edge", triangles(cells(&by_size))));
    }
    match parts.is_empty() {
        true => String::new(),
        false => format!("; from {:.2}° but for {}", quality.min_unexcused_angle_deg, parts.join(" and ")),
    }
}

/// "every guarantee holds, 3 proven; reached, not proven: …", or the broken checks.
pub fn guarantees(verdict: &Verdict, ink: Ink) -> String {
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
    format!("{}, {proven} proven{rest}", ink.green("every guarantee holds"))
}

/// The lines of a check: its worst value and its first flaws.
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
        StopReason::Cancelled => "it was cancelled",
        StopReason::TimedOut => "the time ran out",
        StopReason::Arithmetic => "the coordinates cannot hold a finer mesh",
        StopReason::NoProgress => "the angles got no larger",
    };
    let place = stop.places.first().map_or_else(String::new, |at| format!(", one at {}", place(*at)));
    row("stopped", &format!("{reason}; {} unresolved{place}", plural(stop.unresolved, "cell", "cells")));
    let quality = report.quality.as_ref().and_then(QualityReport::in_plane);
    let held = quality.map(|quality| quality.min_unexcused_angle_deg);
    if let (Some(angle), Some(held)) = (stop.angle_deg, held) {
        let held = format!("the mesh has {:.2}° or more outside of exempt places", (held * 100.0).floor() / 100.0);
        row("", &format!("{held}; --min-angle {angle} asks for no more than that"));
    }
}

fn time(report: &Report) -> String {
    let s = &report.seconds;
    let memory = report.peak_memory_bytes.map_or_else(String::new, |b| format!(", {:.0} MB", b as f64 / 1e6));
    format!(
        "{:.2} s (read {:.2}, arrange {:.2}, mesh {:.2}, verify {:.2}, write {:.2}){memory}",
        s.total, s.read, s.arrange, s.mesh, s.verify, s.write
    )
}

/// A progress line, on a terminal and for work that lasts.
pub struct Bar {
    begun: Instant,
    bar: Option<ProgressBar>,
    shown: bool,
}

impl Bar {
    /// Shorter work needs no progress line.
    const PATIENCE: Duration = Duration::from_millis(400);

    /// A bar that is not shown yet.
    pub fn new(volume: Volume) -> Self {
        Self { begun: Instant::now(), bar: None, shown: volume > Volume::Quiet && io::stderr().is_terminal() }
    }

    /// Shows progress.
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

/// The number of inputs of a batch that are done.
pub struct Count(Option<ProgressBar>);

impl Count {
    /// A bar for this number of inputs.
    pub fn new(volume: Volume, inputs: usize) -> Self {
        let shown = volume > Volume::Quiet && io::stderr().is_terminal();
        Self(shown.then(|| {
            let bar = ProgressBar::new(inputs as u64);
            let template = "{bar:40} {pos} of {len}  {elapsed}, {eta} to go";
            bar.set_style(ProgressStyle::with_template(template).expect("a right template"));
            bar
        }))
    }

    /// Counts an input.
    pub fn one_more(&self) {
        if let Some(bar) = &self.0 {
            bar.inc(1);
        }
    }

    /// Prints above the bar how an input failed.
    pub fn failed(&self, input: &str, ending: &str, advice: &str) {
        // If the file itself cannot be read, the message begins with its name.
        let named = if ending.starts_with(input) { String::new() } else { format!("{input}: ") };
        let say = || {
            error(&format!("{named}{ending}"));
            if !advice.is_empty() {
                help(advice);
            }
        };
        match &self.0 {
            Some(bar) => bar.suspend(say),
            None => say(),
        }
    }
}

impl Drop for Count {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
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
    fn nothing_of_a_file_steers_the_terminal() {
        assert_eq!(harmless("a\x1b[2J\tb\r\n\u{9b}c\u{202e}ä翼"), "a\\u{1b}[2J b\\u{d}\\u{a}\\u{9b}c\\u{202e}ä翼");
        assert_eq!(harmless(&Ink(true).red("x\x1b[0m")), "\x1b[1;31mx\\u{1b}[0m\x1b[0m");
        let long = harmless(&"ä".repeat(4_000_000));
        assert!(long.chars().count() < 4000 && long.contains("[…]"));
        assert_eq!(harmless(&"ä".repeat(3500)), "ä".repeat(3500));
    }

    #[test]
    fn an_excerpt_keeps_the_line_number_and_the_span() {
        let text = "one\ntwo\nth\x1bree four\r\nfive\nsix";
        let (shown, at) = excerpt(text, 14..18);
        assert_eq!(shown, "\ntwo\nth\\u{1b}ree four\nfive\n");
        assert_eq!(&shown[at], " four", "{shown}");
        let long = format!("first\n{}bad {}\n", "ä".repeat(1_000_000), "z".repeat(1_000_000));
        let bad = long.find("bad").unwrap();
        let (shown, at) = excerpt(&long, bad..long.len() - 1);
        assert!(shown.len() < 500 && shown[at].starts_with("bad z") && shown.starts_with("first\nä"), "{shown}");
        assert_eq!(excerpt("", 0..0), ("\n".into(), 0..0));
        assert_eq!(excerpt("a\n", 2..2), ("a\n\n".into(), 2..2));
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
