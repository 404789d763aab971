//! A pen alphabet, so that a PNG needs no font: each glyph is a few polylines on a grid of 0.08 em.
//!
//! A polyline is a word of places. A place is a digit (x) and a letter (y: `d` is the baseline, `m` the height of
//! capitals, `j` that of small letters).

/// Size of a grid step, in em: capitals are 9 steps, 0.72 em, as in common sans-serif fonts.
const STEP: f64 = 0.08;
/// Space between two glyphs, in steps.
const GAP: f64 = 2.2;
/// Width of the pen, in em.
pub(super) const PEN: f64 = 0.09;

/// The advance of the pen after a character, in em.
pub(super) fn advance(c: char) -> f64 {
    let widest = glyph(c).split(' ').flat_map(places).map(|(x, _)| x).fold(0.0, f64::max);
    if c.is_whitespace() { 4.0 * STEP } else { widest + GAP * STEP }
}

/// Passes each polyline of a character to `line`: places in em, to the right of and above the start of its baseline.
pub(super) fn strokes(c: char, mut line: impl FnMut(&mut dyn Iterator<Item = (f64, f64)>)) {
    for word in glyph(c).split(' ').filter(|w| !w.is_empty()) {
        line(&mut places(word));
    }
}

fn places(word: &str) -> impl Iterator<Item = (f64, f64)> {
    word.as_bytes()
        .chunks_exact(2)
        .map(|xy| (f64::from(xy[0] - b'0') * STEP, (f64::from(xy[1]) - f64::from(b'd')) * STEP))
}

#[rustfmt::skip]
fn glyph(c: char) -> &'static str {
    match c {
        'A' => "0d3m6d 1g5g", 'B' => "0d0m4m6l6j4i0i 4i6h6e4d0d", 'C' => "6k4m2m0k0f2d4d6f", 'D' => "0d0m3m6k6f3d0d",
        'E' => "5d0d0m5m 0i4i", 'F' => "0d0m5m 0i4i", 'G' => "6k4m2m0k0f2d4d6f6h4h",
        'H' => "0d0m 6d6m 0i6i", 'I' => "0d0m",
        'J' => "0f1d3d5f5m", 'K' => "0d0m 6m0h 2i6d", 'L' => "0m0d5d", 'M' => "0d0m3g6m6d", 'N' => "0d0m6d6m",
        'O' => "2d0f0k2m4m6k6f4d2d", 'P' => "0d0m4m6l6i4h0h",
        'Q' => "2d0f0k2m4m6k6f4d2d 4f6d", 'R' => "0d0m4m6l6i4h0h 3h6d",
        'S' => "6l4m2m0l0j1i5h6g6e4d2d0e", 'T' => "0m6m 3m3d", 'U' => "0m0f2d4d6f6m",
        'V' => "0m3d6m", 'W' => "0m2d4k6d8m",
        'X' => "0d6m 0m6d", 'Y' => "0m3h6m 3h3d", 'Z' => "0m6m0d6d",
        'a' => "5i3j2j0h0f2d3d5f 5j5d", 'b' => "0m0d 0f2d3d5f5h3j2j0h",
        'c' => "5i3j2j0h0f2d3d5e", 'd' => "5m5d 5f3d2d0f0h2j3j5h",
        'e' => "0g5g5h3j2j0h0f2d3d5e", 'f' => "1d1l2m4m 0j3j",
        'g' => "5j5c3a1a0b 5h3j2j0h0f2d3d5f", 'h' => "0d0m 0h2j3j5h5d",
        'i' => "0d0j 0l0m", 'j' => "2j2b1a0a 2l2m", 'k' => "0d0m 4j0f 1g4d",
        'l' => "0d0m", 'm' => "0d0j 0h1j3j4h4d 4h5j7j8h8d",
        'n' => "0d0j 0h2j3j5h5d", 'o' => "2d0f0h2j3j5h5f3d2d",
        'p' => "0a0j 0f2d3d5f5h3j2j0h", 'q' => "5a5j 5f3d2d0f0h2j3j5h",
        'r' => "0d0j 0h2j3j", 's' => "4i3j1j0i0h4f4e3d1d0e", 't' => "1l1e2d3d 0j3j",
        'u' => "0j0f2d3d5f 5j5d", 'v' => "0j2d4j",
        'w' => "0j2d4j6d8j", 'x' => "0d4j 0j4d", 'y' => "0j2d 4j1a0a", 'z' => "0j4j0d4d",
        '0' => "2d0f0k2m3m5k5f3d2d", '1' => "0k2m2d", '2' => "0k1m4m5k5i0d5d",
        '3' => "0m5m2i4i5h5f4d1d0f", '4' => "4d4m0g6g",
        '5' => "5m0m0i3i5h5f3d1d0e", '6' => "5l4m2m0k0f2d3d5f5g3i2i0g",
        '7' => "0m5m2d", '8' => "2i0k0l2m3m5l5k3i2i0g0e2d3d5e5g3i",
        '9' => "0e1d3d5f5k3m2m0k0j2h3h5j",
        '.' => "0d0e", ',' => "1e0b", ':' => "0d0e 0i0j", ';' => "1e0b 1i1j",
        '-' | '–' => "0h4h", '—' => "0h7h", '−' => "0h5h", '_' => "0c5c",
        '+' => "0h4h 2f2j", '=' => "0g4g 0i4i", '/' => "0c4m", '\\' => "0m4c", '(' => "2n0k0e2b", ')' => "0n2k2e0b",
        '[' => "2n0n0b2b", ']' => "0n2n2b0b", '{' => "2n1m1i0h1g1c2b",
        '}' => "0n1m1i2h1g1c0b", '<' => "4k0h4e", '>' => "0k4h0e",
        '!' => "0d0e 0g0m", '?' => "0k1m3m5k5j2h2g 2d2e", '\'' => "0m0k",
        '"' => "0m0k 2m2k", '#' => "1d2m 4d5m 0g6g 0j6j",
        '%' => "0d6m 1m0l0k1j2k2l1m 5g4f4e5d6e6f5g", '&' => "6d1k1l2m3m4l4k0g0e1d3d6g",
        '*' => "2i2m 0j4l 0l4j", '~' => "0h1i3g4h",
        '^' => "0k2m4k", '|' => "0b0n", '$' => "6l4m2m0l0j1i5h6g6e4d2d0e 3n3c", '`' => "0m1k",
        '@' => "5f5i3j2i2g3f5f6f7h7k5m2m0k0f2d5d", '°' => "1m0l0k1j2j3k3l2m1m", '·' => "0h0i", '…' => "0d0e 3d3e 6d6e",
        '×' => "0f4j 0j4f", '≤' => "4k0h4e 0d4d", '≥' => "0k4h0e 0d4d",
        '√' => "0h1h2d4m7m", 'τ' => "0j4j 2j2e3d", 'κ' => "0d0j 4j0g4d",
        'ä' => "5i3j2j0h0f2d3d5f 5j5d 1l1m 4l4m", 'ö' => "2d0f0h2j3j5h5f3d2d 1l1m 4l4m",
        'ü' => "0j0f2d3d5f 5j5d 1l1m 4l4m",
        c if c.is_whitespace() => "",
        _ => "0d0m5m5d0d",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printable_ascii_has_glyphs_of_its_own_inside_the_line() {
        let missing = glyph('\u{1f980}');
        for c in '!'..='~' {
            assert_ne!(glyph(c), missing, "{c}");
            for word in glyph(c).split(' ') {
                assert!(word.len() >= 4 && word.len() % 2 == 0, "{c}: {word}");
                for (x, y) in places(word) {
                    assert!((0.0..=8.0 * STEP).contains(&x) && (-3.0 * STEP..=10.0 * STEP).contains(&y), "{c}: {word}");
                }
            }
        }
    }
}
