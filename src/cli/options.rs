//! The options of a run, on the command line and in a `--config` file alike; the command line wins.

use super::Halt;
use super::say;
use clap::Args;
use serde::{Deserialize, Serialize};
use squinch::domain::NameBy;
use squinch::import::{Format, Glob};
use squinch::run::Exit;
use squinch::run::request::{
    BallShrinking, ChordError, EdgeTurning, Engine, FillChoice, Keep, LineTypes, LooseEnds, MaxTurning, Midpoint,
    NamesOf, Order, Overlap, Request, SizeOf, SnapTo, Steiner, Strokes, Switch, TrailingEdge,
};
use squinch::size::Given;
use std::path::{Path, PathBuf};

/// What a run is asked for. An option that is not given keeps its default.
#[derive(Args, Clone, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", default, deny_unknown_fields)]
pub struct Options {
    /// Options from a TOML file, keys as the long options here; the command line wins
    #[arg(long, value_name = "FILE.toml", help_heading = "General")]
    #[serde(skip)]
    config: Option<PathBuf>,
    /// Threads; the result does not depend on it [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), allow_hyphen_values = true, help_heading = "General")]
    threads: Option<u64>,
    /// Format of the input, where suffix and content do not tell: airfoil, poly, node, outline, dxf, svg, step
    #[arg(long, value_name = "FORMAT", help_heading = "Input")]
    input_format: Option<String>,

    /// Smallest angle, in degrees; 0: none [default: 20.7]
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, help_heading = "Bounds")]
    min_angle: Option<f64>,
    /// Largest area of a triangle
    #[arg(long, value_name = "AREA", allow_hyphen_values = true, help_heading = "Bounds")]
    max_area: Option<f64>,
    /// Largest length of an edge
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, help_heading = "Bounds")]
    max_edge: Option<f64>,
    /// Triangles whose circumradius is below this are not refined for their angles
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, help_heading = "Bounds")]
    min_edge: Option<f64>,
    /// Largest distance from mesh boundary to curve: a length, or a share of the drawing's diagonal as in 0.1%
    #[arg(long, value_name = "LENGTH|E%", allow_hyphen_values = true, help_heading = "Bounds")]
    chord_error: Option<ChordError>,
    /// Largest turning of the curve along a mesh edge, in degrees, or off [default: 15]
    #[arg(long, value_name = "DEG|off", allow_hyphen_values = true, help_heading = "Bounds")]
    edge_turning: Option<EdgeTurning>,
    /// Largest length of an edge on the boundary, or in the region, of this name; may be repeated
    #[arg(long, value_name = "NAME=LENGTH", help_heading = "Bounds")]
    size_of: Option<Vec<SizeOf>>,
    /// Longest edge by place: an expression in x and y as in "0.1 + 0.05*hypot(x-2, y)", or a file with `x y size` on every line, from
    /// which the size grows by --grade [default there: 0.3]
    #[arg(long, value_name = "FILE|EXPR", allow_hyphen_values = true, help_heading = "Bounds")]
    size: Option<String>,
    /// Growth of the edge length of a sized boundary or region a unit of distance away from it
    #[arg(long, value_name = "G", allow_hyphen_values = true, help_heading = "Bounds")]
    grade: Option<f64>,
    /// Order of the cells: 2 puts a node on the curve within every edge [default: 1]
    #[arg(long, value_name = "1|2", allow_hyphen_values = true, help_heading = "Bounds")]
    order: Option<Order>,

    /// Welding distance; 0 heals nothing, and lists what it leaves as `unhealed` [default: 1e-9 of the diagonal, or up to 1e-4 (SVG) or 1e-6 where slivers would take too many vertices; ends that meet nothing else: 1e-6]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, help_heading = "Input")]
    tolerance: Option<f64>,
    /// Joins free ends that are nearer than this to each other, or to an open line that goes on beyond the corner; welds nothing else
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, help_heading = "Input")]
    close: Option<f64>,
    /// What becomes of lines that bound nothing: auto keeps plainly open ones and refuses outlines that miss closing [default: auto]
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Input")]
    loose: Option<LooseEnds>,
    /// Which faces are inside [default: auto, the file's own rule]
    #[arg(long, value_enum, value_name = "RULE", help_heading = "Input")]
    fill_rule: Option<FillChoice>,
    /// What becomes of strokes: auto makes centre lines where nothing is filled, area fills what they cover [default: auto]
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Input")]
    strokes: Option<Strokes>,
    /// Filled shapes that overlap: the topmost has it all, or each overlap is a region named by all of its shapes [default: paint]
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Input")]
    overlap: Option<Overlap>,
    /// all: adds a box named `box` and keeps every bounded face [default: inside]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Input")]
    keep: Option<Keep>,
    /// Only these layers (DXF) or layers and ids (SVG) are read: names or patterns as PART*, with commas or repeated
    #[arg(long, value_name = "A,B", value_delimiter = ',', help_heading = "Input")]
    layers: Option<Vec<Glob>>,
    /// These layers or ids are not read: names or patterns as in --layers
    #[arg(long, value_name = "A,B", value_delimiter = ',', help_heading = "Input")]
    skip_layers: Option<Vec<Glob>>,
    /// A name for the curve nearest to a place, for the region at a place (in:), or for a DXF entity (handle:); may be repeated
    #[arg(long, value_name = "NAME=X,Y|in:X,Y|handle:H", help_heading = "Input")]
    name: Option<Vec<NameBy>>,
    /// What has a name of its own: each layer, each closed outline (HOLES-1, HOLES-2) or each entity [default: layer]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Input")]
    names: Option<NamesOf>,
    /// DXF: edges leaves out what is drawn in line types for centre, hidden and phantom lines, unless nothing else is drawn [default: edges]
    #[arg(long, value_enum, value_name = "WHICH", help_heading = "Input")]
    line_types: Option<LineTypes>,
    /// DXF: what leaves the XY plane is projected onto it; else it is left out
    #[arg(long, value_enum, value_name = "on|off", num_args = 0..=1, require_equals = true, default_missing_value = "on", help_heading = "Input")]
    flatten_z: Option<Switch>,
    /// Unit of the mesh; the drawing's coordinates are converted where their unit is known
    #[arg(long, value_name = "UNIT", help_heading = "Input")]
    unit: Option<String>,
    /// Factor on every coordinate [default: 1]
    #[arg(long, value_name = "S", allow_hyphen_values = true, help_heading = "Input")]
    scale: Option<f64>,
    /// Pixels to an inch, in a drawing that gives no physical size [default: 96]
    #[arg(long, value_name = "D", help_heading = "Input")]
    dpi: Option<f64>,

    /// Trailing edge of an airfoil [default: keep]
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Airfoils")]
    trailing_edge: Option<TrailingEdge>,
    /// Radius of the far field in chords; 0 meshes the section itself [default: 20]
    #[arg(long, value_name = "R", allow_hyphen_values = true, help_heading = "Airfoils")]
    far_field: Option<f64>,
    /// Angle of incidence in degrees, nose up [default: 0]
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, help_heading = "Airfoils")]
    incidence: Option<f64>,
    /// Chord that the section is scaled to, about the origin of its coordinates
    #[arg(long, value_name = "C", allow_hyphen_values = true, help_heading = "Airfoils")]
    chord: Option<f64>,

    /// The planar face to mesh, by its entity number or name, or largest; with batch, all gives each a mesh of its own [default: largest]
    #[arg(long, value_name = "ID|NAME|largest|all", help_heading = "Solids")]
    face: Option<String>,

    /// Vertices after which refinement stops [default: 5000000]
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Budget")]
    max_vertices: Option<u64>,
    /// Seconds after which arranging, cutting and refining stop. A mesh that is valid by then is still verified and written, which takes
    /// time in proportion to its size
    #[arg(long, value_name = "S", allow_hyphen_values = true, help_heading = "Budget")]
    timeout: Option<f64>,

    /// Who refines: lop, corner lopping, or gcdr, generalized constrained Delaunay refinement [default: lop]
    #[arg(long, value_name = "lop|gcdr", help_heading = "Engine")]
    engine: Option<Engine>,
    /// Largest turning of a curve before it is meshed, at most π/3; auto: the largest whose guarantee covers the angle [default: 0.5]
    #[arg(long, value_name = "RAD|auto", allow_hyphen_values = true, help_heading = "Engine", hide_short_help = true)]
    max_turning: Option<MaxTurning>,
    /// Factor by which a protecting ball shrinks, from 0.5 to below 1 [default: 0.95]
    #[arg(long, value_name = "B", allow_hyphen_values = true, help_heading = "Engine", hide_short_help = true)]
    beta: Option<f64>,
    /// Shrink until the ball is clear, or insert at every step as printed in the paper [default: batched]
    #[arg(long, value_enum, value_name = "HOW", help_heading = "Engine", hide_short_help = true)]
    ball_shrinking: Option<BallShrinking>,
    /// Where a curve is split [default: bisector]
    #[arg(long, value_enum, value_name = "RULE", help_heading = "Engine", hide_short_help = true)]
    midpoint: Option<Midpoint>,
    /// Arcs around sharp corners, which bound the largest angle [default: on]
    #[arg(long, value_enum, value_name = "on|off", help_heading = "Engine", hide_short_help = true)]
    corner_arcs: Option<Switch>,
    /// With gcdr: points in triangles lie within r(1 - delta2) of the circumcenter, off-centres and optimal points within r - delta2 l/(2 sin
    /// angle), where l is the shortest edge [default: 1; with --steiner extreme, random, snap and size the least that the angle allows]
    #[arg(long, value_name = "D", allow_hyphen_values = true, help_heading = "Engine", hide_short_help = true)]
    delta2: Option<f64>,
    /// With gcdr: points on segments lie in the middle part of length |s|(1 - delta1) [default: 1]
    #[arg(long, value_name = "D", allow_hyphen_values = true, help_heading = "Engine", hide_short_help = true)]
    delta1: Option<f64>,
    /// With gcdr: so do those with a vertex of another segment nearby, for |s|(1 - mu) [default: 1]
    #[arg(long, value_name = "M", allow_hyphen_values = true, help_heading = "Engine", hide_short_help = true)]
    mu: Option<f64>,
    /// With gcdr: who chooses the points in triangles; nothing is proven of the free ones [default: center]
    #[arg(long, value_enum, value_name = "WHO", help_heading = "Engine", hide_short_help = true)]
    steiner: Option<Steiner>,
    /// With --steiner snap: the pitch of a square grid through the origin, or a file of places: `x y` on every line
    #[arg(long, value_name = "H|FILE", allow_hyphen_values = true, help_heading = "Engine", hide_short_help = true)]
    snap: Option<String>,
    /// With --steiner random [default: 0]
    #[arg(long, value_name = "N", help_heading = "Engine", hide_short_help = true)]
    seed: Option<u64>,
    /// With gcdr: measure how much nearer to others every point was inserted than the drawing asks for, and hold it to the bounds known
    /// [default: off]
    #[arg(long, value_enum, value_name = "on|off", help_heading = "Engine", hide_short_help = true)]
    densities: Option<Switch>,
}

/// Keys of [`Options`] that say how to run, not what to make.
const OUTSIDE: &[&str] = &["threads", "input-format"];

/// Options resolved: what to make, and how to read the input.
pub struct Resolved {
    pub request: Request,
    pub input_format: Option<Format>,
}

impl Options {
    /// Defaults, under the config file, under the command line; checked, and the threads set.
    pub fn resolve(&self) -> Result<Resolved, Halt> {
        self.resolve_over("")
    }

    /// As [`Options::resolve`], with a request recorded as TOML between the defaults and the config file.
    pub fn resolve_over(&self, recorded: &str) -> Result<Resolved, Halt> {
        let mut asked: toml::Table = recorded.parse().map_err(usage)?;
        if let Some(path) = &self.config {
            asked.extend(table(&read_config(path)?));
        }
        asked.extend(table(self));
        let (outside, mut asked): (toml::Table, toml::Table) =
            asked.into_iter().partition(|(key, _)| OUTSIDE.contains(&key.as_str()));
        let all: Self = toml::Value::Table(outside).try_into().map_err(usage)?;
        read_sizes(&mut asked)?;
        read_snap(&mut asked)?;
        let request: Request = toml::Value::Table(asked).try_into().map_err(usage)?;
        request.validate().map_err(usage)?;
        if let Some(threads) = all.threads {
            // More threads than cores only cost their stacks: the bytes of the result are the same with any number.
            let cores = std::thread::available_parallelism().map_or(1, usize::from);
            squinch::threads::set_count(usize::try_from(threads).unwrap_or(usize::MAX).min(cores));
        }
        let input_format = all.input_format.as_deref().map(input_format).transpose()?;
        Ok(Resolved { request, input_format })
    }
}

/// Puts the sizes of a file in the place of its name, so that a recorded run holds them.
fn read_sizes(asked: &mut toml::Table) -> Result<(), Halt> {
    let Some(toml::Value::String(path)) =
        asked.get("size").filter(|v| v.as_str().is_some_and(|s| Path::new(s).is_file()))
    else {
        return Ok(());
    };
    let wrong = |e: String| Halt::Usage(format!("--size {path}: {e}"));
    let text = std::fs::read_to_string(path).map_err(|e| wrong(e.to_string()))?;
    let sizes = toml::Value::try_from(Given::read_samples(&text).map_err(wrong)?).map_err(usage)?;
    asked.insert("size".into(), sizes);
    Ok(())
}

/// Puts a pitch, or the places of a file, in the place of its text.
fn read_snap(asked: &mut toml::Table) -> Result<(), Halt> {
    let Some(toml::Value::String(given)) = asked.get("snap") else { return Ok(()) };
    let wrong = |e: String| Halt::Usage(format!("--snap {given}: {e}"));
    let snap = match given.parse() {
        Ok(pitch) => SnapTo::Pitch(pitch),
        Err(_) => {
            let text = std::fs::read_to_string(given)
                .map_err(|e| wrong(format!("neither a pitch nor a file that can be read: {e}")))?;
            SnapTo::read_places(&text).map_err(wrong)?
        }
    };
    asked.insert("snap".into(), toml::Value::try_from(snap).map_err(usage)?);
    Ok(())
}

fn usage(error: impl std::fmt::Display) -> Halt {
    Halt::Usage(error.to_string().trim_end().to_owned())
}

fn input_format(name: &str) -> Result<Format, Halt> {
    Format::from_name(name).ok_or_else(|| {
        let names: Vec<_> = Format::ALL.iter().map(|f| f.name()).collect();
        Halt::Usage(format!("--input-format {name}: one of {}", names.join(", ")))
    })
}

/// What is given, by key.
fn table(options: &Options) -> toml::Table {
    toml::Table::try_from(options).expect("options are words, numbers and lists of them")
}

fn read_config(path: &Path) -> Result<Options, Halt> {
    let shown = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|e| Halt::Usage(format!("--config {shown}: {e}")))?;
    toml::from_str(&text).map_err(|error| match error.span() {
        Some(span) => {
            say::pointing(error.message(), None, &shown, &text, span);
            Halt::Said(Exit::Usage)
        }
        None => Halt::Usage(format!("--config {shown}: {}", error.message())),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{CommandFactory, Parser};

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        options: Options,
    }

    #[test]
    fn every_option_of_a_request_can_be_given_and_nothing_else() {
        let keys = |table: toml::Table| table.keys().cloned().collect::<std::collections::BTreeSet<_>>();
        let command = Line::command();
        let mut given: std::collections::BTreeSet<String> =
            command.get_arguments().filter_map(|a| a.get_long()).map(str::to_owned).collect();
        for outside in OUTSIDE.iter().chain(&["config"]) {
            assert!(given.remove(*outside), "{outside}");
        }
        let full = Request {
            max_area: Some(1.0),
            size: Some("x".parse().unwrap()),
            max_edge: Some(1.0),
            min_edge: Some(1.0),
            chord_error: Some(ChordError::Length(1.0)),
            grade: Some(1.0),
            size_of: vec!["a=1".parse().unwrap()],
            tolerance: Some(0.0),
            close: Some(1.0),
            layers: vec!["a".parse().unwrap()],
            skip_layers: vec!["a".parse().unwrap()],
            name: vec!["a=1,2".parse().unwrap()],
            unit: Some("mm".into()),
            scale: Some(1.0),
            chord: Some(1.0),
            timeout: Some(1.0),
            face: Some("largest".into()),
            delta2: Some(1.0),
            snap: Some(SnapTo::Pitch(1.0)),
            delta1: Some(1.0),
            mu: Some(1.0),
            ..Request::default()
        };
        assert_eq!(given, keys(toml::Table::try_from(full).unwrap()));
    }

    #[test]
    fn what_is_given_reaches_the_request() {
        let line = Line::parse_from([
            "x",
            "--min-angle",
            "15",
            "--max-turning",
            "auto",
            "--size-of",
            "a=1",
            "--size-of",
            "b=2",
            "--incidence",
            "-3",
            "--fill-rule",
            "evenodd",
            "--corner-arcs",
            "off",
            "--max-vertices",
            "1000",
            "--input-format",
            "poly",
            "--chord-error",
            "1%",
        ]);
        let Ok(Resolved { request, input_format }) = line.options.resolve() else { panic!("refused") };
        assert_eq!(input_format, Some(Format::Poly));
        assert_eq!(request.min_angle, 15.0);
        assert_eq!(request.max_turning, MaxTurning::Auto);
        assert_eq!(request.size_of.len(), 2);
        assert_eq!(request.incidence, -3.0);
        assert_eq!(request.fill_rule, FillChoice::EvenOdd);
        assert_eq!(request.corner_arcs, Switch::Off);
        assert_eq!(request.max_vertices, 1000);
        assert_eq!(request.chord_error, Some(ChordError::Percent(1.0)));
        assert_eq!(request.beta, Request::default().beta);
    }
}
