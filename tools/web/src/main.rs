//! The same, natively: `squinch-web DRAWING FORMAT` writes the mesh to standard output.

use std::io::Write;

fn main() -> Result<(), String> {
    let mut arguments = std::env::args().skip(1);
    let (Some(path), Some(format)) = (arguments.next(), arguments.next()) else {
        return Err("squinch-web DRAWING FORMAT".into());
    };
    let bytes = std::fs::read(&path).map_err(|e| format!("{path}: {e}"))?;
    let mesh = squinch_web::meshed(&path, &format, &bytes)?;
    std::io::stdout().write_all(&mesh).map_err(|e| e.to_string())
}
