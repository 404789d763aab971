//! Blocks: placed, nested, in rows and columns, within bounds.

use super::*;

#[track_caller]
fn inserted(insert: &str, from: (f64, f64), to: (f64, f64)) {
    let drawing = whole(&with_blocks(UNIT_LINE, insert));
    near_point(only(&drawing).start(), from);
    near_point(only(&drawing).end(), to);
}

#[test]
fn a_block_is_scaled_turned_moved_and_mirrored_about_its_base() {
    inserted("0 INSERT; 2 l; 10 5; 20 6", (5.0, 6.0), (6.0, 6.0));
    inserted("0 INSERT; 2 L; 10 5; 20 6; 41 3; 42 1; 50 90", (5.0, 6.0), (5.0, 9.0));
    inserted("0 INSERT; 2 L; 10 5; 20 6; 41 -2; 50 30", (5.0, 6.0), (5.0 - 3f64.sqrt(), 5.0));
    inserted("0 INSERT; 2 L; 10 5; 20 6; 50 90; 210 0; 220 0; 230 -1", (-5.0, 6.0), (-5.0, 7.0));
    let none = whole(&with_blocks(UNIT_LINE, "0 INSERT; 2 L; 10 0; 20 0; 41 0; 0 INSERT; 2 M; 10 0; 20 0"));
    let expected =
        [("INSERT", 1, "a block drawn with the scale 0"), ("INSERT", 1, "of a block that the file does not define")];
    assert_eq!(skipped(&none), expected);
}

#[test]
fn curves_in_blocks_keep_their_kind() {
    let block = "0 BLOCK; 2 B; 10 0; 20 0; 0 CIRCLE; 10 0; 20 0; 40 1; 0 LWPOLYLINE; 70 1; 10 -1; 20 0; 42 1; 10 1; 20 0; 42 1; 0 ENDBLK";
    let mirrored = whole(&with_blocks(block, "0 INSERT; 2 B; 10 3; 20 0; 41 -2; 42 2; 50 17"));
    assert!(curves(&mirrored).iter().all(|c| matches!(c, Curve::Arc(_))));
    near(area(&mirrored), -8.0 * PI);
    let stretched = whole(&with_blocks(block, "0 INSERT; 2 B; 10 3; 20 0; 41 3; 42 2; 50 17"));
    assert!(curves(&stretched).iter().all(|c| matches!(c, Curve::Ellipse(_))));
    near(area(&stretched), 12.0 * PI);
}

#[test]
fn rows_and_columns_follow_the_turned_axes_unscaled() {
    let drawing =
        whole(&with_blocks(UNIT_LINE, "0 INSERT; 2 L; 10 0; 20 0; 41 5; 42 5; 50 90; 70 3; 71 2; 44 10; 45 20"));
    let starts: Vec<Point> = curves(&drawing).iter().map(Curve::start).collect();
    let expected = [(0.0, 0.0), (0.0, 10.0), (0.0, 20.0), (-20.0, 0.0), (-20.0, 10.0), (-20.0, 20.0)];
    assert_eq!(starts.len(), expected.len());
    starts.into_iter().zip(expected).for_each(|(start, expected)| near_point(start, expected));
}

#[test]
fn blocks_stand_in_blocks() {
    let outer = "0 BLOCK; 2 Outer; 10 0; 20 0; 0 INSERT; 5 9; 8 0; 2 L; 10 1; 20 0; 41 2; 42 2; 0 ENDBLK";
    let drawing = whole(&with_blocks(
        &format!("{UNIT_LINE}; {outer}"),
        "0 INSERT; 5 2F; 8 part; 2 OUTER; 10 10; 20 0; 50 90; 41 3; 42 3",
    ));
    near_point(only(&drawing).start(), (10.0, 3.0));
    near_point(only(&drawing).end(), (10.0, 9.0));
    assert_eq!(names(&drawing), ["part"]);
    let entity = &drawing.curves[0].entity;
    assert!(entity.starts_with("INSERT \"OUTER\" (handle 2F, line "), "{entity}");
    assert!(
        entity.contains(" > INSERT \"L\" (handle 9, line ") && entity.ends_with(" > LINE (handle 1C, line 18)"),
        "{entity}"
    );
}

#[test]
fn a_block_that_holds_itself_is_not_followed() {
    let a = "0 BLOCK; 2 A; 10 0; 20 0; 0 CIRCLE; 10 0; 20 0; 40 1; 0 INSERT; 2 B; 10 0; 20 0; 0 ENDBLK";
    let b = "0 BLOCK; 2 B; 10 0; 20 0; 0 INSERT; 2 a; 10 1; 20 0; 0 ENDBLK";
    let drawing = whole(&with_blocks(&format!("{a}; {b}"), "0 INSERT; 2 A; 10 0; 20 0"));
    assert_eq!(drawing.curves.len(), 1);
    assert_eq!(skipped(&drawing), [("INSERT", 1, "of a block that holds itself")]);
}

#[test]
fn blocks_unfold_within_bounds() {
    let error = refused(&with_blocks(UNIT_LINE, "0 INSERT; 5 2F; 2 L; 10 0; 20 0; 70 30000; 71 30000; 44 2; 45 2"));
    assert!(error.what.contains("more than 1000000 curves") && error.what.contains("handle 2F"), "{error}");
    // Thirty blocks, each with two of the next: nothing is drawn, and it would take 2³⁰ steps.
    let chain = |n: usize, more: &str| -> String {
        (0..n)
            .map(|i| format!("0 BLOCK; 2 B{i}; 10 0; 20 0; {} 0 ENDBLK;", more.replace('#', &(i + 1).to_string())))
            .collect()
    };
    let twice = "0 INSERT; 2 B#; 10 0; 20 0; 0 INSERT; 2 B#; 10 1; 20 0;";
    let error = refused(&with_blocks(&chain(30, twice), "0 INSERT; 2 B0; 10 0; 20 0"));
    assert!(error.what.contains("more than 1000000 curves"), "{error}");
    let error = refused(&with_blocks(&chain(1000, "0 INSERT; 2 B#; 10 0; 20 0;"), "0 INSERT; 2 B0; 10 0; 20 0"));
    assert!(error.what.contains("more than 32 deep"), "{error}");
    // A spline counts by its control points.
    let control: String = (0..1000).map(|i| format!("10 {i}; 20 0;")).collect();
    let spline = format!("0 BLOCK; 2 S; 10 0; 20 0; 0 SPLINE; 71 3; {control} 0 ENDBLK");
    let error = refused(&with_blocks(&spline, "0 INSERT; 2 S; 10 0; 20 0; 70 1000; 44 1"));
    assert!(error.what.contains("more than 1000000 curves"), "{error}");
    let huge = "0 INSERT; 2 L; 10 0; 20 0; 41 1e140; 42 1e140; 0 INSERT; 2 L; 10 0; 20 0";
    let nested = format!("{UNIT_LINE}; 0 BLOCK; 2 H; 10 0; 20 0; {huge}; 0 ENDBLK");
    let error = refused(&with_blocks(&nested, "0 INSERT; 2 H; 10 0; 20 0; 41 1e20; 42 1e20"));
    assert!(error.what.contains("too large or too small"), "{error}");
}
