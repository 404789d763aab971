//! Outlines that do not quite close: rings of chains whose free ends are nearest to each other, with gaps that are
//! short compared with the chains.
//!
//! ```text
//!    ┌──────────┐       Each free end is linked with its nearest one where the gap is below a twentieth of both
//!    │          │       chains. A link between places that are already connected closes a ring: the way from one end
//!    └─────── ──┘       to the other, along edges and earlier links. A ring hardly wider than its gaps is a pair of
//!           gap         parallel lines, and no outline.
//! ```
//!
//! A free end without such a link may stop short of the inside of another open line, which goes on beyond that point.
//! It is linked with the nearest point of the line, under the same limits.

use super::arrangement::Arrangement;
use super::ends::{FreeEnd, Gap, Owner, Short, nearest_ends};
use super::error::ArrangeError;
use crate::geometry::{Point, extent};
use crate::ids::{CurveId, Forest, Id, PointId};
use std::collections::{BTreeSet, VecDeque};

/// An outline does not quite close where each gap is below this part of the shorter chain at it.
const MISSED: f64 = 1.0 / 20.0;

/// A ring is more than this many times as wide as its widest gap.
const WIDE: f64 = 2.0;

/// The budget of search steps for all rings together: some seconds.
const STEPS_MAX: usize = 1 << 24;

/// The largest number of gaps that a message lists.
const LISTED: usize = 4;

/// Lengths below this are written with an exponent.
const PLAIN: f64 = 1e-4;

/// What connects one place of a ring with the next.
#[derive(Clone, Copy)]
enum Via {
    Edge(CurveId),
    OffPlane(usize),
    Gap(Gap),
    /// From a free end to the inside of an open line.
    Short(Short),
    /// A line between two of its parameters: its ends, and the feet of free ends that stop short of it.
    Part(CurveId, [f64; 2]),
}

/// A closed way of chains and of the gaps between them.
struct Ring {
    gaps: Vec<Gap>,
    shorts: Vec<Short>,
    off_plane: BTreeSet<usize>,
}

/// The graph in which rings are searched. Its places are numbered: the nodes, then both ends of each entity that leaves
/// the plane, then the feet of free ends that stop short of lines.
struct Ways<'n, 'a> {
    arrangement: &'n Arrangement<'a>,
    ends: &'n [FreeEnd],
    shorts: &'n [Short],
    from: Vec<Vec<(usize, Via)>>,
    steps_left: usize,
    /// By place: the search that reached it last, and the place and connection from which it did.
    reached: Vec<(usize, usize, Via)>,
    searches: usize,
}

impl<'n, 'a> Ways<'n, 'a> {
    fn new(arrangement: &'n Arrangement<'a>, ends: &'n [FreeEnd], shorts: &'n [Short]) -> Self {
        let count = arrangement.nodes.len() + 2 * arrangement.drawing.off_plane.len() + shorts.len();
        let nothing = (0, 0, Via::OffPlane(0));
        let mut ways = Self {
            arrangement,
            ends,
            shorts,
            from: vec![Vec::new(); count],
            steps_left: STEPS_MAX,
            reached: vec![nothing; count],
            searches: 0,
        };
        for (id, edge) in arrangement.edges.enumerate() {
            ways.add(edge.ends.map(Id::index), Via::Edge(id));
        }
        for k in 0..arrangement.drawing.off_plane.len() {
            let ends = [0, 1].map(|end| ways.place_of(Owner::OffPlane(k, end)));
            ways.add(ends, Via::OffPlane(k));
        }
        ways.add_parts();
        ways
    }

    /// Adds the lines that ends stop short of, in parts from one foot to the next.
    fn add_parts(&mut self) {
        let mut feet: Vec<(CurveId, f64, usize)> =
            self.shorts.iter().enumerate().map(|(k, short)| (short.onto, short.t, self.foot(k))).collect();
        feet.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for feet in feet.chunk_by(|a, b| a.0 == b.0) {
            let onto = feet[0].0;
            let [start, end] = self.arrangement.edges[onto].ends.map(Id::index);
            let stations =
                [(0.0, start)].into_iter().chain(feet.iter().map(|&(_, t, foot)| (t, foot))).chain([(1.0, end)]);
            let stations: Vec<(f64, usize)> = stations.collect();
            for pair in stations.windows(2) {
                self.add([pair[0].1, pair[1].1], Via::Part(onto, [pair[0].0, pair[1].0]));
            }
        }
    }

    fn place_of(&self, owner: Owner) -> usize {
        match owner {
            Owner::Node(node) => node.index(),
            Owner::OffPlane(k, end) => self.arrangement.nodes.len() + 2 * k + end,
        }
    }

    /// The place of the foot of short `k`.
    fn foot(&self, k: usize) -> usize {
        self.from.len() - self.shorts.len() + k
    }

    fn at(&self, place: usize) -> Point {
        match (place.checked_sub(self.arrangement.nodes.len()), place.checked_sub(self.foot(0))) {
            (None, _) => self.arrangement.nodes[PointId::from_index(place)].at,
            (Some(_), Some(k)) => self.shorts[k].at,
            (Some(beyond), None) => self.arrangement.drawing.off_plane[beyond / 2].ends[beyond % 2],
        }
    }

    fn add(&mut self, [a, b]: [usize; 2], via: Via) {
        self.from[a].push((b, via));
        self.from[b].push((a, via));
    }

    /// The links that may close a ring: those across gaps, then those from ends to their feet on lines.
    fn links(&self, gaps: &[Gap]) -> Vec<([usize; 2], Via)> {
        let place = |end: usize| self.place_of(self.ends[end].owner);
        let across = gaps.iter().map(|gap| (gap.ends.map(place), Via::Gap(*gap)));
        let onto = |(k, short): (usize, &Short)| ([place(short.end), self.foot(k)], Via::Short(*short));
        across.chain(self.shorts.iter().enumerate().map(onto)).collect()
    }

    /// The ring that a link between two places closes, by the way of the fewest steps. `None` where it is too narrow,
    /// or not found within the budget.
    fn ring(&mut self, [start, goal]: [usize; 2], link: Via) -> Option<Ring> {
        let mut via = self.way(start, goal)?;
        via.push((goal, start, link));
        let width = self.width(&via);
        let mut ring = Ring { gaps: Vec::new(), shorts: Vec::new(), off_plane: BTreeSet::new() };
        for (_, _, via) in via {
            match via {
                Via::Edge(_) | Via::Part(..) => {}
                Via::OffPlane(k) => _ = ring.off_plane.insert(k),
                Via::Gap(gap) => ring.gaps.push(gap),
                Via::Short(short) => ring.shorts.push(short),
            }
        }
        let widths = ring.gaps.iter().map(|gap| gap.width).chain(ring.shorts.iter().map(|short| short.width));
        let widest = widths.fold(0.0, f64::max);
        (width > WIDE * widest).then_some(ring)
    }

    /// The shortest way from one place to another by breadth-first search: steps, each with the places where it begins
    /// and ends.
    fn way(&mut self, start: usize, goal: usize) -> Option<Vec<(usize, usize, Via)>> {
        self.searches += 1;
        let mut queue = VecDeque::from([start]);
        self.reached[start].0 = self.searches;
        while let Some(here) = queue.pop_front() {
            if here == goal {
                break;
            }
            for &(next, via) in &self.from[here] {
                self.steps_left = self.steps_left.checked_sub(1)?;
                if self.reached[next].0 != self.searches {
                    self.reached[next] = (self.searches, here, via);
                    queue.push_back(next);
                }
            }
        }
        let mut steps = Vec::new();
        let mut here = goal;
        while here != start {
            let (search, before, via) = self.reached[here];
            if search != self.searches {
                return None;
            }
            steps.push((before, here, via));
            here = before;
        }
        steps.reverse();
        Some(steps)
    }

    /// Twice the area within a closed way, over its length: for a long strip, its width.
    fn width(&self, way: &[(usize, usize, Via)]) -> f64 {
        let origin = self.at(way[0].0);
        let (mut area, mut length) = (0.0, 0.0);
        for &(from, to, via) in way {
            let (a, b) = (self.at(from), self.at(to));
            match via {
                Via::Edge(id) => {
                    let edge = &self.arrangement.edges[id];
                    let swept = edge.curve.signed_area(origin);
                    area += if edge.ends[0].index() == from { swept } else { -swept };
                    length += extent(edge.bounds);
                }
                Via::Part(_, [t0, t1]) if t0 == t1 => {}
                Via::Part(id, [t0, t1]) => {
                    let part = self.arrangement.edges[id].curve.part(t0, t1);
                    let swept = part.signed_area(origin);
                    area +=
                        if a.distance_squared(part.start()) <= a.distance_squared(part.end()) { swept } else { -swept };
                    length += extent(part.bounds());
                }
                Via::OffPlane(_) | Via::Gap(_) | Via::Short(_) => {
                    area += 0.5 * (a - origin).cross(b - origin);
                    length += a.distance(b);
                }
            }
        }
        2.0 * area.abs() / length
    }
}

/// The error of a drawing with outlines that do not quite close; `None` if it has none.
///
/// ```text
///   ╭──── · 1 ─────╮      Links are added one after the other, the narrowest gaps first. Link 1 joins two parts. Link
///   │              │      2 is between places that are connected by then, so it closes a ring, by the way through 1.
///   ╰──── · 2 ─────╯      Both gaps are reported.
///
///   ╭──────────────╮           Link 3 is from an end that stops short of an open line to its foot, the nearest point
///   │              · 3         there. The part of the line up to the foot belongs to the ring; the part beyond it does
///   ╰──────────────·──────     not.
/// ```
pub(super) fn missed_rings(arrangement: &Arrangement, ends: &[FreeEnd]) -> Option<ArrangeError> {
    let gaps = missed_gaps(ends);
    let shorts = missed_lines(arrangement, ends, &gaps);
    if gaps.is_empty() && shorts.is_empty() {
        return None;
    }
    let rings = closed_by(&gaps, Ways::new(arrangement, ends, &shorts));
    leaves_plane(arrangement, &rings).or_else(|| misses_closing(arrangement, ends, &rings))
}

/// Gaps between nearest free ends that are short compared with both chains, each once, the narrowest first.
fn missed_gaps(ends: &[FreeEnd]) -> Vec<Gap> {
    let all: Vec<usize> = (0..ends.len()).collect();
    let mut gaps = nearest_ends(ends, &all, |i| MISSED * ends[i].chain);
    gaps.retain(|gap| gap.width < MISSED * ends[gap.ends[1]].chain);
    gaps.iter_mut().for_each(|gap| gap.ends.sort_unstable());
    gaps.sort_by(|a, b| a.width.total_cmp(&b.width).then(a.ends.cmp(&b.ends)));
    gaps.dedup_by_key(|gap| gap.ends);
    gaps
}

/// The free ends in none of `gaps` that stop short of open lines, under the same limits.
fn missed_lines(arrangement: &Arrangement, ends: &[FreeEnd], gaps: &[Gap]) -> Vec<Short> {
    let linked: BTreeSet<usize> = gaps.iter().flat_map(|gap| gap.ends).collect();
    let left: Vec<usize> = (0..ends.len()).filter(|i| !linked.contains(i)).collect();
    let mut shorts = arrangement.shorts(ends, &left, |i| MISSED * ends[i].chain);
    shorts.retain(|short| short.width < MISSED * extent(arrangement.edges[short.onto].bounds));
    shorts
}

/// The rings that the links close, when they are added one after the other.
fn closed_by(gaps: &[Gap], mut ways: Ways) -> Vec<Ring> {
    let mut parts = Forest::new(ways.from.len());
    for (here, ways) in ways.from.iter().enumerate() {
        ways.iter().for_each(|&(there, _)| parts.join(here, there));
    }
    let mut rings = Vec::new();
    for (places, via) in ways.links(gaps) {
        let [a, b] = places;
        if parts.root(a) == parts.root(b) {
            rings.extend(ways.ring(places, via));
        }
        parts.join(a, b);
        ways.add(places, via);
    }
    rings
}

/// The error of a ring that runs along an entity which leaves the plane and is left out.
fn leaves_plane(arrangement: &Arrangement, rings: &[Ring]) -> Option<ArrangeError> {
    let &k = rings.iter().find_map(|ring| ring.off_plane.first())?;
    let entity = &arrangement.drawing.off_plane[k];
    let what = format!("{} leaves the plane and is left out, so that an outline does not close", entity.entity);
    Some(ArrangeError::new(what, entity.ends[0], "--flatten-z projects it onto the plane"))
}

/// A gap that keeps a ring from closing.
struct Missing {
    width: f64,
    at: Point,
    /// Says which ends are how far apart.
    text: String,
}

/// The gaps of all rings: those between free ends, then those from ends to lines, in the order of the ends, each once.
fn missing(arrangement: &Arrangement, ends: &[FreeEnd], rings: &[Ring]) -> Vec<Missing> {
    let mut gaps: Vec<Gap> = rings.iter().flat_map(|ring| ring.gaps.iter().copied()).collect();
    gaps.sort_by_key(|gap| gap.ends);
    gaps.dedup_by_key(|gap| gap.ends);
    let mut shorts: Vec<Short> = rings.iter().flat_map(|ring| ring.shorts.iter().copied()).collect();
    shorts.sort_by_key(|short| short.end);
    shorts.dedup_by_key(|short| short.end);
    let told = |width: f64| arrangement.tolerances.told(width);
    let across = gaps.into_iter().map(|Gap { ends: pair, width }| {
        let [a, b] = pair.map(|end| arrangement.place(&ends[end]));
        Missing { width, at: ends[pair[0]].at, text: format!("{a} and {b} are {} apart", told(width)) }
    });
    let onto = shorts.into_iter().map(|Short { end, onto, width, .. }| {
        let (a, b) = (arrangement.place(&ends[end]), arrangement.text_of(onto));
        Missing { width, at: ends[end].at, text: format!("{a} stops {} short of {b}", told(width)) }
    });
    across.chain(onto).collect()
}

/// The error that lists the gaps, with the option that closes them.
fn misses_closing(arrangement: &Arrangement, ends: &[FreeEnd], rings: &[Ring]) -> Option<ArrangeError> {
    let missing = missing(arrangement, ends, rings);
    let widest = missing.iter().map(|missing| missing.width).reduce(f64::max)?;
    let listed: Vec<&str> = missing.iter().take(LISTED).map(|missing| missing.text.as_str()).collect();
    let more = match missing.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!(", and {more} gaps more"),
    };
    let outlines = if rings.len() == 1 { "an outline misses" } else { "outlines miss" };
    let what = format!("{outlines} closing: {}{more}", listed.join("; "));
    let help = format!(
        "--close {} joins these ends and welds nothing else; --loose keep takes them for open lines, --loose drop leaves them out",
        rounded_up(widest * arrangement.tolerances.unit)
    );
    let also_at = missing.iter().take(LISTED).skip(1).map(|missing| missing.at).collect();
    Some(ArrangeError { also_at, ..ArrangeError::new(what, missing[0].at, help) })
}

/// A positive length, rounded up to two digits.
fn rounded_up(length: f64) -> String {
    let unit = libm::pow(10.0, libm::floor(libm::log10(length)) - 1.0);
    let digits = libm::ceil(length * (1.0 + 1e-9) / unit);
    let rounded = format!("{:.1e}", digits * unit);
    match rounded.parse::<f64>() {
        Ok(plain) if plain >= PLAIN => plain.to_string(),
        _ => rounded,
    }
}
