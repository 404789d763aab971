//! Lists by a number, made by counting.

use std::ops::Range;

/// Items by the group that they belong to, in their order.
pub struct Grouped {
    /// `items[start[g]..start[g + 1]]` are those of group `g`.
    start: Vec<u32>,
    items: Vec<u32>,
}

impl Grouped {
    /// The places of the items that have a group, and one below `groups`.
    pub fn by(groups: usize, group_of: impl Iterator<Item = Option<usize>> + Clone) -> Self {
        Self::of(groups, || (0u32..).zip(group_of.clone()).filter_map(|(i, g)| Some((g.filter(|&g| g < groups)?, i))))
    }

    /// Pairs of group and item, given twice in the same order: once to be counted. Groups must be below `groups`.
    pub fn of<I: Iterator<Item = (usize, u32)>>(groups: usize, pairs: impl Fn() -> I) -> Self {
        let mut start = vec![0u32; groups + 1];
        pairs().for_each(|(g, _)| start[g + 1] += 1);
        for g in 0..groups {
            start[g + 1] += start[g];
        }
        let mut free = start.clone();
        let mut items = vec![0; start[groups] as usize];
        for (g, item) in pairs() {
            items[free[g] as usize] = item;
            free[g] += 1;
        }
        Self { start, items }
    }

    /// The items of a group.
    pub fn of_group(&self, group: usize) -> &[u32] {
        &self.items[self.range(group)]
    }

    fn range(&self, group: usize) -> Range<usize> {
        self.start[group] as usize..self.start[group + 1] as usize
    }
}
