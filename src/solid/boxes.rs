//! A hierarchy of boxes in space: what lies near what.

use super::exact::Place;

/// A box: its least and its greatest corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Space {
    pub least: Place,
    pub greatest: Place,
}

/// Leaves hold at most this many items: below it, a scan is quicker than a descent.
const LEAF: usize = 4;

impl Space {
    /// The smallest box around some points; of none, a box that meets nothing.
    pub(super) fn around(points: impl IntoIterator<Item = Place>) -> Self {
        let nothing = Self { least: [f64::INFINITY; 3], greatest: [f64::NEG_INFINITY; 3] };
        points.into_iter().fold(nothing, |b, p| b.union(Self { least: p, greatest: p }))
    }

    fn union(self, other: Self) -> Self {
        Self {
            least: std::array::from_fn(|k| self.least[k].min(other.least[k])),
            greatest: std::array::from_fn(|k| self.greatest[k].max(other.greatest[k])),
        }
    }

    /// Whether two boxes meet, borders included.
    pub(super) fn meets(self, other: Self) -> bool {
        (0..3).all(|k| self.least[k] <= other.greatest[k] && other.least[k] <= self.greatest[k])
    }

    /// Whether it holds another box.
    pub(super) fn encloses(self, other: Self) -> bool {
        (0..3).all(|k| self.least[k] <= other.least[k] && other.greatest[k] <= self.greatest[k])
    }

    /// Its length along an axis.
    pub(super) fn side(self, axis: usize) -> f64 {
        self.greatest[axis] - self.least[axis]
    }
}

struct Node {
    bounds: Space,
    /// Items `first..first + len` of the order where `len > 0`; else the right child, the left one being the next node.
    first: u32,
    len: u32,
}

/// A hierarchy over boxes `0..n`. Its depth is O(log n) whatever the input.
pub(super) struct Hierarchy {
    boxes: Vec<Space>,
    order: Vec<u32>,
    nodes: Vec<Node>,
}

impl Hierarchy {
    pub(super) fn new(boxes: impl IntoIterator<Item = Space>) -> Self {
        let boxes: Vec<Space> = boxes.into_iter().collect();
        let mut hierarchy = Self { order: (0..boxes.len() as u32).collect(), nodes: Vec::new(), boxes };
        if !hierarchy.boxes.is_empty() {
            hierarchy.build(0, hierarchy.boxes.len());
        }
        hierarchy
    }

    fn build(&mut self, first: usize, end: usize) {
        let boxes = &self.boxes;
        let bounds = Space::around([]);
        let bounds = self.order[first..end].iter().fold(bounds, |b, &i| b.union(boxes[i as usize]));
        let here = self.nodes.len();
        self.nodes.push(Node { bounds, first: first as u32, len: (end - first) as u32 });
        if end - first <= LEAF {
            return;
        }
        let middle = (first + end) / 2;
        let axis = (0..3).max_by(|&i, &j| bounds.side(i).total_cmp(&bounds.side(j))).unwrap_or(0);
        let key = |i: u32| boxes[i as usize].least[axis] + boxes[i as usize].greatest[axis];
        self.order[first..end]
            .select_nth_unstable_by(middle - first, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
        self.build(first, middle);
        let right = self.nodes.len();
        self.build(middle, end);
        self.nodes[here].first = right as u32;
        self.nodes[here].len = 0;
    }

    /// The items whose boxes meet `query`, ascending.
    pub(super) fn meeting(&self, query: Space, found: &mut Vec<u32>) {
        found.clear();
        let mut stack: Vec<usize> = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(here) = stack.pop() {
            let node = &self.nodes[here];
            if !node.bounds.meets(query) {
                continue;
            }
            if node.len == 0 {
                stack.extend([here + 1, node.first as usize]);
                continue;
            }
            let items = &self.order[node.first as usize..][..node.len as usize];
            found.extend(items.iter().filter(|&&i| self.boxes[i as usize].meets(query)));
        }
        found.sort_unstable();
    }
}
