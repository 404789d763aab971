//! Reduces a drawing while its run ends the same way. The result shows the fault and little else.
//!
//! ```text
//!    1. drop whole chains        2. a line for a stretch of a chain      3. drop single curves, points, seeds, sizes
//!
//!       ┌──┐  ┌──┐     ┌──┐          ╭─╮ ╭─╮        ┌─────┐                 ┌──┐      ┌──┐
//!       │  │  │  │  ▶  │  │          │ ╰─╯ │   ▶    │     │                 │  │  ▶   │
//!       └──┘  └──┘     └──┘          └─────┘        └─────┘                 └──┘      └──┘
//!
//!    Each trial is a run. It is kept if it ends as the first run did. The steps repeat until nothing changes.
//! ```

use super::case::{Panic, caught};
use super::request::Request;
use super::{Extent, Outcome, ending, run_drawing};
use crate::curve::Curve;
use crate::domain::{Drawing, DrawnCurve};
use crate::watch::no_clock;

/// A drawing from which nothing more can be removed, or the best one within the budget.
#[derive(Clone, Debug)]
pub struct Reduced {
    /// What is left of the drawing.
    pub drawing: Drawing,
    /// How its run ends. The first run ended the same way.
    pub ending: String,
    /// Number of runs, with the first.
    pub runs: usize,
}

/// Removes whole chains, stretches of chains, then single curves, points, seeds and sizes, while the run ends the same
/// way, in at most `runs_max` runs. `tell` is called with the number of runs and the number of curves in the last one.
pub fn reduce(drawing: &Drawing, request: &Request, runs_max: usize, tell: &mut dyn FnMut(usize, usize)) -> Reduced {
    let ending = ending_of(drawing, request);
    let mut runs = 1;
    let mut same = |trial: &Drawing| {
        if runs >= runs_max {
            return false;
        }
        runs += 1;
        tell(runs, trial.curves.len());
        ending_of(trial, request) == ending
    };
    let mut drawing = drawing.clone();
    loop {
        let before = weight(&drawing);
        drop_parts(&mut drawing, chains, &mut same);
        shorten_chains(&mut drawing, &mut same);
        drop_parts(&mut drawing, singles, &mut same);
        if weight(&drawing) == before {
            return Reduced { drawing, ending, runs };
        }
    }
}

/// How the run of a drawing ends, also with a panic.
pub fn ending_of(drawing: &Drawing, request: &Request) -> String {
    ending_or_panic(&caught(|| run_drawing(drawing, request, Extent::Whole(&mut |_| true), &no_clock)))
}

/// How a run ended, also with a panic.
pub fn ending_or_panic(run: &Result<Outcome, Panic>) -> String {
    match run {
        Ok(outcome) => ending(outcome),
        Err(panic) => format!("panic: {panic}"),
    }
}

fn weight(drawing: &Drawing) -> usize {
    drawing.curves.len() + drawing.points.len() + drawing.seeds.len() + drawing.sizes.len()
}

/// A part of a drawing that can be dropped.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    /// Curves from the first index up to, not including, the last.
    Curves(usize, usize),
    Point(usize),
    Seed(usize),
    Size(usize),
}

fn singles(drawing: &Drawing) -> Vec<Part> {
    let curves = (0..drawing.curves.len()).map(|i| Part::Curves(i, i + 1));
    let points = (0..drawing.points.len()).map(Part::Point);
    let seeds = (0..drawing.seeds.len()).map(Part::Seed);
    let sizes = (0..drawing.sizes.len()).map(Part::Size);
    curves.chain(points).chain(seeds).chain(sizes).collect()
}

/// As [`singles`], but curves that follow each other end to end are one part.
fn chains(drawing: &Drawing) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for part in singles(drawing) {
        match (parts.last_mut(), &part) {
            (Some(Part::Curves(_, end)), Part::Curves(from, to)) if follows(drawing, *from) => {
                debug_assert_eq!(end, from);
                *end = *to;
            }
            _ => parts.push(part),
        }
    }
    parts
}

/// Whether curve `i` starts where the one before ends.
fn follows(drawing: &Drawing, i: usize) -> bool {
    i > 0 && drawing.curves[i - 1].curve.end() == drawing.curves[i].curve.start()
}

/// Drops parts of a drawing, where `parts_of` lists the parts.
fn drop_parts(drawing: &mut Drawing, parts_of: fn(&Drawing) -> Vec<Part>, same: &mut dyn FnMut(&Drawing) -> bool) {
    let whole = &*drawing;
    let kept = shrink(parts_of(whole), &mut |parts| same(&only(whole, parts)));
    *drawing = only(whole, &kept);
}

/// The drawing with only these parts, which are ascending.
fn only(drawing: &Drawing, parts: &[Part]) -> Drawing {
    let mut rest =
        Drawing { curves: Vec::new(), points: Vec::new(), seeds: Vec::new(), sizes: Vec::new(), ..drawing.clone() };
    for part in parts {
        match *part {
            Part::Curves(from, to) => rest.curves.extend_from_slice(&drawing.curves[from..to]),
            Part::Point(i) => rest.points.push(drawing.points[i].clone()),
            Part::Seed(i) => rest.seeds.push(drawing.seeds[i].clone()),
            Part::Size(i) => rest.sizes.push(drawing.sizes[i].clone()),
        }
    }
    rest
}

/// Replaces stretches of chains by straight lines, from long stretches to pairs of curves. So an outline stays closed.
fn shorten_chains(drawing: &mut Drawing, same: &mut dyn FnMut(&Drawing) -> bool) {
    let mut length = drawing.curves.len() / 2;
    while length >= 2 {
        let mut from = 0;
        while from + length <= drawing.curves.len() {
            match shortened(drawing, from, from + length) {
                Some(trial) if same(&trial) => *drawing = trial,
                _ => from += length.div_ceil(2),
            }
        }
        length = if length > 2 { length.div_ceil(2) } else { 1 };
    }
}

/// The drawing with a line in place of the curves from `from` up to, not including, `to`; `None` where they are not a
/// chain, or where the line would have length zero.
fn shortened(drawing: &Drawing, from: usize, to: usize) -> Option<Drawing> {
    let (first, last) = (&drawing.curves[from], &drawing.curves[to - 1]);
    if (from + 1..to).any(|i| !follows(drawing, i)) || first.curve.start() == last.curve.end() {
        return None;
    }
    let curve = Curve::line(first.curve.start(), last.curve.end()).ok()?;
    let mut trial = drawing.clone();
    trial.curves.splice(from..to, [DrawnCurve { curve, ..first.clone() }]);
    Some(trial)
}

/// The rest of `items` that still `fails` and from which no single item can be dropped (delta debugging, Zeller &
/// Hildebrandt 2002, by complements only).
fn shrink<T: Clone>(mut items: Vec<T>, fails: &mut dyn FnMut(&[T]) -> bool) -> Vec<T> {
    let mut chunk = items.len().div_ceil(2).max(1);
    loop {
        let mut dropped = false;
        let mut from = 0;
        while from < items.len() {
            let to = (from + chunk).min(items.len());
            let rest = [&items[..from], &items[to..]].concat();
            if fails(&rest) {
                items = rest;
                dropped = true;
            } else {
                from = to;
            }
        }
        if chunk > 1 {
            chunk = chunk.div_ceil(2);
        } else if !dropped {
            return items;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;

    /// A closed polygon of unit steps around a circle of this radius, so many times over beside each other.
    fn rings(n: usize, corners: usize) -> Drawing {
        let mut drawing = Drawing::default();
        for ring in 0..n {
            let corner = |i: usize| {
                let angle = std::f64::consts::TAU * (i % corners) as f64 / corners as f64;
                Point::new(3.0 * ring as f64 + libm::cos(angle), libm::sin(angle))
            };
            for i in 0..corners {
                let line = Curve::line(corner(i), corner(i + 1)).expect("corners differ");
                drawing.add(line, "rim", format!("ring {ring}, segment {i}"));
            }
        }
        drawing
    }

    #[test]
    fn only_what_the_fault_needs_is_left() {
        for culprits in [vec![], vec![0], vec![63], vec![3, 40], vec![10, 11, 12, 50]] {
            let mut tries = 0;
            let left = shrink((0..64).collect(), &mut |items| {
                tries += 1;
                culprits.iter().all(|c| items.contains(c))
            });
            assert_eq!(left, culprits);
            assert!(tries < 400, "{tries} tries");
        }
    }

    #[test]
    fn every_pair_is_found_whatever_its_place() {
        for a in 0..12 {
            for b in a + 1..12 {
                let left = shrink((0..12).collect(), &mut |items| items.contains(&a) && items.contains(&b));
                assert_eq!(left, [a, b]);
            }
        }
    }

    #[test]
    fn chains_are_found_and_shortened() {
        let drawing = rings(3, 40);
        assert_eq!(chains(&drawing), [Part::Curves(0, 40), Part::Curves(40, 80), Part::Curves(80, 120)]);
        let mut short = drawing.clone();
        let closed = |d: &Drawing| {
            chains(d).iter().all(|part| match *part {
                Part::Curves(from, to) => to > from + 2 && d.curves[to - 1].curve.end() == d.curves[from].curve.start(),
                _ => false,
            })
        };
        shorten_chains(&mut short, &mut |trial| closed(trial));
        assert_eq!(short.curves.len(), 9, "three triangles");
        assert!(closed(&short));
    }

    fn sized_of_nothing() -> Request {
        let mut request = Request::default();
        request.limits.size_of = vec!["nothing=1".parse().expect("a size")];
        request
    }

    #[test]
    fn a_run_is_reduced_to_the_part_that_ends_it() {
        // Two rings with a mesh, and a size for a name that does not exist. Any one triangle is enough for this error.
        let request = sized_of_nothing();
        let reduced = reduce(&rings(2, 12), &request, 500, &mut |_, _| {});
        assert!(reduced.ending.starts_with("request: "), "{}", reduced.ending);
        assert_eq!(reduced.drawing.curves.len(), 3, "{:?}", reduced.drawing.curves);
    }

    #[test]
    fn the_budget_ends_it_with_what_still_ends_alike() {
        let request = sized_of_nothing();
        let reduced = reduce(&rings(2, 12), &request, 3, &mut |_, _| {});
        assert_eq!(reduced.runs, 3);
        assert_eq!(ending_of(&reduced.drawing, &request), reduced.ending);
    }
}
