//! squinch as a WebAssembly module: a drawing's bytes go in, a mesh file's come out.
//!
//! The caller asks for room by [`input`], writes name, formats and drawing there, calls [`mesh`], and reads what [`output`] points at. One call at
//! a time: the module has one thread, and one buffer either way. `unsafe` is said of the exported names alone, which no other symbol may have;
//! no memory is touched by pointers here.

use squinch::meshio::{self, WriteOptions};
use squinch::picture::{self, MeshColour, PictureOptions, picture_of_mesh};
use squinch::prelude::*;
use std::sync::{Mutex, PoisonError};

static INPUT: Mutex<Vec<u8>> = Mutex::new(Vec::new());
static OUTPUT: Mutex<Vec<u8>> = Mutex::new(Vec::new());

/// Room for so many bytes of input.
#[unsafe(no_mangle)]
pub extern "C" fn input(bytes: usize) -> *mut u8 {
    let mut input = INPUT.lock().unwrap_or_else(PoisonError::into_inner);
    *input = vec![0; bytes];
    input.as_mut_ptr()
}

/// Where the output of the last call begins.
#[unsafe(no_mangle)]
pub extern "C" fn output() -> *const u8 {
    OUTPUT.lock().unwrap_or_else(PoisonError::into_inner).as_ptr()
}

/// Meshes the input, of which the first `name` bytes are the drawing's file name, the next `format` the mesh format's, and the rest the drawing. How
/// many bytes of output there are: a mesh file, or, negative, a message.
#[unsafe(no_mangle)]
pub extern "C" fn mesh(name: usize, format: usize) -> isize {
    let input = INPUT.lock().unwrap_or_else(PoisonError::into_inner);
    let (sign, bytes) = match parts(&input, name, format).and_then(|(name, format, bytes)| meshed(name, format, bytes))
    {
        Ok(bytes) => (1, bytes),
        Err(message) => (-1, message.into_bytes()),
    };
    let mut output = OUTPUT.lock().unwrap_or_else(PoisonError::into_inner);
    *output = bytes;
    sign * output.len() as isize
}

fn parts(input: &[u8], name: usize, format: usize) -> Result<(&str, &str, &[u8]), String> {
    let (name, rest) = input.split_at_checked(name).ok_or("the name is longer than the input")?;
    let (format, bytes) = rest.split_at_checked(format).ok_or("the format is longer than the input")?;
    let [name, format] = [name, format].map(|text| std::str::from_utf8(text).map_err(|e| e.to_string()));
    Ok((name?, format?, bytes))
}

/// The mesh of a drawing by the defaults, or a picture of it, as a file of one part.
///
/// # Errors
/// What is wrong, and the way out.
pub fn meshed(name: &str, format: &str, bytes: &[u8]) -> Result<Vec<u8>, String> {
    let source = Source { path: name, bytes, format: None, nodes: None, of_many: false };
    let (file, picture) = (meshio::Format::named(format), picture::Format::named(format));
    if file.is_none() && picture.is_none() {
        return Err(format!("{format}: no format of meshes"));
    }
    let outcome = run(&source, &Request::default(), Extent::Whole(&mut |_progress| true), &no_clock);
    if let Some(failure) = outcome.report.failure {
        return Err(format!("{}: {}", failure.what, failure.help));
    }
    let mesh = outcome.mesh.ok_or("no mesh")?;
    let draw = |format: picture::Format| {
        let options = PictureOptions::default();
        format.encode(&picture_of_mesh(&mesh, outcome.domain.as_ref(), MeshColour::Quality, &options))
    };
    let write = |format| {
        Ok(meshio::encode(&mesh, &[], format, &WriteOptions::default())?.into_iter().next().unwrap_or_default())
    };
    let written = file.map(write).or_else(|| picture.map(draw));
    written.ok_or("nothing was written")?.map_err(|e: std::io::Error| e.to_string())
}
