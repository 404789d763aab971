//! Names of regions: of layers and of texts.

use super::*;

fn region_names(entities: &str) -> Vec<String> {
    let domain = drawn(entities).arrange(&ArrangeOptions::default()).unwrap();
    domain.regions().iter().map(|region| domain.name(region.name).to_owned()).collect()
}

#[test]
fn regions_take_the_layer_of_their_outline() {
    let [steel, copper, plain] = [square("STEEL", 0.0, 4.0), square("COPPER", 10.0, 3.0), square("0", 20.0, 2.0)];
    assert_eq!(region_names(&(steel.clone() + &copper + &plain)), ["STEEL", "COPPER", "region"]);
    // Regions of one layer stay apart: the largest is the first.
    assert_eq!(region_names(&(steel.clone() + &square("STEEL", 10.0, 5.0))), ["STEEL1", "STEEL2"]);
    assert_eq!(region_names(&plain), ["region"]);
}

#[test]
fn a_text_that_stands_alone_in_a_region_names_it() {
    let squares = square("PARTS", 0.0, 4.0) + &square("PARTS", 10.0, 4.0);
    let text = |kind: &str, x: f64, said: &str| format!("0 {kind}; 8 NOTES; 10 {x}; 20 2; 40 0.5; 1 {said}; ");
    let named = |texts: &str| region_names(&(squares.clone() + texts));
    assert_eq!(named(&(text("TEXT", 1.0, "Core") + &text("MTEXT", 11.0, "{Coil\\P2}"))), ["Core", "Coil 2"]);
    // Two texts name nothing, nor does a number, nor what stands outside.
    let texts = text("TEXT", 1.0, "Core")
        + &text("TEXT", 2.0, "M8")
        + &text("TEXT", 11.0, "12.5")
        + &text("TEXT", 50.0, "Scale");
    assert_eq!(named(&texts), ["PARTS1", "PARTS2"]);
    assert!(drawn(&(squares + &texts)).skipped.iter().any(|s| s.entity == "TEXT" && s.count == 4));
}
