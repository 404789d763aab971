//! Whether facets, segments and regions keep their names.

use super::evidence::{Evidence, place};
use super::facets::cells_of;
use crate::ids::{Id, RegionId};
use crate::solid::{Material, RegionSeed, Solid};
use crate::verify::tally::Tally;
use crate::verify::{Check, Status};
use std::collections::BTreeSet;

/// Triangles and edges have the names of the facets and segments that they lie on, where those have one, and the region
/// around a named point has that name, of several such points that of one. Checked: linked triangles and edges, and named
/// points.
pub fn names(ev: &Evidence, solid: &Solid) -> Check {
    let mut tally = Tally::highest("names");
    for triangle in &ev.mesh.triangles {
        let Some(name) = triangle.facet.and_then(|f| solid.facets()[f].name) else { continue };
        tally.count();
        let (has, right) = (ev.mesh.names.text(triangle.name), solid.names().text(name));
        if has != right {
            tally.flaw(|| format!("{} is named \"{has}\" instead of \"{right}\"", ev.tell_triangle(triangle.nodes)));
        }
    }
    for edge in &ev.mesh.edges {
        let Some(s) = edge.segment else { continue };
        tally.count();
        let has = edge.name.map(|name| ev.mesh.names.text(name));
        let right = solid.segments()[s].name.map(|name| solid.names().text(name));
        if has != right {
            tally.flaw(|| format!("{} is named {has:?} instead of {right:?}", ev.tell_edge(edge.nodes)));
        }
    }
    match solid.material() {
        Material::Cells { regions, .. } => seeds(ev, solid, regions, &mut tally),
        Material::Winding => {}
    }
    tally.finish(Status::Proven)
}

fn seeds(ev: &Evidence, solid: &Solid, seeds: &[RegionSeed], tally: &mut Tally) {
    let places: Vec<[f64; 3]> = seeds.iter().map(|seed| seed.at).collect();
    let cells = cells_of(ev, &places);
    let regions: Vec<Option<RegionId>> =
        cells.into_iter().map(|cell| cell.map(|t| ev.mesh.tetrahedron_regions[t])).collect();
    let text = |region: RegionId| ev.mesh.names.text(ev.mesh.regions[region]);
    let found =
        regions.iter().zip(seeds).filter_map(|(region, seed)| Some(((*region)?, solid.names().text(seed.name))));
    let right: BTreeSet<RegionId> = found.filter(|&(r, name)| text(r) == name).map(|(r, _)| r).collect();
    for (region, seed) in regions.iter().zip(seeds) {
        tally.count();
        let name = solid.names().text(seed.name);
        if let Some(region) = region.filter(|r| !right.contains(r)) {
            let (n, has, at) = (region.index(), text(region), place(seed.at));
            tally.flaw(|| format!("region {n} at {at} is named \"{has}\" instead of \"{name}\""));
        }
    }
}
