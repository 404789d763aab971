//! `draw IN --stage S -o X.svg|X.png`: a picture of a stage of a drawing, or of a mesh file.

use super::files::{self, Input, Staged, unwritable};
use super::options::{Options, Resolved};
use super::viewing::{Colour, window};
use super::{Halt, Volume, check, clock, remember};
use clap::{Args, ValueEnum};
use squinch::domain::{Domain, Drawing};
use squinch::geometry::{Point, Rect};
use squinch::picture::{Canvas, Format, PictureOptions, picture_of_domain, picture_of_drawing, picture_of_mesh};
use squinch::refine::Until;
use squinch::run::report::FailureReport;
use squinch::run::request::Request;
use squinch::run::{self, Exit, Plan};
use squinch::watch::Watch;
use std::path::PathBuf;

/// A picture of any stage of a file, or of a mesh
#[derive(Args)]
pub struct Draw {
    /// A drawing, or a mesh (.vtu, .msh, …); - for standard input
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// What to draw; a mesh file is drawn as it is [default: mesh, or drawing with --colour layer]
    #[arg(long, value_enum, value_name = "STAGE")]
    stage: Option<Stage>,
    /// Where the picture goes: .svg or .png; - for standard output, as SVG
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// What triangles are coloured by; layer: curves as found, by their layers
    #[arg(long, value_enum, default_value_t = Colour::Quality, value_name = "BY")]
    colour: Colour,
    /// The window to show, in the drawing's units [default: all of it]
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = window, allow_hyphen_values = true)]
    view: Option<Rect>,
    /// Width of the picture in pixels
    #[arg(long, value_name = "PX", default_value_t = 1200, value_parser = clap::value_parser!(u32).range(100..=8192))]
    width: u32,
    #[command(flatten)]
    options: Options,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Stage {
    /// The curves as found, their repairs or (with --tolerance 0) the flaws that stay, and the place of the first error
    Drawing,
    /// Welded, split and named: regions, points, sharp corners, and every repair by its kind
    Domain,
    /// The domain's curves cut to the largest turning
    Subcurves,
    /// The triangulation as soon as every piece of a curve is an edge
    Triangulation,
    /// Refined, with the balls that protect sharp corners
    Refined,
    /// The mesh as it is written
    Mesh,
}

impl Draw {
    /// Draws the picture.
    pub fn run(self, _volume: Volume) -> Result<Exit, Halt> {
        if self.colour == Colour::Layer && self.shown() != Stage::Drawing {
            return Err(Halt::Usage("--colour layer: only with --stage drawing".into()));
        }
        let Resolved { request, input_format } = self.options.resolve()?;
        let format = match Format::of(&self.output) {
            Some(format) => format,
            None if self.output.as_os_str() == "-" => Format::Svg,
            None => return Err(Halt::Usage(format!("-o {}: pictures are .svg or .png", self.output.display()))),
        };
        files::can_be_written([&self.output])?;
        let input = Input::open(&self.input, input_format)?;
        let is_mesh = check::is_mesh(&input);
        if is_mesh && self.colour == Colour::Layer {
            return Err(Halt::Usage("--colour layer: only for drawings; a mesh has --colour region".into()));
        }
        let canvas = if is_mesh {
            let file = check::read(&input)?;
            picture_of_mesh(&file.mesh, None, self.colour.of_mesh(), &self.picture(input.path, true))
        } else {
            remember(&input, &request);
            self.stage(&input, &request).map_err(|failure| Halt::Failure(Box::new(failure), Some(Box::new(input))))?
        };
        let mut staged = Staged::default();
        format
            .encode(&canvas)
            .and_then(|bytes| staged.add(&self.output, &bytes))
            .and_then(|()| staged.commit())
            .map_err(unwritable)?;
        Ok(Exit::Done)
    }

    fn stage(&self, input: &Input, request: &Request) -> Result<Canvas, FailureReport> {
        let clock = clock();
        let watch: &mut Watch = &mut run::timer(request, &clock);
        let drawing = run::read(&input.source(), request)?;
        let arranged = run::arrange(&drawing, request, watch);
        let mut picture = self.picture(drawing.title.clone(), self.shown() != Stage::Mesh);
        if matches!(self.shown(), Stage::Drawing | Stage::Domain) {
            picture.repairs = arranged.as_ref().map(|domain| domain.repairs().to_vec()).unwrap_or_default();
            // Pictures have no notes.
            picture.unhealed = run::unhealed(&drawing, request, &mut Vec::new(), watch);
        }
        if self.shown() == Stage::Drawing {
            let marks = arranged.err().map_or_else(Vec::new, marks);
            return Ok(picture_of_drawing(&drawing, &PictureOptions { marks, ..picture }));
        }
        self.stage_of_domain(&drawing, &arranged?, request, watch, &picture)
    }

    fn stage_of_domain(
        &self,
        drawing: &Drawing,
        arranged: &Domain,
        request: &Request,
        watch: &mut Watch,
        picture: &PictureOptions,
    ) -> Result<Canvas, FailureReport> {
        if self.shown() == Stage::Domain {
            return Ok(picture_of_domain(arranged, picture));
        }
        let (domain, plan) = Plan::new(drawing, arranged, request, watch)?;
        if self.shown() == Stage::Subcurves {
            return Ok(picture_of_domain(&domain, picture));
        }
        let refined = match self.shown() {
            Stage::Triangulation => plan.drive(&domain, Until::Conforming, watch)?,
            _ => plan.refine(&domain, watch)?,
        };
        let mesh = refined.mesh.ok_or_else(|| run::no_mesh(&refined.stop, "--timeout"))?;
        Ok(picture_of_mesh(&mesh, Some(&domain), self.colour.of_mesh(), picture))
    }

    fn shown(&self) -> Stage {
        self.stage.unwrap_or(if self.colour == Colour::Layer { Stage::Drawing } else { Stage::Mesh })
    }

    fn picture(&self, title: String, balls: bool) -> PictureOptions {
        PictureOptions {
            layers: self.colour == Colour::Layer,
            width_px: self.width,
            view: self.view,
            balls,
            title,
            ..PictureOptions::default()
        }
    }
}

/// The places of a flaw, with its text at the first one.
fn marks(failure: FailureReport) -> Vec<(Point, String)> {
    let words = std::iter::once(failure.what).chain(std::iter::repeat(String::new()));
    let places = failure.at.into_iter().chain(failure.also_at);
    places.filter_map(|at| at.in_plane()).map(|[x, y]| Point::new(x, y)).zip(words).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_is_four_numbers_in_order() {
        assert_eq!(window("-1, -2.5,3,4e1"), Ok(Rect::new(-1.0, -2.5, 3.0, 40.0)));
        for wrong in ["", "1,2,3", "0,0,0,1", "0,1,1,0", "0,0,nan,1", "0,0,1,inf", "0,0,1,1,2"] {
            assert!(window(wrong).is_err(), "{wrong}");
        }
    }
}
