//! The bytes of arrays: base64, zlib, words.
//!
//! ```text
//!    plain       ┌─────┬────────┐                          n: bytes of the values
//!                │  n  │ values │                          one base64 text, or (some writers) two
//!                └─────┴────────┘
//!    zlib        ┌────────┬──────┬──────┬──────────────┐ ┌─────────┬─────────┬───┐
//!                │ blocks │ size │ last │ packed sizes │ │ block 0 │ block 1 │ … │     two base64 texts
//!                └────────┴──────┴──────┴──────────────┘ └─────────┴─────────┴───┘
//!    inline      <DataArray …> one array </DataArray>
//!    appended    <AppendedData encoding="base64"> _ array array …     offsets count from the byte after `_`
//!
//!    Header words have 4 or 8 bytes (`header_type`). size: bytes of an unpacked block; last: of a partial last block
//! ```
//!
//! Input is untrusted. Every count is checked against the bytes at hand. All arrays together may grow to at most
//! `GROWTH` times the file plus `ALLOWANCE`.

use super::xml::{Array, Encoding, File, Kind, Place};
use crate::meshio::{Result, broken};
use base64::Engine;
use std::io::Read;

/// Our own meshes grow about fivefold. zlib allows a thousandfold, which only a malicious file has.
const GROWTH: usize = 32;
/// Small files of constant arrays may grow by more, up to 64 MB.
const ALLOWANCE: usize = 64 << 20;

/// Unpacks arrays until the allowance is used up.
pub struct Unpacker<'f, 'a> {
    /// The file.
    pub file: &'f File<'a>,
    left: usize,
}

/// Bytes, raw or as base64.
struct Source<'a> {
    encoding: Encoding,
    rest: &'a [u8],
}

impl Source<'_> {
    /// The next segment of `n` bytes. In base64 each segment begins a new group of four characters.
    fn segment(&mut self, n: usize) -> Option<Vec<u8>> {
        match self.encoding {
            Encoding::Raw => {
                let (segment, rest) = self.rest.split_at_checked(n)?;
                self.rest = rest;
                Some(segment.to_vec())
            }
            Encoding::Base64 => {
                let (mut bytes, used) = self.decode(n)?;
                self.rest = &self.rest[used..];
                bytes.truncate(n);
                Some(bytes)
            }
        }
    }

    /// The first `n` bytes of the next segment, without consuming it, and whether the segment ends with them.
    fn peek(&self, n: usize) -> Option<(Vec<u8>, bool)> {
        match self.encoding {
            Encoding::Raw => Some((self.rest.get(..n)?.to_vec(), false)),
            Encoding::Base64 => {
                let (mut bytes, used) = self.decode(n)?;
                let ends = self.rest[..used].last() == Some(&b'=');
                bytes.truncate(n);
                Some((bytes, ends))
            }
        }
    }

    /// At least `n` bytes from whole groups of four characters, and the number of characters consumed, with white
    /// space.
    fn decode(&self, n: usize) -> Option<(Vec<u8>, usize)> {
        let wanted = n.div_ceil(3).checked_mul(4).filter(|&w| w <= self.rest.len())?;
        let mut characters = Vec::with_capacity(wanted);
        let mut used = 0;
        while characters.len() < wanted {
            let c = *self.rest.get(used)?;
            used += 1;
            if !c.is_ascii_whitespace() {
                characters.push(c);
            }
        }
        let bytes = ANY_PADDING.decode(characters).ok().filter(|bytes| bytes.len() >= n)?;
        Some((bytes, used))
    }
}

/// Some writers omit the padding or set unused bits.
const ANY_PADDING: base64::engine::GeneralPurpose = base64::engine::GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    base64::engine::GeneralPurposeConfig::new()
        .with_decode_padding_mode(base64::engine::DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

impl<'f, 'a> Unpacker<'f, 'a> {
    /// Unpacks a file of this many bytes.
    pub fn new(file: &'f File<'a>, bytes: usize) -> Self {
        Self { file, left: bytes.saturating_mul(GROWTH).saturating_add(ALLOWANCE) }
    }

    /// The values of an array as numbers (integers up to 2⁵³ are exact), at most `most` of them.
    pub fn numbers(&mut self, array: &Array, most: u64) -> Result<Vec<f64>> {
        let size = array.kind.size().ok_or_else(|| broken(format!("array '{}' does not hold numbers", array.name)))?;
        if let Place::Ascii(text) = array.place {
            self.left = self.left.saturating_sub(text.len());
            let text = std::str::from_utf8(text).map_err(|_| broken(format!("array '{}' is not text", array.name)))?;
            let number =
                |word: &str| word.parse().map_err(|_| broken(format!("array '{}' holds '{word}'", array.name)));
            return text
                .split_ascii_whitespace()
                .take(usize::try_from(most).unwrap_or(usize::MAX))
                .map(number)
                .collect();
        }
        let most_bytes = usize::try_from(most).unwrap_or(usize::MAX).saturating_mul(size).min(self.left);
        let bytes = self.bytes(array, most_bytes)?;
        Ok(bytes.chunks_exact(size).map(|word| number(array.kind, word, self.file.big_endian)).collect())
    }

    /// As [`Self::numbers`], for integers in `lowest..=i32::MAX`.
    pub fn integers(&mut self, array: &Array, most: u64, lowest: i32) -> Result<Vec<i32>> {
        let integer = |v: f64| {
            let right = v >= f64::from(lowest) && v <= f64::from(i32::MAX) && v.fract() == 0.0;
            right.then_some(v as i32).ok_or_else(|| broken(format!("array '{}' holds {v}", array.name)))
        };
        self.numbers(array, most)?.into_iter().map(integer).collect()
    }

    fn bytes(&mut self, array: &Array, most: usize) -> Result<Vec<u8>> {
        let mut source = match (array.place, self.file.appended) {
            (Place::Ascii(text), _) => Source { encoding: Encoding::Raw, rest: text },
            (Place::Inline(text), _) => Source { encoding: Encoding::Base64, rest: text },
            (Place::Appended(offset), Some((encoding, data))) => {
                let rest = usize::try_from(offset).ok().and_then(|offset| data.get(offset..));
                let rest = rest.ok_or_else(|| broken(format!("array '{}' lies beyond the end", array.name)))?;
                Source { encoding, rest }
            }
            (Place::Appended(_), None) => return Err(broken("there are no appended data")),
        };
        let packed = source.rest.len();
        let unpacked = if self.file.zlib { self.inflated(&mut source, most) } else { self.plain(&mut source, most) };
        let unpacked =
            unpacked.ok_or_else(|| broken(format!("array '{}' is cut short, too long or garbled", array.name)))?;
        // The packed bytes count, too, because many arrays may share appended data.
        self.left = self.left.saturating_sub(unpacked.len()).saturating_sub(packed - source.rest.len());
        Ok(unpacked)
    }

    fn word(&self, bytes: &[u8]) -> Option<usize> {
        usize::try_from(number(Kind::UInt(bytes.len()), bytes, self.file.big_endian) as u64).ok()
    }

    /// Unpacked data: number of bytes, then the bytes, in one segment or (by some writers) two.
    fn plain(&self, source: &mut Source, most: usize) -> Option<Vec<u8>> {
        let header = self.file.header_bytes;
        let (length, apart) = source.peek(header)?;
        let length = self.word(&length).filter(|&n| n <= most)?;
        if apart {
            source.segment(header)?;
            return source.segment(length);
        }
        let mut bytes = source.segment(header.checked_add(length)?)?;
        bytes.drain(..header);
        Some(bytes)
    }

    /// Packed data: number of blocks, block size, size of a partial last block, packed sizes; then, in a second
    /// segment, the blocks.
    fn inflated(&self, source: &mut Source, most: usize) -> Option<Vec<u8>> {
        let word = self.file.header_bytes;
        let blocks = self.word(&source.peek(word)?.0)?;
        let header = source.segment(blocks.checked_add(3)?.checked_mul(word)?)?;
        let words: Vec<usize> = header.chunks_exact(word).map(|w| self.word(w)).collect::<Option<_>>()?;
        let (size, last, sizes) = (words[1], words[2], &words[3..]);
        let unpacked = |i: usize| if i + 1 == blocks && last > 0 { last } else { size };
        (0..blocks).try_fold(0_usize, |sum, i| sum.checked_add(unpacked(i))).filter(|&all| all <= most)?;
        let packed = source.segment(sizes.iter().try_fold(0_usize, |sum, &n| sum.checked_add(n))?)?;
        let (mut bytes, mut from) = (Vec::new(), 0);
        for (i, &n) in sizes.iter().enumerate() {
            let end = bytes.len() + unpacked(i);
            let block = packed.get(from..from + n)?;
            // One byte more than expected, so that zlib reads its end and checksum.
            let most = (unpacked(i) as u64).saturating_add(1);
            flate2::read::ZlibDecoder::new(block).take(most).read_to_end(&mut bytes).ok()?;
            if bytes.len() != end {
                return None;
            }
            from += n;
        }
        Some(bytes)
    }
}

fn number(kind: Kind, word: &[u8], big_endian: bool) -> f64 {
    let mut bits = 0_u64;
    for (i, &byte) in word.iter().enumerate() {
        let place = if big_endian { word.len() - 1 - i } else { i };
        bits |= u64::from(byte) << (8 * place);
    }
    match kind {
        Kind::Float(4) => f64::from(f32::from_bits(bits as u32)),
        Kind::Float(_) => f64::from_bits(bits),
        Kind::Int(n) => {
            let unused = 64 - 8 * n as u32;
            (((bits << unused) as i64) >> unused) as f64
        }
        Kind::UInt(_) | Kind::Other => bits as f64,
    }
}
