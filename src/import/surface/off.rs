//! OFF, the Object File Format of Geomview: points and polygons.

use super::text::{Row, Rows, Written, whole};
use crate::geometry::written::{number, tokens};
use crate::import::ImportError;
use crate::solid::{FoundFacet, Material, Surfaces};

const HELP: &str = "see http://www.geomview.org/docs/html/OFF.html for the format";

/// The keyword of the header, where there is one: `OFF` with the letters for what points carry besides their place.
fn keyword(row: Row<'_>) -> Option<&str> {
    let first = tokens(row.text).next()?;
    std::str::from_utf8(first)
        .ok()
        .filter(|word| word.strip_suffix("OFF").is_some_and(|letters| letters.chars().all(|c| "STCN4n".contains(c))))
}

/// Whether the file begins with the keyword and the counts.
pub(super) fn sniff(bytes: &[u8]) -> bool {
    let mut rows = Rows::new(bytes, HELP);
    let Some(first) = rows.next().filter(|row| keyword(*row).is_some()) else { return false };
    let is_counts = |row: Row, skipped: usize| {
        let counts: Vec<_> = tokens(row.text).skip(skipped).map(number).collect();
        counts.len() >= 3 && counts.iter().all(Option::is_some)
    };
    is_counts(first, 1) || tokens(first.text).nth(1).is_none() && rows.next().is_some_and(|row| is_counts(row, 0))
}

/// Reads an OFF file.
pub(super) fn read(bytes: &[u8]) -> Result<Surfaces, ImportError> {
    let mut surfaces = Surfaces { format: "OFF".into(), material: Material::Winding, ..Surfaces::default() };
    let mut rows = Rows::new(bytes, HELP);
    let mut header = rows.header()?;
    let mut counts: Vec<&[u8]> = tokens(header.text).collect();
    if let Some(word) = keyword(header) {
        match word {
            "OFF" | "COFF" | "NOFF" | "CNOFF" | "STOFF" => {}
            _ => return Err(header.error(format!("{word} files hold points of other than three coordinates"))),
        }
        counts.remove(0);
        if counts.first().is_some_and(|t| t.eq_ignore_ascii_case(b"BINARY")) {
            let help = "convert it to the text form of OFF";
            return Err(ImportError::at(header.line, "binary OFF files are not read", help));
        }
        if counts.is_empty() {
            header = rows.header()?;
            counts = tokens(header.text).collect();
        }
    } else {
        surfaces.notes.push("The keyword OFF is missing in the first line.".into());
    }
    let count = |i: usize, what: &str| {
        let token = counts.get(i).ok_or_else(|| header.error(format!("the count of {what} is missing")))?;
        header.count(header.number(token, i, "the counts")?, what)
    };
    let (points, faces) = (count(0, "points")?, count(1, "faces")?);
    read_points(&mut rows, header, points, &mut surfaces)?;
    for i in 0..faces {
        let row = rows.expect(header, "faces", i, faces)?;
        let entity = format!("face {} (line {})", i + 1, row.line);
        let polygon = face(row, &entity, surfaces.points.len())?;
        surfaces.facets.push(FoundFacet { polygons: vec![polygon], entity, ..FoundFacet::default() });
    }
    if let Some(row) = rows.next() {
        surfaces.notes.push(format!("What follows from line {} on was passed over.", row.line));
    }
    Ok(surfaces)
}

fn read_points(rows: &mut Rows, header: Row, count: usize, surfaces: &mut Surfaces) -> Result<(), ImportError> {
    let mut written = Written::default();
    for i in 0..count {
        let row = rows.expect(header, "points", i, count)?;
        let (at, _) = row.take::<3>("a point (x, y, z)")?;
        tokens(row.text).zip(at).for_each(|(token, x)| written.note(token, x));
        surfaces.points.push(at);
    }
    surfaces.digits = written.digits();
    Ok(())
}

/// The corners of a face; a colour after them is passed over.
fn face(row: Row, entity: &str, points: usize) -> Result<Vec<u32>, ImportError> {
    let ([corners], mut rest) = row.take(&format!("{entity}: the count of corners"))?;
    let corners = row.count(corners, "corners")?;
    let mut polygon = Vec::with_capacity(corners.min(row.text.len() / 2 + 1));
    for i in 0..corners {
        let token =
            rest.next().ok_or_else(|| row.error(format!("{entity} promises {corners} corners, but has {i}")))?;
        let corner = number(token).and_then(whole).and_then(|n| u32::try_from(n).ok());
        let corner = corner.filter(|&n| (n as usize) < points);
        polygon.push(corner.ok_or_else(|| {
            let text = String::from_utf8_lossy(&token[..token.len().min(20)]).into_owned();
            row.error(format!("{entity}: there is no point {text}; there are {points}, from 0"))
        })?);
    }
    Ok(polygon)
}
