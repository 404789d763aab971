//! STEP files (ISO 10303-21), whatever their application protocol: a planar face of a solid, with its holes and curved
//! edges.
//!
//! step-io parses the entities by number. This module interprets them (ISO 10303-42). step-io's model of products is
//! not used, because it renumbers entities, and messages could not name an edge of the file.
//!
//! A file has many faces and a drawing has one plane, so one planar face is read: the largest, or the one that is asked
//! for. Faces on other surfaces are counted as left out. Coordinates are those of the part: the placements of an
//! assembly are not applied.

use super::MOST_LISTED;
use super::entity::{Entity, File, Result, parsed, parts};
use super::space::Surface;
use super::units::Context;
use crate::cad::{Edge, Face, FaceError, SpaceCurve};
use crate::domain::{Drawing, FaceInfo, Skipped};
use crate::geometry::Frame;
use crate::geometry::space::times;
use crate::import::ImportError;
use std::collections::BTreeMap;
use step_io::parser::Graph;

/// Reads one planar face: the one with the given number (`12` or `#12`) or name, else the largest.
///
/// # Errors
/// [`ImportError`] with the line where the file breaks the format or an entity cannot be read. Also where there is no
/// planar face, or not the one that is asked for.
pub fn read(bytes: &[u8], stem: &str, face: Option<&str>) -> Result<Drawing> {
    let (graph, mended) = parsed(bytes)?;
    let file = File { graph: &graph };
    let contexts = file.contexts_of_faces();
    let faces = file.faces(&contexts);
    let infos: Vec<FaceInfo> = faces.planar.iter().map(|planar| file.info(planar)).collect();
    let chosen = match face.filter(|wanted| *wanted != "largest") {
        Some(wanted) => file.wanted(&faces, wanted)?,
        None => largest(&infos, &faces)?,
    };
    let planar = &faces.planar[chosen];
    let face = planar.face.as_ref().map_err(Clone::clone)?;
    let mut drawing = face.drawing().map_err(|error| file.located(planar.id, error))?;
    drawing.format = "STEP".into();
    drawing.title = format!("{stem}, {}", face.name);
    drawing.unit = contexts.get(&planar.id).and_then(|context| context.unit.clone());
    drawing.notes.extend(mended);
    drawing.notes.extend(others(&infos, chosen));
    drawing.skipped = faces.skipped(&graph);
    drawing.faces = infos;
    Ok(drawing)
}

/// Each planar face of a file, by number.
///
/// # Errors
/// [`ImportError`] where the file breaks the format. A face that cannot be drawn is listed with its flaw.
pub fn faces(bytes: &[u8]) -> Result<Vec<FaceInfo>> {
    let (graph, _) = parsed(bytes)?;
    let file = File { graph: &graph };
    Ok(file.faces(&file.contexts_of_faces()).planar.iter().map(|planar| file.info(planar)).collect())
}

/// The planar faces, and the counts of others by surface.
struct Faces {
    planar: Vec<Planar>,
    curved: BTreeMap<String, Vec<u64>>,
}

struct Planar {
    id: u64,
    /// Empty where it has no name.
    name: String,
    frame: Frame,
    face: Result<Face>,
}

/// The largest face that can be drawn; if none can, the first one, whose flaw is then reported.
fn largest(infos: &[FaceInfo], faces: &Faces) -> Result<usize> {
    let area = |i: usize| infos[i].area.unwrap_or(f64::NEG_INFINITY);
    // The first of equal ones.
    let largest = (0..infos.len()).reduce(|a, b| if area(b) > area(a) { b } else { a });
    largest.ok_or_else(|| {
        let what = match faces.curved.is_empty() {
            true => "the file holds no faces".into(),
            false => format!("the file has no planar face: {}", faces.curved_kinds()),
        };
        ImportError::new(what, "only planar faces can be meshed yet; curved faces and solids cannot")
    })
}

/// One sentence about the faces that were not chosen.
fn others(infos: &[FaceInfo], chosen: usize) -> Option<String> {
    let mut others: Vec<&FaceInfo> =
        infos.iter().enumerate().filter(|(i, _)| *i != chosen).map(|(_, info)| info).collect();
    if others.is_empty() {
        return None;
    }
    let area = |info: &FaceInfo| info.area.unwrap_or(0.0);
    others.sort_by(|a, b| area(b).total_cmp(&area(a)));
    let label = |info: &FaceInfo| match info.name.as_str() {
        "" => format!("#{}", info.id),
        name => format!("#{} {name}", info.id),
    };
    let listed = others.iter().take(MOST_LISTED).map(|info| {
        let [x, y, z] = info.normal.map(|n| (n * 1e3).round() / 1e3 + 0.0);
        format!("{} (area {}, normal {x} {y} {z})", label(info), six_digits(area(info)))
    });
    let listed: Vec<String> = listed.collect();
    let more = match others.len() - listed.len() {
        0 => String::new(),
        n => format!(", and {n} more, which inspect lists"),
    };
    let list = listed.join(", ");
    Some(format!("planar face {} was read; --face picks another: {list}{more}", label(&infos[chosen])))
}

fn six_digits(value: f64) -> String {
    format!("{value:.5e}").parse::<f64>().unwrap_or(value).to_string()
}

impl Faces {
    fn curved_kinds(&self) -> String {
        let kinds: Vec<String> = self.curved.iter().map(|(kind, ids)| format!("{} on {kind}", ids.len())).collect();
        kinds.join(", ")
    }

    fn skipped(&self, graph: &Graph) -> Vec<Skipped> {
        let why = "only planar faces are meshed; curved faces and solids are not yet".to_owned();
        let curved = self.curved.iter();
        let mut skipped: Vec<Skipped> = curved
            .map(|(kind, ids)| Skipped { entity: format!("faces on {kind}"), count: ids.len(), why: why.clone() })
            .collect();
        const PLACEMENT: &str = "NEXT_ASSEMBLY_USAGE_OCCURRENCE";
        let count = graph.entities.values().flat_map(parts).filter(|e| e.kind == PLACEMENT).count();
        if count > 0 {
            let why = "a face keeps the coordinates of its own part: placements are not applied".into();
            skipped.push(Skipped { entity: PLACEMENT.into(), count, why });
        }
        skipped
    }
}

impl File<'_> {
    fn faces(&self, contexts: &BTreeMap<u64, Context>) -> Faces {
        let mut faces = Faces { planar: Vec::new(), curved: BTreeMap::new() };
        let of_kind = |entity: &Entity| matches!(entity.kind, "ADVANCED_FACE" | "FACE_SURFACE");
        for entity in self.graph.entities.values().flat_map(parts).filter(of_kind) {
            let context = contexts.get(&entity.id);
            let uncertainty = context.and_then(|c| c.uncertainty).unwrap_or(0.0);
            match entity.reference(2).and_then(|surface| self.plane(surface, uncertainty)) {
                Ok(Surface::Plane(frame)) => {
                    let face = self.face(&entity, frame, uncertainty);
                    let frame = face.as_ref().map_or(frame, |face| face.frame);
                    let name = entity.name().unwrap_or_default().to_owned();
                    faces.planar.push(Planar { id: entity.id, name, frame, face });
                }
                Ok(Surface::Curved(kind)) => faces.curved.entry(kind).or_default().push(entity.id),
                Err(error) => faces
                    .curved
                    .entry(format!("a surface that cannot be read ({})", error.what))
                    .or_default()
                    .push(entity.id),
            }
        }
        faces
    }

    fn face(&self, entity: &Entity, frame: Frame, uncertainty: f64) -> Result<Face> {
        let outward = entity.flag(3)?;
        // Seen from outside, whatever the orientation of the surface.
        let frame = if outward { frame } else { Frame { y: times(frame.y, -1.0), ..frame } };
        let name = entity.name().map_or_else(|| format!("face #{}", entity.id), str::to_owned);
        let bounds = entity.references(1)?;
        let loops = bounds.into_iter().map(|bound| self.bound(bound, entity.id)).collect::<Result<Vec<_>>>()?;
        let loops = loops.into_iter().filter(|edges| !edges.is_empty()).collect();
        Ok(Face { frame, name, entity: format!("{} #{}", entity.kind, entity.id), loops, uncertainty })
    }

    fn info(&self, planar: &Planar) -> FaceInfo {
        let flat = planar.face.as_ref().map_err(|e| e.what.clone()).and_then(|f| f.flat().map_err(|e| e.to_string()));
        let name = planar.name.clone();
        let (area, flaw) = match flat {
            Ok(flat) => (Some(flat.area), None),
            Err(flaw) => (None, Some(flaw)),
        };
        FaceInfo { id: planar.id, name, area, normal: planar.frame.normal(), flaw }
    }

    /// The planar face with a number or a name.
    fn wanted(&self, faces: &Faces, wanted: &str) -> Result<usize> {
        // As the file writes it, as regions are named, or the number alone.
        let number = wanted.strip_prefix("face ").unwrap_or(wanted);
        let id: Option<u64> = number.strip_prefix('#').unwrap_or(number).parse().ok();
        if let Some(found) = faces.planar.iter().position(|planar| Some(planar.id) == id) {
            return Ok(found);
        }
        let surface = faces.curved.iter().find(|(_, ids)| id.is_some_and(|id| ids.contains(&id)));
        if let Some((kind, _)) = surface {
            let what = format!("face {wanted} lies on a {kind}: only planar faces can be meshed yet");
            return Err(ImportError::new(what, "pick a planar face; inspect lists them"));
        }
        let named = faces.planar.iter().enumerate().filter(|(_, planar)| !wanted.is_empty() && planar.name == wanted);
        let found: Vec<usize> = named.map(|(i, _)| i).collect();
        match found.as_slice() {
            [one] => Ok(*one),
            [] => {
                let count = faces.planar.len();
                let help =
                    format!("inspect lists the {count} planar faces of the file; batch meshes each by --face all");
                Err(ImportError::new(format!("--face {wanted}: there is no planar face of this number or name"), help))
            }
            many => {
                let ids: Vec<String> =
                    many.iter().take(MOST_LISTED).map(|i| format!("#{}", faces.planar[*i].id)).collect();
                let what = format!("--face {wanted}: {} faces have this name", many.len());
                Err(ImportError::new(what, format!("pick one by its number: {}", ids.join(", "))))
            }
        }
    }

    fn located(&self, face: u64, error: FaceError) -> ImportError {
        let line = self.graph.get(face).map_or(0, |raw| raw.span().line as usize);
        ImportError::at(
            line,
            error.to_string(),
            "repair the face in the program that made it, or pick another by --face",
        )
    }

    /// The edges of a bound.
    fn bound(&self, id: u64, face: u64) -> Result<Vec<Edge>> {
        let bound = self.entity(id, &["FACE_BOUND", "FACE_OUTER_BOUND"])?;
        let (along, path) = (bound.flag(2)?, bound.reference(1)?);
        let path = self.entity(path, &["EDGE_LOOP", "POLY_LOOP", "VERTEX_LOOP"])?;
        let mut edges = match path.kind {
            "EDGE_LOOP" => {
                path.references(1)?.into_iter().map(|id| self.oriented_edge(id, face)).collect::<Result<_>>()?
            }
            "POLY_LOOP" => self.polygon(&path, face)?,
            // A single point on the face bounds nothing.
            _ => Vec::new(),
        };
        if !along {
            edges.reverse();
            edges.iter_mut().for_each(|edge| edge.backward = !edge.backward);
        }
        Ok(edges)
    }

    fn polygon(&self, path: &Entity, face: u64) -> Result<Vec<Edge>> {
        let points = path.references(1)?.into_iter().map(|id| self.point(id)).collect::<Result<Vec<_>>>()?;
        let next = points.iter().cycle().skip(1);
        let edge = |ends: [[f64; 3]; 2]| Edge {
            curve: SpaceCurve::Line,
            ends,
            same_sense: true,
            backward: false,
            name: format!("loop #{}", path.id),
            entity: format!("POLY_LOOP #{} of face #{face}", path.id),
        };
        Ok(points.iter().zip(next).map(|(a, b)| edge([*a, *b])).collect())
    }

    fn oriented_edge(&self, id: u64, face: u64) -> Result<Edge> {
        let oriented = self.entity(id, &["ORIENTED_EDGE"])?;
        let (edge, along) = (oriented.reference(3)?, oriented.flag(4)?);
        let edge = self.entity(edge, &["EDGE_CURVE"])?;
        let ends = [self.vertex(edge.reference(1)?)?, self.vertex(edge.reference(2)?)?];
        let (curve, with_basis) = self.curve(edge.reference(3)?)?;
        Ok(Edge {
            curve,
            ends,
            same_sense: edge.flag(4)? == with_basis,
            backward: !along,
            name: edge.name().map_or_else(|| format!("edge #{}", edge.id), str::to_owned),
            entity: format!("EDGE_CURVE #{} of face #{face}", edge.id),
        })
    }
}
