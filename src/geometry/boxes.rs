//! A hierarchy of boxes: what lies near what.
//!
//! Built once over any number of boxes, in O(n log n), by halving along the longer side; answers "which boxes meet this one" and
//! "what is nearest to this point" in about O(log n). Recursion depth is O(log n) whatever the input.

use super::{Point, Rect};
use std::convert::Infallible;

/// Depth first, one sibling waits a level; halving 2^32 items takes 32 levels.
const WAITING: usize = 34;

/// Leaves hold at most this many items: below it, a scan is quicker than a descent.
const LEAF: usize = 4;

struct Node {
    bounds: Rect,
    /// Items `first..first + len` of the order where `len > 0`; else the right child, the left one being the next node.
    first: u32,
    len: u32,
}

/// A hierarchy over boxes `0..n`.
pub struct BoxHierarchy {
    boxes: Vec<Rect>,
    order: Vec<u32>,
    nodes: Vec<Node>,
}

impl BoxHierarchy {
    /// A hierarchy over boxes, known by their place in the sequence.
    pub fn new(boxes: impl IntoIterator<Item = Rect>) -> Self {
        let boxes: Vec<Rect> = boxes.into_iter().collect();
        let mut hierarchy = Self { order: (0..boxes.len() as u32).collect(), nodes: Vec::new(), boxes };
        if !hierarchy.boxes.is_empty() {
            hierarchy.build(0, hierarchy.boxes.len());
        }
        hierarchy
    }

    fn build(&mut self, first: usize, end: usize) {
        let boxes = &self.boxes;
        let bounds = self.order[first..end].iter().map(|&i| boxes[i as usize]).reduce(|a, b| a.union(b)).unwrap();
        let here = self.nodes.len();
        self.nodes.push(Node { bounds, first: first as u32, len: (end - first) as u32 });
        if end - first <= LEAF {
            return;
        }
        let middle = (first + end) / 2;
        let wide = bounds.width() >= bounds.height();
        let key = |i: u32| {
            let c = boxes[i as usize].center();
            if wide { c.x } else { c.y }
        };
        self.order[first..end]
            .select_nth_unstable_by(middle - first, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
        self.build(first, middle);
        let right = self.nodes.len();
        self.build(middle, end);
        self.nodes[here].first = right as u32;
        self.nodes[here].len = 0;
    }

    pub fn len(&self) -> usize {
        self.boxes.len()
    }

    pub fn is_empty(&self) -> bool {
        self.boxes.is_empty()
    }

    /// Calls `each` with every item whose box meets `query`, borders included; stops when `each` says so (`false`).
    pub fn meeting(&self, query: Rect, mut each: impl FnMut(usize) -> bool) {
        let mut stack = [0u32; WAITING];
        let mut waiting = usize::from(!self.nodes.is_empty());
        while waiting > 0 {
            waiting -= 1;
            let here = stack[waiting];
            let node = &self.nodes[here as usize];
            if !touches(node.bounds, query) {
                continue;
            }
            if node.len == 0 {
                (stack[waiting], stack[waiting + 1]) = (node.first, here + 1);
                waiting += 2;
                continue;
            }
            for &item in &self.order[node.first as usize..][..node.len as usize] {
                if touches(self.boxes[item as usize], query) && !each(item as usize) {
                    return;
                }
            }
        }
    }

    /// The item at the smallest `distance`, below `bound`, and that distance. `distance(i, bound)` is asked only of items whose boxes
    /// are nearer than the best so far (`bound`); it may answer anything larger than `bound` for "no nearer".
    pub fn nearest(&self, p: Point, bound: f64, mut distance: impl FnMut(usize, f64) -> f64) -> Option<(usize, f64)> {
        let (mut best, mut nearest) = (bound, None);
        let mut stack = [(0u32, 0.0); WAITING];
        let mut waiting = usize::from(!self.nodes.is_empty());
        while waiting > 0 {
            waiting -= 1;
            let (here, away) = stack[waiting];
            if away > best {
                continue;
            }
            let node = &self.nodes[here as usize];
            if node.len == 0 {
                let (left, right) = (here + 1, node.first);
                let to = |n: u32| distance_to_box(p, self.nodes[n as usize].bounds);
                let (dl, dr) = (to(left), to(right));
                // The nearer child is pushed last and so looked at first.
                let (far, near) = if dl <= dr { ((right, dr), (left, dl)) } else { ((left, dl), (right, dr)) };
                (stack[waiting], stack[waiting + 1]) = (far, near);
                waiting += 2;
                continue;
            }
            for &item in &self.order[node.first as usize..][..node.len as usize] {
                if distance_to_box(p, self.boxes[item as usize]) <= best {
                    let d = distance(item as usize, best);
                    let wins = d < best || (d == best && nearest.is_some_and(|n| (item as usize) < n));
                    if wins {
                        (best, nearest) = (d, Some(item as usize));
                    }
                }
            }
        }
        nearest.map(|item| (item, best))
    }

    /// Every pair of items whose boxes meet, the smaller first, in ascending order of the first. There may be as many as the square of
    /// the items: they are never all kept.
    pub fn pairs(&self, mut each: impl FnMut(usize, usize)) {
        let Ok(()) = self.try_pairs(|i, j| {
            each(i, j);
            Ok::<(), Infallible>(())
        });
    }

    /// [`BoxHierarchy::pairs`] until the first error of `each`.
    pub fn try_pairs<E>(&self, mut each: impl FnMut(usize, usize) -> Result<(), E>) -> Result<(), E> {
        let mut partners = Vec::new();
        for i in 0..self.boxes.len() {
            partners.clear();
            self.meeting(self.boxes[i], |j| {
                if j > i {
                    partners.push(j);
                }
                true
            });
            partners.sort_unstable();
            partners.iter().try_for_each(|&j| each(i, j))?;
        }
        Ok(())
    }
}

fn touches(a: Rect, b: Rect) -> bool {
    a.x0 <= b.x1 && b.x0 <= a.x1 && a.y0 <= b.y1 && b.y0 <= a.y1
}

/// Distance from a point to a box, 0 inside.
pub fn distance_to_box(p: Point, b: Rect) -> f64 {
    let dx = (b.x0 - p.x).max(p.x - b.x1).max(0.0);
    let dy = (b.y0 - p.y).max(p.y - b.y1).max(0.0);
    (dx * dx + dy * dy).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fixed sequence of numbers in 0..1.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 1u64;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / (1u64 << 24) as f64
        }
    }

    fn some_boxes(n: usize) -> Vec<Rect> {
        let mut next = numbers();
        (0..n)
            .map(|_| {
                let (x, y) = (next(), next());
                Rect::new(x, y, x + 0.1 * next(), y + 0.1 * next())
            })
            .collect()
    }

    #[test]
    fn meeting_agrees_with_a_scan() {
        for n in [0, 1, 3, 200] {
            let boxes = some_boxes(n);
            let hierarchy = BoxHierarchy::new(boxes.clone());
            for query in some_boxes(50) {
                let mut found = Vec::new();
                hierarchy.meeting(query, |i| {
                    found.push(i);
                    true
                });
                found.sort_unstable();
                let scan: Vec<usize> = (0..n).filter(|&i| touches(boxes[i], query)).collect();
                assert_eq!(found, scan);
            }
        }
    }

    #[test]
    fn nearest_agrees_with_a_scan() {
        let boxes = some_boxes(300);
        let hierarchy = BoxHierarchy::new(boxes.clone());
        let mut next = numbers();
        for _ in 0..100 {
            let p = Point::new(next(), next());
            let (item, d) = hierarchy.nearest(p, f64::INFINITY, |i, _| boxes[i].center().distance(p)).unwrap();
            let scan = boxes.iter().map(|b| b.center().distance(p)).fold(f64::INFINITY, f64::min);
            assert_eq!(d, scan);
            assert_eq!(boxes[item].center().distance(p), scan);
        }
        assert!(hierarchy.nearest(Point::ZERO, -1.0, |_, _| 0.0).is_none());
    }

    #[test]
    fn equal_boxes_do_not_recurse_without_end() {
        let hierarchy = BoxHierarchy::new(vec![Rect::new(0.0, 0.0, 0.0, 0.0); 100_000]);
        let mut count = 0;
        hierarchy.meeting(Rect::new(0.0, 0.0, 0.0, 0.0), |_| {
            count += 1;
            true
        });
        assert_eq!(count, 100_000);
    }
}
