//! The order in which points are inserted: rounds that double in size, each along a Hilbert curve (Amenta, Choi & Rote 2003, BRIO),
//! so that a walk from the last point to the next is short and the expected cost of a cavity is constant.

use super::{Point, Rect, bounds_of};

/// Levels of the Hilbert curve: 2^16 cells a side tell 10⁷ points apart well enough.
const LEVELS: u32 = 16;

/// Indices of `points` in a good order for insertion. Deterministic: the rounds are drawn by a hash of the place along the curve.
pub fn brio(points: &[Point]) -> Vec<u32> {
    let curve = hilbert(points);
    rounds(curve.len()).into_iter().map(|place| curve[place as usize]).collect()
}

/// Indices of `points` along the Hilbert curve of their box.
pub fn hilbert(points: &[Point]) -> Vec<u32> {
    let Some(bounds) = bounds_of(points.iter().copied()) else { return Vec::new() };
    let mut keyed: Vec<(u32, u32)> =
        points.iter().enumerate().map(|(i, &p)| (hilbert_key(p, bounds), i as u32)).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, i)| i).collect()
}

/// Places 0..n in rounds, each in the direction opposite to that of the round before, so that it starts where that one ended.
pub fn rounds(n: usize) -> Vec<u32> {
    let mut order: Vec<u32> = (0..n as u32).collect();
    order.sort_by_key(|&i| round_of(i));
    order.chunk_by_mut(|&i, &j| round_of(i) == round_of(j)).step_by(2).for_each(<[u32]>::reverse);
    order
}

/// The round of a point: the last holds half of all, the one before a quarter, and so on.
fn round_of(index: u32) -> u32 {
    // Finalizer of MurmurHash3 (Appleby): every bit of the index stirs every bit of the result.
    let mut h = index;
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    h ^= h >> 16;
    32 - h.trailing_zeros().min(31)
}

/// Place of a point along the Hilbert curve of a box, in 0..2^32.
pub fn hilbert_key(p: Point, bounds: Rect) -> u32 {
    let side = bounds.width().max(bounds.height());
    let cells = f64::from(1u32 << LEVELS);
    let cell =
        |v: f64, low: f64| if side > 0.0 { (((v - low) / side * cells) as u32).min((1 << LEVELS) - 1) } else { 0 };
    let (mut x, mut y) = (cell(p.x, bounds.x0), cell(p.y, bounds.y0));
    let mut key = 0u32;
    let mut s = 1u32 << (LEVELS - 1);
    while s > 0 {
        let (rx, ry) = (u32::from(x & s > 0), u32::from(y & s > 0));
        key = (key << 2) | ((3 * rx) ^ ry);
        // Turn the quadrant so that the curve enters and leaves it at the right corners.
        if ry == 0 {
            if rx == 1 {
                x = !x;
                y = !y;
            }
            std::mem::swap(&mut x, &mut y);
        }
        s >>= 1;
    }
    key
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_each_cell_next_to_the_last() {
        let n = 16;
        let bounds = Rect::new(0.0, 0.0, n as f64, n as f64);
        let mut cells: Vec<(u32, i32, i32)> = (0..n)
            .flat_map(|x| (0..n).map(move |y| (x, y)))
            .map(|(x, y)| (hilbert_key(Point::new(x as f64 + 0.5, y as f64 + 0.5), bounds), x, y))
            .collect();
        cells.sort_unstable();
        for pair in cells.windows(2) {
            assert_eq!((pair[0].1 - pair[1].1).abs() + (pair[0].2 - pair[1].2).abs(), 1, "{pair:?}");
        }
    }

    #[test]
    fn every_index_comes_once_and_the_last_round_is_half() {
        let points: Vec<Point> = (0..1000).map(|i| Point::new((i % 37) as f64, (i % 53) as f64)).collect();
        let mut order = brio(&points);
        assert_eq!(order.len(), 1000);
        let last = (0..1000).filter(|&i| round_of(i) == 32).count();
        assert!((400..600).contains(&last), "{last}");
        order.sort_unstable();
        assert!(order.iter().enumerate().all(|(i, &v)| i == v as usize));
    }

    #[test]
    fn no_points_one_point_and_equal_points_are_ordered() {
        assert!(brio(&[]).is_empty());
        assert_eq!(brio(&[Point::ZERO]), [0]);
        assert_eq!(brio(&[Point::ZERO; 5]).len(), 5);
    }
}
