//! TetGen's `.poly` and `.smesh` (Si, TetGen manual, chapter 5): vertices, facets, hole points and region points.
//!
//! A marker is the facet's name, as text; facets with marker 0 or none have no name. The attribute of a region point is
//! the region's name. Every bounded cell is material but those that hold a hole point.

use super::text::{Row, Rows, Written, whole};
use crate::geometry::written::{number, tokens};
use crate::ids::NameId;
use crate::import::ImportError;
use crate::solid::{FoundFacet, Material, RegionSeed, Surfaces};
use std::collections::BTreeMap;

const HELP: &str = "see the TetGen manual, chapter 5, File Formats, for the format";

/// Whether the first line says that the vertices have three coordinates.
pub(in crate::import) fn in_space(bytes: &[u8]) -> bool {
    let Some(row) = Rows::new(bytes, HELP).next() else { return false };
    let mut head = tokens(row.text).map(number);
    let count = head.next().flatten();
    count.and_then(whole).is_some_and(|n| n >= 0) && head.next().flatten() == Some(3.0)
}

/// Whether the first rows are a header of four whole numbers and the first vertex.
pub(in crate::import) fn begins_as_tetgen(bytes: &[u8]) -> bool {
    let mut rows = Rows::new(bytes, HELP).map(|row| tokens(row.text).map(number).collect::<Option<Vec<_>>>());
    let [Some(Some(header)), Some(Some(vertex))] = [rows.next(), rows.next()] else { return false };
    let is_header = header.len() == 4 && header.iter().all(|&x| whole(x).is_some()) && header[1] == 3.0;
    is_header && vertex.len() >= 4 && (vertex[0] == 0.0 || vertex[0] == 1.0)
}

/// Reads a `.poly` file.
pub(in crate::import) fn read_poly(bytes: &[u8]) -> Result<Surfaces, ImportError> {
    read(bytes, "TetGen poly", facet_of_poly)
}

/// Reads a `.smesh` file: a `.poly` whose facets are one polygon each, on a line of their own.
pub(super) fn read_smesh(bytes: &[u8]) -> Result<Surfaces, ImportError> {
    read(bytes, "TetGen smesh", facet_of_smesh)
}

/// Reads one facet, the `i`-th, and its marker.
type FacetReader<'a> = fn(&mut Reader<'a>, Row<'a>, usize) -> Result<(FoundFacet, i64), ImportError>;

struct Reader<'a> {
    rows: Rows<'a>,
    /// Places of the vertices by their numbers; none where they are consecutive from `first`.
    places: BTreeMap<i64, u32>,
    first: i64,
    count: usize,
    marked: bool,
}

fn read<'a>(bytes: &'a [u8], format: &str, facet: FacetReader<'a>) -> Result<Surfaces, ImportError> {
    let mut surfaces = Surfaces { format: format.into(), ..Surfaces::default() };
    let mut reader =
        Reader { rows: Rows::new(bytes, HELP), places: BTreeMap::new(), first: 0, count: 0, marked: false };
    reader.vertices(&mut surfaces)?;
    reader.facets(&mut surfaces, facet)?;
    let holes = reader.holes(&mut surfaces)?;
    let regions = reader.regions(&mut surfaces)?;
    surfaces.material = Material::Cells { holes, regions };
    if let Some(row) = reader.rows.next() {
        let line = row.line;
        surfaces.notes.push(format!("What follows from line {line} on belongs to no section and was passed over."));
    }
    Ok(surfaces)
}

impl<'a> Reader<'a> {
    fn vertices(&mut self, surfaces: &mut Surfaces) -> Result<(), ImportError> {
        let header = self.rows.header()?;
        let ([count, dimension], _) = header.take("the vertex header (count, dimension, attributes, markers)")?;
        let count = header.count(count, "vertices")?;
        if dimension != 3.0 {
            return Err(header.error(format!("the dimension is {dimension}, but vertices in space have 3")));
        }
        if count == 0 {
            let help = "paste the .node file in place of this line";
            return Err(ImportError::at(header.line, "the vertices are in a .node file of their own", help));
        }
        // A row takes at least eight bytes, whatever the header says.
        let mut given = Vec::with_capacity(count.min(self.rows.left() / 8 + 1));
        let mut written = Written::default();
        for i in 0..count {
            let row = self.rows.expect(header, "vertices", i, count)?;
            let ([n, at @ ..], _) = row.take::<4>("a vertex (number, x, y, z)")?;
            given.push((whole(n).ok_or_else(|| row.error(format!("{n} is no vertex number")))?, row));
            surfaces.points.push([at[0], at[1], at[2]]);
            tokens(row.text).skip(1).zip(at).for_each(|(token, x)| written.note(token, x));
        }
        surfaces.digits = written.digits();
        self.number(&given)
    }

    /// Finds out how vertices are numbered.
    fn number(&mut self, given: &[(i64, Row)]) -> Result<(), ImportError> {
        self.count = given.len();
        self.first = given.first().map_or(0, |&(n, _)| n);
        if (self.first..).zip(given).all(|(n, (given, _))| n == *given) {
            return Ok(());
        }
        for (i, &(n, row)) in given.iter().enumerate() {
            if self.places.insert(n, i as u32).is_some() {
                return Err(row.error(format!("a second vertex {n}")));
            }
        }
        Ok(())
    }

    fn vertex(&self, row: Row, token: &[u8], entity: &str) -> Result<u32, ImportError> {
        let n = number(token).and_then(whole);
        let place = n.and_then(|n| match self.places.is_empty() {
            true => u32::try_from(n.checked_sub(self.first)?).ok().filter(|&i| (i as usize) < self.count),
            false => self.places.get(&n).copied(),
        });
        place.ok_or_else(|| {
            let text = String::from_utf8_lossy(&token[..token.len().min(20)]).into_owned();
            row.error(format!("{entity}: there is no vertex {text}"))
        })
    }

    fn facets(&mut self, surfaces: &mut Surfaces, facet: FacetReader<'a>) -> Result<(), ImportError> {
        let Some(header) = self.rows.next() else {
            surfaces.notes.push("The file ends before the facets; there are none.".into());
            return Ok(());
        };
        let ([count], mut rest) = header.take("the facet header (count, markers)")?;
        let marked = rest.next().and_then(number).unwrap_or(0.0);
        if marked != 0.0 && marked != 1.0 {
            let what = "expected the facet header (count, then 0 or 1 for markers), found something else";
            return Err(ImportError::at(header.line, what, "does the count of vertices fit the lines that follow it?"));
        }
        self.marked = marked == 1.0;
        let count = header.count(count, "facets")?;
        for i in 0..count {
            let row = self.rows.expect(header, "facets", i, count)?;
            let (mut facet, marker) = facet(self, row, i)?;
            facet.name = (marker != 0).then(|| surfaces.names.intern(&marker.to_string()));
            surfaces.facets.push(facet);
        }
        Ok(())
    }

    /// A polygon: the count of its corners, and the corners, which may go on in the lines that follow. What is left of
    /// the last line is given back.
    fn polygon(
        &mut self,
        row: Row<'a>,
        entity: &str,
    ) -> Result<(Vec<u32>, impl Iterator<Item = &'a [u8]> + use<'a>), ImportError> {
        let ([corners], _) = row.take(&format!("{entity}: the count of corners"))?;
        let corners = row.count(corners, "corners")?;
        if corners == 0 {
            return Err(row.error(format!("{entity}: a polygon without corners")));
        }
        let mut polygon = Vec::with_capacity(corners.min(row.text.len() / 2 + 1));
        let (mut row, mut skip) = (row, 1);
        loop {
            let mut rest = tokens(row.text);
            rest.by_ref().take(skip).for_each(drop);
            for token in rest.by_ref().take(corners - polygon.len()) {
                polygon.push(self.vertex(row, token, entity)?);
            }
            if polygon.len() == corners {
                return Ok((polygon, rest));
            }
            let missing = |line| {
                let what =
                    format!("{entity}: {corners} corners are promised, but the file ends after {}", polygon.len());
                ImportError::at(line, what, HELP)
            };
            row = self.rows.next().ok_or_else(|| missing(row.line))?;
            skip = 0;
        }
    }

    fn holes(&mut self, surfaces: &mut Surfaces) -> Result<Vec<[f64; 3]>, ImportError> {
        let Some(header) = self.rows.next() else {
            surfaces.notes.push("The file ends before the hole points; there are none.".into());
            return Ok(Vec::new());
        };
        let ([count], _) = header.take("the count of holes")?;
        let count = header.count(count, "holes")?;
        self.places_of(header, "holes", count)
    }

    fn places_of(&mut self, header: Row, what: &str, count: usize) -> Result<Vec<[f64; 3]>, ImportError> {
        let mut places = Vec::new();
        for i in 0..count {
            let ([_, x, y, z], _) = self.rows.expect(header, what, i, count)?.take("a hole point (number, x, y, z)")?;
            places.push([x, y, z]);
        }
        Ok(places)
    }

    fn regions(&mut self, surfaces: &mut Surfaces) -> Result<Vec<RegionSeed>, ImportError> {
        let Some(header) = self.rows.next() else { return Ok(Vec::new()) };
        let ([count], _) = header.take("the count of regions")?;
        let count = header.count(count, "regions")?;
        let mut regions = Vec::new();
        for i in 0..count {
            let row = self.rows.expect(header, "regions", i, count)?;
            let ([n, at @ ..], mut rest) = row.take::<4>("a region point (number, x, y, z, attribute)")?;
            let attribute = rest.next().and_then(number).unwrap_or(n);
            let name: NameId = surfaces.names.intern(&attribute.to_string());
            regions.push(RegionSeed { at: [at[0], at[1], at[2]], name });
        }
        Ok(regions)
    }
}

fn marker_of(token: Option<&[u8]>) -> i64 {
    token.and_then(number).and_then(whole).unwrap_or(0)
}

fn facet_of_poly<'a>(reader: &mut Reader<'a>, row: Row<'a>, i: usize) -> Result<(FoundFacet, i64), ImportError> {
    let entity = format!("facet {} (line {})", i + 1, row.line);
    let ([polygons], mut rest) = row.take(&format!("{entity}: the count of polygons"))?;
    let count = row.count(polygons, "polygons")?;
    let holes = row.count(rest.next().and_then(number).unwrap_or(0.0), "holes of the facet")?;
    let marker = if reader.marked { marker_of(rest.next()) } else { 0 };
    let mut facet = FoundFacet { entity, ..FoundFacet::default() };
    for i in 0..count {
        let first = reader.rows.expect(row, "polygons", i, count)?;
        facet.polygons.push(reader.polygon(first, &facet.entity)?.0);
    }
    facet.holes = reader.places_of(row, "holes of the facet", holes)?;
    Ok((facet, marker))
}

fn facet_of_smesh<'a>(reader: &mut Reader<'a>, row: Row<'a>, i: usize) -> Result<(FoundFacet, i64), ImportError> {
    let entity = format!("facet {} (line {})", i + 1, row.line);
    let (polygon, mut rest) = reader.polygon(row, &entity)?;
    let marker = if reader.marked { marker_of(rest.next()) } else { 0 };
    Ok((FoundFacet { polygons: vec![polygon], entity, ..FoundFacet::default() }, marker))
}
