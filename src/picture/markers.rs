//! Markers of repairs. Each kind has a shape, of one size. Where markers would overlap, one stands for several and has
//! their number beside it.

use super::PictureOptions;
use super::canvas::Colour;
use super::frame::Frame;
use super::path::{Pixel, px};
use super::words::counted_words;
use crate::domain::{Repair, RepairKind};
use crate::geometry::Point;
use std::collections::BTreeMap;

/// More markers would cover the drawing.
const MARKERS_MAX: usize = 250;
const REPAIRED: Colour = Colour::hex(0x7a1fa2);
const LEFT: Colour = Colour::hex(0xc2187e);

/// The kind of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Mended {
    /// Whether the flaw was found but not repaired.
    pub left: bool,
    kind: RepairKind,
}

impl Mended {
    /// The colour of the marker.
    pub fn colour(self) -> Colour {
        if self.left { LEFT } else { REPAIRED }
    }

    /// The marker around a place as a polyline, and whether it is closed. Each kind has a different shape.
    pub fn shape(self, at: Pixel, radius: f64) -> (Vec<Pixel>, bool) {
        let corners = |turns: &[f64], reach: &[f64]| -> Vec<Pixel> {
            let corner = |(k, turn): (usize, &f64)| {
                let (sin, cos) = libm::sincos(turn * std::f64::consts::TAU);
                let r = radius * reach[k % reach.len()];
                px(at.x + r * cos, at.y + r * sin)
            };
            turns.iter().enumerate().map(corner).collect()
        };
        // Corners from the top on, clockwise on the page.
        let regular = |n: u32, first: f64, reach: &[f64]| {
            corners(&(0..n).map(|k| first + f64::from(k) / f64::from(n)).collect::<Vec<_>>(), reach)
        };
        let boxed = |places: &[[f64; 2]]| -> Vec<Pixel> {
            places.iter().map(|[x, y]| px(at.x + radius * x, at.y + radius * y)).collect()
        };
        match self.kind {
            RepairKind::ToleranceRaised => (regular(10, -0.25, &[1.3, 0.55]), true),
            RepairKind::Weld => (regular(24, 0.0, &[0.9]), true),
            RepairKind::GapClosed => (regular(4, 0.125, &[1.15]), true),
            RepairKind::Split => (regular(3, -0.25, &[1.1]), true),
            RepairKind::SelfSplit => (regular(3, 0.25, &[1.1]), true),
            RepairKind::Corner => (regular(4, 0.0, &[1.1]), true),
            RepairKind::Duplicate => (boxed(&[[-1.2, -0.5], [1.2, -0.5], [1.2, 0.5], [-1.2, 0.5]]), true),
            RepairKind::Overlap => (boxed(&[[-1.2, 0.5], [-0.4, -0.5], [1.2, -0.5], [0.4, 0.5]]), true),
            RepairKind::ZeroLength => (boxed(&[[-0.8, -1.0], [0.8, 1.0], [0.8, -1.0], [-0.8, 1.0]]), true),
            RepairKind::Collapsed => (regular(6, 0.0, &[1.0]), true),
            RepairKind::Hidden => (boxed(&[[-1.2, 0.0], [1.2, 0.0]]), false),
            RepairKind::Seed => (boxed(&[[0.0, -1.1], [0.0, 1.1], [0.0, 0.0], [-1.1, 0.0], [1.1, 0.0]]), false),
        }
    }
}

/// A marker, with the number of repairs that it stands for.
#[derive(Clone, Copy)]
pub struct Marker {
    /// The kind.
    pub mended: Mended,
    /// The place in the drawing.
    pub at: Point,
    /// Number of repairs.
    pub count: usize,
}

/// Legend entries of the repairs in `options`: each kind with its number.
pub fn entries(options: &PictureOptions) -> Vec<(Mended, String)> {
    let mut counts: BTreeMap<Mended, usize> = BTreeMap::new();
    mended(options).for_each(|(mended, _)| *counts.entry(mended).or_default() += 1);
    let entry = |(mended, count): (Mended, usize)| {
        let words = counted_words(count, mended.kind.words());
        (mended, if mended.left { format!("left as it is: {words}") } else { words })
    };
    counts.into_iter().map(entry).collect()
}

/// The repairs in `options`, with their kinds.
pub fn mended(options: &PictureOptions) -> impl Iterator<Item = (Mended, &Repair)> {
    let of = |repairs, left| <[Repair]>::iter(repairs).map(move |r| (Mended { left, kind: r.kind }, r));
    of(&options.repairs, false).chain(of(&options.unhealed, true))
}

/// Markers in the window. All repairs within one cell of a grid share a marker, of the rarest kind among them and at
/// its place. The cells are as wide as a marker and its gap, enlarged until there are few enough markers.
pub fn markers(frame: &Frame, options: &PictureOptions, width: f64) -> Vec<Marker> {
    let seen: Vec<(Mended, Point, Pixel)> = mended(options)
        .map(|(mended, repair)| (mended, Point::new(repair.at[0], repair.at[1])))
        .map(|(mended, at)| (mended, at, frame.pixel(at)))
        .filter(|(_, _, pixel)| frame.sees(&[*pixel]))
        .collect();
    let mut totals: BTreeMap<Mended, usize> = BTreeMap::new();
    seen.iter().for_each(|(mended, ..)| *totals.entry(*mended).or_default() += 1);
    let mut cell = width;
    loop {
        let mut cells: BTreeMap<[i64; 2], Marker> = BTreeMap::new();
        for &(mended, at, pixel) in &seen {
            let place = [pixel.x, pixel.y].map(|x| (x / cell).floor() as i64);
            let marker = cells.entry(place).or_insert(Marker { mended, at, count: 0 });
            let count = marker.count + 1;
            let rarer = totals[&mended] < totals[&marker.mended];
            *marker = if rarer { Marker { mended, at, count } } else { Marker { count, ..*marker } };
        }
        // A cell wider than any picture holds all markers.
        if cells.len() <= MARKERS_MAX || cell > 1e4 {
            return cells.into_values().collect();
        }
        cell *= 1.5;
    }
}
