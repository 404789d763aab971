//! The protecting balls, and which of them may exempt a triangle.
//!
//! ```text
//!         ╱ `.
//!       ╱     :             nearest other point q of P: |pq| = lfs₀(p)
//!     p ─ d ──┤·········● q
//!       ╲     :             ball_radius: d ≤ (√2 − 1)·lfs₀(p), and no two balls meet
//!         ╲ .´              lfs_ratio:   lfs(p) ≤ C₀·d
//! ```

use super::Check;
use super::Status;
use super::evidence::{Evidence, place};
use super::tally::Tally;
use crate::domain::Domain;
use crate::geometry::boxes::{BoxHierarchy, Labels};
use crate::geometry::{Point, Rect};
use crate::ids::{IdVec, PointId};
use crate::mesh::{Ball, BallReason};
use crate::size::SizeField;
use std::f64::consts::SQRT_2;

/// C₀ = 1 + √2, the grading constant of Lemma 4.
const GRADING: f64 = 1.0 + SQRT_2;

/// A radius is a quotient of rounded distances, with an error of a few ε; 1e-12 is far above it.
const RADIUS: f64 = 1.0 + 1e-12;

/// A ball that passed `ball_radius` and `lfs_ratio`: it may exempt triangles.
#[derive(Clone, Copy, Debug)]
pub struct SoundBall {
    /// The place of its corner.
    pub center: Point,
    /// In units of the drawing.
    pub radius: f64,
    /// What set the radius, as the report spells it.
    pub why: &'static str,
}

/// `ball_radius`, `lfs_ratio` and the balls that passed both. A foreign mesh has no balls of its own. There every acute
/// corner gets the largest one, of radius (√2−1)·lfs₀, and nothing is checked.
pub fn check(ev: &Evidence, domain: &Domain) -> (Check, Check, Vec<SoundBall>) {
    let lfs0 = domain.lfs0();
    if ev.promise.foreign {
        return (Check::not_asked("ball_radius"), Check::not_asked("lfs_ratio"), largest_balls(domain, &lfs0));
    }
    let (ball_radius, well_placed) = radius(ev, domain, &lfs0);
    let (lfs_ratio, well_graded) = ratio(ev, domain);
    let balls = ev.mesh.balls.iter().zip(well_placed.iter().zip(well_graded));
    let sound = balls.filter(|(_, (placed, graded))| **placed && *graded);
    let sound =
        sound.map(|(b, _)| SoundBall { center: domain.points()[b.corner], radius: b.radius, why: reason(b.why) });
    (ball_radius, lfs_ratio, sound.collect())
}

fn largest_balls(domain: &Domain, lfs0: &IdVec<PointId, f64>) -> Vec<SoundBall> {
    let acute = domain.points().enumerate().filter(|(p, _)| domain.is_acute(*p));
    let why = reason(BallReason::LocalFeatureSize);
    acute.map(|(p, &center)| SoundBall { center, radius: lfs0[p] / GRADING, why }).collect()
}

fn reason(why: BallReason) -> &'static str {
    match why {
        BallReason::LocalFeatureSize => "local_feature_size",
        BallReason::Encroached => "encroached",
        BallReason::Size => "size",
    }
}

fn tell(domain: &Domain, ball: &Ball) -> String {
    let p = ball.corner;
    format!("the ball of radius {} around point {} at {}", ball.radius, p.0, place(domain.points()[p]))
}

/// Every ball is around an acute corner, no larger than (√2−1)·lfs₀, and meets no other. Worst: the largest d/lfs₀.
fn radius(ev: &Evidence, domain: &Domain, lfs0: &IdVec<PointId, f64>) -> (Check, Vec<bool>) {
    let mut tally = Tally::highest("ball_radius");
    let met = balls_that_meet(ev, domain);
    let mut placed = Vec::with_capacity(ev.mesh.balls.len());
    for (ball, met) in ev.mesh.balls.iter().zip(met) {
        tally.count();
        let largest = lfs0[ball.corner] / GRADING;
        tally.measure(ball.radius / lfs0[ball.corner], domain.points()[ball.corner]);
        let flaw = if !(ball.radius > 0.0 && ball.radius.is_finite()) {
            Some("is none".to_owned())
        } else if !domain.is_acute(ball.corner) {
            Some("is around a corner that is not acute".to_owned())
        } else if ball.radius > largest * RADIUS {
            Some(format!("is larger than {largest}"))
        } else {
            met.map(|other| format!("meets the ball around point {}", other.0))
        };
        placed.push(flaw.is_none());
        if let Some(flaw) = flaw {
            tally.flaw(|| format!("{} {flaw}", tell(domain, ball)));
        }
    }
    (tally.finish(Status::Proven), placed)
}

/// For each ball the corner of a ball that it meets.
fn balls_that_meet(ev: &Evidence, domain: &Domain) -> Vec<Option<PointId>> {
    let balls = &ev.mesh.balls;
    let center = |i: usize| domain.points()[balls[i].corner];
    let mut met = vec![None; balls.len()];
    // A radius that is not finite has a box of size 0 here; `radius` reports it.
    let size = |r: f64| if r.is_finite() { 2.0 * r.abs() } else { 0.0 };
    let boxes =
        (0..balls.len()).map(|i| Rect::from_center_size(center(i), (size(balls[i].radius), size(balls[i].radius))));
    BoxHierarchy::new(boxes).pairs(
        |_| Labels::default(),
        |i, j| {
            if center(i).distance(center(j)) <= balls[i].radius + balls[j].radius {
                met[i] = Some(balls[j].corner);
                met[j] = Some(balls[i].corner);
            }
        },
    );
    met
}

/// lfs(p) ≤ C₀·d(p) (Lemma 4; with corner arcs C₀ = max(1+√2, 1.5/β)). Balls that a size limit capped are exempt, where
/// there is such a limit. Worst: the largest lfs/d.
fn ratio(ev: &Evidence, domain: &Domain) -> (Check, Vec<bool>) {
    let mut tally = Tally::highest("lfs_ratio");
    let lfs = domain.lfs();
    let beta = ev.promise.lopping().filter(|lopping| lopping.arc_turning_rad.is_some()).map(|lopping| lopping.beta);
    let grading = beta.map_or(GRADING, |beta| GRADING.max(1.5 / beta));
    let field = SizeField::new(&ev.promise.sizing, domain);
    let lfs0 = domain.lfs0();
    // The engine computed it by the same steps from the same numbers, but for the scale: 1e-9 is above any rounding in
    // between.
    let capped = |ball: &Ball| {
        let largest = field.largest_ball(domain, ball.corner, lfs0[ball.corner] / GRADING);
        ball.radius >= largest * (1.0 - 1e-9)
    };
    let mut graded = Vec::with_capacity(ev.mesh.balls.len());
    for ball in &ev.mesh.balls {
        if ball.why == BallReason::Size && capped(ball) {
            tally.exempt();
            graded.push(true);
            continue;
        }
        tally.count();
        let ratio = lfs[ball.corner] / ball.radius;
        tally.measure(ratio, domain.points()[ball.corner]);
        let holds = ratio <= grading * RADIUS;
        graded.push(holds);
        if !holds {
            let unasked =
                if ball.why == BallReason::Size { " (capped for size, but no size asked for that)" } else { "" };
            tally.flaw(|| format!("{} is too small: lfs is {ratio} times as large{unasked}", tell(domain, ball)));
        }
    }
    (tally.finish(Status::Proven), graded)
}
