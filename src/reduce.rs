//! Shrinks a drawing while a run of it ends the same way: what is left shows the fault and little else.

use crate::case::{Panic, caught};
use crate::domain::Drawing;
use crate::pipeline::{Extent, Outcome, ending, run_drawing};
use crate::request::Request;

/// A drawing from which nothing more could be dropped, or not within the budget.
#[derive(Clone, Debug)]
pub struct Reduced {
    pub drawing: Drawing,
    /// How its run ends, as the first did.
    pub ending: String,
    pub runs: usize,
}

/// One thing that can be dropped from a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    Curve(usize),
    Point(usize),
    Seed(usize),
    Size(usize),
}

/// Drops curves, points, seeds and size requests while the run ends the same way, in at most `runs_max` runs.
/// `tell` hears how many runs there were and how many parts are left.
pub fn reduce(drawing: &Drawing, request: &Request, runs_max: usize, tell: &mut dyn FnMut(usize, usize)) -> Reduced {
    let ending = ending_of(drawing, request);
    let mut runs = 1;
    let kept = shrink(parts(drawing), runs_max, &mut |parts| {
        runs += 1;
        tell(runs, parts.len());
        ending_of(&only(drawing, parts), request) == ending
    });
    Reduced { drawing: only(drawing, &kept), ending, runs }
}

/// How the run of a drawing ends, panics included.
pub fn ending_of(drawing: &Drawing, request: &Request) -> String {
    ending_or_panic(&caught(|| run_drawing(drawing, request, Extent::Whole(&mut |_| true))))
}

/// How a run ended that may have broken down.
pub fn ending_or_panic(run: &Result<Outcome, Panic>) -> String {
    match run {
        Ok(outcome) => ending(outcome),
        Err(panic) => format!("panic: {panic}"),
    }
}

fn parts(drawing: &Drawing) -> Vec<Part> {
    let curves = (0..drawing.curves.len()).map(Part::Curve);
    let points = (0..drawing.points.len()).map(Part::Point);
    let seeds = (0..drawing.seeds.len()).map(Part::Seed);
    let sizes = (0..drawing.sizes.len()).map(Part::Size);
    curves.chain(points).chain(seeds).chain(sizes).collect()
}

/// The drawing with these parts (ascending) and no other.
fn only(drawing: &Drawing, parts: &[Part]) -> Drawing {
    let mut rest =
        Drawing { curves: Vec::new(), points: Vec::new(), seeds: Vec::new(), sizes: Vec::new(), ..drawing.clone() };
    for part in parts {
        match *part {
            Part::Curve(i) => rest.curves.push(drawing.curves[i].clone()),
            Part::Point(i) => rest.points.push(drawing.points[i].clone()),
            Part::Seed(i) => rest.seeds.push(drawing.seeds[i].clone()),
            Part::Size(i) => rest.sizes.push(drawing.sizes[i].clone()),
        }
    }
    rest
}

/// A part of `items` that still `fails` and from which no single item can be dropped, unless `tries` end first
/// (delta debugging, Zeller & Hildebrandt 2002, by complements only).
fn shrink<T: Copy>(mut items: Vec<T>, mut tries: usize, fails: &mut dyn FnMut(&[T]) -> bool) -> Vec<T> {
    let mut chunk = items.len().div_ceil(2).max(1);
    loop {
        let mut dropped = false;
        let mut from = 0;
        while from < items.len() {
            let Some(left) = tries.checked_sub(1) else { return items };
            tries = left;
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

    #[test]
    fn only_what_the_fault_needs_is_left() {
        for culprits in [vec![], vec![0], vec![63], vec![3, 40], vec![10, 11, 12, 50]] {
            let mut tries = 0;
            let left = shrink((0..64).collect(), 10_000, &mut |items| {
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
                let left = shrink((0..12).collect(), 10_000, &mut |items| items.contains(&a) && items.contains(&b));
                assert_eq!(left, [a, b]);
            }
        }
    }

    #[test]
    fn the_budget_ends_it_with_what_still_fails() {
        let left = shrink((0..1000).collect(), 5, &mut |items| items.contains(&700));
        assert!(left.contains(&700) && left.len() < 1000);
    }
}
