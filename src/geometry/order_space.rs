//! The Hilbert order of points in space.

/// Bits of a place along each axis.
const BITS: u32 = 20;

/// The places of the points, along a Hilbert curve through their bounding box.
pub fn hilbert(points: &[[f64; 3]]) -> Vec<u32> {
    let least = |k: usize| points.iter().fold(f64::INFINITY, |m, p| m.min(p[k]));
    let largest = |k: usize| points.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p[k]));
    let low = [0, 1, 2].map(least);
    let width = [0, 1, 2].map(|k| largest(k) - low[k]).into_iter().fold(0.0, f64::max);
    let cells = f64::from((1u32 << BITS) - 1);
    let factor = if width > 0.0 { cells / width } else { 0.0 };
    let key = |p: &[f64; 3]| hilbert_key([0, 1, 2].map(|k| ((p[k] - low[k]) * factor) as u32));
    let mut keyed: Vec<(u64, u32)> = points.iter().map(key).zip(0..).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, place)| place).collect()
}

/// The place of a cell along the curve. J. Skilling, "Programming the Hilbert curve" (2004): Gray codes of the bits, from the
/// highest down, with the axes exchanged or turned as each octant asks.
fn hilbert_key(mut x: [u32; 3]) -> u64 {
    for bit in (1..BITS).rev().map(|k| 1 << k) {
        let below = bit - 1;
        for k in 0..3 {
            if x[k] & bit != 0 {
                x[0] ^= below;
            } else {
                let turned = (x[0] ^ x[k]) & below;
                x[0] ^= turned;
                x[k] ^= turned;
            }
        }
    }
    x[1] ^= x[0];
    x[2] ^= x[1];
    let parity = (1..BITS).rev().filter(|k| x[2] >> k & 1 == 1).fold(0, |t, k| t ^ ((1 << k) - 1));
    let x = x.map(|x| x ^ parity);
    (0..BITS).rev().fold(0, |key, k| x.iter().fold(key, |key, x| key << 1 | u64::from(x >> k & 1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_along_the_curve_are_neighbours_in_space() {
        let cells: Vec<[u32; 3]> = (0..512).map(|i| [i % 8, i / 8 % 8, i / 64].map(|x| x << (BITS - 3))).collect();
        let mut keyed: Vec<(u64, [u32; 3])> = cells.iter().map(|&c| (hilbert_key(c), c)).collect();
        keyed.sort_unstable();
        for pair in keyed.windows(2) {
            let steps: u32 = (0..3).map(|k| pair[0].1[k].abs_diff(pair[1].1[k]) >> (BITS - 3)).sum();
            assert_eq!(steps, 1, "{pair:?}");
        }
    }
}
