//! Writing outlines. Each curve has the form that reads back the same, to the last bit.

use super::{VERSION, curve_entity, point_entity, seed_entity, shape_entity};
use crate::curve::{Bezier, Curve, CurveError};
use crate::domain::{Drawing, DrawnCurve, DrawnPoint, FillRule, Seed, SeedKind, Shape, SizeRequest};
use crate::geometry::Point;
use crate::ids::Names;
use serde_json::{Map, Value, json};

/// The drawing as outline text, one line for each entry. Reading it gives the same drawing, bit for bit.
pub fn to_json(drawing: &Drawing) -> String {
    let mut head = Map::new();
    head.insert("squinch".into(), json!(VERSION));
    head.insert("title".into(), json!(drawing.title));
    head.insert("format".into(), json!(drawing.format));
    if let Some((unit, from)) = &drawing.unit {
        head.insert("unit".into(), json!(unit));
        head.insert("unit_from".into(), json!(from));
    }
    head.insert("fill".into(), json!(fill_word(drawing.fill)));
    if drawing.sketch {
        head.insert("sketch".into(), json!(true));
    }
    head.insert("names".into(), drawing.names.iter().map(|(_, text)| json!(text)).collect());
    let mut text = String::from("{\n");
    for (key, value) in &head {
        text.push_str(&format!("  {}: {value},\n", json!(key)));
    }
    let names = &drawing.names;
    push_list(&mut text, "shapes", drawing.shapes.iter().enumerate().map(|(i, s)| shape_value(i, s, names)));
    push_list(
        &mut text,
        "clips",
        drawing.clips.iter().map(|c| c.within.map_or(json!({}), |within| json!({ "within": within }))),
    );
    push_list(&mut text, "curves", drawing.curves.iter().enumerate().map(|(i, c)| curve_value(i, c, names)));
    push_list(&mut text, "points", drawing.points.iter().enumerate().map(|(i, p)| point_value(i, p, names)));
    push_list(&mut text, "seeds", drawing.seeds.iter().enumerate().map(|(i, s)| seed_value(i, s, names)));
    push_list(&mut text, "sizes", drawing.sizes.iter().map(|s| size_value(s, names)));
    push_list(&mut text, "skipped", drawing.skipped.iter().map(|s| json!(s)));
    push_list(&mut text, "notes", drawing.notes.iter().map(|n| json!(n)));
    // Removes the comma after the last list.
    text.truncate(text.trim_end().trim_end_matches(',').len());
    text.push_str("\n}\n");
    text
}

fn push_list(text: &mut String, key: &str, entries: impl ExactSizeIterator<Item = Value>) {
    if entries.len() == 0 {
        return;
    }
    let lines: Vec<String> = entries.map(|entry| format!("    {entry}")).collect();
    text.push_str(&format!("  \"{key}\": [\n{}\n  ],\n", lines.join(",\n")));
}

fn fill_word(fill: FillRule) -> &'static str {
    match fill {
        FillRule::NonZero => "nonzero",
        FillRule::EvenOdd => "evenodd",
        FillRule::Regions => "regions",
        FillRule::Shapes => "shapes",
        FillRule::EvenOddAndShapes => "evenodd+shapes",
    }
}

fn pair(p: Point) -> Value {
    json!([p.x, p.y])
}

fn pairs(points: &[Point]) -> Value {
    points.iter().map(|&p| pair(p)).collect()
}

fn with_entity(mut value: Value, entity: &str, default: &str) -> Value {
    if entity != default {
        value["entity"] = json!(entity);
    }
    value
}

fn shape_value(i: usize, shape: &Shape, names: &Names) -> Value {
    let mut value = json!({ "name": names.text(shape.name), "even_odd": shape.even_odd });
    for (key, clip) in [("clip", shape.clip), ("part_of", shape.part_of)] {
        clip.into_iter().for_each(|clip| value[key] = json!(clip));
    }
    with_entity(value, &shape.entity, &shape_entity(i))
}

fn curve_value(i: usize, drawn: &DrawnCurve, names: &Names) -> Value {
    let (kind, form) = kind_value(&drawn.curve);
    let mut value = json!({ "name": names.text(drawn.name), kind: form });
    if let Some(shape) = drawn.shape {
        value["shape"] = json!(shape);
    }
    if let Some(clip) = drawn.clip {
        value["clip"] = json!(clip);
    }
    with_entity(value, &drawn.entity, &curve_entity(i))
}

/// The kind and its value: the short form if it reads back the same, else the complete form.
fn kind_value(curve: &Curve) -> (&'static str, Value) {
    let same = |plain: Result<Curve, CurveError>| plain.as_ref() == Ok(curve);
    match curve {
        Curve::Line(l) => ("line", json!([pair(l.start), pair(l.end)])),
        Curve::Arc(a) if same(Curve::circle(a.center, a.radius)) => {
            ("circle", json!({ "center": pair(a.center), "radius": a.radius }))
        }
        Curve::Arc(a) => {
            let mut arc = json!({ "center": pair(a.center), "radius": a.radius,
                                  "start_rad": a.start_rad, "sweep_rad": a.sweep_rad });
            if !same(Curve::arc(a.center, a.radius, a.start_rad, a.sweep_rad)) {
                arc["ends"] = pairs(&a.ends);
            }
            ("arc", arc)
        }
        Curve::Ellipse(e) => {
            let mut ellipse = json!({ "center": pair(e.center), "u": [e.u.x, e.u.y], "v": [e.v.x, e.v.y],
                                      "start_rad": e.start_rad, "sweep_rad": e.sweep_rad });
            if !same(Curve::ellipse(e.center, e.u, e.v, e.start_rad, e.sweep_rad)) {
                ellipse["ends"] = pairs(&e.ends);
            }
            ("ellipse", ellipse)
        }
        Curve::Bezier(b) => match &b.weights {
            None => ("bezier", pairs(&b.points)),
            Some(weights) => ("rational_bezier", json!({ "points": pairs(&b.points), "weights": weights })),
        },
        Curve::Spline(s) => {
            let spans: Vec<Value> = s.spans.iter().map(span_value).collect();
            ("piecewise_bezier", json!({ "knots": s.knots, "spans": spans }))
        }
        Curve::Clothoid(c) => {
            let (from, heading, curvature, length) = (curve.start(), c.heading_rad(), c.curvatures(), c.length());
            let mut clothoid = json!({ "from": pair(from), "heading_rad": heading, "curvature": curvature,
                                       "length": length });
            if !same(Curve::clothoid(from, heading, curvature, length)) {
                clothoid["to"] = pair(curve.end());
            }
            ("clothoid", clothoid)
        }
    }
}

fn span_value(span: &Bezier) -> Value {
    let mut value = json!({ "points": pairs(&span.points) });
    if let Some(weights) = &span.weights {
        value["weights"] = json!(weights);
    }
    value
}

fn point_value(i: usize, drawn: &DrawnPoint, names: &Names) -> Value {
    let mut value = json!({ "at": pair(drawn.at) });
    if let Some(name) = drawn.name {
        value["name"] = json!(names.text(name));
    }
    with_entity(value, &drawn.entity, &point_entity(i))
}

fn seed_value(i: usize, seed: &Seed, names: &Names) -> Value {
    let mut value = json!({ "at": pair(seed.at) });
    match seed.kind {
        SeedKind::Hole => value["hole"] = json!(true),
        SeedKind::Region { name, max_area } => {
            value["region"] = json!(names.text(name));
            if let Some(area) = max_area {
                value["max_area"] = json!(area);
            }
        }
    }
    with_entity(value, &seed.entity, &seed_entity(i))
}

fn size_value(size: &SizeRequest, names: &Names) -> Value {
    match *size {
        SizeRequest::Boundary { name, edge } => json!({ "boundary": names.text(name), "edge": edge }),
        SizeRequest::Region { name, edge } => json!({ "region": names.text(name), "edge": edge }),
        SizeRequest::Near { from, to, edge, grade } => {
            json!({ "near": [pair(from), pair(to)], "edge": edge, "grade": grade })
        }
        SizeRequest::Everywhere { edge } => json!({ "edge": edge }),
    }
}
