//! Linework that is no edge of the part: frames, and outlines that cross those of another layer.

use super::*;

/// Curves on layers, by name.
fn layered(layers: &[(&str, Vec<Curve>)]) -> Drawing {
    let mut drawing = Drawing::default();
    for (name, curves) in layers {
        let line_types = [("CONTINUOUS".to_owned(), curves.len())].into();
        let layer = Some(drawing.layers.push(Layer { name: (*name).into(), line_types }));
        for curve in curves {
            drawing.add(curve.clone(), name, format!("curve on {name}"));
            drawing.curves.last_mut().unwrap().layer = layer;
        }
    }
    drawing
}

fn notes_of(layers: &[(&str, Vec<Curve>)]) -> String {
    filled(&layered(layers), FillRule::EvenOdd).notes().join("\n")
}

#[test]
fn a_frame_around_a_part_is_told() {
    let part = ("PART", square(2.0, 2.0, 6.0));
    let holes = ("HOLES", vec![circle(4.0, 4.0, 0.5), circle(6.0, 6.0, 0.5)]);
    let sheet = ("A4", square(0.0, 0.0, 10.0));
    let double = ("A4", [square(0.0, 0.0, 10.0), square(1.0, 1.0, 8.0)].concat());
    for frame in [sheet.clone(), double] {
        let notes = notes_of(&[frame, part.clone(), holes.clone()]);
        assert!(notes.contains("Layer A4") && notes.contains("--skip-layers A4"), "{notes}");
    }
    // A box of the title block holds nothing.
    let titled = ("A4", [square(0.0, 0.0, 10.0), square(8.5, 0.2, 1.0)].concat());
    let notes = notes_of(&[titled, part.clone(), holes.clone()]);
    assert!(notes.contains("--skip-layers A4"), "{notes}");
    // A plate with holes is no frame, unless it is called one; nor is what holds nothing.
    assert_eq!(notes_of(&[sheet.clone(), part.clone()]), "");
    assert_eq!(notes_of(&[part.clone(), holes.clone()]), "");
    assert!(notes_of(&[("Title frame", square(0.0, 0.0, 10.0)), part]).contains("--skip-layers 'Title frame'"));
}

#[test]
fn outlines_that_cross_those_of_another_layer_are_told() {
    let disk =
        ("0", vec![circle(0.0, 0.0, 10.0), circle(6.0, 0.0, 1.0), circle(-6.0, 0.0, 1.0), circle(0.0, 6.0, 1.0)]);
    let bolts = ("CENTER", vec![circle(0.0, 0.0, 6.0)]);
    let notes = notes_of(&[disk.clone(), bolts]);
    assert!(notes.contains("layer CENTER cross those of layer 0") && notes.contains("5 places more"), "{notes}");
    assert!(notes.contains("--skip-layers CENTER"), "{notes}");
    // On one layer with its holes, too; but not holes that run into each other.
    let notes = notes_of(&[("0", [disk.1.clone(), vec![circle(0.0, 0.0, 6.0)]].concat())]);
    assert!(notes.contains("curve on 0 crosses 3 circles of its layer") && notes.contains("--skip-layers"), "{notes}");
    let row = (0..6).map(|i| circle(f64::from(i), 0.0, 0.8)).collect();
    assert_eq!(notes_of(&[("0", row)]), "");
    // What only touches, shares a wall, or is open, crosses nothing.
    let beside = ("SIDE", vec![circle(12.0, 0.0, 2.0)]);
    assert_eq!(notes_of(&[disk, beside]), "");
    assert_eq!(notes_of(&[("A", square(0.0, 0.0, 2.0)), ("B", square(2.0, 0.0, 2.0))]), "");
    let open = notes_of(&[("A", square(0.0, 0.0, 2.0)), ("B", vec![line((-1.0, 1.0), (3.0, 1.0))])]);
    assert!(!open.contains("cross"), "{open}");
}
