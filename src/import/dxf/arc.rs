//! Circles, ellipses and their arcs.

use super::figure::{Figure, Level, Notices, Refusal, built, single};
use super::plane::{FLAT, Plane, cross};
use super::sections::Record;
use crate::curve::Curve;
use crate::geometry::{Point, Vec2};
use std::f64::consts::TAU;

/// Largest missing part of a full turn: 2π written with six decimals.
const CLOSING: f64 = 1e-7;
/// Largest missing part where the angles have few digits.
const LARGEST_CLOSING: f64 = 1e-3;

/// The counter-clockwise sweep from one angle to another, as a positive part of a turn. It is a full turn where the
/// angles are equal, or where the missing part is within two units of the last decimal of the angles.
pub(super) fn sweep(from: f64, to: f64, turn: f64, last_decimal: f64, notices: &mut Notices) -> f64 {
    let sweep = (to - from).rem_euclid(turn);
    let is_whole = |missing: f64| sweep > turn - missing || sweep == 0.0 || (to - from).abs() >= turn - missing;
    if is_whole(CLOSING * turn) {
        return turn;
    }
    if is_whole((2.0 * last_decimal).min(LARGEST_CLOSING * turn)) {
        notices.add("Arcs that miss a full turn by no more than their last decimal can tell are full.");
        return turn;
    }
    sweep
}

/// An ARC or CIRCLE.
pub(super) fn arc(record: &Record, notices: &mut Notices) -> Result<Figure<'static>, Refusal> {
    let plane = Plane::of(record)?;
    let [x, y, z] = record.point(10)?;
    let (center, radius) = (Point::new(x, y), record.required(40)?);
    let curve = if record.kind == "CIRCLE" {
        Curve::circle(center, radius)
    } else {
        let (from, to) = (record.required(50)?, record.required(51)?);
        let sweep = sweep(from, to, 360.0, record.last_decimal(&[50, 51]), notices);
        Curve::arc(center, radius, from.to_radians(), sweep.to_radians())
    };
    // The ends lie at the rounded angles.
    let angle = radius * record.last_decimal(&[50, 51]).to_radians();
    let last_decimal = record.last_decimal(&[10, 20, 40]).max(angle);
    Ok(single(plane.place(built(record, curve)?, z), plane.level(z), last_decimal))
}

/// An ELLIPSE. Its center and axis are coordinates of the drawing; the extrusion direction only gives the sense of the
/// minor axis.
pub(super) fn ellipse(record: &Record, notices: &mut Notices) -> Result<Figure<'static>, Refusal> {
    let plane = Plane::of(record)?;
    let ([x, y, z], axis) = (record.point(10)?, record.point(11)?);
    let major = Vec2::new(axis[0], axis[1]);
    let leaves = axis[2].abs() > FLAT * axis[0].abs().max(axis[1].abs());
    let [ux, uy, _] = cross(plane.normal(), if leaves { axis } else { [axis[0], axis[1], 0.0] });
    let minor = Vec2::new(ux, uy) * record.required(40)?;
    let (from, to) = (record.real(41, 0.0)?, record.real(42, TAU)?);
    let sweep = sweep(from, to, TAU, record.last_decimal(&[41, 42]), notices);
    let curve = Curve::ellipse(Point::new(x, y), major, minor, from, sweep);
    let level = match plane.level(z) {
        Level::At(_) if !leaves => Level::At(z),
        Level::At(_) | Level::Leaves => Level::Leaves,
    };
    let rounded = record.last_decimal(&[40]).max(record.last_decimal(&[41, 42]));
    let last_decimal = record.last_decimal(&[10, 20, 11, 21]).max(major.hypot() * rounded);
    Ok(single(built(record, curve)?, level, last_decimal))
}
