//! Seeds, drawn points, the box of `keep all`.

use super::*;

#[test]
fn seeds_cut_holes_and_name_regions() {
    let mut rings = drawing((0..5).flat_map(|i| square(f64::from(i), f64::from(i), 20.0 - 2.0 * f64::from(i))));
    let steel = rings.names.intern("steel");
    let limit = Some(0.5);
    rings.seeds = vec![
        seed(0.5, 0.5, SeedKind::Region { name: steel, max_area: limit }),
        seed(10.0, 10.0, SeedKind::Region { name: steel, max_area: limit }),
        seed(1.5, 1.5, SeedKind::Hole),
        seed(50.0, 0.0, SeedKind::Hole),
        seed(1.5, 18.5, SeedKind::Hole),
    ];
    let domain = regions(&rings);
    assert_eq!(repairs(&domain, RepairKind::Seed), 2);
    let names: Vec<&str> = domain.regions().iter().map(|r| domain.name(r.name)).collect();
    assert_eq!(names, ["steel", "region1", "region2"]);
    close(&areas(&domain), &[400.0 - 324.0 + 144.0, 256.0 - 196.0, 196.0 - 144.0]);
    assert_eq!(domain.regions().iter().next().unwrap().max_area, limit);
    let region = |x: f64| domain.locate_region(p(x, 10.0)).map(|r| domain.name(domain.regions()[r].name));
    assert_eq!(
        [0.5, 1.5, 2.5, 3.5, 4.5].map(region),
        [Some("steel"), None, Some("region1"), Some("region2"), Some("steel")]
    );
    assert_eq!(region(-1.0), None);
}

#[test]
fn drawn_points_are_kept_and_split_what_they_lie_on() {
    let mut drawn = drawing(square(0.0, 0.0, 2.0));
    let name = drawn.names.intern("probe");
    for (x, y) in [(1.0, 1.0), (1.0, 0.0), (2.0, 2.0), (9.0, 9.0)] {
        drawn.points.push(DrawnPoint { at: p(x, y), name: Some(name), entity: format!("point {x} {y}") });
    }
    let domain = regions(&drawn);
    assert_eq!((domain.points().len(), domain.curves().len()), (7, 5));
    assert_eq!(domain.point_names().len(), 4);
    assert!(domain.point_names().keys().any(|&q| domain.points()[q] == p(1.0, 0.0) && domain.star(q).len() == 2));
}

#[test]
fn keep_all_adds_a_box_and_keeps_every_face() {
    let mut drawn = drawing([circle(0.0, 0.0, 1.0), circle(0.0, 0.0, 0.5)]);
    drawn.seeds.push(seed(0.0, 0.0, SeedKind::Hole));
    let domain = drawn.arrange(&ArrangeOptions { keep_all: true, ..Default::default() }).unwrap();
    assert_eq!(domain.flaws(), [""; 0]);
    let side = 2.0 + 2.0 * 8f64.sqrt();
    close(&areas(&domain), &[side * side - PI, 0.75 * PI, 0.25 * PI]);
    assert_eq!(domain.curves().iter().filter(|c| domain.name(c.name) == "box").count(), 4);
}
