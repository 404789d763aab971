//! Pictures of a drawing, a domain and a mesh: curves by the name of their boundary, cells by quality, region or size.
//!
//! Curves are flattened here for the eye only, to a tenth of a pixel; nothing else in the library flattens them.

mod markers;

use crate::canvas::{Anchor, Canvas, Colour, Frame, Label, Paint, Path, Pixel, Stroke, px, text_width};
use crate::curve::{Curve, End};
use crate::domain::{Domain, Drawing, Repair, SeedKind};
use crate::geometry::{Point, Rect, Vec2, bounds_of};
use crate::ids::{CurveId, LayerId, NameId, Names, PointId, RegionId, TriangleId};
use crate::mesh::{BallReason, Mesh};
use markers::Mended;
use std::collections::{BTreeMap, BTreeSet};

/// What the triangles of a mesh are coloured by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MeshColour {
    /// The smallest angle, 0–60°.
    #[default]
    Quality,
    Region,
    /// The colour of the region in the drawing; that of `Region` where it has none.
    Paint,
    /// The root of the area, on a logarithmic scale.
    Size,
}

/// How a picture is made.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureOptions {
    pub width_px: u32,
    /// The window to show, in the drawing's units; `None`: all of it.
    pub view: Option<Rect>,
    /// Protecting balls as dashed circles.
    pub balls: bool,
    /// Of a drawing: curves by their layers, not by their names.
    pub layers: bool,
    /// Places to point at, each with a label: flaws.
    pub marks: Vec<(Point, String)>,
    /// What was mended, marked by kind; where many crowd, one marker has their number beside it.
    pub repairs: Vec<Repair>,
    /// What was found and left as it is, marked likewise.
    pub unhealed: Vec<Repair>,
    /// First words of the caption.
    pub title: String,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            width_px: 1200,
            view: None,
            balls: true,
            layers: false,
            marks: Vec::new(),
            repairs: Vec::new(),
            unhealed: Vec::new(),
            title: String::new(),
        }
    }
}

const INK: Colour = Colour::hex(0x2b3440);
/// Edges on dark cells.
const CHALK: Colour = Colour::hex(0xffffff);
const FAINT: Colour = Colour::hex(0x7b8794);
const ALARM: Colour = Colour::hex(0xd6002a);
const BALL: Colour = Colour::hex(0x7a1fa2);

/// Boundary names: Okabe & Ito's colours, told apart by every kind of colour vision (their yellow darkened to be seen
/// on white).
const LINES: [u32; 8] = [0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0x8c6d00, 0x56b4e9, 0xe69f00, 0x444444];
/// Regions: the same hues, light enough to lie under lines.
const AREAS: [u32; 8] = [0xcfe3f1, 0xf8ddc9, 0xcdebdf, 0xf2dde9, 0xebe4c4, 0xdcf0fb, 0xfbe9c6, 0xdddddd];
/// Smallest angle of a triangle: brown (bad) over orange and cream to blue (good), a pair that colour-blind eyes keep
/// apart. It turns pale just above 20.7°, the angle that corner lopping reaches: what stands out is what a corner
/// excuses.
const QUALITY: [(f64, u32); 7] = [
    (0.0, 0x6b1f00),
    (10.0, 0xc8500a),
    (20.0, 0xf6a54a),
    (23.0, 0xfbdcae),
    (32.0, 0xf0efe3),
    (44.0, 0xb7d9ee),
    (60.0, 0x4f9ccb),
];
/// Size: dark where fine, light where coarse; lightness alone tells.
const SIZE: [(f64, u32); 5] = [(0.0, 0x1f2a5a), (0.25, 0x22668d), (0.5, 0x37a08f), (0.75, 0x9ad07a), (1.0, 0xf6f3b0)];

/// The look of a boundary: eight colours, then the same colours dashed.
fn line_stroke(index: usize, width: f64) -> Stroke {
    let stroke = Stroke::new(Colour::hex(LINES[index % LINES.len()]), width);
    match index / LINES.len() % 3 {
        0 => stroke,
        1 => stroke.dashed(4.0 * width, 2.4 * width),
        _ => stroke.dashed(0.5 * width, 2.0 * width),
    }
}

fn area_colour(index: usize) -> Colour {
    Colour::hex(AREAS[index % AREAS.len()])
}

fn along(scale: &[(f64, u32)], value: f64) -> Colour {
    let above = scale.partition_point(|&(at, _)| at < value).clamp(1, scale.len() - 1);
    let ((a, from), (b, to)) = (scale[above - 1], scale[above]);
    Colour::hex(from).mix(Colour::hex(to), (value - a) / (b - a))
}

// ---- the three pictures ----

/// A drawing as found: curves by name, points, seeds.
pub fn picture_of_drawing(drawing: &Drawing, options: &PictureOptions) -> Canvas {
    let (ranks, lines) = if options.layers { by_layer(drawing) } else { by_name(drawing) };
    let kinds = lines.len();
    let legend = Legend { lines, ..Legend::default() }.with_markers(options);
    let caption = [counted(drawing.curves.len(), "curve"), counted(drawing.points.len(), "point")].join(", ");
    let bounds = drawing.bounds().unwrap_or(Rect::ZERO);
    let mut sheet = Sheet::new(bounds, options, &caption, &legend);
    sheet.curves(kinds, ranks.into_iter().zip(drawing.curves.iter().map(|c| &c.curve)));
    sheet.canvas.layer("points", true);
    for p in &drawing.points {
        sheet.dot(p.at, INK);
    }
    for c in &drawing.curves {
        for p in [c.curve.start(), c.curve.end()] {
            sheet.ring(p, 2.2, INK);
        }
    }
    for seed in &drawing.seeds {
        let what = match &seed.kind {
            SeedKind::Hole => "hole",
            SeedKind::Region { name, .. } => drawing.names.text(*name),
        };
        sheet.label(seed.at, what, FAINT, false);
    }
    sheet.finish(options, &legend)
}

/// The colour of every drawn curve by its name, as a place in the list of those that are used.
fn by_name(drawing: &Drawing) -> (Vec<usize>, Vec<String>) {
    let used = distinct(drawing.curves.iter().map(|c| c.name));
    (drawing.curves.iter().map(|c| rank(&used, c.name)).collect(), entries(&used, &drawing.names))
}

/// The same by its layer; what is on none comes first.
fn by_layer(drawing: &Drawing) -> (Vec<usize>, Vec<String>) {
    let used: Vec<Option<LayerId>> =
        drawing.curves.iter().map(|c| c.layer).collect::<BTreeSet<_>>().into_iter().collect();
    let name =
        |layer: &Option<LayerId>| layer.map_or("no layer", |layer| drawing.layers[layer].name.as_str()).to_owned();
    let ranks = drawing.curves.iter().map(|c| used.partition_point(|layer| *layer < c.layer)).collect();
    (ranks, used.iter().map(name).collect())
}

/// A domain: regions filled, curves by name, the points of P, acute corners ringed with their angle.
pub fn picture_of_domain(domain: &Domain, options: &PictureOptions) -> Canvas {
    let used = distinct(domain.curves().iter().map(|c| c.name));
    let areas = distinct(domain.regions().iter().map(|r| r.name));
    let legend =
        Legend { lines: entries(&used, domain.names()), areas: entries(&areas, domain.names()), ..Legend::default() }
            .with_markers(options);
    let acute: Vec<PointId> = domain.points().ids().filter(|&p| domain.is_acute(p)).collect();
    let caption = [
        counted(domain.curves().len(), "curve"),
        counted(domain.points().len(), "point"),
        counted(domain.regions().len(), "region"),
        counted(acute.len(), "acute corner"),
    ];
    let mut sheet = Sheet::new(domain.bounds(), options, &caption.join(", "), &legend);
    sheet.canvas.layer("regions", true);
    for (r, region) in domain.regions().enumerate() {
        let outline = sheet.outline(domain, r);
        sheet.canvas.path(outline, Paint::fill(area_colour(rank(&areas, region.name)), 0.8));
    }
    sheet.curves(used.len(), domain.curves().iter().map(|c| (rank(&used, c.name), &c.curve)));
    sheet.canvas.layer("points", true);
    for &p in domain.points().iter() {
        sheet.dot(p, INK);
    }
    sheet.canvas.layer("corners", true);
    for &p in &acute {
        let at = domain.points()[p];
        sheet.ring(at, 6.5, ALARM);
        if let Some(corner) = domain.corner(p) {
            sheet.label(at, &format!("{}°", short(corner.angle_rad.to_degrees())), ALARM, false);
        }
    }
    sheet.finish(options, &legend)
}

/// A mesh: cells by `colour`, edges thin, boundary edges thick by name (along the exact curves where the domain is
/// given), balls dashed.
pub fn picture_of_mesh(mesh: &Mesh, domain: Option<&Domain>, colour: MeshColour, options: &PictureOptions) -> Canvas {
    let used = distinct(mesh.edges.iter().map(|e| e.name));
    let regions = distinct(mesh.regions.iter().copied());
    let mut legend = Legend { lines: entries(&used, &mesh.names), ..Legend::default() }.with_markers(options);
    let cells = CellColours::new(mesh, colour, &regions);
    match colour {
        MeshColour::Region => legend.areas = entries(&regions, &mesh.names),
        MeshColour::Paint if mesh.colours.is_empty() => legend.areas = entries(&regions, &mesh.names),
        // The colours are those of the drawing: nothing to explain.
        MeshColour::Paint => {}
        MeshColour::Quality | MeshColour::Size => legend.scale = cells.scale(),
    }
    let worst = mesh.triangles.iter().map(|t| smallest_angle_deg(corners(mesh, t))).reduce(f64::min);
    let mut caption = vec![counted(mesh.triangles.len(), "triangle"), counted(mesh.nodes.len(), "vertex")];
    caption.extend(worst.map(|angle| format!("smallest angle {}°", short(angle))));
    let bounds = bounds_of(mesh.nodes.iter().copied()).unwrap_or(Rect::ZERO);
    let mut sheet = Sheet::new(bounds, options, &caption.join(", "), &legend);
    sheet.cells(mesh, &cells);
    sheet.edges(mesh, &cells);
    sheet.boundary(mesh, domain, &used);
    if options.balls {
        sheet.balls(mesh);
    }
    sheet.finish(options, &legend)
}

// ---- colours of cells ----

/// The colour class of every triangle (few, so that one path holds all of a colour).
struct CellColours<'a> {
    mesh: &'a Mesh,
    colour: MeshColour,
    regions: &'a [NameId],
    /// Logarithms of the smallest and largest root of area.
    sizes: [f64; 2],
}

/// A colour as it is seen over white.
fn on_white([r, g, b, a]: [u8; 4]) -> Colour {
    let over = |part: u8| ((u32::from(part) * u32::from(a) + 255 * (255 - u32::from(a)) + 127) / 255) as u8;
    Colour(over(r), over(g), over(b))
}

/// Steps of a colour scale: finer ones cannot be told apart.
const SHADES: usize = 60;

impl<'a> CellColours<'a> {
    fn new(mesh: &'a Mesh, colour: MeshColour, regions: &'a [NameId]) -> Self {
        let mut sizes = [f64::INFINITY, f64::NEG_INFINITY];
        if colour == MeshColour::Size {
            for size in mesh.triangles.iter().map(|t| log_size(corners(mesh, t))).filter(|s| s.is_finite()) {
                sizes = [sizes[0].min(size), sizes[1].max(size)];
            }
        }
        Self { mesh, colour, regions, sizes }
    }

    fn class(&self, t: TriangleId) -> usize {
        let abc = corners(self.mesh, &self.mesh.triangles[t]);
        let shade = |fraction: f64| ((fraction * SHADES as f64) as usize).min(SHADES - 1);
        match self.colour {
            MeshColour::Quality => shade(smallest_angle_deg(abc) / 60.0),
            MeshColour::Size => shade((log_size(abc) - self.sizes[0]) / (self.sizes[1] - self.sizes[0]).max(1e-12)),
            MeshColour::Region | MeshColour::Paint => {
                let region = self.mesh.triangle_regions.get(t).and_then(|&r| self.mesh.regions.get(r));
                region.map_or(0, |&name| rank(self.regions, name))
            }
        }
    }

    fn paint(&self, class: usize) -> Colour {
        let middle = (class as f64 + 0.5) / SHADES as f64;
        match self.colour {
            MeshColour::Quality => along(&QUALITY, middle * 60.0),
            MeshColour::Size => along(&SIZE, middle),
            MeshColour::Region => area_colour(class),
            MeshColour::Paint => {
                let drawn = self.regions.get(class).and_then(|name| self.mesh.colours.get(name));
                drawn.map_or_else(|| area_colour(class), |drawn| on_white(drawn.0))
            }
        }
    }

    /// Whether dark lines cannot be seen on the colour: scales are chosen for them, a drawing's colours are what they are.
    fn is_dark(&self, class: usize) -> bool {
        let Colour(r, g, b) = self.paint(class);
        // Rec. 709's luma, of 255.
        self.colour == MeshColour::Paint && 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b) < 90.0
    }

    /// The legend's scale: its histogram, and what its ends and ticks say.
    fn scale(&self) -> Option<Scale> {
        let mut counts = vec![0; SHADES];
        for t in self.mesh.triangles.ids() {
            counts[self.class(t)] += 1;
        }
        let ticks = match self.colour {
            MeshColour::Quality => [0, 10, 20, 30, 40, 50, 60].map(|d| (f64::from(d) / 60.0, format!("{d}°"))).to_vec(),
            MeshColour::Size if self.sizes[0] < self.sizes[1] => [0.0, 0.25, 0.5, 0.75, 1.0]
                .map(|f| (f, short(libm::exp(self.sizes[0] + f * (self.sizes[1] - self.sizes[0])))))
                .to_vec(),
            MeshColour::Size if self.sizes[0].is_finite() => vec![(0.0, short(libm::exp(self.sizes[0])))],
            MeshColour::Size | MeshColour::Region | MeshColour::Paint => return None,
        };
        let title =
            if self.colour == MeshColour::Quality { "smallest angle of a triangle" } else { "√area of a triangle" };
        let shades = (0..SHADES).map(|class| self.paint(class)).collect();
        Some(Scale { title, counts, shades, ticks })
    }
}

fn corners(mesh: &Mesh, triangle: &[crate::ids::VertexId; 3]) -> [Point; 3] {
    triangle.map(|v| mesh.nodes.get(v).copied().unwrap_or(Point::new(f64::NAN, f64::NAN)))
}

/// 0 of a triangle that has no angles.
fn smallest_angle_deg([a, b, c]: [Point; 3]) -> f64 {
    let angle = |p: Point, q: Point, r: Point| crate::geometry::turn_from(q - p, r - p).abs().to_degrees();
    let least = angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b));
    if least.is_finite() { least } else { 0.0 }
}

fn log_size([a, b, c]: [Point; 3]) -> f64 {
    0.5 * libm::log(0.5 * (b - a).cross(c - a).abs())
}

// ---- names ----

fn distinct(names: impl Iterator<Item = NameId>) -> Vec<NameId> {
    names.collect::<BTreeSet<_>>().into_iter().collect()
}

fn rank(used: &[NameId], name: NameId) -> usize {
    used.partition_point(|&n| n < name)
}

fn entries(used: &[NameId], names: &Names) -> Vec<String> {
    used.iter().map(|&n| names.text(n).to_owned()).collect()
}

/// "1 curve", "12 345 curves".
fn counted(n: usize, what: &str) -> String {
    let many = if what == "vertex" { "vertices".to_owned() } else { format!("{what}s") };
    counted_words(n, [what, &many])
}

fn counted_words(n: usize, [one, many]: [&str; 2]) -> String {
    let digits = n.to_string();
    let mut number = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            number.push('\u{202f}');
        }
        number.push(c);
    }
    format!("{number} {}", if n == 1 { one } else { many })
}

/// Three significant digits, for people.
fn short(v: f64) -> String {
    if v == 0.0 || !v.is_finite() {
        return format!("{v}");
    }
    let digits = libm::floor(libm::log10(v.abs()));
    if (-3.0..5.0).contains(&digits) {
        let decimals = (2.0 - digits).max(0.0) as usize;
        let text = format!("{v:.decimals$}");
        let short = if decimals > 0 { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        return short.to_owned();
    }
    format!("{v:.2e}")
}

// ---- the sheet: frame, legend, and what is drawn on it ----

#[derive(Clone, Debug, Default)]
struct Legend {
    lines: Vec<String>,
    areas: Vec<String>,
    markers: Vec<(Mended, String)>,
    /// Whether markers may stand for several.
    crowded: bool,
    scale: Option<Scale>,
}

#[derive(Clone, Debug)]
struct Scale {
    title: &'static str,
    counts: Vec<usize>,
    shades: Vec<Colour>,
    /// Place along the scale (0–1) and text.
    ticks: Vec<(f64, String)>,
}

/// Names shown before "and n more".
const LEGEND_NAMES_MAX: usize = 36;

/// A place in the legend: a swatch and its text.
struct Chip {
    at: Pixel,
    text: String,
    swatch: Swatch,
}

enum Swatch {
    Marker(Mended),
    Line(usize),
    Area(Colour),
    None,
}

struct Sheet {
    canvas: Canvas,
    caption: String,
    /// Type size, in pixels, from the picture's width.
    type_px: f64,
    width: f64,
    margin: f64,
    /// Where labels stand already.
    labels: Vec<Rect>,
}

impl Sheet {
    fn new(bounds: Rect, options: &PictureOptions, caption: &str, legend: &Legend) -> Self {
        let width = f64::from(options.width_px.clamp(120, 8192));
        // At the default width of 1200: 16 px type, a margin of 36 px.
        let (type_px, margin) = ((width / 75.0).clamp(9.0, 22.0), width * 0.03);
        let view = options.view.unwrap_or(bounds);
        let frame = Frame::new(view, px(margin, margin), width - 2.0 * margin, width);
        let frame = if options.view.is_none() { frame.with_rim(margin * 0.9) } else { frame };
        let caption =
            if options.title.is_empty() { caption.to_owned() } else { format!("{}: {caption}", options.title) };
        let mut sheet =
            Self { canvas: Canvas::new(width, width, frame), caption, type_px, width, margin, labels: Vec::new() };
        let height = sheet.legend_top() + sheet.legend_height(legend) + margin * 0.8;
        sheet.canvas = Canvas::new(width, height, frame);
        sheet
    }

    fn pixel(&self, p: Point) -> Pixel {
        self.canvas.frame().pixel(p)
    }

    /// A width that looks the same at every picture width.
    fn pen(&self, at_1200: f64) -> f64 {
        at_1200 * (self.width / 1200.0).clamp(0.5, 2.0)
    }

    // -- curves --

    fn curves<'a>(&mut self, classes: usize, curves: impl Iterator<Item = (usize, &'a Curve)>) {
        let mut paths = vec![Path::default(); classes];
        for (class, curve) in curves {
            let line = self.flatten(curve, 0.0, 1.0);
            self.canvas.frame().add_line(&mut paths[class], &line);
        }
        self.boundary_paths(paths);
    }

    fn boundary_paths(&mut self, paths: Vec<Path>) {
        self.canvas.layer("boundary", true);
        let width = self.pen(2.4);
        for (class, path) in paths.into_iter().enumerate() {
            self.canvas.path(path, Paint::stroke(line_stroke(class, width)));
        }
    }

    /// The part of a curve as a polyline within about a tenth of a pixel, by halving; at most 4097 places.
    fn flatten(&self, curve: &Curve, t0: f64, t1: f64) -> Vec<Pixel> {
        let at = |t: f64| self.pixel(curve.point(t));
        if curve.as_line().is_some() {
            return vec![at(t0), at(t1)];
        }
        // Eight parts to begin with, so that a wave whose middle lies on the chord is not taken for flat.
        let first: Vec<(f64, Pixel)> =
            (0..=8).map(|i| t0 + (t1 - t0) * f64::from(i) / 8.0).map(|t| (t, at(t))).collect();
        let mut line = vec![first[0].1];
        for ends in first.windows(2) {
            let mut from = ends[0];
            let mut ahead = vec![ends[1]];
            while let Some(&to) = ahead.last() {
                let t = 0.5 * (from.0 + to.0);
                let middle = at(t);
                let bent = deviation(from.1, to.1, middle) > 0.1;
                // 9 halvings of 8 parts give the 4096 pieces.
                if bent && ahead.len() <= 9 {
                    ahead.push((t, middle));
                } else {
                    line.push(to.1);
                    from = to;
                    ahead.pop();
                }
            }
        }
        line
    }

    /// The outline of a region: its curves chained into closed contours (in any way: by even–odd they fill the same).
    fn outline(&self, domain: &Domain, region: RegionId) -> Path {
        let mut leaving: BTreeMap<PointId, Vec<(CurveId, End)>> = BTreeMap::new();
        for (id, curve) in domain.curves().enumerate() {
            match curve.sides.map(|side| side == Some(region)) {
                [true, false] => leaving.entry(curve.ends[0]).or_default().push((id, End::Start)),
                [false, true] => leaving.entry(curve.ends[1]).or_default().push((id, End::Finish)),
                [true, true] | [false, false] => {}
            }
        }
        let mut path = Path::default();
        let starts: Vec<PointId> = leaving.keys().copied().collect();
        for start in starts {
            let mut contour = Vec::new();
            let mut at = start;
            while let Some((id, from)) = leaving.get_mut(&at).and_then(Vec::pop) {
                let curve = &domain.curves()[id];
                let mut line = self.flatten(&curve.curve, 0.0, 1.0);
                at = curve.ends[1];
                if from == End::Finish {
                    line.reverse();
                    at = curve.ends[0];
                }
                contour.extend(line);
            }
            self.canvas.frame().add_polygon(&mut path, &contour);
        }
        path
    }

    // -- meshes --

    fn cells(&mut self, mesh: &Mesh, colours: &CellColours) {
        let mut paths: BTreeMap<usize, Path> = BTreeMap::new();
        for (t, triangle) in mesh.triangles.enumerate() {
            let abc = corners(mesh, triangle).map(|p| self.pixel(p));
            if self.canvas.frame().sees(&abc) {
                self.canvas.frame().add_polygon(paths.entry(colours.class(t)).or_default(), &abc);
            }
        }
        self.canvas.layer_of_cells("cells");
        for (class, path) in paths {
            self.canvas.path(path, Paint::fill(colours.paint(class), 1.0));
        }
    }

    /// Every edge once, light where all about it is dark, fainter as cells get small: a mesh of pixel-sized cells would else be black.
    fn edges(&mut self, mesh: &Mesh, colours: &CellColours) {
        let mut edges: Vec<([crate::ids::VertexId; 2], bool)> = Vec::with_capacity(mesh.triangles.len() * 3);
        for (t, &[a, b, c]) in mesh.triangles.enumerate() {
            let seen = corners(mesh, &[a, b, c]).map(|p| self.pixel(p));
            if self.canvas.frame().sees(&seen) {
                let is_dark = colours.is_dark(colours.class(t));
                edges.extend([[a, b], [b, c], [c, a]].map(|[u, v]| (if u < v { [u, v] } else { [v, u] }, is_dark)));
            }
        }
        // Of the two cells at an edge a light one comes first.
        edges.sort_unstable();
        edges.dedup_by_key(|(edge, _)| *edge);
        let mut classes: [[Path; 2]; 3] = Default::default();
        for ([u, v], is_dark) in edges {
            let [a, b] = [u, v].map(|n| self.pixel(corners(mesh, &[n, n, n])[0]));
            let length = libm::hypot(a.x - b.x, a.y - b.y);
            let class = match length / self.pen(1.0) {
                l if l >= 12.0 => 0,
                l if l >= 5.0 => 1,
                l if l >= 2.0 => 2,
                _ => continue,
            };
            self.canvas.frame().add_line(&mut classes[class][usize::from(is_dark)], &[a, b]);
        }
        self.canvas.layer("edges", true);
        for (paths, (width, opacity)) in classes.into_iter().zip([(0.8, 0.75), (0.55, 0.6), (0.35, 0.4)]) {
            for (path, (ink, share)) in paths.into_iter().zip([(INK, 1.0), (CHALK, 0.7)]) {
                let stroke = Stroke::new(ink, self.pen(width)).opacity(share * opacity);
                self.canvas.path(path, Paint::stroke(stroke));
            }
        }
    }

    fn boundary(&mut self, mesh: &Mesh, domain: Option<&Domain>, used: &[NameId]) {
        let mut paths = vec![Path::default(); used.len()];
        for edge in &mesh.edges {
            let ends = edge.nodes.map(|v| self.pixel(corners(mesh, &[v, v, v])[0]));
            let linked = edge.link.and_then(|link| Some((domain?.curves().get(link.curve)?, link.t)));
            let line = match linked {
                Some((curve, t)) if self.near(ends) => self.flatten(&curve.curve, t[0], t[1]),
                _ => ends.to_vec(),
            };
            self.canvas.frame().add_line(&mut paths[rank(used, edge.name)], &line);
        }
        self.boundary_paths(paths);
    }

    /// Whether an edge is long enough to show its curve, and in sight (a curved edge may bulge by less than its
    /// length).
    fn near(&self, [a, b]: [Pixel; 2]) -> bool {
        let l = libm::hypot(a.x - b.x, a.y - b.y);
        l > 1.0 && self.canvas.frame().sees(&[a, b, px(a.x - l, a.y - l), px(a.x + l, a.y + l)])
    }

    fn balls(&mut self, mesh: &Mesh) {
        self.canvas.layer("balls", true);
        let nodes: BTreeMap<PointId, Point> =
            mesh.points.iter().filter_map(|&(p, v)| Some((p, *mesh.nodes.get(v)?))).collect();
        for ball in &mesh.balls {
            let Some(&corner) = nodes.get(&ball.corner) else { continue };
            let (at, radius) = (self.pixel(corner), ball.radius * self.canvas.frame().scale());
            // Below a pixel and a half the circle would be a blot.
            if radius < 1.5 {
                continue;
            }
            let opacity = if ball.why == BallReason::Size { 0.6 } else { 1.0 };
            let stroke = Stroke::new(BALL, self.pen(1.5)).opacity(opacity).dashed(self.pen(5.0), self.pen(4.5));
            self.canvas.circle(at, radius, Paint::fill(BALL, 0.06).and_stroke(stroke));
        }
    }

    // -- points and labels --

    fn dot(&mut self, p: Point, colour: Colour) {
        let (at, radius) = (self.pixel(p), self.pen(2.6));
        if self.canvas.frame().sees(&[at]) {
            self.canvas.circle(at, radius, Paint::fill(colour, 1.0));
        }
    }

    fn ring(&mut self, p: Point, radius: f64, colour: Colour) {
        let (at, radius, width) = (self.pixel(p), self.pen(radius), self.pen(1.3));
        if self.canvas.frame().sees(&[at]) {
            self.canvas.circle(at, radius, Paint::stroke(Stroke::new(colour, width)));
        }
    }

    /// A label beside a place, at the first of four sides where it hides no other label and stays in the picture; if
    /// there is none, it is left away, unless it is `owed`.
    fn label(&mut self, p: Point, text: &str, colour: Colour, owed: bool) {
        let at = self.pixel(p);
        if text.is_empty() || !self.canvas.frame().sees(&[at]) {
            return;
        }
        let size = self.type_px * 0.85;
        // A cross, with its rim, reaches farther than a dot.
        let [beside, above] = if owed { [12.0, 11.0] } else { [9.0, 7.0] };
        let (dx, up, down, width) =
            (self.pen(beside), self.pen(above), self.pen(above) + 0.7 * size, text_width(text, size));
        let sheet = Rect::new(0.0, 0.0, self.width, self.legend_top());
        let boxes = [(dx, -up), (-dx - width, -up), (dx, down), (-dx - width, down)]
            .map(|(x, y)| Rect::new(at.x + x, at.y + y - 0.75 * size, at.x + x + width, at.y + y + 0.25 * size));
        let free =
            |b: &&Rect| b.union(sheet) == sheet && self.labels.iter().all(|other| other.intersect(**b).area() == 0.0);
        let beyond = |b: Rect| Vec2::new((b.x1 - sheet.x1).max(0.0).min(b.x0), (b.y0 - sheet.y0).min(0.0));
        let moved_in = |b: Rect| b - beyond(b);
        let Some(room) = boxes.iter().find(free).copied().or(owed.then(|| moved_in(boxes[0]))) else { return };
        self.labels.push(room);
        self.canvas.text(Label::new(px(room.x0, room.y1 - 0.25 * size), text, size).colour(colour).rim());
    }

    fn marks(&mut self, marks: &[(Point, String)]) {
        self.canvas.layer("marks", true);
        let arm = self.pen(7.0);
        // No label may hide a cross.
        for (p, _) in marks {
            let (at, side) = (self.pixel(*p), 2.0 * arm);
            self.labels.push(Rect::from_center_size((at.x, at.y), (side, side)));
        }
        for (p, text) in marks {
            let at = self.pixel(*p);
            let mut cross = Path::default();
            for (dx, dy) in [(arm, arm), (arm, -arm)] {
                cross.add([px(at.x - dx, at.y - dy), px(at.x + dx, at.y + dy)], false);
            }
            if self.canvas.frame().sees(&[at]) {
                let (rim, pen) = (Stroke::new(Colour::hex(0xffffff), self.pen(5.0)), Stroke::new(ALARM, self.pen(2.4)));
                self.canvas.path(cross.clone(), Paint::stroke(rim));
                self.canvas.path(cross, Paint::stroke(pen));
                self.label(*p, &clipped(text, MARK_MAX), ALARM, true);
            }
        }
    }

    // -- legend --

    fn legend_top(&self) -> f64 {
        self.canvas.frame().plot().y1 + self.margin
    }

    fn legend_height(&self, legend: &Legend) -> f64 {
        let scale = if legend.scale.is_some() { self.type_px * 5.4 } else { 0.0 };
        let chips = self.chips(legend).last().map_or(0.0, |c| c.at.y - self.legend_top() + self.type_px * 0.4);
        chips.max(self.type_px * 1.4) + scale
    }

    /// Caption, then markers, areas and lines, each row filled from the left.
    fn chips(&self, legend: &Legend) -> Vec<Chip> {
        let swatches = (0..).zip(&legend.areas).map(|(i, name)| (Swatch::Area(area_colour(i)), name));
        let lines = (0..).zip(&legend.lines).map(|(i, name)| (Swatch::Line(i), name));
        let all = legend.areas.len() + legend.lines.len();
        let mut wanted: Vec<(Swatch, String)> = vec![(Swatch::None, self.caption.clone())];
        wanted.extend(legend.markers.iter().map(|(mended, text)| (Swatch::Marker(*mended), text.clone())));
        if legend.crowded {
            wanted.push((Swatch::None, "×n: n beside each other, marked by the rarest".into()));
        }
        wanted.extend(swatches.chain(lines).take(LEGEND_NAMES_MAX).map(|(s, name)| (s, clipped(name, NAME_MAX))));
        if all > LEGEND_NAMES_MAX {
            wanted.push((Swatch::None, format!("and {} more", all - LEGEND_NAMES_MAX)));
        }
        let mut chips: Vec<Chip> = Vec::new();
        let mut at = px(self.margin, self.legend_top() + self.type_px);
        for (swatch, text) in wanted {
            let room = if matches!(swatch, Swatch::None) { 0.0 } else { self.type_px * 2.0 };
            let width = room + text_width(&text, self.type_px) + self.type_px * 1.6;
            if at.x > self.margin && (at.x + width > self.width - self.margin || chips.len() == 1) {
                at = px(self.margin, at.y + self.type_px * 1.6);
            }
            chips.push(Chip { at, text, swatch });
            at.x += width;
        }
        chips
    }

    fn finish(mut self, options: &PictureOptions, legend: &Legend) -> Canvas {
        self.repairs(options);
        self.marks(&options.marks);
        self.canvas.layer("legend", false);
        let chips = self.chips(legend);
        let below = chips.last().map_or(self.legend_top(), |c| c.at.y) + self.type_px * 1.2;
        for Chip { at, text, swatch } in chips {
            let (w, mid) = (self.type_px * 1.5, at.y - self.type_px * 0.36);
            let room = match swatch {
                Swatch::None => 0.0,
                Swatch::Marker(mended) => {
                    self.marker(mended, px(at.x + 0.5 * w, mid), self.type_px * 0.5);
                    self.type_px * 2.0
                }
                Swatch::Line(class) => {
                    let mut path = Path::default();
                    path.add([px(at.x, mid), px(at.x + w, mid)], false);
                    self.canvas.path(path, Paint::stroke(line_stroke(class, self.pen(3.0))));
                    self.type_px * 2.0
                }
                Swatch::Area(colour) => {
                    let half = self.type_px * 0.45;
                    let paint = Paint::fill(colour, 1.0).and_stroke(Stroke::new(FAINT, self.pen(0.7)));
                    self.canvas.rect(Rect::new(at.x, mid - half, at.x + w, mid + half), paint);
                    self.type_px * 2.0
                }
            };
            self.canvas.text(Label::new(px(at.x + room, at.y), text, self.type_px));
        }
        if let Some(scale) = &legend.scale {
            self.scale(scale, below);
        }
        self.canvas
    }

    /// A histogram whose bars carry the colours: the scale and the distribution in one.
    fn scale(&mut self, scale: &Scale, top: f64) {
        let (left, size) = (self.margin.round(), self.type_px * 0.8);
        let (floor, tall) = ((top + self.type_px * 2.2).round(), self.type_px * 1.9);
        let most = scale.counts.iter().copied().max().unwrap_or(0).max(1) as f64;
        // Whole pixels, or smoothing would draw a seam between two shades.
        let step = (self.width * 0.42 / scale.counts.len().max(1) as f64).floor().max(1.0);
        let length = step * scale.counts.len() as f64;
        for (i, (&count, &shade)) in scale.counts.iter().zip(&scale.shades).enumerate() {
            let x = left + i as f64 * step;
            self.canvas.rect(Rect::new(x, floor, x + step, floor + self.type_px * 0.5), Paint::fill(shade, 1.0));
            if count > 0 {
                // A single triangle is still to be seen: at least a pixel and a half.
                let bar = (tall * count as f64 / most).max(1.5);
                let ink = shade.mix(INK, 0.15);
                self.canvas.rect(Rect::new(x, floor - bar, x + step * 0.85, floor), Paint::fill(ink, 1.0));
            }
        }
        for (at, text) in &scale.ticks {
            let place = px(left + at * length, floor + self.type_px * 0.5 + size * 1.15);
            let anchor = if *at == 0.0 { Anchor::Start } else { Anchor::Middle };
            self.canvas.text(Label::new(place, text.clone(), size).anchor(anchor).colour(FAINT));
        }
        let place = px(left + length + self.type_px * 1.6, floor + self.type_px * 0.4);
        self.canvas.text(Label::new(place, scale.title, size).colour(FAINT));
    }
}

/// Characters of a name in a legend.
const NAME_MAX: usize = 40;
/// Characters of what is said beside a mark.
const MARK_MAX: usize = 60;

/// A text of so many characters at most.
fn clipped(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        text.to_owned()
    } else {
        text.chars().take(most - 2).chain("…".chars()).collect()
    }
}

/// Distance of `p` from the line ab, or from a where a and b coincide.
fn deviation(a: Pixel, b: Pixel, p: Pixel) -> f64 {
    let (ab, ap) = ((b.x - a.x, b.y - a.y), (p.x - a.x, p.y - a.y));
    let length = libm::hypot(ab.0, ab.1);
    if length < 0.01 { libm::hypot(ap.0, ap.1) } else { (ab.0 * ap.1 - ab.1 * ap.0).abs() / length }
}

/// Names of the colour classes, for options: "quality", "region", "paint", "size".
impl std::str::FromStr for MeshColour {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "quality" => Ok(Self::Quality),
            "region" => Ok(Self::Region),
            "paint" => Ok(Self::Paint),
            "size" => Ok(Self::Size),
            _ => Err(format!("'{text}' is no colouring: quality, region, paint or size")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_significant_digits() {
        let texts = [0.0, 20.705, 0.001234, 123456.0, 60.0, 1e-9, 2.5e7].map(short);
        assert_eq!(texts, ["0", "20.7", "0.00123", "1.23e5", "60", "1.00e-9", "2.50e7"]);
    }

    #[test]
    fn scales_hit_their_anchors_and_stay_inside() {
        for (at, colour) in QUALITY {
            assert_eq!(along(&QUALITY, at), Colour::hex(colour));
        }
        assert_eq!(along(&QUALITY, -5.0), Colour::hex(QUALITY[0].1));
        assert_eq!(along(&SIZE, 7.0), Colour::hex(SIZE[4].1));
    }

    #[test]
    fn region_names_have_light_colours() {
        for i in 0..AREAS.len() {
            let Colour(r, g, b) = area_colour(i);
            assert!(r.min(g).min(b) > 0xb0, "lines must stand out on {i}");
        }
    }

    #[test]
    fn ids_of_names_rank_in_order() {
        let used = distinct([NameId(4), NameId(1), NameId(4)].into_iter());
        assert_eq!(used.iter().map(|&n| rank(&used, n)).collect::<Vec<_>>(), [0, 1]);
    }
}
