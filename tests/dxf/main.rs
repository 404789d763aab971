//! What the DXF reader takes, what it makes of it, and how it refuses.

mod blocks;
mod curves;
mod dress;
mod hatches;
mod layers;
mod refusals;
mod regions;

use proptest::prelude::*;
use squinch::curve::{Curve, End};
use squinch::domain::{ArrangeOptions, Drawing, FillRule, SeedKind};
use squinch::geometry::{Point, Vec2};
use squinch::import::{self, DxfOptions, Format, ImportError, LineTypes, Options, Selection};
use squinch::section;
use std::f64::consts::{FRAC_PI_2, PI};

fn read(bytes: &[u8], format: Format, stem: &str, options: &Options) -> Result<Drawing, ImportError> {
    section::drawn(import::read(bytes, format, stem, options)?, &section::Options::default())
}

fn pairs(short: &str) -> Vec<(i32, &str)> {
    short
        .split([';', '\n'])
        .map(str::trim_start)
        .filter(|text| !text.is_empty())
        .map(|text| text.split_once(' ').unwrap_or((text, "")))
        .map(|(code, value)| (code.parse().expect("a group code"), value))
        .collect()
}

fn text(short: &str) -> String {
    pairs(short).iter().map(|(code, value)| format!("{code:>3}\n{value}\n")).collect()
}

fn section(name: &str, short: &str) -> String {
    format!("0 SECTION; 2 {name}; {short}; 0 ENDSEC;")
}

/// A file of nothing but these entities.
fn plain(entities: &str) -> String {
    section("ENTITIES", entities) + "0 EOF"
}

fn from_bytes(bytes: &[u8]) -> Result<Drawing, ImportError> {
    read(bytes, Format::Dxf, "stem", &Options::default())
}

fn whole(short: &str) -> Drawing {
    from_bytes(text(short).as_bytes()).unwrap_or_else(|e| panic!("{e}\n{short}"))
}

fn drawn(entities: &str) -> Drawing {
    whole(&plain(entities))
}

#[track_caller]
fn refused(short: &str) -> ImportError {
    match from_bytes(text(short).as_bytes()) {
        Err(error) => error,
        Ok(drawing) => panic!("read {} curves", drawing.curves.len()),
    }
}

fn curves(drawing: &Drawing) -> Vec<Curve> {
    drawing.curves.iter().map(|c| c.curve.clone()).collect()
}

#[track_caller]
fn only(drawing: &Drawing) -> &Curve {
    assert_eq!(drawing.curves.len(), 1, "{:?}", drawing.skipped);
    &drawing.curves[0].curve
}

/// The area that the curves go around, drawn as closed outlines in one direction.
fn area(drawing: &Drawing) -> f64 {
    drawing.curves.iter().map(|c| c.curve.signed_area(Point::ORIGIN)).sum()
}

/// The area of the kept regions.
fn measure(drawing: &Drawing) -> f64 {
    drawing.arrange(&ArrangeOptions::default()).unwrap_or_else(|e| panic!("{e}")).area()
}

fn skipped(drawing: &Drawing) -> Vec<(&str, usize, &str)> {
    drawing.skipped.iter().map(|s| (s.entity.as_str(), s.count, s.why.as_str())).collect()
}

fn noted(drawing: &Drawing, part: &str) -> bool {
    drawing.notes.iter().any(|note| note.contains(part))
}

fn names(drawing: &Drawing) -> Vec<&str> {
    drawing.curves.iter().map(|c| drawing.names.text(c.name)).collect()
}

#[track_caller]
fn near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * (1.0 + b.abs()), "{a} is not {b}");
}

#[track_caller]
fn near_point(a: Point, b: (f64, f64)) {
    assert!(a.distance(Point::new(b.0, b.1)) <= 1e-12 * (1.0 + b.0.abs() + b.1.abs()), "{a:?} is not {b:?}");
}

const SQUARE: &str = "0 LWPOLYLINE; 8 rim; 90 4; 70 1; 10 0; 20 0; 10 4; 20 0; 10 4; 20 4; 10 0; 20 4";

/// A quarter of the unit circle, rational.
const QUARTER: &str = "0 SPLINE; 70 12; 71 2; 72 6; 73 3; 40 0; 40 0; 40 0; 40 1; 40 1; 40 1;
    41 1; 41 0.7071067811865476; 41 1; 10 1; 20 0; 30 0; 10 1; 20 1; 30 0; 10 0; 20 1; 30 0";

fn with_blocks(blocks: &str, entities: &str) -> String {
    section("BLOCKS", blocks) + &plain(entities)
}

const UNIT_LINE: &str = "0 BLOCK; 2 L; 70 0; 10 1; 20 1; 30 0; 0 LINE; 5 1C; 8 0; 10 1; 20 1; 11 2; 21 1; 0 ENDBLK";

/// A hatch with these paths.
fn hatch(style: u8, paths: &str) -> String {
    let count = paths.matches("92 ").count();
    format!(
        "0 HATCH; 5 4D; 8 steel; 10 0; 20 0; 30 0; 210 0; 220 0; 230 1; 2 ANSI31; 70 0; 71 0; 91 {count}; {paths};
         75 {style}; 76 1; 52 0; 41 1; 77 0; 78 1; 53 45; 43 0; 44 0; 45 1; 46 1; 79 0; 98 1; 10 99; 20 99"
    )
}

/// The unit disc, as a path without its flags.
const DISC: &str =
    "93 2; 72 2; 10 0; 20 0; 40 1; 50 0; 51 180; 73 1; 72 2; 10 0; 20 0; 40 1; 50 180; 51 360; 73 1; 97 1; 330 1F";

/// A file with something of everything.
fn sampler() -> String {
    let header = section("HEADER", "9 $ACADVER; 1 AC1015; 9 $INSUNITS; 70 6");
    let tables = section("TABLES", "0 TABLE; 2 LAYER; 70 1; 0 LAYER; 2 rim; 70 0; 62 7; 0 ENDTAB");
    let outline = format!("{SQUARE}; 0 CIRCLE; 10 2; 20 2; 40 1; {QUARTER}; 0 INSERT; 2 L; 10 0; 20 9; 70 2; 44 3");
    let ellipse = "0 ELLIPSE; 10 9; 20 9; 11 2; 21 0; 40 0.5; 41 0; 42 3";
    let entities = format!("{outline}; {ellipse}; {}; 0 POINT; 10 1; 20 1", hatch(0, &format!("92 1; {DISC}")));
    header + &tables + &with_blocks(UNIT_LINE, &entities)
}

fn same(a: &Drawing, b: &Drawing) {
    assert_eq!(curves(a), curves(b));
    assert_eq!((names(a), &a.unit, &a.points.len()), (names(b), &b.unit, &b.points.len()));
    assert_eq!(a.seeds.iter().map(|s| s.at).collect::<Vec<_>>(), b.seeds.iter().map(|s| s.at).collect::<Vec<_>>());
}

/// The same pairs as a binary file, with codes of one byte or of two.
fn binary(short: &str, wide: bool) -> Vec<u8> {
    let mut bytes = b"AutoCAD Binary DXF\r\n\x1a\0".to_vec();
    for (code, value) in pairs(short) {
        match u8::try_from(code) {
            Ok(code) if !wide && code < 255 => bytes.push(code),
            _ => {
                bytes.extend((!wide).then_some(255));
                bytes.extend((code as i16).to_le_bytes());
            }
        }
        match code {
            10..=59 | 210..=239 => bytes.extend(value.parse::<f64>().unwrap().to_le_bytes()),
            60..=79 => bytes.extend(value.parse::<i16>().unwrap().to_le_bytes()),
            90..=99 => bytes.extend(value.parse::<i32>().unwrap().to_le_bytes()),
            290..=299 => bytes.push(value.parse::<u8>().unwrap()),
            1004 => bytes.extend([2, 0, 10]),
            1070 => bytes.extend(value.parse::<i16>().unwrap().to_le_bytes()),
            _ => bytes.extend([value.as_bytes(), b"\0"].concat()),
        }
    }
    bytes
}

fn with(options: DxfOptions, short: &str) -> Drawing {
    let options = Options { dxf: options, ..Options::default() };
    read(text(short).as_bytes(), Format::Dxf, "stem", &options).unwrap_or_else(|e| panic!("{e}\n{short}"))
}

fn regions(drawing: &Drawing) -> Vec<(String, f64)> {
    let domain = drawing.arrange(&ArrangeOptions::default()).unwrap();
    domain.regions().iter().map(|r| (domain.name(r.name).to_owned(), r.area)).collect()
}

/// A closed polyline around a square, on a layer.
fn square(layer: &str, x: f64, side: f64) -> String {
    let corners = [(x, 0.0), (x + side, 0.0), (x + side, side), (x, side)].map(|(x, y)| format!("10 {x}; 20 {y}; "));
    format!("0 LWPOLYLINE; 8 {layer}; 90 4; 70 1; {}", corners.concat())
}
