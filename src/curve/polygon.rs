//! Control polygons relative to an origin, polynomial or rational.

use super::bernstein;
use crate::geometry::Vec2;
use std::ops::{Add, Mul, Sub};

/// A point times its weight, and the weight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weighted {
    /// The point times the weight.
    pub at: Vec2,
    /// The weight, positive.
    pub weight: f64,
}

impl Weighted {
    /// The point itself.
    pub(super) fn point(self) -> Vec2 {
        self.at / self.weight
    }
}
impl Add for Weighted {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Weighted { at: self.at + o.at, weight: self.weight + o.weight }
    }
}
impl Sub for Weighted {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Weighted { at: self.at - o.at, weight: self.weight - o.weight }
    }
}
impl Mul<f64> for Weighted {
    type Output = Self;
    fn mul(self, k: f64) -> Self {
        Weighted { at: self.at * k, weight: self.weight * k }
    }
}

/// The control polygon of a part of a curve, relative to an origin.
#[derive(Clone, Debug)]
pub(super) enum Polygon {
    Plain(Vec<Vec2>),
    Rational(Vec<Weighted>),
}

impl Polygon {
    /// The point at t, relative to the origin.
    pub(super) fn value(&self, t: f64) -> Vec2 {
        match self {
            Polygon::Plain(c) => bernstein::value(c, t),
            Polygon::Rational(c) => bernstein::value(c, t).point(),
        }
    }

    /// The polygons of the parts over 0..t and t..1.
    pub(super) fn split(&self, t: f64) -> (Polygon, Polygon) {
        match self {
            Polygon::Plain(c) => {
                let (left, right) = bernstein::split(c, t);
                (Polygon::Plain(left), Polygon::Plain(right))
            }
            Polygon::Rational(c) => {
                let (left, right) = bernstein::split(c, t);
                (Polygon::Rational(left), Polygon::Rational(right))
            }
        }
    }

    /// The polygon of the part over t0..t1.
    pub(super) fn restricted(&self, t0: f64, t1: f64) -> Polygon {
        match self {
            Polygon::Plain(c) => Polygon::Plain(bernstein::restricted(c, t0, t1)),
            Polygon::Rational(c) => Polygon::Rational(bernstein::restricted(c, t0, t1)),
        }
    }

    /// The polygon of the curve followed the other way.
    pub(super) fn reversed(mut self) -> Polygon {
        match &mut self {
            Polygon::Plain(c) => c.reverse(),
            Polygon::Rational(c) => c.reverse(),
        }
        self
    }

    /// The control points. The curve lies in their convex hull.
    pub(super) fn points(&self) -> Vec<Vec2> {
        match self {
            Polygon::Plain(c) => c.clone(),
            Polygon::Rational(c) => c.iter().map(|p| p.point()).collect(),
        }
    }

    /// Control points times their weights.
    pub(super) fn numerators(&self) -> Vec<Vec2> {
        match self {
            Polygon::Plain(c) => c.clone(),
            Polygon::Rational(c) => c.iter().map(|p| p.at).collect(),
        }
    }

    /// The weights; `None` for a polynomial curve.
    pub(super) fn weights(&self) -> Option<Vec<f64>> {
        match self {
            Polygon::Plain(_) => None,
            Polygon::Rational(c) => Some(c.iter().map(|p| p.weight).collect()),
        }
    }

    /// The coefficients of (form(point) + constant) times the denominator, which has the sign of the form plus the
    /// constant.
    pub(super) fn linear_form(&self, form: impl Fn(Vec2) -> f64, constant: f64) -> Vec<f64> {
        match self {
            Polygon::Plain(c) => c.iter().map(|p| form(*p) + constant).collect(),
            Polygon::Rational(c) => c.iter().map(|p| form(p.at) + constant * p.weight).collect(),
        }
    }
}
