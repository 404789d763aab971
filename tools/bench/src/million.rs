//! About 10⁶ triangles on a curved sample.

use crate::run;
use squinch::meshio::{Format, WriteOptions, encode};
use squinch::plane::lopping::Options;
use squinch::size::Sizing;
use std::time::Instant;

pub fn print() {
    let drawing = run::read("samples/plate.json").expect("the sample is there");
    let measure = run::run(&drawing, 0.5, &run::unsized_options(0.36)).expect("the sample meshes").domain.area();
    // Triangles of a uniformly refined mesh have about 0.6 of the largest area allowed.
    let sizing = Sizing { max_area: Some(measure / 1e6 / 0.62), ..Sizing::default() };
    let options = Options { sizing, ..run::unsized_options(20.7f64.to_radians()) };
    let r = run::run(&drawing, 0.5, &options).expect("the sample meshes");
    let start = Instant::now();
    let bytes = encode(&r.mesh, &[], Format::Vtu, &WriteOptions::default()).expect("memory holds the file").concat();
    let write = start.elapsed().as_secs_f64();
    let n = r.mesh.triangles.len();
    println!("{n} triangles, kept: {}", r.verdict.kept());
    println!(
        "seconds: arrange {:.3}, refine {:.3}, verify {:.3}, write {write:.3}",
        r.seconds.arrange, r.seconds.refine, r.seconds.verify
    );
    println!(
        "refine: {:.3} µs a triangle; file: {:.1} bytes a triangle",
        1e6 * r.seconds.refine / n as f64,
        bytes.len() as f64 / n as f64
    );
    println!("peak memory: {:.1} bytes a triangle (whole process)", peak_memory() / n as f64);
    for (name, count) in &r.counters.0 {
        println!("    {name}: {count}");
    }
}

/// Peak resident memory in bytes; 0 where the system does not tell.
fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    line.and_then(|l| l.trim().trim_end_matches(" kB").parse::<f64>().ok()).unwrap_or(0.0) * 1024.0
}
