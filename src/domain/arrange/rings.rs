//! Outlines that miss closing: rings of chains whose free ends are nearest to each other, with gaps that are short beside the chains.
//!
//! ```text
//!    ┌──────────┐          Each free end is linked with its nearest one where the gap is below a twentieth of both chains. A link between
//!    │          │          parts that are connected already closes a ring: the way from one end to the other along pieces and earlier
//!    └─────── ──┘          links. A ring that is hardly wider than its gaps is a pair of parallel lines.
//!           gap
//! ```
//!
//! A free end without such a link may stop short of the inside of another open line, which goes on beyond the corner: it is linked with the
//! nearest point there, under the same limits.

use super::ArrangeError;
use super::cut::{Network, extent};
use super::loose::{FreeEnd, Gap, Owner, Short, nearest_ends};
use crate::geometry::Point;
use crate::ids::{CurveId, Forest, Id, PointId};
use std::collections::{BTreeSet, VecDeque};

/// An outline misses closing where each gap is below this part of the shorter chain at it.
const MISSED: f64 = 1.0 / 20.0;

/// A ring is at least so many times as wide as its widest gap.
const WIDE: f64 = 2.0;

/// Places that are looked at, for all rings together: some seconds.
const STEPS_MAX: usize = 1 << 24;

/// Gaps that a message lists.
const LISTED: usize = 4;

/// Along what a ring goes from one place to the next.
#[derive(Clone, Copy)]
enum Via {
    Piece(CurveId),
    OffPlane(usize),
    Gap(Gap),
    /// From a free end to the inside of an open line.
    Short(Short),
    /// From one parameter of a line to another: between its ends and the points that ends stop short of.
    Part(CurveId, [f64; 2]),
}

/// Chains that close up where each gap is bridged.
struct Ring {
    gaps: Vec<Gap>,
    shorts: Vec<Short>,
    off_plane: BTreeSet<usize>,
}

/// Nodes, then both ends of each entity that leaves the plane, then the points that free ends stop short of; what leads from each to others.
struct Ways<'n, 'a> {
    network: &'n Network<'a>,
    ends: &'n [FreeEnd],
    shorts: &'n [Short],
    from: Vec<Vec<(usize, Via)>>,
    steps_left: usize,
    /// By place: the search that reached it last, and from where.
    reached: Vec<(usize, usize, Via)>,
    searches: usize,
}

impl<'n, 'a> Ways<'n, 'a> {
    fn new(network: &'n Network<'a>, ends: &'n [FreeEnd], shorts: &'n [Short]) -> Self {
        let count = network.nodes.len() + 2 * network.drawing.off_plane.len() + shorts.len();
        let nothing = (0, 0, Via::OffPlane(0));
        let mut ways = Self {
            network,
            ends,
            shorts,
            from: vec![Vec::new(); count],
            steps_left: STEPS_MAX,
            reached: vec![nothing; count],
            searches: 0,
        };
        for (id, piece) in network.pieces.enumerate() {
            ways.add(piece.ends.map(Id::index), Via::Piece(id));
        }
        for k in 0..network.drawing.off_plane.len() {
            let ends = [0, 1].map(|end| ways.place_of(Owner::OffPlane(k, end)));
            ways.add(ends, Via::OffPlane(k));
        }
        ways.add_parts();
        ways
    }

    /// Lines that ends stop short of, in parts from one such point to the next.
    fn add_parts(&mut self) {
        let mut feet: Vec<(CurveId, f64, usize)> =
            self.shorts.iter().enumerate().map(|(k, short)| (short.onto, short.t, self.foot(k))).collect();
        feet.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for feet in feet.chunk_by(|a, b| a.0 == b.0) {
            let onto = feet[0].0;
            let [start, end] = self.network.pieces[onto].ends.map(Id::index);
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
            Owner::OffPlane(k, end) => self.network.nodes.len() + 2 * k + end,
        }
    }

    /// The place of the point that an end stops short of.
    fn foot(&self, k: usize) -> usize {
        self.from.len() - self.shorts.len() + k
    }

    fn at(&self, place: usize) -> Point {
        match (place.checked_sub(self.network.nodes.len()), place.checked_sub(self.foot(0))) {
            (None, _) => self.network.nodes[PointId::from_index(place)].at,
            (Some(_), Some(k)) => self.shorts[k].at,
            (Some(beyond), None) => self.network.drawing.off_plane[beyond / 2].ends[beyond % 2],
        }
    }

    fn add(&mut self, [a, b]: [usize; 2], via: Via) {
        self.from[a].push((b, via));
        self.from[b].push((a, via));
    }

    fn places(&self, gap: &Gap) -> [usize; 2] {
        gap.ends.map(|end| self.place_of(self.ends[end].owner))
    }

    /// The ring that a link from one place to another closes: by the way of the fewest steps. `None` where it is too narrow, or not found
    /// within the budget.
    fn ring(&mut self, [start, goal]: [usize; 2], link: Via) -> Option<Ring> {
        let mut via = self.way(start, goal)?;
        via.push((goal, start, link));
        let width = self.width(&via);
        let mut ring = Ring { gaps: Vec::new(), shorts: Vec::new(), off_plane: BTreeSet::new() };
        for (_, _, via) in via {
            match via {
                Via::Piece(_) | Via::Part(..) => {}
                Via::OffPlane(k) => _ = ring.off_plane.insert(k),
                Via::Gap(gap) => ring.gaps.push(gap),
                Via::Short(short) => ring.shorts.push(short),
            }
        }
        let widths = ring.gaps.iter().map(|gap| gap.width).chain(ring.shorts.iter().map(|short| short.width));
        let widest = widths.fold(0.0, f64::max);
        (width > WIDE * widest).then_some(ring)
    }

    /// The steps from one place to another, each with where it begins and ends.
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

    /// Twice the area within a closed way over its length: the width of a long strip.
    fn width(&self, way: &[(usize, usize, Via)]) -> f64 {
        let origin = self.at(way[0].0);
        let (mut area, mut length) = (0.0, 0.0);
        for &(from, to, via) in way {
            let (a, b) = (self.at(from), self.at(to));
            match via {
                Via::Piece(id) => {
                    let piece = &self.network.pieces[id];
                    let green = piece.curve.green(origin);
                    area += if piece.ends[0].index() == from { green } else { -green };
                    length += extent(piece.bounds);
                }
                Via::Part(_, [t0, t1]) if t0 == t1 => {}
                Via::Part(id, [t0, t1]) => {
                    let part = self.network.pieces[id].curve.part(t0, t1);
                    let green = part.green(origin);
                    area +=
                        if a.distance_squared(part.start()) <= a.distance_squared(part.end()) { green } else { -green };
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

impl Network<'_> {
    /// Says what outlines miss closing, if any do.
    pub fn missed_rings(&self, ends: &[FreeEnd]) -> Option<ArrangeError> {
        let all: Vec<usize> = (0..ends.len()).collect();
        let mut links = nearest_ends(ends, &all, |i| MISSED * ends[i].chain);
        links.retain(|gap| gap.width < MISSED * ends[gap.ends[1]].chain);
        links.iter_mut().for_each(|gap| gap.ends.sort_unstable());
        links.sort_by(|a, b| a.width.total_cmp(&b.width).then(a.ends.cmp(&b.ends)));
        links.dedup_by_key(|gap| gap.ends);
        let linked: BTreeSet<usize> = links.iter().flat_map(|gap| gap.ends).collect();
        let left: Vec<usize> = (0..ends.len()).filter(|i| !linked.contains(i)).collect();
        let mut shorts = self.shorts(ends, &left, |i| MISSED * ends[i].chain);
        shorts.retain(|short| short.width < MISSED * extent(self.pieces[short.onto].bounds));
        if links.is_empty() && shorts.is_empty() {
            return None;
        }
        let mut ways = Ways::new(self, ends, &shorts);
        let mut parts = Forest::new(ways.from.len());
        for (here, ways) in ways.from.iter().enumerate() {
            ways.iter().for_each(|&(there, _)| parts.join(here, there));
        }
        let across = links.iter().map(|gap| (ways.places(gap), Via::Gap(*gap)));
        let onto =
            |(k, short): (usize, &Short)| ([ways.place_of(ends[short.end].owner), ways.foot(k)], Via::Short(*short));
        let links: Vec<([usize; 2], Via)> = across.chain(shorts.iter().enumerate().map(onto)).collect();
        let mut rings = Vec::new();
        for ([a, b], via) in links {
            if parts.root(a) == parts.root(b) {
                rings.extend(ways.ring([a, b], via));
            }
            parts.join(a, b);
            ways.add([a, b], via);
        }
        self.missed(&rings, ends)
    }

    fn missed(&self, rings: &[Ring], ends: &[FreeEnd]) -> Option<ArrangeError> {
        if let Some(&k) = rings.iter().find_map(|ring| ring.off_plane.first()) {
            let entity = &self.drawing.off_plane[k];
            let what = format!("{} leaves the plane and is left out, so that an outline does not close", entity.entity);
            return Some(ArrangeError::new(what, entity.ends[0], "--flatten-z projects it onto the plane"));
        }
        let mut gaps: Vec<Gap> = rings.iter().flat_map(|ring| ring.gaps.iter().copied()).collect();
        gaps.sort_by_key(|gap| gap.ends);
        gaps.dedup_by_key(|gap| gap.ends);
        let mut shorts: Vec<Short> = rings.iter().flat_map(|ring| ring.shorts.iter().copied()).collect();
        shorts.sort_by_key(|short| short.end);
        shorts.dedup_by_key(|short| short.end);
        // Widths and places of all, with what is to be said of each.
        let between = |gap: &Gap| {
            let [a, b] = gap.ends.map(|end| self.place(&ends[end]));
            (gap.width, ends[gap.ends[0]].at, format!("{a} and {b} are {} apart", self.tolerances.told(gap.width)))
        };
        let before = |short: &Short| {
            let end = &ends[short.end];
            let [a, b] = [self.place(end), self.text_of(short.onto).to_owned()];
            (short.width, end.at, format!("{a} stops {} short of {b}", self.tolerances.told(short.width)))
        };
        let missing: Vec<(f64, Point, String)> = gaps.iter().map(between).chain(shorts.iter().map(before)).collect();
        let widest = missing.iter().map(|gap| gap.0).reduce(f64::max)?;
        let listed: Vec<&str> = missing.iter().take(LISTED).map(|gap| &gap.2[..]).collect();
        let more =
            if missing.len() > LISTED { format!(", and {} gaps more", missing.len() - LISTED) } else { String::new() };
        let outlines = if rings.len() == 1 { "an outline misses" } else { "outlines miss" };
        let what = format!("{outlines} closing: {}{more}", listed.join("; "));
        let help = format!(
            "--close {} joins these ends and welds nothing else; --loose keep takes them for open lines, --loose drop leaves them out",
            rounded_up(widest * self.tolerances.unit)
        );
        let also_at = missing.iter().take(LISTED).skip(1).map(|gap| gap.1).collect();
        Some(ArrangeError { also_at, ..ArrangeError::new(what, missing[0].1, help) })
    }
}

/// A little more than a positive length, in two digits.
fn rounded_up(length: f64) -> String {
    let unit = libm::pow(10.0, libm::floor(libm::log10(length)) - 1.0);
    let digits = libm::ceil(length * (1.0 + 1e-9) / unit);
    let rounded = format!("{:.1e}", digits * unit);
    match rounded.parse::<f64>() {
        Ok(plain) if plain >= PLAIN => plain.to_string(),
        _ => rounded,
    }
}

/// Shorter lengths are written with an exponent.
const PLAIN: f64 = 1e-4;
