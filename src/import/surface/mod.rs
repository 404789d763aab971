//! Readers of surfaces in space: bytes → [`Surfaces`]. Nothing is welded or dropped here, that is
//! [`Surfaces::assemble`]'s part.

mod off;
mod stl;
mod tetgen;
mod text;

pub use super::ImportError as SurfaceError;

use crate::solid::Surfaces;

/// Suffixes of files that hold surfaces, and what reads them.
const READERS: [(&str, Reader); 4] =
    [("poly", tetgen::read_poly), ("smesh", tetgen::read_smesh), ("off", off::read), ("stl", stl::read)];

type Reader = fn(&[u8]) -> Result<Surfaces, SurfaceError>;

/// Whether the bytes, of a file with this suffix, hold a surface in space. A `.poly` is TetGen's, and not Triangle's,
/// where the dimension in its first line is 3.
pub fn is_surface(bytes: &[u8], suffix: Option<&str>) -> bool {
    reader_of(bytes, suffix).is_some()
}

/// Reads a surface.
///
/// # Errors
/// [`SurfaceError`] with the line where the file breaks its format. Never panics, and takes memory in proportion to
/// `bytes`.
pub fn read(bytes: &[u8], suffix: Option<&str>) -> Result<Surfaces, SurfaceError> {
    let reader = reader_of(bytes, suffix).ok_or_else(|| {
        let known: Vec<_> = READERS.iter().map(|(suffix, _)| format!(".{suffix}")).collect();
        let help = format!("surfaces are read from {}; give the file its suffix", known.join(", "));
        SurfaceError::new("this is no surface in space of a known format", help)
    })?;
    reader(bytes)
}

fn reader_of(bytes: &[u8], suffix: Option<&str>) -> Option<Reader> {
    let named = suffix.and_then(|s| READERS.iter().find(|(known, _)| known.eq_ignore_ascii_case(s)));
    match named {
        Some(("poly", _)) if !tetgen::in_space(bytes) => None,
        Some((_, reader)) => Some(*reader),
        None if suffix.is_some_and(|s| !s.is_empty()) => None,
        None if off::sniff(bytes) => Some(off::read),
        None if stl::sniff(bytes) => Some(stl::read),
        None if tetgen::in_space(bytes) => Some(tetgen::read_poly),
        None => None,
    }
}
