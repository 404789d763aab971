//! What the writers of planar and of solid meshes share: the head of the file, arrays and their compression, names.

use crate::ids::{Id, IdVec, NameId, Names, RegionId};
use crate::meshio::names::xml_attribute;
use crate::threads;
use base64::Engine;
use flate2::{Compress, Compression, FlushCompress, Status};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{self, Write};

/// Bytes of a compressed block: a multiple of every word, large enough to compress well, small enough to share among
/// threads.
const BLOCK: usize = 1 << 17;

/// Opens the file and its grid.
pub fn begin(out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(
        out,
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
         compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>"
    )
}

/// Names of boundaries numbered from 1 in the order of first use, which a reader recovers.
pub fn boundary_numbers(names: impl Iterator<Item = NameId>) -> BTreeMap<NameId, i32> {
    let mut numbers = BTreeMap::new();
    for name in names {
        let next = numbers.len() as i32 + 1;
        numbers.entry(name).or_insert(next);
    }
    numbers
}

/// Fields that say how the mesh was made, and its unit.
pub fn write_stamps(stamps: &[(String, String)], unit: Option<&str>, out: &mut impl Write) -> io::Result<()> {
    for (key, value) in stamps {
        let name = format!("squinch:{key}");
        match value.parse::<f64>() {
            Ok(number) if number.to_string() == *value => Array::of_f64(&name, 1, [number]),
            _ => Array::of_u8(&name, value.as_bytes().to_vec()),
        }
        .write_field(out)?;
    }
    unit.map_or(Ok(()), |unit| Array::of_u8("unit", unit.as_bytes().to_vec()).write_field(out))
}

/// Fields that say which numbers of regions and boundaries carry a name.
pub fn write_names(
    names: &Names,
    regions: &IdVec<RegionId, NameId>,
    boundaries: &BTreeMap<NameId, i32>,
    out: &mut impl Write,
) -> io::Result<()> {
    // In the order of first use, so that the file is the same whatever the order of the table of names.
    let mut numbers: BTreeMap<NameId, Vec<i32>> = BTreeMap::new();
    for (region, &name) in regions.enumerate() {
        numbers.entry(name).or_default().push(region.index() as i32 + 1);
    }
    for name in regions.iter() {
        let Some(numbers) = numbers.remove(name) else { continue };
        Array::of_i32(&format!("region:{}", names.text(*name)), numbers).write_field(out)?;
    }
    let mut by_number: Vec<(i32, NameId)> = boundaries.iter().map(|(&name, &number)| (number, name)).collect();
    by_number.sort_unstable();
    for (number, name) in by_number {
        Array::of_i32(&format!("boundary:{}", names.text(name)), [number]).write_field(out)?;
    }
    Ok(())
}

/// One `DataArray`, its values as little-endian bytes.
pub struct Array<'a> {
    name: &'a str,
    kind: &'static str,
    components: usize,
    values: usize,
    bytes: Vec<u8>,
}

impl<'a> Array<'a> {
    pub fn of_i32(name: &'a str, values: impl IntoIterator<Item = i32>) -> Self {
        let bytes: Vec<u8> = values.into_iter().flat_map(i32::to_le_bytes).collect();
        Self { name, kind: "Int32", components: 1, values: bytes.len() / 4, bytes }
    }

    pub fn of_f64(name: &'a str, components: usize, values: impl IntoIterator<Item = f64>) -> Self {
        let bytes: Vec<u8> = values.into_iter().flat_map(f64::to_le_bytes).collect();
        Self { name, kind: "Float64", components, values: bytes.len() / 8, bytes }
    }

    pub fn of_u8(name: &'a str, bytes: Vec<u8>) -> Self {
        Self { name, kind: "UInt8", components: 1, values: bytes.len(), bytes }
    }

    /// The same values, so many to a tuple.
    pub fn in_tuples(self, components: usize) -> Self {
        Self { components, ..self }
    }

    /// A field array also says how many tuples it has: VTK cannot know otherwise. An empty list is left out; an empty
    /// text is kept.
    pub fn write_field(&self, out: &mut impl Write) -> io::Result<()> {
        if self.values == 0 && !self.name.starts_with("squinch:") {
            return Ok(());
        }
        self.write_with(&format!(" NumberOfTuples=\"{}\"", self.values / self.components), out)
    }

    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        self.write_with("", out)
    }

    fn write_with(&self, more: &str, out: &mut impl Write) -> io::Result<()> {
        let name = xml_attribute(self.name);
        let components =
            if self.components == 1 { String::new() } else { format!(" NumberOfComponents=\"{}\"", self.components) };
        let format = if self.bytes.is_empty() { "ascii" } else { "binary" };
        writeln!(out, "<DataArray type=\"{}\" Name=\"{name}\"{components}{more} format=\"{format}\">", self.kind)?;
        if !self.bytes.is_empty() {
            write_compressed(&self.bytes, out)?;
        }
        writeln!(out, "\n</DataArray>")
    }
}

/// Header (number of blocks, block size, size of a last partial block, compressed sizes) and blocks, each as base64.
fn write_compressed(bytes: &[u8], out: &mut impl Write) -> io::Result<()> {
    let blocks: Vec<&[u8]> = bytes.chunks(BLOCK).collect();
    let blocks: Vec<Vec<u8>> =
        threads::map(&blocks, |block| compressed(block)).into_iter().collect::<io::Result<_>>()?;
    let mut header = vec![blocks.len() as u64, BLOCK as u64, (bytes.len() % BLOCK) as u64];
    header.extend(blocks.iter().map(|b| b.len() as u64));
    let header: Vec<u8> = header.into_iter().flat_map(u64::to_le_bytes).collect();
    let base64 = &base64::engine::general_purpose::STANDARD;
    out.write_all(base64.encode(header).as_bytes())?;
    out.write_all(base64.encode(blocks.concat()).as_bytes())
}

thread_local! {
    /// Each thread keeps its compressor: to make one, a third of a megabyte has to be cleared.
    static DEFLATE: RefCell<Compress> = RefCell::new(Compress::new(Compression::fast(), true));
}

/// A block as a zlib stream.
fn compressed(block: &[u8]) -> io::Result<Vec<u8>> {
    DEFLATE.with_borrow_mut(|deflate| {
        deflate.reset();
        let mut out = Vec::with_capacity(BLOCK / 4);
        loop {
            let done = deflate.total_in() as usize;
            match deflate.compress_vec(&block[done..], &mut out, FlushCompress::Finish)? {
                Status::StreamEnd => return Ok(out),
                Status::Ok | Status::BufError => out.reserve(BLOCK / 4),
            }
        }
    })
}
