//! Regions: which faces are kept, which seeds and labels lie in them, and their names.
//!
//! ```text
//!   ╭──────────────────╮       A seed × belongs to the face in which it lies: the one on the visible side of a curve
//!   │ × steel  ╭─────╮ │       next to it. × steel names the outer face; ○ makes the inner one a hole.
//!   │          │  ○  │ │
//!   │          ╰─────╯ │
//!   ╰──────────────────╯
//! ```

use super::arrangement::Arrangement;
use super::error::{ArrangeError, Unarranged};
use super::faces::Faces;
use super::fill::Fill;
use super::repair::{Repair, RepairKind};
use super::trace::{DirectedEdge, tracing};
use super::{ArrangeOptions, FillRule};
use crate::domain::locate::{Locator, Side, VisibleSide};
use crate::domain::{Domain, Drawing, Region, SeedKind};
use crate::geometry::{Point, extent};
use crate::ids::{LayerId, NameId, RegionId};
use crate::watch::{Stopped, Watch};
use std::collections::{BTreeMap, BTreeSet};

/// What a seed makes of the face in which it lies.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Said {
    Hole,
    Region(NameId, Option<f64>),
}

/// Chooses the faces that are kept, names their regions and writes them on the sides of the curves. `domain` was made
/// of `arrangement`.
///
/// # Errors
///
/// Where no face is kept, and where `watch` ends the run.
pub(super) fn keep(
    arrangement: &Arrangement,
    domain: &mut Domain,
    faces: &Faces,
    rule: FillRule,
    options: &ArrangeOptions,
    watch: &mut Watch,
) -> Result<(), Unarranged> {
    let Fill { inside: mut kept, painted } = Fill::new(arrangement, domain, faces, rule, options.fragments);
    let said = read_seeds(arrangement, domain, faces, watch)?;
    for (face, said) in said.iter().enumerate() {
        kept[face] &= options.keep_all || *said != Some(Said::Hole);
    }
    if !kept.contains(&true) {
        return Err(nothing_to_mesh(arrangement, faces, rule).into());
    }
    let areas = face_areas(faces);
    let labels = read_labels(arrangement, domain, faces, watch)?;
    let mut named: Vec<Option<(NameId, Option<f64>)>> = vec![None; kept.len()];
    for face in (0..kept.len()).filter(|&face| kept[face]) {
        named[face] = match said[face] {
            Some(Said::Region(name, max_area)) => Some((name, max_area)),
            Some(Said::Hole) | None => {
                let label = || labels[face].map(|text| domain.names.intern(text));
                painted[face].or_else(label).map(|name| (name, None))
            }
        };
    }
    let region_of = name_regions(arrangement, domain, faces, &kept, |face| named[face], &areas);
    let region = |directed: DirectedEdge| faces.face(directed).and_then(|face| region_of[face]);
    for id in domain.curves.ids() {
        let sides = [Side::Left, Side::Right].map(|side| region(DirectedEdge { curve: id, side }));
        domain.curves[id].sides = sides;
    }
    Ok(())
}

/// The seed that decides about each face. Holes take precedence over region names, and of several names the first.
fn read_seeds(
    arrangement: &Arrangement,
    domain: &mut Domain,
    faces: &Faces,
    watch: &mut Watch,
) -> Result<Vec<Option<Said>>, Stopped> {
    let seeds = &arrangement.drawing.seeds;
    let mut said: Vec<Option<Said>> = vec![None; faces.cycles.len()];
    let mut repairs = Vec::new();
    let locator = Locator::new(domain);
    let is_hole = |k: &SeedKind| matches!(k, SeedKind::Hole);
    let holes_first = [true, false].into_iter().flat_map(|hole| seeds.iter().filter(move |s| is_hole(&s.kind) == hole));
    for (k, seed) in holes_first.enumerate() {
        tracing(domain, seeds.len() - k).tell(watch)?;
        let sight = locator.sight(seed.at);
        let face = sight.and_then(|VisibleSide { curve, side, .. }| faces.face(DirectedEdge { curve, side }));
        let mut note = |why: &str| {
            let what = format!("{} {why}", seed.entity);
            repairs.push(Repair { kind: RepairKind::Seed, at: [seed.at.x, seed.at.y], size: 0.0, what });
        };
        let on_curve = sight.is_some_and(|s| s.distance <= arrangement.tolerances.weld);
        if on_curve && face.is_some() {
            note("lies on a curve, and was taken for the face on one of its sides");
        }
        let new = match seed.kind {
            SeedKind::Hole => Said::Hole,
            SeedKind::Region { name, max_area } => Said::Region(name, max_area),
        };
        match face.map(|f| (f, said[f])) {
            None if on_curve => note("lies on a curve beside no bounded face and was not used"),
            None => note("lies in no bounded face and was not used"),
            Some((f, None)) => said[f] = Some(new),
            Some((_, Some(old))) if old == new => note("lies in a face that already has such a point"),
            Some(_) => note("lies in a face that another point speaks for, and was not used"),
        }
    }
    domain.repairs.extend(repairs);
    Ok(said)
}

/// The text in each face, where there is exactly one.
fn read_labels<'a>(
    arrangement: &Arrangement<'a>,
    domain: &Domain,
    faces: &Faces,
    watch: &mut Watch,
) -> Result<Vec<Option<&'a str>>, Stopped> {
    let labels = &arrangement.drawing.labels;
    let mut said: Vec<BTreeSet<&str>> = vec![BTreeSet::new(); faces.cycles.len()];
    let locator = Locator::new(domain);
    for (k, label) in labels.iter().enumerate() {
        tracing(domain, labels.len() - k).tell(watch)?;
        let sight = locator.sight(label.at);
        if let Some(face) = sight.and_then(|VisibleSide { curve, side, .. }| faces.face(DirectedEdge { curve, side })) {
            said[face].insert(label.text.as_str());
        }
    }
    Ok(said.into_iter().map(|texts| texts.first().copied().filter(|_| texts.len() == 1)).collect())
}

/// The area of every bounded face: the area of its own cycle minus those enclosed by the components in it.
fn face_areas(faces: &Faces) -> Vec<f64> {
    let mut areas: Vec<f64> = faces.cycles.iter().map(|c| c.area).collect();
    for (component, parent) in faces.parent.iter().enumerate() {
        if let Some(face) = parent {
            areas[*face] += faces.cycles[faces.outer[component]].area;
        }
    }
    areas
}

/// Makes one region for each given name and area limit, in the order of the names. Then makes one for each other kept
/// face, the largest first, under a name that no other region has. Returns the region of each face.
fn name_regions(
    arrangement: &Arrangement,
    domain: &mut Domain,
    faces: &Faces,
    kept: &[bool],
    given: impl Fn(usize) -> Option<(NameId, Option<f64>)>,
    areas: &[f64],
) -> Vec<Option<RegionId>> {
    let mut region_of = vec![None; faces.cycles.len()];
    let (mut named, mut unnamed) = (Vec::new(), Vec::new());
    for face in (0..kept.len()).filter(|&f| kept[f]) {
        match given(face) {
            Some((name, max_area)) => named.push((name, max_area, face)),
            None => unnamed.push(face),
        }
    }
    let limit = |max_area: Option<f64>| max_area.unwrap_or(f64::INFINITY);
    named.sort_by(|a, b| a.0.cmp(&b.0).then(limit(a.1).total_cmp(&limit(b.1))).then(a.2.cmp(&b.2)));
    for group in named.chunk_by(|a, b| a.0 == b.0 && a.1 == b.1) {
        let (name, max_area, _) = group[0];
        let area = group.iter().map(|g| areas[g.2]).sum();
        let id = domain.regions.push(Region { name, is_named: true, area, max_area });
        group.iter().for_each(|g| region_of[g.2] = Some(id));
    }
    let place = |face: usize| {
        let points = faces.cycles[face].edges.iter().map(|&h| domain.points[h.tail(domain)]);
        points.map(|p| [p.y, p.x]).min_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))).unwrap_or_default()
    };
    let mut placed: Vec<(f64, [f64; 2], usize)> = unnamed.into_iter().map(|f| (areas[f], place(f), f)).collect();
    placed.sort_by(|a, b| {
        let lower = a.1[0].total_cmp(&b.1[0]).then(a.1[1].total_cmp(&b.1[1]));
        b.0.total_cmp(&a.0).then(lower).then(a.2.cmp(&b.2))
    });
    let outlines: Vec<Option<&str>> =
        placed.iter().map(|&(_, _, face)| layer_of_outline(arrangement, faces, face)).collect();
    let names = numbered(domain, &outlines);
    for ((area, _, face), name) in placed.into_iter().zip(names) {
        let name = domain.names.intern(&name);
        region_of[face] = Some(domain.regions.push(Region { name, is_named: false, area, max_area: None }));
    }
    region_of
}

/// The layer with the greatest part of a face's outline. `None` where the file has no layers, and for layer 0, which
/// every file has.
fn layer_of_outline<'a>(arrangement: &Arrangement<'a>, faces: &Faces, face: usize) -> Option<&'a str> {
    let drawing = arrangement.drawing;
    let mut lengths: BTreeMap<LayerId, f64> = BTreeMap::new();
    for directed in &faces.cycles[face].edges {
        let edge = &arrangement.edges[directed.curve];
        if let Some(layer) = drawing.curves[edge.source as usize].layer {
            *lengths.entry(layer).or_default() += extent(edge.bounds);
        }
    }
    let (&layer, _) = lengths.iter().max_by(|a, b| a.1.total_cmp(b.1))?;
    Some(drawing.layers[layer].name.as_str()).filter(|name| !name.is_empty() && *name != "0")
}

/// Names that no region has yet: the layer's name, or `region`, with a number where several would be equal.
fn numbered(domain: &Domain, outlines: &[Option<&str>]) -> Vec<String> {
    let mut taken: BTreeSet<String> = domain.regions.iter().map(|r| domain.name(r.name).to_owned()).collect();
    let bases: Vec<&str> = outlines.iter().map(|outline| outline.unwrap_or("region")).collect();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    bases.iter().for_each(|&base| *counts.entry(base).or_default() += 1);
    let mut last: BTreeMap<&str, usize> = BTreeMap::new();
    let mut names = Vec::with_capacity(bases.len());
    for base in bases {
        let mut name = base.to_owned();
        let number = last.entry(base).or_default();
        while taken.contains(&name) || counts[base] > 1 && name == base {
            *number += 1;
            name = format!("{base}{number}");
        }
        taken.insert(name.clone());
        names.push(name);
    }
    names
}

/// The error that says why no face is kept; at the first free end, if free ends are the reason.
fn nothing_to_mesh(arrangement: &Arrangement, faces: &Faces, rule: FillRule) -> ArrangeError {
    let has_faces = faces.cycles.len() > faces.outer.len();
    let first = arrangement.drawing.curves.first().map_or(Point::ORIGIN, |c| c.curve.start());
    if let Some(error) = cut_away(arrangement.drawing, rule) {
        return error;
    }
    if has_faces {
        return all_outside(rule, first);
    }
    let free = arrangement.free_ends();
    let Some(end) = free.first() else {
        let help = "the curves enclose nothing: draw a closed outline";
        return ArrangeError::new("nothing to mesh: no closed region", first, help);
    };
    let gap = free[1..].iter().map(|other| other.at.distance(end.at)).reduce(f64::min);
    let away = gap
        .map_or_else(String::new, |gap| format!("{} away from the next free end: ", arrangement.tolerances.told(gap)));
    let what = format!("nothing to mesh: no closed region; {} ends freely", arrangement.entity_of(end));
    ArrangeError::new(what, end.at, format!("{away}close the outline by another curve"))
}

/// The error that clips cut away all shapes; `None` where some shape is not clipped.
fn cut_away(drawing: &Drawing, rule: FillRule) -> Option<ArrangeError> {
    match rule {
        FillRule::Shapes | FillRule::EvenOddAndShapes => {}
        FillRule::Regions | FillRule::NonZero | FillRule::EvenOdd => return None,
    }
    let mut painted = drawing.shapes.enumerate().filter(|(_, shape)| shape.part_of.is_none());
    let (id, shape) = painted.next()?;
    if shape.clip.is_none() || painted.any(|(_, other)| other.clip.is_none()) {
        return None;
    }
    let outline = drawing.curves.iter().find(|c| c.shape == Some(id));
    let part = drawing.shapes.iter().find(|part| part.part_of == shape.clip);
    let clip = part.map_or("a clip without extent", |part| &part.entity);
    let what =
        format!("nothing to mesh: {} and all other shapes are cut away; the first is cut by {clip}", shape.entity);
    let at = outline.map_or(Point::ORIGIN, |c| c.curve.start());
    Some(ArrangeError::new(what, at, "move the clip over what it cuts, or take it off"))
}

/// The error that says why none of a drawing's faces is kept.
fn all_outside(rule: FillRule, at: Point) -> ArrangeError {
    let error = |what: &str, help: &str| ArrangeError::new(format!("nothing to mesh: {what}"), at, help);
    match rule {
        FillRule::Regions => error("a hole point lies in every closed region", "remove hole points"),
        FillRule::NonZero | FillRule::EvenOdd | FillRule::Shapes | FillRule::EvenOddAndShapes => error(
            "every closed region is a hole or outside by the fill rule",
            "choose another fill rule (`regions` keeps every bounded face), or remove hole points",
        ),
    }
}
