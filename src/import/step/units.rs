//! The units of a face.

use super::MOST_NESTING;
use super::entity::{Entity, File, parts, reference};
use crate::geometry::metres;
use std::collections::{BTreeMap, BTreeSet};
use step_io::parser::Attribute;

/// The units of a representation.
#[derive(Clone, Debug, Default)]
pub(super) struct Context {
    /// The unit of length, and where it was read.
    pub unit: Option<(String, String)>,
    /// The uncertainty, in the unit.
    pub uncertainty: Option<f64>,
}

impl<'a> File<'a> {
    /// The context of each face: that of the representation whose items lead to it. Items that show another
    /// representation do not count.
    pub(super) fn contexts_of_faces(&self) -> BTreeMap<u64, Context> {
        let mut contexts = BTreeMap::new();
        let mut seen = BTreeSet::new();
        for entity in self.graph.entities.values().flat_map(parts) {
            let (Some(Attribute::List(items)), Some(Attribute::EntityRef(context))) =
                (entity.attributes.get(1), entity.attributes.get(2))
            else {
                continue;
            };
            let Ok(units) = self.entity(*context, &["GLOBAL_UNIT_ASSIGNED_CONTEXT"]) else { continue };
            let mut found = Vec::new();
            let mut waiting: Vec<u64> = items.iter().filter_map(reference).collect();
            while let Some(id) = waiting.pop() {
                let Some(raw) = self.graph.get(id).filter(|_| seen.insert(id)) else { continue };
                if parts(raw).any(|part| matches!(part.kind, "ADVANCED_FACE" | "FACE_SURFACE")) {
                    found.push(id);
                } else if !parts(raw).any(|part| part.kind == "MAPPED_ITEM") {
                    parts(raw).for_each(|part| referred(part.attributes, &mut waiting));
                }
            }
            if !found.is_empty() {
                let context = self.context(&units);
                contexts.extend(found.into_iter().map(|face| (face, context.clone())));
            }
        }
        contexts
    }

    fn context(&self, units: &Entity) -> Context {
        let ids = units.references(0).unwrap_or_default();
        let unit = ids.into_iter().find_map(|id| self.unit_of_length(id, MOST_NESTING));
        let uncertainty = self.entity(units.id, &["GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT"]).and_then(|e| e.references(0));
        let measures = uncertainty.unwrap_or_default().into_iter();
        let lengths = measures.filter_map(|id| {
            let measure = self.entity(id, &["UNCERTAINTY_MEASURE_WITH_UNIT"]).ok()?;
            let Attribute::Typed { type_name, .. } = measure.attributes.first()? else { return None };
            let factor = match (&unit, self.unit_of_length(measure.reference(1).ok()?, MOST_NESTING)) {
                (Some((_, own, _)), Some((_, other, _))) => other / own,
                _ => 1.0,
            };
            (type_name == "LENGTH_MEASURE").then_some(measure.real(0).ok()? * factor)
        });
        let uncertainty = lengths.filter(|u| u.is_finite() && *u >= 0.0).reduce(f64::max);
        Context { unit: unit.map(|(name, _, from)| (name, from)), uncertainty }
    }

    /// The name of a unit of length, its size in metres, and the entity that gives it.
    fn unit_of_length(&self, id: u64, nesting: usize) -> Option<(String, f64, String)> {
        let raw = self.graph.get(id)?;
        if let Some(si) = parts(raw).find(|part| part.kind == "SI_UNIT") {
            let [.., prefix, Attribute::Enum(name)] = si.attributes else { return None };
            let prefix = match prefix {
                Attribute::Enum(prefix) => prefix.as_str(),
                _ => "",
            };
            let unit = match (name.as_str(), prefix) {
                ("METRE", "") => "m",
                ("METRE", "MILLI") => "mm",
                ("METRE", "CENTI") => "cm",
                ("METRE", "DECI") => "dm",
                ("METRE", "MICRO") => "um",
                ("METRE", "NANO") => "nm",
                ("METRE", "KILO") => "km",
                _ => return None,
            };
            return Some((unit.into(), metres(unit)?, format!("SI_UNIT #{id}")));
        }
        let converted = parts(raw).find(|part| part.kind == "CONVERSION_BASED_UNIT").filter(|_| nesting > 0)?;
        let measure =
            self.entity(converted.reference(1).ok()?, &["LENGTH_MEASURE_WITH_UNIT", "MEASURE_WITH_UNIT"]).ok()?;
        let (_, base, _) = self.unit_of_length(measure.reference(1).ok()?, nesting - 1)?;
        let size = measure.real(0).ok()? * base;
        // Inches are written with four digits, and survey feet differ in the sixth.
        let known = ["m", "mm", "cm", "dm", "um", "nm", "km", "in", "ft", "yd", "mi"];
        let same = |unit: &&&str| metres(unit).is_some_and(|m| (size - m).abs() <= 1e-6 * m);
        let name = known
            .iter()
            .find(same)
            .map_or_else(|| converted.name().unwrap_or("?").to_lowercase(), |unit| (*unit).into());
        Some((name, size, format!("CONVERSION_BASED_UNIT #{id}")))
    }
}

/// The entities that attributes refer to, at any depth of lists.
fn referred(attributes: &[Attribute], found: &mut Vec<u64>) {
    let mut waiting: Vec<&Attribute> = attributes.iter().collect();
    while let Some(attribute) = waiting.pop() {
        match attribute {
            Attribute::EntityRef(id) => found.push(*id),
            Attribute::List(list) => waiting.extend(list),
            _ => {}
        }
    }
}
