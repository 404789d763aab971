//! Layers of a DXF drawing at the command line: listed, chosen, coloured.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A plate with a bore on PART, a frame on FRAME, a centre line on AXES.
fn drawing(name: &str) -> PathBuf {
    let rectangle = |layer: &str, [x0, y0, x1, y1]: [f64; 4]| {
        format!(
            "0\nLWPOLYLINE\n8\n{layer}\n70\n1\n10\n{x0}\n20\n{y0}\n10\n{x1}\n20\n{y0}\n10\n{x1}\n20\n{y1}\n10\n{x0}\n20\n{y1}\n"
        )
    };
    let text = [
        "0\nSECTION\n2\nENTITIES\n",
        &rectangle("FRAME", [-10.0, -10.0, 50.0, 40.0]),
        &rectangle("PART", [0.0, 0.0, 40.0, 30.0]),
        "0\nCIRCLE\n8\nPART\n10\n20\n20\n15\n40\n5\n",
        "0\nLINE\n8\nAXES\n6\nCENTER\n10\n-5\n20\n15\n11\n45\n21\n15\n",
        "0\nENDSEC\n0\nEOF\n",
    ]
    .concat();
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("layers-{name}.dxf"));
    fs::write(&path, text).expect("an input is written");
    path
}

fn squinch(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_squinch")).args(arguments).env("NO_COLOR", "1").output().expect("squinch starts")
}

fn found(arguments: &[&str]) -> serde_json::Value {
    serde_json::from_slice(&squinch(&[&["inspect", "--json"], arguments].concat()).stdout).expect("JSON")
}

#[test]
fn inspect_lists_layers() {
    let path = drawing("inspect");
    let path = path.to_str().unwrap();
    let layers = found(&[path])["layers"].clone();
    let part = layers.as_array().unwrap().iter().find(|layer| layer["name"] == "PART").unwrap();
    assert_eq!((part["entities"].as_u64(), part["closed_loops"].as_u64()), (Some(2), Some(2)));
    assert!((part["area"].as_f64().unwrap() - (1200.0 - 25.0 * std::f64::consts::PI)).abs() < 1e-9);
    assert_eq!(part["line_types"]["CONTINUOUS"], 2);
    let text = String::from_utf8(squinch(&["inspect", path]).stdout).unwrap();
    assert!(text.contains("FRAME: 1 entity, CONTINUOUS, 1 closed loop, area 3000"), "{text}");
    assert!(text.contains("1 LINE: of a line type that draws no edge"), "{text}");
}

#[test]
fn layers_and_line_types_are_chosen() {
    let path = drawing("choose");
    let path = path.to_str().unwrap();
    let area = |arguments: &[&str]| found(&[&[path], arguments].concat())["domain"]["area"].as_f64().unwrap();
    let part = 1200.0 - 25.0 * std::f64::consts::PI;
    for arguments in [["--skip-layers", "frame"], ["--layers", "P*"]] {
        assert!((area(&arguments) - part).abs() < 1e-9, "{arguments:?}");
    }
    assert_eq!(found(&[path, "--line-types", "all"])["curves"]["line"], 9);
    let unknown = squinch(&["inspect", path, "--layers", "PRAT"]);
    assert_ne!(unknown.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&unknown.stderr).contains("PART"));
}

#[test]
fn a_picture_shows_layers() {
    let path = drawing("draw");
    let path = path.to_str().unwrap();
    let svg = String::from_utf8(squinch(&["draw", path, "--colour", "layer", "-o", "-"]).stdout).unwrap();
    assert!(svg.contains("FRAME") && svg.contains("PART"));
    assert_eq!(squinch(&["draw", path, "--colour", "layer", "--stage", "mesh", "-o", "-"]).status.code(), Some(2));
}
