//! Files that say too much or contradict themselves: a clear error with its line, or a drawing; in bounded time and
//! memory.
//!
//! What all readers do with any broken file is tested in `readers.rs`; what a format says of its own broken files
//! beside the rest of it (`svg`, `dxf`, `import`, `formats.rs`, `vtu.rs`).

use squinch::domain::{Drawing, Loose};
use squinch::import::{self, DxfOptions, Format, ImportError, LineTypes, Options, Strokes};
use squinch::meshio::{self, MeshFile};
use squinch::options::Switch;
use squinch::run::request::Request;
use squinch::run::{Exit, Extent, Outcome, Source, run};
use squinch::section;
use squinch::watch::no_clock;
use std::time::{Duration, Instant};

fn read(bytes: &[u8], format: Format, stem: &str, options: &Options) -> Result<Drawing, ImportError> {
    section::drawn(import::read(bytes, format, stem, options)?, &section::Options::default())
}

/// Far more than any of these files takes, on a slow machine and without optimisation.
const PATIENCE: Duration = Duration::from_secs(20);

fn sample(name: &str) -> Vec<u8> {
    std::fs::read(format!("samples/{name}")).expect("the sample is there")
}

/// What `work` gives, if it does not take for ever.
fn soon<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    assert!(start.elapsed() < PATIENCE, "{what} took {:?}", start.elapsed());
    result
}

fn meshed(name: &str, bytes: &[u8], format: Option<Format>) -> Outcome {
    meshed_by(name, bytes, format, Request::default())
}

fn meshed_by(name: &str, bytes: &[u8], format: Option<Format>, request: Request) -> Outcome {
    let airfoil = section::Options { far_field: 2.0, ..request.airfoil };
    let request = Request { max_vertices: 2000, timeout: Some(10.0), airfoil, ..request };
    let source = Source { path: name, bytes, format, nodes: None, of_many: false };
    soon(name, || run(&source, &request, Extent::Whole(&mut |_| true), &no_clock))
}

/// Mesh or refusal, and every refusal says what, and offers a way out.
fn ends_well(outcome: &Outcome, name: &str) {
    assert_ne!(outcome.exit, Exit::Bug, "{name}: {:?}", outcome.report.failure);
    match &outcome.report.failure {
        None => assert!(outcome.mesh.is_some(), "{name}"),
        Some(failure) => assert!(!failure.what.is_empty() && !failure.help.is_empty(), "{name}: {failure:?}"),
    }
}

// ---- drawings ----

/// Group codes and values, separated by semicolons, as a DXF text.
fn dxf(pairs: &str) -> Vec<u8> {
    let lines = pairs.split(';').map(|pair| pair.trim().split_once(' ').expect("code and value"));
    lines.map(|(code, value)| format!("{code}\n{value}\n")).collect::<String>().into_bytes()
}

fn dxf_entities(entities: &str) -> Vec<u8> {
    dxf(&format!("0 SECTION; 2 ENTITIES; {entities}; 0 ENDSEC; 0 EOF"))
}

fn svg(body: &str) -> Vec<u8> {
    format!("<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink'>{body}</svg>")
        .into_bytes()
}

fn refusal(what: &str, format: Format, bytes: &[u8]) -> ImportError {
    let read = soon(what, || read(bytes, format, "broken", &Options::default()));
    match read {
        Err(error) => error,
        Ok(drawing) => panic!("{what}: read as {} curves", drawing.curves.len()),
    }
}

#[test]
fn numbers_that_are_none_are_refused_with_their_line() {
    for number in ["nan", "inf", "-Infinity", "1e999"] {
        let broken = [
            (Format::Dxf, dxf_entities(&format!("0 LINE; 10 0; 20 {number}; 11 1; 21 0")), 10),
            (
                Format::Outline,
                format!("{{ \"squinch\": 1,\n\"curves\": [ {{ \"line\":\n[[0, {number}], [1, 0]] }} ] }}").into(),
                3,
            ),
            (Format::Poly, format!("3 2 0 0\n1 0 0\n2 {number} 0\n3 0 1\n0 0\n0\n").into(), 3),
            (Format::Node, format!("3 2 0 0\n1 0 0\n2 1 {number}\n3 0 1\n").into(), 3),
            (Format::Airfoil, format!("Section\n1 0\n0.5 0.1\n0 0\n0.5 {number}\n1 0\n").into(), 5),
            (Format::Airfoil, format!("Section\n{number} 0\n0.5 0.1\n0 0\n0.5 -0.1\n1 0\n").into(), 2),
        ];
        for (format, bytes, line) in broken {
            let error = refusal(number, format, &bytes);
            assert_eq!(error.line, Some(line), "{number} in {}: {error}", format.name());
        }
        // A path is drawn up to its first error, as SVG asks; a shape without a size is not drawn.
        let shapes = format!("<path d='M0 0L{number} 1 5 5z'/><circle r='{number}'/>");
        if let Ok(drawing) = read(&svg(&shapes), Format::Svg, "broken", &Options::default()) {
            assert!(drawing.curves.iter().all(|c| c.curve.bounds().is_finite()), "{number}");
        }
    }
}

#[test]
fn counts_beyond_the_file_are_refused() {
    for count in ["2000000000", "4294967294", "9223372036854775807", "18446744073709551615", "1e300", "-1"] {
        let line =
            format!("0 LINE; 10 0; 20 0; 11 1; 21 0; 0 SPLINE; 70 8; 71 3; 72 {count}; 73 {count}; 40 0; 10 0; 20 0");
        let polyline = format!("0 LWPOLYLINE; 90 {count}; 70 1; 10 0; 20 0; 10 1; 20 0; 10 0; 20 1");
        let broken = [
            (Format::Poly, format!("{count} 2 0 0\n1 0 0\n2 1 0\n3 0 1\n0 0\n0\n").into_bytes()),
            (Format::Poly, format!("3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n{count} 0\n1 1 2\n0\n").into_bytes()),
            (
                Format::Poly,
                format!("3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n{count}\n1 0.2 0.2\n").into_bytes(),
            ),
            (Format::Node, format!("{count} 2 0 0\n1 0 0\n2 1 0\n3 0 1\n").into_bytes()),
            (Format::Dxf, dxf_entities(&line)),
        ];
        for (format, bytes) in broken {
            let error = refusal(count, format, &bytes);
            assert!(error.line.is_some(), "{count} in {}: {error}", format.name());
        }
        // A count that other entities repeat by what they hold is refused.
        if let Ok(drawing) = read(&dxf_entities(&polyline), Format::Dxf, "broken", &Options::default()) {
            assert_eq!(drawing.curves.len(), 3, "{count}");
        }
        let lednicer = format!("Section\n{count}. {count}.\n\n0 0\n0.5 0.1\n1 0\n\n0 0\n0.5 -0.1\n1 0\n");
        ends_well(&meshed("section", lednicer.as_bytes(), Some(Format::Airfoil)), count);
    }
}

#[test]
fn what_unfolds_without_end_is_refused_or_left_out() {
    let block = |name: &str, body: &str| format!("0 BLOCK; 2 {name}; 10 0; 20 0; {body}; 0 ENDBLK");
    let insert = |name: &str| format!("0 INSERT; 2 {name}; 10 0; 20 0");
    let file = |blocks: &str, entities: &str| {
        dxf(&format!("0 SECTION; 2 BLOCKS; {blocks}; 0 ENDSEC; 0 SECTION; 2 ENTITIES; {entities}; 0 ENDSEC; 0 EOF"))
    };
    let circle = "0 CIRCLE; 10 0; 20 0; 40 1";
    let twice = |name: &str| format!("{}; {}", insert(name), insert(name));
    // Each block shows the next one twice: 2³⁰ circles.
    let doubled: Vec<String> = (0..30).map(|k| block(&format!("B{k}"), &twice(&format!("B{}", k + 1)))).collect();
    let deep: Vec<String> = (0..50_000).map(|k| block(&format!("B{k}"), &insert(&format!("B{}", k + 1)))).collect();
    let grid = format!("{}; 70 30000; 71 30000; 44 1; 45 1", insert("B"));
    let drawings = [
        ("itself", file(&block("A", &format!("{circle}; {}", insert("A"))), &insert("A"))),
        ("each other", file(&format!("{}; {}", block("A", &insert("B")), block("B", &insert("A"))), &insert("A"))),
        ("doubled", file(&format!("{}; {}", doubled.join("; "), block("B30", circle)), &insert("B0"))),
        ("deep", file(&deep.join("; "), &insert("B0"))),
        ("a grid", file(&block("B", circle), &grid)),
    ];
    for (what, bytes) in drawings {
        match soon(what, || read(&bytes, Format::Dxf, "unfolding", &Options::default())) {
            Err(error) => assert!(!error.what.is_empty() && !error.help.is_empty(), "{what}: {error:?}"),
            Ok(drawing) => {
                assert!(drawing.curves.len() <= 1 && !drawing.skipped.is_empty(), "{what}: {:?}", drawing.skipped)
            }
        }
    }
    let uses: String =
        (0..40).map(|k| format!("<g id='g{k}'>{}</g>", format!("<use xlink:href='#g{}'/>", k + 1).repeat(2))).collect();
    let pictures = [
        ("a loop", "<use id='a' xlink:href='#a'/>".to_owned()),
        ("a loop of two", "<g id='a'><use xlink:href='#b'/></g><g id='b'><use xlink:href='#a'/></g>".to_owned()),
        ("doubled uses", format!("<defs>{uses}<circle id='g40' r='1'/></defs><use xlink:href='#g0'/>")),
        ("deep groups", format!("{}<circle r='1'/>{}", "<g>".repeat(100_000), "</g>".repeat(100_000))),
        ("deep paths", format!("<path d='M0 0{}'/>", "m1 1".repeat(100_000))),
    ];
    for (what, body) in pictures {
        match soon(what, || read(&svg(&body), Format::Svg, "unfolding", &Options::default())) {
            Err(error) => assert!(!error.what.is_empty() && !error.help.is_empty(), "{what}: {error:?}"),
            Ok(drawing) => assert!(drawing.curves.len() <= 100_000, "{what}: {} curves", drawing.curves.len()),
        }
    }
    let lists = format!("{{ \"squinch\": 1, \"curves\": {}", "[".repeat(1_000_000));
    assert!(refusal("deep lists", Format::Outline, lists.as_bytes()).line.is_some());
    let objects = format!("{{ \"squinch\": 1, \"curves\": [{}", "{\"line\":".repeat(1_000_000));
    assert!(refusal("deep objects", Format::Outline, objects.as_bytes()).line.is_some());
}

#[test]
fn pictures_that_say_too_much_are_meshes_or_refusals() {
    let chain = |n: usize, by: &str| {
        let path = |k: usize| {
            format!(
                "<clipPath id='c{k}' clip-path='url(#c{})'><rect width='{}' height='9'/>{by}</clipPath>",
                k + 1,
                k + 1
            )
        };
        (0..n).map(path).collect::<String>()
    };
    let plain = "<rect width='8' height='8'/>";
    let clipped = |defs: &str| format!("{defs}<g clip-path='url(#c0)'>{plain}</g>");
    // Each child of a clip path asks for the next one, moved: 2^40 of them.
    let doubled: String = (0..40)
        .map(|k| {
            let child = |x: usize| format!("<circle r='5' transform='translate({x})' clip-path='url(#c{})'/>", k + 1);
            format!("<clipPath id='c{k}'>{}{}</clipPath>", child(0), child(1))
        })
        .collect();
    let nested = format!("{}{plain}{}", "<g clip-path='inset(1%)'>".repeat(300), "</g>".repeat(300));
    let boxes = format!(
        "{}{plain}{}",
        "<g style='transform-box:fill-box;transform-origin:center;rotate:1deg'>".repeat(300),
        "</g>".repeat(300)
    );
    // Each of 1000 clips cuts, in each of the thousand elements, what another row of clips leaves: 500 000 clips.
    let staggered: String = (0..1000)
        .map(|k| format!("<g style='clip-path:polygon({k}px 0,{k}.5px 9px,4{k:03}px 9px,4{k:03}px 0)'><rect x='{k}' width='4000' height='8'/>"))
        .collect();
    let sheet = |selector: &str| format!("<style>{selector} {{ fill: red }}</style><g><g><g>{plain}</g></g></g>");
    let elements = "<g/>".repeat(2000);
    let pictures = [
        (
            "a clip path in itself",
            clipped("<clipPath id='c0' clip-path='url(#c0)'><rect width='5' height='5'/></clipPath>"),
        ),
        ("clip paths in a cycle", clipped(&chain(2, "<circle r='3' clip-path='url(#c0)'/>").replace("#c2", "#c0"))),
        (
            "a use of a clip path",
            clipped(
                "<clipPath id='c0'><use xlink:href='#c0'/><use xlink:href='#u'/></clipPath><use id='u' xlink:href='#u'/>",
            ),
        ),
        ("clip paths in a row", clipped(&chain(100, ""))),
        ("doubled clip paths", clipped(&doubled)),
        ("nested clip paths", nested),
        ("nested boxes", boxes),
        ("staggered clips", staggered + &"</g>".repeat(1000)),
        ("deep selectors", sheet(&"g > g ".repeat(10_000))),
        ("selectors in selectors", sheet(&format!("{}g{}", ":not(".repeat(10_000), ")".repeat(10_000)))),
        (
            "selectors that turn back",
            format!("<style>{} {{ fill: red }}</style><g>{elements}</g>", "g ~ ".repeat(40) + "p"),
        ),
        ("letters of several bytes", sheet("*é, [k]é, é>*, #é.é:é, rect é")),
        ("huge places of children", sheet("rect:nth-child(-1099511627776n+1099511627775), rect:nth-child(9e99n)")),
        ("blocks without end", format!("<style>{}</style>{plain}", "@media screen { g { ".repeat(10_000))),
        ("variables of themselves", format!("<g style='--a:var(--b);--b:var(--a);fill:var(--a,var(--b))'>{plain}</g>")),
        ("a huge scale", format!("<g transform='scale(1e300)'><g transform='scale(1e300)'>{plain}</g></g>")),
        ("a tiny scale", format!("<g transform='scale(1e-200) scale(1e-200)'>{plain}</g>")),
        ("infinite turns", format!("<g style='rotate:1e999turn;translate:1e999px;scale:-1e999'>{plain}</g>")),
        ("a huge skew", format!("<g transform='skewX(90) skewY(-1e300) rotate(1e308, 1e308, -1e308)'>{plain}</g>")),
        ("a huge matrix", format!("<g transform='matrix(1e308 1e308 -1e308 1e308 1e308 1e308)'>{plain}</g>")),
    ];
    for (what, body) in pictures {
        ends_well(&meshed(what, &svg(&body), Some(Format::Svg)), what);
    }
    let curves = "<path d='M0 0C0 9 9 9 9 0A4 2 9 0 1 0 0z'/><circle r='2'/><path d='M0 0h9'/>";
    for pen in [
        "stroke-dasharray='0'",
        "stroke-dasharray='0 0 0'",
        "stroke-dasharray='-1 2'",
        "stroke-dasharray='1 -1'",
        "stroke-dasharray='1e-300'",
        "stroke-dasharray='1e-3'",
        "stroke-dasharray='1e-320 1e300' stroke-dashoffset='-1e308'",
        "stroke-dasharray='1e999 0' stroke-dashoffset='1e999'",
        "stroke-dasharray='nan 1'",
        "stroke-dasharray='0 3' stroke-linecap='round'",
        "stroke-width='1e300'",
        "stroke-width='1e999'",
        "stroke-width='1e-300'",
        "stroke-width='-1'",
        "stroke-miterlimit='1e999' stroke-linejoin='miter'",
        "transform='scale(1e-9 1)' vector-effect='non-scaling-stroke'",
    ] {
        let body = format!("<g fill='none' stroke='red' {pen}>{curves}</g>");
        let request = Request { strokes: Strokes::Area, ..Request::default() };
        ends_well(&meshed_by(pen, &svg(&body), Some(Format::Svg), request), pen);
    }
}

#[test]
fn entities_that_contradict_themselves_are_meshes_or_refusals() {
    let square = "0 LWPOLYLINE; 8 0; 90 4; 70 1; 10 0; 20 0; 10 9; 20 0; 10 9; 20 9; 10 0; 20 9";
    let vertex = |x: f64, offset: f64| format!("11 {x}; 21 0; 12 1; 22 0; 13 0; 23 1; 74 2; 41 {offset}; 41 0; 75 0");
    let hatch = |paths: &str| format!("0 HATCH; 8 0; 2 SOLID; 70 1; 91 1; {paths}; 75 0; 76 1");
    let spline =
        |data: &str| format!("0 SPLINE; 8 0; 70 0; 71 3; {data}; 10 0; 20 0; 10 1; 20 3; 10 2; 20 -3; 10 3; 20 0");
    let entities = [
        ("a multiline without vertices", "0 MLINE; 8 0; 71 2".to_owned()),
        ("a multiline of one vertex", format!("0 MLINE; 8 0; 71 3; {}", vertex(0.0, 1.0))),
        ("a multiline of no lines", "0 MLINE; 8 0; 71 1; 11 0; 21 0; 11 9; 21 0".into()),
        ("a multiline of huge offsets", format!("0 MLINE; 8 0; 71 1; {}; {}", vertex(0.0, 1e308), vertex(9.0, -1e308))),
        ("a polygon without paths", "0 MPOLYGON; 8 0; 91 0".into()),
        ("a polygon of one corner", "0 MPOLYGON; 8 0; 91 1; 92 2; 72 0; 73 1; 93 1; 10 1; 20 1".into()),
        ("a polygon of edges", "0 MPOLYGON; 8 0; 91 1; 92 1; 93 1; 72 2; 10 0; 20 0; 40 1; 50 0; 51 360; 73 1".into()),
        ("a hatch of no paths", hatch("92 1")),
        ("a path without edges", hatch("92 1; 93 0; 97 0")),
        ("a path of promised edges", hatch("92 1; 93 2147483647")),
        ("a polyline of nothing", hatch("92 3; 72 1; 73 1; 93 0")),
        (
            "arcs of no extent",
            hatch("92 1; 93 2; 72 2; 10 0; 20 0; 40 0; 50 0; 51 360; 73 1; 72 1; 10 1; 20 1; 11 1; 21 1"),
        ),
        ("an ellipse of no width", hatch("92 1; 93 1; 72 3; 10 0; 20 0; 11 1; 21 0; 40 0; 50 0; 51 360; 73 1")),
        ("a spline edge of no points", hatch("92 1; 93 1; 72 4; 94 3; 73 0; 74 0; 95 0; 96 0; 97 0")),
        ("a huge tolerance of knots", spline("42 1e300; 40 9; 40 0; 40 5; 40 1; 40 1; 40 1; 40 1; 40 -7")),
        ("a negative tolerance of knots", spline("42 -1; 40 0; 40 0; 40 0; 40 0; 40 1; 40 1; 40 1; 40 1")),
        ("one knot all over", spline("42 1e300; 40 1; 40 1; 40 1; 40 1; 40 1; 40 1; 40 1; 40 1")),
        ("weights of nothing", spline("41 0; 41 0; 41 0; 41 0")),
        ("weights of both signs", spline("41 1; 41 -1; 41 1; 41 -1")),
        (
            "huge tangents",
            "0 SPLINE; 8 0; 70 0; 71 3; 74 3; 12 1e308; 22 1e308; 13 1e-320; 23 0; 11 0; 21 0; 11 1; 21 1; 11 2; 21 0"
                .into(),
        ),
        ("a solid of one corner", "0 SOLID; 8 0; 10 1; 20 1; 11 1; 21 1; 12 1; 22 1; 13 1; 23 1".into()),
        ("a wipeout", "0 WIPEOUT; 8 0; 10 0; 20 0; 11 1e300; 21 0; 91 2; 14 0; 24 0".into()),
        ("an ellipse of no axis", "0 ELLIPSE; 8 0; 10 0; 20 0; 11 0; 21 0; 31 1; 40 0.5; 41 0; 42 6.28".into()),
    ];
    for (what, entity) in entities {
        for text in [dxf_entities(&entity), dxf_entities(&format!("{square}; {entity}"))] {
            let dxf = DxfOptions { line_types: LineTypes::All, flatten_z: Switch::On };
            let all = Request { dxf, loose: Loose::Drop, ..Request::default() };
            for request in [Request::default(), all] {
                ends_well(&meshed_by(what, &text, Some(Format::Dxf), request), what);
            }
        }
    }
    // Layers and blocks whose line types refer to each other and to nothing.
    let by_block = dxf(&format!(
        "0 SECTION; 2 TABLES; 0 TABLE; 2 LAYER; 0 LAYER; 2 A; 70 0; 62 7; 6 BYBLOCK; 0 LAYER; 2 B; 70 0; 62 7; 6 BYLAYER; 0 ENDTAB; \
         0 ENDSEC; 0 SECTION; 2 BLOCKS; 0 BLOCK; 2 K; 10 0; 20 0; 0 INSERT; 8 A; 6 BYBLOCK; 2 L; 10 0; 20 0; 0 ENDBLK; 0 BLOCK; 2 L; \
         10 0; 20 0; 0 CIRCLE; 8 B; 6 BYBLOCK; 10 0; 20 0; 40 1; 0 INSERT; 8 B; 6 BYLAYER; 2 K; 10 0; 20 0; 0 ENDBLK; 0 ENDSEC; \
         0 SECTION; 2 ENTITIES; 0 INSERT; 8 A; 6 BYBLOCK; 2 K; 10 0; 20 0; {square}; 0 ENDSEC; 0 EOF"
    ));
    let outcome = meshed("line types in a cycle", &by_block, Some(Format::Dxf));
    assert_eq!(outcome.exit, Exit::Done, "{:?}", outcome.report.failure);
}

#[test]
fn tables_of_coordinates_that_are_none_are_sections_or_refusals() {
    let rows = |row: &dyn Fn(usize) -> String| (0..40).map(|k| row(k) + "\n").collect::<String>();
    let tables = [
        ("index columns alone", rows(&|k| format!("{k}"))),
        ("equal rows", rows(&|_| "0.5 0.1".into())),
        ("equal columns", rows(&|k| format!("{k} {k} {k}"))),
        ("a column of nothing", rows(&|k| format!("{} 0 0", k as f64 / 39.0))),
        ("surfaces that swap", rows(&|k| format!("{} {} {}", k as f64 / 39.0, (k % 2) as f64, ((k + 1) % 2) as f64))),
        ("minus signs alone", rows(&|_| "-1-2-3-4-5-6-7-8".into())),
        ("signs of another alphabet", rows(&|k| format!("\u{2212}{k}.5\u{2212}0.1"))),
        ("numbers without end", "1".repeat(100_000) + " 0\n0.5 0.1\n0 0\n0.5 -0.1\n1 0\n"),
        ("a row without end", "0.5 ".repeat(100_000)),
        ("two numbers in front", "Section 1e308 -1e308\n".to_owned() + &rows(&|k| format!("{} 0.1", k as f64 / 39.0))),
        ("huge numbers", rows(&|k| format!("{}e300 {}e300", k, k % 7))),
        ("tiny numbers", rows(&|k| format!("{}e-310 {}e-310", k, k % 7))),
    ];
    for (what, text) in tables {
        for chord in [None, Some(1e-300), Some(1e300)] {
            let airfoil = section::Options { chord, ..section::Options::default() };
            let request = Request { airfoil, ..Request::default() };
            ends_well(&meshed_by(what, text.as_bytes(), Some(Format::Airfoil), request), what);
        }
    }
}

#[test]
fn gaps_are_closed_by_absurd_values_or_refused() {
    let plate = sample("plate.json");
    let open = dxf_entities(
        "0 LINE; 10 0; 20 0; 11 9; 21 0; 0 LINE; 10 9; 20 0; 11 9; 21 9; 0 LINE; 10 9; 20 9; 11 0; 21 0.1",
    );
    for close in [f64::MIN_POSITIVE, 1e-300, 1e-9, 1.0, 1e9, 1e300, f64::MAX] {
        for loose in [Loose::Auto, Loose::Keep, Loose::Drop, Loose::Error] {
            for (name, bytes, format) in [("plate", &plate, Format::Outline), ("open", &open, Format::Dxf)] {
                let request = Request { close: Some(close), loose, ..Request::default() };
                ends_well(&meshed_by(name, bytes, Some(format), request), &format!("{name} closed by {close:e}"));
            }
        }
    }
    for close in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = Request { close: Some(close), ..Request::default() }.validate();
        assert_eq!(refused.map_err(|error| error.option), Err("close"), "{close}");
    }
}

// ---- meshes ----

fn read_mesh(what: &str, format: meshio::Format, text: &str) -> Result<MeshFile, meshio::MeshError> {
    soon(what, || meshio::read(text.as_bytes(), format, &[]))
}

#[test]
fn mesh_files_with_counts_beyond_the_file_are_refused() {
    use meshio::Format::{Inp, Msh, Obj, Stl, Su2, Triangle, Vtk, Vtu};
    for count in ["2000000000", "4294967295", "9223372036854775807", "18446744073709551615", "-1", "1e18", "nan"] {
        let vtu = format!(
            "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid>\
             <Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{count}\"><Points><DataArray type=\"Float64\" \
             NumberOfComponents=\"3\" format=\"ascii\">0 0 0</DataArray></Points></Piece></UnstructuredGrid></VTKFile>"
        );
        let broken = [
            (Vtu, vtu),
            (
                Vtk,
                format!(
                    "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {count} double\n0 0 0\n"
                ),
            ),
            (
                Vtk,
                format!(
                    "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 float\n000000000000\nCELLS {count} {count}\n"
                ),
            ),
            (Msh, format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{count}\n1 0 0 0\n$EndNodes\n")),
            (
                Msh,
                format!(
                    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {count} 1 {count}\n2 1 0 {count}\n1\n0 0 0\n$EndNodes\n"
                ),
            ),
            (Msh, format!("$MeshFormat\n4.1 1 8\n\x01\0\0\0$EndMeshFormat\n$Nodes\n{}", "\u{7f}".repeat(200))),
            (Su2, format!("NDIME= 2\nNELEM= {count}\n5 0 1 2\nNPOIN= 3\n0 0\n1 0\n0 1\n")),
            (Su2, format!("NDIME= 2\nNELEM= 1\n5 0 1 2\nNPOIN= {count}\n0 0\n1 0\n0 1\n")),
            (Inp, format!("*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n*ELEMENT, TYPE=CPS3\n1, 1, 2, {count}\n")),
            (Obj, format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 {count}9\n")),
            (Triangle, format!("{count} 3 0\n1 1 2 3\n")),
        ];
        for (format, text) in broken {
            let error = read_mesh(count, format, &text).expect_err(&format!("{count} in {}: {text}", format.name()));
            assert!(!error.what.is_empty() && !error.help.is_empty(), "{error:?}");
        }
    }
    let stl = [&[b' '; 80][..], &u32::MAX.to_le_bytes(), &[0; 50]].concat();
    soon("stl", || meshio::read(&stl, Stl, &[])).expect_err("4294967295 triangles in 134 bytes");
    // Of a generated set the numbers are all in the file but for these three.
    let set = "*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n*ELEMENT, TYPE=CPS3\n1, 1, 2, 3\n*ELSET, ELSET=all, GENERATE\n1, 9000000000000000000, 1\n";
    let _ = read_mesh("a generated set", Inp, set);
    let deep = format!("<VTKFile>{}", "<a>".repeat(1_000_000));
    read_mesh("deep tags", Vtu, &deep).expect_err("a million open tags");
}
