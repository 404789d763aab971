//! The names in use, each once, in order. The index of a name chooses its colour.

use crate::ids::{NameId, Names};
use std::collections::BTreeSet;

/// The names, each once, in order.
pub fn distinct(names: impl Iterator<Item = NameId>) -> Vec<NameId> {
    names.collect::<BTreeSet<_>>().into_iter().collect()
}

/// The index of a name among those in use.
pub fn rank(used: &[NameId], name: NameId) -> usize {
    used.partition_point(|&n| n < name)
}

/// The names as text.
pub fn entries(used: &[NameId], names: &Names) -> Vec<String> {
    used.iter().map(|&n| names.text(n).to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_of_names_rank_in_order() {
        let used = distinct([NameId(4), NameId(1), NameId(4)].into_iter());
        assert_eq!(used.iter().map(|&n| rank(&used, n)).collect::<Vec<_>>(), [0, 1]);
    }
}
