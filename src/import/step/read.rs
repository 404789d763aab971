//! STEP files (ISO 10303-21), whatever their application protocol: a planar face of a solid, with its holes and curved edges.
//!
//! step-io's parser gives the entities by their numbers; what they mean (ISO 10303-42) is read here. Its model of whole products is
//! not used: it gives entities numbers of its own, by which nobody could find an edge in the file.
//!
//! A file holds many faces and a drawing one plane, so one planar face is read: the largest, or the one that is asked for. Faces on
//! other surfaces are counted as left out. Coordinates are those of the face's own part: the placements of an assembly are not applied.

use crate::cad::{Edge, Face, FaceError, SpaceCurve};
use crate::domain::{Drawing, FaceInfo, Skipped};
use crate::geometry::space::{cross, dot, length, minus, plus, times, unit};
use crate::geometry::{Frame, metres};
use crate::import::ImportError;
use std::collections::{BTreeMap, BTreeSet};
use step_io::parser::{Attribute, Graph, RawEntity, Span, parse};

/// The parsed entities take some ten times the file's size in memory.
const MOST_BYTES: usize = 256 << 20;
/// Spans are cut from a spline in time that grows with the cube of the degree; modellers stop at 25.
const MOST_DEGREE: usize = 32;
/// Curves may stand for other curves (surface curves, trimmed curves); a file may nest them in a ring.
const MOST_NESTING: usize = 8;
/// Faces that a note lists; `inspect` lists them all.
const MOST_LISTED: usize = 8;

type Result<T> = std::result::Result<T, ImportError>;

/// Reads one planar face: the one that is asked for by its number (`12` or `#12`) or its name, else the largest.
///
/// # Errors
/// [`ImportError`] with the line where the file breaks the format or an entity cannot be read; also where there is no planar face,
/// or not the one that is asked for.
pub fn read(bytes: &[u8], stem: &str, face: Option<&str>) -> Result<Drawing> {
    let (graph, mended) = parsed(bytes)?;
    let file = File::new(&graph);
    let faces = file.faces();
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
    drawing.unit = file.contexts.get(&planar.id).and_then(|context| context.unit.clone());
    drawing.notes.extend(mended);
    drawing.notes.extend(others(&infos, chosen));
    drawing.skipped = faces.skipped(&graph);
    drawing.faces = infos;
    Ok(drawing)
}

/// Every planar face of a file, by number.
///
/// # Errors
/// [`ImportError`] where the file breaks the format. A face that cannot be drawn is listed with its flaw.
pub fn faces(bytes: &[u8]) -> Result<Vec<FaceInfo>> {
    let (graph, _) = parsed(bytes)?;
    let file = File::new(&graph);
    Ok(file.faces().planar.iter().map(|planar| file.info(planar)).collect())
}

// ---- the parser ----

/// The header entities that the standard asks for, empty.
const HEADER: [(&str, &str); 3] = [
    ("FILE_DESCRIPTION", "FILE_DESCRIPTION((''),'2;1');"),
    ("FILE_NAME", "FILE_NAME('','',(''),(''),'','','');"),
    ("FILE_SCHEMA", "FILE_SCHEMA((''));"),
];

/// The entities, and what was mended to get them. Old writers leave header entities out, of which nothing here depends.
fn parsed(bytes: &[u8]) -> Result<(Graph, Vec<String>)> {
    if bytes.len() > MOST_BYTES {
        let what = format!("the file has {} bytes; at most {MOST_BYTES} are read", bytes.len());
        return Err(ImportError::new(what, "export the part that is to be meshed alone"));
    }
    let mut text = bytes.to_vec();
    let mut notes = Vec::new();
    loop {
        let error = match parse(text.as_slice()) {
            Ok(graph) => {
                notes.extend(graph.warnings.iter().take(MOST_LISTED).map(ToString::to_string));
                return Ok((graph, notes));
            }
            Err(error) => error,
        };
        let missing = match &error {
            step_io::Error::MissingHeaderEntity { name } => HEADER.iter().find(|(known, _)| known == name),
            _ => None,
        };
        // Each of the three is put in once at most.
        let (Some((name, empty)), Some(at)) = (missing, header(&text).filter(|_| notes.len() < HEADER.len())) else {
            return Err(broken(&error));
        };
        text.splice(at..at, empty.bytes());
        notes.push(format!("the header has no {name}: read as if it were empty"));
    }
}

/// Where the header's first entity begins.
fn header(text: &[u8]) -> Option<usize> {
    let word = text.windows(6).position(|word| word == b"HEADER")?;
    Some(word + text[word..].iter().position(|&b| b == b';')? + 1)
}

fn broken(error: &step_io::Error) -> ImportError {
    use step_io::Error::{
        InvalidAttributePosition, Lex, MalformedFileSchema, NestingTooDeep, TooLarge, UnexpectedToken,
    };
    let span: Option<Span> = match error {
        Lex(lex) => Some(lex.span),
        UnexpectedToken { span, .. }
        | MalformedFileSchema { span }
        | InvalidAttributePosition { span, .. }
        | NestingTooDeep { span }
        | TooLarge { span } => Some(*span),
        _ => None,
    };
    let text = error.to_string();
    let what = match (&span, text.split_once(": ")) {
        (Some(_), Some((_, what))) => what.to_owned(),
        _ => text.trim_start_matches("parse error: ").to_owned(),
    };
    let mut error = ImportError::new(what, "the file is damaged or not a STEP file: export it anew");
    error.line = span.map(|span| span.line as usize);
    error.column = span.map(|span| span.column as usize);
    error
}

// ---- entities ----

/// One entity as one of the types that it is, its attributes in the order of that type.
#[derive(Clone, Copy)]
struct Entity<'a> {
    id: u64,
    line: usize,
    kind: &'a str,
    attributes: &'a [Attribute],
}

impl<'a> Entity<'a> {
    fn fail(&self, what: impl std::fmt::Display) -> ImportError {
        let what = format!("{} #{} {what}", self.kind, self.id);
        ImportError::at(self.line, what, "the entity is not as ISO 10303-42 has it: export the file anew")
    }

    fn attribute(&self, i: usize) -> Result<&'a Attribute> {
        self.attributes.get(i).ok_or_else(|| self.fail(format!("has no attribute {}", i + 1)))
    }

    fn reference(&self, i: usize) -> Result<u64> {
        reference(self.attribute(i)?).ok_or_else(|| self.fail(format!("refers to nothing in attribute {}", i + 1)))
    }

    fn list(&self, i: usize) -> Result<&'a [Attribute]> {
        match self.attribute(i)? {
            Attribute::List(list) => Ok(list),
            _ => Err(self.fail(format!("has no list in attribute {}", i + 1))),
        }
    }

    fn references(&self, i: usize) -> Result<Vec<u64>> {
        let list = self.list(i)?.iter().map(reference).collect::<Option<_>>();
        list.ok_or_else(|| self.fail(format!("lists something else than entities in attribute {}", i + 1)))
    }

    fn real(&self, i: usize) -> Result<f64> {
        real(self.attribute(i)?).ok_or_else(|| self.fail(format!("has no number in attribute {}", i + 1)))
    }

    fn reals(&self, i: usize) -> Result<Vec<f64>> {
        let list = self.list(i)?.iter().map(real).collect::<Option<_>>();
        list.ok_or_else(|| self.fail(format!("lists something else than numbers in attribute {}", i + 1)))
    }

    fn whole(&self, i: usize) -> Result<usize> {
        let number = match self.attribute(i)? {
            Attribute::Integer(n) => usize::try_from(*n).ok(),
            _ => None,
        };
        number.ok_or_else(|| self.fail(format!("has no whole number in attribute {}", i + 1)))
    }

    /// `.T.` or `.F.`; unknown counts as true, which is what it mostly is.
    fn flag(&self, i: usize) -> Result<bool> {
        match self.attribute(i)? {
            Attribute::Enum(word) => Ok(word != "F"),
            _ => Err(self.fail(format!("has no truth value in attribute {}", i + 1))),
        }
    }

    /// A name; some writers say `NONE` where there is none.
    fn name(&self) -> Option<&'a str> {
        match self.attributes.first() {
            Some(Attribute::String(name)) => Some(name.trim()).filter(|name| !name.is_empty() && *name != "NONE"),
            _ => None,
        }
    }
}

fn reference(attribute: &Attribute) -> Option<u64> {
    match attribute {
        Attribute::EntityRef(id) => Some(*id),
        _ => None,
    }
}

fn real(attribute: &Attribute) -> Option<f64> {
    match attribute {
        Attribute::Real(value) => Some(*value),
        Attribute::Integer(value) => Some(*value as f64),
        Attribute::Typed { value, .. } => match value.as_ref() {
            Attribute::Real(value) => Some(*value),
            Attribute::Integer(value) => Some(*value as f64),
            _ => None,
        },
        _ => None,
    }
}

/// The types of an entity with their attributes: one, or the parts of a complex one.
fn parts(entity: &RawEntity) -> impl Iterator<Item = Entity<'_>> {
    let (id, line) = (entity.id(), entity.span().line as usize);
    let (simple, complex) = match entity {
        RawEntity::Simple { name, attributes, .. } => (Some((name, attributes)), None),
        RawEntity::Complex { parts, .. } => (None, Some(parts.iter().map(|part| (&part.name, &part.attributes)))),
    };
    let parts = simple.into_iter().chain(complex.into_iter().flatten());
    parts.map(move |(kind, attributes)| Entity { id, line, kind, attributes })
}

// ---- faces ----

struct File<'a> {
    graph: &'a Graph,
    /// What the numbers of a face are measured in.
    contexts: BTreeMap<u64, Context>,
}

/// The planar faces, and the others counted by their surface.
struct Faces {
    planar: Vec<Planar>,
    curved: BTreeMap<String, Vec<u64>>,
}

struct Planar {
    id: u64,
    /// Empty where it has none.
    name: String,
    frame: Frame,
    face: Result<Face>,
}

/// The largest of the faces that can be drawn; where none can, the first, whose flaw is then told.
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

impl<'a> File<'a> {
    fn new(graph: &'a Graph) -> Self {
        let mut file = Self { graph, contexts: BTreeMap::new() };
        file.contexts = file.contexts_of_faces();
        file
    }

    /// An entity as the first of some types that it is.
    fn entity(&self, id: u64, kinds: &[&str]) -> Result<Entity<'a>> {
        let found =
            self.graph.get(id).map(|raw| kinds.iter().find_map(|kind| parts(raw).find(|part| part.kind == *kind)));
        match found {
            Some(Some(entity)) => Ok(entity),
            Some(None) => Err(self.first(id)?.fail(format!("stands where {} is expected", kinds.join(" or ")))),
            None => Err(self.dangling(id)),
        }
    }

    fn dangling(&self, id: u64) -> ImportError {
        ImportError::new(
            format!("#{id} is referred to and not there"),
            "the file is cut short or damaged: export it anew",
        )
    }

    /// The first type of an entity: of a complex one, no more than a word for messages.
    fn first(&self, id: u64) -> Result<Entity<'a>> {
        self.graph.get(id).and_then(|raw| parts(raw).next()).ok_or_else(|| self.dangling(id))
    }

    fn faces(&self) -> Faces {
        let mut faces = Faces { planar: Vec::new(), curved: BTreeMap::new() };
        let of_kind = |entity: &Entity| matches!(entity.kind, "ADVANCED_FACE" | "FACE_SURFACE");
        for entity in self.graph.entities.values().flat_map(parts).filter(of_kind) {
            let context = self.contexts.get(&entity.id);
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
        // Seen from outside, whichever way the surface looks.
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

    /// The planar face of a number or a name.
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
        ImportError::at(line, error.to_string(), "mend the face in the program that made it, or pick another by --face")
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
            // A lone point on the face bounds nothing.
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

// ---- geometry (ISO 10303-42) ----

/// Curves that stand for another, which is their second attribute.
const STAND_INS: [&str; 5] =
    ["SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE", "BOUNDED_SURFACE_CURVE", "TRIMMED_CURVE"];

/// The types that hold a spline's degree and control points; of a complex entity, the first.
const SPLINES: [&str; 5] =
    ["B_SPLINE_CURVE", "B_SPLINE_CURVE_WITH_KNOTS", "BEZIER_CURVE", "QUASI_UNIFORM_CURVE", "UNIFORM_CURVE"];

enum Surface {
    Plane(Frame),
    /// The name of its type.
    Curved(String),
}

impl File<'_> {
    fn triple(&self, entity: &Entity) -> Result<[f64; 3]> {
        let reals = entity.reals(1)?;
        reals.try_into().map_err(|reals: Vec<f64>| entity.fail(format!("has {} coordinates, not 3", reals.len())))
    }

    fn point(&self, id: u64) -> Result<[f64; 3]> {
        let entity = self.entity(id, &["CARTESIAN_POINT"])?;
        let point = self.triple(&entity)?;
        if point.iter().all(|x| x.is_finite()) { Ok(point) } else { Err(entity.fail("is nowhere")) }
    }

    fn vertex(&self, id: u64) -> Result<[f64; 3]> {
        self.point(self.entity(id, &["VERTEX_POINT"])?.reference(1)?)
    }

    /// A direction where there is one.
    fn direction(&self, entity: &Entity, i: usize) -> Result<Option<[f64; 3]>> {
        match entity.attributes.get(i) {
            Some(Attribute::EntityRef(id)) => {
                let direction = self.entity(*id, &["DIRECTION"])?;
                let [x, y, z] = self.triple(&direction)?;
                if unit([x, y, z]).is_none() {
                    return Err(direction.fail("has no direction"));
                }
                Ok(Some([x, y, z]))
            }
            _ => Ok(None),
        }
    }

    /// The axes of a placement in space; those left out are the coordinate axes.
    fn placement(&self, id: u64) -> Result<Frame> {
        let entity = self.entity(id, &["AXIS2_PLACEMENT_3D"])?;
        let axis = self.direction(&entity, 2)?.unwrap_or([0.0, 0.0, 1.0]);
        let toward = self.direction(&entity, 3)?.unwrap_or([1.0, 0.0, 0.0]);
        Frame::of_plane(self.point(entity.reference(1)?)?, axis, toward).ok_or_else(|| entity.fail("has no axes"))
    }

    /// The frame of a surface that is a plane, by its type or by its control points.
    fn plane(&self, id: u64, uncertainty: f64) -> Result<Surface> {
        if let Ok(plane) = self.entity(id, &["PLANE"]) {
            return Ok(Surface::Plane(self.placement(plane.reference(1)?)?));
        }
        let nets = ["B_SPLINE_SURFACE", "B_SPLINE_SURFACE_WITH_KNOTS", "BEZIER_SURFACE", "QUASI_UNIFORM_SURFACE"];
        let Ok(net) = self.entity(id, &nets) else {
            return Ok(Surface::Curved(self.first(id)?.kind.to_owned()));
        };
        // The part of a complex entity has no name before its attributes.
        let simple = usize::from(matches!(net.attributes.first(), Some(Attribute::String(_))));
        let mut rows = Vec::new();
        for row in net.list(2 + simple)? {
            let Attribute::List(row) = row else { return Err(net.fail("has a row that is no list")) };
            let row = row.iter().map(|p| reference(p).ok_or_else(|| net.fail("has a control point that is none")));
            rows.push(row.map(|id| self.point(id?)).collect::<Result<Vec<_>>>()?);
        }
        Ok(plane_of_net(&rows, uncertainty).map_or_else(|| Surface::Curved("B_SPLINE_SURFACE".into()), Surface::Plane))
    }

    /// The curve in space that an entity is or stands for, and whether it runs the same way.
    fn curve(&self, id: u64) -> Result<(SpaceCurve, bool)> {
        let (mut id, mut along) = (id, true);
        for _ in 0..MOST_NESTING {
            let Ok(stand_in) = self.entity(id, &STAND_INS) else { return Ok((self.space_curve(id)?, along)) };
            id = stand_in.reference(1)?;
            if stand_in.kind == "TRIMMED_CURVE" {
                along = along == stand_in.flag(4)?;
            }
        }
        Err(self.first(id)?.fail("stands for itself"))
    }

    fn space_curve(&self, id: u64) -> Result<SpaceCurve> {
        if let Ok(spline) = self.entity(id, &SPLINES) {
            return self.spline(id, &spline);
        }
        let Ok(entity) = self.entity(id, &["LINE", "POLYLINE", "CIRCLE", "ELLIPSE", "PARABOLA", "HYPERBOLA"]) else {
            return Err(self.first(id)?.fail("is no curve that is read here"));
        };
        match entity.kind {
            "LINE" => Ok(SpaceCurve::Line),
            "POLYLINE" => self.polyline(&entity),
            _ => self.conic(&entity),
        }
    }

    fn polyline(&self, entity: &Entity) -> Result<SpaceCurve> {
        let points = entity.references(1)?.into_iter().map(|id| self.point(id)).collect::<Result<Vec<_>>>()?;
        // Clamped: the first knot and the last are twofold.
        let last = points.len().saturating_sub(1);
        let knots = (0..points.len() + 2).map(|i| i.saturating_sub(1).min(last) as f64).collect();
        Ok(SpaceCurve::Nurbs { degree: 1, knots, points, weights: None })
    }

    fn conic(&self, entity: &Entity) -> Result<SpaceCurve> {
        let size = |i: usize| match entity.real(i)? {
            size if size > 0.0 => Ok(size),
            size => Err(entity.fail(format!("has the size {size}"))),
        };
        let Frame { origin, x, y } = self.placement(entity.reference(1)?)?;
        let first = size(2)?;
        Ok(match entity.kind {
            "CIRCLE" => SpaceCurve::Ellipse { center: origin, u: times(x, first), v: times(y, first) },
            "ELLIPSE" => SpaceCurve::Ellipse { center: origin, u: times(x, first), v: times(y, size(3)?) },
            // The first size is the focal distance.
            "PARABOLA" => SpaceCurve::Parabola { apex: origin, u: times(x, first), v: times(y, 2.0 * first) },
            _ => SpaceCurve::Hyperbola { center: origin, u: times(x, first), v: times(y, size(3)?) },
        })
    }

    fn spline(&self, id: u64, entity: &Entity) -> Result<SpaceCurve> {
        let simple = usize::from(matches!(entity.attributes.first(), Some(Attribute::String(_))));
        let degree = entity.whole(simple)?;
        if degree > MOST_DEGREE {
            return Err(entity.fail(format!("is of degree {degree}; at most {MOST_DEGREE} is read")));
        }
        let points = entity.references(1 + simple)?.into_iter().map(|id| self.point(id)).collect::<Result<Vec<_>>>()?;
        let knots = match self.entity(id, &["B_SPLINE_CURVE_WITH_KNOTS"]) {
            // A simple entity holds the attributes of its supertypes first.
            Ok(knots) => with_multiplicities(&knots, 6 * simple, degree, points.len())?,
            Err(_) => implied_knots(entity, self.graph.get(id), degree, points.len())?,
        };
        let weights = self.entity(id, &["RATIONAL_B_SPLINE_CURVE"]).ok().map(|part| part.reals(0)).transpose()?;
        Ok(SpaceCurve::Nurbs { degree, knots, points, weights })
    }
}

/// The frame of the plane of control points, its normal that of the surface; `None` where they do not lie in one.
fn plane_of_net(rows: &[Vec<[f64; 3]>], uncertainty: f64) -> Option<Frame> {
    let origin = *rows.first()?.first()?;
    let offsets = || rows.iter().flatten().map(|p| minus(*p, origin));
    let extent = offsets().map(length).fold(0.0, f64::max);
    // What the cells of the net span together by their diagonals: u × v is the surface's normal, and rows follow each other along u.
    let mut normal = [0.0; 3];
    for (below, above) in rows.iter().zip(rows.iter().skip(1)) {
        for (a, b) in below.windows(2).zip(above.windows(2)) {
            normal = plus(normal, cross(minus(b[1], a[0]), minus(a[1], b[0])));
        }
    }
    let along = rows.last()?.first().map(|p| minus(*p, origin))?;
    let frame = Frame::of_plane(origin, normal, along)?;
    let slack = uncertainty.max(1e-7 * extent);
    offsets().all(|d| dot(d, frame.normal()).abs() <= slack).then_some(frame)
}

/// The knots of a spline that gives each distinct one with its multiplicity.
fn with_multiplicities(entity: &Entity, first: usize, degree: usize, points: usize) -> Result<Vec<f64>> {
    let (counts, distinct) = (entity.reals(first)?, entity.reals(first + 1)?);
    let total: f64 = counts.iter().sum();
    let expected = points + degree + 1;
    if counts.len() != distinct.len() || counts.iter().any(|n| *n < 1.0) || total != expected as f64 {
        return Err(entity.fail(format!("has multiplicities that do not give {expected} knots")));
    }
    // The total bounds each of them.
    let knots = distinct.iter().zip(&counts).flat_map(|(knot, count)| std::iter::repeat_n(*knot, *count as usize));
    Ok(knots.collect())
}

/// The knots that a type of spline implies: evenly spaced; clamped but of a uniform one; full inside of a chain of Béziers.
fn implied_knots(entity: &Entity, raw: Option<&RawEntity>, degree: usize, points: usize) -> Result<Vec<f64>> {
    let is = |kind: &str| raw.is_some_and(|raw| parts(raw).any(|part| part.kind == kind));
    let whole = points.checked_sub(1).filter(|n| degree > 0 && n % degree == 0).map(|n| n / degree);
    if is("UNIFORM_CURVE") {
        return Ok((0..points + degree + 1).map(|i| i as f64).collect());
    }
    if is("QUASI_UNIFORM_CURVE") && points > degree {
        let inner = points - degree;
        return Ok((0..points + degree + 1).map(|i| i.clamp(degree, degree + inner) as f64).collect());
    }
    match (is("BEZIER_CURVE"), whole) {
        (true, Some(spans)) => {
            let inner = (0..=spans).flat_map(|i| std::iter::repeat_n(i as f64, degree));
            Ok([0.0].into_iter().chain(inner).chain([spans as f64]).collect())
        }
        _ => Err(entity.fail("has no knots")),
    }
}

// ---- units ----

/// What the numbers of a representation are measured in.
#[derive(Clone, Debug, Default)]
struct Context {
    unit: Option<(String, String)>,
    /// In the unit.
    uncertainty: Option<f64>,
}

impl<'a> File<'a> {
    /// The context of every face: that of the representation whose items lead to it, but for items that show another representation.
    fn contexts_of_faces(&self) -> BTreeMap<u64, Context> {
        let mut contexts = BTreeMap::new();
        let mut seen = BTreeSet::new();
        for entity in self.graph.entities.values().flat_map(parts) {
            let (Some(Attribute::List(items)), Some(Attribute::EntityRef(context))) =
                (entity.attributes.get(1), entity.attributes.get(2))
            else {
                continue;
            };
            let Ok(units) = self.entity(*context, &["GLOBAL_UNIT_ASSIGNED_CONTEXT"]) else { continue };
            let mut found = Vec::new();
            let mut waiting: Vec<u64> = items.iter().filter_map(reference).collect();
            while let Some(id) = waiting.pop() {
                let Some(raw) = self.graph.get(id).filter(|_| seen.insert(id)) else { continue };
                if parts(raw).any(|part| matches!(part.kind, "ADVANCED_FACE" | "FACE_SURFACE")) {
                    found.push(id);
                } else if !parts(raw).any(|part| part.kind == "MAPPED_ITEM") {
                    parts(raw).for_each(|part| referred(part.attributes, &mut waiting));
                }
            }
            if !found.is_empty() {
                let context = self.context(&units);
                contexts.extend(found.into_iter().map(|face| (face, context.clone())));
            }
        }
        contexts
    }

    fn context(&self, units: &Entity) -> Context {
        let ids = units.references(0).unwrap_or_default();
        let unit = ids.into_iter().find_map(|id| self.unit_of_length(id, MOST_NESTING));
        let uncertainty = self.entity(units.id, &["GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT"]).and_then(|e| e.references(0));
        let measures = uncertainty.unwrap_or_default().into_iter();
        let lengths = measures.filter_map(|id| {
            let measure = self.entity(id, &["UNCERTAINTY_MEASURE_WITH_UNIT"]).ok()?;
            let Attribute::Typed { type_name, .. } = measure.attributes.first()? else { return None };
            let factor = match (&unit, self.unit_of_length(measure.reference(1).ok()?, MOST_NESTING)) {
                (Some((_, own, _)), Some((_, other, _))) => other / own,
                _ => 1.0,
            };
            (type_name == "LENGTH_MEASURE").then_some(measure.real(0).ok()? * factor)
        });
        let uncertainty = lengths.filter(|u| u.is_finite() && *u >= 0.0).reduce(f64::max);
        Context { unit: unit.map(|(name, _, from)| (name, from)), uncertainty }
    }

    /// The name of a unit of length, its size in metres, and the entity that says so.
    fn unit_of_length(&self, id: u64, nesting: usize) -> Option<(String, f64, String)> {
        let raw = self.graph.get(id)?;
        if let Some(si) = parts(raw).find(|part| part.kind == "SI_UNIT") {
            let [.., prefix, Attribute::Enum(name)] = si.attributes else { return None };
            let prefix = match prefix {
                Attribute::Enum(prefix) => prefix.as_str(),
                _ => "",
            };
            let unit = match (name.as_str(), prefix) {
                ("METRE", "") => "m",
                ("METRE", "MILLI") => "mm",
                ("METRE", "CENTI") => "cm",
                ("METRE", "DECI") => "dm",
                ("METRE", "MICRO") => "um",
                ("METRE", "NANO") => "nm",
                ("METRE", "KILO") => "km",
                _ => return None,
            };
            return Some((unit.into(), metres(unit)?, format!("SI_UNIT #{id}")));
        }
        let converted = parts(raw).find(|part| part.kind == "CONVERSION_BASED_UNIT").filter(|_| nesting > 0)?;
        let measure =
            self.entity(converted.reference(1).ok()?, &["LENGTH_MEASURE_WITH_UNIT", "MEASURE_WITH_UNIT"]).ok()?;
        let (_, base, _) = self.unit_of_length(measure.reference(1).ok()?, nesting - 1)?;
        let size = measure.real(0).ok()? * base;
        // Inches are written with four digits, survey feet differ in the sixth.
        let known = ["m", "mm", "cm", "dm", "um", "nm", "km", "in", "ft", "yd", "mi"];
        let same = |unit: &&&str| metres(unit).is_some_and(|m| (size - m).abs() <= 1e-6 * m);
        let name = known
            .iter()
            .find(same)
            .map_or_else(|| converted.name().unwrap_or("?").to_lowercase(), |unit| (*unit).into());
        Some((name, size, format!("CONVERSION_BASED_UNIT #{id}")))
    }
}

/// The entities that attributes name, at any depth of lists.
fn referred(attributes: &[Attribute], found: &mut Vec<u64>) {
    let mut waiting: Vec<&Attribute> = attributes.iter().collect();
    while let Some(attribute) = waiting.pop() {
        match attribute {
            Attribute::EntityRef(id) => found.push(*id),
            Attribute::List(list) => waiting.extend(list),
            _ => {}
        }
    }
}
