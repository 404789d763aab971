//! The order in which points are inserted: rounds that grow eightfold, each along a Hilbert curve (Amenta, Choi & Rote
//! 2003, BRIO). So a walk from the last point to the next is short, and the expected size of a cavity is constant.
//!
//! ```text
//!   ┌──┐  ┌──┐       The curve on two levels, 4 × 4 cells, from ● to ▶. A quadrant's digits of x and y give two bits
//!   │  └──┘  │       of the key: 0 lower left, 1 upper left, 2 upper right, 3 lower right. In the lower left quadrant
//!   └──┐  ┌──┘       the axes are exchanged, in the lower right one also both reversed.
//!   ●──┘  └──▶
//! ```

use super::{Point, Rect, bounds_of};

/// Levels of the Hilbert curve: 2^24 cells separate 10⁷ points well enough. A cell with many points gets its own curve.
const LEVELS: u32 = 12;

/// Levels in one step of the curve's automaton.
const STRIDE: u32 = 4;

/// A cell with more points than this is ordered along its own curve. Fewer points lie within a short walk of each
/// other.
const CROWD: usize = 16;

/// Fewer points than this are sorted by comparison: clearing the counts of a radix sort would cost more.
const FEW: usize = 2048;

/// The indices of `points` along the Hilbert curve of their box; in a cell with many points, along the curve of their
/// own box. Equal points come in the order of their indices.
pub fn hilbert(points: &[Point]) -> Vec<u32> {
    let mut keyed = along_curve(points, 0..points.len() as u32);
    // Each curve divides a box by 2^12 along each axis, so points of very different magnitudes are separated after a
    // few curves.
    let mut crowds: Vec<(usize, usize)> = crowded(&keyed, 0).collect();
    while let Some((first, end)) = crowds.pop() {
        let indices: Vec<u32> = keyed[first..end].iter().map(|&k| k as u32).collect();
        let finer = along_curve(points, indices.into_iter());
        // If all lie in a single cell, all are equal: there is no finer order.
        if finer[0] >> 32 != finer[finer.len() - 1] >> 32 {
            crowds.extend(crowded(&finer, first));
        }
        keyed[first..end].copy_from_slice(&finer);
    }
    keyed.into_iter().map(|k| k as u32).collect()
}

/// Points sorted along the Hilbert curve of their box, as key · 2^32 + index.
fn along_curve(points: &[Point], indices: impl Iterator<Item = u32> + Clone) -> Vec<u64> {
    let Some(bounds) = bounds_of(indices.clone().map(|i| points[i as usize])) else { return Vec::new() };
    let key = |i: u32| u64::from(hilbert_key(points[i as usize], bounds)) << 32 | u64::from(i);
    let mut keyed: Vec<u64> = indices.map(key).collect();
    if keyed.len() < FEW {
        keyed.sort_unstable();
    } else {
        sort_by_key(&mut keyed);
    }
    keyed
}

/// Runs of more than [`CROWD`] equal keys, as places `from + first..from + end`.
fn crowded(keyed: &[u64], from: usize) -> impl Iterator<Item = (usize, usize)> {
    let mut end = from;
    keyed.chunk_by(|a, b| a >> 32 == b >> 32).filter_map(move |run| {
        end += run.len();
        (run.len() > CROWD).then_some((end - run.len(), end))
    })
}

/// Sorts by the key, bits 32 to 55, and keeps the order of equal keys: a radix sort in two passes of twelve bits, the
/// lower first.
fn sort_by_key(items: &mut Vec<u64>) {
    const BITS: u32 = LEVELS;
    let mut other = vec![0; items.len()];
    for pass in 0..2 {
        let digit = |item: u64| (item >> (32 + pass * BITS)) as usize & ((1 << BITS) - 1);
        let mut places = vec![0u32; 1 << BITS];
        items.iter().for_each(|&item| places[digit(item)] += 1);
        let mut sum = 0;
        for place in &mut places {
            sum += std::mem::replace(place, sum);
        }
        for &item in items.iter() {
            let place = &mut places[digit(item)];
            other[*place as usize] = item;
            *place += 1;
        }
        std::mem::swap(items, &mut other);
    }
}

/// The number of the last round; a hash of 32 zeros belongs to round 0.
const LAST: u32 = 10;

/// The places 0..n, in rounds. Each round runs opposite to the one before, so it starts where that one ended.
pub fn rounds(n: usize) -> Vec<u32> {
    let mut ends = [0usize; LAST as usize + 1];
    (0..n as u32).for_each(|i| ends[round_of(i) as usize] += 1);
    let mut sum = 0;
    for end in &mut ends {
        sum += *end;
        *end = sum;
    }
    let mut order = vec![0; n];
    for i in (0..n as u32).rev() {
        let end = &mut ends[round_of(i) as usize];
        *end -= 1;
        order[*end] = i;
    }
    // At this point each end is the beginning of its round.
    for (round, &first) in ends.iter().enumerate().skip(1).step_by(2) {
        let end = ends.get(round + 1).copied().unwrap_or(n);
        order[first..end].reverse();
    }
    order
}

/// The round of a place: the last, [`LAST`], has 7/8 of all places, the one before 7/64, and so on. Measured: rounds
/// that double, as in the paper, take 15 % longer (longer walks); rounds that grow by 16 or 32 are not faster (larger
/// cavities).
fn round_of(place: u32) -> u32 {
    // The finalizer of MurmurHash3 (Appleby): every bit of the index affects every bit of the result.
    let mut h = place;
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    h ^= h >> 16;
    LAST - h.trailing_zeros() / 3
}

/// The place of a point along the Hilbert curve of a box, in 0..2^24.
pub fn hilbert_key(p: Point, bounds: Rect) -> u32 {
    let side = bounds.width().max(bounds.height());
    let cells = f64::from(1u32 << LEVELS);
    // The conversion saturates, so a quotient that is not a number or too large (a tiny box) still gives some cell.
    let cell = |v: f64, low: f64| (((v - low) / side * cells) as u32).min((1 << LEVELS) - 1);
    let (x, y) = (cell(p.x, bounds.x0), cell(p.y, bounds.y0));
    let (mut key, mut turn) = (0u32, 0);
    for level in (0..LEVELS).step_by(STRIDE as usize).map(|done| LEVELS - STRIDE - done) {
        let digits = |v: u32| (v >> level) as usize & ((1 << STRIDE) - 1);
        let step = STEPS[turn][digits(x)][digits(y)];
        key = (key << (2 * STRIDE)) | u32::from(step.0);
        turn = usize::from(step.1);
    }
    key
}

/// The automaton of the curve. Its state is the orientation in a quadrant: bit 0, axes exchanged; bit 1, both reversed.
/// By state and the next [`STRIDE`] digits of x and of y: the next `2 · STRIDE` digits of the key, and the next state.
static STEPS: [[[(u8, u8); 1 << STRIDE]; 1 << STRIDE]; 4] = steps();

const fn steps() -> [[[(u8, u8); 1 << STRIDE]; 1 << STRIDE]; 4] {
    let mut steps = [[[(0, 0); 1 << STRIDE]; 1 << STRIDE]; 4];
    let mut entry = 0;
    while entry < 4 << (2 * STRIDE) {
        let (turn, x, y) =
            (entry >> (2 * STRIDE), (entry >> STRIDE) & ((1 << STRIDE) - 1), entry & ((1 << STRIDE) - 1));
        let (mut key, mut now, mut level) = (0, turn, STRIDE);
        while level > 0 {
            level -= 1;
            let (bx, by) = ((x >> level) & 1, (y >> level) & 1);
            let (bx, by) = if now & 1 == 1 { (by, bx) } else { (bx, by) };
            let (rx, ry) = (bx ^ (now >> 1), by ^ (now >> 1));
            key = (key << 2) | ((3 * rx) ^ ry);
            // The lower quadrants are turned so that the curve is continuous between quadrants.
            if ry == 0 {
                now ^= 1 | (rx << 1);
            }
        }
        steps[turn][x][y] = (key as u8, now as u8);
        entry += 1;
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_each_cell_next_to_the_last() {
        let n = 64;
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

    /// The order of insertion, as the kernel puts it together.
    fn brio(points: &[Point]) -> Vec<u32> {
        let curve = hilbert(points);
        rounds(curve.len()).into_iter().map(|place| curve[place as usize]).collect()
    }

    #[test]
    fn every_index_comes_once_and_the_last_round_has_seven_eighths() {
        let points: Vec<Point> = (0..1000).map(|i| Point::new((i % 37) as f64, (i % 53) as f64)).collect();
        let mut order = brio(&points);
        assert_eq!(order.len(), 1000);
        let last = (0..1000).filter(|&i| round_of(i) == LAST).count();
        assert!((800..950).contains(&last), "{last}");
        order.sort_unstable();
        assert!(order.iter().enumerate().all(|(i, &v)| i == v as usize));
    }

    #[test]
    fn rounds_come_by_size_each_in_one_direction() {
        let order = rounds(5000);
        let mut last = None;
        for round in order.chunk_by(|&i, &j| round_of(i) == round_of(j)) {
            assert!(Some(round_of(round[0])) > last);
            last = Some(round_of(round[0]));
            assert!(round.is_sorted() || round.iter().rev().is_sorted());
        }
        let ends: Vec<(u32, u32)> =
            order.chunk_by(|&i, &j| round_of(i) == round_of(j)).map(|r| (r[0], r[r.len() - 1])).collect();
        let [.., (a, b), (c, d)] = ends[..] else { panic!("two rounds at least") };
        assert!((a < b) != (c < d), "the last round runs against the one before");
    }

    #[test]
    fn both_sorts_agree() {
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            state
        };
        let items: Vec<u64> = (0..5000u64).map(|i| (next() >> 52 << 32 << (i % 13)) | i).collect();
        let (mut radix, mut comparison) = (items.clone(), items);
        sort_by_key(&mut radix);
        comparison.sort_unstable();
        assert_eq!(radix, comparison);
    }

    #[test]
    fn a_crowd_is_ordered_as_well_as_a_field() {
        // The same field twice, once shrunk to far less than a cell beside a distant point.
        let field: Vec<Point> = (0..900).map(|i| Point::new((i * 7 % 30) as f64, (i / 30) as f64)).collect();
        let crowd = field.iter().map(|p| Point::new(p.x * 1e-9, p.y * 1e-9)).chain([Point::new(1e6, 1e6)]);
        let order = hilbert(&crowd.collect::<Vec<_>>());
        assert_eq!(order[..900], hilbert(&field));
        assert_eq!(order[900], 900);
    }

    #[test]
    fn no_points_one_point_and_equal_points_are_ordered() {
        assert!(brio(&[]).is_empty());
        assert_eq!(brio(&[Point::ZERO]), [0]);
        assert_eq!(brio(&[Point::ZERO; 5]).len(), 5);
        assert_eq!(hilbert(&[Point::new(3.0, 4.0); 5000]), (0..5000).collect::<Vec<u32>>());
    }
}
