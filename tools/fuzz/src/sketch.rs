//! Drawings that a fuzzer can learn to make hard: a few curves of all kinds whose places repeat, nearly repeat, lie on earlier curves,
//! on their tangents, or around their centers.

use arbitrary::{Arbitrary, Result, Unstructured};
use kurbo::Affine;
use squinch::curve::{Curve, End};
use squinch::domain::{ArrangeOptions, Drawing, DrawnPoint, FillRule, Seed, SeedKind, Shape};
use squinch::geometry::{Point, Vec2, direction};
use squinch::import::outline;
use squinch::run::request::{Keep, Order, Request};
use std::f64::consts::{PI, TAU};

/// More than this adds nothing but time.
const CURVES: usize = 10;

/// A drawing, and how it is arranged and meshed.
pub struct Sketch {
    pub drawing: Drawing,
    fill: Option<FillRule>,
    keep_all: bool,
    tolerance: Option<f64>,
    min_angle: f64,
    order: Order,
}

/// As an outline, which the command line reads; the options of the run as its title.
impl std::fmt::Debug for Sketch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let options = [
            self.tolerance.map(|t| format!("--tolerance {t:e}")),
            self.keep_all.then(|| "--keep all".into()),
            Some(format!("--min-angle {} --order {}", self.min_angle, u64::from(self.order))),
        ];
        let title = options.into_iter().flatten().collect::<Vec<_>>().join(" ");
        f.write_str(&outline::to_json(&Drawing { title, ..self.drawing.clone() }))
    }
}

impl Sketch {
    pub fn arrange_options(&self) -> ArrangeOptions {
        ArrangeOptions {
            tolerance: self.tolerance,
            fill: self.fill,
            keep_all: self.keep_all,
            ..ArrangeOptions::default()
        }
    }

    pub fn request(&self, max_vertices: usize) -> Request {
        Request {
            keep: if self.keep_all { Keep::All } else { Keep::Inside },
            tolerance: self.tolerance,
            min_angle: self.min_angle,
            order: self.order,
            max_vertices,
            ..Request::default()
        }
    }
}

impl<'a> Arbitrary<'a> for Sketch {
    fn arbitrary(bytes: &mut Unstructured<'a>) -> Result<Self> {
        let fill = *bytes.choose(&[
            Some(FillRule::Regions),
            Some(FillRule::EvenOdd),
            Some(FillRule::NonZero),
            Some(FillRule::Regions),
            Some(FillRule::Shapes),
        ])?;
        let keep_all = bytes.ratio(1, 8)?;
        let tolerance = *bytes.choose(&[None, None, None, Some(0.0), Some(1e-6), Some(1e-3)])?;
        let min_angle = *bytes.choose(&[20.7, 0.0, 30.0])?;
        let order = if bytes.ratio(1, 8)? { Order::Second } else { Order::First };
        let mut pen = Pen { bytes, curves: Vec::new(), places: Vec::new() };
        while pen.curves.len() < CURVES && !pen.bytes.is_empty() {
            pen.draw()?;
        }
        let Pen { curves, places, .. } = pen;
        let mut drawing = Drawing { format: "sketch".into(), ..Drawing::default() };
        drawing.fill = fill.unwrap_or_default();
        for (i, curve) in curves.into_iter().enumerate() {
            match fill {
                Some(FillRule::Shapes) => add_shape(&mut drawing, curve, i),
                _ => drawing.add(curve, NAMES[i % 3], format!("curve {i}")),
            }
        }
        if let [.., place] = places[..] {
            match bytes.int_in_range(0..=15)? {
                0 => drawing.points.push(DrawnPoint { at: place, name: None, entity: "point".into() }),
                1 => drawing.seeds.push(Seed { at: place, kind: SeedKind::Hole, entity: "hole".into() }),
                _ => {}
            }
        }
        Ok(Self { drawing, fill, keep_all, tolerance, min_angle, order })
    }
}

const NAMES: [&str; 3] = ["a", "b", "c"];

/// Adds what a curve and its chord enclose as a shape of its own.
fn add_shape(drawing: &mut Drawing, curve: Curve, i: usize) {
    let (name, entity) = (drawing.names.intern(&format!("shape {i}")), format!("shape {i}"));
    let shape = drawing.shapes.push(Shape::new(name, i % 2 == 0, entity));
    let chord = Curve::line(curve.end(), curve.start()).ok();
    for side in [curve].into_iter().chain(chord) {
        drawing.add(side, NAMES[i % 3], format!("side of shape {i}"));
        drawing.curves.last_mut().expect("one was added").shape = Some(shape);
    }
}

struct Pen<'u, 'a> {
    bytes: &'u mut Unstructured<'a>,
    curves: Vec<Curve>,
    /// Every place so far.
    places: Vec<Point>,
}

impl Pen<'_, '_> {
    /// Draws one curve; what cannot be built is left out.
    fn draw(&mut self) -> Result<()> {
        let curve = match self.bytes.int_in_range(0..=15)? {
            0 | 1 => Curve::line(self.place()?, self.place()?),
            2 | 3 => Curve::circle(self.place()?, self.radius()?),
            4 => Curve::arc(self.place()?, self.radius()?, self.angle()?, self.angle()?),
            5 => Curve::bulge(self.place()?, self.place()?, self.parameter()? * 4.0 - 2.0),
            6 => Curve::arc_through(self.place()?, self.place()?, self.place()?),
            7 => {
                let (center, u) = (self.place()?, direction(self.angle()?) * self.radius()?);
                let v = Vec2::new(-u.y, u.x) * (0.001 + self.parameter()?);
                Curve::ellipse(center, u, v, self.angle()?, self.angle()?)
            }
            8 | 9 => {
                let degree = *self.bytes.choose(&[2, 3, 3, 3, 4, 1])?;
                Curve::bezier(self.several(degree + 1)?)
            }
            10 => {
                let degree = self.bytes.int_in_range(2..=3)?;
                let (points, mut weights) = (self.several(degree + 1)?, Vec::new());
                for _ in 0..=degree {
                    weights.push(*self.bytes.choose(&[1.0, 0.5, 2.0, 1e-3, 100.0])?);
                }
                Curve::rational_bezier(points, weights)
            }
            11 => {
                let n = self.bytes.int_in_range(2..=6)?;
                Curve::natural_spline(&self.several(n)?)
            }
            12 => {
                let n = self.bytes.int_in_range(3..=6)?;
                Curve::periodic_spline(&self.several(n)?)
            }
            13 => {
                let points = self.several(6)?;
                let inner = *self.bytes.choose(&[[1.0, 2.0], [1.0, 1.0], [1.0, 1.0 + 1e-9]])?;
                let knots = [0.0, 0.0, 0.0, 0.0, inner[0], inner[1], 3.0, 3.0, 3.0, 3.0];
                Curve::nurbs(3, &knots, &points, None)
            }
            14 => return self.polygon(),
            _ => return self.again(),
        };
        self.curves.extend(curve.ok());
        Ok(())
    }

    /// A closed chain of lines.
    fn polygon(&mut self) -> Result<()> {
        let n = self.bytes.int_in_range(3..=5)?;
        let corners = self.several(n)?;
        let sides = (0..n).filter_map(|i| Curve::line(corners[i], corners[(i + 1) % n]).ok());
        self.curves.extend(sides);
        Ok(())
    }

    /// An earlier curve once more, or a part of it, or it moved a little, or turned, or with other ends.
    fn again(&mut self) -> Result<()> {
        let Some(curve) = self.earlier()? else { return Ok(()) };
        let again = match self.bytes.int_in_range(0..=5)? {
            0 => curve,
            1 => curve.reversed(),
            2 => {
                let (t, u) = (self.parameter()?, self.parameter()?);
                if t == u {
                    return Ok(());
                }
                curve.part(t.min(u), t.max(u))
            }
            3 => {
                let by = direction(self.angle()?) * self.hair()?;
                curve.transformed(Affine::translate(by))
            }
            4 => {
                let center = self.place()?;
                let turn = Affine::rotate_about(self.angle()?, center);
                curve.transformed(turn)
            }
            _ => {
                // A small move, as welding asks for.
                let by = direction(self.angle()?) * (1e-6 * curve.bounds().size().max_side());
                curve.with_ends(curve.start() + by, curve.end())
            }
        };
        self.curves.push(again);
        Ok(())
    }

    fn several(&mut self, n: usize) -> Result<Vec<Point>> {
        (0..n).map(|_| self.place()).collect()
    }

    fn earlier(&mut self) -> Result<Option<Curve>> {
        if self.curves.is_empty() {
            return Ok(None);
        }
        let i = self.bytes.choose_index(self.curves.len())?;
        Ok(Some(self.curves[i].clone()))
    }

    /// A point of a grid, an earlier place, or one that an earlier curve suggests; sometimes off it by a hair.
    fn place(&mut self) -> Result<Point> {
        let choice = self.bytes.int_in_range(0..=15)?;
        let earlier = if choice >= 8 { self.earlier()? } else { None };
        let at = match (choice, earlier) {
            (4..=7, _) if !self.places.is_empty() => *self.bytes.choose(&self.places)?,
            (8 | 9, Some(curve)) => curve.point(self.parameter()?),
            (10, Some(curve)) => curve.start(),
            (11, Some(curve)) => curve.end(),
            (12, Some(curve)) => curve.end() + curve.tangent(1.0, End::Finish) * self.radius()?,
            (13, Some(Curve::Arc(arc))) => arc.center,
            (14, Some(curve)) => {
                let t = self.parameter()?;
                let along = curve.tangent(t, End::Start);
                curve.point(t) + Vec2::new(-along.y, along.x) * self.radius()?
            }
            (15, _) => Point::new(self.fine()?, self.fine()?),
            _ => Point::new(self.coarse()?, self.coarse()?),
        };
        let at = if self.bytes.ratio(1, 8)? { at + direction(self.angle()?) * self.hair()? } else { at };
        self.places.push(at);
        Ok(at)
    }

    /// A multiple of a quarter from −4 to 4.
    fn coarse(&mut self) -> Result<f64> {
        Ok(f64::from(self.bytes.int_in_range(-16i8..=16)?) / 4.0)
    }

    /// A number from −4 to 4 with all its digits.
    fn fine(&mut self) -> Result<f64> {
        Ok(f64::from(self.bytes.arbitrary::<i32>()?) / 536_870_912.0)
    }

    /// A radius of a few sizes, one that makes a circle touch, or one off by a hair.
    fn radius(&mut self) -> Result<f64> {
        let radius = match self.bytes.int_in_range(0..=7)? {
            0..=3 => f64::from(self.bytes.int_in_range(1u8..=16)?) / 4.0,
            4 => match self.earlier()? {
                Some(Curve::Arc(arc)) => arc.radius,
                Some(curve) => curve.start().distance(curve.end()),
                None => 1.0,
            },
            5 if self.places.len() > 1 => {
                let [a, b] = [*self.bytes.choose(&self.places)?, *self.bytes.choose(&self.places)?];
                a.distance(b)
            }
            6 => self.hair()?,
            _ => self.fine()?.abs(),
        };
        Ok(if self.bytes.ratio(1, 8)? { radius + self.hair()? } else { radius })
    }

    /// A multiple of 15°, or any angle; up to once around either way.
    fn angle(&mut self) -> Result<f64> {
        let steps: i8 = self.bytes.int_in_range(-25..=25)?;
        if steps.abs() == 25 { Ok(self.fine()? * PI / 2.0) } else { Ok(f64::from(steps) / 24.0 * TAU) }
    }

    /// A sixteenth from 0 to 1.
    fn parameter(&mut self) -> Result<f64> {
        Ok(f64::from(self.bytes.int_in_range(0u8..=16)?) / 16.0)
    }

    /// 10⁻³ to 10⁻¹³.
    fn hair(&mut self) -> Result<f64> {
        Ok(*self.bytes.choose(&[1e-3, 1e-4, 1e-5, 1e-6, 3e-7, 1e-8, 2e-9, 5e-10, 1e-10, 1e-11, 1e-12, 1e-13])?)
    }
}
