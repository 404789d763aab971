//! Angles of arcs: sweeps, the angles that they pass, and the parameter of a conic.

use super::CurveError;
use std::f64::consts::TAU;

/// A sweep in radians, if it is not 0 and at most once around; nearly ±2π becomes exactly ±2π.
pub(super) fn checked_sweep(sweep_rad: f64) -> Result<f64, CurveError> {
    // Readers compute 2π from degrees or as a difference of angles: it is a few units in the last place off.
    let full = TAU * (1.0 + 16.0 * f64::EPSILON);
    if sweep_rad == 0.0 || sweep_rad.abs() > full {
        return Err(CurveError::Sweep { sweep_rad });
    }
    let nearly_full = sweep_rad.abs() >= TAU * (1.0 - 16.0 * f64::EPSILON);
    Ok(if nearly_full { TAU.copysign(sweep_rad) } else { sweep_rad })
}

/// Parameters t in t0..t1 (open) at which start + sweep·t equals `angle` modulo `period`, ascending.
///
/// ```text
///             90°
///           ╭──●──╮            An arc from 30° with a sweep of 200° passes the angles 90° and 180° of period 90°.
///          ╱       ╲           There y and x of a circle are extreme.
///    180° ●    ·    ╲ start
///          ╲
///           end
/// ```
pub(super) fn passages(start_rad: f64, sweep_rad: f64, angle: f64, period: f64, t0: f64, t1: f64) -> Vec<f64> {
    let (from, to) = (start_rad + sweep_rad * t0, start_rad + sweep_rad * t1);
    let (low, high) = if from < to { (from, to) } else { (to, from) };
    let first = libm::ceil((low - angle) / period);
    // A sweep of 2π passes an angle modulo π/2 (the shortest period in use) at most five times.
    let mut found: Vec<f64> = (0..5)
        .map(|k| angle + (first + f64::from(k)) * period)
        .take_while(|passage| *passage <= high)
        .map(|passage| (passage - start_rad) / sweep_rad)
        .filter(|t| *t > t0 && *t < t1)
        .collect();
    found.sort_by(f64::total_cmp);
    found
}

/// φ − sin φ without cancellation.
pub(super) fn angle_minus_sine(phi: f64) -> f64 {
    if phi.abs() > 1.0 {
        return phi - libm::sin(phi);
    }
    // Taylor; the term after φ²¹ is below 1/23! < 2⁻⁷⁴ of the first.
    let mut term = phi * phi * phi / 6.0;
    let mut sum = 0.0;
    let mut k = 4.0;
    for _ in 0..10 {
        sum += term;
        term *= -phi * phi / (k * (k + 1.0));
        k += 2.0;
    }
    sum
}

/// The share of its whole angle that a rational quadratic arc has covered at its parameter s; `half` is half of that
/// angle, in radians.
pub(super) fn conic_parameter(s: f64, half: f64) -> f64 {
    let (sin, cos) = libm::sincos(half);
    libm::atan2(s * sin, (1.0 - s) + s * cos) / half
}
