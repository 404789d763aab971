//! A planar face built with truck-modeling: a line, a circular arc, a spline and a round hole, on a tilted plane. Meshed, judged,
//! and written with its places in space.
//!
//! `cargo run --features cad --example truck_face -- face.vtu`

use squinch::cad::truck::drawing_of_truck_face;
use squinch::meshio::{Format, WriteOptions, encode};
use squinch::run::request::Request;
use squinch::run::{Exit, Extent, run_drawing};
use squinch::watch::no_clock;
use std::error::Error;
use truck_modeling::{Face, Point3, Rad, Vector3, Wire, builder};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "truck_face.vtu".into());
    let drawing = drawing_of_truck_face(&face()?)?;
    let mut request = Request::default();
    request.limits.max_edge = Some(0.4);
    let outcome = run_drawing(&drawing, &request, Extent::Whole(&mut |_progress| true), &no_clock);
    let (Some(mesh), Exit::Done) = (&outcome.mesh, outcome.exit) else {
        return Err(format!("no mesh that keeps its promises: {:?}", outcome.report.failure).into());
    };
    std::fs::write(&path, encode(mesh, &[], Format::Vtu, &WriteOptions::default())?.concat())?;
    let names: Vec<_> = mesh.names.iter().map(|(_, name)| name).collect();
    println!("{path}: {} triangles, named {}; every guarantee holds", mesh.triangles.len(), names.join(", "));
    Ok(())
}

/// The face, 30 degrees off the horizontal.
fn face() -> Result<Face, Box<dyn Error>> {
    let vertex = |x, y| builder::vertex(Point3::new(x, y, 0.0));
    let (a, b, c) = (vertex(0.0, 0.0), vertex(4.0, 0.0), vertex(4.0, 3.0));
    let rim: Wire = vec![
        builder::line(&a, &b),
        builder::circle_arc(&b, &c, Point3::new(5.5, 1.5, 0.0)),
        builder::bezier(&c, &a, vec![Point3::new(2.0, 5.0, 0.0), Point3::new(0.0, 3.0, 0.0)]),
    ]
    .into();
    let start = vertex(2.5, 1.2);
    let mut hole: Wire = builder::rsweep(&start, Point3::new(2.0, 1.2, 0.0), Vector3::unit_z(), Rad(7.0));
    hole.invert();
    let flat = builder::try_attach_plane(&[rim, hole])?;
    let tilt = Rad(std::f64::consts::FRAC_PI_6);
    Ok(builder::rotated(&flat, Point3::new(0.0, 0.0, 0.0), Vector3::unit_x(), tilt))
}
