//! Overlapping shapes.

use super::*;

#[test]
fn overlapping_shapes_go_to_the_topmost_or_fall_into_fragments() {
    let boxes = svg(r#"<rect id="a" width="6" height="4"/><rect id="b" x="4" y="2" width="6" height="4"/>
        <rect id="c" x="5" width="6" height="10"/>"#);
    regions_are(&boxes, false, &[("a", 18.0), ("b", 4.0), ("c", 60.0)]);
    let fragments = [("a", 18.0), ("b", 2.0), ("c", 38.0), ("c+a", 2.0), ("c+b", 18.0), ("b+a", 2.0), ("c+b+a", 2.0)];
    regions_are(&boxes, true, &fragments);
    // Two unit circles, each through the center of the other, and a hole by the even-odd rule in the upper one.
    let discs = svg(r#"<circle id="low" cx="10" cy="10" r="1"/>
        <path id="top" fill-rule="evenodd" d="M10 10a1 1 0 1 1 2 0a1 1 0 1 1-2 0zm1.5 0a.25.25 0 1 0 .5 0a.25.25 0 1 0-.5 0"/>"#);
    let (lens, hole) = (2.0 * PI / 3.0 - 0.75_f64.sqrt(), PI / 16.0);
    regions_are(&discs, false, &[("low", PI - lens), ("top", PI - hole)]);
    regions_are(&discs, true, &[("low", PI - lens), ("top", PI - lens - hole), ("top+low", lens)]);
}

#[test]
fn names_of_fragments_are_distinct_and_bounded() {
    // A layer may be called as a fragment would be, and several shapes may have one name.
    let named = svg(r#"<rect id="a" width="3" height="1"/><rect id="b" x="2" width="3" height="1"/>
        <rect id="b+a" x="9" width="1" height="1"/><g id="a"><rect x="20" width="2" height="1"/><rect x="21" width="2" height="1"/></g>"#);
    regions_are(&named, true, &[("a", 5.0), ("b", 2.0), ("b+a", 1.0), ("b+a#2", 1.0)]);
    let nested = |id: &dyn Fn(u32) -> String| {
        let rect = |k: u32| format!(r#"<rect id="{}" x="{k}" width="{}" height="1"/>"#, id(k), 90 - 2 * k);
        svg(&(0..12).map(rect).collect::<String>())
    };
    let innermost = |drawing: &Drawing| {
        let innermost = |r: &(String, f64)| (r.1 - 68.0).abs() < 1e-9;
        regions(drawing, true).into_iter().find(innermost).expect("the innermost").0
    };
    assert_eq!(innermost(&nested(&|k| format!("r{k}"))), "r11+r10+r9+r8+r7+r6+r5+r4+4 more");
    let long = innermost(&nested(&|k| format!("{k:050}")));
    assert_eq!(long, format!("{:050}+{:050}+10 more", 11, 10));
}
