//! What was repaired when a drawing was arranged, and where.

use std::collections::BTreeMap;

/// A repair, with its place and its size. The size is a length in units of the drawing: how far ends moved, how wide
/// the gap was between curves that became one, or how large the lost feature was; 0 where nothing moved.
#[derive(Clone, Debug, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct Repair {
    /// What was repaired.
    pub kind: RepairKind,
    /// The place, in the drawing's coordinates: [x, y].
    pub at: [f64; 2],
    /// A length in units of the drawing, at least 0; what it measures depends on the kind.
    pub size: f64,
    /// One sentence with the entities.
    pub what: String,
}

/// The kinds of repair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RepairKind {
    /// The whole drawing was welded within more than the default tolerance: its slivers would have taken too many
    /// vertices.
    ToleranceRaised,
    /// Ends within the tolerance became one vertex.
    Weld,
    /// An open gap was closed to the nearest free end.
    GapClosed,
    /// A curve was split where another crosses, touches or ends on it.
    Split,
    /// A curve met itself and was split there.
    SelfSplit,
    /// A cusp or tangent jump became a corner.
    Corner,
    /// A curve that another repeats was dropped.
    Duplicate,
    /// Overlapping stretches became one.
    Overlap,
    /// A curve no longer than the tolerance was dropped: its ends are one vertex.
    ZeroLength,
    /// A closed curve, or a loop of a curve, no wider than the tolerance became a point or a line.
    Collapsed,
    /// A stretch of an outline that a later shape of the picture covers was left out.
    Hidden,
    /// A hole or region point that lies in no bounded face, or a second one in the same face.
    Seed,
}

impl RepairKind {
    /// Its name in messages: singular and plural.
    pub fn words(self) -> [&'static str; 2] {
        match self {
            Self::ToleranceRaised => ["tolerance raised", "tolerances raised"],
            Self::Weld => ["weld", "welds"],
            Self::GapClosed => ["gap closed", "gaps closed"],
            Self::Split => ["split", "splits"],
            Self::SelfSplit => ["split of a curve with itself", "splits of curves with themselves"],
            Self::Corner => ["corner found", "corners found"],
            Self::Duplicate => ["duplicate dropped", "duplicates dropped"],
            Self::Overlap => ["overlap merged", "overlaps merged"],
            Self::Collapsed => ["feature within the tolerance lost", "features within the tolerance lost"],
            Self::ZeroLength => ["curve of no length dropped", "curves of no length dropped"],
            Self::Hidden => ["outline hidden in part", "outlines hidden in part"],
            Self::Seed => ["seed without a face", "seeds without a face"],
        }
    }
}

impl Repair {
    /// Multiplies place and size by a factor.
    pub(in crate::domain) fn scale(&mut self, factor: f64) {
        self.at = self.at.map(|x| x * factor);
        self.size *= factor;
    }
}

/// A grid of square cells, numbered from the origin. Places too far out for a number, as a drawn point may be, belong
/// to the last cell.
#[derive(Clone, Copy)]
pub(super) struct Cells {
    width: f64,
}

impl Cells {
    /// Cells as wide as a tolerance.
    pub fn as_wide_as(tolerance: f64) -> Self {
        Self { width: tolerance }
    }

    /// Cells four times as wide as a tolerance: wider than a repair moves anything.
    pub fn wider_than(tolerance: f64) -> Self {
        Self { width: 4.0 * tolerance }
    }

    /// The cell of a place.
    pub fn of(self, at: [f64; 2]) -> [i64; 2] {
        const LAST: f64 = (1u64 << 62) as f64;
        at.map(|x| (x / self.width).floor().clamp(-LAST, LAST) as i64)
    }

    /// The cell of a place and the eight cells around it.
    pub fn around(self, at: [f64; 2]) -> impl Iterator<Item = [i64; 2]> {
        let [i, j] = self.of(at);
        (-1..=1).flat_map(move |di| (-1..=1).map(move |dj| [i + di, j + dj]))
    }
}

/// The number of repairs of each kind in each cell.
pub(super) struct Places {
    cells: Cells,
    counts: BTreeMap<(RepairKind, [i64; 2]), usize>,
}

impl Places {
    /// Counts repairs by kind and cell.
    pub fn of(repairs: &[Repair], cells: Cells) -> Self {
        let mut counts = BTreeMap::new();
        repairs.iter().for_each(|repair| *counts.entry((repair.kind, cells.of(repair.at))).or_default() += 1);
        Self { cells, counts }
    }

    /// Whether a repair of the same kind is left in the same cell or the eight around it; if so, takes one away.
    pub fn take(&mut self, repair: &Repair) -> bool {
        for cell in self.cells.around(repair.at) {
            if let Some(count) = self.counts.get_mut(&(repair.kind, cell)).filter(|count| **count > 0) {
                *count -= 1;
                return true;
            }
        }
        false
    }
}
