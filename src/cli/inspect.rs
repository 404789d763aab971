//! `inspect IN`: the contents of a file, with each repair and each flaw and its place.

use super::files::{self, Input, Staged, unwritable};
use super::options::{Options, Resolved};
use super::{Halt, Volume, clock, remember, say};
use clap::Args;
use serde::Serialize;
use squinch::domain::{ArrangeOptions, Domain, Drawing, DrawnCurve, FaceInfo, Layer, Loose, Repair, Skipped};
use squinch::ids::{Id, IdVec, LayerId, PointId};
use squinch::import::outline;
use squinch::run::report::{FailureReport, SCHEMA, kinds};
use squinch::run::{self, Exit};
use squinch::watch::Watch;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::PathBuf;

/// What is in a file: curves, names, regions, corners, every repair and flaw with its place
#[derive(Args)]
pub struct Inspect {
    /// A drawing: .svg, .dxf, .step, airfoil .dat, .poly, .node, outline .json; - for standard input
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// As JSON
    #[arg(long)]
    json: bool,
    /// The drawing as read, with exact curves, in our outline format: edit it by hand or script, then mesh it
    #[arg(long, value_name = "FILE.json")]
    outline: Option<PathBuf>,
    #[command(flatten)]
    options: Options,
}

impl Inspect {
    /// Prints the contents.
    pub fn run(self, volume: Volume) -> Result<Exit, Halt> {
        let Resolved { request, input_format } = self.options.resolve()?;
        let input = Input::open(&self.input, input_format)?;
        remember(&input, &request);
        let drawing = match run::read(&input.source(), &request) {
            Ok(drawing) => drawing,
            Err(failure) => return Err(Halt::Failure(Box::new(failure), Some(Box::new(input)))),
        };
        if let Some(path) = &self.outline {
            let mut staged = Staged::default();
            let text = outline::to_json(&drawing);
            staged.add(path, text.as_bytes()).and_then(|()| staged.commit()).map_err(unwritable)?;
        }
        let clock = clock();
        let watch = &mut run::timer(&request, &clock);
        let arranged = run::arrange(&drawing, &request, watch);
        let unarranged = arranged.as_ref().err().map(|failure| failure.kind.exit());
        let mut findings = Findings::new(&input.path, &drawing, arranged);
        findings.layers = layers(&drawing, watch);
        findings.unhealed = run::unhealed(&drawing, &request, &mut findings.notes, watch);
        let text = if self.json {
            serde_json::to_string_pretty(&findings).expect("findings are strings, numbers and lists of them") + "\n"
        } else {
            findings.text(volume)
        };
        files::print(&text)?;
        Ok(unarranged.unwrap_or(if findings.flaws.is_empty() { Exit::Done } else { Exit::Geometry }))
    }
}

/// The contents of a file. Lengths are in the drawing's unit.
#[derive(Serialize)]
struct Findings {
    schema: u32,
    version: &'static str,
    path: String,
    format: String,
    title: String,
    unit: Option<String>,
    unit_from: Option<String>,
    /// x₀, y₀, x₁, y₁.
    bounds: Option<[f64; 4]>,
    curves: BTreeMap<&'static str, usize>,
    points: usize,
    seeds: usize,
    /// Of formats with layers.
    layers: Vec<LayerFindings>,
    boundaries: Vec<Boundary>,
    /// Absent where the drawing could not be arranged.
    domain: Option<DomainFindings>,
    /// The planar faces of a solid, one of which was read.
    faces: Vec<FaceInfo>,
    skipped: Vec<Skipped>,
    notes: Vec<String>,
    repairs: Vec<Repair>,
    /// With `--tolerance 0`: the repairs of the default tolerance.
    unhealed: Vec<Repair>,
    flaws: Vec<Flaw>,
}

/// A layer, without the others.
#[derive(Serialize)]
struct LayerFindings {
    name: String,
    entities: usize,
    /// Number of entities by line type.
    line_types: BTreeMap<String, usize>,
    closed_loops: usize,
    /// The area within its closed loops; absent where they cannot be arranged.
    area: Option<f64>,
}

#[derive(Serialize)]
struct Boundary {
    name: String,
    curves: usize,
    length: f64,
}

#[derive(Serialize)]
struct DomainFindings {
    points: usize,
    curves: usize,
    tolerance: f64,
    area: f64,
    regions: Vec<RegionFindings>,
    acute_corners: usize,
    smallest_angle: Option<CornerFindings>,
}

#[derive(Serialize)]
struct RegionFindings {
    name: String,
    area: f64,
}

#[derive(Serialize)]
struct CornerFindings {
    angle_deg: f64,
    at: [f64; 2],
    between: [String; 2],
}

#[derive(Serialize)]
struct Flaw {
    what: String,
    at: Option<[f64; 2]>,
    help: String,
}

impl Findings {
    fn new(path: &str, drawing: &Drawing, arranged: Result<Domain, FailureReport>) -> Self {
        let (unit, unit_from) = drawing.unit.clone().unzip();
        let flaws = match &arranged {
            Ok(domain) => domain.flaws().into_iter().map(|what| Flaw { what, at: None, help: String::new() }).collect(),
            Err(f) => vec![Flaw { what: f.what.clone(), at: f.at.and_then(|at| at.in_plane()), help: f.help.clone() }],
        };
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            path: path.to_owned(),
            format: drawing.format.clone(),
            title: drawing.title.clone(),
            unit,
            unit_from,
            bounds: drawing.bounds().map(|b| [b.x0, b.y0, b.x1, b.y1]),
            curves: kinds(drawing),
            points: drawing.points.len(),
            seeds: drawing.seeds.len(),
            layers: Vec::new(),
            boundaries: boundaries(drawing),
            domain: arranged.as_ref().ok().map(DomainFindings::new),
            faces: drawing.faces.clone(),
            skipped: drawing.skipped.clone(),
            notes: drawing.notes.iter().chain(arranged.iter().flat_map(|d| d.notes())).cloned().collect(),
            repairs: arranged.as_ref().map(|d| d.repairs().to_vec()).unwrap_or_default(),
            unhealed: Vec::new(),
            flaws,
        }
    }

    fn text(&self, volume: Volume) -> String {
        let ink = say::Ink::stdout();
        let mut text = String::new();
        let mut row = |name: &str, value: &str| {
            let row = say::harmless(&format!("  {}  {value}", ink.dim(&format!("{name:<8}"))));
            let _ = writeln!(text, "{row}"); // a String takes every write
        };
        row("title", &self.title);
        row("format", &self.format);
        let unit = match (&self.unit, &self.unit_from) {
            (Some(unit), Some(from)) => format!("{unit} ({from})"),
            _ => "not known".into(),
        };
        row("unit", &unit);
        if let Some([x0, y0, x1, y1]) = self.bounds {
            row("bounds", &format!("{} to {}", say::place([x0, y0]), say::place([x1, y1])));
        }
        row("curves", &say::kinds(&self.curves));
        if self.points + self.seeds > 0 {
            row(
                "others",
                &format!(
                    "{}, {}",
                    say::plural(self.points, "point", "points"),
                    say::plural(self.seeds, "seed", "seeds")
                ),
            );
        }
        self.layers.iter().for_each(|layer| row("layer", &layer.row()));
        for b in &self.boundaries {
            row(
                "boundary",
                &format!(
                    "{}: {}, length {}",
                    b.name,
                    say::plural(b.curves, "curve", "curves"),
                    say::number(b.length, 9)
                ),
            );
        }
        if let Some(domain) = &self.domain {
            domain.rows(&mut row);
        }
        self.faces.iter().for_each(|face| row("face", &face_row(face)));
        for skipped in &self.skipped {
            row("left out", &format!("{} {}: {}", skipped.count, skipped.entity, skipped.why));
        }
        self.notes.iter().for_each(|note| row("note", note));
        say::repair_rows(&self.repairs, &self.unhealed, volume, &mut row);
        for flaw in &self.flaws {
            row("flaw", &ink.red(&say::located(&flaw.what, flaw.at.map(Into::into))));
            if !flaw.help.is_empty() {
                row("", &flaw.help);
            }
        }
        text
    }
}

fn face_row(face: &FaceInfo) -> String {
    let normal = face.normal.map(|n| say::number(n, 6)).join(", ");
    let what = match (&face.area, &face.flaw) {
        (Some(area), _) => format!("area {}", say::number(*area, 9)),
        (None, flaw) => flaw.clone().unwrap_or_default(),
    };
    let name = if face.name.is_empty() { String::new() } else { format!(" {}", face.name) };
    format!("#{}{name}: normal ({normal}), {what}", face.id)
}

fn layers(drawing: &Drawing, watch: &mut Watch) -> Vec<LayerFindings> {
    let options = ArrangeOptions { loose: Loose::Drop, ..ArrangeOptions::default() };
    let mut finding = |id: LayerId, layer: &Layer| {
        // Curves of clips have no layer and cut those of all layers.
        let of_clip = |c: &DrawnCurve| c.shape.is_some_and(|shape| drawing.shapes[shape].part_of.is_some());
        let on_it = drawing.curves.iter().filter(|c| c.layer == Some(id) || of_clip(c));
        // By itself it needs no layer.
        let curves: Vec<_> = on_it.map(|c| DrawnCurve { layer: None, ..c.clone() }).collect();
        let alone = Drawing {
            curves,
            names: drawing.names.clone(),
            shapes: drawing.shapes.clone(),
            clips: drawing.clips.clone(),
            fill: drawing.fill,
            ..Drawing::default()
        };
        let domain = alone.arrange_watched(&options, watch).ok();
        LayerFindings {
            name: layer.name.clone(),
            entities: layer.line_types.values().sum(),
            line_types: layer.line_types.clone(),
            closed_loops: domain.as_ref().map_or(0, closed_loops),
            area: domain.map(|domain| domain.area()),
        }
    };
    drawing.layers.enumerate().map(|(id, layer)| finding(id, layer)).collect()
}

/// The number of connected components of outlines.
fn closed_loops(domain: &Domain) -> usize {
    let mut above: IdVec<PointId, PointId> = domain.points().ids().collect();
    let mut loops = BTreeSet::new();
    let outlines = || domain.curves().iter().filter(|curve| curve.sides[0] != curve.sides[1]);
    for curve in outlines() {
        let [a, b] = curve.ends.map(|end| root(&mut above, end));
        above[a] = b;
    }
    outlines().for_each(|curve| _ = loops.insert(root(&mut above, curve.ends[0])));
    loops.len()
}

/// The representative point of a component. Paths to it are halved on the way.
fn root(above: &mut IdVec<PointId, PointId>, mut point: PointId) -> PointId {
    while above[point] != point {
        above[point] = above[above[point]];
        point = above[point];
    }
    point
}

impl LayerFindings {
    fn row(&self) -> String {
        let entities = say::plural(self.entities, "entity", "entities");
        if self.entities == 0 {
            return format!("{}: {entities}", self.name);
        }
        let line_types: Vec<String> = match self.line_types.len() {
            1 => self.line_types.keys().cloned().collect(),
            _ => self.line_types.iter().map(|(name, count)| format!("{name} {count}")).collect(),
        };
        let line_types = line_types.into_iter().filter(|name| !name.is_empty());
        let loops = say::plural(self.closed_loops, "closed loop", "closed loops");
        let area = self.area.map(|area| format!("area {}", say::number(area, 9)));
        let parts = [entities].into_iter().chain(line_types).chain([loops]).chain(area);
        format!("{}: {}", self.name, parts.collect::<Vec<_>>().join(", "))
    }
}

fn boundaries(drawing: &Drawing) -> Vec<Boundary> {
    let named = drawing.names.iter().map(|(_, name)| Boundary { name: name.to_owned(), curves: 0, length: 0.0 });
    let mut boundaries: Vec<_> = named.collect();
    for drawn in &drawing.curves {
        let boundary = &mut boundaries[drawn.name.index()];
        boundary.curves += 1;
        boundary.length += drawn.curve.length();
    }
    boundaries.retain(|b| b.curves > 0);
    boundaries
}

impl DomainFindings {
    fn new(domain: &Domain) -> Self {
        let corners = || domain.points().ids().filter_map(|p| Some((p, domain.corner(p)?)));
        let smallest = corners().min_by(|(_, a), (_, b)| a.angle_rad.total_cmp(&b.angle_rad));
        let name_of = |curve| domain.name(domain.curves()[curve].name).to_owned();
        Self {
            points: domain.points().len(),
            curves: domain.curves().len(),
            tolerance: domain.tolerance(),
            area: domain.area(),
            regions: domain
                .regions()
                .iter()
                .map(|r| RegionFindings { name: domain.name(r.name).to_owned(), area: r.area })
                .collect(),
            acute_corners: domain.points().ids().filter(|&p| domain.is_acute(p)).count(),
            smallest_angle: smallest.map(|(p, corner)| CornerFindings {
                angle_deg: corner.angle_rad.to_degrees(),
                at: [domain.points()[p].x, domain.points()[p].y],
                between: corner.between.map(name_of),
            }),
        }
    }

    fn rows(&self, row: &mut dyn FnMut(&str, &str)) {
        let arranged = format!(
            "{}, {}, welded within {}",
            say::plural(self.points, "point", "points"),
            say::plural(self.curves, "curve", "curves"),
            say::number(self.tolerance, 3)
        );
        row("arranged", &arranged);
        for region in &self.regions {
            row("region", &format!("{}: area {}", region.name, say::number(region.area, 9)));
        }
        if let Some(corner) = &self.smallest_angle {
            let [a, b] = &corner.between;
            let (at, n) = (say::place(corner.at), say::count(self.acute_corners));
            row("corners", &format!("{n} acute; smallest {:.4}° at {at}, {a} and {b}", corner.angle_deg));
        }
    }
}
