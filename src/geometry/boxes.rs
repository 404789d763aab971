//! A bounding box hierarchy: which items lie near each other.
//!
//! It is built once over any number of boxes, in O(n log n), by halving along the longer side. It finds the boxes that
//! meet a box, and the item nearest to a point, in about O(log n). The depth is O(log n) for every input.
//!
//! ```text
//!   ┌──────────────────────────┐     order  a b c d e f
//!   │ ┌──────┐  ┌────────────┐ │     nodes  0: whole, 1: a b c, 2: d e f
//!   │ │ a  b │  │  d    e    │ │
//!   │ │  c   │  │     f      │ │     The items of a node are halved along the longer side of its bounds.
//!   │ └──────┘  └────────────┘ │     The left child is the next node, `first` the right child.
//!   └──────────────────────────┘
//! ```

use super::{Point, Rect};
use std::convert::Infallible;

/// The size of the stack: depth first, one sibling waits a level, and halving 2^32 items takes 32 levels.
const WAITING: usize = 34;

/// The largest number of items in a leaf: below it, a scan is quicker than a descent.
const LEAF: usize = 4;

struct Node {
    bounds: Rect,
    /// In a leaf (`len > 0`) its items are `first..first + len` of the order. Else this is the right child; the left
    /// child is the next node.
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
    /// A hierarchy over boxes, which are numbered by their place in the sequence.
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

    /// The number of boxes.
    pub fn len(&self) -> usize {
        self.boxes.len()
    }

    /// Whether there is no box.
    pub fn is_empty(&self) -> bool {
        self.boxes.is_empty()
    }

    /// The boxes, in the order in which they were given.
    pub fn boxes(&self) -> &[Rect] {
        &self.boxes
    }

    /// Calls `each` with every item whose box meets `query`, borders included, until `each` returns `false`.
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
            for &item in self.items(node) {
                if touches(self.boxes[item as usize], query) && !each(item as usize) {
                    return;
                }
            }
        }
    }

    /// The item with the smallest `distance` below `bound`, and that distance. `distance(i, bound)` is called only for
    /// items whose boxes are nearer than the best so far (`bound`); any result above `bound` means that the item is not
    /// nearer.
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
                // The nearer child is pushed last, so it is visited first.
                let (far, near) = if dl <= dr { ((right, dr), (left, dl)) } else { ((left, dl), (right, dr)) };
                (stack[waiting], stack[waiting + 1]) = (far, near);
                waiting += 2;
                continue;
            }
            for &item in self.items(node) {
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

    /// Calls `each` with every pair of items whose boxes meet and that have no common label, the smaller first, in a
    /// fixed order. Groups whose items all have one label are skipped at once: n segments around a point, labelled by
    /// their ends, cost n log n, not n²/2.
    pub fn pairs(&self, labels: impl Fn(usize) -> Labels, mut each: impl FnMut(usize, usize)) {
        let Ok(()) = self.try_pairs(labels, |i, j| {
            each(i, j);
            Ok::<(), Infallible>(())
        });
    }

    /// [`BoxHierarchy::pairs`] until the first error of `each`.
    ///
    /// # Errors
    /// The first error of `each`, after which no further pair is visited.
    pub fn try_pairs<E>(
        &self,
        labels: impl Fn(usize) -> Labels,
        mut each: impl FnMut(usize, usize) -> Result<(), E>,
    ) -> Result<(), E> {
        let labelled = Labelled::new(self, labels);
        labelled.try_pairs(&labelled, true, |i, j| each(i.min(j), i.max(j)))
    }

    /// The same for every pair of an item here and an item of another hierarchy.
    ///
    /// # Errors
    /// The first error of `each`, after which no further pair is visited.
    pub fn try_pairs_with<E>(
        &self,
        labels: impl Fn(usize) -> Labels,
        other: &Self,
        of_other: impl Fn(usize) -> Labels,
        each: impl FnMut(usize, usize) -> Result<(), E>,
    ) -> Result<(), E> {
        Labelled::new(self, labels).try_pairs(&Labelled::new(other, of_other), false, each)
    }

    /// The items of a leaf; empty for inner nodes.
    fn items(&self, node: &Node) -> &[u32] {
        &self.order[node.first as usize..][..node.len as usize]
    }
}

/// The labels of an item in [`BoxHierarchy::pairs`]: items with a common label make no pair.
pub type Labels = [Option<u32>; 2];

fn share(a: Labels, b: Labels) -> bool {
    a.iter().any(|label| label.is_some() && b.contains(label))
}

/// A hierarchy with the labels of its items.
struct Labelled<'a> {
    tree: &'a BoxHierarchy,
    labels: Vec<Labels>,
    /// By node: the labels that all items below it have.
    common: Vec<Labels>,
}

impl<'a> Labelled<'a> {
    fn new(tree: &'a BoxHierarchy, labels: impl Fn(usize) -> Labels) -> Self {
        let labels: Vec<Labels> = (0..tree.boxes.len()).map(labels).collect();
        let both = |a: Labels, b: Labels| a.map(|label| label.filter(|_| b.contains(&label)));
        let mut common = vec![Labels::default(); tree.nodes.len()];
        for (here, node) in tree.nodes.iter().enumerate().rev() {
            let of_items = tree.items(node).iter().map(|&i| labels[i as usize]).reduce(both);
            common[here] = of_items.unwrap_or_else(|| both(common[here + 1], common[node.first as usize]));
        }
        Self { tree, labels, common }
    }

    /// Calls `each` with pairs of an item here and one of `other`. `same`: both are one hierarchy, and each pair is
    /// reported once.
    fn try_pairs<E>(
        &self,
        other: &Self,
        same: bool,
        mut each: impl FnMut(usize, usize) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut stack = match self.tree.is_empty() || other.tree.is_empty() {
            true => Vec::new(),
            false => vec![[0, 0]],
        };
        while let Some([a, b]) = stack.pop() {
            let (m, n) = (&self.tree.nodes[a], &other.tree.nodes[b]);
            if !touches(m.bounds, n.bounds) || share(self.common[a], other.common[b]) {
                continue;
            }
            let (of_m, of_n) = ([a + 1, m.first as usize], [b + 1, n.first as usize]);
            match (m.len > 0, n.len > 0) {
                (false, _) if same && a == b => {
                    stack.extend([[of_m[0], of_m[0]], [of_m[0], of_m[1]], [of_m[1], of_m[1]]]);
                }
                (true, true) => self.pairs_of_leaves(other, [m, n], same && a == b, &mut each)?,
                (leaf, other_leaf) if leaf || (!other_leaf && is_larger(n.bounds, m.bounds)) => {
                    stack.extend(of_n.map(|child| [a, child]));
                }
                _ => stack.extend(of_m.map(|child| [child, b])),
            }
        }
        Ok(())
    }

    fn pairs_of_leaves<E>(
        &self,
        other: &Self,
        [m, n]: [&Node; 2],
        same: bool,
        each: &mut impl FnMut(usize, usize) -> Result<(), E>,
    ) -> Result<(), E> {
        let second = other.tree.items(n);
        for (k, &i) in self.tree.items(m).iter().enumerate() {
            for &j in if same { &second[k + 1..] } else { second } {
                let (i, j) = (i as usize, j as usize);
                if touches(self.tree.boxes[i], other.tree.boxes[j]) && !share(self.labels[i], other.labels[j]) {
                    each(i, j)?;
                }
            }
        }
        Ok(())
    }
}

fn is_larger(a: Rect, b: Rect) -> bool {
    a.width() + a.height() > b.width() + b.height()
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
    fn pairs_agree_with_a_scan() {
        for n in [0, 1, 5, 300] {
            let boxes = some_boxes(n);
            let hierarchy = BoxHierarchy::new(boxes.clone());
            let few = |i: usize| [(i % 3 != 1).then_some(i as u32 % 7), (i % 5 != 1).then_some(i as u32 % 11)];
            let unlabelled = |_: usize| Labels::default();
            for labels in [&few as &dyn Fn(usize) -> Labels, &unlabelled] {
                let apart = |i: usize, j: usize| {
                    labels(i).iter().flatten().all(|label| labels(j).iter().flatten().all(|other| label != other))
                };
                let all = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
                let scan: Vec<_> = all.filter(|&(i, j)| touches(boxes[i], boxes[j]) && apart(i, j)).collect();
                let mut found = Vec::new();
                hierarchy.pairs(labels, |i, j| found.push((i, j)));
                found.sort_unstable();
                assert_eq!(found, scan);
            }
        }
    }

    #[test]
    fn pairs_of_two_hierarchies_agree_with_a_scan() {
        let (boxes, others) = (some_boxes(70), some_boxes(150).split_off(80));
        let labels = |i: usize| [Some(i as u32 % 5), None];
        let mut found = Vec::new();
        let (first, second) = (BoxHierarchy::new(boxes.clone()), BoxHierarchy::new(others.clone()));
        let Ok(()) = first.try_pairs_with(labels, &second, labels, |i, j| {
            found.push((i, j));
            Ok::<(), Infallible>(())
        });
        found.sort_unstable();
        let all = (0..70).flat_map(|i| (0..70).map(move |j| (i, j)));
        let scan: Vec<_> = all.filter(|&(i, j)| touches(boxes[i], others[j]) && i % 5 != j % 5).collect();
        assert_eq!(found, scan);
    }

    #[test]
    fn many_boxes_with_one_label_are_no_pairs_and_cost_little() {
        let hierarchy = BoxHierarchy::new(vec![Rect::new(0.0, 0.0, 1.0, 1.0); 200_000]);
        hierarchy.pairs(|i| [Some(i as u32 + 1), Some(0)], |i, j| panic!("{i} and {j} are a pair"));
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
