//! The input deck of Abaqus and CalculiX. Read are `*NODE`, `*ELEMENT` of triangles (CPS3, CPE3, CAX3, S3, STRI3 and
//! similar ones, also of 6 nodes) and of lines (T2D2, B21 and similar ones, also of 3 nodes), and `*SURFACE` of element
//! faces. The element set names the region or boundary; a surface is a boundary. Other keywords are skipped.
//!
//! The set of an element is the one on its `*ELEMENT` line. Where there is none, or it is an entity of the program that
//! wrote the deck (Gmsh's `Surface2`, `Line1`; FreeCAD's `Efaces`, `Eedges`), it is the smallest of the `*ELSET` lists
//! that hold the element. Gmsh writes its physical groups there.

use crate::geometry::written::number;
use crate::meshio::draft::{BOUNDARY, Draft, REGION};
use crate::meshio::names::Comments;
use crate::meshio::{MeshFile, Result, broken_at, lines, text, unsupported};
use std::collections::BTreeMap;

/// Reads a deck.
pub fn read(bytes: &[u8]) -> Result<MeshFile> {
    let mut deck = Deck::default();
    for (n, line) in lines(bytes) {
        if let Some(comment) = line.strip_prefix(b"**") {
            deck.comments.read(comment);
        } else if let Some(keyword) = line.strip_prefix(b"*") {
            deck.keyword(n, &text(keyword))?;
        } else if !line.is_empty() {
            deck.data(n, line)?;
        }
    }
    deck.finish()
}

#[derive(Default)]
enum Section {
    Nodes,
    /// Nodes an element, and its set.
    Triangles(usize, Option<String>),
    Lines(usize, Option<String>),
    Surface(String),
    /// The last of the lists, and whether its lines are ranges.
    Set(bool),
    #[default]
    Other,
}

/// An element of the deck.
struct Element {
    tag: u64,
    nodes: Vec<usize>,
    set: Option<String>,
}

/// The edges of boundaries, in the order of the deck.
enum Boundary {
    Line(Element),
    /// A side of a triangle, in the surface of this name.
    Face {
        ends: [usize; 2],
        name: String,
    },
}

/// A member of a list of elements.
enum Member {
    Element(u64),
    /// From, to, and the step.
    Range([u64; 3]),
    Set(String),
}

struct List {
    name: String,
    members: Vec<Member>,
}

#[derive(Default)]
struct Deck {
    draft: Draft,
    comments: Comments,
    section: Section,
    nodes: BTreeMap<u64, usize>,
    triangles: Vec<Element>,
    boundaries: Vec<Boundary>,
    lists: Vec<List>,
    /// The index of a triangle by its element number.
    places: BTreeMap<u64, usize>,
    /// The numbers of an element that continues on the next line.
    begun: Vec<u64>,
}

impl Deck {
    fn keyword(&mut self, n: usize, line: &str) -> Result<()> {
        let mut parts = line.split(',').map(str::trim);
        let keyword = parts.next().unwrap_or_default().to_ascii_uppercase();
        let parts: Vec<&str> = parts.collect();
        let parameters: BTreeMap<String, &str> = parts
            .iter()
            .filter_map(|p| p.split_once('='))
            .map(|(k, v)| (k.trim().to_ascii_uppercase(), v.trim()))
            .collect();
        let set = parameters.get("ELSET").map(|set| (*set).to_owned());
        self.section = match keyword.as_str() {
            "NODE" => Section::Nodes,
            "ELEMENT" => {
                let kind = parameters.get("TYPE").copied().unwrap_or_default().to_ascii_uppercase();
                element(&kind, set).ok_or_else(|| {
                    unsupported(format!("line {n}: elements of type '{kind}'"), "only triangles and lines can be read")
                })?
            }
            "ELSET" => {
                self.lists.push(List { name: set.unwrap_or_else(|| REGION.into()), members: Vec::new() });
                Section::Set(parts.iter().any(|part| part.eq_ignore_ascii_case("GENERATE")))
            }
            "SURFACE" => {
                let name = parameters.get("NAME").copied().unwrap_or(BOUNDARY);
                match parameters.get("TYPE").map(|kind| kind.to_ascii_uppercase()).as_deref() {
                    None | Some("ELEMENT") => Section::Surface(self.comments.boundary(name)),
                    Some(_) => Section::Other,
                }
            }
            _ => Section::Other,
        };
        self.begun.clear();
        Ok(())
    }

    fn data(&mut self, n: usize, line: &[u8]) -> Result<()> {
        let words: Vec<&[u8]> = line.split(|&b| b == b',').map(<[u8]>::trim_ascii).filter(|w| !w.is_empty()).collect();
        let whole = |word: &&[u8]| -> Result<u64> {
            text(word)
                .parse()
                .map_err(|_| broken_at(n, format!("'{}' is not a number of a node or element", text(word))))
        };
        match &self.section {
            Section::Nodes => {
                let tag = words.first().map(whole).transpose()?.unwrap_or(0);
                let value = |k: usize| words.get(k).map_or(Some(0.0), |word| number(word));
                let (Some(x), Some(y), Some(z)) = (value(1), value(2), value(3)) else {
                    return Err(broken_at(n, "a coordinate is not a number"));
                };
                if self.nodes.insert(tag, self.draft.nodes.len()).is_some() {
                    return Err(broken_at(n, format!("node {tag} is given twice")));
                }
                self.draft.nodes.push([x, y, z]);
            }
            Section::Triangles(size, _) | Section::Lines(size, _) => {
                let size = *size;
                for word in &words {
                    self.begun.push(whole(word)?);
                }
                if self.begun.len() > size {
                    self.element(n)?;
                }
            }
            Section::Surface(name) => {
                let name = name.clone();
                self.face(n, line, &words, name)?;
            }
            Section::Set(ranges) => {
                let members: Vec<Member> = if *ranges {
                    let numbers: Vec<u64> = words.iter().map(whole).collect::<Result<_>>()?;
                    let &[from, ref rest @ ..] = numbers.as_slice() else { return Ok(()) };
                    let to = rest.first().copied().unwrap_or(from);
                    vec![Member::Range([from, to, rest.get(1).copied().unwrap_or(1)])]
                } else {
                    let member = |word: &&[u8]| text(word).parse().map_or(Member::Set(text(word)), Member::Element);
                    words.iter().map(member).collect()
                };
                self.lists.last_mut().expect("its keyword began the list").members.extend(members);
            }
            Section::Other => {}
        }
        Ok(())
    }

    fn face(&mut self, n: usize, line: &[u8], words: &[&[u8]], name: String) -> Result<()> {
        let [element, face] = words else { return Ok(()) };
        let tag = text(element).parse().ok();
        let triangle = tag.and_then(|tag: u64| self.places.get(&tag)).map(|&t| &self.triangles[t]);
        let side = face.strip_prefix(b"S").or(face.strip_prefix(b"s")).and_then(number);
        let (Some(triangle), Some(side @ (1.0 | 2.0 | 3.0))) = (triangle, side) else {
            let what = format!("line {n}: '{}' is not a face of a triangle", text(line));
            return Err(unsupported(what, "surfaces can be read as faces S1 to S3 of elements before them"));
        };
        let side = side as usize - 1;
        let ends = [triangle.nodes[side], triangle.nodes[(side + 1) % 3]];
        self.boundaries.push(Boundary::Face { ends, name });
        Ok(())
    }

    fn element(&mut self, n: usize) -> Result<()> {
        let numbers = std::mem::take(&mut self.begun);
        let find =
            |tag: &u64| self.nodes.get(tag).copied().ok_or_else(|| broken_at(n, format!("there is no node {tag}")));
        let mut nodes: Vec<usize> = numbers[1..].iter().map(find).collect::<Result<_>>()?;
        let tag = numbers[0];
        match &self.section {
            Section::Triangles(size, set) if nodes.len() == *size => {
                if self.places.insert(tag, self.triangles.len()).is_some() {
                    return Err(broken_at(n, format!("element {tag} is given twice")));
                }
                self.triangles.push(Element { tag, nodes, set: set.clone() });
            }
            Section::Lines(size, set) if nodes.len() == *size => {
                // Of three nodes, the second lies within.
                if nodes.len() == 3 {
                    nodes.swap(1, 2);
                }
                self.boundaries.push(Boundary::Line(Element { tag, nodes, set: set.clone() }));
            }
            _ => return Err(broken_at(n, format!("an element has {} nodes", nodes.len()))),
        }
        Ok(())
    }

    fn finish(mut self) -> Result<MeshFile> {
        let mut sets = self.sets()?;
        let mut draft = self.draft;
        for Element { tag, nodes, set } in self.triangles {
            let name = sets.of(tag, set).unwrap_or_else(|| REGION.into());
            draft.triangle(nodes, &self.comments.region(&name));
        }
        for boundary in self.boundaries {
            match boundary {
                Boundary::Line(Element { tag, nodes, set }) => {
                    let name = sets.of(tag, set).unwrap_or_else(|| BOUNDARY.into());
                    draft.line(nodes, &self.comments.boundary(&name));
                }
                Boundary::Face { ends, name } => draft.line(ends.to_vec(), &name),
            }
        }
        let mut file = draft.finish()?;
        file.mesh.unit = self.comments.unit;
        if sets.in_several > 0 {
            let n = sets.in_several;
            file.notes.push(format!("{n} elements are in several element sets: each has the name of the smallest"));
        }
        Ok(file)
    }

    /// The lists that hold each element.
    fn sets(&mut self) -> Result<Sets> {
        let lines = self.boundaries.iter().filter_map(|boundary| match boundary {
            Boundary::Line(element) => Some(element),
            Boundary::Face { .. } => None,
        });
        let mut by_set: BTreeMap<String, Vec<u64>> = BTreeMap::new();
        let mut by_tag: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
        for element in self.triangles.iter().chain(lines) {
            by_tag.insert(element.tag, Vec::new());
            if let Some(set) = &element.set {
                by_set.entry(set.to_ascii_lowercase()).or_default().push(element.tag);
            }
        }
        // Ranges and sets of sets can describe many elements in few bytes, so their total is limited.
        let mut left = 64 * by_tag.len() + 1000;
        let mut sizes = Vec::new();
        for (k, list) in self.lists.iter().enumerate() {
            let mut size = 0;
            for member in &list.members {
                let (tags, from, step, cost): (Vec<u64>, _, _, _) = match member {
                    Member::Element(tag) => (vec![*tag], *tag, 1, 0),
                    Member::Range([from, to, step]) => {
                        let there = by_tag.range(*from..=(*to).max(*from)).map(|(&tag, _)| tag);
                        let tags: Vec<u64> = there.take(left + 1).collect();
                        let cost = tags.len().max(1);
                        (tags, *from, (*step).max(1), cost)
                    }
                    Member::Set(name) => {
                        let tags = by_set.get(&name.to_ascii_lowercase()).cloned().unwrap_or_default();
                        let cost = tags.len().max(1);
                        (tags, 0, 1, cost)
                    }
                };
                left = left.checked_sub(cost).ok_or_else(|| {
                    let what = format!("element set '{}': the sets list elements again and again", list.name);
                    unsupported(what, "write each element into its sets once")
                })?;
                for tag in tags.into_iter().filter(|tag| (tag - from).is_multiple_of(step)) {
                    if let Some(lists) = by_tag.get_mut(&tag).filter(|lists| lists.last() != Some(&k)) {
                        lists.push(k);
                        size += 1;
                    }
                }
            }
            sizes.push(size);
        }
        let names = std::mem::take(&mut self.lists).into_iter().map(|list| list.name).collect();
        Ok(Sets { names, sizes, by_tag, in_several: 0 })
    }
}

/// The lists of elements, by their elements.
struct Sets {
    names: Vec<String>,
    sizes: Vec<usize>,
    by_tag: BTreeMap<u64, Vec<usize>>,
    /// Number of elements in several lists.
    in_several: usize,
}

impl Sets {
    /// The set of an element whose line names `own`, if there is one.
    fn of(&mut self, tag: u64, own: Option<String>) -> Option<String> {
        if own.as_ref().is_some_and(|own| !is_entity(own)) {
            return own;
        }
        let lists = self.by_tag.get(&tag).map(Vec::as_slice).unwrap_or_default();
        self.in_several += usize::from(lists.len() > 1);
        let smallest = lists.iter().min_by_key(|&&k| (self.sizes[k], k));
        smallest.map(|&k| self.names[k].clone()).or(own)
    }
}

/// Whether a set is an entity of the program that wrote the deck, which no user named.
fn is_entity(set: &str) -> bool {
    let numbered = ["Line", "Curve", "Surface", "Volume"];
    let is_number = |rest: &str| !rest.is_empty() && rest.bytes().all(|b| b.is_ascii_digit());
    numbered.iter().any(|word| set.strip_prefix(word).is_some_and(is_number))
        || ["Efaces", "Eedges", "Evolumes"].contains(&set)
}

/// The cells of an element type; `None` where they are neither triangles nor lines.
fn element(kind: &str, set: Option<String>) -> Option<Section> {
    let starts = |words: &[&str]| words.iter().any(|word| kind.starts_with(word));
    if starts(&["CPS3", "CPE3", "CAX3", "S3", "STRI3", "M3D3", "SFM3D3", "DC2D3", "DS3", "R3D3"]) {
        Some(Section::Triangles(3, set))
    } else if starts(&["CPS6", "CPE6", "CAX6", "S6", "STRI65", "M3D6", "SFM3D6", "DC2D6", "DS6"]) {
        Some(Section::Triangles(6, set))
    } else if starts(&["T2D2", "T3D2", "B21", "B31", "R2D2"]) {
        Some(Section::Lines(2, set))
    } else if starts(&["T2D3", "T3D3", "B22", "B32"]) {
        Some(Section::Lines(3, set))
    } else {
        None
    }
}
