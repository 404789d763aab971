//! Which tetrahedra are material, and of which region: cells are what facets part.

use super::insert::Kernel;
use super::tetrahedra::Face;
use super::{Complex, Fault};
use crate::ids::{Id, RegionId, TetId};
use crate::solid::Material;

/// By tetrahedron: its region; and the names of the regions.
pub(super) struct Regions {
    pub of: Vec<Option<RegionId>>,
    pub names: Vec<String>,
}

/// Name of what the input does not name.
const UNNAMED: &str = "solid";

/// The cells of a complex, and how they lie to each other.
struct Cells {
    /// By tetrahedron: its cell. Cell 0 is the outside.
    of: Vec<usize>,
    count: usize,
    /// The winding number of each cell; that of one which is reached in two ways is that of the first.
    winding: Vec<i32>,
}

impl Complex<'_> {
    /// The regions of all tetrahedra.
    pub(super) fn regions(&mut self) -> Result<Regions, Fault> {
        let cells = self.cells();
        let mut region_of_cell: Vec<Option<RegionId>> = vec![None; cells.count];
        let mut names: Vec<String> = Vec::new();
        let mut named = |name: &str| {
            let place = names.iter().position(|known| known == name).unwrap_or_else(|| {
                names.push(name.to_owned());
                names.len() - 1
            });
            RegionId::from_index(place)
        };
        match self.solid.material() {
            Material::Winding => {
                for cell in (1..cells.count).filter(|&cell| cells.winding[cell] > 0) {
                    region_of_cell[cell] = Some(named(UNNAMED));
                }
            }
            Material::Cells { holes, regions } => {
                let mut is_hole = vec![false; cells.count];
                is_hole[0] = true;
                for &at in holes {
                    is_hole[cells.of[self.tet_at(at)?.index()]] = true;
                }
                for seed in regions {
                    let cell = cells.of[self.tet_at(seed.at)?.index()];
                    if !is_hole[cell] && region_of_cell[cell].is_none() {
                        region_of_cell[cell] = Some(named(self.solid.names().text(seed.name)));
                    }
                }
                for cell in (0..cells.count).filter(|&cell| !is_hole[cell]) {
                    region_of_cell[cell].get_or_insert_with(|| named(UNNAMED));
                }
            }
        }
        if region_of_cell.iter().all(Option::is_none) {
            return Err(Fault::Empty);
        }
        // A tetrahedron that does not stand is in no cell.
        let of = cells.of.iter().map(|&cell| region_of_cell.get(cell).copied().flatten()).collect();
        Ok(Regions { of, names })
    }

    /// Fills cells from tetrahedron to tetrahedron, the outside first; each next one from a facet of those before, so
    /// that its winding number is known.
    fn cells(&self) -> Cells {
        let net = &self.kernel.net;
        let mut cells = Cells { of: vec![usize::MAX; net.capacity()], count: 0, winding: Vec::new() };
        let outside = net.at(crate::ids::VertexId(0));
        let mut starts = vec![(outside, 0)];
        // A cell that shares no facet with the others is one that touches nothing: only the outside can be.
        while let Some((start, winding)) = starts.pop() {
            if cells.of[start.index()] != usize::MAX {
                continue;
            }
            let cell = cells.count;
            cells.count += 1;
            cells.winding.push(winding);
            cells.of[start.index()] = cell;
            let mut stack = vec![start];
            while let Some(t) = stack.pop() {
                for f in (0..4).map(|i| Face::of(t, i)) {
                    let Some(beyond) = net.twin(f).map(Face::tet) else { continue };
                    if cells.of[beyond.index()] != usize::MAX {
                        continue;
                    }
                    match net.facet(f) {
                        Some(_) => starts.push((beyond, winding + self.winding_across(f))),
                        None => {
                            cells.of[beyond.index()] = cell;
                            stack.push(beyond);
                        }
                    }
                }
            }
        }
        cells
    }

    /// What the winding number changes by through a face on a facet, from its tetrahedron to the one beyond.
    fn winding_across(&self, f: Face) -> i32 {
        let triangle = self.kernel.net.triangle(f);
        let (facet, front) = self.triangles[&super::facets::sorted(triangle)];
        let winding = self.solid.facets()[facet].winding;
        let [a, b, c] = front;
        // Seen from the front of the facet, the face turns as `front` does.
        if [[a, b, c], [b, c, a], [c, a, b]].contains(&triangle) { winding } else { -winding }
    }

    fn tet_at(&mut self, at: [f64; 3]) -> Result<TetId, Fault> {
        let at = at.map(|x| x * self.factor);
        Kernel::locate(&mut self.kernel, at).map_err(|_| Fault::Outside { at })
    }
}
