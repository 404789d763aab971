//! Outlines of our own: every kind, round trips, refusals, the schema.

use super::*;

#[test]
fn an_outline_holds_every_kind_and_round_trips() {
    let drawing = json(EVERYTHING);
    assert_eq!(drawing.curves.len(), 22);
    assert_eq!(drawing.names.iter().map(|(_, n)| n).take(3).collect::<Vec<_>>(), ["second", "first", "boundary"]);
    assert_eq!(drawing.curves[2].entity, "steps, edge 1");
    assert_eq!((drawing.sizes.len(), drawing.seeds.len(), drawing.points.len()), (4, 2, 2));
    round_trips(&drawing);
}

#[test]
fn welded_cut_and_turned_curves_round_trip_too() {
    let mut drawing = json(EVERYTHING);
    let third = 1.0 / 3.0;
    for c in &mut drawing.curves {
        let part = c.curve.part(0.1, 0.7 * third + 0.3);
        c.curve = part.with_ends(part.start() + squinch::geometry::Vec2::new(1e-9, -1e-9), part.end());
    }
    round_trips(&drawing);
    for c in &mut drawing.curves {
        c.curve = c.curve.reversed().transformed(kurbo::Affine::rotate(third) * kurbo::Affine::scale(1e-7));
    }
    round_trips(&drawing);
}

#[test]
fn refusals_of_outlines_say_where() {
    let curve =
        |body: &str| format!("{{ \"squinch\": 1, \"curves\": [\n{{ \"line\": [[0, 0], [1, 1]] }},\n{body}\n] }}");
    for (line, part, text) in [
        (3, "curves[1]", curve(r#"{ "circle": { "center": [0, 0], "radius": -1 } }"#)),
        (3, "curves[1]: invalid length 1", curve(r#"{ "line": [[0], [1, 1]] }"#)),
        (3, "unknown field `colour`", curve(r#"{ "line": [[0, 0], [1, 1]], "colour": 3 }"#)),
        (3, "holds 0 curves", curve(r#"{ "name": "x" }"#)),
        (3, "holds 2 curves", curve(r#"{ "line": [[0, 0], [1, 1]], "bezier": [[0, 0], [1, 1]] }"#)),
        (3, "missing field `radius`", curve(r#"{ "circle": { "center": [0, 0] } }"#)),
        (3, "an arc is given by", curve(r#"{ "arc": { "center": [0, 0], "radius": 1 } }"#)),
        (3, "an arc is given by", curve(r#"{ "arc": { "from": [0, 0], "to": [1, 0] } }"#)),
        (
            3,
            "`start_deg` and `sweep_deg`",
            curve(r#"{ "arc": { "center": [0, 0], "radius": 1, "start_deg": 1, "sweep_rad": 1 } }"#),
        ),
        (
            3,
            "where the angles put them",
            curve(
                r#"{ "arc": { "center": [0, 0], "radius": 1, "start_deg": 0, "sweep_deg": 90, "ends": [[1, 0], [0, 2]] } }"#,
            ),
        ),
        (3, "an ellipse is given by", curve(r#"{ "ellipse": { "center": [0, 0], "u": [1, 0] } }"#)),
        (
            3,
            "ascending from 0 to 1",
            curve(r#"{ "piecewise_bezier": { "knots": [0, 2], "spans": [{ "points": [[0, 0], [1, 1]] }] } }"#),
        ),
        (
            3,
            "spans[1] does not start",
            curve(
                r#"{ "piecewise_bezier": { "knots": [0, 0.5, 1],
                 "spans": [{ "points": [[0, 0], [1, 1]] }, { "points": [[0, 0], [1, 1]] }] } }"#,
            )
            .replace("\n   ", " "),
        ),
        (3, "degree 301 is above", curve(r#"{ "nurbs": { "degree": 301, "knots": [0, 1], "points": [[0, 0]] } }"#)),
        (3, "curves[1]", curve(r#"{ "nurbs": { "degree": 2, "knots": [0, 1], "points": [[0, 0]] } }"#)),
        (3, "number out of range", curve(r#"{ "line": [[0, 0], [1e999, 1]] }"#)),
        (3, "a polyline needs 2 points, this one has 1", curve(r#"{ "polyline": [[0, 0]] }"#)),
        (1, "missing field `squinch`", "{}".into()),
        (1, "unknown field `curvs`", r#"{ "squinch": 1, "curvs": [] }"#.into()),
        (2, "seeds[0]: needs `region`", "{ \"squinch\": 1, \"seeds\": [\n{ \"at\": [0, 0] } ] }".into()),
        (
            2,
            "seeds[0]: `max_area`",
            "{ \"squinch\": 1, \"seeds\": [\n{ \"at\": [0, 0], \"region\": \"a\", \"max_area\": 0 } ] }".into(),
        ),
        (1, "sizes[0]: `edge` must be positive", r#"{ "squinch": 1, "sizes": [{ "edge": 0 }] }"#.into()),
        (
            1,
            "sizes[0]: `near` needs `grade`",
            r#"{ "squinch": 1, "sizes": [{ "edge": 1, "near": [[0, 0], [1, 1]] }] }"#.into(),
        ),
        (1, "EOF", r#"{ "squinch": 1, "curves": ["#.into()),
    ] {
        let error = refused(&text, Format::Outline);
        assert!(error.what.contains(part), "{error}\n{text}");
        assert_eq!(error.line, Some(line), "{error}\n{text}");
        assert!(error.column.is_some() && !error.what.contains(" at line "));
    }
    assert!(refused(r#"{ "squinch": 2 }"#, Format::Outline).what.contains("version 2"));
}

#[test]
fn the_schema_knows_every_key_that_is_read_and_written() {
    let schema: serde_json::Value = serde_json::from_str(outline::SCHEMA).unwrap();
    let written: serde_json::Value = serde_json::from_str(&outline::to_json(&json(EVERYTHING))).unwrap();
    for key in written.as_object().unwrap().keys() {
        assert!(schema["properties"].get(key).is_some(), "{key}");
    }
    // What serde says it expects is what the schema offers.
    for (place, probe) in [
        ("/properties", r#"{ "?": 1 }"#),
        ("/$defs/curve/properties", r#"{ "curves": [{ "?": 1 }] }"#),
        ("/$defs/arc/properties", r#"{ "curves": [{ "arc": { "?": 1 } }] }"#),
        ("/$defs/ellipse/properties", r#"{ "curves": [{ "ellipse": { "?": 1 } }] }"#),
        ("/$defs/seed/properties", r#"{ "seeds": [{ "?": 1 }] }"#),
        ("/$defs/size/properties", r#"{ "sizes": [{ "?": 1 }] }"#),
        ("/$defs/namedPoint/properties", r#"{ "points": [{ "?": 1 }] }"#),
    ] {
        let said = refused(probe, Format::Outline).what;
        let mut expected: Vec<&str> = said.split('`').skip(3).step_by(2).collect();
        let mut offered: Vec<&str> =
            schema.pointer(place).unwrap().as_object().unwrap().keys().map(String::as_str).collect();
        expected.sort_unstable();
        offered.sort_unstable();
        assert_eq!(expected, offered, "{said}");
    }
}
